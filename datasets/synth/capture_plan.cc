#include "datasets/synth/capture_plan.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/errors/errors.h"
#include "datasets/procedural/random.h"

namespace glint {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using procedural::Rng;

constexpr double kDegree = std::numbers::pi / 180.0;
// Azimuths of successive photos: the golden angle spreads any number of them evenly.
constexpr double kGoldenAngle = 2.399963229728653;

// Streams of random numbers that must not follow each other's length.
enum Stream : std::uint64_t { kLensStream = 1, kPoseStream = 2, kExposureStream = 3 };

Rng StreamOf(std::uint64_t seed, Stream stream) {
  return Rng(procedural::Mix64(seed) ^ (0x5eed0000ull + stream));
}

void CheckOptions(const CapturePlanOptions& o) {
  const auto require = [](bool fine, const std::string& what) {
    if (!fine) throw UserError(what);
  };
  require(o.photos >= 1 && o.photos <= 1000, "photos: use 1 to 1000");
  require(o.megapixels >= 0.05 && o.megapixels <= 60, "megapixels: use 0.05 to 60");
  require(o.sample_mm >= 10 && o.sample_mm <= 1000, "sample-mm: use 10 to 1000");
  require(
      o.nearest_mm > 0 && o.farthest_mm >= o.nearest_mm && o.nearest_mm >= 1.2 * o.sample_mm,
      "distance-mm: the nearest must be positive, at least 1.2 times the sample's side, and not "
      "above the farthest");
  require(o.largest_tilt_deg >= 0 && o.largest_tilt_deg <= 65, "tilt-deg: use 0 to 65");
  require(o.directions.empty() || o.directions.size() == static_cast<size_t>(o.photos),
          "directions: give one a photograph");
  for (const CameraDirection& direction : o.directions) {
    require(direction.tilt_deg >= 0 && direction.tilt_deg <= 65,
            "directions: use tilts of 0 to 65");
  }
  require(o.paper_level > 0 && o.paper_level <= 4, "paper-level: use a number in (0, 4]");
  require(o.ambient >= 0 && o.ambient <= 10, "ambient: use 0 to 10");
  require(o.vignetting >= 0 && o.vignetting <= 0.8, "vignetting: use 0 to 0.8");
  require(o.exposure_ev >= 0 && o.exposure_ev <= 4, "exposure-ev: use 0 to 4");
  require(o.exif_error >= 0 && o.exif_error <= 0.5, "exif-error: use 0 to 0.5");
  for (const double tint : o.flash_tint) {
    require(tint > 0 && tint <= 1, "flash-tint: each channel must lie in (0, 1]");
  }
}

// Looking from `camera` at `target`, the top of the picture toward +y of the sample, then turned
// about the line of sight.
Rigid3 LookAt(const Vector3d& camera, const Vector3d& target, double roll) {
  const Vector3d forward = (target - camera).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitY()).normalized();
  const Vector3d down = forward.cross(right);
  Rigid3 camera_from_sample;
  camera_from_sample.rotation.row(0) = std::cos(roll) * right + std::sin(roll) * down;
  camera_from_sample.rotation.row(1) = -std::sin(roll) * right + std::cos(roll) * down;
  camera_from_sample.rotation.row(2) = forward;
  camera_from_sample.translation = -(camera_from_sample.rotation * camera);
  return camera_from_sample;
}

struct DrawnPose {
  Vector3d direction;  // from the sample to the camera
  double distance_mm;
  Vector2d target_mm;
  double roll;
};

// Range of tilts of a photo: about none in the first, then in turn small ones, which put the
// flash's reflection on the sample, and large ones, which tie down focal length and diffuse colour.
std::pair<double, double> TiltRange_deg(int index, double largest) {
  if (index == 0) return {0.0, std::min(2.0, largest)};
  const double middle = std::min(15.0, largest);
  return index % 2 == 0 ? std::pair{std::min(4.0, largest), middle} : std::pair{middle, largest};
}

DrawnPose DrawPose(const CapturePlanOptions& options, int index, double first_azimuth, Rng& rng) {
  const auto [low, high] = TiltRange_deg(index, options.largest_tilt_deg);
  double azimuth = first_azimuth + index * kGoldenAngle + 0.3 * (2.0 * rng.Unit() - 1.0);
  double tilt = kDegree * (low + (high - low) * rng.Unit());
  if (!options.directions.empty()) {
    const CameraDirection& told = options.directions[static_cast<size_t>(index)];
    azimuth = kDegree * told.azimuth_deg;
    tilt = kDegree * told.tilt_deg;
  }
  const double jitter_mm = (index == 0 ? 0.03 : 0.08) * options.sample_mm;
  DrawnPose pose;
  pose.direction = {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                    std::cos(tilt)};
  pose.distance_mm = options.nearest_mm + (options.farthest_mm - options.nearest_mm) * rng.Unit();
  pose.target_mm.x() = jitter_mm * (2.0 * rng.Unit() - 1.0);
  pose.target_mm.y() = jitter_mm * (2.0 * rng.Unit() - 1.0);
  pose.roll = kDegree * (index == 0 ? 3.0 : 12.0) * (2.0 * rng.Unit() - 1.0);
  return pose;
}

// The four corners of the squares lie in the picture, `share` of the half picture or less from its
// centre.
bool BoardInPicture(const CapturePlan& plan, const Rigid3& camera_from_sample, double share) {
  const BoardRectangle outline = OutlineInSample(plan.board);
  const Vector2d half_px(0.5 * plan.camera.width_px, 0.5 * plan.camera.height_px);
  for (const double x_mm : {outline.left_mm, outline.right_mm}) {
    for (const double y_mm : {outline.bottom_mm, outline.top_mm}) {
      const Vector3d corner = camera_from_sample * Vector3d(x_mm, y_mm, 0);
      if (corner.z() < 0.1 * plan.options.nearest_mm) return false;
      const Vector2d offset = ImageFromCamera(plan.camera, corner) - half_px;
      if ((offset.cwiseAbs().array() > share * half_px.array()).any()) return false;
    }
  }
  return true;
}

// Steps back, as a photographer would, until the board is in the picture; tilted views may cut it a
// little.
PlannedPhoto PlacePhoto(const CapturePlan& plan, int index, DrawnPose pose) {
  constexpr int kMostSteps = 100;
  const double share = index == 0 ? 0.99 : 1.06;
  PlannedPhoto photo;
  for (int step = 0; step < kMostSteps; ++step, pose.distance_mm *= 1.02) {
    const Vector3d target(pose.target_mm.x(), pose.target_mm.y(), 0);
    photo.camera_from_sample =
        LookAt(target + pose.distance_mm * pose.direction, target, pose.roll);
    if (BoardInPicture(plan, photo.camera_from_sample, share)) break;
  }
  const auto& offset = plan.options.flash_offset_mm;
  photo.light_in_sample_mm =
      Inverse(photo.camera_from_sample) * Vector3d(offset[0], offset[1], offset[2]);
  if (photo.light_in_sample_mm.z() < 0.2 * plan.options.nearest_mm) {
    throw UserError("flash-offset-mm: puts the flash at or below the sample; use a smaller offset");
  }
  return photo;
}

// Irradiance on the sheet per power.
double LightGeometry(const Vector3d& light_mm, double x_mm, double y_mm) {
  const Vector3d to_light = light_mm - Vector3d(x_mm, y_mm, 0);
  const double distance = to_light.norm();
  return to_light.z() / (distance * distance * distance);
}

// Exposures from −ev to +ev in even steps, shuffled, relative to the first photo's.
void DrawExposures(CapturePlan* plan) {
  const CapturePlanOptions& options = plan->options;
  if (options.exposure_ev <= 0 && options.exif_error <= 0) return;
  Rng rng = StreamOf(options.seed, kExposureStream);
  const size_t count = plan->photos.size();
  std::vector<double> stops(count, 0.0);
  for (size_t i = 0; i < count && count > 1; ++i) {
    stops[i] = options.exposure_ev * (2.0 * static_cast<double>(i) / (count - 1.0) - 1.0);
  }
  for (size_t i = count; i > 1; --i) {
    std::swap(stops[i - 1], stops[std::min(i - 1, static_cast<size_t>(rng.Unit() * i))]);
  }
  for (size_t i = 0; i < count; ++i) {
    PlannedPhoto& photo = plan->photos[i];
    // Four uniform numbers: close to normal, with a bound.
    const double normal =
        (rng.Unit() + rng.Unit() + rng.Unit() + rng.Unit() - 2.0) * std::numbers::sqrt3;
    photo.exposure = std::exp2(stops[i] - stops[0]);
    photo.exif_exposure = photo.exposure * (1.0 + options.exif_error * normal);
  }
}

// The strength t of LensFalloff at which the corners, a half diagonal away, lose `share`.
double FalloffStrength(double share) { return 1.0 / std::sqrt(1.0 - share) - 1.0; }

// The polynomial of Camera::vignetting nearest to the lens's fall-off, over equal areas.
std::array<double, 3> NearestPolynomial(double strength) {
  constexpr int kPoints = 200;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (int i = 0; i < kPoints; ++i) {
    const double r2 = (i + 0.5) / kPoints;
    const Vector3d powers(r2, r2 * r2, r2 * r2 * r2);
    const double value = 1.0 / ((1.0 + strength * r2) * (1.0 + strength * r2)) - 1.0;
    normal += powers * powers.transpose();
    right += powers * value;
  }
  const Vector3d v = normal.ldlt().solve(right);
  return {v.x(), v.y(), v.z()};
}

// One power for the whole capture: the brightest piece of paper reaches `paper_level`.
void SetPower(CapturePlan* plan) {
  const BoardRectangle sheet = OutlineInSample(plan->board);
  double brightest = 0;
  for (const PlannedPhoto& photo : plan->photos) {
    // The foot of the flash, moved onto the sheet, is where the paper is brightest.
    const double x = std::clamp(photo.light_in_sample_mm.x(), sheet.left_mm, sheet.right_mm);
    const double y = std::clamp(photo.light_in_sample_mm.y(), sheet.bottom_mm, sheet.top_mm);
    brightest = std::max(brightest, photo.exposure * LightGeometry(photo.light_in_sample_mm, x, y));
  }
  const CapturePlanOptions& options = plan->options;
  const double room =
      options.ambient * LightGeometry(plan->photos.front().light_in_sample_mm, 0, 0);
  double longest = 0;
  for (const PlannedPhoto& photo : plan->photos) longest = std::max(longest, photo.exposure);
  const double power =
      options.paper_level * std::numbers::pi / (kPaperAlbedo * (brightest + longest * room));
  plan->light_rgb = power * Vector3d(options.flash_tint.data());
  plan->ambient_rgb.setConstant(power * room);
}

}  // namespace

Camera PhoneCamera(double megapixels, std::uint64_t seed) {
  Rng rng = StreamOf(seed, kLensStream);
  const auto around = [&rng](double centre, double half_width) {
    return centre + half_width * (2.0 * rng.Unit() - 1.0);
  };
  Camera camera;
  camera.model = CameraModel::kRadial;
  camera.width_px =
      4 * std::max(1, static_cast<int>(std::lround(std::sqrt(megapixels * 1e6 / 12))));
  camera.height_px = camera.width_px / 4 * 3;
  const double scale = camera.width_px / 4000.0;
  // A phone's main camera: 26 mm equivalent, a little barrel that turns back toward the corners.
  const double focal_px = around(3000, 60) * scale;
  const double cx = 0.5 * camera.width_px + around(0, 14) * scale;
  const double cy = 0.5 * camera.height_px + around(0, 14) * scale;
  const double k1 = around(0.05, 0.03);
  const double k2 = around(-0.08, 0.03);
  camera.parameters = {focal_px, cx, cy, k1, k2};
  return camera;
}

double LensFalloff(const CapturePlan& plan, const Vector2d& point_px) {
  if (plan.options.vignetting <= 0) return 1;
  const double strength = FalloffStrength(plan.options.vignetting);
  const double denominator = 1.0 + strength * VignettingRadius2(plan.camera, point_px);
  return 1.0 / (denominator * denominator);
}

namespace {

// The sample, which lies at the board's centre, must fit into its window.
void CheckBoardOf(const CapturePlanOptions& options) {
  if (!options.board) return;
  const auto opening = OpeningInSample(*options.board);
  if (!opening) return;
  const double room_mm =
      2 * std::min({-opening->left_mm, opening->right_mm, -opening->bottom_mm, opening->top_mm});
  if (options.sample_mm <= room_mm) return;
  throw UserError("board: found a window that takes " + std::to_string(room_mm) +
                  " mm at most round the board's centre, while the sample measures " +
                  std::to_string(options.sample_mm) + "; give a smaller --sample-mm");
}

}  // namespace

CapturePlan PlanCapture(const CapturePlanOptions& options) {
  CheckOptions(options);
  CheckBoardOf(options);
  CapturePlan plan;
  plan.options = options;
  plan.board = options.board.value_or(FrameBoard(options.sample_mm));
  plan.margin_mm = plan.board.square_mm;
  plan.camera = PhoneCamera(options.megapixels, options.seed);
  if (options.vignetting > 0) {
    plan.camera.vignetting = NearestPolynomial(FalloffStrength(options.vignetting));
  }
  Rng rng = StreamOf(options.seed, kPoseStream);
  const double first_azimuth = 2.0 * std::numbers::pi * rng.Unit();
  for (int i = 0; i < options.photos; ++i) {
    plan.photos.push_back(PlacePhoto(plan, i, DrawPose(options, i, first_azimuth, rng)));
  }
  DrawExposures(&plan);
  SetPower(&plan);
  return plan;
}

}  // namespace glint
