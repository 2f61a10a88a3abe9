#include "rectify/views/rectify_photo.h"

#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "pipeline/contract/errors.h"

namespace glint {
namespace {

// Below the darkest step of an 8-bit photo of gamma 2.2 that noise leaves (code 4).
constexpr float kBlack = 1e-4f;

double PixelsPerTexel(const PlaneProjection& projection, const SamplePlane& plane) {
  const double dx = plane.width_mm / plane.width, dy = plane.height_mm / plane.height;
  const auto centre = projection.ImageFromPlane(0, 0);
  const auto right = projection.ImageFromPlane(dx, 0), down = projection.ImageFromPlane(0, -dy);
  if (!centre || !right || !down) return 0;
  Eigen::Matrix2d jacobian;
  jacobian << *right - *centre, *down - *centre;
  return std::sqrt(std::abs(jacobian.determinant()));
}

ViewCounts Count(const ResampledView& view) {
  const size_t texels = view.status.size();
  size_t by_status[4] = {0, 0, 0, 0};
  size_t black = 0;
  for (size_t i = 0; i < texels; ++i) {
    ++by_status[static_cast<size_t>(view.status[i])];
    if (view.status[i] == TexelStatus::kUsable && view.rgb[i] < kBlack &&
        view.rgb[texels + i] < kBlack && view.rgb[2 * texels + i] < kBlack) {
      ++black;
    }
  }
  const auto fraction = [&](TexelStatus status) {
    return static_cast<double>(by_status[static_cast<size_t>(status)]) /
           static_cast<double>(texels);
  };
  return {fraction(TexelStatus::kUsable),
          fraction(TexelStatus::kOutside),
          fraction(TexelStatus::kSaturated),
          fraction(TexelStatus::kMasked),
          static_cast<double>(black) / static_cast<double>(texels),
          0};
}

void RequireUsable(const ViewCounts& counts, const std::filesystem::path& file) {
  if (counts.usable > 0) {
    if (counts.black < counts.usable) return;
    throw UserError(file, "sample", "a black sample: no texel reflects any light",
                    "check that the flash fired, or leave this photograph out");
  }
  if (counts.saturated > 0) {
    throw UserError(file, "sample", "a saturated sample: every texel has clipped pixels",
                    "expose less, or leave this photograph out");
  }
  if (counts.outside > 0) {
    throw UserError(file, "sample", "a sample that lies outside of the photograph",
                    "show the sample whole, check [sample] size_mm and centre_mm, or leave this "
                    "photograph out");
  }
  throw UserError(file, "sample", "a sample that lies under the board's frame",
                  "check [sample] size_mm and centre_mm and [board] window");
}

}  // namespace

Json ToJson(const ViewCounts& counts) {
  return {{"usable", counts.usable},       {"outside", counts.outside},
          {"saturated", counts.saturated}, {"masked", counts.masked},
          {"black", counts.black},         {"pixels_per_texel", counts.pixels_per_texel}};
}

View ViewOf(const Calibration& calibration, const CalibratedPhoto& photo,
            const std::vector<double>& ambient, const std::filesystem::path& calibration_file) {
  const Rigid3 sample_from_camera = Inverse(photo.camera_from_sample);
  const Eigen::Vector3d camera = sample_from_camera.translation;
  const Eigen::Vector3d light = sample_from_camera * photo.light_in_camera_mm;
  for (const auto& [what, z] : {std::pair{"camera", camera.z()}, std::pair{"light", light.z()}}) {
    if (z > 0) continue;
    throw UserError(
        calibration_file, photo.photo,
        "a " + std::string(what) + " behind the sample (z = " + std::to_string(z) + " mm)",
        "check [board] and [light] offset_mm and run calib again");
  }
  View view;
  view.camera_in_sample_mm = {camera.x(), camera.y(), camera.z()};
  view.light_in_sample_mm = {light.x(), light.y(), light.z()};
  view.light_rgb = {calibration.light_rgb.x(), calibration.light_rgb.y(),
                    calibration.light_rgb.z()};
  view.ambient_rgb = {ambient[0], ambient[1], ambient[2]};
  if (calibration.ambient_rgb) {
    for (int c = 0; c < 3; ++c) view.ambient_rgb[c] = (*calibration.ambient_rgb)[c];
  }
  return view;
}

RectifiedImage MaskView(ResampledView view, const std::filesystem::path& file, ViewCounts* counts) {
  *counts = Count(view);
  RequireUsable(*counts, file);
  RectifiedImage image{view.width, view.height, std::move(view.rgb), {}};
  image.mask.reserve(view.status.size());
  for (const TexelStatus status : view.status) {
    image.mask.push_back(status == TexelStatus::kUsable ? 1.0f : 0.0f);
  }
  return image;
}

RectifiedImage RectifyPhoto(const LinearPhoto& photo, const PlaneProjection& projection,
                            const SamplePlane& plane, const ResampleOptions& options,
                            const std::vector<TexelStatus>& status_before,
                            const std::filesystem::path& file, ViewCounts* counts) {
  RectifiedImage image =
      MaskView(ResampleToPlane(photo, projection, plane, options, status_before), file, counts);
  counts->pixels_per_texel = PixelsPerTexel(projection, plane);
  return image;
}

}  // namespace glint
