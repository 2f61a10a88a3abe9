#include "fitting/render/view_tensors.h"

#include <vector>

#include "fitting/layers/staging.h"

namespace glint {
namespace {

using torch::Tensor;
using torch::TensorOptions;
using torch::indexing::None;
using torch::indexing::Slice;

// Coordinates of `count` texels, as SamplePlane has them, made on the device.
Tensor Coordinates(int count, int first, int stride, int whole, double size_mm,
                   TexelSampling sampling, const TensorOptions& options) {
  const Tensor i = torch::arange(count, options.dtype(torch::kFloat64)) * stride + first;
  if (sampling == TexelSampling::kPixelCentres) return ((i + 0.5) / whole - 0.5) * size_mm;
  if (whole > 1) return (i / (whole - 1) - 0.5) * size_mm;
  return torch::zeros_like(i);
}

// Texel positions [3, H, W].
Tensor Positions(const SamplePlane& plane, const TensorOptions& options) {
  const PlaneOfPart& part = plane.whole;
  const Tensor x = Coordinates(plane.width, part.first_column, part.stride, plane.whole_width(),
                               plane.width_mm, plane.sampling, options);
  const Tensor y = -Coordinates(plane.height, part.first_row, part.stride, plane.whole_height(),
                                plane.height_mm, plane.sampling, options);
  const auto size = {static_cast<int64_t>(plane.height), static_cast<int64_t>(plane.width)};
  return torch::stack({x.index({None, Slice()}).expand(size), y.index({Slice(), None}).expand(size),
                       torch::zeros(size, x.options())})
      .to(c10::typeMetaToScalarType(options.dtype()));
}

Tensor SquaredLength(const Tensor& v) { return v.square().sum(2, /*keepdim=*/true); }

}  // namespace

ViewTensors TensorsOf(const ViewBatch& batch, const TensorOptions& options) {
  constexpr int64_t kNumbers = 4 * 3 + 1;
  std::vector<double> values;
  values.reserve(batch.views.size() * kNumbers);
  for (const View& view : batch.views) {
    for (const Vec3d& vector :
         {view.light_in_sample_mm, view.camera_in_sample_mm, view.light_rgb, view.ambient_rgb}) {
      values.insert(values.end(), vector.begin(), vector.end());
    }
    values.push_back(view.exposure);
  }
  const int64_t per_element = batch.views_per_element;
  const auto elements = static_cast<int64_t>(batch.views.size()) / per_element;
  const Tensor all = Staged(values, {elements, per_element, kNumbers, 1, 1}, options);
  const auto vector = [&](int64_t k) { return all.slice(2, 3 * k, 3 * k + 3); };
  return {vector(0), vector(1), vector(2), vector(3), all.slice(2, kNumbers - 1)};
}

ViewDirections DirectionsOf(const ViewTensors& views, const SamplePlane& plane) {
  const Tensor position = Positions(plane, views.light.options());
  const Tensor to_light = views.light - position;
  const Tensor to_camera = views.camera - position;
  ViewDirections d;
  d.light_distance_squared = SquaredLength(to_light);
  d.light = to_light / d.light_distance_squared.sqrt();
  d.camera = to_camera / SquaredLength(to_camera).sqrt();
  const Tensor sum = d.light + d.camera;
  d.half = sum / SquaredLength(sum).sqrt().clamp_min(1e-10);
  return d;
}

}  // namespace glint
