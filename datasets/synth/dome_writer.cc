#include "datasets/synth/dome_writer.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/json.h"
#include "base/formats/svbrdf_file.h"
#include "base/parallel/parallel.h"
#include "datasets/procedural/random.h"
#include "datasets/synth/photo_file.h"
#include "datasets/synth/vec3.h"
#include "fitting/relief/height_field.h"
#include "fitting/render/render_lit.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr double kFarSides = 10;  // of the camera, and of lamps whose distance is not given
constexpr double kDegree_rad = std::numbers::pi / 180;
constexpr double kBrightest = 0.9;  // radiance that one texel in a hundred exceeds in all pictures

struct Lamp {
  Eigen::Vector3d direction, told;
  Eigen::Vector3d strength_rgb;
};

// On a spiral over the half sphere. Of a lamp's strength a half is smooth over the dome.
std::vector<Lamp> LampsOf(const DomeOptions& options, std::uint64_t seed) {
  procedural::Rng rng(procedural::Mix64(seed) ^ 0xd03eull);
  const double low = std::sin(options.lowest_deg * kDegree_rad);
  const double high = std::sin(options.highest_deg * kDegree_rad);
  constexpr double kGoldenAngle_rad = 2.399963229728653;
  const double bright_side = 2 * std::numbers::pi * rng.Unit();
  std::vector<Lamp> lamps;
  for (int i = 0; i < options.lights; ++i) {
    const double z = high + (low - high) * (i + 0.5) / options.lights;
    const double azimuth = i * kGoldenAngle_rad, side = std::sqrt(1 - z * z);
    Lamp lamp;
    lamp.direction = {side * std::cos(azimuth), side * std::sin(azimuth), z};
    const Eigen::Vector3d axis =
        lamp.direction.cross(Eigen::Vector3d(rng.Normal(), rng.Normal(), rng.Normal()))
            .normalized();
    // Two components across the direction of this standard deviation each.
    const double angle = options.jitter_deg * kDegree_rad * std::hypot(rng.Normal(), rng.Normal());
    lamp.told = Eigen::AngleAxisd(angle, axis) * lamp.direction;
    const double smooth = side * std::cos(azimuth - bright_side) * std::numbers::sqrt2;
    const double grey = options.uneven * std::numbers::sqrt2 / 2 * (smooth + rng.Normal());
    const double red = options.colours * rng.Normal(), blue = options.colours * rng.Normal();
    lamp.strength_rgb = {std::exp(grey + red), std::exp(grey), std::exp(grey + blue)};
    lamps.push_back(lamp);
  }
  return lamps;
}

View ViewOf(const DomeOptions& options, const Lamp& lamp) {
  const double far_mm = kFarSides * options.sample_mm;
  const double distance_mm = options.distance_mm > 0 ? options.distance_mm : far_mm;
  View view;
  view.camera_in_sample_mm = {0, 0, far_mm};
  view.light_in_sample_mm = ToVec3d(distance_mm * lamp.direction);
  view.light_rgb = ToVec3d(std::numbers::pi * distance_mm * distance_mm * lamp.strength_rgb);
  return view;
}

// Whether the relief hides the lamp from a texel: along the light's way nothing may be higher.
bool InShadow(const HeightField& relief, int row, int column, const Eigen::Vector3d& light,
              double highest_mm) {
  const double across = light.head<2>().norm();
  if (across < 1e-6) return false;
  const double step_mm = std::min(relief.texel_x_mm, relief.texel_y_mm);
  const double base = relief.at(row, column);
  for (int k = 1;; ++k) {
    const double height = base + k * step_mm * light.z() / across;
    if (height > highest_mm) return false;
    const double c = column + k * step_mm * light.x() / across / relief.texel_x_mm;
    const double r = row - k * step_mm * light.y() / across / relief.texel_y_mm;
    if (c < 0 || r < 0 || c > relief.width - 1 || r > relief.height - 1) return false;
    if (relief.Lookup(r, c) > height) return true;
  }
}

void CastShadows(const HeightField& relief, const Eigen::Vector3d& light,
                 std::vector<float>* radiance) {
  const double highest = *std::max_element(relief.height_mm.begin(), relief.height_mm.end());
  const size_t texels = relief.height_mm.size();
  for (int row = 0; row < relief.height; ++row) {
    for (int column = 0; column < relief.width; ++column) {
      if (!InShadow(relief, row, column, light, highest)) continue;
      const size_t i = static_cast<size_t>(row) * relief.width + column;
      for (size_t c = 0; c < 3; ++c) (*radiance)[c * texels + i] = 0;
    }
  }
}

// Every channel, mirrored at the borders.
void BlurPicture(double sigma_px, int width, int height, std::vector<float>* radiance) {
  if (!(sigma_px > 0)) return;
  for (int c = 0; c < 3; ++c) {
    cv::Mat plane(height, width, CV_32F,
                  radiance->data() + static_cast<size_t>(c) * width * height);
    cv::GaussianBlur(plane, plane, {}, sigma_px, sigma_px, cv::BORDER_REFLECT_101);
  }
}

// One factor for all pictures, as one exposure has.
double ExposureOf(const std::vector<std::vector<float>>& pictures) {
  std::vector<float> values;
  for (const auto& picture : pictures) {
    for (size_t i = 0; i < picture.size(); i += 7) values.push_back(picture[i]);
  }
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(0.99 * values.size());
  std::nth_element(values.begin(), at, values.end());
  return *at > 0 ? kBrightest / *at : 1;
}

void WritePicture(const fs::path& file, const std::vector<float>& radiance, int width, int height,
                  double exposure, const DomeOptions& options, std::uint64_t seed) {
  const EightBitEncoder encoder(ParseEncoding("gamma2.2"));
  const size_t pixels = static_cast<size_t>(width) * height;
  std::vector<unsigned char> bytes(3 * pixels);
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const auto value = static_cast<float>(exposure * radiance[c * pixels + i]);
      bytes[3 * i + c] = encoder(NoisyRadiance(value, options.noise, seed, 3 * i + c));
    }
  }
  PhotoFacts facts;
  facts.jpeg_quality = options.jpeg_quality;
  WritePhoto(file, width, height, bytes, facts);
}

std::string PictureName(size_t index, const std::string& format) {
  return fmt::format("light_{:03}.{}", index, format);
}

// The mean (of logarithms) of all lamps and channels, radiance times mm².
double MeanPower(const std::vector<Lamp>& lamps, const DomeOptions& options) {
  double sum = 0;
  for (const Lamp& lamp : lamps) {
    for (const double power : ViewOf(options, lamp).light_rgb) sum += std::log(power) / 3;
  }
  return std::exp(sum / static_cast<double>(lamps.size()));
}

void WriteTruth(const fs::path& folder, const std::vector<Lamp>& lamps,
                const MaterialSource& material, const DomeOptions& options, double exposure) {
  fs::create_directories(folder);
  WriteSvbrdf(folder / "svbrdf.exr", material.maps, ReflectanceConvention::Photograph());
  Json json = {{"sample_mm", options.sample_mm},
               {"power", exposure * MeanPower(lamps, options)},
               {"lights", Json::array()}};
  for (size_t i = 0; i < lamps.size(); ++i) {
    const Lamp& lamp = lamps[i];
    json["lights"].push_back(
        {{"photo", PictureName(i, options.format)},
         {"direction", {lamp.direction.x(), lamp.direction.y(), lamp.direction.z()}},
         {"strength_rgb", {lamp.strength_rgb.x(), lamp.strength_rgb.y(), lamp.strength_rgb.z()}}});
  }
  WriteFileAtomically(folder / "lights.json", json.dump(1) + "\n");
}

}  // namespace

void WriteDome(const fs::path& folder, const MaterialSource& material, const DomeOptions& options,
               std::uint64_t seed, int threads) {
  if (fs::exists(folder) && !fs::is_empty(folder)) {
    throw UserError(folder, "", "a folder that is not empty", "name a new one");
  }
  const int width = material.maps.width, height = material.maps.height;
  SamplePlane plane;
  plane.width = width;
  plane.height = height;
  plane.width_mm = options.sample_mm;
  plane.height_mm = options.sample_mm * height / width;
  const std::vector<Lamp> lamps = LampsOf(options, seed);
  HeightField relief;
  if (options.shadows) relief = IntegrateNormals(material.maps, plane, 0, {}, threads);
  std::vector<std::vector<float>> pictures(lamps.size());
  ForEachPiece(static_cast<int>(lamps.size()), threads, [&](int lamp) {
    const auto i = static_cast<size_t>(lamp);
    pictures[i].resize(3 * material.maps.texels());
    RenderLit(material.maps, plane, ViewOf(options, lamps[i]), ReflectanceConvention::Photograph(),
              pictures[i].data(), 1);
    if (options.shadows) CastShadows(relief, lamps[i].direction, &pictures[i]);
    BlurPicture(options.blur_px, width, height, &pictures[i]);
  });
  const double exposure = ExposureOf(pictures);
  fs::create_directories(folder);
  std::string list = fmt::format("{}\n", lamps.size());
  for (size_t i = 0; i < lamps.size(); ++i) {
    const std::string name = PictureName(i, options.format);
    WritePicture(folder / name, pictures[i], width, height, exposure, options,
                 procedural::Mix64(seed + 7919 * i));
    list += fmt::format("{} {:.6f} {:.6f} {:.6f}\n", name, lamps[i].told.x(), lamps[i].told.y(),
                        lamps[i].told.z());
  }
  WriteFileAtomically(folder / "dirs.lp", list);
  WriteTruth(folder / "truth", lamps, material, options, exposure);
}

}  // namespace glint
