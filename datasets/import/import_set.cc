#include "datasets/import/import_set.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "base/errors/errors.h"
#include "base/linearize/light_guess.h"
#include "base/programs/progress.h"
#include "datasets/import/read_image.h"
#include "datasets/import/register_set.h"
#include "rectify/views/rectify_photo.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kSmallest_px = 8, kLargest_px = 16384;
constexpr double kSquareTexels = 0.01;  // how far the sides of a texel may differ

// "1500" or "1500,1400,1300".
Vec3d ParsePower(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.c_str();
  while (true) {
    char* end = nullptr;
    numbers.push_back(std::strtod(at, &end));
    if (end == at || !(numbers.back() > 0) || !std::isfinite(numbers.back())) break;
    if (*end == '\0' && numbers.size() == 1) return {numbers[0], numbers[0], numbers[0]};
    if (*end == '\0' && numbers.size() == 3) return {numbers[0], numbers[1], numbers[2]};
    if (*end != ',' || numbers.size() == 3) break;
    at = end + 1;
  }
  throw UserError("--light-power: found '" + text +
                  "'; use estimate, a number above 0, or three as r,g,b (radiance·mm²)");
}

// One pixel a texel: the values as they are.
ResampledView CopyCentre(const LinearPhoto& photo, const SamplePlane& plane) {
  const size_t texels = static_cast<size_t>(plane.width) * plane.height;
  ResampledView view{plane.width, plane.height, std::vector<float>(3 * texels),
                     std::vector<TexelStatus>(texels)};
  const int left = (photo.width() - plane.width) / 2, top = (photo.height() - plane.height) / 2;
  photo.Visit([&](const auto& reader) {
    for (int row = 0; row < plane.height; ++row) {
      for (int column = 0; column < plane.width; ++column) {
        const auto pixel =
            reader.At(static_cast<size_t>(top + row) * photo.width() + left + column);
        const size_t texel = static_cast<size_t>(row) * plane.width + column;
        for (size_t c = 0; c < 3; ++c) view.rgb[c * texels + texel] = pixel.rgb[c];
        view.status[texel] = pixel.saturated ? TexelStatus::kSaturated : TexelStatus::kUsable;
      }
    }
  });
  return view;
}

// The image resampled to the sample's plane, `rectified_from_sample` on the one that it was
// rectified for; what lies beside the sample in it serves the filter at the rim.
RectifiedImage ToPlane(const LinearPhoto& photo, const SamplePlane& plane, PixelSize sample,
                       const Eigen::Matrix3d& rectified_from_sample, int threads,
                       const fs::path& file, ViewCounts* counts) {
  const bool moved = !rectified_from_sample.isIdentity(0);
  if (!moved && sample.width == plane.width && sample.height == plane.height) {
    RectifiedImage image = MaskView(CopyCentre(photo, plane), file, counts);
    counts->pixels_per_texel = 1;
    return image;
  }
  SamplePlane whole = plane;  // of the whole image, at the sample's scale
  whole.width_mm *= static_cast<double>(photo.width()) / sample.width;
  whole.height_mm *= static_cast<double>(photo.height()) / sample.height;
  ResampleOptions options;
  options.threads = threads;
  // Corner to corner, the outermost texels reach half their width beyond the picture.
  if (plane.sampling == TexelSampling::kCornerToCorner) {
    options.border_px = static_cast<double>(sample.width) / plane.width;
  }
  const HomographyProjection picture = TopViewProjection(whole, photo.width(), photo.height());
  return RectifyPhoto(photo, MovedProjection(picture, rectified_from_sample), plane, options, {},
                      file, counts);
}

void RequireSize(const LinearPhoto& photo, const ForeignView& view, PixelSize wanted,
                 const fs::path& first) {
  if (photo.width() == wanted.width && photo.height() == wanted.height) return;
  throw UserError(view.image, "size", fmt::format("{}x{}", photo.width(), photo.height()),
                  fmt::format("{} is {}x{}; give all images the same size",
                              first.filename().string(), wanted.width, wanted.height));
}

}  // namespace

void AddImportOptions(OptionSet* set, ImportOptions* options) {
  set->AddRange("size", &options->size, 0, kLargest_px,
                "resample to this width in texels; 0: keep the images' width");
  set->AddRange(
      "crop", &options->crop, 0, kLargest_px,
      "the sample is the central square with sides of this many pixels; 0: the layout's default");
  set->AddChoice("registration", &options->registration, {"auto", "none"},
                 "auto: find the sample's plane and bring photographs into one frame; none: use "
                 "the views as they are (always so for renderings, convention dir2019)");
  set->Add("convention", &options->convention,
           "reflectance convention: photograph, dir2019, materialgan, or keywords as in "
           "docs/views.md; if omitted, the source's");
  set->Add("light-power", &options->light_power,
           "estimate, a number, or r,g,b in radiance·mm²; if omitted, the source's");
  set->AddChoice("encoding", &options->encoding, {"", "auto", "srgb", "gamma2.2", "linear"},
                 "encoding of the images; if omitted, the source's");
  set->AddRange(
      "saturation-level", &options->saturation_level, 0.5, 1.01,
      "stored value (full scale is 1) at or above which a pixel of an 8- or 16-bit image counts as "
      "clipped; above 1: never");
  set->AddRange("float-saturation-level", &options->float_saturation_level, 0, 1e9,
                "the same for float images; 0: they never clip");
}

void ApplyOptions(const ImportOptions& options, ForeignSet* set) {
  if (options.crop > 0) set->crop_px = options.crop;
  if (!options.encoding.empty()) set->encoding = options.encoding;
  if (!options.convention.empty()) {
    try {
      set->convention = ParseReflectanceConvention(options.convention);
    } catch (const std::invalid_argument& error) {
      throw UserError("--convention: " + std::string(error.what()));
    }
  }
  if (options.light_power == "estimate") {
    set->light_power_known = set->light_power_given = false;
  } else if (!options.light_power.empty()) {
    const Vec3d power = ParsePower(options.light_power);
    for (ForeignView& view : set->views) view.view.light_rgb = power;
    set->light_power_known = set->light_power_given = true;
  }
}

std::vector<fs::path> ImportInputs(const ForeignSet& set) {
  std::vector<fs::path> inputs = set.description;
  for (const ForeignView& view : set.views) inputs.push_back(view.image);
  return inputs;
}

SamplePlane ImportedPlane(const ForeignSet& set, const ImportOptions& options) {
  const PixelSize sample = SampleSize(set);
  const double aspect = (set.width_mm / sample.width) / (set.height_mm / sample.height);
  if (std::abs(aspect - 1) > kSquareTexels) {
    throw UserError(set.description[0], "size_mm",
                    fmt::format("{} x {} mm", set.width_mm, set.height_mm),
                    fmt::format("the images are {}x{} pixels, and pixels are square", sample.width,
                                sample.height));
  }
  SamplePlane plane;
  plane.width = sample.width;
  plane.height = sample.height;
  if (options.size > 0) {
    plane.height = static_cast<int>(
        std::lround(static_cast<double>(options.size) * sample.height / sample.width));
    plane.width = options.size;
  }
  if (std::min(plane.width, plane.height) < kSmallest_px ||
      std::max(plane.width, plane.height) > kLargest_px) {
    throw UserError(fmt::format("--size: found {}x{} texels; both sides must be from {} to {}",
                                plane.width, plane.height, kSmallest_px, kLargest_px));
  }
  plane.width_mm = set.width_mm;
  plane.height_mm = set.height_mm;
  plane.sampling = set.convention.sampling;
  return plane;
}

ImportSummary ImportSet(const ForeignSet& foreign, const ImportOptions& options,
                        const CommonOptions& common, Stage* stage) {
  ImportSummary summary;
  RectifiedSet& set = summary.set;
  set.plane = ImportedPlane(foreign, options);
  set.convention = foreign.convention;
  set.light_power_known = foreign.light_power_known;
  summary.metrics["layout"] = std::string(ForeignLayoutName(foreign.layout));
  summary.metrics["views"] = Json::array();
  const fs::path& first = foreign.views[0].image;
  const auto [image_width, image_height] = PhotoSize(first);
  const PixelSize size{image_width, image_height}, sample = SampleSize(foreign);
  const SampleRegistration registration = RegisterSet(foreign, options, set.plane, common.threads);
  summary.metrics["registration"] = RegistrationMetrics(registration, set.plane);
  LightGuess guess(set.plane, set.convention.falloff);
  Progress progress("import", static_cast<int64_t>(foreign.views.size()));
  for (size_t i = 0; i < foreign.views.size(); ++i) {
    const ForeignView& source = foreign.views[i];
    RectifiedView view;
    view.name = ViewName(i);
    view.file = view.name + ".exr";
    view.photo = source.name;
    view.view = InSampleFrame(source.view, registration.plane);
    const LinearPhoto photo = ReadLinear(source, foreign.encoding, options);
    view.ldr = source.ldr.value_or(!photo.is_float());
    view.linear = photo.stored_linear();
    RequireSize(photo, source, size, first);
    ViewCounts counts;
    const RectifiedImage image =
        ToPlane(photo, set.plane, sample, RectifiedFromSample(registration, source.view, i),
                common.threads, source.image, &counts);
    WriteRectifiedImage(stage->Output(view.file), image, set, view);
    guess.Add(image);
    Json metrics = {{"name", view.name}};
    metrics.update(ToJson(counts));
    summary.metrics["views"].push_back(metrics);
    set.views.push_back(std::move(view));
    progress.Advance(1, source.name);
  }
  if (!foreign.light_power_given) GiveLight(guess, &set);
  stage->Commit(ToJson(set), summary.metrics);
  set.manifest_file = stage->manifest_file();
  return summary;
}

std::string ImportedCaptureToml(const ForeignSet& set, const SamplePlane& plane) {
  return fmt::format(
      "# Written by glint-import from a set in the layout of {}.\n"
      "# Its views are rectified already (glint/rectify), so there are no photographs and no "
      "board\n"
      "# here, and glint run starts at fit.\n\n"
      "[sample]\n"
      "size_mm = [{}, {}]\n"
      "resolution_px = [{}, {}]\n",
      ForeignLayoutName(set.layout), set.width_mm, set.height_mm, plane.width, plane.height);
}

}  // namespace glint
