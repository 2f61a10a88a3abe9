#include "fitting/latent/fit_loss.h"

#include <cmath>
#include <limits>

#include "fitting/render/fused_loss.h"

namespace glint {
namespace {

bool Usable(const Photograph& photo) {
  for (const float m : photo.mask) {
    if (m > 0) return true;
  }
  return false;
}

struct Group {
  std::vector<ViewImages> images;
  std::vector<size_t> photographs;
};

Group GroupOf(const PhotographSet& set, bool ldr, double light_scale) {
  Group group;
  for (size_t i = 0; i < set.photographs.size(); ++i) {
    const Photograph& photo = set.photographs[i];
    if (photo.ldr != ldr || !Usable(photo)) continue;
    View view = photo.view;
    for (double& power : view.light_rgb) power *= light_scale;
    group.images.push_back({view, photo.rgb.data(), photo.mask.data()});
    group.photographs.push_back(i);
  }
  return group;
}

}  // namespace

FitLossValue FitLoss::Evaluate(const EncodedMaps& encoded, double light_scale,
                               bool want_gradient) const {
  const SvbrdfMaps maps = DecodeMaps(encoded);
  FitLossValue value;
  value.view_loss.assign(set_.photographs.size(), std::numeric_limits<double>::quiet_NaN());
  SvbrdfMaps gradient(want_gradient ? maps.width : 0, want_gradient ? maps.height : 0);
  double total_weight = 0;
  for (const bool ldr : {true, false}) {
    const Group group = GroupOf(set_, ldr, light_scale);
    if (group.images.empty()) continue;
    LogLossOptions options;
    options.clamp_rendered = ldr;
    options.want_gradient = want_gradient;
    options.threads = threads_;
    const LossAndGradient part =
        EvaluateLogLoss(maps, set_.plane, group.images, set_.convention, options);
    double weight = 0;
    for (size_t k = 0; k < group.photographs.size(); ++k) {
      weight += part.view_weights[k];
      value.view_loss[group.photographs[k]] = part.view_losses[k];
    }
    value.loss += weight * part.loss;
    total_weight += weight;
    if (!want_gradient) continue;
    for (size_t i = 0; i < gradient.planes.size(); ++i) {
      gradient.planes[i] += static_cast<float>(weight) * part.gradient.planes[i];
    }
    for (size_t k = 0; k < group.images.size(); ++k) {
      for (int c = 0; c < 3; ++c) {
        value.log_light_scale_gradient +=
            weight * part.light_gradients[k][c] * group.images[k].view.light_rgb[c];
      }
    }
  }
  value.loss /= total_weight;
  if (!want_gradient) return value;
  value.log_light_scale_gradient /= total_weight;
  const float scale = static_cast<float>(1 / total_weight);
  for (float& g : gradient.planes) g *= scale;
  value.gradient = EncodedMaps(maps.width, maps.height);
  DecodeTexelsAdjoint(encoded.planes.data(), gradient.planes.data(), maps.texels(),
                      value.gradient.planes.data());
  return value;
}

}  // namespace glint
