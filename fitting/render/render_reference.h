// The renderer in plain torch operations, on any device and in any floating type, differentiable by
// torch's autograd. It is the check of the fused kernel, and the renderer where that cannot run
// (GPU). Shapes as in render_autograd.h; the model is written as base/reflectance/brdf.h states
// it.
#pragma once

#include "fitting/render/render_autograd.h"

namespace glint {

// Renderings [B, V, 3, H, W] of maps [B, 10, H, W]. light_rgb is [B, V, 3], or undefined: the
// views'.
at::Tensor RenderReference(const at::Tensor& maps, const at::Tensor& light_rgb,
                           const ViewBatch& batch);

// Mean |log(images + offset) − log(rendered + offset)| weighted by masks [B, V, H, W] (or
// undefined).
at::Tensor LogLossReference(const at::Tensor& rendered, const at::Tensor& images,
                            const at::Tensor& masks, const TensorLossOptions& options);

}  // namespace glint
