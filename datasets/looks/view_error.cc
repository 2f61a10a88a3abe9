#include "datasets/looks/view_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/errors/errors.h"
#include "base/formats/manifest.h"
#include "base/formats/rectified_rows.h"
#include "base/formats/svbrdf_file.h"
#include "base/formats/svbrdf_rows.h"
#include "base/images/image.h"
#include "base/reflectance/characteristic_curve.h"
#include "base/reflectance/log_radiance.h"
#include "base/resampling/resampling.h"
#include "fitting/photographs/photographs.h"
#include "fitting/photographs/picture_shift.h"
#include "fitting/render/render_environment.h"
#include "fitting/render/render_lit.h"
#include "fitting/view_correction/corrections_json.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

std::array<double, 3> OptionalNumbers(const fs::path& file, const Json& data,
                                      const std::string& field, std::array<double, 3> absent) {
  if (!data.contains(field)) return absent;
  const auto numbers = RequireNumbers(file, data, "data", field, 3);
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

ViewError CompareView(std::span<const float> rendered, const RectifiedImage& photograph, bool ldr) {
  const size_t texels = photograph.mask.size();
  if (rendered.size() != 3 * texels || photograph.rgb.size() != 3 * texels) {
    throw std::invalid_argument("rendering and photograph must have one size");
  }
  const auto seen = [ldr](float value) {
    const double v = std::max(value, 0.0f);
    return ldr ? std::min(v, 1.0) : v;
  };
  ViewError error;
  double squares = 0, logs = 0;
  for (size_t i = 0; i < texels; ++i) {
    if (photograph.mask[i] < 0.5f) continue;
    ++error.texels;
    for (size_t c = 0; c < 3; ++c) {
      const double photo = seen(photograph.rgb[c * texels + i]);
      const double render = seen(rendered[c * texels + i]);
      squares += (photo - render) * (photo - render);
      logs += std::abs(std::log(photo + kLogOffset) - std::log(render + kLogOffset));
    }
  }
  if (error.texels == 0) return error;
  error.mse = squares / (3.0 * static_cast<double>(error.texels));
  error.rmse = std::sqrt(error.mse);
  error.log_l1 = logs / (3.0 * static_cast<double>(error.texels));
  return error;
}

std::vector<bool> ToldTexels(const RectifiedImage& photograph, bool ldr) {
  const Photograph asked{{}, ldr, photograph.rgb, photograph.mask};
  std::vector<bool> told(photograph.mask.size());
  for (size_t i = 0; i < told.size(); ++i) {
    told[i] = photograph.mask[i] >= 0.5f || ReachesLimit(asked, i);
  }
  return told;
}

std::vector<float> LogResiduals(std::span<const float> rendered, const RectifiedImage& photograph,
                                bool ldr) {
  const size_t texels = photograph.mask.size();
  if (rendered.size() != 3 * texels || photograph.rgb.size() != 3 * texels) {
    throw std::invalid_argument("rendering and photograph must have one size");
  }
  const auto log = [ldr](float value) {
    const double v = std::max(value, 0.0f);
    return std::log((ldr ? std::min(v, 1.0) : v) + kLogOffset);
  };
  std::vector<float> residuals(rendered.size(), std::numeric_limits<float>::quiet_NaN());
  for (size_t k = 0; k < residuals.size(); ++k) {
    if (photograph.mask[k % texels] < 0.5f) continue;
    residuals[k] = static_cast<float>(log(photograph.rgb[k]) - log(rendered[k]));
  }
  return residuals;
}

namespace {

SvbrdfMaps ReadMapsAtMost(const fs::path& file, int most_side, ReflectanceConvention* convention) {
  if (most_side == 0) return ReadSvbrdf(file, convention);
  const ImageHeader header = ReadExrHeader(file);
  const auto [width, height] = SizeAtMost(header.width, header.height, most_side);
  return ResampledSvbrdf(file, width, height, convention).Read(0, height);
}

}  // namespace

FittedMaps ReadFittedMaps(const fs::path& path, int most_side) {
  FittedMaps fit;
  if (path.extension() == ".exr") {
    fit.maps = ReadMapsAtMost(path, most_side, &fit.convention);
    return fit;
  }
  const fs::path file = fs::is_directory(path) ? path / "manifest.json" : path;
  const Manifest manifest = ReadManifest(file);
  if (manifest.stage != "fit" && manifest.stage != "refine") {
    throw UserError(file, "stage", "'" + manifest.stage + "'",
                    "give the manifest of fit or refine, or an svbrdf.exr");
  }
  VerifyOutputs(file, manifest);
  fit.maps = ReadMapsAtMost(file.parent_path() / "svbrdf.exr", most_side, &fit.convention);
  fit.light_scale_rgb =
      OptionalNumbers(file, manifest.data, "light_scale_rgb", fit.light_scale_rgb);
  fit.shared_light = ReadSharedLight(file, manifest.data);
  fit.corrections = ReadCorrections(file, manifest.data);
  fit.environment = ReadEnvironmentLighting(file, manifest.data);
  return fit;
}

RectifiedImage PhotographOfFit(const FittedMaps& fit, const RectifiedSet& set,
                               const RectifiedView& view) {
  return PhotographOfFit(fit, set, view, set.plane.width, set.plane.height);
}

RectifiedImage PhotographOfFit(const FittedMaps& fit, const RectifiedSet& set,
                               const RectifiedView& view, int width, int height) {
  RectifiedReader reader(set, view);
  RectifiedImage photograph{width, height, {}, {}};
  if (width == set.plane.width && height == set.plane.height) {
    photograph = reader.Read(0, height);
  } else {
    const ReadRows read = [&](int first_row, int rows) {
      RectifiedImage part = reader.Read(first_row, rows);
      return Photograph{view.view, view.ldr, std::move(part.rgb), std::move(part.mask)};
    };
    Photograph small = DownsampledByRows(read, set.plane, width, height, 1);
    photograph.rgb = std::move(small.rgb);
    photograph.mask = std::move(small.mask);
  }
  const auto found = fit.corrections.find(view.name);
  if (found == fit.corrections.end() || !found->second.shifts.any()) return photograph;
  const CornerShifts shifts =
      AtSize({{found->second}, {}, {}}, set.plane.width, set.plane.height, width, height)
          .views[0]
          .shifts;
  ShiftPicture(shifts, width, height, &photograph.rgb);
  ShiftMask(shifts, width, height, &photograph.mask);
  return photograph;
}

View ViewOfFit(const FittedMaps& fit, const RectifiedView& view) {
  const auto found = fit.corrections.find(view.name);
  View lit = WithSharedLight(view.view, fit.shared_light);
  if (found != fit.corrections.end()) lit = CorrectedView(lit, found->second);
  for (int c = 0; c < 3; ++c) lit.light_rgb[c] *= fit.light_scale_rgb[c];
  return lit;
}

std::vector<float> RenderFit(const FittedMaps& fit, const RectifiedSet& set,
                             const RectifiedView& view, int threads) {
  const bool same_size = fit.maps.width == set.plane.width && fit.maps.height == set.plane.height;
  SvbrdfMaps resampled;
  if (!same_size) resampled = ResampleSvbrdf(fit.maps, set.plane.width, set.plane.height);
  const SvbrdfMaps& maps = same_size ? fit.maps : resampled;
  // The reflectance is the maps'; light and texels are the set's.
  ReflectanceConvention convention = set.convention;
  convention.diffuse_weight = fit.convention.diffuse_weight;
  convention.lobes = fit.convention.lobes;
  const View lit = ViewOfFit(fit, view);
  std::vector<float> rendered(3 * maps.texels());
  RenderLit(maps, set.plane, lit, convention, rendered.data(), threads);
  AddEnvironmentLighting(fit.environment, maps, set.plane, lit, convention, rendered.data(),
                         threads);
  if (view.encoded()) Record(lit.curve, rendered);
  return rendered;
}

void WritePair(const fs::path& file, const RectifiedImage& photograph, bool ldr,
               std::span<const float> rendered) {
  constexpr float kDifferenceGain = 4;
  const int width = photograph.width;
  const size_t texels = photograph.mask.size();
  const std::vector<bool> told = ToldTexels(photograph, ldr);
  Image image(3 * width, photograph.height, {"R", "G", "B"});
  for (int c = 0; c < 3; ++c) {
    for (size_t i = 0; i < texels; ++i) {
      const size_t row = i / width, column = i % width;
      float* out = image.channel(c).data() + row * image.width + column;
      const float seen = told[i] ? photograph.rgb[c * texels + i] : rendered[c * texels + i];
      const float photo = std::clamp(seen, 0.0f, 1.0f);
      const float render = std::clamp(rendered[c * texels + i], 0.0f, 1.0f);
      const float values[3] = {photo, render, kDifferenceGain * std::abs(photo - render)};
      for (int panel = 0; panel < 3; ++panel) {
        out[static_cast<ptrdiff_t>(panel) * width] =
            std::pow(std::clamp(values[panel], 0.0f, 1.0f), 1 / 2.2f);
      }
    }
  }
  WritePng(file, image);
}

}  // namespace glint
