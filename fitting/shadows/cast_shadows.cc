#include "fitting/shadows/cast_shadows.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "base/parallel/parallel.h"

namespace glint {
namespace {

constexpr double kIndirect = 0.2;     // of what a texel would receive, that it does in shadow
constexpr double kLeastScale = 0.05;  // of the residuals of a matte texel, by its albedo
constexpr double kGrazing = 0.05;     // cosine; a texel turned farther away is dark by itself
constexpr double kMostSure = 0.99;    // of a shadow, by heights alone: initial maps may be wrong
constexpr int kRounds = 3;            // of weights, each of high lights and of all
constexpr double kMostSlope = 1;      // that one texel counts with
constexpr size_t kMostForSlopes = 16384;  // texels: their mean square to a hundredth

// What one texel shows under each light.
struct Seen {
  Eigen::Vector3f light;
  float value;  // radiance by irradiance
  size_t view;
};

class MatteTexel {
 public:
  // The lights of `order` (views, highest first) that show it.
  MatteTexel(const PhotographSet& set, const std::vector<size_t>& order)
      : set_(set), order_(order), falls_(set.convention.falloff == LightFalloff::kInverseSquare) {
    for (const Photograph& photograph : set.photographs) {
      const Vec3d& rgb = photograph.view.light_rgb;
      power_.push_back(static_cast<float>(photograph.view.exposure * (rgb[0] + rgb[1] + rgb[2])));
    }
    seen_.reserve(order.size());
    off_.reserve(order.size());
  }

  // False where too few photographs show it.
  bool Solve(size_t texel) {
    Look(texel);
    if (seen_.size() < kFewestForShadows) return false;
    const size_t high = std::max(kFewestForShadows, seen_.size() / 2);
    weights_.assign(seen_.size(), 1.0f);
    for (const size_t count : {high, seen_.size()}) {
      for (int round = 0; round < kRounds; ++round) {
        SolveFrom(count);
        Weigh(count);
      }
    }
    return albedo() > 0;
  }

  const std::vector<Seen>& seen() const { return seen_; }
  float Expected(const Seen& seen) const { return normal_.dot(seen.light); }
  bool IsTurnedAway(const Seen& seen) const {
    return Expected(seen) < static_cast<float>(kGrazing) * albedo();
  }
  // What it shows of what is expected.
  float Share(const Seen& seen) const { return seen.value / std::max(Dark(), Expected(seen)); }
  float albedo() const { return normal_.norm(); }
  const Eigen::Vector3f& normal() const { return normal_; }  // times the albedo
  // By how much it departs from what is expected, relative to that, and the scale of such.
  float Off(const Seen& seen) const {
    const float expected = std::max(0.0f, Expected(seen));
    return (seen.value - expected) / (expected + Dark());
  }
  float scale() const { return scale_; }

 private:
  void Look(size_t texel) {
    seen_.clear();
    const SamplePlane& plane = set_.plane;
    const int column = static_cast<int>(texel) % plane.width;
    const int row = static_cast<int>(texel) / plane.width;
    const size_t texels = static_cast<size_t>(plane.width) * plane.height;
    for (const size_t v : order_) {
      const Photograph& photograph = set_.photographs[v];
      if (!(photograph.mask[texel] >= 0.5f)) continue;
      const View& view = photograph.view;
      const Vec3d& from = view.light_in_sample_mm;
      const Eigen::Vector3f to(static_cast<float>(from[0] - plane.x_mm(column)),
                               static_cast<float>(from[1] - plane.y_mm(row)),
                               static_cast<float>(from[2]));
      const float square = falls_ ? to.squaredNorm() : 1.0f;
      float radiance = 0;
      for (size_t c = 0; c < 3; ++c) radiance += photograph.rgb[c * texels + texel];
      seen_.push_back({to.normalized(), radiance * square / power_[v], v});
    }
  }

  float Dark() const { return static_cast<float>(kGrazing) * albedo() + 1e-6f; }

  void SolveFrom(size_t count) {
    Eigen::Matrix3f products = Eigen::Matrix3f::Identity() * 1e-6f;
    Eigen::Vector3f right = Eigen::Vector3f::Zero();
    for (size_t i = 0; i < count; ++i) {
      const Eigen::Vector3f weighted = weights_[i] * seen_[i].light;
      products += weighted * seen_[i].light.transpose();
      right += seen_[i].value * weighted;
    }
    normal_ = products.ldlt().solve(right);
  }

  // By the texel's own scale among the first `count`.
  void Weigh(size_t count) {
    off_.clear();
    for (size_t i = 0; i < count; ++i) off_.push_back(std::abs(Off(seen_[i])));
    const auto middle = off_.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(off_.begin(), middle, off_.end());
    scale_ = std::max(static_cast<float>(kLeastScale), 1.4826f * *middle);
    for (size_t i = 0; i < seen_.size(); ++i) {
      const float off = Off(seen_[i]) / scale_, expected = Expected(seen_[i]);
      const float unit = expected + Dark();
      weights_[i] = expected > 0 ? 1 / (unit * unit * (1 + off * off)) : 0.0f;
    }
  }

  const PhotographSet& set_;
  const std::vector<size_t>& order_;
  const bool falls_;
  std::vector<float> power_;  // of all channels together, exposed
  std::vector<Seen> seen_;
  std::vector<float> weights_, off_;
  Eigen::Vector3f normal_ = Eigen::Vector3f::Zero();
  float scale_ = 0;
};

double ElevationTangent(const View& view) {
  const Vec3d& light = view.light_in_sample_mm;
  return light[2] / std::max(1e-9, std::hypot(light[0], light[1]));
}

std::vector<size_t> HighestFirst(const PhotographSet& set) {
  std::vector<size_t> order(set.photographs.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return ElevationTangent(set.photographs[a].view) > ElevationTangent(set.photographs[b].view);
  });
  return order;
}

// Whether a texel that shows `share` of what it should rather lies in shadow; `scale`: of what lit
// ones show about 1.
bool InShadow(double share, double scale, double shadowed_share) {
  const double dark = share / kIndirect;
  const double shadow = std::sqrt(2 / std::numbers::pi) / kIndirect * std::exp(-dark * dark / 2);
  const double off = (share - 1) / scale;
  const double lit = 1 / (std::numbers::pi * scale * (1 + off * off));
  return shadowed_share * shadow > (1 - shadowed_share) * lit;
}

}  // namespace

double ShadowedShare(double elevation_tangent, double relief_slope_sd) {
  if (!(relief_slope_sd > 0)) return 0;
  const double nu = elevation_tangent / (std::numbers::sqrt2 * relief_slope_sd);
  const double lambda =
      (std::exp(-nu * nu) / (nu * std::sqrt(std::numbers::pi)) - std::erfc(nu)) / 2;
  return std::max(0.0, lambda) / (1 + std::max(0.0, lambda));
}

double ReliefSlopeSd(const PhotographSet& set, int threads) {
  if (set.photographs.size() < kFewestForShadows) return 0;
  const size_t texels = static_cast<size_t>(set.plane.width) * set.plane.height;
  const size_t count = std::min(texels, kMostForSlopes);
  const std::vector<size_t> order = HighestFirst(set);
  std::vector<std::array<double, 2>> slopes(count, {std::nan(""), 0});
  ForEachBlock(static_cast<int>(count), 256, threads, [&](int begin, int end) {
    MatteTexel texel(set, order);
    for (int i = begin; i < end; ++i) {
      const size_t at = (2 * static_cast<size_t>(i) + 1) * texels / (2 * count);
      if (!texel.Solve(at) || !(texel.normal().z() > 0)) continue;
      const Eigen::Vector3f& normal = texel.normal();
      slopes[static_cast<size_t>(i)] = {normal.x() / normal.z(), normal.y() / normal.z()};
    }
  });
  double squares = 0, known = 0;
  for (const auto& slope : slopes) {
    if (std::isnan(slope[0])) continue;
    // Where a texel is not matte its slope may be any.
    squares += std::min(slope[0] * slope[0] + slope[1] * slope[1], kMostSlope * kMostSlope);
    known += 1;
  }
  return known > 0 ? std::sqrt(squares / (2 * known)) : 0;
}

void MaskCastShadows(const HidingRelief& relief, int threads, PhotographSet* set) {
  if (set->photographs.size() < kFewestForShadows) return;
  const std::vector<size_t> order = HighestFirst(*set);
  std::vector<double> by_finer;
  for (const Photograph& photograph : set->photographs) {
    by_finer.push_back(ShadowedShare(ElevationTangent(photograph.view), relief.finer_slope_sd));
  }
  const SamplePlane& plane = set->plane;
  ForEachBlock(plane.width * plane.height, 1024, threads, [&](int begin, int end) {
    MatteTexel texel(*set, order);
    for (int i = begin; i < end; ++i) {
      if (!texel.Solve(static_cast<size_t>(i))) continue;
      const double x_mm = plane.x_mm(i % plane.width), y_mm = plane.y_mm(i / plane.width);
      for (const Seen& seen : texel.seen()) {
        Photograph& photograph = set->photographs[seen.view];
        const double by_heights =
            relief.horizon.HiddenShare(x_mm, y_mm, photograph.view.light_in_sample_mm);
        // What is finer hides lit texels; one that is turned away is dark by itself.
        const double by_what_is_finer = texel.IsTurnedAway(seen) ? 0 : by_finer[seen.view];
        const double hidden = std::min(kMostSure, by_heights + (1 - by_heights) * by_what_is_finer);
        if (InShadow(texel.Share(seen), texel.scale(), hidden)) {
          photograph.mask[static_cast<size_t>(i)] = 0.0f;
        }
      }
    }
  });
}

}  // namespace glint
