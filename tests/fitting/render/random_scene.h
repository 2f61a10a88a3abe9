// Random maps, views and images for the renderer's tests; the same for the same seed.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "base/reflectance/texel_at.h"
#include "base/reflectance/view.h"

namespace glint {

class RandomScene {
 public:
  explicit RandomScene(unsigned seed) : engine_(seed) {}

  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

  // Unit normals tilted up to about 40°, everything else inside its range.
  SvbrdfMaps Maps(int width, int height, double least_roughness = 0.1) {
    SvbrdfMaps maps(width, height);
    for (size_t i = 0; i < maps.texels(); ++i) {
      const double x = Uniform(-0.6, 0.6), y = Uniform(-0.6, 0.6);
      const double length = std::sqrt(x * x + y * y + 1);
      maps.plane(kNormalX)[i] = static_cast<float>(x / length);
      maps.plane(kNormalY)[i] = static_cast<float>(y / length);
      maps.plane(kNormalZ)[i] = static_cast<float>(1 / length);
      for (int p = kDiffuseR; p < kRoughness; ++p) {
        maps.plane(p)[i] = static_cast<float>(Uniform(0.02, 0.95));
      }
      maps.plane(kRoughness)[i] = static_cast<float>(Uniform(least_roughness, 1));
    }
    return maps;
  }

  // Camera and light apart, 150–400 mm above a sample of about 100 mm, coloured light and ambient.
  glint::View View() {
    glint::View view;
    view.camera_in_sample_mm = {Uniform(-150, 150), Uniform(-150, 150), Uniform(150, 400)};
    view.light_in_sample_mm = {Uniform(-150, 150), Uniform(-150, 150), Uniform(150, 400)};
    for (int c = 0; c < 3; ++c) {
      view.light_rgb[c] = Uniform(5e4, 2e5);
      view.ambient_rgb[c] = Uniform(0, 0.2);
    }
    view.exposure = Uniform(0.5, 2);
    return view;
  }

  std::vector<float> Image(size_t values, double high = 1) {
    std::vector<float> image(values);
    for (float& value : image) value = static_cast<float>(Uniform(0, high));
    return image;
  }

 private:
  std::mt19937 engine_;
};

// All of both switches.
inline const std::vector<ReflectanceConvention>& AllConventions() {
  static const std::vector<ReflectanceConvention> conventions = {
      ReflectanceConvention::Photograph(),
      ReflectanceConvention::Dir2019(),
      ReflectanceConvention::MaterialGan(),
      {DiffuseWeight::kOneMinusSpecular, LightFalloff::kNone, TexelSampling::kPixelCentres},
      {DiffuseWeight::kOne, LightFalloff::kInverseSquare, TexelSampling::kPixelCentres, {0.7, 0.4}},
      {DiffuseWeight::kOne,
       LightFalloff::kInverseSquare,
       TexelSampling::kPixelCentres,
       {0.3, 0.4, 0.05}},
      {DiffuseWeight::kOne,
       LightFalloff::kInverseSquare,
       TexelSampling::kPixelCentres,
       {.tail_exponent = 4}},
      {DiffuseWeight::kOneMinusSpecular,
       LightFalloff::kNone,
       TexelSampling::kCornerToCorner,
       {0.3, 0.4, 0.05, 8}},
      {DiffuseWeight::kOne,
       LightFalloff::kInverseSquare,
       TexelSampling::kPixelCentres,
       {.anisotropy = {2, 60}}},
      {DiffuseWeight::kOneMinusSpecular,
       LightFalloff::kInverseSquare,
       TexelSampling::kPixelCentres,
       {0.3, 0.4, 0.05, 4, {1.5, 150}}}};
  return conventions;
}

inline SamplePlane TestPlane(int width, int height, const ReflectanceConvention& convention) {
  return {width, height, 100.0, 80.0, convention.sampling};
}

}  // namespace glint
