#include "calib/capture/fixed_camera.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/errors/errors.h"
#include "base/linearize/linear_photo.h"
#include "base/parallel/parallel.h"
#include "base/programs/progress.h"
#include "base/statistics/median.h"
#include "calib/capture/guide_capture.h"
#include "calib/moving_light/lights_file.h"
#include "calib/moving_light/reflecting_ball.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// The nominal distance of a camera or lamp whose distance is not given, by the picture's longer
// side. Three painted panels are level in the mean when their lamps stand 10 to 15 of their widths
// away: nearer ones would make them hollow, farther ones arched.
constexpr double kFarSides = 10;
constexpr int kGridSide = 64;         // points along each side at which lamps' strengths are told
constexpr double kGridMargin = 0.02;  // of the sample's side that is left out at its rim
constexpr double kLeastElevation = 0.03;  // sine; lower lights graze a flat sample

struct PictureScale {
  int width_px = 0, height_px = 0;
  double mm_per_px = 0;
  double longer_mm() const { return mm_per_px * std::max(width_px, height_px); }
};

// All photographs are of one size, or the camera was not one that stood still.
std::pair<int, int> CommonSize(const Capture& capture) {
  const auto size = PhotoSize(capture.folder / capture.photos[0]);
  for (const std::string& name : capture.photos) {
    const auto other = PhotoSize(capture.folder / name);
    if (other == size) continue;
    throw UserError(capture.folder / name, "size",
                    fmt::format("{}x{}, while {} has {}x{}", other.first, other.second,
                                capture.photos[0], size.first, size.second),
                    "photographs of a fixed camera must have one size; list only those of one size "
                    "in [photos] files");
  }
  return size;
}

PictureScale ScaleOf(const Capture& capture) {
  PictureScale scale;
  std::tie(scale.width_px, scale.height_px) = CommonSize(capture);
  const PosesTable& poses = capture.poses;
  if (poses.points_mm > 0) {
    const auto& p = poses.points_px;
    const double length_px = std::hypot(p[2] - p[0], p[3] - p[1]);
    if (!(length_px > 1)) {
      throw UserError(capture.file, "poses.points_px", "two points at the same position",
                      "give the ends of a ruler in the picture");
    }
    scale.mm_per_px = poses.points_mm / length_px;
  } else {
    const double width_mm =
        poses.picture_width_mm > 0 ? poses.picture_width_mm : capture.sample_size_mm[0];
    scale.mm_per_px = width_mm / scale.width_px;
  }
  const Eigen::Vector2d centre = -capture.board.board_centre_in_sample_mm;
  for (int axis = 0; axis < 2; ++axis) {
    const double side_mm = scale.mm_per_px * (axis == 0 ? scale.width_px : scale.height_px);
    const double reach_mm =
        2 * std::abs(centre[axis]) + capture.sample_size_mm[static_cast<size_t>(axis)];
    if (reach_mm <= side_mm * (1 + 1e-3)) continue;
    throw UserError(
        capture.file, "sample.size_mm",
        fmt::format("{:g} x {:g} mm about [{:g}, {:g}]", capture.sample_size_mm[0],
                    capture.sample_size_mm[1], centre.x(), centre.y()),
        fmt::format("the picture shows {:.4g} x {:.4g} mm: reduce size_mm, or correct "
                    "picture_width_mm or points_mm in [poses]",
                    scale.mm_per_px * scale.width_px, scale.mm_per_px * scale.height_px));
  }
  return scale;
}

std::vector<BallOutline> BallsOf(const Capture& capture) {
  std::vector<BallOutline> balls;
  const std::vector<double>& at = capture.lights.balls_px;
  for (size_t i = 0; i + 5 < at.size(); i += 6) {
    const auto ball =
        CircleThrough({Eigen::Vector2d(at[i], at[i + 1]), Eigen::Vector2d(at[i + 2], at[i + 3]),
                       Eigen::Vector2d(at[i + 4], at[i + 5])});
    if (!ball) {
      throw UserError(capture.file, "lights.balls_px", "three points on a line",
                      "give points all round the ball's rim");
    }
    balls.push_back(*ball);
  }
  return balls;
}

// What one photograph tells.
struct PhotoLook {
  DetectedPhoto photo;
  std::vector<std::array<float, 3>> radiance;  // at the grid's points; below 0: clipped
  std::vector<BallPicture> balls;
};

// Mean of 3 × 3 pixels about a point.
template <class Reader>
std::array<float, 3> RadianceAt(const Reader& pixels, int width, int height, double x_px,
                                double y_px) {
  std::array<float, 3> sum{0, 0, 0};
  const int x0 = std::clamp(static_cast<int>(x_px), 1, width - 2);
  const int y0 = std::clamp(static_cast<int>(y_px), 1, height - 2);
  for (int y = y0 - 1; y <= y0 + 1; ++y) {
    for (int x = x0 - 1; x <= x0 + 1; ++x) {
      const auto pixel = pixels.At(static_cast<size_t>(y) * static_cast<size_t>(width) + x);
      if (pixel.saturated) return {-1, -1, -1};
      for (size_t c = 0; c < 3; ++c) sum[c] += std::max(pixel.rgb[c], 0.0f) / 9;
    }
  }
  return sum;
}

template <class Reader>
BallPicture PictureOfBall(const Reader& pixels, int width, int height, const BallOutline& ball) {
  BallPicture picture;
  const auto clamped = [](double value, int most) {
    return std::clamp(static_cast<int>(std::floor(value)), 0, most);
  };
  picture.left_px = clamped(ball.centre_px.x() - ball.radius_px, width - 1);
  picture.top_px = clamped(ball.centre_px.y() - ball.radius_px, height - 1);
  picture.width = clamped(ball.centre_px.x() + ball.radius_px, width - 1) + 1 - picture.left_px;
  picture.height = clamped(ball.centre_px.y() + ball.radius_px, height - 1) + 1 - picture.top_px;
  for (int y = picture.top_px; y < picture.top_px + picture.height; ++y) {
    for (int x = picture.left_px; x < picture.left_px + picture.width; ++x) {
      const auto rgb = pixels.At(static_cast<size_t>(y) * static_cast<size_t>(width) + x).rgb;
      picture.brightness.push_back((rgb[0] + rgb[1] + rgb[2]) / 3);
    }
  }
  return picture;
}

PhotoLook LookAt(const Capture& capture, const std::string& name,
                 const std::vector<Eigen::Vector2d>& points_px,
                 const std::vector<BallOutline>& balls) {
  const fs::path file = capture.folder / name;
  Photo photo = ReadPhoto(file);
  PhotoLook look;
  look.photo.name = name;
  look.photo.width_px = photo.image.width;
  look.photo.height_px = photo.image.height;
  look.photo.orientation = photo.orientation;
  look.photo.focal_length_35mm = photo.focal_length_35mm;
  look.photo.camera_model = photo.camera_model;
  look.photo.clips = !photo.is_float();
  look.photo.exposure = photo.exposure();
  look.photo.measures.name = name;
  const Encoding encoding = ResolveEncoding(capture.resolved_encoding(), file, photo);
  const LinearPhoto linear(std::move(photo), encoding);
  const int width = linear.width(), height = linear.height();
  if (width < 3 || height < 3) {
    throw UserError(file, "size", fmt::format("{}x{}", width, height), "give a larger picture");
  }
  int clipped = 0;
  linear.Visit([&](const auto& pixels) {
    for (const Eigen::Vector2d& at : points_px) {
      look.radiance.push_back(RadianceAt(pixels, width, height, at.x(), at.y()));
      clipped += look.radiance.back()[0] < 0;
    }
    for (const auto& ball : balls) {
      look.balls.push_back(PictureOfBall(pixels, width, height, ball));
    }
  });
  look.photo.sample_clipped_share =
      static_cast<double>(clipped) / static_cast<double>(points_px.size());
  return look;
}

// What all photographs show of the ball alike is ambient illumination.
void TakeOutRoom(size_t ball, std::vector<PhotoLook>* looks) {
  const size_t pixels = looks->front().balls[ball].brightness.size();
  for (size_t i = 0; i < pixels; ++i) {
    std::vector<double> values;
    for (const PhotoLook& look : *looks) values.push_back(look.balls[ball].brightness[i]);
    const double usual = Median(values);
    for (PhotoLook& look : *looks) {
      float& value = look.balls[ball].brightness[i];
      value = std::max(0.0f, value - static_cast<float>(usual));
    }
  }
}

// By photograph; nullopt where no ball shows one. Two balls' directions are averaged.
std::vector<std::optional<ListedLight>> LightsFromBalls(const std::vector<BallOutline>& balls,
                                                        std::vector<PhotoLook>* looks) {
  std::vector<std::optional<ListedLight>> lights(looks->size());
  std::vector<Eigen::Vector3d> sums(looks->size(), Eigen::Vector3d::Zero());
  for (size_t b = 0; b < balls.size(); ++b) {
    TakeOutRoom(b, looks);
    for (size_t i = 0; i < looks->size(); ++i) {
      if (const auto direction = LightFromBall((*looks)[i].balls[b], balls[b])) {
        sums[i] += *direction;
      }
    }
  }
  for (size_t i = 0; i < lights.size(); ++i) {
    if (!(sums[i].norm() > 0)) continue;
    lights[i].emplace();
    lights[i]->direction = sums[i].normalized();
  }
  return lights;
}

std::vector<std::optional<ListedLight>> LightsFromFile(const Capture& capture,
                                                       double picture_width_mm) {
  const LightsFile file =
      ReadLightsFile(capture.folder / capture.lights.file, capture.lights.unit, picture_width_mm);
  std::vector<std::string> remarks = file.remarks;
  const std::vector<int> match = MatchLights(file, capture.photos, &remarks);
  for (const std::string& remark : remarks) spdlog::warn("{}", remark);
  std::vector<std::optional<ListedLight>> lights;
  for (const int light : match) {
    lights.emplace_back();
    if (light >= 0) lights.back() = file.lights[static_cast<size_t>(light)];
  }
  return lights;
}

// "": it can be used.
std::string WhatIsWrong(const Capture& capture, const std::optional<ListedLight>& light) {
  if (!light) {
    return capture.lights.file.empty() ? "no reflection of the light on the ball"
                                       : capture.lights.file + " does not list it";
  }
  if (light->direction.z() >= kLeastElevation) return "";
  return fmt::format("its light is {:.0f}° {} the sample's plane",
                     std::abs(std::asin(light->direction.z())) / kDegree,
                     light->direction.z() < 0 ? "below" : "above");
}

// Nothing is used of a file whose vectors point the other way.
void RequireSomeLights(const Capture& capture, const std::vector<std::string>& reasons,
                       const std::vector<std::optional<ListedLight>>& lights) {
  if (std::any_of(reasons.begin(), reasons.end(), [](const auto& r) { return r.empty(); })) return;
  const bool below = std::any_of(lights.begin(), lights.end(), [](const auto& light) {
    return light && light->direction.z() < 0;
  });
  throw UserError(capture.lights.file.empty() ? capture.file : capture.folder / capture.lights.file,
                  "", "no usable light (" + capture.photos[0] + ": " + reasons[0] + ")",
                  below ? "vectors point from the sample to the light: x right, y up, z to the "
                          "camera; is the sign of z, or the order of y and z, different?"
                        : "correct [lights] in capture.toml");
}

class FixedCamera {
 public:
  FixedCamera(const Capture& capture, const CalibOptions& options, int threads,
              CalibSummary* summary)
      : capture_(capture),
        options_(options),
        threads_(threads),
        scale_(ScaleOf(capture)),
        centre_mm_(-capture.board.board_centre_in_sample_mm),
        summary_(*summary) {}

  void Run() {
    const auto balls = BallsOf(capture_);
    std::vector<PhotoLook> looks = LookAtAll(balls);
    const auto lights = balls.empty() ? LightsFromFile(capture_, scale_.mm_per_px * scale_.width_px)
                                      : LightsFromBalls(balls, &looks);
    std::vector<std::string> reasons;
    reasons.reserve(lights.size());
    for (const auto& light : lights) reasons.push_back(WhatIsWrong(capture_, light));
    RequireSomeLights(capture_, reasons, lights);
    AddCamera();
    LampProblem lamps;
    lamps.points_mm = points_mm_;
    for (size_t i = 0; i < looks.size(); ++i) {
      summary_.photos.push_back(looks[i].photo);
      if (!reasons[i].empty()) {
        summary_.rejected.push_back({looks[i].photo.name, reasons[i]});
        spdlog::warn("{} is left out: {}", looks[i].photo.name, reasons[i]);
        continue;
      }
      AddPhoto(looks[i].photo, *lights[i]);
      lamps.lights_mm.push_back(LightInSample_mm(*lights[i]));
      lamps.radiance.push_back(std::move(looks[i].radiance));
    }
    SetStrengths(lamps);
    Describe();
  }

 private:
  std::vector<PhotoLook> LookAtAll(const std::vector<BallOutline>& balls) {
    std::vector<Eigen::Vector2d> points_px;
    for (int row = 0; row < kGridSide; ++row) {
      for (int column = 0; column < kGridSide; ++column) {
        const auto along = [](int i) {
          return (1 - 2 * kGridMargin) * ((i + 0.5) / kGridSide - 0.5);
        };
        const Eigen::Vector2d at_mm(along(column) * capture_.sample_size_mm[0],
                                    -along(row) * capture_.sample_size_mm[1]);
        points_mm_.emplace_back(at_mm.x(), at_mm.y(), 0);
        const Eigen::Vector2d in_picture = (at_mm + centre_mm_) / scale_.mm_per_px;
        points_px.emplace_back(scale_.width_px / 2.0 + in_picture.x(),
                               scale_.height_px / 2.0 - in_picture.y());
      }
    }
    std::vector<PhotoLook> looks(capture_.photos.size());
    Progress progress("lights", static_cast<std::int64_t>(looks.size()));
    ForEachPiece(static_cast<int>(looks.size()), threads_, [&](int piece) {
      const auto i = static_cast<size_t>(piece);
      looks[i] = LookAt(capture_, capture_.photos[i], points_px, balls);
      progress.Advance(1, capture_.photos[i]);
    });
    return looks;
  }

  double camera_mm() const {
    return capture_.lights.camera_mm > 0 ? capture_.lights.camera_mm
                                         : kFarSides * scale_.longer_mm();
  }

  void AddCamera() {
    Camera camera;
    camera.model = CameraModel::kSimplePinhole;
    camera.width_px = scale_.width_px;
    camera.height_px = scale_.height_px;
    camera.parameters = {camera_mm() / scale_.mm_per_px, scale_.width_px / 2.0,
                         scale_.height_px / 2.0};
    summary_.calibration.cameras = {camera};
    // Above the picture's middle; the camera's y axis points down, its z axis at the sample.
    camera_from_sample_.rotation = Eigen::Vector3d(1, -1, -1).asDiagonal();
    camera_from_sample_.translation = {centre_mm_.x(), -centre_mm_.y(), camera_mm()};
  }

  Eigen::Vector3d LightInSample_mm(const ListedLight& light) const {
    const Eigen::Vector3d centre(centre_mm_.x(), centre_mm_.y(), 0);
    if (light.position_mm) return *light.position_mm - centre;
    const double distance_mm = capture_.lights.distance_mm > 0 ? capture_.lights.distance_mm
                                                               : kFarSides * scale_.longer_mm();
    return distance_mm * light.direction - centre;
  }

  void AddPhoto(const DetectedPhoto& detected, const ListedLight& light) {
    CalibratedPhoto photo;
    photo.photo = detected.name;
    photo.camera_from_sample = camera_from_sample_;
    photo.light_in_camera_mm = camera_from_sample_ * LightInSample_mm(light);
    summary_.calibration.photos.push_back(photo);
  }

  void SetStrengths(const LampProblem& lamps) {
    Calibration& calibration = summary_.calibration;
    calibration.fixed_camera = true;
    calibration.ambient_rgb = Eigen::Vector3d(capture_.ambient.data());
    const Eigen::Vector3d given(capture_.light_power.data());
    calibration.light_power_known = given.maxCoeff() > 0;
    calibration.light_rgb = given;
    if (!calibration.light_power_known) {
      // That of a white surface which reaches 0.8; refined later.
      calibration.light_rgb.setConstant(0.8 * std::numbers::pi * lamps.lights_mm[0].squaredNorm());
    }
    if (options_.light != "board") return;  // nominal: all alike, or by EXIF
    summary_.lamps = EstimateLampStrengths(lamps, threads_);
    // Exposures are those of the first photograph's light; what is given is the mean lamp's power.
    if (calibration.light_power_known) calibration.light_rgb *= summary_.lamps.lamps[0].exposure;
    for (size_t i = 0; i < calibration.photos.size(); ++i) {
      const LampStrength& lamp = summary_.lamps.lamps[i];
      const LampStrength& first = summary_.lamps.lamps[0];
      calibration.photos[i].exposure = lamp.exposure / first.exposure;
      calibration.photos[i].white_balance_rgb = lamp.colour;
    }
  }

  void Describe() {
    summary_.poses = {{"source", "fixed camera"},
                      {"camera_mm", camera_mm()},
                      {"camera_distance_known", capture_.lights.camera_mm > 0},
                      {"picture_width_mm", scale_.mm_per_px * scale_.width_px}};
    RegistrationProblem none;
    none.views.resize(summary_.calibration.photos.size());
    summary_.placement = Unregistered(none);
    summary_.guidance = Judge(GuidanceInputOf(capture_, summary_, false));
  }

  const Capture& capture_;
  const CalibOptions& options_;
  int threads_;
  PictureScale scale_;
  Eigen::Vector2d centre_mm_;  // the sample's, from the picture's middle
  std::vector<Eigen::Vector3d> points_mm_;
  Rigid3 camera_from_sample_;
  CalibSummary& summary_;
};

}  // namespace

void CalibrateFixedCamera(const Capture& capture, const CalibOptions& options, int threads,
                          CalibSummary* summary) {
  FixedCamera(capture, options, threads, summary).Run();
}

}  // namespace glint
