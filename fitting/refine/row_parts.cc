#include "fitting/refine/row_parts.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <regex>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/json_file.h"
#include "base/images/exr_rows.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

const char kRunAgain[] = "run glint-refine --part for this part again";

// The whole of `text` as a number; 0: it is none.
int NumberIn(const std::string& text) {
  int number = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  return read.ec == std::errc() && read.ptr == end ? number : 0;
}

}  // namespace

RowPart ParseRowPart(const std::string& text) {
  const size_t slash = text.find('/');
  RowPart part;
  part.part = NumberIn(text.substr(0, slash));
  part.of = slash == std::string::npos ? 0 : NumberIn(text.substr(slash + 1));
  if (part.part < 1 || part.of > kMostRowParts || part.part > part.of) {
    throw UserError("--part: found \"" + text +
                    "\"; give K/N, the K-th of N parts (1 <= K <= N <= " +
                    std::to_string(kMostRowParts) + "), such as 3/8");
  }
  return part;
}

std::string PartStage(const RowPart& part) { return "refine-" + part.name(); }

void RemoveParts(const fs::path& work) {
  const std::regex name("refine-[0-9]+of[0-9]+");
  std::error_code error;
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(work, error)) {
    if (std::regex_match(entry.path().filename().string(), name)) folders.push_back(entry.path());
  }
  for (const fs::path& folder : folders) fs::remove_all(folder, error);
}

void WriteRowSums(const fs::path& file, const RowSums& sums) {
  WriteFileAtomically(file, Json(sums).dump() + "\n");
}

RowSums ReadRowSums(const fs::path& file, int rows, size_t columns) {
  const Json json = ReadJsonFile(file, kRunAgain);
  const auto is_row = [&](const Json& row) {
    return row.is_array() && row.size() == columns &&
           std::all_of(row.begin(), row.end(),
                       [](const Json& x) { return x.is_number() || x.is_null(); });
  };
  if (!json.is_array() || json.size() != static_cast<size_t>(rows) ||
      !std::all_of(json.begin(), json.end(), is_row)) {
    throw UserError(
        file, "",
        "other than " + std::to_string(rows) + " lists of " + std::to_string(columns) + " numbers",
        kRunAgain);
  }
  RowSums sums;
  for (const Json& row : json) {
    std::vector<double>& numbers = sums.emplace_back();
    for (const Json& x : row) numbers.push_back(x.is_null() ? std::nan("") : x.get<double>());
  }
  return sums;
}

void JoinRows(const std::vector<fs::path>& parts, int height, int rows_at_once,
              const fs::path& file) {
  const ExrReader like(parts.front());
  int rows = 0;
  for (const fs::path& part : parts) {
    const ExrReader reader(part);
    if (reader.width() != like.width() || reader.channels() != like.channels()) {
      throw UserError(part, "", "another width or other channels than in the first part's",
                      kRunAgain);
    }
    rows += reader.height();
  }
  if (rows != height) {
    throw UserError(
        file.filename(), "", std::to_string(rows) + " rows in all parts",
        std::to_string(height) + " are expected; run glint-refine --part for all again");
  }
  ExrWriter writer(file, like.width(), height, like.channels(), like.attributes(),
                   like.precision());
  for (const fs::path& part : parts) {
    ExrReader reader(part);
    for (int first = 0; first < reader.height(); first += rows_at_once) {
      writer.Write(reader.Read(first, std::min(rows_at_once, reader.height() - first)));
    }
  }
  writer.Close();
}

}  // namespace glint
