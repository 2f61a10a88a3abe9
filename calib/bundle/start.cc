#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "calib/bundle/bundle_internal.h"

namespace glint::bundle {
namespace {

// Homography from the plane (mm) to pixels relative to `centre`, robust against outlier corners.
std::optional<Eigen::Matrix3d> PlaneHomography(const BundlePhoto& photo,
                                               const Eigen::Vector2d& centre, double size_px) {
  if (photo.corners.size() < 4) return std::nullopt;
  std::vector<cv::Point2d> plane, image;
  for (const BundleCorner& corner : photo.corners) {
    plane.emplace_back(corner.position_in_sample_mm.x(), corner.position_in_sample_mm.y());
    image.emplace_back(corner.point_px.x() - centre.x(), corner.point_px.y() - centre.y());
  }
  cv::Mat h;
  try {
    h = cv::findHomography(plane, image, cv::RANSAC, std::max(2.0, 0.01 * size_px));
  } catch (const cv::Exception&) {
    return std::nullopt;  // corners on a line
  }
  if (h.empty() || h.type() != CV_64F) return std::nullopt;
  Eigen::Matrix3d out;
  for (int i = 0; i < 9; ++i) out(i / 3, i % 3) = h.at<double>(i / 3, i % 3);
  if (!out.allFinite()) return std::nullopt;
  // The board is in front of the camera: the third row is positive at its corners.
  double side = 0;
  for (const cv::Point2d& p : plane) side += out.row(2).dot(Eigen::Vector3d(p.x, p.y, 1));
  return side < 0 ? Eigen::Matrix3d(-out) : out;
}

// The pose that a homography implies for focal length f (Zhang 2000, section 3.1).
Rigid3 PoseFromHomography(const Eigen::Matrix3d& h, double focal_px) {
  Eigen::Matrix3d m = h;
  m.topRows<2>() /= focal_px;
  const double scale = 2.0 / (m.col(0).norm() + m.col(1).norm());
  Eigen::Matrix3d r;
  r << scale * m.col(0), scale * m.col(1), Eigen::Vector3d::Zero();
  r.col(2) = r.col(0).cross(r.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) *= -1;
  return {u * svd.matrixV().transpose(), scale * m.col(2)};
}

// Median distance of a photo's corners from where a pinhole of focal length f sees them.
double MedianError(const BundlePhoto& photo, const Eigen::Vector2d& centre, const Rigid3& pose,
                   double focal_px) {
  std::vector<double> errors;
  for (const BundleCorner& corner : photo.corners) {
    const Eigen::Vector3d p = pose * Eigen::Vector3d(corner.position_in_sample_mm.x(),
                                                     corner.position_in_sample_mm.y(), 0);
    errors.push_back(p.z() > 0 ? (focal_px * p.head<2>() / p.z() + centre - corner.point_px).norm()
                               : 1e6);
  }
  std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
  return errors[errors.size() / 2];
}

struct View {
  const BundlePhoto* photo;
  Eigen::Matrix3d homography;
};

// The focal length under which the homographies look most like views of a plane. Every photo counts
// by its median error, so that neither a few wrong corners nor a wrong photo lead astray.
// What EXIF tells wins where the views are about as well explained by it: seen from straight above,
// a plane says little about the focal length.
double FocalLength(const std::vector<View>& views, const Eigen::Vector2d& centre, double size_px,
                   double told_px) {
  constexpr int kSteps = 160;
  constexpr double kLowest = 0.3, kHighest = 12;  // of the longer side
  constexpr double kAsWell = 1.3;
  const auto cost_of = [&](double focal) {
    double cost = 0;
    for (const View& view : views) {
      cost += MedianError(*view.photo, centre, PoseFromHomography(view.homography, focal), focal);
    }
    return cost;
  };
  double best = size_px, best_cost = INFINITY;
  for (int i = 0; i <= kSteps; ++i) {
    const double focal = size_px * kLowest * std::pow(kHighest / kLowest, double(i) / kSteps);
    const double cost = cost_of(focal);
    if (cost < best_cost) {
      best_cost = cost;
      best = focal;
    }
  }
  const bool plausible = told_px > kLowest * size_px && told_px < kHighest * size_px;
  return plausible && cost_of(told_px) <= kAsWell * best_cost ? told_px : best;
}

Camera StartCamera(const BundleCamera& description, CameraModel model, double focal_px) {
  if (description.known) return *description.known;
  Camera camera{model, description.width_px, description.height_px, {}};
  camera.parameters.assign(CameraParameterNames(model).size(), 0.0);
  const size_t centre = PrincipalPointIndex(model);
  std::fill_n(camera.parameters.begin(), FocalLengthCount(model), focal_px);
  camera.parameters[centre] = 0.5 * description.width_px;
  camera.parameters[centre + 1] = 0.5 * description.height_px;
  return camera;
}

// Corner positions with a known camera's distortion taken out, relative to its principal point.
BundlePhoto Undistorted(const BundlePhoto& photo, const Camera& camera) {
  BundlePhoto out = photo;
  out.corners.clear();
  for (BundleCorner corner : photo.corners) {
    const auto uv = NormalizedFromImage(camera, corner.point_px);
    if (!uv) continue;
    corner.point_px = camera.focal_length_x() * *uv;
    out.corners.push_back(corner);
  }
  return out;
}

// Over all corners that were seen.
BoardBend FlatBoard(const BundleProblem& problem) {
  Eigen::Vector2d low(INFINITY, INFINITY), high(-INFINITY, -INFINITY);
  for (const BundlePhoto& photo : problem.photos) {
    for (const BundleCorner& corner : photo.corners) {
      low = low.cwiseMin(corner.position_in_sample_mm);
      high = high.cwiseMax(corner.position_in_sample_mm);
    }
  }
  BoardBend bend;
  if (!low.allFinite()) return bend;
  bend.centre_mm = 0.5 * (low + high);
  bend.half_size_mm = (0.5 * (high - low)).cwiseMax(1e-6);
  return bend;
}

}  // namespace

double BendPriorSigma(const BoardBend& bend) { return 0.1 * bend.half_size_mm.maxCoeff(); }

State Start(const BundleProblem& problem, const BundleOptions& options) {
  State state;
  state.bend = problem.bend ? *problem.bend : FlatBoard(problem);
  state.photos.resize(problem.photos.size());
  for (size_t i = 0; i < problem.photos.size(); ++i) {
    state.photos[i].inlier.assign(problem.photos[i].corners.size(), true);
  }
  for (size_t c = 0; c < problem.cameras.size(); ++c) {
    const BundleCamera& description = problem.cameras[c];
    const double size_px = std::max(description.width_px, description.height_px);
    Eigen::Vector2d centre(0.5 * description.width_px, 0.5 * description.height_px);
    if (description.known) centre.setZero();
    std::vector<BundlePhoto> photos;  // outlives the views
    std::vector<size_t> indices;
    for (size_t i = 0; i < problem.photos.size(); ++i) {
      if (problem.photos[i].camera != static_cast<int>(c)) continue;
      indices.push_back(i);
      photos.push_back(description.known ? Undistorted(problem.photos[i], *description.known)
                                         : problem.photos[i]);
    }
    std::vector<View> views;
    std::vector<size_t> view_photos;
    for (size_t k = 0; k < photos.size(); ++k) {
      if (const auto h = PlaneHomography(photos[k], centre, size_px)) {
        views.push_back({&photos[k], *h});
        view_photos.push_back(indices[k]);
      } else {
        state.photos[indices[k]].accepted = false;
        state.photos[indices[k]].rejected = "its corners are collinear or too few";
      }
    }
    const double focal = description.known
                             ? description.known->focal_length_x()
                             : FocalLength(views, centre, size_px, description.told_focal_px);
    state.cameras.push_back(StartCamera(description, options.model, focal));
    for (size_t k = 0; k < views.size(); ++k) {
      const Rigid3 pose = PoseFromHomography(views[k].homography, focal);
      PhotoState& photo = state.photos[view_photos[k]];
      photo.rotation0 = pose.rotation;
      for (int j = 0; j < 3; ++j) photo.pose[3 + j] = pose.translation[j];
    }
  }
  return state;
}

}  // namespace glint::bundle
