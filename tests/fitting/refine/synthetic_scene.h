// A small sample with known maps, photographed by arithmetic: what refinement is tested on.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "base/reflectance/texel_at.h"
#include "fitting/refine/refine.h"

namespace glint::test {

struct SyntheticScene {
  SvbrdfMaps truth;
  std::vector<View> views;
  std::vector<std::vector<float>> photographs;
  std::vector<std::vector<float>> masks;
  SamplePlane plane;
  ReflectanceConvention convention = ReflectanceConvention::Dir2019();
  bool ldr = false;

  // Points into this scene.
  RefineProblem Problem() const {
    RefineProblem problem;
    problem.plane = plane;
    problem.convention = convention;
    for (size_t i = 0; i < views.size(); ++i) {
      problem.views.push_back({views[i], ldr, photographs[i], masks[i]});
    }
    return problem;
  }
};

// One level glossy substance whose diffuse albedo varies a little.
inline SvbrdfMaps LevelSubstance(int size, float roughness) {
  SvbrdfMaps maps(size, size);
  for (size_t t = 0; t < maps.texels(); ++t) {
    maps.plane(kNormalZ)[t] = 1;
    maps.plane(kRoughness)[t] = roughness;
    for (int c = 0; c < 3; ++c) {
      maps.plane(kDiffuseR + c)[t] = 0.15f + 0.05f * static_cast<float>(t % 7) / 7;
      maps.plane(kSpecularR + c)[t] = 0.05f;
    }
  }
  return maps;
}

// Four materials in quarters, each with noise; normals tilted up to about 30°.
inline SvbrdfMaps QuarteredMaps(int size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  const float rough[4] = {0.25f, 0.4f, 0.55f, 0.3f};
  const float specular[4] = {0.05f, 0.3f, 0.1f, 0.6f};
  const float diffuse[4] = {0.3f, 0.05f, 0.5f, 0.1f};
  SvbrdfMaps maps(size, size);
  for (size_t t = 0; t < maps.texels(); ++t) {
    const int row = static_cast<int>(t) / size, column = static_cast<int>(t) % size;
    const int quarter = 2 * (2 * row / size) + 2 * column / size;
    const float x = 0.3f * uniform(random), y = 0.3f * uniform(random);
    const float length = 1.0f / std::sqrt(1.0f + x * x + y * y);
    maps.plane(kNormalX)[t] = x * length;
    maps.plane(kNormalY)[t] = y * length;
    maps.plane(kNormalZ)[t] = length;
    maps.plane(kRoughness)[t] = rough[quarter] * (1.0f + 0.1f * uniform(random));
    for (int c = 0; c < 3; ++c) {
      maps.plane(kDiffuseR + c)[t] = diffuse[quarter] * (0.8f + 0.2f * uniform(random));
      maps.plane(kSpecularR + c)[t] = specular[quarter] * (0.9f + 0.1f * uniform(random));
    }
  }
  return maps;
}

// `bits` 0: float radiance; otherwise clipped at 1 and quantised in gamma 2.2.
// `light`: what is not said of the views' lights and curve. `lobes`: nor of the sample's.
inline SyntheticScene Photograph(const SvbrdfMaps& truth, int views, int bits = 0,
                                 unsigned seed = 5, const SharedLight& light = {},
                                 const SpecularLobes& lobes = {}) {
  SyntheticScene scene;
  ReflectanceConvention reflecting = scene.convention;
  reflecting.lobes = lobes;
  scene.truth = truth;
  scene.ldr = bits > 0;
  scene.plane = {truth.width, truth.height, 2.0, 2.0, TexelSampling::kCornerToCorner};
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-kDirJitter, kDirJitter);
  for (int v = 0; v < views; ++v) {
    const double x = v ? jitter(random) : 0.0, y = v ? jitter(random) : 0.0;
    scene.views.push_back(DirView(x, y));
    const View lit = WithSharedLight(scene.views.back(), light);
    std::vector<float> rgb(3 * truth.texels());
    for (size_t t = 0; t < truth.texels(); ++t) {
      double radiance[3];
      ShadeRadiance(
          TexelAt(truth, t),
          TexelGeometryInView<double>(lit, scene.convention.falloff,
                                      scene.plane.x_mm(static_cast<int>(t) % truth.width),
                                      scene.plane.y_mm(static_cast<int>(t) / truth.width)),
          reflecting, radiance);
      for (int c = 0; c < 3; ++c) {
        double value = Recorded(radiance[c], lit.curve.toe, lit.curve.shoulder).value;
        if (bits > 0) {
          const double most = std::exp2(bits) - 1.0;
          const double level = std::round(most * std::pow(std::fmin(value, 1.0), 1.0 / 2.2));
          value = std::pow(level / most, 2.2);
        }
        rgb[c * truth.texels() + t] = static_cast<float>(value);
      }
    }
    scene.photographs.push_back(std::move(rgb));
    scene.masks.emplace_back(truth.texels(), 1.0f);
  }
  return scene;
}

// The truth, off in everything: independently per texel when `rough`, smoothly otherwise.
inline SvbrdfMaps DisturbedMaps(const SvbrdfMaps& truth, float amount, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  SvbrdfMaps maps = truth;
  for (size_t t = 0; t < maps.texels(); ++t) {
    float x = maps.plane(kNormalX)[t] + 0.15f * amount * uniform(random);
    float y = maps.plane(kNormalY)[t] + 0.15f * amount * uniform(random);
    const float length = 1.0f / std::sqrt(x * x + y * y + 1.0f);
    maps.plane(kNormalX)[t] = x * length;
    maps.plane(kNormalY)[t] = y * length;
    maps.plane(kNormalZ)[t] = length;
    maps.plane(kRoughness)[t] *= 1.0f + 0.3f * amount * uniform(random);
    for (int c = 0; c < 3; ++c) {
      maps.plane(kDiffuseR + c)[t] *= 1.0f + 0.3f * amount * uniform(random);
      maps.plane(kSpecularR + c)[t] *= 1.0f + 0.3f * amount * uniform(random);
    }
  }
  return maps;
}

inline double MeanSquare(const SvbrdfMaps& a, const SvbrdfMaps& b, int first, int last) {
  double sum = 0.0;
  for (int p = first; p <= last; ++p) {
    for (size_t t = 0; t < a.texels(); ++t) {
      const double d = static_cast<double>(a.plane(p)[t]) - b.plane(p)[t];
      sum += d * d;
    }
  }
  return sum / (static_cast<double>(a.texels()) * (last - first + 1));
}

}  // namespace glint::test
