// The fitting loss of many views and its gradient in one pass over the texels.
//
//   loss = Σ mask·|log(I + 0.01) − log(R + 0.01)| / (3·Σ mask)    over texels, views and channels
//
// (Gao et al. 2019, eq. 2), with I the photograph and R the rendering, clamped to [0, 1] for
// low-dynamic-range photographs and below at 0 always (radiances above 1e12 count as 1e12). No
// rendering is stored: memory does not grow with the number of views (but for a few sums per view).
#pragma once

#include <span>
#include <vector>

#include "base/reflectance/convention.h"
#include "base/reflectance/svbrdf_maps.h"
#include "base/reflectance/view.h"

namespace glint {

// One photograph: how it was taken, and its planar linear values, 3·height·width.
struct ViewImages {
  View view;
  const float* rgb_linear_planar = nullptr;
  const float* mask = nullptr;  // height·width weights ≥ 0; null: all 1. A texel with NaN in the
                                // photograph counts as masked out.
};

struct LogLossOptions {
  bool clamp_rendered = false;  // to [0, 1]: photographs are low dynamic range
  double offset = 0.01;         // added to both sides of the logarithm; > 0
  bool want_gradient = true;    // else only the losses are computed
  int threads = 1;              // ≤ 0: one per core; results do not depend on it
};

struct LossAndGradient {
  double loss = 0;
  SvbrdfMaps gradient;  // ∂loss/∂maps; empty unless wanted. The normal's components are free
                        // variables: project their gradient on the tangent plane (see brdf.h).
  std::vector<double> view_losses;       // each view's own mean
  std::vector<double> view_weights;      // Σ mask of each view: loss is the mean so weighted
  std::vector<Vec3d> light_gradients;    // ∂loss/∂view.light_rgb; empty unless wanted
  std::vector<Vec3d> ambient_gradients;  // ∂loss/∂view.ambient_rgb; empty unless wanted
};

// Throws std::invalid_argument if sizes do not agree, an image is missing, or every mask is empty.
LossAndGradient EvaluateLogLoss(const SvbrdfMaps& maps, const SamplePlane& plane,
                                std::span<const ViewImages> images,
                                const ReflectanceConvention& convention,
                                const LogLossOptions& options);

}  // namespace glint
