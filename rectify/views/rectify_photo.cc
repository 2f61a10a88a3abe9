#include "rectify/views/rectify_photo.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors/errors.h"

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

// Counts texels as rows go by.
class TexelCounter {
 public:
  void Add(const ResampledView& rows) {
    const size_t texels = rows.status.size();
    texels_ += texels;
    for (size_t i = 0; i < texels; ++i) {
      ++by_status_[static_cast<size_t>(rows.status[i])];
      if (rows.status[i] == TexelStatus::kUsable && rows.rgb[i] < kBlack &&
          rows.rgb[texels + i] < kBlack && rows.rgb[2 * texels + i] < kBlack) {
        ++black_;
      }
    }
  }
  ViewCounts counts() const {
    return {Share(by_status_[static_cast<size_t>(TexelStatus::kUsable)]),
            Share(by_status_[static_cast<size_t>(TexelStatus::kOutside)]),
            Share(by_status_[static_cast<size_t>(TexelStatus::kSaturated)]),
            Share(by_status_[static_cast<size_t>(TexelStatus::kMasked)]),
            Share(black_),
            0};
  }

 private:
  double Share(size_t count) const {
    return static_cast<double>(count) / static_cast<double>(texels_);
  }
  size_t texels_ = 0, black_ = 0;
  size_t by_status_[4] = {0, 0, 0, 0};
};

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
    throw UserError(file, "sample", "a sample that lies outside the photograph",
                    "get the whole sample into the picture, check [sample] size_mm and centre_mm, "
                    "or leave this "
                    "photograph out");
  }
  throw UserError(file, "sample", "a sample that lies under the board's frame",
                  "check [sample] size_mm and centre_mm and [board] window");
}

// The view's radiance is corrected, and so is what lit it.
void CorrectLights(const ColourCorrection& correction, View* view) {
  const Eigen::Vector3d flash =
      correction.Flash(Eigen::Vector3d(view->light_rgb[0], view->light_rgb[1], view->light_rgb[2]));
  const Eigen::Vector3d ambient =
      correction(Eigen::Vector3d(view->ambient_rgb[0], view->ambient_rgb[1], view->ambient_rgb[2]));
  for (int c = 0; c < 3; ++c) {
    view->light_rgb[c] = flash[c];
    view->ambient_rgb[c] = std::max(0.0, ambient[c]);
  }
}

RectifiedImage WithMask(ResampledView view) {
  RectifiedImage image{view.width, view.height, std::move(view.rgb), {}};
  image.mask.reserve(view.status.size());
  for (const TexelStatus status : view.status) {
    image.mask.push_back(status == TexelStatus::kUsable ? 1.0f : 0.0f);
  }
  return image;
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
  if (calibration.colour_correction) CorrectLights(*calibration.colour_correction, &view);
  return view;
}

RectifiedImage MaskView(ResampledView view, const std::filesystem::path& file, ViewCounts* counts) {
  TexelCounter counter;
  counter.Add(view);
  *counts = counter.counts();
  RequireUsable(*counts, file);
  return WithMask(std::move(view));
}

RectifiedImage RectifyPhoto(const LinearPhoto& photo, const PlaneProjection& projection,
                            const SamplePlane& plane, const ResampleOptions& options,
                            const FrameStatus& frame, const std::filesystem::path& file,
                            ViewCounts* counts) {
  const std::vector<TexelStatus> before = frame ? frame(plane) : std::vector<TexelStatus>();
  RectifiedImage image =
      MaskView(ResampleToPlane(photo, projection, plane, options, before), file, counts);
  counts->pixels_per_texel = PixelsPerTexel(projection, plane);
  return image;
}

ViewCounts RectifyByRows(const LinearPhoto& photo, const PlaneProjection& projection,
                         const SamplePlane& plane, const ResampleOptions& options,
                         const FrameStatus& frame, const std::filesystem::path& file,
                         const std::function<void(const RectifiedImage& rows)>& take) {
  TexelCounter counter;
  for (int first = 0; first < plane.height; first += kRowsAtOnce) {
    const SamplePlane rows = plane.Rows(first, std::min(kRowsAtOnce, plane.height - first));
    const std::vector<TexelStatus> before = frame ? frame(rows) : std::vector<TexelStatus>();
    ResampledView view = ResampleToPlane(photo, projection, rows, options, before);
    counter.Add(view);
    take(WithMask(std::move(view)));
  }
  ViewCounts counts = counter.counts();
  RequireUsable(counts, file);
  counts.pixels_per_texel = PixelsPerTexel(projection, plane);
  return counts;
}

}  // namespace glint
