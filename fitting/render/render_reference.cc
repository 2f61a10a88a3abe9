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

// sin² between n and h, of anisotropic lobes with what h has along the tangent 1/ratio and across
// it ratio times. The tangent is what n leaves of the direction g in the sample's plane.
Tensor StretchedSine(const Tensor& normal, const Tensor& half, const Tensor& n_dot_h,
                     const Anisotropy& anisotropy) {
  const Tensor sine_squared = Dot(normal, normal) - n_dot_h * n_dot_h;
  if (!anisotropy.any()) return sine_squared;
  const double direction_rad = anisotropy.direction_deg * (M_PI / 180);
  const Tensor g =
      torch::tensor({std::cos(direction_rad), std::sin(direction_rad), 0.0}, normal.options())
          .view({1, 1, 3, 1, 1});
  const Tensor n_dot_g = Dot(normal, g);
  const Tensor along =
      (Dot(half, g) - n_dot_h * n_dot_g).square() / (1 - n_dot_g * n_dot_g).clamp_min(1e-3);
  return along / anisotropy.ratio + (sine_squared - along) * anisotropy.ratio;
}

// D·G / (4·NoL·NoV) of one lobe, from clamped cosines. D is Student's t (convention.h) with
// t = sin²θ + cos²θ·(γ−1)α²: (γ−1)^γ α^(2γ−2) cos^(2γ−4)θ / (π t^γ).
Tensor LobeFactor(const Tensor& normal, const Tensor& half, const Tensor& n_dot_l,
                  const Tensor& n_dot_v, const Tensor& roughness, const SpecularLobes& lobes) {
  const int tail = lobes.tail_exponent;
  const Tensor alpha = roughness * roughness;
  const Tensor k = (alpha * 0.5).clamp_min(kDenominatorClamp);
  const Tensor n_dot_h = Dot(normal, half);
  const Tensor sine_squared = StretchedSine(normal, half, n_dot_h, lobes.anisotropy);
  const Tensor facing = n_dot_h > kDotClamp;
  const Tensor cosine = n_dot_h.clamp_min(kDotClamp);
  const Tensor wide = alpha * std::sqrt(tail - 1.0);
  const Tensor t = torch::where(facing, sine_squared, torch::ones_like(sine_squared)) +
                   cosine * cosine * wide * wide;
  const Tensor ratio = wide / t.clamp_min(kDenominatorClamp);
  const Tensor masking = (n_dot_l * (1 - k) + k) * (n_dot_v * (1 - k) + k);
  const Tensor peak = ratio * ratio * (0.25 * kInversePi) / masking;
  if (tail == 2) return peak;
  const Tensor share = cosine * cosine * wide * wide / t.clamp_min(kDenominatorClamp);
  return peak * (tail - 1) * share.pow(tail - 2);
}

// Of the sample's lobes (base/reflectance/convention.h), with the specular map's F0 and with a
// coat's.
struct SpecularFactors {
  Tensor mapped, coat;
};
SpecularFactors FactorsOf(const SpecularLobes& lobes, const Tensor& normal, const Tensor& half,
                          const Tensor& n_dot_l, const Tensor& n_dot_v, const Tensor& roughness) {
  const auto of = [&](double scale) {
    return LobeFactor(normal, half, n_dot_l, n_dot_v, (roughness * scale).clamp_max(1), lobes);
  };
  if (!lobes.two()) {
    const Tensor only = LobeFactor(normal, half, n_dot_l, n_dot_v, roughness, lobes);
    return {only, torch::zeros_like(only)};
  }
  const double share = lobes.narrow_share, wide = std::pow(lobes.narrow_ratio, -share);
  const Tensor broad = of(wide) * (1 - share), narrow = of(wide * lobes.narrow_ratio) * share;
  if (lobes.coat_f0 > 0) return {broad, narrow};
  return {broad + narrow, torch::zeros_like(broad)};
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
  const SpecularLobes& lobes = batch.convention.lobes;
  const SpecularFactors factors = FactorsOf(lobes, normal, half, n_dot_l, n_dot_v, roughness);
  const Tensor coat = lobes.coat_f0 + (1 - lobes.coat_f0) * power;
  const Tensor brdf = lobe + factors.mapped * fresnel + factors.coat * coat;
  Tensor irradiance = light_rgb.defined() ? light_rgb.unsqueeze(-1).unsqueeze(-1) : views.light_rgb;
  if (batch.convention.falloff == LightFalloff::kInverseSquare) {
    irradiance = irradiance / light_distance_squared;
  }
  Tensor mirrored = specular;
  if (lobes.coat_f0 > 0) {
    mirrored = specular * (1 - lobes.narrow_share) + lobes.narrow_share * lobes.coat_f0;
  }
  const Tensor ambient = views.ambient_rgb * (lobe + mirrored * kInversePi);
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
