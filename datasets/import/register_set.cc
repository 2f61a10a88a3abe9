#include "datasets/import/register_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/model/registration.h"
#include "base/parallel/parallel.h"
#include "datasets/import/read_image.h"
#include "rectify/views/rectify_photo.h"

namespace glint {
namespace {

double MarginOf(const LinearPhoto& photo, PixelSize sample) {
  return std::clamp(std::min(static_cast<double>(photo.width()) / sample.width,
                             static_cast<double>(photo.height()) / sample.height),
                    1.0, constants::kLargestImportMargin);
}

// The picture from the top, the sample and a margin, small.
TopView SmallView(const LinearPhoto& photo, const SamplePlane& plane, PixelSize sample,
                  double margin) {
  const double longest = std::max(sample.width, sample.height);
  const double scale = margin * std::min(1.0, constants::kRegistrationSide_px / longest);
  SamplePlane small;
  small.width = static_cast<int>(std::lround(sample.width * scale));
  small.height = static_cast<int>(std::lround(sample.height * scale));
  small.width_mm = margin * plane.width_mm;
  small.height_mm = margin * plane.height_mm;
  SamplePlane whole = plane;
  whole.sampling = small.sampling;
  whole.width_mm *= static_cast<double>(photo.width()) / sample.width;
  whole.height_mm *= static_cast<double>(photo.height()) / sample.height;
  ResampleOptions options;
  options.border_px = longest;  // texels at the rim hold what is nearest
  const ResampledView view = ResampleToPlane(
      photo, TopViewProjection(whole, photo.width(), photo.height()), small, options);
  TopView top{small.width, small.height, {}, {}};
  const size_t texels = view.status.size();
  for (size_t i = 0; i < texels; ++i) {
    top.radiance.push_back((view.rgb[i] + view.rgb[texels + i] + view.rgb[2 * texels + i]) / 3);
  }
  return top;
}

Eigen::Vector3d Vector(const Vec3d& v) { return {v[0], v[1], v[2]}; }

}  // namespace

SampleRegistration RegisterSet(const ForeignSet& set, const ImportOptions& options,
                               const SamplePlane& plane, int threads) {
  RegistrationProblem problem;
  problem.sample_width_mm = plane.width_mm;
  problem.sample_height_mm = plane.height_mm;
  problem.views.resize(set.views.size());
  const double longest_mm = std::max(plane.width_mm, plane.height_mm);
  const bool wanted = options.registration == "auto" && set.photographs() && set.views.size() > 1;
  problem.height_mm = set.plane_mm.value_or(0);
  problem.height_sd_mm = !wanted || set.plane_mm ? 0 : constants::kImportedHeightSd * longest_mm;
  problem.often_as_said = false;
  problem.homography_sd_mm = wanted ? constants::kImportedPlaceSd * longest_mm : 0;
  if (!wanted) return Unregistered(problem);
  const PixelSize sample = SampleSize(set);
  problem.margin = MarginOf(ReadLinear(set.views[0], set.encoding, options), sample);
  ForEachPiece(static_cast<int>(set.views.size()), threads, [&](int piece) {
    const auto i = static_cast<size_t>(piece);
    const LinearPhoto photo = ReadLinear(set.views[i], set.encoding, options);
    problem.views[i] = SmallView(photo, plane, sample, problem.margin);
    problem.views[i].camera_mm = Vector(set.views[i].view.camera_in_sample_mm);
  });
  return RegisterSample(problem, threads);
}

Eigen::Matrix3d RectifiedFromSample(const SampleRegistration& registration, const View& view,
                                    size_t index) {
  return AssumedFromSample(registration.plane, Vector(view.camera_in_sample_mm)) *
         registration.homographies[index];
}

View InSampleFrame(View view, const PlaneValues& sample_plane) {
  const Rigid3 sample_from_assumed = Inverse(AssumedFromSample(sample_plane));
  for (Vec3d* point : {&view.camera_in_sample_mm, &view.light_in_sample_mm}) {
    const Eigen::Vector3d moved = sample_from_assumed * Vector(*point);
    *point = {moved.x(), moved.y(), moved.z()};
  }
  return view;
}

Json RegistrationMetrics(const SampleRegistration& registration, const SamplePlane& plane) {
  const double texel_mm = plane.width_mm / plane.width;
  const auto sigma = [&](int i) { return std::sqrt(registration.plane_covariance(i, i)); };
  return {{"told_by_texture", registration.told},
          {"height_mm", registration.plane[0]},
          {"height_sd_mm", sigma(0)},
          {"slope", {registration.plane[1], registration.plane[2]}},
          {"slope_sd", {sigma(1), sigma(2)}},
          {"windows", registration.windows},
          {"measured", registration.measured},
          {"displaced_before_texel", registration.displaced_before_mm / texel_mm},
          {"displaced_after_texel", registration.displaced_after_mm / texel_mm}};
}

std::string RegistrationText(const Json& metrics) {
  if (!metrics["told_by_texture"].get<bool>()) return "";
  return fmt::format(
      "  sample {:.2f} ± {:.2f} mm above its plane; photographs displaced by {:.2f} texels, after "
      "registration {:.2f}\n",
      metrics["height_mm"].get<double>(), metrics["height_sd_mm"].get<double>(),
      metrics["displaced_before_texel"].get<double>(),
      metrics["displaced_after_texel"].get<double>());
}

}  // namespace glint
