#include "fitting/refine/gather.h"

#include <algorithm>
#include <utility>

#include "base/model/photographs.h"
#include "base/reflectance/texel_at.h"

namespace glint {

namespace {

struct Seen {
  float radiance[3];
  bool clipped[3];
};

// False: it does not see the texel.
bool See(const RefineView& view, size_t texels, size_t texel, Seen* seen) {
  if (!(view.mask[texel] >= 0.5f)) return false;
  const std::span<const float> target = view.deblurred.empty() ? view.rgb : view.deblurred;
  for (size_t c = 0; c < 3; ++c) {
    seen->radiance[c] = std::max(target[c * texels + texel], 0.0f);
    seen->clipped[c] = view.ldr && static_cast<double>(view.rgb[c * texels + texel]) >=
                                       constants::kClippedRadiance;
  }
  return true;
}

struct Place {
  double x_mm, y_mm;
};

Place PlaceOf(const SamplePlane& plane, size_t texel) {
  const int width = plane.width;
  return {plane.x_mm(static_cast<int>(texel) % width), plane.y_mm(static_cast<int>(texel) / width)};
}

}  // namespace

void GatherObservations(const RefineProblem& problem, const SvbrdfMaps& maps,
                        std::span<const size_t> texels, std::span<const int> views,
                        BatchObservations* observations) {
  observations->Clear(static_cast<int>(views.size()));
  for (size_t i = 0; i < texels.size(); ++i) {
    const Place place = PlaceOf(problem.plane, texels[i]);
    observations->Place(static_cast<int>(i), place.x_mm, place.y_mm);
  }
  for (size_t k = 0; k < views.size(); ++k) {
    const RefineView& view = problem.views[static_cast<size_t>(views[k])];
    const int at = static_cast<int>(k);
    for (size_t i = 0; i < texels.size(); ++i) {
      Seen seen;
      if (!See(view, maps.texels(), texels[i], &seen)) continue;
      observations->Set(static_cast<int>(i), at, seen.radiance, seen.clipped, view.weight);
    }
    observations->Complete(at, BatchView(view.view, problem.convention.falloff));
  }
  if (!problem.environment.any()) return;
  for (size_t i = 0; i < texels.size(); ++i) {
    const Place place = PlaceOf(problem.plane, texels[i]);
    const EnvironmentReflection reflection(TexelAt(maps, texels[i]));
    for (size_t k = 0; k < views.size(); ++k) {
      const View& view = problem.views[static_cast<size_t>(views[k])].view;
      TexelGeometry<double> geometry =
          TexelGeometryInView<double>(view, problem.convention.falloff, place.x_mm, place.y_mm);
      reflection.AddTo(problem.environment, view.exposure, &geometry);
      observations->SetAmbient(static_cast<int>(i), static_cast<int>(k), geometry.ambient,
                               geometry.ambient_specular);
    }
  }
}

GatheredObservations::GatheredObservations(const RefineProblem& problem, const SvbrdfMaps& maps)
    : problem_(problem), maps_(maps) {}

const BatchObservations& GatheredObservations::Of(std::span<const size_t> texels,
                                                  std::span<const int> views,
                                                  BatchObservations* buffer) {
  const size_t bytes = views.size() * BatchObservations::kPlanes * sizeof(BatchRow);
  Key key{{texels.begin(), texels.end()}, {views.begin(), views.end()}};
  bool keeps = true;
  {
    const std::lock_guard lock(mutex_);
    const auto kept = kept_.find(key);
    if (kept != kept_.end()) return *kept->second;
    keeps = bytes_ + bytes <= kMostBytes;
    if (keeps) bytes_ += bytes;
  }
  if (!keeps) {
    GatherObservations(problem_, maps_, texels, views, buffer);
    return *buffer;
  }
  auto gathered = std::make_unique<BatchObservations>(static_cast<int>(views.size()));
  GatherObservations(problem_, maps_, texels, views, gathered.get());
  const std::lock_guard lock(mutex_);
  return *kept_.emplace(std::move(key), std::move(gathered)).first->second;
}

void GatheredObservations::Forget() {
  const std::lock_guard lock(mutex_);
  kept_.clear();
  bytes_ = 0;
}

}  // namespace glint
