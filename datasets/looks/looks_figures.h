// The figures of Looks as rows of a table: the one place for a figure's name, meaning and value.
// Files, printed tables, the report page and docs/evaluation.md list what is here.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "datasets/looks/looks.h"

namespace glint {

// A band of detail, in texels of a picture 256 across.
struct LooksBand {
  const char* key;
  const char* heading;
};

struct LooksFigure {
  const char* key;
  const char* heading;
  std::span<const LooksBand> bands = {};      // finest first; none: the figure is one number
  std::span<double> (*values)(Looks& looks);  // one for each band
  const char* says;                           // to a reader of the page
  const char* definition;                     // in Markdown, as the next
  const char* interpretation;
  int decimals = 3;      // where methods are compared
  bool overall = false;  // judges the whole picture and not one aspect of it
};

std::span<const LooksFigure> LooksFigures();

// One number of a figure: a column of a table.
struct LooksColumn {
  const LooksFigure* figure;
  size_t band;  // 0 where there are none

  std::string key() const;      // "contrast_1_2"
  std::string heading() const;  // "contrast 1–2"
  double ValueOf(Looks looks) const;
};

// Tables with little room have the two finest bands.
inline constexpr size_t kFineBands = 2, kAllBands = std::numeric_limits<size_t>::max();

// Of one figure and of all, each with at most so many of its bands.
std::vector<LooksColumn> ColumnsOf(const LooksFigure& figure, size_t most_bands = kAllBands);
std::vector<LooksColumn> LooksColumns(size_t most_bands = kAllBands);

// Mean of each figure over those that know it; unknown where none does.
Looks MeanLooks(std::span<const Looks> looks);

// By key, a list where a figure has bands; what is unknown is null.
Json ToJson(const Looks& looks);

// A figure for people; "–" where it is unknown.
std::string LooksText(double figure, int decimals);

// Of a column of plain text, in characters: room for its heading and for a figure.
int LooksWidth(const std::string& heading);

}  // namespace glint
