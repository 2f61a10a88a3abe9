#include "fitting/render/render_reference.h"

#include <torch/torch.h>

#include <cmath>

#include "base/reflectance/brdf_constants.h"
#include "base/reflectance/svbrdf_maps.h"
#include "fitting/render/view_tensors.h"

namespace glint {
namespace {

using torch::Tensor;

Tensor Dot(const Tensor& a, const Tensor& b) { return (a * b).sum(2, /*keepdim=*/true); }

// D·G / (4·NoL·NoV) of one lobe, from clamped cosines.
Tensor LobeFactor(const Tensor& normal, const Tensor& half, const Tensor& n_dot_l,
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

// Of the sample's lobes (base/reflectance/convention.h).
Tensor SpecularFactor(const SpecularLobes& lobes, const Tensor& normal, const Tensor& half,
                      const Tensor& n_dot_l, const Tensor& n_dot_v, const Tensor& roughness) {
  if (!lobes.two()) return LobeFactor(normal, half, n_dot_l, n_dot_v, roughness);
  const double share = lobes.narrow_share, wide = std::pow(lobes.narrow_ratio, -share);
  const auto of = [&](double scale) {
    return LobeFactor(normal, half, n_dot_l, n_dot_v, (roughness * scale).clamp_max(1));
  };
  return of(wide) * (1 - share) + of(wide * lobes.narrow_ratio) * share;
}

}  // namespace

Tensor RenderReference(const Tensor& maps, const Tensor& light_rgb, const ViewBatch& batch) {
  TORCH_CHECK(maps.dim() == 4 && maps.size(1) == kSvbrdfPlanes, "maps: expected [B, 10, H, W]");
  const ViewTensors views = TensorsOf(batch, maps.options());
  const auto [light, camera, half, light_distance_squared] = DirectionsOf(views, batch.plane);

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
  const Tensor factor =
      SpecularFactor(batch.convention.lobes, normal, half, n_dot_l, n_dot_v, roughness);
  const Tensor brdf = lobe + factor * fresnel;
  Tensor irradiance = light_rgb.defined() ? light_rgb.unsqueeze(-1).unsqueeze(-1) : views.light_rgb;
  if (batch.convention.falloff == LightFalloff::kInverseSquare) {
    irradiance = irradiance / light_distance_squared;
  }
  const Tensor ambient = views.ambient_rgb * (lobe + specular * kInversePi);
  return views.exposure * (irradiance * brdf * n_dot_l + ambient);
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
