#include "tests/base/model/constant_tables.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <span>

#include "base/model/estimate.h"
#include "base/model/initial_maps.h"
#include "base/model/photographs.h"
#include "base/model/registration.h"
#include "base/model/solver.h"
#include "base/model/substances.h"
#include "base/model/uncalibrated_light.h"
#include "base/model/view_correction.h"

namespace glint::test {
namespace {

using constants::ModelConstant;

struct Section {
  const char* title;
  std::span<const ModelConstant> rows;
};

const Section kModelSections[] = {
    {"The photographs", constants::kPhotographRows},
    {"Initial maps", constants::kInitialMapsRows},
    {"Substances", constants::kSubstanceRows},
    {"The estimate and cross-validation", constants::kEstimateRows},
    {"Light that was not calibrated", constants::kLightRows},
    {"View correction", constants::kViewCorrectionRows},
    {"Registration", constants::kRegistrationRows},
};

// The same number again, as compiled in double or in single precision.
bool Means(const std::string& text, double value) {
  const double read = std::strtod(text.c_str(), nullptr);
  return read == value || static_cast<float>(read) == static_cast<float>(value);
}

std::string WithoutZeros(std::string number) {  // of its exponent
  const size_t exponent = number.find_first_of("e");
  if (exponent == std::string::npos) return number;
  const size_t digits = number.find_first_not_of("-+0", exponent + 1);
  const bool negative = number[exponent + 1] == '-';
  return number.substr(0, exponent + 1) + (negative ? "-" : "") + number.substr(digits);
}

std::string ValuesText(const constants::ConstantValues& values) {
  std::string text;
  for (size_t i = 0; i < values.count; ++i) {
    text += (i > 0 ? ", " : "") + NumberText(values.of[i]);
  }
  return text;
}

// `kA`, `kB`
std::string NameText(const std::string& names) {
  std::string text = "`";
  for (const char c : names)
    text += c == ',' ? std::string("`,") : c == ' ' ? " `" : std::string(1, c);
  return text + "`";
}

std::string MeaningText(const ModelConstant& row) {
  const std::string option = row.option;
  return row.meaning + (option.empty() ? "" : " (`" + option + "`)");
}

}  // namespace

std::string NumberText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  if (Means(text, value)) return WithoutZeros(text);
  for (int denominator = 2; denominator <= 1024; denominator *= 2) {
    const double numerator = value * denominator;
    if (numerator != std::round(numerator)) continue;
    return std::to_string(std::lround(numerator)) + "/" + std::to_string(denominator);
  }
  std::snprintf(text, sizeof text, "%.17g", value);
  return WithoutZeros(text);
}

std::string ModelTable() {
  std::string table = "| constant | value | unit | meaning | source |\n|---|---|---|---|---|\n";
  for (const Section& section : kModelSections) {
    table += std::string("| **") + section.title + "** | | | | |\n";
    for (const ModelConstant& row : section.rows) {
      table += "| " + NameText(row.name) + " | " + ValuesText(row.values) + " | " + row.unit +
               " | " + MeaningText(row) + " | " + row.source + " |\n";
    }
  }
  return table;
}

std::string SolverTable() {
  std::string table = "| constant | value | unit | of |\n|---|---|---|---|\n";
  for (const ModelConstant& row : constants::kSolverRows) {
    table += "| " + NameText(row.name) + " | " + ValuesText(row.values) + " | " + row.unit + " | " +
             MeaningText(row) + " |\n";
  }
  return table;
}

}  // namespace glint::test
