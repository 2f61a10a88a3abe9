#include "datasets/import/number_file.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "base/errors/errors.h"
#include "base/files/files.h"

namespace glint {
namespace {

constexpr size_t kMaxBytes = 4u << 20;

double ParseNumber(const std::filesystem::path& file, int line, const std::string& word) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (end == word.c_str() || *end != '\0' || !std::isfinite(value)) {
    throw UserError(file, "line " + std::to_string(line), "'" + word.substr(0, 60) + "'",
                    "a number is expected");
  }
  return value;
}

std::vector<NumberRow> ReadRows(const std::filesystem::path& file, const std::string& heading) {
  std::istringstream text(ReadTextFile(file, kMaxBytes));
  std::vector<NumberRow> rows;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    if (number == 1 && !heading.empty() && line.rfind(heading, 0) == 0) continue;
    for (char& c : line) {
      if (c == ',' || c == ';' || c == '\t' || c == '\r') c = ' ';
    }
    NumberRow row{number, {}};
    std::istringstream words(line);
    for (std::string word; words >> word;) row.numbers.push_back(ParseNumber(file, number, word));
    if (!row.numbers.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

std::vector<NumberRow> ReadNumberRows(const std::filesystem::path& file, size_t columns,
                                      const std::string& heading) {
  std::vector<NumberRow> rows = ReadRows(file, heading);
  for (const NumberRow& row : rows) {
    if (row.numbers.size() == columns) continue;
    throw UserError(file, "line " + std::to_string(row.line),
                    std::to_string(row.numbers.size()) + " numbers",
                    "write " + std::to_string(columns) + " numbers in every line");
  }
  if (rows.empty()) {
    throw UserError(file, "", "no numbers",
                    "write lines of " + std::to_string(columns) + " numbers");
  }
  return rows;
}

}  // namespace glint
