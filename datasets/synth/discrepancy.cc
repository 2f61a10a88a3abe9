#include "datasets/synth/discrepancy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/parallel/parallel.h"
#include "datasets/procedural/random.h"
#include "fitting/render/renderer.h"

namespace glint {
namespace {

std::vector<float> Rendered(const SvbrdfMaps& maps, const SamplePlane& plane, const View& view,
                            const ReflectanceConvention& convention, int threads) {
  std::vector<float> rgb(3 * maps.texels());
  RenderView(maps, plane, view, convention, rgb.data(), threads);
  return rgb;
}

SvbrdfMaps WithoutSpecular(SvbrdfMaps maps) {
  for (int p = kSpecularR; p <= kSpecularB; ++p) {
    std::fill(maps.plane(p).begin(), maps.plane(p).end(), 0.0f);
  }
  return maps;
}

SvbrdfMaps Rougher(SvbrdfMaps maps, double factor) {
  for (float& r : maps.plane(kRoughness)) r = std::min(1.0f, static_cast<float>(factor * r));
  return maps;
}

// Normals tilted along `azimuth` by `widths` times each texel's α.
SvbrdfMaps Tilted(SvbrdfMaps maps, double azimuth, double widths) {
  const size_t texels = maps.texels();
  for (size_t t = 0; t < texels; ++t) {
    const double r = maps.plane(kRoughness)[t], tilt = widths * r * r;
    double n[3];
    for (int i = 0; i < 3; ++i) n[i] = maps.plane(kNormalX + i)[t];
    n[0] += tilt * std::cos(azimuth);
    n[1] += tilt * std::sin(azimuth);
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; ++i) maps.plane(kNormalX + i)[t] = static_cast<float>(n[i] / length);
  }
  return maps;
}

void AddScaled(const std::vector<float>& more, double weight, std::vector<float>* sum) {
  for (size_t k = 0; k < sum->size(); ++k) (*sum)[k] += static_cast<float>(weight * more[k]);
}

// The maps' radiance with a lobe of another shape; its diffuse part is theirs.
std::vector<float> WithOtherLobe(const Discrepancy& discrepancy, const DrawnDiscrepancy& drawn,
                                 const SvbrdfMaps& maps, const SamplePlane& plane, const View& view,
                                 const ReflectanceConvention& convention, int threads) {
  const double strength = discrepancy.strength;
  std::vector<float> sum(3 * maps.texels(), 0.0f);
  if (drawn.lobe == DiscrepantLobe::kSecondLobe) {
    const double share = std::min(1.0, strength * discrepancy.second_lobe_share);
    const SvbrdfMaps wide = Rougher(maps, discrepancy.second_lobe_width);
    AddScaled(Rendered(maps, plane, view, convention, threads), 1 - share, &sum);
    AddScaled(Rendered(wide, plane, view, convention, threads), share, &sum);
    return sum;
  }
  // Gauss and Hermite's five points: exact for a normal distribution's moments up to the ninth.
  constexpr std::array<std::pair<double, double>, 5> kPoints = {{{-2.8569700, 0.0112574},
                                                                 {-1.3556262, 0.2220759},
                                                                 {0.0, 0.5333333},
                                                                 {1.3556262, 0.2220759},
                                                                 {2.8569700, 0.0112574}}};
  for (const auto& [widths, weight] : kPoints) {
    const SvbrdfMaps tilted =
        Tilted(maps, drawn.azimuth_rad, widths * strength * discrepancy.anisotropy);
    AddScaled(Rendered(tilted, plane, view, convention, threads), weight, &sum);
  }
  return sum;
}

// What leaves the sample beside where it entered.
void BlurDiffuse(const Discrepancy& discrepancy, const SvbrdfMaps& maps, const SamplePlane& plane,
                 const View& view, const ReflectanceConvention& convention, int threads,
                 std::vector<float>* rgb) {
  const double sigma_x =
      discrepancy.strength * discrepancy.diffuse_blur_mm * plane.width / plane.width_mm;
  const double sigma_y =
      discrepancy.strength * discrepancy.diffuse_blur_mm * plane.height / plane.height_mm;
  std::vector<float> diffuse = Rendered(WithoutSpecular(maps), plane, view, convention, threads);
  AddScaled(diffuse, -1, rgb);
  for (size_t c = 0; c < 3; ++c) {
    cv::Mat channel(maps.height, maps.width, CV_32F, diffuse.data() + c * maps.texels());
    cv::GaussianBlur(channel, channel, {0, 0}, std::max(sigma_x, 1e-3), std::max(sigma_y, 1e-3),
                     cv::BORDER_REPLICATE);
  }
  AddScaled(diffuse, 1, rgb);
}

// Position on the plane, in rows and columns, of a point in millimetres.
struct Cell {
  double row, column;
};
Cell CellOf(const HeightField& relief, const SamplePlane& plane, double x_mm, double y_mm) {
  return {(plane.y_mm(0) - y_mm) / relief.texel_y_mm, (x_mm - plane.x_mm(0)) / relief.texel_x_mm};
}

// Share of the light that reaches a point of the relief: how far the ray toward the light stays
// above the surface, softened over a quarter of a texel, as much as a flash is wide.
double Lit(const HeightField& relief, const SamplePlane& plane, double x, double y, double h,
           const Vec3d& light, double most_height) {
  const double step = 0.5 * std::min(relief.texel_x_mm, relief.texel_y_mm);
  const double across = std::hypot(light[0] - x, light[1] - y);
  if (across < 1e-9) return 1;
  const double rise = (light[2] - h) / across;
  const double ux = (light[0] - x) / across, uy = (light[1] - y) / across;
  const double softness = 0.25 * step;
  double lit = 1;
  for (double s = 2 * step; h + s * rise < most_height && lit > 0; s += step) {
    const Cell cell = CellOf(relief, plane, x + s * ux, y + s * uy);
    if (cell.row < 0 || cell.column < 0 || cell.row > relief.height - 1 ||
        cell.column > relief.width - 1) {
      break;
    }
    const double above = h + s * rise - relief.Lookup(cell.row, cell.column);
    lit = std::min(lit, std::clamp(1 + above / softness, 0.0, 1.0));
  }
  return lit;
}

// The picture as a camera sees the relief, put back onto the plane: texels stand aside by their
// height, and what lies in shadow is dark but for what is scattered into it.
std::vector<float> SeenOnRelief(const HeightField& relief, const SamplePlane& plane,
                                const View& view, const std::vector<float>& rgb, double strength,
                                int threads) {
  constexpr double kScattered = 0.1;  // of the light, within shadows
  const size_t texels = relief.height_mm.size();
  const double most = *std::max_element(relief.height_mm.begin(), relief.height_mm.end());
  std::vector<float> lit(texels);
  ForEachPieceByWorker(relief.height, threads, [&](int row, int) {
    for (int column = 0; column < relief.width; ++column) {
      const size_t i = static_cast<size_t>(row) * relief.width + column;
      const double share = Lit(relief, plane, plane.x_mm(column), plane.y_mm(row),
                               relief.height_mm[i], view.light_in_sample_mm, most);
      lit[i] = static_cast<float>(1 - strength * (1 - kScattered) * (1 - share));
    }
  });
  std::vector<float> seen(rgb.size());
  ForEachPieceByWorker(relief.height, threads, [&](int row, int) {
    for (int column = 0; column < relief.width; ++column) {
      const size_t i = static_cast<size_t>(row) * relief.width + column;
      const double x = plane.x_mm(column), y = plane.y_mm(row);
      const Vec3d& camera = view.camera_in_sample_mm;
      // The ray through (x, y, 0) meets the surface where it is as high as the relief there;
      // heights are small beside the distance, so two steps are enough.
      double h = relief.height_mm[i];
      Cell cell{static_cast<double>(row), static_cast<double>(column)};
      for (int iteration = 0; iteration < 2; ++iteration) {
        const double toward = strength * h / camera[2];
        cell = CellOf(relief, plane, x + toward * (camera[0] - x), y + toward * (camera[1] - y));
        h = relief.Lookup(cell.row, cell.column);
      }
      const double r = std::clamp(cell.row, 0.0, relief.height - 1.0);
      const double c = std::clamp(cell.column, 0.0, relief.width - 1.0);
      const int r0 = std::min(static_cast<int>(r), std::max(relief.height - 2, 0));
      const int c0 = std::min(static_cast<int>(c), std::max(relief.width - 2, 0));
      const int r1 = std::min(r0 + 1, relief.height - 1), c1 = std::min(c0 + 1, relief.width - 1);
      const double weights[4] = {(1 - (r - r0)) * (1 - (c - c0)), (1 - (r - r0)) * (c - c0),
                                 (r - r0) * (1 - (c - c0)), (r - r0) * (c - c0)};
      const size_t corners[4] = {
          static_cast<size_t>(r0) * relief.width + c0, static_cast<size_t>(r0) * relief.width + c1,
          static_cast<size_t>(r1) * relief.width + c0, static_cast<size_t>(r1) * relief.width + c1};
      for (size_t channel = 0; channel < 3; ++channel) {
        double sum = 0;
        for (int k = 0; k < 4; ++k) {
          sum += weights[k] * lit[corners[k]] * rgb[channel * texels + corners[k]];
        }
        seen[channel * texels + i] = static_cast<float>(sum);
      }
    }
  });
  return seen;
}

}  // namespace

DrawnDiscrepancy DrawDiscrepancy(const Discrepancy& discrepancy, std::uint64_t seed, int views) {
  procedural::Rng rng(procedural::Mix64(seed) ^ 0xd15c4e9aull);
  DrawnDiscrepancy drawn;
  drawn.lobe = rng.Unit() < 0.5 ? DiscrepantLobe::kSecondLobe : DiscrepantLobe::kAnisotropic;
  drawn.azimuth_rad = std::numbers::pi * rng.Unit();
  for (int i = 0; i < views; ++i) {
    drawn.exposures.push_back(std::exp(discrepancy.strength * discrepancy.exposure * rng.Normal()));
  }
  return drawn;
}

std::vector<float> RenderDiscrepant(const Discrepancy& discrepancy, const DrawnDiscrepancy& drawn,
                                    const SvbrdfMaps& maps, const HeightField& relief,
                                    const SamplePlane& plane, const View& view,
                                    const ReflectanceConvention& convention, int threads) {
  std::vector<float> rgb =
      WithOtherLobe(discrepancy, drawn, maps, plane, view, convention, threads);
  BlurDiffuse(discrepancy, maps, plane, view, convention, threads, &rgb);
  for (float& value : rgb) value = std::max(value, 0.0f);
  if (!discrepancy.relief) return rgb;
  return SeenOnRelief(relief, plane, view, rgb, std::min(1.0, discrepancy.strength), threads);
}

std::vector<unsigned char> JpegRoundTrip(const std::vector<unsigned char>& codes, int width,
                                         int height, int quality) {
  cv::Mat picture(height, width, CV_8UC3);
  std::copy(codes.begin(), codes.end(), picture.ptr());
  cv::cvtColor(picture, picture, cv::COLOR_RGB2BGR);
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  cv::Mat decoded = cv::imdecode(bytes, cv::IMREAD_COLOR);
  cv::cvtColor(decoded, decoded, cv::COLOR_BGR2RGB);
  return {decoded.ptr(), decoded.ptr() + codes.size()};
}

}  // namespace glint
