#include "fitting/layers/staging.h"

#include <ATen/Dispatch.h>

#include <algorithm>

namespace glint {

torch::Tensor Staged(std::span<const double> values, at::IntArrayRef shape,
                     const torch::TensorOptions& options) {
  const bool pinned = options.device().is_cuda();
  const auto type = c10::typeMetaToScalarType(options.dtype());
  const torch::Tensor host =
      torch::empty(shape, torch::TensorOptions().dtype(type).pinned_memory(pinned));
  TORCH_CHECK(host.numel() == static_cast<int64_t>(values.size()), "staged tensor: found ",
              values.size(), " values for shape ", shape);
  AT_DISPATCH_ALL_TYPES(type, "Staged", [&] {
    std::transform(values.begin(), values.end(), host.data_ptr<scalar_t>(),
                   [](double x) { return static_cast<scalar_t>(x); });
  });
  return pinned ? host.to(options.device(), /*non_blocking=*/true) : host;
}

}  // namespace glint
