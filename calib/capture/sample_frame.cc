#include "calib/capture/sample_frame.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/errors/errors.h"
#include "calib/capture/sample_plane.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct Ray {
  Vector3d origin, direction;
};

class FrameFinder {
 public:
  FrameFinder(const Capture& capture, const PosedModel& model, const FrameOptions& options)
      : capture_(capture), model_(model), options_(options), centres_(model.CameraCentres()) {}

  SampleFrame Find() {
    frame_.plane = FindSamplePlane(capture_, model_, options_, &frame_.plane_points);
    const PosesTable& poses = capture_.poses;
    if (!poses.corners_px.empty()) {
      FromCorners();
    } else if (!poses.points_px.empty()) {
      FromScale("points", poses.points_mm / (OnPlane(poses.points_px, 0, "points_px") -
                                             OnPlane(poses.points_px, 1, "points_px"))
                                                .norm());
    } else if (!poses.cameras.empty()) {
      const double distance = (CentreOf(poses.cameras[0]) - CentreOf(poses.cameras[1])).norm();
      FromScale("cameras", poses.cameras_mm / distance);
    } else if (poses.height_mm > 0) {
      FromScale("height", poses.height_mm / Height());
    } else {
      FromBoard();
    }
    frame_.plane_rms_mm = frame_.plane.rms * frame_.sample_from_model.scale;
    return frame_;
  }

 private:
  // --- Photographs

  const PosedPhoto& PhotoNamed(const std::string& name) const {
    return glint::PhotoNamed(capture_, model_.photos, name);
  }

  Vector3d CentreOf(const std::string& name) const {
    return Inverse(PhotoNamed(name).camera_from_model).translation;
  }

  // Direction of the picture's point; nullopt where the lens sees nothing.
  static std::optional<Ray> RayOf(const PosedPhoto& photo, const Vector2d& point_px) {
    const auto uv = NormalizedFromImage(photo.camera, point_px);
    if (!uv) return std::nullopt;
    const Rigid3 model_from_camera = Inverse(photo.camera_from_model);
    return Ray{model_from_camera.translation,
               (model_from_camera.rotation * uv->homogeneous()).normalized()};
  }

  std::optional<Vector3d> Meet(const std::optional<Ray>& ray) const {
    if (!ray) return std::nullopt;
    const double toward = frame_.plane.normal.dot(ray->direction);
    if (!(toward < -1e-3)) return std::nullopt;
    return ray->origin - frame_.plane.Distance(ray->origin) / toward * ray->direction;
  }

  // The index-th point of a list of pixels of [poses] photo.
  Vector3d OnPlane(const std::vector<double>& list, size_t index, const char* key) const {
    const Vector2d point_px(list[2 * index], list[2 * index + 1]);
    const auto point = Meet(RayOf(PhotoNamed(capture_.poses.photo), point_px));
    if (point) return *point;
    throw UserError(capture_.file, std::string("poses.") + key,
                    fmt::format("[{}, {}], a pixel whose line of sight misses the sample's plane",
                                point_px.x(), point_px.y()),
                    "give pixels of " + capture_.poses.photo);
  }

  double Height() const {
    if (!capture_.poses.photo.empty()) return frame_.plane.Distance(CentreOf(capture_.poses.photo));
    std::vector<double> heights;
    for (const Vector3d& centre : centres_) heights.push_back(frame_.plane.Distance(centre));
    return MedianOf(heights);
  }

  // --- Frames

  Similarity3 FrameAt(const Vector3d& origin, const Vector3d& toward_x, double mm_per_unit) const {
    const Vector3d& z = frame_.plane.normal;
    const Vector3d x = (toward_x - z.dot(toward_x) * z).normalized();
    Similarity3 frame;
    frame.scale = mm_per_unit;
    frame.rotation.row(0) = x;
    frame.rotation.row(1) = z.cross(x);
    frame.rotation.row(2) = z;
    frame.translation = -mm_per_unit * (frame.rotation * origin);
    return frame;
  }

  // The photograph whose optical axis is nearest to the plane's normal: its right.
  Vector3d DefaultX() const {
    const auto steepness = [&](const PosedPhoto& photo) {
      return -photo.camera_from_model.rotation.row(2).dot(frame_.plane.normal);
    };
    const auto steepest = std::max_element(
        model_.photos.begin(), model_.photos.end(),
        [&](const PosedPhoto& a, const PosedPhoto& b) { return steepness(a) < steepness(b); });
    return steepest->camera_from_model.rotation.row(0);
  }

  Vector3d DefaultOrigin() const {
    const Similarity3 plane_frame = FrameAt(Vector3d::Zero(), DefaultX(), 1);
    std::vector<double> x, y;
    for (const PosedPhoto& photo : model_.photos) {
      const Vector2d middle(0.5 * photo.camera.width_px, 0.5 * photo.camera.height_px);
      const auto point = Meet(RayOf(photo, middle));
      if (!point) continue;
      x.push_back((plane_frame * *point).x());
      y.push_back((plane_frame * *point).y());
    }
    if (x.empty()) {
      throw UserError(model_.source, "images",
                      "no photograph that looks at the plane of its points",
                      "give the sample's position with [poses] corners_px");
    }
    const double height = frame_.plane.offset;
    return Inverse(plane_frame) * Vector3d(MedianOf(x), MedianOf(y), height);
  }

  void FromScale(const std::string& source, double mm_per_unit) {
    if (!std::isfinite(mm_per_unit)) {
      throw UserError(capture_.file, "poses", "two points or cameras at the same position",
                      "give two that are far apart");
    }
    const PosesTable& poses = capture_.poses;
    const Vector3d origin =
        poses.origin_px.empty() ? DefaultOrigin() : OnPlane(poses.origin_px, 0, "origin_px");
    const Vector3d x = poses.x_axis_px.empty() ? DefaultX()
                                               : Vector3d(OnPlane(poses.x_axis_px, 1, "x_axis_px") -
                                                          OnPlane(poses.x_axis_px, 0, "x_axis_px"));
    frame_.source = source;
    frame_.sample_from_model = FrameAt(origin, x, mm_per_unit);
  }

  // The plane's points under the sample's four corners, moved onto a rectangle of its size.
  void FromCorners() {
    Eigen::Matrix3Xd found(3, 4), wanted(3, 4);
    const double x = 0.5 * capture_.sample_size_mm[0], y = 0.5 * capture_.sample_size_mm[1];
    wanted << -x, x, x, -x, y, y, -y, -y, 0, 0, 0, 0;
    for (int i = 0; i < 4; ++i) {
      found.col(i) = OnPlane(capture_.poses.corners_px, static_cast<size_t>(i), "corners_px");
    }
    frame_.source = "corners";
    Align(found, wanted);
    const double size = std::hypot(x, y);
    const bool fits = frame_.fit_rms_mm < 0.05 * size;
    if (fits && UpIsUp()) return;
    throw UserError(capture_.file, "poses.corners_px",
                    fits ? "corners that run anticlockwise"
                         : fmt::format("four points that lie {:.1f} mm off the corners of {} x {} "
                                       "mm",
                                       frame_.fit_rms_mm, capture_.sample_size_mm[0],
                                       capture_.sample_size_mm[1]),
                    "give top left, top right, bottom right, bottom left of the sample, and its "
                    "true size_mm");
  }

  bool UpIsUp() const {
    return frame_.sample_from_model.rotation.row(2).dot(frame_.plane.normal) > 0;
  }

  void Align(const Eigen::Matrix3Xd& in_model, const Eigen::Matrix3Xd& in_sample) {
    const auto aligned = AlignPoints(in_model, in_sample);
    if (!aligned) {
      throw UserError(capture_.file, "poses", "corners on a line", "give the sample's corners");
    }
    frame_.sample_from_model = *aligned;
    double squares = 0;
    for (long i = 0; i < in_model.cols(); ++i) {
      squares += (*aligned * Vector3d(in_model.col(i)) - in_sample.col(i)).squaredNorm();
    }
    frame_.fit_rms_mm = std::sqrt(squares / static_cast<double>(in_model.cols()));
  }

  // --- Board

  // The point nearest to all rays; where they are too nearly parallel, the plane's.
  std::optional<Vector3d> Intersect(const std::vector<Ray>& rays) const {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
    double widest = 1;
    for (const Ray& ray : rays) {
      const Eigen::Matrix3d across =
          Eigen::Matrix3d::Identity() - ray.direction * ray.direction.transpose();
      normal += across;
      right += across * ray.origin;
      widest = std::min(widest, ray.direction.dot(rays[0].direction));
    }
    constexpr double kCosineOfEnough = 0.996;  // 5 degrees
    if (widest < kCosineOfEnough) return Vector3d(normal.inverse() * right);
    return Meet(rays[0]);
  }

  void FromBoard() {
    std::map<int, std::pair<Vector2d, std::vector<Ray>>> corners;
    for (const PosedPhoto& photo : model_.photos) {
      frame_.board_photos += !photo.corners.empty();
      for (const SightedCorner& corner : photo.corners) {
        const auto ray = RayOf(photo, corner.point_px);
        if (!ray) continue;
        auto& entry = corners[corner.id];
        entry.first = corner.position_in_sample_mm;
        entry.second.push_back(*ray);
      }
    }
    std::vector<Vector3d> found;
    std::vector<Vector2d> wanted;
    for (const auto& [id, corner] : corners) {
      const auto point = Intersect(corner.second);
      if (!point) continue;
      found.push_back(*point);
      wanted.push_back(corner.first);
    }
    constexpr size_t kFewestCorners = 4;
    if (found.size() < kFewestCorners) RefuseWithoutScale();
    Eigen::Matrix3Xd in_model(3, found.size()), in_sample(3, found.size());
    for (size_t i = 0; i < found.size(); ++i) {
      in_model.col(static_cast<long>(i)) = found[i];
      in_sample.col(static_cast<long>(i)) = wanted[i].homogeneous();
      in_sample(2, static_cast<long>(i)) = 0;
    }
    frame_.source = "board";
    frame_.board_corners = static_cast<int>(found.size());
    Align(in_model, in_sample);
    const Eigen::Vector3d extent = in_sample.rowwise().maxCoeff() - in_sample.rowwise().minCoeff();
    if (frame_.fit_rms_mm < 0.01 * extent.norm() && UpIsUp()) return;
    throw UserError(
        model_.source, "images",
        fmt::format("the board's corners {:.2f} mm off their positions", frame_.fit_rms_mm),
        "the board moved between the photographs, is not the one that [board] describes, or "
        "the model is bad; give [poses] corners_px to do without the board");
  }

  [[noreturn]] void RefuseWithoutScale() const {
    throw UserError(
        capture_.file, "poses", capture_.has_board ? "too little of the board" : "no length",
        "a COLMAP model has no scale in millimetres; give one of these in [poses]:\n"
        "  photo = \"" +
            model_.photos[0].name +
            "\" and corners_px = [[x, y], …]  the sample's corners in it, from the top left "
            "clockwise\n"
            "  photo and points_px = [[x, y], [x, y]], points_mm  two points and their distance\n"
            "  cameras = [\"…\", \"…\"], cameras_mm  the distance of the lens between two "
            "photographs\n"
            "  height_mm  the lens's usual height above the sample");
  }

  const Capture& capture_;
  const PosedModel& model_;
  FrameOptions options_;
  std::vector<Vector3d> centres_;
  SampleFrame frame_;
};

}  // namespace

std::vector<Vector3d> PosedModel::CameraCentres() const {
  std::vector<Vector3d> centres;
  for (const PosedPhoto& photo : photos) {
    centres.push_back(Inverse(photo.camera_from_model).translation);
  }
  return centres;
}

SampleFrame FindSampleFrame(const Capture& capture, const PosedModel& model,
                            const FrameOptions& options) {
  return FrameFinder(capture, model, options).Find();
}

}  // namespace glint
