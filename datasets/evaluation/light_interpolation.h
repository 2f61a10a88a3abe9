// Relighting by interpolation of photographs, as viewers for reflectance transformation imaging do
// it: what maps of a material are to be compared with. Every method predicts a photograph under a
// new light as a weighted sum of the photographs, texel by texel, of their values as a screen shows
// them (gamma 2.2).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace glint {

struct LightInterpolation {
  std::string name;  // "ptm", "sh9", "sh16", "rbf"
  // Rows: the new lights, columns: the photographs. Unit vectors toward the lights, z the normal.
  Eigen::MatrixXd (*weights)(const std::vector<Eigen::Vector3d>& known,
                             const std::vector<Eigen::Vector3d>& wanted);
};

// Polynomial texture maps, six terms (Malzbender, Gelb, Wolters 2001); real spherical harmonics of
// degree 2 and 3, least squares; thin-plate splines over the lights' x and y with an affine part
// (Duchon 1977), which go through the photographs.
const std::vector<LightInterpolation>& LightInterpolations();

}  // namespace glint
