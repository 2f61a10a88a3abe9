#include "calib/corners/saddle.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "calib/corners/damped_descent.h"

namespace glint {
namespace {

enum Parameter {
  kCx,
  kCy,
  kTurn1,
  kTurn2,
  kLogBlur,
  kMean,
  kRampX,
  kRampY,
  kContrast,
  kGainX,
  kGainY
};
constexpr int kAll = 11;
constexpr int kWithoutGain = 9;  // too few pixels to tell b from the rest

// A pixel averages over its area, so that no edge is sharper than a box one pixel wide, whose
// standard deviation this is. Sharper models have no slope at any pixel's centre, and so no
// optimum.
constexpr double kLeastBlur_px = 0.29;

using Vector = Eigen::Matrix<double, kAll, 1>;
using Matrix = Eigen::Matrix<double, kAll, kAll>;

struct Pixel {
  double x, y, value, weight;
};

struct Window {
  std::vector<Pixel> pixels;
  double radius_px = 0;
};

// The model at given parameters. Ramps are per window radius, so that all parameters are of one
// size.
class CornerModel {
 public:
  CornerModel(const Vector& p, double radius)
      : p_(p),
        radius_(radius),
        scale_(1.0 / (std::sqrt(2.0) * std::exp(p[kLogBlur]))),
        c1_(std::cos(p[kTurn1])),
        s1_(std::sin(p[kTurn1])),
        c2_(std::cos(p[kTurn2])),
        s2_(std::sin(p[kTurn2])) {}

  // The value at a pixel and, unless null, its gradient.
  double At(double x, double y, Vector* gradient) const {
    const double dx = x - p_[kCx], dy = y - p_[kCy];
    const double d1 = c1_ * dx + s1_ * dy, d2 = c2_ * dx + s2_ * dy;
    const double e1 = std::erf(d1 * scale_), e2 = std::erf(d2 * scale_);
    const double ux = dx / radius_, uy = dy / radius_;
    const double gain = p_[kContrast] + p_[kGainX] * ux + p_[kGainY] * uy;
    if (gradient != nullptr) {
      const double slope = 2.0 / std::sqrt(std::numbers::pi) * scale_;
      const double g1 = slope * std::exp(-d1 * d1 * scale_ * scale_) * e2 * gain;
      const double g2 = slope * std::exp(-d2 * d2 * scale_ * scale_) * e1 * gain;
      Vector& g = *gradient;
      g[kCx] = -(p_[kRampX] + p_[kGainX] * e1 * e2) / radius_ - c1_ * g1 - c2_ * g2;
      g[kCy] = -(p_[kRampY] + p_[kGainY] * e1 * e2) / radius_ - s1_ * g1 - s2_ * g2;
      g[kTurn1] = g1 * (c1_ * dy - s1_ * dx);
      g[kTurn2] = g2 * (c2_ * dy - s2_ * dx);
      g[kLogBlur] = -(d1 * g1 + d2 * g2);
      g[kMean] = 1;
      g[kRampX] = ux;
      g[kRampY] = uy;
      g[kContrast] = e1 * e2;
      g[kGainX] = ux * e1 * e2;
      g[kGainY] = uy * e1 * e2;
    }
    return p_[kMean] + p_[kRampX] * ux + p_[kRampY] * uy + gain * e1 * e2;
  }

 private:
  const Vector& p_;
  double radius_, scale_, c1_, s1_, c2_, s2_;
};

double SumOfSquares(const Window& window, const Vector& p) {
  const CornerModel model(p, window.radius_px);
  double sum = 0;
  for (const Pixel& pixel : window.pixels) {
    const double r = model.At(pixel.x, pixel.y, nullptr) - pixel.value;
    sum += pixel.weight * r * r;
  }
  return sum;
}

// Normal equations; parameters from `active` on, and those of `frozen`, stay as they are.
void Normal(const Window& window, const Vector& p, int active, Matrix* jtj, Vector* jtr) {
  jtj->setZero();
  jtr->setZero();
  const CornerModel model(p, window.radius_px);
  Vector g;
  for (const Pixel& pixel : window.pixels) {
    const double r = model.At(pixel.x, pixel.y, &g) - pixel.value;
    jtj->selfadjointView<Eigen::Lower>().rankUpdate(g, pixel.weight);
    *jtr += pixel.weight * r * g;
  }
  *jtj = jtj->selfadjointView<Eigen::Lower>();
  HoldFrom(active, jtj, jtr);
}

// Pixels in the ellipse of the guess, clipped at the image's edge. Weights fade toward the rim:
// which pixels it happens to cut must not matter.
Window CollectPixels(const GrayImage& image, const SaddleGuess& guess, double max_radius_px) {
  Window window;
  Eigen::Matrix2d px_from_squares;
  px_from_squares << guess.column_px, guess.row_px;
  const double longest = std::max(guess.column_px.norm(), guess.row_px.norm());
  const double squares = std::min(guess.radius_squares, max_radius_px / longest);
  const Eigen::Matrix2d squares_from_px = px_from_squares.inverse();
  window.radius_px = squares * longest;
  const int reach = static_cast<int>(std::ceil(1.5 * window.radius_px)) + 1;
  const int column0 = static_cast<int>(std::floor(guess.centre_px.x()));
  const int row0 = static_cast<int>(std::floor(guess.centre_px.y()));
  for (int row = std::max(0, row0 - reach); row <= std::min(image.height - 1, row0 + reach);
       ++row) {
    for (int column = std::max(0, column0 - reach);
         column <= std::min(image.width - 1, column0 + reach); ++column) {
      const Eigen::Vector2d offset(column + 0.5 - guess.centre_px.x(),
                                   row + 0.5 - guess.centre_px.y());
      const double rim = 1 - (squares_from_px * offset).squaredNorm() / (squares * squares);
      if (rim <= 0) continue;
      window.pixels.push_back({column + 0.5, row + 0.5, static_cast<double>(image.at(column, row)),
                               std::min(1.0, 2 * rim)});
    }
  }
  return window;
}

// Angle of the normal to `edge` that points to the side of `toward`.
double NormalAngle(const Eigen::Vector2d& edge, const Eigen::Vector2d& toward) {
  Eigen::Vector2d normal(-edge.y(), edge.x());
  if (normal.dot(toward) < 0) normal = -normal;
  return std::atan2(normal.y(), normal.x());
}

Vector Start(const Window& window, const SaddleGuess& guess) {
  Vector p = Vector::Zero();
  p[kCx] = guess.centre_px.x();
  p[kCy] = guess.centre_px.y();
  p[kTurn1] = NormalAngle(guess.row_px, guess.column_px);
  p[kTurn2] = NormalAngle(guess.column_px, guess.row_px);
  p[kLogBlur] = std::log(std::clamp(0.3 * window.radius_px, 1.0, 4.0));
  double mean = 0, spread = 0;
  double total = 0;
  for (const Pixel& pixel : window.pixels) {
    mean += pixel.weight * pixel.value;
    total += pixel.weight;
  }
  mean /= total;
  for (const Pixel& pixel : window.pixels) spread += pixel.weight * std::abs(pixel.value - mean);
  p[kMean] = mean;
  // Same sign of both distances: the squares at the top left and the bottom right.
  p[kContrast] = (guess.top_left_is_black ? -1 : 1) * spread / total;
  return p;
}

bool Minimize(const Window& window, int active, Vector* p) {
  return MinimizeDamped<kAll>(
      [&](const Vector& trial) { return SumOfSquares(window, trial); },
      [&](const Vector& at, Matrix* jtj, Vector* jtr) { Normal(window, at, active, jtj, jtr); },
      [&](Vector* trial) {
        (*trial)[kLogBlur] =
            std::clamp((*trial)[kLogBlur], std::log(kLeastBlur_px), std::log(window.radius_px));
      },
      [](const Vector& delta) { return delta.head<2>().norm() < 1e-5; }, p);
}

// Mean residuals of eight sectors round the centre; what hides a part of a corner stands out.
double WorstSector(const Window& window, const Vector& p) {
  const CornerModel model(p, window.radius_px);
  std::array<double, 8> sum{}, count{};
  for (const Pixel& pixel : window.pixels) {
    const double angle = std::atan2(pixel.y - p[kCy], pixel.x - p[kCx]);
    const int sector =
        std::clamp(static_cast<int>((angle + std::numbers::pi) / (2 * std::numbers::pi) * 8), 0, 7);
    sum[sector] += pixel.weight * (pixel.value - model.At(pixel.x, pixel.y, nullptr));
    count[sector] += pixel.weight;
  }
  double worst = 0;
  for (int i = 0; i < 8; ++i) {
    if (count[i] > 0) worst = std::max(worst, std::abs(sum[i] / count[i]));
  }
  return worst;
}

double TurnDegrees(double a, double b) {
  return std::abs(std::remainder(a - b, 2 * std::numbers::pi)) * 180.0 / std::numbers::pi;
}

}  // namespace

SaddleFit FitSaddle(const GrayImage& image, const SaddleGuess& guess,
                    const SaddleOptions& options) {
  SaddleFit fit;
  const double cross =
      std::abs(guess.column_px.x() * guess.row_px.y() - guess.column_px.y() * guess.row_px.x());
  const double shortest = std::min(guess.column_px.norm(), guess.row_px.norm());
  const double longest = std::max(guess.column_px.norm(), guess.row_px.norm());
  // Squares seen at a grazing angle have no corners to speak of.
  if (!guess.centre_px.allFinite() || !(longest < 1e5) || !(cross > 0.05 * longest * longest)) {
    return fit;
  }
  if (guess.radius_squares * shortest < options.min_radius_px) return fit;
  if (!(guess.centre_px.x() > 1 && guess.centre_px.y() > 1 &&
        guess.centre_px.x() < image.width - 1 && guess.centre_px.y() < image.height - 1)) {
    return fit;
  }
  SaddleGuess at = guess;
  Vector p;
  Window window;
  // The window follows the centre: one cut askew would pull the centre toward its middle.
  constexpr int kMaxRounds = 4;
  for (int round = 0; round < kMaxRounds; ++round) {
    window = CollectPixels(image, at, options.max_radius_px);
    // Half of the ellipse must lie in the image.
    const double area =
        std::numbers::pi * window.radius_px * window.radius_px * cross / (longest * longest);
    if (static_cast<double>(window.pixels.size()) < std::max(16.0, 0.6 * area)) return fit;
    const int active = window.pixels.size() < 60 ? kWithoutGain : kAll;
    if (round == 0) p = Start(window, at);
    if (!Minimize(window, active, &p)) return fit;
    const double step_px = (p.head<2>() - at.centre_px).norm();
    at.centre_px = p.head<2>();
    if (!((at.centre_px - guess.centre_px).norm() < options.max_shift_squares * shortest)) {
      return fit;
    }
    if (step_px < 0.02) break;
  }
  const double turn1 = TurnDegrees(p[kTurn1], NormalAngle(guess.row_px, guess.column_px));
  const double turn2 = TurnDegrees(p[kTurn2], NormalAngle(guess.column_px, guess.row_px));
  const int active = window.pixels.size() < 60 ? kWithoutGain : kAll;
  Matrix jtj;
  Vector jtr;
  Normal(window, p, active, &jtj, &jtr);
  const double cost = SumOfSquares(window, p);
  double freedom = -active;
  for (const Pixel& pixel : window.pixels) freedom += pixel.weight;
  freedom = std::max(1.0, freedom);
  const Matrix covariance = jtj.inverse() * (cost / freedom);

  fit.centre_px = p.head<2>();
  fit.contrast = (guess.top_left_is_black ? -1 : 1) * p[kContrast];  // negative: inverted
  fit.blur_px = std::exp(p[kLogBlur]);
  fit.residual = std::sqrt(cost / freedom) / std::abs(p[kContrast]);
  fit.worst_sector = WorstSector(window, p) / std::abs(p[kContrast]);
  fit.sigma_px = std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1)));
  // Light that falls off steeply over a few pixels is something that hides a part.
  const double contrast = std::abs(p[kContrast]);
  const bool even = std::hypot(p[kGainX], p[kGainY]) <= options.max_gain * contrast &&
                    std::hypot(p[kRampX], p[kRampY]) <= options.max_ramp * contrast;
  fit.ok = even && fit.contrast >= options.min_contrast && fit.residual <= options.max_residual &&
           fit.worst_sector <= options.max_sector_residual &&
           fit.sigma_px <= options.max_sigma_px && fit.blur_px < 0.7 * window.radius_px &&
           turn1 <= options.max_turn_deg && turn2 <= options.max_turn_deg;
  return fit;
}

}  // namespace glint
