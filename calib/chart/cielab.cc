#include "calib/chart/cielab.h"

#include <Eigen/LU>
#include <array>
#include <utility>

namespace glint {
namespace {

using NamedWhite = std::pair<std::string_view, std::array<double, 3>>;
// CIE 15:2004, table T.3; D65 is the white of Rec.709's primaries as IEC 61966-2-1 rounds them.
constexpr std::array<NamedWhite, 5> kWhites = {{{"D50", {0.96422, 1, 0.82521}},
                                                {"D55", {0.95682, 1, 0.92149}},
                                                {"D65", {0.95047, 1, 1.08883}},
                                                {"A", {1.09850, 1, 0.35585}},
                                                {"E", {1, 1, 1}}}};

Eigen::Matrix3d Bradford() {
  Eigen::Matrix3d cones;
  cones << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296;
  return cones;
}

Eigen::Matrix3d Adaptation(const Eigen::Vector3d& from_white, const Eigen::Vector3d& to_white) {
  const Eigen::Matrix3d cones = Bradford();
  const Eigen::Vector3d gain = (cones * to_white).cwiseQuotient(cones * from_white);
  return cones.inverse() * gain.asDiagonal() * cones;
}

}  // namespace

std::optional<Eigen::Vector3d> WhitePoint(std::string_view illuminant) {
  for (const auto& [name, xyz] : kWhites) {
    if (name == illuminant) return Eigen::Vector3d(xyz.data());
  }
  return std::nullopt;
}

std::string IlluminantNamesText() {
  std::string text;
  for (const auto& [name, xyz] : kWhites) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

Eigen::Vector3d AdaptedXyz(const Eigen::Vector3d& xyz, const Eigen::Vector3d& from_white,
                           const Eigen::Vector3d& to_white) {
  return Adaptation(from_white, to_white) * xyz;
}

Eigen::Vector3d LabFromXyz(const Eigen::Vector3d& xyz, const Eigen::Vector3d& white) {
  const Eigen::Vector3d f = xyz.cwiseQuotient(white).unaryExpr(&LabCurve<double>);
  return {116 * f.y() - 16, 500 * (f.x() - f.y()), 200 * (f.y() - f.z())};
}

Eigen::Vector3d XyzFromLab(const Eigen::Vector3d& lab, const Eigen::Vector3d& white) {
  const double y = (lab[0] + 16) / 116;
  const Eigen::Vector3d f(y + lab[1] / 500, y, y - lab[2] / 200);
  const auto cube = [](double v) {
    return v > 6.0 / 29 ? v * v * v : (v - 4.0 / 29) * (108.0 / 841);
  };
  return f.unaryExpr(cube).cwiseProduct(white);
}

const Eigen::Matrix3d& XyzD50FromRec709() {
  static const Eigen::Matrix3d matrix = [] {
    Eigen::Matrix3d d65;
    d65 << 0.4123908, 0.3575843, 0.1804808, 0.2126390, 0.7151687, 0.0721923, 0.0193308, 0.1191948,
        0.9505322;
    return Eigen::Matrix3d(Adaptation(d65.rowwise().sum(), *WhitePoint("D50")) * d65);
  }();
  return matrix;
}

Eigen::Vector3d Rec709FromLab(const Eigen::Vector3d& lab) {
  return XyzD50FromRec709().inverse() * XyzFromLab(lab, *WhitePoint("D50"));
}

}  // namespace glint
