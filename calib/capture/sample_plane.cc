#include "calib/capture/sample_plane.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors/errors.h"

namespace glint {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

class PlaneFinder {
 public:
  PlaneFinder(const Capture& capture, const PosedModel& model, const FrameOptions& options)
      : capture_(capture), model_(model), options_(options), centres_(model.CameraCentres()) {}

  // The sample's own points where there are enough of them, else all. All too where the ground's
  // plane runs within the sample's noise: it has more points, and its features do not wander with
  // the flash, as those of relief and gloss do.
  void Find() {
    std::vector<CloudPoint> all;
    for (const ModelPoint& point : model_.points) all.push_back({point.position, point.weight});
    if (all.empty()) {
      throw UserError(model_.source, "points3D", "no points",
                      "give the model with its points; where every photograph shows the [board], "
                      "leave out [poses]");
    }
    const std::vector<CloudPoint> inside = PointsInside();
    constexpr size_t kEnough = 50;
    FitTo(inside.size() >= kEnough ? inside : all);
    if (inside.size() < kEnough) return;
    const PlaneFit own = plane_;
    const size_t own_points = plane_points_;
    try {
      FitTo(all);
    } catch (const UserError&) {
      Take(own, own_points);
      return;
    }
    if (!RunsWithin(own, inside, 2 * own.rms)) Take(own, own_points);
  }

  const PlaneFit& plane() const { return plane_; }
  size_t plane_points() const { return plane_points_; }

 private:
  void Take(const PlaneFit& plane, size_t points) {
    plane_ = plane;
    plane_points_ = points;
  }

  // Points that lie within the sample's corners; none where the corners are not told.
  std::vector<CloudPoint> PointsInside() const {
    std::vector<CloudPoint> inside;
    if (capture_.poses.corners_px.empty()) return inside;
    for (const ModelPoint& point : model_.points) {
      if (InsideCorners(point.position)) inside.push_back({point.position, point.weight});
    }
    return inside;
  }

  bool InsideCorners(const Vector3d& position) const {
    const PosedPhoto& photo = PhotoNamed(capture_, model_.photos, capture_.poses.photo);
    const Vector3d in_camera = photo.camera_from_model * position;
    if (!(in_camera.z() > 0)) return false;
    const Vector2d point = ImageFromCamera(photo.camera, in_camera);
    const auto& c = capture_.poses.corners_px;
    int left = 0;
    for (size_t i = 0; i < 4; ++i) {
      const Vector2d a(c[2 * i], c[2 * i + 1]);
      const Vector2d b(c[2 * ((i + 1) % 4)], c[2 * ((i + 1) % 4) + 1]);
      left += (b - a).x() * (point - a).y() - (b - a).y() * (point - a).x() > 0;
    }
    return left == 0 || left == 4;
  }

  // Whether the present plane is that near to `own` wherever the latter's inliers lie.
  bool RunsWithin(const PlaneFit& own, const std::vector<CloudPoint>& points,
                  double tolerance) const {
    for (size_t i = 0; i < points.size(); ++i) {
      if (!own.inlier[i]) continue;
      const Vector3d& x = points[i].position;
      if (std::abs(plane_.Distance(x) - own.Distance(x)) > tolerance) return false;
    }
    return true;
  }

  void FitTo(const std::vector<CloudPoint>& candidates) {
    Vector3d middle;
    for (int k = 0; k < 3; ++k) {
      std::vector<double> values;
      values.reserve(candidates.size());
      for (const CloudPoint& point : candidates) values.push_back(point.position[k]);
      middle[k] = MedianOf(values);
    }
    std::vector<double> distances;
    for (const Vector3d& centre : centres_) distances.push_back((centre - middle).norm());
    PlaneOptions plane;
    plane.threshold = options_.plane_tolerance * MedianOf(distances);
    plane.min_share = options_.min_share;
    plane_ = FitPlane(candidates, plane);
    plane_points_ = candidates.size();
    if (!plane_.problem.empty()) {
      throw UserError(model_.source, "points3D", plane_.problem,
                      "the sample's plane cannot be determined from them: photograph it so that it "
                      "and the flat surface around it fill the pictures, give its position with "
                      "[poses] corners_px, or increase --plane-tolerance for a rough sample");
    }
    TurnTowardCameras();
  }

  void TurnTowardCameras() {
    PlaneFit& plane = plane_;
    size_t above = 0;
    for (const Vector3d& centre : centres_) above += plane.Distance(centre) > 0;
    if (2 * above < centres_.size()) {
      plane.normal = -plane.normal;
      plane.offset = -plane.offset;
      above = centres_.size() - above;
    }
    if (above == centres_.size()) return;
    throw UserError(model_.source, "points3D",
                    fmt::format("a plane with {} cameras above and {} below it", above,
                                centres_.size() - above),
                    "it is not the sample's: leave out photographs of other things, or give the "
                    "sample's position with [poses] corners_px");
  }

  const Capture& capture_;
  const PosedModel& model_;
  FrameOptions options_;
  std::vector<Vector3d> centres_;
  PlaneFit plane_;
  size_t plane_points_ = 0;
};

}  // namespace

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

const PosedPhoto& PhotoNamed(const Capture& capture, const std::vector<PosedPhoto>& photos,
                             const std::string& name) {
  for (const PosedPhoto& photo : photos) {
    if (photo.name == name) return photo;
  }
  throw UserError(capture.file, "poses", "'" + name + "', which the COLMAP model does not contain",
                  "name a photograph that it contains: " + photos[0].name);
}

PlaneFit FindSamplePlane(const Capture& capture, const PosedModel& model,
                         const FrameOptions& options, size_t* plane_points) {
  PlaneFinder finder(capture, model, options);
  finder.Find();
  *plane_points = finder.plane_points();
  return finder.plane();
}

}  // namespace glint
