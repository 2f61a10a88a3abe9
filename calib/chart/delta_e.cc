#include "calib/chart/delta_e.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double Power7(double x) { return std::pow(x, 7); }
// √(C⁷ / (C⁷ + 25⁷))
double ChromaShare(double chroma) {
  return std::sqrt(Power7(chroma) / (Power7(chroma) + Power7(25)));
}

// Hue angle in degrees, from 0 to 360; 0 without chroma.
double Hue(double a, double b) {
  if (a == 0 && b == 0) return 0;
  const double hue = std::atan2(b, a) / kDegree;
  return hue < 0 ? hue + 360 : hue;
}

// What the differences of lightness, chroma and hue are divided by, and the blues' rotation.
struct Weights {
  double lightness, chroma, hue, rotation;
};

Weights WeightsAt(double lightness, double chroma, double hue) {
  const double t = 1 - 0.17 * std::cos((hue - 30) * kDegree) + 0.24 * std::cos(2 * hue * kDegree) +
                   0.32 * std::cos((3 * hue + 6) * kDegree) -
                   0.20 * std::cos((4 * hue - 63) * kDegree);
  const double off = (lightness - 50) * (lightness - 50);
  const double blue = (hue - 275) / 25;
  return {1 + 0.015 * off / std::sqrt(20 + off), 1 + 0.045 * chroma, 1 + 0.015 * chroma * t,
          -std::sin(60 * std::exp(-blue * blue) * kDegree) * 2 * ChromaShare(chroma)};
}

double MeanHue(double h1, double h2, bool either_grey) {
  if (either_grey) return h1 + h2;
  if (std::abs(h1 - h2) <= 180) return (h1 + h2) / 2;
  return h1 + h2 < 360 ? (h1 + h2 + 360) / 2 : (h1 + h2 - 360) / 2;
}

double HueDifference(double h1, double h2, bool either_grey) {
  if (either_grey) return 0;
  const double d = h2 - h1;
  return d > 180 ? d - 360 : d < -180 ? d + 360 : d;
}

}  // namespace

double DeltaE00(const Eigen::Vector3d& lab_1, const Eigen::Vector3d& lab_2) {
  const double mean_c = (std::hypot(lab_1[1], lab_1[2]) + std::hypot(lab_2[1], lab_2[2])) / 2;
  const double stretch = 1 + 0.5 * (1 - ChromaShare(mean_c));
  const double a1 = stretch * lab_1[1], a2 = stretch * lab_2[1];
  const double c1 = std::hypot(a1, lab_1[2]), c2 = std::hypot(a2, lab_2[2]);
  const double h1 = Hue(a1, lab_1[2]), h2 = Hue(a2, lab_2[2]);
  const bool either_grey = c1 * c2 == 0;
  const double hue =
      2 * std::sqrt(c1 * c2) * std::sin(HueDifference(h1, h2, either_grey) / 2 * kDegree);
  const Weights w =
      WeightsAt((lab_1[0] + lab_2[0]) / 2, (c1 + c2) / 2, MeanHue(h1, h2, either_grey));
  const double dl = (lab_2[0] - lab_1[0]) / w.lightness, dc = (c2 - c1) / w.chroma,
               dh = hue / w.hue;
  return std::sqrt(dl * dl + dc * dc + dh * dh + w.rotation * dc * dh);
}

Eigen::Matrix3d DeltaE00Metric(const Eigen::Vector3d& reference) {
  const double stretch = 1 + 0.5 * (1 - ChromaShare(std::hypot(reference[1], reference[2])));
  const double a = stretch * reference[1], b = reference[2], chroma = std::hypot(a, b);
  const Weights w = WeightsAt(reference[0], chroma, Hue(a, b));
  // Along and across the reference's hue; of a grey any direction will do.
  const double cosine = chroma > 0 ? a / chroma : 1, sine = chroma > 0 ? b / chroma : 0;
  Eigen::Matrix3d scaled = Eigen::Matrix3d::Zero();
  scaled(0, 0) = 1 / w.lightness;
  scaled.row(1) << 0, stretch * cosine / w.chroma, sine / w.chroma;
  scaled.row(2) << 0, -stretch * sine / w.hue, cosine / w.hue;
  Eigen::Matrix3d form = Eigen::Matrix3d::Identity();
  form(1, 2) = form(2, 1) = w.rotation / 2;
  return Eigen::LLT<Eigen::Matrix3d>(form).matrixU() * scaled;
}

}  // namespace glint
