#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "calib/moving_light/lights_file_formats.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBlank = " \t\r,;";

std::string_view Trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) + 1 - first);
}

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// "0,26" of a program that writes decimal commas becomes "0.26"; commas that separate stay.
std::string WithDecimalPoints(std::string_view line) {
  constexpr std::string_view kBetweenWords = " \t\r;";
  std::string text(line);
  for (size_t first = 0; first < text.size();) {
    size_t end = text.find_first_of(kBetweenWords, first);
    if (end == std::string::npos) end = text.size();
    size_t at = first;
    if (at < end && (text[at] == '-' || text[at] == '+')) ++at;
    const size_t comma = text.find(',', at);
    const auto digits = [&](size_t from, size_t to) {
      return to > from && std::all_of(text.begin() + static_cast<std::ptrdiff_t>(from),
                                      text.begin() + static_cast<std::ptrdiff_t>(to), IsDigit);
    };
    if (comma < end && digits(at, comma) && digits(comma + 1, end)) text[comma] = '.';
    first = end + 1;
  }
  return text;
}

// The last number of a line, which is taken off. False: it is none.
bool TakeLastNumber(std::string_view* line, double* number) {
  *line = Trimmed(*line);
  const size_t blank = line->find_last_of(kBlank);
  const std::string_view word = blank == std::string_view::npos ? *line : line->substr(blank + 1);
  const bool plus = word.size() > 1 && word[0] == '+' && (IsDigit(word[1]) || word[1] == '.');
  const auto [end, error] =
      std::from_chars(word.data() + (plus ? 1 : 0), word.data() + word.size(), *number);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(*number)) {
    return false;
  }
  *line = Trimmed(line->substr(0, line->size() - word.size()));
  return true;
}

double Unit_mm(const std::string& unit) {
  return unit == "mm" ? 1 : unit == "cm" ? 10 : unit == "m" ? 1000 : 0;
}

std::string Unquoted(std::string_view name) {
  if (name.size() > 1 && name.front() == '"' && name.back() == '"') {
    name = name.substr(1, name.size() - 2);
  }
  return std::string(name);
}

}  // namespace

std::string WithoutFolders(const std::string& name) {
  const size_t slash = name.find_last_of("/\\");
  return slash == std::string::npos ? name : name.substr(slash + 1);
}

ListedLight LightOf(const fs::path& file, const std::string& place, const Eigen::Vector3d& vector,
                    double unit_mm) {
  const double length = vector.norm();
  const std::string found =
      fmt::format("the vector {:g} {:g} {:g}", vector.x(), vector.y(), vector.z());
  if (!(length > 0)) {
    throw UserError(file, place, found, "it has no direction: correct it or remove the line");
  }
  ListedLight light;
  light.direction = vector / length;
  if (unit_mm > 0) {
    light.position_mm = unit_mm * vector;
    return light;
  }
  // Directions are written with few digits, or are of a ball whose radius was off: one set of nine
  // published ones has lengths of .979 to .992.
  constexpr double kLeast = 0.5, kMost = 2;
  if (length < kLeast || length > kMost) {
    throw UserError(file, place, fmt::format("{}, of length {:.4g}", found, length),
                    "directions have length 1; if these are positions, state it in [lights]: unit "
                    "= \"mm\" (or cm, m)");
  }
  return light;
}

LightsFile ReadLpFile(const fs::path& file, const std::string& unit) {
  LightsFile result;
  result.file = file;
  std::string text = ReadTextFile(file);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  std::istringstream stream(text);
  std::string line_text;
  std::optional<double> announced;
  double worst = 0;
  for (int number = 1; std::getline(stream, line_text); ++number) {
    line_text = WithDecimalPoints(line_text);
    std::string_view line = Trimmed(line_text);
    if (line.empty() || line.front() == '#') continue;
    const std::string place = fmt::format("line {}", number);
    const std::string whole(line);
    std::array<double, 3> xyz{};
    if (!announced && result.lights.empty() && TakeLastNumber(&line, &xyz[0]) && line.empty()) {
      announced = xyz[0];
      continue;
    }
    line = whole;
    for (int i = 2; i >= 0; --i) {
      if (TakeLastNumber(&line, &xyz[static_cast<size_t>(i)])) continue;
      throw UserError(file, place, "'" + whole + "'",
                      "write a file name and three numbers: x (right), y (up), z (to the camera)");
    }
    if (line.empty()) {
      throw UserError(file, place, "'" + whole + "'", "write the photograph's name in front");
    }
    ListedLight light =
        LightOf(file, place, Eigen::Vector3d(xyz[0], xyz[1], xyz[2]), Unit_mm(unit));
    light.photo = WithoutFolders(Unquoted(line));
    worst = std::max(worst, std::abs(Eigen::Vector3d(xyz[0], xyz[1], xyz[2]).norm() - 1));
    result.lights.push_back(std::move(light));
  }
  if (announced && *announced != static_cast<double>(result.lights.size())) {
    throw UserError(
        file, "line 1",
        fmt::format("{:g} lights announced, {} listed", *announced, result.lights.size()),
        "correct the number, or complete the list: is the file truncated?");
  }
  constexpr double kWorthAWord = 0.05;
  if (unit.empty() && worst > kWorthAWord) {
    result.remarks.push_back(fmt::format(
        "{}: its vectors' lengths differ from 1 by up to {:.0f} %; only their directions are used",
        file.string(), 100 * worst));
  }
  return result;
}

}  // namespace glint
