// Refinement of a sample by several jobs, each of some of its rows: results of parts, kept beside
// the stage's own and joined to it. Joined, all of its files are byte for byte what one job writes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fitting/refine/refine_rows.h"

namespace glint {

// A join holds a lock, an open file, on each; a process may have 1024.
inline constexpr int kMostRowParts = 256;

// The part-th of `of` parts of a sample, from the top, counted from 1.
struct RowPart {
  int part = 1, of = 1;

  // Of a sample of `height` rows: [first, last).
  int first(int height) const { return RowAt(part - 1, height); }
  int last(int height) const { return RowAt(part, height); }
  // "3of8"
  std::string name() const { return std::to_string(part) + "of" + std::to_string(of); }

 private:
  int RowAt(int edge, int height) const {
    return static_cast<int>(static_cast<long long>(height) * edge / of);
  }
};

// "3/8". Throws UserError.
RowPart ParseRowPart(const std::string& text);

// The stage's name and folder of a part, beside the stage's own: "refine-3of8".
std::string PartStage(const RowPart& part);
// Removes results of parts, which a result of the whole leaves without use, from `work`. What
// cannot be removed stays.
void RemoveParts(const std::filesystem::path& work);

// Files of a part's result.
inline constexpr char kPartSums[] = "sums.json";
void WriteRowSums(const std::filesystem::path& file, const RowSums& sums);
// Throws UserError: not `rows` lists of `columns` numbers. What was not finite comes back as NaN.
RowSums ReadRowSums(const std::filesystem::path& file, int rows, size_t columns);

// Writes the EXR file whose rows are those of `parts`, from the top, `rows_at_once` in memory.
// Throws UserError: they do not fit together; nothing is then written.
void JoinRows(const std::vector<std::filesystem::path>& parts, int height, int rows_at_once,
              const std::filesystem::path& file);

}  // namespace glint
