// Colours of surfaces between CIE XYZ, CIE L*a*b* and linear Rec.709.
//
// XYZ of a perfect white is its illuminant's white point, Y = 1. Lab is relative to D50, as charts'
// makers publish it. Rec.709 is relative to D65; between the two lies Bradford's adaptation, so
// that white is (1, 1, 1) and neutral surfaces have R = G = B. CIE 15:2004; IEC 61966-2-1;
// ICC.1:2010, annex E (Bradford).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace glint {

inline constexpr std::string_view kLabIlluminant = "D50";

// XYZ of D50, D55, D65, A or E for the observer of 1931; nullopt: another name.
std::optional<Eigen::Vector3d> WhitePoint(std::string_view illuminant);
std::string IlluminantNamesText();  // "D50, D55, …"

// How the surface looks under another white, by Bradford's cone responses.
Eigen::Vector3d AdaptedXyz(const Eigen::Vector3d& xyz, const Eigen::Vector3d& from_white,
                           const Eigen::Vector3d& to_white);

Eigen::Vector3d LabFromXyz(const Eigen::Vector3d& xyz, const Eigen::Vector3d& white);
Eigen::Vector3d XyzFromLab(const Eigen::Vector3d& lab, const Eigen::Vector3d& white);

const Eigen::Matrix3d& XyzD50FromRec709();
Eigen::Vector3d Rec709FromLab(const Eigen::Vector3d& lab);

// The cube root of Lab, with its straight part below (6/29)³, which goes on below 0.
template <class T>
T LabCurve(const T& t) {
  using std::cbrt;
  constexpr double kCube = 216.0 / 24389, kSlope = 841.0 / 108;
  return t > T(kCube) ? cbrt(t) : T(kSlope) * t + T(4.0 / 29);
}

// Channels may lie below 0. T: double, or ceres::Jet.
template <class T>
Eigen::Matrix<T, 3, 1> LabFromRec709(const Eigen::Matrix<T, 3, 1>& rgb) {
  // For a white of 1: rows divided by the white point, which is the image of (1, 1, 1).
  static const Eigen::Matrix3d relative =
      XyzD50FromRec709().rowwise().sum().cwiseInverse().asDiagonal() * XyzD50FromRec709();
  const Eigen::Matrix<T, 3, 1> xyz = relative.cast<T>() * rgb;
  const T fx = LabCurve(xyz[0]), fy = LabCurve(xyz[1]), fz = LabCurve(xyz[2]);
  return {T(116) * fy - T(16), T(500) * (fx - fy), T(200) * (fy - fz)};
}

}  // namespace glint
