// One row of the tables of docs/model.md: numbers of the statistical model that can change a map,
// as they are compiled in, with their unit and where they come from. The other headers of this
// folder have the numbers, by subject, and beside them their rows, which name the constants
// themselves; tests/base/model compares the tables, and GLINT_UPDATE=1 ctest -R model_page writes
// them anew.
//
// Defaults of options are these constants. Not here: the reflectance model (docs/conventions.md),
// what makes the initial maps, and sizes of memory and work that change no value.
//
// "Longer side" is the sample's; log radiance is log(radiance + kLogOffset).
#pragma once

#include <array>
#include <cstddef>

namespace glint::constants {

// The numbers of one row, as they are compiled in.
struct ConstantValues {
  template <class... T>
  constexpr ConstantValues(T... values)  // NOLINT: rows are lists of values
      : of{static_cast<double>(values)...}, count(sizeof...(T)) {}
  template <class T, size_t N>
  constexpr ConstantValues(const std::array<T, N>& values) : count(N) {  // NOLINT
    for (size_t i = 0; i < N; ++i) of[i] = static_cast<double>(values[i]);
  }
  std::array<double, 8> of{};
  size_t count = 0;
};

struct ModelConstant {
  const char* name;  // in the code; of a row of several, separated by commas
  ConstantValues values;
  const char* unit;     // "": a number
  const char* meaning;  // Markdown, as the next
  const char* source;
  const char* option;  // whose default it is; "": none
};

constexpr ModelConstant Row(const char* name, const ConstantValues& values, const char* unit,
                            const char* meaning, const char* source = "", const char* option = "") {
  return {name, values, unit, meaning, source, option};
}

}  // namespace glint::constants
