#include "datasets/synth/view_set.h"

#include <fmt/format.h>

#include <algorithm>

#include "datasets/procedural/random.h"
#include "datasets/synth/capture_plan.h"
#include "datasets/synth/photo_file.h"
#include "fitting/render/renderer.h"
#include "pipeline/contract/errors.h"
#include "pipeline/contract/files.h"
#include "pipeline/contract/image.h"
#include "pipeline/contract/stage.h"
#include "pipeline/contract/svbrdf_file.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kStageVersion = 1;  // of stage "rectify" as written here
constexpr double kDirSide = 2.0;  // DIR's plane spans [-1, 1]²

Vec3d ToVec3d(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

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
    view.name = fmt::format("view_{:03}", i);
    view.file = view.name + ".exr";
    view.photo = PhotoName(static_cast<int>(i), is_float);
    view.ldr = !is_float;
    view.view = planned.views[i];
    set.views.push_back(view);
  }
  return set;
}

}  // namespace

void AddViewSetOptions(ViewSetOptions* options, OptionSet* set) {
  set->AddRange("count", &options->count, 1, 10000, "views");
  set->AddChoice(
      "rule", &options->rule, {"dir", "photo"},
      "dir: camera = light, DIR 2019's synthetic geometry; photo: a phone's poses, flash "
      "beside the lens, inverse square");
  set->AddChoice("bits", &options->bits, {"8", "float"}, "8: clipped and rounded; float: exact");
  set->AddChoice("encoding", &options->encoding, {"gamma2.2", "srgb", "linear"},
                 "what the 8 bits are spaced evenly in (linear: as in DIR 2019)");
}

PlannedViews PlanViews(const ViewSetOptions& options, std::uint64_t seed, int width, int height) {
  PlannedViews planned;
  if (options.rule == "dir") {
    planned.convention = ReflectanceConvention::Dir2019();
    planned.plane = {width, height, kDirSide, kDirSide * height / width,
                     planned.convention.sampling};
    planned.views = DirViews(options.count, seed);
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

RectifiedImage RenderPlannedView(const SvbrdfMaps& maps, const PlannedViews& planned, int index,
                                 const ViewSetOptions& options, int threads) {
  RectifiedImage image{maps.width, maps.height, {}, {}};
  image.rgb.resize(3 * maps.texels());
  image.mask.assign(maps.texels(), 1.0f);
  RenderView(maps, planned.plane, planned.views[index], planned.convention, image.rgb.data(),
             threads);
  if (options.bits == "float") return image;
  const Encoding encoding = ParseEncoding(options.encoding);
  const EightBitEncoder encoder(encoding);
  const std::vector<float> decoded = LinearTable(encoding, 256);
  for (float& value : image.rgb) value = decoded[encoder(value)];
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
  ViewSetOptions echoed = options;
  OptionSet echo;
  AddViewSetOptions(&echoed, &echo);
  Stage stage(folder / "glint" / "rectify", {"rectify", kStageVersion}, echo, common, inputs);
  if (stage.UpToDate()) return;
  for (size_t i = 0; i < set.views.size(); ++i) {
    WriteRectifiedImage(stage.Output(set.views[i].file), images[i], set);
  }
  stage.Commit(ToJson(set), Json::object());
}

}  // namespace glint
