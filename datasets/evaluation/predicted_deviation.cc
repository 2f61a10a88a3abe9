#include "datasets/evaluation/predicted_deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/errors/errors.h"
#include "base/formats/manifest.h"
#include "base/images/image.h"
#include "base/reflectance/log_radiance.h"
#include "fitting/view_correction/deviating_view.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// Channels of confidence.exr and the planes of the maps that they are deviations of.
struct StatedPlane {
  const char* channel;
  SvbrdfPlane plane;
};
constexpr std::array<StatedPlane, 9> kStated = {{{"normal.X", kNormalX},
                                                 {"normal.Y", kNormalY},
                                                 {"diffuse.R", kDiffuseR},
                                                 {"diffuse.G", kDiffuseG},
                                                 {"diffuse.B", kDiffuseB},
                                                 {"specular.R", kSpecularR},
                                                 {"specular.G", kSpecularG},
                                                 {"specular.B", kSpecularB},
                                                 {"roughness.Y", kRoughness}}};

// `maps` with one plane moved by `widths` of its deviations, within what reflectance can be.
SvbrdfMaps Moved(const SvbrdfMaps& maps, const StatedDeviations& stated, size_t index,
                 float widths) {
  constexpr float kLeastRoughness = 0.03f, kMostTilt = 0.99f;
  SvbrdfMaps moved = maps;
  const size_t texels = maps.texels();
  const SvbrdfPlane plane = kStated[index].plane;
  const bool normal = plane == kNormalX || plane == kNormalY;
  for (size_t t = 0; t < texels; ++t) {
    const float value = maps.plane(plane)[t] + widths * stated.planes[index * texels + t];
    if (!normal) {
      moved.plane(plane)[t] = std::clamp(value, plane == kRoughness ? kLeastRoughness : 0.0f, 1.0f);
      continue;
    }
    const float other = maps.plane(plane == kNormalX ? kNormalY : kNormalX)[t];
    const float most = std::sqrt(std::max(0.0f, kMostTilt * kMostTilt - other * other));
    const float tilted = std::clamp(value, -most, most);
    moved.plane(plane)[t] = tilted;
    moved.plane(kNormalZ)[t] = std::sqrt(std::max(1e-4f, 1 - tilted * tilted - other * other));
  }
  return moved;
}

double Log(float radiance, bool ldr) {
  const double shown = std::max(radiance, 0.0f);
  return std::log((ldr ? std::min(shown, 1.0) : shown) + kLogOffset);
}

}  // namespace

std::optional<StatedDeviations> ReadStatedDeviations(const fs::path& manifest) {
  const fs::path file = manifest.parent_path() / "confidence.exr";
  if (!fs::exists(file)) return std::nullopt;
  const Image image = ReadExr(file);
  StatedDeviations stated{image.width, image.height, {}, 0, 0, 0};
  for (const StatedPlane& plane : kStated) {
    const int index = image.ChannelIndex(plane.channel);
    if (index < 0) {
      throw UserError(file, plane.channel, "no such channel", "run glint-refine again");
    }
    const auto values = image.channel(index);
    stated.planes.insert(stated.planes.end(), values.begin(), values.end());
  }
  const Manifest refined = ReadManifest(manifest);
  stated.residual_deviation = refined.metrics.value("residual_deviation", 0.0);
  stated.exposure_spread = refined.metrics.value("exposure_spread", 0.0);
  stated.light_spread = refined.metrics.value("light_spread", 0.0);
  return stated;
}

std::vector<float> PredictedDeviation(const FittedMaps& fit, const StatedDeviations& stated,
                                      const RectifiedSet& set, const RectifiedView& view,
                                      int threads) {
  if (fit.maps.width != stated.width || fit.maps.height != stated.height ||
      set.plane.width != stated.width || set.plane.height != stated.height) {
    throw std::invalid_argument("maps, deviations and views must have one size");
  }
  std::vector<double> variance(3 * fit.maps.texels(),
                               stated.residual_deviation * stated.residual_deviation);
  const auto add = [&](const FittedMaps& more, const RectifiedView& view_of_more,
                       const FittedMaps& less, const RectifiedView& view_of_less) {
    const std::vector<float> above = RenderFit(more, set, view_of_more, threads);
    const std::vector<float> below = RenderFit(less, set, view_of_less, threads);
    for (size_t k = 0; k < variance.size(); ++k) {
      const double half = 0.5 * (Log(above[k], view.ldr) - Log(below[k], view.ldr));
      variance[k] += half * half;
    }
  };
  for (size_t i = 0; i < kStated.size(); ++i) {
    FittedMaps more = fit, less = fit;
    more.maps = Moved(fit.maps, stated, i, 1);
    less.maps = Moved(fit.maps, stated, i, -1);
    add(more, view, less, view);
  }
  const DeviationValues spreads = {stated.exposure_spread, stated.light_spread,
                                   stated.light_spread};
  const bool known = fit.corrections.contains(view.name);
  for (size_t i = 0; i < spreads.size() && !known; ++i) {
    if (!(spreads[i] > 0)) continue;
    const auto deviating = [&](double by) {
      DeviationValues deviation{};
      deviation[i] = by;
      RectifiedView moved = view;
      moved.view = Deviating(view.view, deviation);
      return moved;
    };
    add(fit, deviating(spreads[i]), fit, deviating(-spreads[i]));
  }
  std::vector<float> deviation(variance.size());
  std::transform(variance.begin(), variance.end(), deviation.begin(),
                 [](double v) { return static_cast<float>(std::sqrt(v)); });
  return deviation;
}

Coverage CoverageOf(const SvbrdfMaps& maps, const SvbrdfMaps& truth, const StatedDeviations& stated,
                    double widths) {
  const size_t texels = maps.texels();
  if (truth.texels() != texels || stated.planes.size() != kStated.size() * texels) {
    throw std::invalid_argument("maps, truth and deviations must have one size");
  }
  std::array<double, kStated.size()> share{};
  for (size_t i = 0; i < kStated.size(); ++i) {
    for (size_t t = 0; t < texels; ++t) {
      const double off =
          std::abs(maps.plane(kStated[i].plane)[t] - truth.plane(kStated[i].plane)[t]);
      if (off <= widths * stated.planes[i * texels + t]) share[i] += 1.0 / texels;
    }
  }
  return {(share[0] + share[1]) / 2, (share[2] + share[3] + share[4]) / 3,
          (share[5] + share[6] + share[7]) / 3, share[8]};
}

}  // namespace glint
