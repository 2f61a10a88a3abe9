#include "base/formats/colour_correction.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/errors/errors.h"
#include "base/formats/manifest.h"

namespace glint {

std::optional<ColourModel> ColourModelFromName(std::string_view name) {
  for (const ColourModel model : {ColourModel::kLinear, ColourModel::kRootPolynomial}) {
    if (name == ColourModelName(model)) return model;
  }
  return std::nullopt;
}

std::string_view ColourModelName(ColourModel model) {
  return model == ColourModel::kLinear ? "linear" : "root-polynomial";
}

int ColourTerms(ColourModel model) { return model == ColourModel::kLinear ? 3 : 6; }

ColourCorrection::Terms ColourCorrection::TermsOf(ColourModel model, const Eigen::Vector3d& rgb) {
  Terms terms = Terms::Zero();
  terms.head<3>() = rgb;
  if (model == ColourModel::kLinear) return terms;
  const Eigen::Vector3d root = rgb.cwiseMax(0).cwiseSqrt();
  terms.tail<3>() << root.x() * root.y(), root.y() * root.z(), root.x() * root.z();
  return terms;
}

Eigen::Vector3d ColourCorrection::Flash(const Eigen::Vector3d& rgb) const {
  const Eigen::Vector3d luminance(0.2126, 0.7152, 0.0722);  // of Rec.709
  return Eigen::Vector3d::Constant(luminance.dot((*this)(rgb)));
}

ColourCorrection ColourCorrection::After(const Eigen::Vector3d& gain_rgb) const {
  ColourCorrection after = *this;
  after.matrix *= TermsOf(ColourModel::kRootPolynomial, gain_rgb).asDiagonal();
  return after;
}

Json ToJson(const ColourCorrection& correction) {
  std::vector<double> values;
  for (int row = 0; row < 3; ++row) {
    for (int term = 0; term < ColourTerms(correction.model); ++term) {
      values.push_back(correction.matrix(row, term));
    }
  }
  return {{"model", std::string(ColourModelName(correction.model))}, {"matrix", values}};
}

ColourCorrection ReadColourCorrection(const std::filesystem::path& file, const Json& json,
                                      const std::string& name) {
  const std::string model_name = RequireString(file, json, name, "model");
  const auto model = ColourModelFromName(model_name);
  if (!model) {
    throw UserError(file, name + ".model", "'" + model_name + "'",
                    "linear or root-polynomial is expected; run calib again");
  }
  ColourCorrection correction{*model, ColourCorrection::Matrix::Zero()};
  const int terms = ColourTerms(*model), count = 3 * terms;
  const auto values = RequireNumbers(file, json, name, "matrix", static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) correction.matrix(i / terms, i % terms) = values[i];
  return correction;
}

}  // namespace glint
