#include "calib/corners/marker_outline.h"

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

// Parameters: corners x0 y0 … x3 y3, log σ, paper p0 and its slopes (per half side), ink, bulges.
enum Parameter { kLogBlur = 8, kPaper, kSlopeX, kSlopeY, kInk, kBulge };
constexpr int kAll = 17;
constexpr int kWithoutBulge = 13;
constexpr double kBulgeSide_px = 40;    // shorter sides are taken to be straight
constexpr double kLeastBlur_px = 0.29;  // see saddle.cc
constexpr int kSegments = 8;            // a side

using Vector = Eigen::Matrix<double, kAll, 1>;
using Matrix = Eigen::Matrix<double, kAll, kAll>;

struct Pixel {
  double x, y, value, weight;
  int segment;  // of the outline, kSegments a side
};

struct Band {
  std::vector<Pixel> pixels;
  Eigen::Vector2d centre_px{0, 0};
  double half_side_px = 1;
  int active = kAll;
};

const std::array<double, 256>& LinearLevels() {
  static const std::array<double, 256> levels = [] {
    std::array<double, 256> table{};
    for (size_t i = 0; i < table.size(); ++i)
      table[i] = std::pow(static_cast<double>(i) / 255, 2.2);
    return table;
  }();
  return levels;
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Distance to side i, positive inside, and how it depends on the side's two corners and its bulge.
struct SideDistance {
  double value = 0;
  Eigen::Vector2d by_start, by_end;
  double by_bulge = 0;
};

SideDistance DistanceToSide(const Eigen::Vector2d& start, const Eigen::Vector2d& end, double bulge,
                            const Eigen::Vector2d& x) {
  const Eigen::Vector2d side = end - start, from = x - start;
  const double length = side.norm();
  const Eigen::Vector2d along = side / length;
  const double t = std::clamp(along.dot(from) / length, 0.0, 1.0);
  SideDistance d;
  // Clockwise with y down: inside is to the right of the way, where this cross product is positive.
  const double straight = Cross(along, from);
  d.by_bulge = 4 * t * (1 - t);
  d.value = straight + bulge * d.by_bulge;
  // The line turns about its other end. The unclamped t keeps this exact beyond the corners.
  const double u = along.dot(from) / length;
  const Eigen::Vector2d normal(-along.y(), along.x());  // toward the inside
  d.by_start = -(1 - u) * normal;
  d.by_end = -u * normal;
  return d;
}

double Evaluate(const Vector& p, const Band& band, double x, double y, Vector* gradient) {
  const double blur = std::exp(p[kLogBlur]);
  const double ux = (x - band.centre_px.x()) / band.half_side_px;
  const double uy = (y - band.centre_px.y()) / band.half_side_px;
  const double paper = p[kPaper] + p[kSlopeX] * ux + p[kSlopeY] * uy;
  std::array<SideDistance, 4> sides;
  std::array<double, 4> step;
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    sides[i] = DistanceToSide(p.segment<2>(2 * i), p.segment<2>(2 * j), p[kBulge + i], {x, y});
    step[i] = 0.5 * std::erfc(-sides[i].value / (blur * std::numbers::sqrt2));
  }
  const double covered = step[0] * step[1] * step[2] * step[3];
  if (gradient != nullptr) {
    Vector& g = *gradient;
    g.setZero();
    for (int i = 0; i < 4; ++i) {
      const int j = (i + 1) % 4;
      const double z = sides[i].value / blur;
      if (std::abs(z) > 6) continue;
      const double others = step[(i + 1) % 4] * step[(i + 2) % 4] * step[(i + 3) % 4];
      const double slope = (p[kInk] - paper) * others * std::exp(-0.5 * z * z) /
                           (blur * std::sqrt(2 * std::numbers::pi));
      g.segment<2>(2 * i) += slope * sides[i].by_start;
      g.segment<2>(2 * j) += slope * sides[i].by_end;
      g[kBulge + i] = slope * sides[i].by_bulge;
      g[kLogBlur] -= slope * sides[i].value;
    }
    g[kPaper] = 1 - covered;
    g[kSlopeX] = ux * (1 - covered);
    g[kSlopeY] = uy * (1 - covered);
    g[kInk] = covered;
  }
  return paper + (p[kInk] - paper) * covered;
}

// Pixels within the band round the quadrilateral: outside up to `outer`, inside up to `inner`.
// Weights fade toward both rims.
Band CollectPixels(const GrayImage& image, const Vector& p, double outer, double inner) {
  Band band;
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  double longest = 0;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d c = p.segment<2>(2 * i);
    band.centre_px += 0.25 * c;
    low = low.cwiseMin(c);
    high = high.cwiseMax(c);
    longest = std::max(longest, (p.segment<2>(2 * ((i + 1) % 4)) - c).norm());
  }
  band.half_side_px = 0.5 * longest;
  const int x0 = std::max(0, static_cast<int>(low.x() - outer));
  const int y0 = std::max(0, static_cast<int>(low.y() - outer));
  const int x1 = std::min(image.width - 1, static_cast<int>(high.x() + outer));
  const int y1 = std::min(image.height - 1, static_cast<int>(high.y() + outer));
  for (int row = y0; row <= y1; ++row) {
    for (int column = x0; column <= x1; ++column) {
      const Eigen::Vector2d at(column + 0.5, row + 0.5);
      double nearest = 1e9;
      int side = 0;
      for (int i = 0; i < 4; ++i) {
        const auto d =
            DistanceToSide(p.segment<2>(2 * i), p.segment<2>(2 * ((i + 1) % 4)), p[kBulge + i], at);
        if (d.value < nearest) {
          nearest = d.value;
          side = i;
        }
      }
      const double rim = nearest > 0 ? 1 - nearest / inner : 1 + nearest / outer;
      if (rim <= 0) continue;
      const Eigen::Vector2d start = p.segment<2>(2 * side);
      const Eigen::Vector2d way = Eigen::Vector2d(p.segment<2>(2 * ((side + 1) % 4))) - start;
      const double t = std::clamp(way.dot(at - start) / way.squaredNorm(), 0.0, 0.999);
      band.pixels.push_back({at.x(), at.y(), LinearLevels()[image.at(column, row)],
                             std::min(1.0, 3 * rim),
                             kSegments * side + static_cast<int>(kSegments * t)});
    }
  }
  return band;
}

double SumOfSquares(const Band& band, const Vector& p) {
  double sum = 0;
  for (const Pixel& pixel : band.pixels) {
    const double r = Evaluate(p, band, pixel.x, pixel.y, nullptr) - pixel.value;
    sum += pixel.weight * r * r;
  }
  return sum;
}

void Normal(const Band& band, const Vector& p, Matrix* jtj, Vector* jtr) {
  jtj->setZero();
  jtr->setZero();
  Vector g;
  for (const Pixel& pixel : band.pixels) {
    const double r = Evaluate(p, band, pixel.x, pixel.y, &g) - pixel.value;
    jtj->selfadjointView<Eigen::Lower>().rankUpdate(g, pixel.weight);
    *jtr += pixel.weight * r * g;
  }
  *jtj = jtj->selfadjointView<Eigen::Lower>();
  HoldFrom(band.active, jtj, jtr);
}

bool Minimize(const Band& band, double max_blur_px, Vector* p) {
  return MinimizeDamped<kAll>(
      [&](const Vector& trial) { return SumOfSquares(band, trial); },
      [&](const Vector& at, Matrix* jtj, Vector* jtr) { Normal(band, at, jtj, jtr); },
      [&](Vector* trial) {
        (*trial)[kLogBlur] =
            std::clamp((*trial)[kLogBlur], std::log(kLeastBlur_px), std::log(max_blur_px));
      },
      [](const Vector& delta) { return delta.head<8>().cwiseAbs().maxCoeff() < 1e-5; }, p);
}

// Paper and ink from the pixels that lie clearly on either side.
void StartLevels(const Band& band, double blur_px, Vector* p) {
  double sum[2] = {0, 0}, count[2] = {0, 0};
  for (const Pixel& pixel : band.pixels) {
    double nearest = 1e9;
    for (int i = 0; i < 4; ++i) {
      nearest =
          std::min(nearest, DistanceToSide(p->segment<2>(2 * i), p->segment<2>(2 * ((i + 1) % 4)),
                                           0, {pixel.x, pixel.y})
                                .value);
    }
    if (std::abs(nearest) < blur_px) continue;
    sum[nearest > 0] += pixel.value;
    count[nearest > 0] += 1;
  }
  (*p)[kPaper] = count[0] > 0 ? sum[0] / count[0] : 0.5;
  (*p)[kInk] = count[1] > 0 ? sum[1] / count[1] : 0.0;
}

double WorstSegment(const Band& band, const Vector& p) {
  std::array<double, 4 * kSegments> sum{}, count{};
  for (const Pixel& pixel : band.pixels) {
    const double r = pixel.value - Evaluate(p, band, pixel.x, pixel.y, nullptr);
    sum[pixel.segment] += pixel.weight * r;
    count[pixel.segment] += pixel.weight;
  }
  double worst = 0;
  for (size_t i = 0; i < sum.size(); ++i) {
    if (count[i] > 0) worst = std::max(worst, std::abs(sum[i] / count[i]));
  }
  return worst;
}

// Whether the outline and its band lie in the picture.
bool InPicture(const GrayImage& image, const Vector& p, double outer) {
  for (int i = 0; i < 4; ++i) {
    const double x = p[2 * i], y = p[2 * i + 1];
    if (!(x > outer && y > outer && x < image.width - outer && y < image.height - outer)) {
      return false;
    }
  }
  return true;
}

}  // namespace

OutlineFit FitOutline(const GrayImage& image, const Eigen::Vector2d guess_px[4], int cells,
                      const OutlineOptions& options) {
  OutlineFit fit;
  Vector p = Vector::Zero();
  double shortest = 1e9, longest = 0;
  for (int i = 0; i < 4; ++i) {
    if (!guess_px[i].allFinite()) return fit;
    p.segment<2>(2 * i) = guess_px[i];
    const Eigen::Vector2d side = guess_px[(i + 1) % 4] - guess_px[i];
    // In turn and convex, seen from the front.
    if (!(Cross(side, guess_px[(i + 2) % 4] - guess_px[(i + 1) % 4]) > 0)) return fit;
    shortest = std::min(shortest, side.norm());
    longest = std::max(longest, side.norm());
  }
  const double cell_px = shortest / cells;
  if (!(cell_px >= options.min_cell_px) || !(longest < 1e5)) return fit;
  // The border is one cell wide, and so is at least the white round it.
  const double band_px = std::min(0.85 * cell_px, options.max_band_px);
  const double max_blur_px = 0.6 * band_px;
  p[kLogBlur] = std::log(std::clamp(0.3 * band_px, 0.5, max_blur_px));
  Band band;
  constexpr int kMaxRounds = 4;
  for (int round = 0; round < kMaxRounds; ++round) {
    if (!InPicture(image, p, 1.0)) return fit;
    band = CollectPixels(image, p, band_px, band_px);
    band.active = shortest >= kBulgeSide_px ? kAll : kWithoutBulge;
    if (band.pixels.size() < 60) return fit;
    if (round == 0) StartLevels(band, std::exp(p[kLogBlur]), &p);
    const Vector before = p;
    if (!Minimize(band, max_blur_px, &p)) return fit;
    for (int i = 0; i < 4; ++i) {
      const double shift = (p.segment<2>(2 * i) - guess_px[i]).norm();
      if (!(shift < options.max_shift_cells * longest / cells)) return fit;
    }
    if ((p - before).head<8>().cwiseAbs().maxCoeff() < 0.02) break;
  }
  Matrix jtj;
  Vector jtr;
  Normal(band, p, &jtj, &jtr);
  const double cost = SumOfSquares(band, p);
  double freedom = -band.active;
  for (const Pixel& pixel : band.pixels) freedom += pixel.weight;
  const Matrix covariance = jtj.inverse() * (cost / std::max(1.0, freedom));
  fit.contrast = p[kPaper] - p[kInk];
  fit.blur_px = std::exp(p[kLogBlur]);
  fit.residual = std::sqrt(cost / std::max(1.0, freedom)) / std::abs(fit.contrast);
  fit.ok = fit.contrast >= options.min_contrast && fit.residual <= options.max_residual &&
           WorstSegment(band, p) <= options.max_side_residual * fit.contrast &&
           fit.blur_px < 0.98 * max_blur_px;
  for (int i = 0; i < 4; ++i) {
    fit.corners_px[i] = p.segment<2>(2 * i);
    fit.sigma_px[i] =
        std::sqrt(0.5 * (covariance(2 * i, 2 * i) + covariance(2 * i + 1, 2 * i + 1)));
    fit.ok = fit.ok && fit.sigma_px[i] <= options.max_sigma_px;
  }
  return fit;
}

}  // namespace glint
