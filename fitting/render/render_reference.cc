#include "fitting/render/render_reference.h"

#include <torch/torch.h>

#include <vector>

#include "fitting/reflectance/brdf_constants.h"
#include "fitting/reflectance/svbrdf_maps.h"

namespace glint {
namespace {

using torch::Tensor;
using torch::indexing::None;
using torch::indexing::Slice;

// A value of every view as [B, V, 3, 1, 1], like `maps` in type and device.
Tensor PerView(const ViewBatch& batch, const Tensor& maps, Vec3d View::*member) {
  std::vector<double> values;
  for (const View& view : batch.views) {
    values.insert(values.end(), (view.*member).begin(), (view.*member).end());
  }
  return torch::tensor(values, torch::kFloat64)
      .view({maps.size(0), batch.views_per_element, 3, 1, 1})
      .to(maps.options());
}

Tensor Exposures(const ViewBatch& batch, const Tensor& maps) {
  std::vector<double> values;
  for (const View& view : batch.views) values.push_back(view.exposure);
  return torch::tensor(values, torch::kFloat64)
      .view({maps.size(0), batch.views_per_element, 1, 1, 1})
      .to(maps.options());
}

// Texel positions [3, H, W].
Tensor Positions(const SamplePlane& plane, const Tensor& maps) {
  Tensor x = torch::empty({plane.width}, torch::kFloat64);
  Tensor y = torch::empty({plane.height}, torch::kFloat64);
  for (int i = 0; i < plane.width; ++i) x.data_ptr<double>()[i] = plane.x_mm(i);
  for (int i = 0; i < plane.height; ++i) y.data_ptr<double>()[i] = plane.y_mm(i);
  const auto size = {static_cast<int64_t>(plane.height), static_cast<int64_t>(plane.width)};
  return torch::stack({x.index({None, Slice()}).expand(size), y.index({Slice(), None}).expand(size),
                       torch::zeros(size, torch::kFloat64)})
      .to(maps.options());
}

Tensor Dot(const Tensor& a, const Tensor& b) { return (a * b).sum(2, /*keepdim=*/true); }

// D·G / (4·NoL·NoV), from clamped cosines.
Tensor SpecularFactor(const Tensor& normal, const Tensor& half, const Tensor& n_dot_l,
                      const Tensor& n_dot_v, const Tensor& roughness) {
  const Tensor alpha = roughness * roughness;
  const Tensor k = (alpha * 0.5).clamp_min(kDenominatorClamp);
  const Tensor n_dot_h = Dot(normal, half);
  const Tensor sine_squared = Dot(normal, normal) - n_dot_h * n_dot_h;
  const Tensor facing = n_dot_h > kDotClamp;
  const Tensor clamped = n_dot_h.clamp_min(kDotClamp) * alpha;
  const Tensor t =
      torch::where(facing, sine_squared, torch::ones_like(sine_squared)) + clamped * clamped;
  const Tensor ratio = alpha / t.clamp_min(kDenominatorClamp);
  const Tensor masking = (n_dot_l * (1 - k) + k) * (n_dot_v * (1 - k) + k);
  return ratio * ratio * (0.25 * kInversePi) / masking;
}

}  // namespace

Tensor RenderReference(const Tensor& maps, const Tensor& light_rgb, const ViewBatch& batch) {
  TORCH_CHECK(maps.dim() == 4 && maps.size(1) == kSvbrdfPlanes, "maps: expected [B, 10, H, W]");
  const Tensor position = Positions(batch.plane, maps);
  const Tensor to_light = PerView(batch, maps, &View::light_in_sample_mm) - position;
  const Tensor to_camera = PerView(batch, maps, &View::camera_in_sample_mm) - position;
  const Tensor light_distance_squared = Dot(to_light, to_light);
  const Tensor light = to_light / light_distance_squared.sqrt();
  const Tensor camera = to_camera / Dot(to_camera, to_camera).sqrt();
  const Tensor sum = light + camera;
  const Tensor half = sum / Dot(sum, sum).sqrt().clamp_min(1e-10);

  const Tensor texels = maps.unsqueeze(1);  // [B, 1, 10, H, W]
  const Tensor normal = texels.slice(2, kNormalX, kDiffuseR);
  const Tensor diffuse = texels.slice(2, kDiffuseR, kSpecularR);
  const Tensor specular = texels.slice(2, kSpecularR, kRoughness);
  const Tensor roughness = texels.slice(2, kRoughness, kSvbrdfPlanes);
  const Tensor n_dot_l = Dot(normal, light).clamp_min(kDotClamp);
  const Tensor n_dot_v = Dot(normal, camera).clamp_min(kDotClamp);
  const Tensor v_dot_h = Dot(camera, half).clamp_min(kDotClamp);

  const Tensor power = torch::exp2(v_dot_h * (kFresnelSquare * v_dot_h + kFresnelLinear));
  const Tensor fresnel = specular + (1 - specular) * power;
  Tensor lobe = diffuse * kInversePi;
  if (batch.convention.diffuse_weight == DiffuseWeight::kOneMinusSpecular) {
    lobe = lobe * (1 - specular);
  }
  const Tensor brdf = lobe + SpecularFactor(normal, half, n_dot_l, n_dot_v, roughness) * fresnel;
  Tensor irradiance = light_rgb.defined() ? light_rgb.unsqueeze(-1).unsqueeze(-1)
                                          : PerView(batch, maps, &View::light_rgb);
  if (batch.convention.falloff == LightFalloff::kInverseSquare) {
    irradiance = irradiance / light_distance_squared;
  }
  const Tensor ambient = PerView(batch, maps, &View::ambient_rgb) * (lobe + specular * kInversePi);
  return Exposures(batch, maps) * (irradiance * brdf * n_dot_l + ambient);
}

Tensor LogLossReference(const Tensor& rendered, const Tensor& images, const Tensor& masks,
                        const TensorLossOptions& options) {
  Tensor shown = rendered.clamp_min(0);
  if (options.clamp_rendered) shown = shown.clamp_max(1);
  const Tensor difference = torch::abs(torch::log(images.clamp_min(0) + options.offset) -
                                       torch::log(shown + options.offset));
  if (!masks.defined()) return difference.mean();
  const Tensor weights = masks.unsqueeze(2);
  const Tensor used = torch::where(weights > 0, difference, torch::zeros_like(difference));
  return (used * weights).sum() / (3 * masks.sum());
}

}  // namespace glint
