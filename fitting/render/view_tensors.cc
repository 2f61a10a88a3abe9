#include "fitting/render/view_tensors.h"

#include <vector>

namespace glint {
namespace {

using torch::Tensor;
using torch::TensorOptions;
using torch::indexing::None;
using torch::indexing::Slice;

// `values` of all views, as many of each, [B, V, n, 1, 1].
Tensor OfViews(const std::vector<double>& values, const ViewBatch& batch,
               const TensorOptions& options) {
  const auto views = static_cast<int64_t>(batch.views.size());
  return torch::tensor(values, torch::kFloat64)
      .view({views / batch.views_per_element, batch.views_per_element,
             static_cast<int64_t>(values.size()) / views, 1, 1})
      .to(options);
}

// Texel positions [3, H, W].
Tensor Positions(const SamplePlane& plane, const TensorOptions& options) {
  Tensor x = torch::empty({plane.width}, torch::kFloat64);
  Tensor y = torch::empty({plane.height}, torch::kFloat64);
  for (int i = 0; i < plane.width; ++i) x.data_ptr<double>()[i] = plane.x_mm(i);
  for (int i = 0; i < plane.height; ++i) y.data_ptr<double>()[i] = plane.y_mm(i);
  const auto size = {static_cast<int64_t>(plane.height), static_cast<int64_t>(plane.width)};
  return torch::stack({x.index({None, Slice()}).expand(size), y.index({Slice(), None}).expand(size),
                       torch::zeros(size, torch::kFloat64)})
      .to(options);
}

Tensor SquaredLength(const Tensor& v) { return v.square().sum(2, /*keepdim=*/true); }

}  // namespace

Tensor PerView(const ViewBatch& batch, Vec3d View::*member, const TensorOptions& options) {
  std::vector<double> values;
  for (const View& view : batch.views) {
    values.insert(values.end(), (view.*member).begin(), (view.*member).end());
  }
  return OfViews(values, batch, options);
}

Tensor ExposuresOf(const ViewBatch& batch, const TensorOptions& options) {
  std::vector<double> values;
  for (const View& view : batch.views) values.push_back(view.exposure);
  return OfViews(values, batch, options);
}

ViewDirections DirectionsOf(const ViewBatch& batch, const TensorOptions& options) {
  const Tensor position = Positions(batch.plane, options);
  const Tensor to_light = PerView(batch, &View::light_in_sample_mm, options) - position;
  const Tensor to_camera = PerView(batch, &View::camera_in_sample_mm, options) - position;
  ViewDirections d;
  d.light_distance_squared = SquaredLength(to_light);
  d.light = to_light / d.light_distance_squared.sqrt();
  d.camera = to_camera / SquaredLength(to_camera).sqrt();
  const Tensor sum = d.light + d.camera;
  d.half = sum / SquaredLength(sum).sqrt().clamp_min(1e-10);
  return d;
}

}  // namespace glint
