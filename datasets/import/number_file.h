// Text files of numbers: rows separated by line ends, numbers by commas, tabs and blanks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace glint {

struct NumberRow {
  int line = 0;  // from 1
  std::vector<double> numbers;
};

// Rows that are not empty, each of `columns` numbers. A first line that begins with `heading` (when
// not empty) is passed over. Throws UserError naming file and line: a word that is no finite
// number, a row of another length, no rows.
std::vector<NumberRow> ReadNumberRows(const std::filesystem::path& file, size_t columns,
                                      const std::string& heading = "");

}  // namespace glint
