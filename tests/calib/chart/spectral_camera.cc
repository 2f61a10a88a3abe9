#include "tests/calib/chart/spectral_camera.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>

#include "calib/chart/cielab.h"
#include "tests/calib/chart/chart_scene.h"
#include "tests/calib/testing/synthetic_photo.h"

namespace glint::testing {
namespace {

constexpr int kBands = 31;

Eigen::VectorXd Sampled(const std::function<double(double)>& of_nm) {
  Eigen::VectorXd values(kBands);
  for (int i = 0; i < kBands; ++i) values[i] = of_nm(400 + 10 * i);
  return values;
}

double Bell(double nm, double centre, double below, double above) {
  const double off = (nm - centre) / (nm < centre ? below : above);
  return std::exp(-0.5 * off * off);
}

double BlackBody(double nm, double kelvin) {
  return std::pow(nm / 560, -5) / (std::exp(1.4388e7 / (nm * kelvin)) - 1);
}

// C. Wyman, P. Sloan, P. Shirley 2013, Simple Analytic Approximations to the CIE XYZ Color Matching
// Functions.
Eigen::Matrix<double, 3, kBands> ColourMatching() {
  Eigen::Matrix<double, 3, kBands> rows;
  rows.row(0) = Sampled([](double l) {
                  return 1.056 * Bell(l, 599.8, 37.9, 31.0) + 0.362 * Bell(l, 442, 16, 26.7) -
                         0.065 * Bell(l, 501.1, 20.4, 26.2);
                }).transpose();
  rows.row(1) = Sampled([](double l) {
                  return 0.821 * Bell(l, 568.8, 46.9, 40.5) + 0.286 * Bell(l, 530.9, 16.3, 31.1);
                }).transpose();
  rows.row(2) = Sampled([](double l) {
                  return 1.217 * Bell(l, 437, 11.8, 36) + 0.681 * Bell(l, 459, 26, 13.8);
                }).transpose();
  return rows;
}

// XYZ over that of white, under 5003 K.
Eigen::Matrix<double, 3, kBands> RelativeXyz() {
  const Eigen::VectorXd light = Sampled([](double l) { return BlackBody(l, 5003); });
  const Eigen::Matrix<double, 3, kBands> rows = ColourMatching() * light.asDiagonal();
  return rows.rowwise().sum().cwiseInverse().asDiagonal() * rows;
}

// The smoothest spectrum of these tristimulus values: least second differences.
Eigen::VectorXd Smoothest(const Eigen::Matrix<double, 3, kBands>& tristimulus,
                          const Eigen::Vector3d& values) {
  Eigen::MatrixXd bend = Eigen::MatrixXd::Zero(kBands - 2, kBands);
  for (int i = 0; i < kBands - 2; ++i) bend.row(i).segment<3>(i) << 1, -2, 1;
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(kBands + 3, kBands + 3);
  system.topLeftCorner(kBands, kBands) = bend.transpose() * bend;
  system.bottomLeftCorner(3, kBands) = tristimulus;
  system.topRightCorner(kBands, 3) = tristimulus.transpose();
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kBands + 3);
  right.tail<3>() = values;
  return system.fullPivLu().solve(right).head(kBands);
}

Eigen::VectorXd FlashSpectrum(const std::string& name) {
  if (name == "xenon") return Sampled([](double l) { return BlackBody(l, 5600); });
  if (name == "tungsten") return Sampled([](double l) { return BlackBody(l, 2856); });
  if (name == "warm LED") {
    return Sampled([](double l) { return 0.3 * Bell(l, 452, 10, 12) + Bell(l, 595, 52, 58); });
  }
  // A white LED: a blue chip and a phosphor.
  return Sampled([](double l) { return 0.9 * Bell(l, 452, 10, 12) + Bell(l, 570, 45, 62); });
}

Eigen::Matrix<double, 3, kBands> Sensitivities(const std::string& name) {
  Eigen::Matrix<double, 3, kBands> rows;
  const auto set = [&](int c, const std::function<double(double)>& of_nm) {
    rows.row(c) = Sampled(of_nm).transpose();
  };
  if (name == "narrow") {
    set(0, [](double l) { return Bell(l, 602, 28, 30); });
    set(1, [](double l) { return Bell(l, 537, 32, 34); });
    set(2, [](double l) { return Bell(l, 458, 24, 28); });
  } else if (name == "wide") {
    set(0, [](double l) { return Bell(l, 598, 36, 38) + 0.08 * Bell(l, 450, 20, 30); });
    set(1, [](double l) { return Bell(l, 532, 40, 44); });
    set(2, [](double l) { return Bell(l, 462, 30, 36); });
  } else {
    set(0, [](double l) { return Bell(l, 595, 30, 42) + 0.15 * Bell(l, 500, 40, 40); });
    set(1, [](double l) { return Bell(l, 530, 36, 48) + 0.1 * Bell(l, 460, 30, 30); });
    set(2, [](double l) { return Bell(l, 455, 24, 32) + 0.1 * Bell(l, 530, 30, 30); });
  }
  return rows;
}

}  // namespace

std::vector<std::string> SpectralFlashes() { return {"xenon", "LED", "warm LED"}; }
std::vector<std::string> SpectralCameras() { return {"narrow", "wide", "leaky"}; }

std::vector<Eigen::VectorXd> SmoothReflectances(Chart* chart) {
  const Eigen::Matrix<double, 3, kBands> relative = RelativeXyz();
  const Eigen::Vector3d white = *WhitePoint("D50");
  std::vector<Eigen::VectorXd> reflectances;
  for (ChartPatch& patch : chart->patches) {
    const Eigen::Vector3d values = XyzFromLab(patch.lab, white).cwiseQuotient(white);
    Eigen::VectorXd spectrum = Smoothest(relative, values);
    spectrum = spectrum.cwiseMax(0.005).cwiseMin(1.0);
    patch.lab = LabFromXyz((relative * spectrum).cwiseProduct(white), white);
    reflectances.push_back(spectrum);
  }
  return reflectances;
}

std::vector<PatchReading> SpectralReadings(const Chart& chart,
                                           const std::vector<Eigen::VectorXd>& reflectances,
                                           const std::string& flash, const std::string& camera) {
  Eigen::Matrix<double, 3, kBands> rows = Sensitivities(camera) * FlashSpectrum(flash).asDiagonal();
  rows = rows.rowwise().sum().cwiseInverse().asDiagonal() * rows;
  ChartShot shot;
  shot.flash = {0.1, -0.2, 1.7};
  Random random(5);
  std::vector<PatchReading> readings;
  for (size_t i = 0; i < reflectances.size(); ++i) {
    const double light = 0.85 * FlashAt(shot, chart.FromMiddle(chart.patches[i].centre));
    PatchReading& reading = readings.emplace_back();
    reading.pixels = 400;
    for (int c = 0; c < 3; ++c) {
      const double linear =
          light * rows.row(c).dot(reflectances[i]) * (1 + 0.005 * random.Normal());
      reading.rgb[c] = std::pow(std::round(255 * std::pow(linear, 1 / 2.2)) / 255, 2.2);
    }
  }
  return readings;
}

}  // namespace glint::testing
