#include "datasets/synth/view_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/svbrdf_file.h"
#include "base/images/image.h"
#include "base/programs/stage.h"
#include "datasets/procedural/random.h"
#include "datasets/synth/capture_plan.h"
#include "datasets/synth/photo_file.h"
#include "datasets/synth/vec3.h"
#include "fitting/render/renderer.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kStageVersion = 3;  // of stage "rectify" as written here
constexpr double kDirSide = 2.0;  // DIR's plane spans [-1, 1]²
constexpr double kRadians = std::numbers::pi / 180;

std::vector<View> DirViews(int count, std::uint64_t seed) {
  procedural::Rng rng(procedural::Mix64(seed) ^ 0xd1f2019ull);
  std::vector<View> views{DirView(0, 0)};
  while (static_cast<int>(views.size()) < count) {
    const double x = kDirJitter * (2.0 * rng.Unit() - 1.0);
    const double y = kDirJitter * (2.0 * rng.Unit() - 1.0);
    views.push_back(DirView(x, y));
  }
  return views;
}

// Without a view from the top.
std::vector<View> TiltedDirViews(const ViewSetOptions& options, std::uint64_t seed) {
  constexpr double kTiltRange_deg = 10;
  procedural::Rng rng(procedural::Mix64(seed) ^ 0x71f7ull);
  std::vector<View> views;
  for (int i = 0; i < options.count; ++i) {
    const double tilt = (options.least_tilt_deg + kTiltRange_deg * rng.Unit()) * kRadians;
    const double azimuth = 2 * std::numbers::pi * rng.Unit();
    const double aside = kDirHeight * std::tan(tilt);
    views.push_back(DirView(aside * std::cos(azimuth), aside * std::sin(azimuth)));
  }
  return views;
}

std::vector<View> PhotoViews(const CapturePlan& plan) {
  std::vector<View> views;
  for (const PlannedPhoto& photo : plan.photos) {
    View view;
    view.camera_in_sample_mm = ToVec3d(Inverse(photo.camera_from_sample).translation);
    view.light_in_sample_mm = ToVec3d(photo.light_in_sample_mm);
    view.light_rgb = ToVec3d(plan.light_rgb);
    views.push_back(view);
  }
  return views;
}

// Poses of published flash captures: the first from near the top.
std::vector<View> FlashViews(int count, std::uint64_t seed, double sample_mm) {
  constexpr double kNearest = 3, kFarthest = 5;  // half-widths of the sample
  constexpr double kMostTilt_deg = 20, kFlashBeside_mm = 12;
  procedural::Rng rng(procedural::Mix64(seed) ^ 0xf1a54ull);
  std::vector<View> views;
  for (int i = 0; i < count; ++i) {
    const double distance = 0.5 * sample_mm * rng.Uniform(kNearest, kFarthest);
    const double tilt = (i == 0 ? 0.1 : 1.0) * kMostTilt_deg * kRadians * std::sqrt(rng.Unit());
    const double azimuth = 2 * std::numbers::pi * rng.Unit();
    View view;
    view.camera_in_sample_mm = {distance * std::sin(tilt) * std::cos(azimuth),
                                distance * std::sin(tilt) * std::sin(azimuth),
                                distance * std::cos(tilt)};
    view.light_in_sample_mm = view.camera_in_sample_mm;
    view.light_in_sample_mm[0] += kFlashBeside_mm;  // of an upright phone
    const double power = std::numbers::pi * std::pow(0.25 * sample_mm * (kNearest + kFarthest), 2);
    view.light_rgb = {power, power, power};
    views.push_back(view);
  }
  return views;
}

std::string PhotoName(int index, bool is_float) {
  return fmt::format("photos/view_{:03}.{}", index, is_float ? "exr" : "png");
}

void WriteViewPhoto(const fs::path& file, const RectifiedImage& rectified,
                    const ViewSetOptions& options) {
  const size_t pixels = static_cast<size_t>(rectified.width) * rectified.height;
  if (options.bits == "float") {
    Image image(rectified.width, rectified.height, {"R", "G", "B"});
    image.samples = rectified.rgb;
    WriteExr(file, image);
    return;
  }
  const EightBitEncoder encoder(ParseEncoding(options.encoding));
  std::vector<unsigned char> bytes(3 * pixels);
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < 3; ++c) bytes[3 * i + c] = encoder(rectified.rgb[c * pixels + i]);
  }
  WritePhoto(file, rectified.width, rectified.height, bytes, PhotoFacts{});
}

std::string CaptureToml(const PlannedViews& planned, const ViewSetOptions& options) {
  const bool is_float = options.bits == "float";
  return fmt::format(
      "# Synthetic rectified views (rule {}): there is no board, and rectify is done.\n"
      "[sample]\nsize_mm = [{}, {}]\nresolution_px = [{}, {}]\n\n"
      "[photos]\nfiles = [\"photos/view_*.{}\"]\n\n[radiometry]\nencoding = \"{}\"\n",
      options.rule, planned.plane.width_mm, planned.plane.height_mm, planned.plane.width,
      planned.plane.height, is_float ? "exr" : "png", is_float ? "linear" : options.encoding);
}

RectifiedSet SetOf(const PlannedViews& planned, bool is_float) {
  RectifiedSet set;
  set.plane = planned.plane;
  set.convention = planned.convention;
  for (size_t i = 0; i < planned.views.size(); ++i) {
    RectifiedView view;
    view.name = ViewName(i);
    view.file = view.name + ".exr";
    view.photo = PhotoName(static_cast<int>(i), is_float);
    view.ldr = !is_float;
    view.view = planned.views[i];
    set.views.push_back(view);
  }
  return set;
}

PlannedViews UndisturbedViews(const ViewSetOptions& options, std::uint64_t seed, int width,
                              int height) {
  PlannedViews planned;
  if (options.rule == "dir") {
    planned.convention = ReflectanceConvention::Dir2019();
    planned.plane = {width, height, kDirSide, kDirSide * height / width,
                     planned.convention.sampling};
    planned.views =
        options.least_tilt_deg > 0 ? TiltedDirViews(options, seed) : DirViews(options.count, seed);
    return planned;
  }
  if (options.least_tilt_deg > 0) {
    throw UserError(fmt::format("least-tilt-deg: found {} with rule {}; use rule dir",
                                options.least_tilt_deg, options.rule));
  }
  if (options.rule == "flash") {
    constexpr double kSample_mm = 100;
    planned.convention = ReflectanceConvention::Photograph();
    planned.plane = {width, height, kSample_mm, kSample_mm * height / width,
                     planned.convention.sampling};
    planned.views = FlashViews(options.count, seed, kSample_mm);
    return planned;
  }
  // Exposure and poses of the longest capture, so that sets of one seed are nested.
  constexpr int kPlannedPhotos = 64;
  CapturePlanOptions capture;
  capture.seed = seed;
  capture.photos = std::max(options.count, kPlannedPhotos);
  planned.convention = ReflectanceConvention::Photograph();
  planned.plane = {width, height, capture.sample_mm, capture.sample_mm * height / width,
                   planned.convention.sampling};
  planned.views = PhotoViews(PlanCapture(capture));
  planned.views.resize(options.count);
  return planned;
}

// Errors of the capture: those asked for, and those that belong to the discrepancy.
Disturbance DisturbanceOf(const ViewSetOptions& options) {
  Disturbance disturbance = options.disturbance;
  Discrepancy discrepancy;
  discrepancy.strength = options.discrepancy;
  const auto at_least = [&](double value, double* field) {
    *field = std::max(*field, discrepancy.strength * value);
  };
  at_least(discrepancy.light_off_deg, &disturbance.light_off_deg);
  at_least(discrepancy.registration_texel, &disturbance.registration_texel);
  at_least(discrepancy.ambient_percent, &disturbance.environment_percent);
  return disturbance;
}

}  // namespace

void AddViewSetOptions(ViewSetOptions* options, OptionSet* set) {
  set->AddRange("count", &options->count, 1, 10000, "number of views");
  set->AddChoice("rule", &options->rule, {"dir", "photo", "flash"},
                 "dir: camera and light co-located, DIR 2019's synthetic geometry; photo: a "
                 "phone's poses, flash beside the lens, inverse square; flash: the same, but "
                 "nearer vertical, like published flash captures");
  set->AddChoice("bits", &options->bits, {"8", "float"}, "8: clipped and rounded; float: exact");
  set->AddChoice("encoding", &options->encoding, {"gamma2.2", "srgb", "linear"},
                 "tone curve of the 8-bit views (DIR 2019, i.e. Gao et al. 2019, uses linear)");
  set->AddRange("exposure-stops", &options->exposure_stops, -20, 20,
                "multiply the exposure of all photographs by 2^stops; recorded in the manifest");
  set->AddRange("least-tilt-deg", &options->least_tilt_deg, 0, 65,
                "no top view: every camera is tilted by at least this angle and at most 10° more "
                "(--rule dir only); 0: off");
  Disturbance* disturbance = &options->disturbance;
  set->AddRange("light-off-deg", &disturbance->light_off_deg, 0, 60,
                "rotate every light direction by this angle; not recorded in the manifest");
  set->Add("light-together", &disturbance->light_together,
           "rotate all lights in the same direction, as if the flash were mounted elsewhere beside "
           "the lens");
  set->AddRange("registration-texel", &disturbance->registration_texel, 0, 100,
                "shift the corners of every view by this many texels (RMS); not recorded in the "
                "manifest");
  set->AddRange(
      "environment-percent", &disturbance->environment_percent, 0, 1000,
      "ambient illumination on a white plane relative to the flash; not recorded in the manifest");
  set->AddRange("discrepancy", &options->discrepancy, 0, 2,
                "strength of effects that the reflectance model cannot represent (other lobes, "
                "relief, diffuse blur, capture errors, JPEG); 1: as in real samples");
  set->Add("environment", &disturbance->environment,
           "equirectangular radiance map, .hdr or .exr (default: uniform white surroundings)");
}

PlannedViews PlanViews(const ViewSetOptions& options, std::uint64_t seed, int width, int height) {
  PlannedViews planned = UndisturbedViews(options, seed, width, height);
  planned.discrepancy.strength = options.discrepancy;
  planned.drawn_discrepancy = DrawDiscrepancy(planned.discrepancy, seed, options.count);
  const Disturbance disturbance = DisturbanceOf(options);
  if (disturbance.environment_percent > 0) {
    const View first = options.rule == "dir" ? DirView(0, 0) : planned.views[0];
    planned.environment = ScaledEnvironment(disturbance, first, planned.plane, planned.convention);
  }
  for (size_t i = 0; i < planned.views.size(); ++i) {
    planned.views[i].exposure *= std::exp2(options.exposure_stops);
    const ViewDisturbance drawn = DrawDisturbance(disturbance, seed, static_cast<int>(i));
    View taken = planned.views[i];
    taken.exposure *= planned.drawn_discrepancy.exposures[i];
    taken.light_in_sample_mm =
        TurnLight(taken.light_in_sample_mm, disturbance.light_off_deg, drawn.light_azimuth_rad);
    planned.taken.push_back(taken);
    planned.shifts.push_back(drawn.shifts);
  }
  return planned;
}

RectifiedImage RenderPlannedView(const SvbrdfMaps& maps, const PlannedViews& planned, int index,
                                 const ViewSetOptions& options, int threads) {
  RectifiedImage image{maps.width, maps.height, {}, {}};
  image.mask.assign(maps.texels(), 1.0f);
  const View& view = planned.taken[static_cast<size_t>(index)];
  if (planned.discrepancy.any()) {
    image.rgb = RenderDiscrepant(planned.discrepancy, planned.drawn_discrepancy, maps,
                                 IntegrateNormals(maps, planned.plane), planned.plane, view,
                                 planned.convention, threads);
  } else {
    image.rgb.resize(3 * maps.texels());
    RenderView(maps, planned.plane, view, planned.convention, image.rgb.data(), threads);
  }
  if (!planned.environment.lights.empty()) {
    AddEnvironment(planned.environment, maps, planned.plane, view, planned.convention,
                   image.rgb.data(), threads);
  }
  if (DisturbanceOf(options).registration_texel > 0) {
    ShiftPicture(planned.shifts[static_cast<size_t>(index)], maps.width, maps.height, &image.rgb);
  }
  if (options.bits == "float") return image;
  const size_t texels = maps.texels();
  const Encoding encoding = ParseEncoding(options.encoding);
  const EightBitEncoder encoder(encoding);
  std::vector<unsigned char> codes(3 * texels);
  for (size_t k = 0; k < codes.size(); ++k) codes[k] = encoder(image.rgb[k % 3 * texels + k / 3]);
  if (planned.discrepancy.any()) {
    codes = JpegRoundTrip(codes, maps.width, maps.height, planned.discrepancy.jpeg_quality);
  }
  const std::vector<float> decoded = LinearTable(encoding, 256);
  for (size_t k = 0; k < codes.size(); ++k) image.rgb[k % 3 * texels + k / 3] = decoded[codes[k]];
  return image;
}

void WriteViewSet(const fs::path& folder, const MaterialSource& material,
                  const ViewSetOptions& options, const CommonOptions& common) {
  const bool is_float = options.bits == "float";
  const PlannedViews planned =
      PlanViews(options, common.seed, material.maps.width, material.maps.height);
  RectifiedSet set = SetOf(planned, is_float);
  fs::create_directories(folder / "photos");
  fs::create_directories(folder / "truth");
  WriteSvbrdf(folder / "truth" / "svbrdf.exr", material.maps, planned.convention);
  WriteFileAtomically(folder / "capture.toml", CaptureToml(planned, options));
  std::vector<RectifiedImage> images;
  std::vector<fs::path> inputs;
  for (size_t i = 0; i < set.views.size(); ++i) {
    images.push_back(
        RenderPlannedView(material.maps, planned, static_cast<int>(i), options, common.threads));
    WriteViewPhoto(folder / set.views[i].photo, images.back(), options);
    inputs.push_back(folder / set.views[i].photo);
  }
  if (options.disturbance.environment_percent > 0 && !options.disturbance.environment.empty()) {
    inputs.push_back(options.disturbance.environment);
  }
  ViewSetOptions echoed = options;
  OptionSet echo;
  AddViewSetOptions(&echoed, &echo);
  Stage stage(folder / "glint" / "rectify", {"rectify", kStageVersion}, echo, common, inputs);
  if (stage.UpToDate()) return;
  for (size_t i = 0; i < set.views.size(); ++i) {
    WriteRectifiedImage(stage.Output(set.views[i].file), images[i], set, set.views[i]);
  }
  stage.Commit(ToJson(set), Json::object());
}

}  // namespace glint
