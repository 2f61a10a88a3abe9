// The colours of a camera under its flash, corrected to Rec.709: what a colour chart tells.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

#include "base/files/json.h"

namespace glint {

enum class ColourModel {
  kLinear,         // 3 × 3
  kRootPolynomial  // 3 × 6 of R, G, B, √(RG), √(GB), √(RB): G. Finlayson, M. Mackiewicz,
                   // A. Hurlbert 2015, Color Correction Using Root-Polynomial Regression
};

std::optional<ColourModel> ColourModelFromName(std::string_view name);
std::string_view ColourModelName(ColourModel model);  // "linear", "root-polynomial"
int ColourTerms(ColourModel model);                   // 3 or 6

// Radiance as the camera stored it, linear, to linear Rec.709 radiance in which a white surface
// under the flash has R = G = B = its green value as stored. Both models are homogeneous of degree
// one: exposure and fall-off pass through unchanged.
struct ColourCorrection {
  using Matrix = Eigen::Matrix<double, 3, 6>;
  using Terms = Eigen::Matrix<double, 6, 1>;

  ColourModel model = ColourModel::kLinear;
  Matrix matrix = Matrix::Identity();  // columns that the model lacks are 0

  // Products of values below 0, which noise leaves, have the root 0.
  static Terms TermsOf(ColourModel model, const Eigen::Vector3d& rgb);
  // Not clamped: colours beyond Rec.709 have channels below 0.
  Eigen::Vector3d operator()(const Eigen::Vector3d& rgb) const {
    return matrix * TermsOf(model, rgb);
  }
  // A light of power (or irradiance) `rgb` as stored, for corrected radiance. The flash is white
  // by definition; its power is the luminance of the corrected one, so that a paper with a tint
  // keeps its luminous reflectance.
  Eigen::Vector3d Flash(const Eigen::Vector3d& rgb) const;

  // The correction that first multiplies what it is given by `gain_rgb`.
  ColourCorrection After(const Eigen::Vector3d& gain_rgb) const;
};

// {"model": "linear", "matrix": [9 or 18 numbers, row-major]}
Json ToJson(const ColourCorrection& correction);
// Throws UserError naming `file` and `name`.
ColourCorrection ReadColourCorrection(const std::filesystem::path& file, const Json& json,
                                      const std::string& name);

}  // namespace glint
