#include "fitting/texel/texel_batch.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/reflectance/log_radiance.h"
#include "fitting/texel/batch_kernel.h"

namespace glint {
namespace {

constexpr float kNoCeiling = 1e30f;

}  // namespace
void SetLane(int lane, const TexelValues& values, BatchValues* batch) {
  for (size_t i = 0; i < values.size(); ++i) batch->of[i][lane] = static_cast<float>(values[i]);
}

TexelValues ValuesOfLane(int lane, const BatchValues& batch) {
  TexelValues values;
  for (size_t i = 0; i < values.size(); ++i) values[i] = batch.of[i][lane];
  return values;
}

void BatchPrior::SetLane(int lane, const TexelPrior& prior) {
  for (int i = 0; i < kTexelParameters; ++i) {
    const size_t p = static_cast<size_t>(i);
    weight.of[p][lane] = static_cast<float>(std::sqrt(prior.weight(i)));
    mean.of[p][lane] =
        static_cast<float>(i < kSlopeX ? prior.mean()[p] : prior.mean_normal(i - kSlopeX));
  }
}

void BatchPrior::CopyLane(const BatchPrior& from, int from_lane, int lane) {
  for (int i = 0; i < kTexelParameters; ++i) {
    weight.of[i][lane] = from.weight.of[i][from_lane];
    mean.of[i][lane] = from.mean.of[i][from_lane];
  }
}

BatchView::BatchView(const View& view, LightFalloff falloff)
    : beam{static_cast<float>(view.beam[0]), static_cast<float>(view.beam[1])},
      inverse_square(falloff == LightFalloff::kInverseSquare) {
  for (size_t i = 0; i < 3; ++i) {
    camera_in_sample_mm[i] = static_cast<float>(view.camera_in_sample_mm[i]);
    light_in_sample_mm[i] = static_cast<float>(view.light_in_sample_mm[i]);
    exposed_light[i] = static_cast<float>(view.exposure * view.light_rgb[i]);
    exposed_ambient[i] = static_cast<float>(view.exposure * view.ambient_rgb[i]);
  }
}

BatchObservations::BatchObservations(int most_views)
    : rows_(static_cast<size_t>(most_views) * kPlanes) {}

void BatchObservations::Clear(int views) {
  assert(static_cast<size_t>(views) * kPlanes <= rows_.size());
  views_ = views;
  seen_.fill(0);
  for (BatchRow& row : place_mm_) row = BatchRow();
  for (int v = 0; v < views; ++v) {
    BatchRow* planes = view(v);
    std::fill_n(planes, static_cast<int>(kPlanes), BatchRow());
    // Any geometry and radiance that keep the arithmetic finite.
    for (const Plane plane : {kLightZ, kCameraZ, kHalfInverse}) {
      std::fill_n(planes[plane].lane, kBatch, 1.0f);
    }
    std::fill_n(planes[kInverseTarget].lane, 3 * kBatch, 1.0f);
  }
}

void BatchObservations::Place(int lane, double x_mm, double y_mm) {
  place_mm_[0][lane] = static_cast<float>(x_mm);
  place_mm_[1][lane] = static_cast<float>(y_mm);
}

// Radiances wait in the place of their inverses.
void BatchObservations::Set(int lane, int v, const float radiance[3], const bool clipped[3],
                            double weight) {
  BatchRow* planes = view(v);
  for (int i = 0; i < 3; ++i) {
    planes[kInverseTarget + i][lane] = radiance[i] + static_cast<float>(kLogOffset);
    planes[kCeiling + i][lane] = clipped[i] ? 0.0f : kNoCeiling;
  }
  planes[kWeight][lane] = static_cast<float>(weight);
  ++seen_[static_cast<size_t>(lane)];
}

void BatchObservations::Complete(int v, const BatchView& geometry) {
  kernel::BatchKernelFor(BestInstructionSet()).complete(geometry, place_mm_, view(v));
}

void BatchObservations::SetAmbient(int lane, int v, const double diffuse[3],
                                   const double specular[3]) {
  BatchRow* planes = view(v);
  for (int i = 0; i < 3; ++i) {
    planes[kAmbient + i][lane] = static_cast<float>(diffuse[i]);
    planes[kAmbientSpecular + i][lane] = static_cast<float>(specular[i]);
  }
}

void BatchObservations::CopyLane(const BatchObservations& from, int from_lane, int lane) {
  const int rows = views_ * kPlanes;
  for (int i = 0; i < rows; ++i) {
    rows_[static_cast<size_t>(i)][lane] = from.rows_[static_cast<size_t>(i)][from_lane];
  }
  seen_[static_cast<size_t>(lane)] = from.seen(from_lane);
}

void kernel::BatchSolution::CopyLane(const BatchSolution& from, int from_lane, int lane) {
  const auto copy = [&](const BatchRow& row, BatchRow* to) { (*to)[lane] = row[from_lane]; };
  for (int i = 0; i < kTexelParameters; ++i) {
    copy(from.values.of[i], &values.of[i]);
    copy(from.variables.of[i], &variables.of[i]);
    copy(from.least_diagonal.of[i], &least_diagonal.of[i]);
  }
  copy(from.start_cost, &start_cost);
  copy(from.cost, &cost);
  copy(from.damping, &damping);
  copy(from.growth, &growth);
  copy(from.iterations, &iterations);
  const LaneBits bit = 1u << lane;
  converged = (converged & ~bit) | ((from.converged >> from_lane & 1u) << lane);
  finished = (finished & ~bit) | ((from.finished >> from_lane & 1u) << lane);
}

TexelGram BatchResiduals::GramOf(int lane, int views) const {
  TexelGram gram{};
  for (int v = 0; v < views; ++v) {
    for (int c = 0; c < 3; ++c) {
      const std::pair<size_t, double> columns[] = {
          {DiffuseParameter(c), at(v, c, kByDiffuse, lane)},
          {SpecularParameter(c), at(v, c, kBySpecular, lane)},
          {kRough, at(v, c, kByRough, lane)},
          {kSlopeX, at(v, c, kBySlopeX, lane)},
          {kSlopeY, at(v, c, kBySlopeY, lane)},
          {kTexelParameters, at(v, c, kResidual, lane)}};
      for (size_t a = 0; a < std::size(columns); ++a) {
        for (size_t b = a; b < std::size(columns); ++b) {
          gram[columns[a].first][columns[b].first] += columns[a].second * columns[b].second;
        }
      }
    }
  }
  return gram;
}

}  // namespace glint
