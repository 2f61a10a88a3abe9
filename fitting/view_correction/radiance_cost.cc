#include "fitting/view_correction/radiance_cost.h"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>

#include "fitting/reflectance/brdf.h"

namespace glint {
namespace {

constexpr int kShadingSize = kTexelSize + 3;  // texel, light
using Jet = ceres::Jet<double, kShadingSize>;

constexpr double kLogOffset = 0.01;

enum Block : int { kTexel, kLight, kAmbient, kExposure, kShift };

// A residual made so that its square grows linearly beyond `scale`, and its derivative.
struct Robust {
  double value, slope;
};
Robust MakeRobust(double residual, double scale) {
  const double x = residual / scale;
  const double root = std::sqrt(1 + x * x);
  // scale·√(2(root − 1)) without the loss of digits near 0
  const double value = residual * std::sqrt(2 / (root + 1));
  const double slope = std::abs(x) < 1e-8 ? 1.0 : residual / (root * value);
  return {value, slope};
}

TexelSvbrdf<Jet> TexelOf(const double* p) {
  TexelSvbrdf<Jet> texel;
  for (int c = 0; c < 3; ++c) {
    texel.diffuse[c] = Jet(p[kTexelDiffuse + c], kTexelDiffuse + c);
    texel.specular[c] = Jet(p[kTexelSpecular + c], kTexelSpecular + c);
  }
  texel.roughness = Jet(p[kTexelRough], kTexelRough);
  const Jet x(p[kTexelSlope], kTexelSlope), y(p[kTexelSlope + 1], kTexelSlope + 1);
  const Jet inverse = 1.0 / sqrt(x * x + y * y + 1.0);
  texel.normal[0] = x * inverse;
  texel.normal[1] = y * inverse;
  texel.normal[2] = inverse;
  return texel;
}

}  // namespace

RadianceCost::RadianceCost(const ViewContext& context, int column, int row)
    : context_(context), column_(column), row_(row) {
  const SamplePlane& plane = context.plane;
  position_mm_[0] = plane.x_mm(column);
  position_mm_[1] = plane.y_mm(row);
  const Vec3d& eye = context.photograph->view.camera_in_sample_mm;
  const double to_eye[3] = {eye[0] - position_mm_[0], eye[1] - position_mm_[1], eye[2]};
  const double length = std::sqrt(Dot(to_eye, to_eye));
  for (int i = 0; i < 3; ++i) camera_[i] = to_eye[i] / length;
  CornerWeights((column + 0.5) / plane.width, (row + 0.5) / plane.height, corner_weights_);
}

bool RadianceCost::Evaluate(double const* const* parameters, double* residuals,
                            double** jacobians) const {
  const View& view = context_.photograph->view;
  const double exposure = view.exposure * std::exp(parameters[kExposure][0]);
  Jet light[3], camera[3], irradiance[3], ambient[3];
  for (int i = 0; i < 3; ++i) {
    const double position = i < 2 ? position_mm_[i] : 0.0;
    light[i] = Jet(parameters[kLight][i], kTexelSize + i) * context_.light_distance_mm +
               (view.light_in_sample_mm[i] - position);
    camera[i] = Jet(camera_[i]);
  }
  const Jet inverse = 1.0 / sqrt(Dot(light, light));
  const Jet attenuation =
      context_.convention.falloff == LightFalloff::kInverseSquare ? inverse * inverse : Jet(1.0);
  for (int i = 0; i < 3; ++i) {
    light[i] *= inverse;
    irradiance[i] = exposure * view.light_rgb[i] * attenuation;
    ambient[i] =
        Jet(exposure * (view.ambient_rgb[i] + parameters[kAmbient][i] * context_.irradiance));
  }
  const TexelSvbrdf<Jet> texel = TexelOf(parameters[kTexel]);
  Jet radiance[3];
  ShadeRadiance(texel, MakeTexelGeometry(light, camera, irradiance, ambient),
                context_.convention.diffuse_weight, radiance);

  double column = column_, row = row_;
  for (int i = 0; i < 4; ++i) {
    column += corner_weights_[i] * parameters[kShift][i];
    row += corner_weights_[i] * parameters[kShift][4 + i];
  }
  const SamplePlane& plane = context_.plane;
  const size_t texels = static_cast<size_t>(plane.width) * plane.height;
  const auto zero = [&](int block, int size) {
    if (jacobians && jacobians[block]) std::fill_n(jacobians[block], 3 * size, 0.0);
  };
  zero(kAmbient, 3);
  for (int c = 0; c < 3; ++c) {
    const LookedUp seen = LookUp(context_.photograph->rgb.data() + static_cast<size_t>(c) * texels,
                                 plane.width, plane.height, column, row);
    // What is clipped in the photograph and in the rendering agrees.
    const bool clamped = context_.photograph->ldr && radiance[c].a > 1.0;
    const double rendered = clamped ? 1.0 : std::max(radiance[c].a, 0.0);
    const double shown = std::max(seen.value, 0.0);
    const Robust robust = MakeRobust(std::log(rendered + kLogOffset) - std::log(shown + kLogOffset),
                                     context_.robust_scale);
    residuals[c] = context_.weight * robust.value;
    if (!jacobians) continue;
    const double by_rendered =
        clamped ? 0.0 : context_.weight * robust.slope / (rendered + kLogOffset);
    const double by_shown = -context_.weight * robust.slope / (shown + kLogOffset);
    for (int i = 0; jacobians[kTexel] && i < kTexelSize; ++i) {
      jacobians[kTexel][c * kTexelSize + i] = by_rendered * radiance[c].v[i];
    }
    for (int i = 0; jacobians[kLight] && i < 3; ++i) {
      jacobians[kLight][c * 3 + i] = by_rendered * radiance[c].v[kTexelSize + i];
    }
    if (jacobians[kAmbient]) {
      jacobians[kAmbient][c * 3 + c] = by_rendered * exposure * context_.irradiance *
                                       AmbientLobe(texel, context_.convention.diffuse_weight, c).a;
    }
    if (jacobians[kExposure]) jacobians[kExposure][c] = by_rendered * rendered;
    for (int i = 0; jacobians[kShift] && i < 4; ++i) {
      jacobians[kShift][c * 8 + i] = by_shown * seen.by_column * corner_weights_[i];
      jacobians[kShift][c * 8 + 4 + i] = by_shown * seen.by_row * corner_weights_[i];
    }
  }
  return true;
}

}  // namespace glint
