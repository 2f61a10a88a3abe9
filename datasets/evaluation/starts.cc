#include "datasets/evaluation/starts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/errors/errors.h"
#include "datasets/procedural/random.h"

namespace glint {
namespace {

constexpr int kBlock = 32;  // texels an element of the auto-encoder's code stands for
constexpr float kRougher = 0.3f;

std::array<float, kSvbrdfPlanes> RandomTexel(procedural::Rng* rng) {
  std::array<float, kSvbrdfPlanes> texel{};
  const float x = rng->Uniform(-0.5f, 0.5f), y = rng->Uniform(-0.5f, 0.5f);
  const float length = std::sqrt(x * x + y * y + 1);
  texel[kNormalX] = x / length;
  texel[kNormalY] = y / length;
  texel[kNormalZ] = 1 / length;
  for (int p = kDiffuseR; p <= kSpecularB; ++p) texel[static_cast<size_t>(p)] = rng->Unit();
  texel[kRoughness] = rng->Uniform(0.05f, 1);
  return texel;
}

SvbrdfMaps RandomStart(const SvbrdfMaps& truth) {
  SvbrdfMaps maps(truth.width, truth.height);
  procedural::Rng rng(0x57a27u);
  for (int row = 0; row < maps.height; row += kBlock) {
    for (int column = 0; column < maps.width; column += kBlock) {
      const auto texel = RandomTexel(&rng);
      for (int y = row; y < std::min(row + kBlock, maps.height); ++y) {
        for (int x = column; x < std::min(column + kBlock, maps.width); ++x) {
          for (int p = 0; p < kSvbrdfPlanes; ++p) maps.at(p, y, x) = texel[static_cast<size_t>(p)];
        }
      }
    }
  }
  return maps;
}

SvbrdfMaps RoughStart(const SvbrdfMaps& truth) {
  SvbrdfMaps maps = truth;
  for (float& roughness : maps.plane(kRoughness)) roughness = std::min(1.0f, roughness + kRougher);
  for (int c = 0; c < 3; ++c) {
    for (float& specular : maps.plane(kSpecularR + c)) specular *= 0.5f;
  }
  return maps;
}

}  // namespace

Method WithStart(Method method, const std::string& start) {
  method.name = start + "-" + method.name;
  method.capture = start + "-" + method.capture;
  if (start == "random") {
    method.start = RandomStart;
  } else if (start == "truth") {
    method.start = [](const SvbrdfMaps& truth) { return truth; };
  } else if (start == "rough") {
    method.start = RoughStart;
  } else if (start == "heuristic") {
    method.fit_arguments.insert(method.fit_arguments.end(), {"--initial-maps", "rules"});
  } else if (start == "network") {
    method.fit_arguments.insert(method.fit_arguments.end(), {"--initial-maps", "estimator"});
  } else {
    throw UserError("starts: found \"" + start +
                    "\"; use random, heuristic, network, truth, rough");
  }
  return method;
}

}  // namespace glint
