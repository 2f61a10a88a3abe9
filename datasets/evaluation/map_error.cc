#include "datasets/evaluation/map_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "datasets/procedural/random.h"
#include "fitting/render/renderer.h"

namespace glint {
namespace {

void RequireSameSize(const SvbrdfMaps& estimate, const SvbrdfMaps& truth) {
  if (estimate.width == truth.width && estimate.height == truth.height && truth.texels() > 0)
    return;
  throw std::invalid_argument("maps to compare must have one size, of at least one texel");
}

double MeanSquare(const SvbrdfMaps& estimate, const SvbrdfMaps& truth, int first_plane,
                  int last_plane) {
  double sum = 0;
  for (int p = first_plane; p <= last_plane; ++p) {
    const auto a = estimate.plane(p), b = truth.plane(p);
    for (size_t i = 0; i < a.size(); ++i) {
      const double difference = static_cast<double>(a[i]) - b[i];
      sum += difference * difference;
    }
  }
  return sum / (static_cast<double>(last_plane - first_plane + 1) * truth.texels());
}

// Cosine-weighted direction, at least 10° above the plane (Malley's method).
Vec3d DrawPosition(procedural::Rng* rng) {
  constexpr double kSineOf10Degrees = 0.17364817766693033;
  double sine = 0, cosine = 0;
  do {
    sine = std::sqrt(static_cast<double>(rng->Unit()));
    cosine = std::sqrt(1 - sine * sine);
  } while (cosine < kSineOf10Degrees);
  const double azimuth = 2 * std::numbers::pi * rng->Unit();
  return {kDirHeight * sine * std::cos(azimuth), kDirHeight * sine * std::sin(azimuth),
          kDirHeight * cosine};
}

}  // namespace

MapErrors CompareMaps(const SvbrdfMaps& estimate, const SvbrdfMaps& truth) {
  RequireSameSize(estimate, truth);
  MapErrors errors;
  errors.diffuse = MeanSquare(estimate, truth, kDiffuseR, kDiffuseB);
  errors.specular = MeanSquare(estimate, truth, kSpecularR, kSpecularB);
  errors.roughness = MeanSquare(estimate, truth, kRoughness, kRoughness);
  // (n + 1)/2 halves differences and so quarters their squares.
  errors.normal = MeanSquare(estimate, truth, kNormalX, kNormalZ) / 4;
  return errors;
}

std::vector<View> NovelViews(int count, std::uint64_t seed) {
  procedural::Rng rng(seed);
  std::vector<View> views;
  for (int i = 0; i < count; ++i) {
    View view = DirView(0, 0);
    view.light_in_sample_mm = DrawPosition(&rng);
    view.camera_in_sample_mm = DrawPosition(&rng);
    views.push_back(view);
  }
  return views;
}

double RenderError(const SvbrdfMaps& estimate, const SvbrdfMaps& truth,
                   const std::vector<View>& views, int threads) {
  RequireSameSize(estimate, truth);
  const ReflectanceConvention convention = ReflectanceConvention::Dir2019();
  const double longer = std::max(truth.width, truth.height);
  const SamplePlane plane{truth.width, truth.height, 2 * truth.width / longer,
                          2 * truth.height / longer, convention.sampling};
  std::vector<float> a(3 * truth.texels()), b(3 * truth.texels());
  double sum = 0;
  for (const View& view : views) {
    RenderView(estimate, plane, view, convention, a.data(), threads);
    RenderView(truth, plane, view, convention, b.data(), threads);
    for (size_t i = 0; i < a.size(); ++i) {
      const double difference =
          static_cast<double>(std::clamp(a[i], 0.0f, 1.0f)) - std::clamp(b[i], 0.0f, 1.0f);
      sum += difference * difference;
    }
  }
  return sum / (static_cast<double>(a.size()) * views.size());
}

Table1Row EvaluateMaps(const SvbrdfMaps& estimate, const SvbrdfMaps& truth, int threads) {
  return {CompareMaps(estimate, truth),
          RenderError(estimate, truth, NovelViews(kNovelViews, kNovelSeed), threads)};
}

}  // namespace glint
