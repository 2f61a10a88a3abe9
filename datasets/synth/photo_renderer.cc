#include "datasets/synth/photo_renderer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/errors/errors.h"
#include "base/parallel/parallel.h"
#include "base/reflectance/brdf.h"
#include "datasets/procedural/random.h"
#include "datasets/synth/vec3.h"

namespace glint {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Points where an edge crosses the pixel: a Fibonacci lattice, whose projections on both axes are
// evenly spaced, so that coverage by an edge along a row or column is right to 1/178. (A square
// grid of 8 × 8 is off by up to 1/16 there, which moves corners.)
constexpr int kEdgeSamples = 89;
constexpr int kEdgeGenerator = 55;
constexpr int kFewestMapSamples = 2;  // a side, inside the sample
constexpr int kMostMapSamples = 16;
constexpr double kSamplesPerTexel = 2;

// Smooth noise in [0, 1] with one random value per unit square's corner.
double ValueNoise(double x, double y, std::uint32_t seed) {
  const double left = std::floor(x), top = std::floor(y);
  const auto at = [&](int dx, int dy) {
    return static_cast<double>(procedural::ToUnit(procedural::Hash2(
        static_cast<std::int32_t>(left) + dx, static_cast<std::int32_t>(top) + dy, seed)));
  };
  const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
  const double u = smooth(x - left), v = smooth(y - top);
  const double upper = at(0, 0) + u * (at(1, 0) - at(0, 0));
  const double lower = at(0, 1) + u * (at(1, 1) - at(0, 1));
  return upper + v * (lower - upper);
}

Vector2d Between(const Vector2d& a, const Vector2d& b, double t) { return a + t * (b - a); }

}  // namespace

PhotoRenderer::PhotoRenderer(const CapturePlan& plan, const SvbrdfMaps& maps, int threads)
    : plan_(plan),
      painter_(plan.board, plan.margin_mm),
      map_width_(maps.width),
      map_height_(maps.height),
      texels_(maps.texels()) {
  for (size_t i = 0; i < texels_.size(); ++i) {
    for (int p = 0; p < kSvbrdfPlanes; ++p) texels_[i].value[p] = maps.plane(p)[i];
  }
  for (const PlannedPhoto& photo : plan.photos) {
    const Rigid3 sample_from_camera = Inverse(photo.camera_from_sample);
    View view;
    view.camera_in_sample_mm = ToVec3d(sample_from_camera.translation);
    view.light_in_sample_mm = ToVec3d(photo.light_in_sample_mm);
    view.light_rgb = ToVec3d(plan.light_rgb);
    view.ambient_rgb = ToVec3d(plan.ambient_rgb);
    geometry_.push_back({sample_from_camera.rotation, sample_from_camera.translation, view});
  }
  const int columns = plan.camera.width_px + 1;
  normalized_.resize(static_cast<size_t>(columns) * (plan.camera.height_px + 1));
  ForEachPiece(plan.camera.height_px + 1, threads, [&](int row) {
    for (int column = 0; column < columns; ++column) {
      const auto point = NormalizedFromImage(plan.camera, Vector2d(column, row));
      if (!point) {
        throw ComputationError("the lens distortion has no inverse at pixel (" +
                               std::to_string(column) + ", " + std::to_string(row) + ")");
      }
      normalized_[static_cast<size_t>(row) * columns + column] = point->cast<float>();
    }
  });
}

PhotoRenderer::Surface PhotoRenderer::SurfaceAt(const Vector2d& position_mm) const {
  const double half_mm = 0.5 * plan_.options.sample_mm;
  if (std::abs(position_mm.x()) <= half_mm && std::abs(position_mm.y()) <= half_mm) return kSample;
  if (!plan_.options.has_board) return kTable;
  const auto reflectance = painter_.ReflectanceAt(position_mm.x(), position_mm.y());
  if (!reflectance) return kTable;
  return *reflectance < 0.5 ? kInk : kPaper;
}

double PhotoRenderer::TablePattern(const Vector2d& position_mm) const {
  constexpr double kFar_mm = 1e5;  // rays that go past the horizon
  if (plan_.options.has_board || position_mm.cwiseAbs().maxCoeff() > kFar_mm) return 1;
  double sum = 0, weights = 0, weight = 1;
  const auto seed = static_cast<std::uint32_t>(procedural::Mix64(plan_.options.seed ^ 0x7ab1e));
  for (const double wavelength_mm : {9.0, 4.5, 2.4, 1.3}) {
    const Vector2d at = position_mm / wavelength_mm;
    sum += weight * ValueNoise(at.x(), at.y(), seed + static_cast<std::uint32_t>(100 * weight));
    weights += weight;
    weight *= 0.8;
  }
  // Contrast as of printed cloth: from a tenth of the mean to twice the mean.
  return std::clamp(1 + 3.6 * (sum / weights - 0.5), 0.1, 2.0);
}

void PhotoRenderer::FillCorners(const PhotoGeometry& geometry, int corner_row,
                                CornerRow* corners) const {
  const int columns = plan_.camera.width_px + 1;
  corners->position_mm.resize(columns);
  corners->surface.resize(columns);
  const auto* normalized = normalized_.data() + static_cast<size_t>(corner_row) * columns;
  for (int i = 0; i < columns; ++i) {
    const Vector3d ray =
        geometry.sample_from_camera * Vector3d(normalized[i].x(), normalized[i].y(), 1.0);
    // A ray that does not come down meets the table very far away.
    const double length = geometry.camera_mm.z() / std::max(-ray.z(), 1e-6);
    corners->position_mm[i] = (geometry.camera_mm + length * ray).head<2>();
    corners->surface[i] = SurfaceAt(corners->position_mm[i]);
  }
}

PhotoRenderer::Rgb PhotoRenderer::ShadeSurface(const PhotoGeometry& geometry, Surface surface,
                                               const Vector2d& position_mm) const {
  if (surface == kSample) return ShadeSample(geometry, position_mm);
  const auto& light = geometry.view.light_in_sample_mm;
  const double dx = light[0] - position_mm.x(), dy = light[1] - position_mm.y();
  const double squared = dx * dx + dy * dy + light[2] * light[2];
  const double falloff = light[2] / (squared * std::sqrt(squared));
  const double pattern = surface == kTable ? TablePattern(position_mm) : 1;
  Rgb rgb;
  for (int c = 0; c < 3; ++c) {
    const double albedo = surface == kTable ? pattern * kTableAlbedo[c]
                                            : (surface == kInk ? kInkAlbedo : kPaperAlbedo);
    const double irradiance = plan_.light_rgb[c] * falloff + plan_.ambient_rgb[c];
    rgb[c] = static_cast<float>(albedo * kInversePi * irradiance);
  }
  return rgb;
}

PhotoRenderer::Rgb PhotoRenderer::ShadeSample(const PhotoGeometry& geometry,
                                              const Vector2d& position_mm) const {
  const double side_mm = plan_.options.sample_mm;
  const auto place = [side_mm](double along_mm, int texels, int* low, int* high) {
    const double at = (along_mm / side_mm + 0.5) * texels - 0.5;
    const double clamped = std::clamp(at, 0.0, texels - 1.0);
    *low = static_cast<int>(clamped);
    *high = std::min(*low + 1, texels - 1);
    return static_cast<float>(clamped - *low);
  };
  int left, right, top, bottom;
  const float tx = place(position_mm.x(), map_width_, &left, &right);
  const float ty = place(-position_mm.y(), map_height_, &top, &bottom);
  const Texel* row0 = texels_.data() + static_cast<size_t>(top) * map_width_;
  const Texel* row1 = texels_.data() + static_cast<size_t>(bottom) * map_width_;
  std::array<float, kSvbrdfPlanes> value;
  for (int p = 0; p < kSvbrdfPlanes; ++p) {
    const float upper = row0[left].value[p] + tx * (row0[right].value[p] - row0[left].value[p]);
    const float lower = row1[left].value[p] + tx * (row1[right].value[p] - row1[left].value[p]);
    value[p] = upper + ty * (lower - upper);
  }
  const float* n = value.data();
  const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  const TexelSvbrdf<float> texel{{n[0] / length, n[1] / length, n[2] / length},
                                 {value[kDiffuseR], value[kDiffuseG], value[kDiffuseB]},
                                 {value[kSpecularR], value[kSpecularG], value[kSpecularB]},
                                 value[kRoughness]};
  const auto in_view =
      TexelGeometryInView(geometry.view, LightFalloff::kInverseSquare,
                          static_cast<float>(position_mm.x()), static_cast<float>(position_mm.y()));
  Rgb rgb;
  ShadeRadiance(texel, in_view, {DiffuseWeight::kOne}, rgb.data());
  return rgb;
}

PhotoRenderer::Rgb PhotoRenderer::ShadePixel(const PhotoGeometry& geometry, const CornerRow& above,
                                             const CornerRow& below, int column) const {
  const Vector2d& a = above.position_mm[column];
  const Vector2d& b = above.position_mm[column + 1];
  const Vector2d& c = below.position_mm[column];
  const Vector2d& d = below.position_mm[column + 1];
  const auto at = [&](double u, double v) {
    return Between(Between(a, b, u), Between(c, d, u), v);
  };
  const Surface surface = above.surface[column];
  bool uniform = surface == above.surface[column + 1] && surface == below.surface[column] &&
                 surface == below.surface[column + 1];
  if (uniform && surface != kSample) {
    // A corner of ink may poke in between the pixel's corners.
    const Vector2d centre = at(0.5, 0.5);
    uniform = SurfaceAt(at(0.5, 0)) == surface && SurfaceAt(at(0.5, 1)) == surface &&
              SurfaceAt(at(0, 0.5)) == surface && SurfaceAt(at(1, 0.5)) == surface &&
              SurfaceAt(centre) == surface;
    if (uniform && plan_.options.has_board) return ShadeSurface(geometry, surface, centre);
  }
  const auto add = [](const Rgb& rgb, Rgb* sum) {
    for (int k = 0; k < 3; ++k) (*sum)[k] += rgb[k];
  };
  Rgb sum{0, 0, 0};
  int samples = 0;
  if (uniform && surface != kSample) {
    samples = 4;  // the pattern is smooth
    for (int i = 0; i < samples; ++i) {
      add(ShadeSurface(geometry, surface,
                       at(0.25 + 0.5 * (i % 2), 0.25 + 0.5 * static_cast<double>(i / 2))),
          &sum);
    }
  } else if (uniform) {
    const double texel_mm = plan_.options.sample_mm / std::max(map_width_, map_height_);
    const double longest_mm = std::sqrt(std::max((b - a).squaredNorm(), (c - a).squaredNorm()));
    const int side =
        std::clamp(static_cast<int>(std::ceil(kSamplesPerTexel * longest_mm / texel_mm)),
                   kFewestMapSamples, kMostMapSamples);
    samples = side * side;
    for (int i = 0; i < samples; ++i) {
      const int across = i % side, down = i / side;
      add(ShadeSample(geometry, at((across + 0.5) / side, (down + 0.5) / side)), &sum);
    }
  } else {
    samples = kEdgeSamples;
    for (int i = 0; i < samples; ++i) {
      const int across = i * kEdgeGenerator % kEdgeSamples;
      const Vector2d position = at((across + 0.5) / kEdgeSamples, (i + 0.5) / kEdgeSamples);
      add(ShadeSurface(geometry, SurfaceAt(position), position), &sum);
    }
  }
  for (float& value : sum) value /= static_cast<float>(samples);
  return sum;
}

void PhotoRenderer::RenderRows(int photo, int first_row, int rows, std::span<float> rgb) const {
  const PhotoGeometry& geometry = geometry_[photo];
  const double exposure = plan_.photos[photo].exposure;
  CornerRow above, below;
  FillCorners(geometry, first_row, &above);
  float* out = rgb.data();
  for (int row = first_row; row < first_row + rows; ++row) {
    FillCorners(geometry, row + 1, &below);
    for (int column = 0; column < plan_.camera.width_px; ++column) {
      Rgb value = ShadePixel(geometry, above, below, column);
      const double seen = exposure * LensFalloff(plan_, Vector2d(column + 0.5, row + 0.5));
      for (float& v : value) v = static_cast<float>(seen * v);
      out = std::copy(value.begin(), value.end(), out);
    }
    std::swap(above, below);
  }
}

}  // namespace glint
