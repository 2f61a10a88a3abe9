// Intrinsics and poses from pictures of a flat board: one bundle adjustment.
//
//   minimise  Σ_photos Σ_corners ρ( ‖ π(camera, camera_from_sample · X) − x ‖² )
//
// over the intrinsics of every camera and the pose of every photo. Start: one focal length per
// camera by Zhang's constraints on the homographies (which OpenCV fits), poses from the
// homographies. While outliers are looked for, ρ is Cauchy's loss with a scale from the residuals'
// median; the final solution is plain least squares on what was kept, so that its covariance
// s²(JᵀJ)⁻¹ means what it says. Solved on one thread: the problem is small, and the result has one
// value. A board that is not flat can be given two unknowns of its own: see BoardBend.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "base/camera/camera_model.h"
#include "base/camera/rigid3.h"

namespace glint {

struct BundleCorner {
  int id = 0;
  Eigen::Vector2d position_in_sample_mm;  // on the plane z = 0
  Eigen::Vector2d point_px;               // centre of the top-left pixel: (0.5, 0.5)
};

struct BundlePhoto {
  std::string name;
  int camera = 0;  // index into BundleProblem::cameras
  std::vector<BundleCorner> corners;
};

struct BundleCamera {
  int width_px = 0, height_px = 0;
  std::optional<Camera> known;  // held as it is; only poses are solved for
  double told_focal_px = 0;     // by EXIF: the start, unless the board contradicts it; 0: not told
};

// How far the board stands off its plane: two parabolas, after mrcal's "calibration object warp".
//   z = height_x (1 − x²) + height_y (1 − y²),  x and y from −1 to 1 across the board's corners,
// so that the outermost four corners stay on z = 0 and each height is reached in the middle.
struct BoardBend {
  Eigen::Vector2d centre_mm{0, 0}, half_size_mm{1, 1};
  Eigen::Vector2d height_mm{0, 0};  // (height_x, height_y), positive toward the viewer
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();

  Eigen::Vector2d Weights(const Eigen::Vector2d& position_in_sample_mm) const {
    const Eigen::Array2d at = (position_in_sample_mm - centre_mm).array() / half_size_mm.array();
    return (1 - at.square()).matrix();
  }
  double HeightAt(const Eigen::Vector2d& position_in_sample_mm) const {
    return height_mm.dot(Weights(position_in_sample_mm));
  }
  // Of the height, along x and y.
  Eigen::Vector2d SlopesAt(const Eigen::Vector2d& position_in_sample_mm) const {
    const Eigen::Array2d at = (position_in_sample_mm - centre_mm).array() / half_size_mm.array();
    return (-2 * height_mm.array() * at / half_size_mm.array()).matrix();
  }
};

struct BundleProblem {
  std::vector<BundleCamera> cameras;
  std::vector<BundlePhoto> photos;
  std::optional<BoardBend> bend;  // known; held as it is
};

struct BundleOptions {
  CameraModel model = CameraModel::kOpenCv;
  std::vector<std::string> hold;  // parameters held at 0 (distortion alone: "p1", "k3", …)
  bool bend = false;              // solve for the board's bending too
  bool reject = true;             // look for outlier corners and photos
  double reject_sigmas = 5;       // a corner is an outlier beyond this many robust deviations …
  double min_reject_px = 0.5;     // … and beyond this distance
  int min_corners = 6;            // a photo with fewer inliers is rejected
  double min_inlier_share = 0.5;  // and one with a smaller share of them
  double max_photo_ratio = 4;     // and one whose median residual is this many times the usual
  double max_focal_sigma = 0.05;  // relative; beyond, a focal length counts as undetermined
  int max_iterations = 200;       // of one Ceres solve
};

struct CameraEstimate {
  Camera camera;
  std::vector<double> sigma;   // per parameter, scaled by the residual variance; 0: held
  Eigen::MatrixXd covariance;  // of all parameters; rows of held ones are zero
  int photos = 0;              // accepted
};

struct CornerResidual {
  int id = 0;
  Eigen::Vector2d point_px;     // as seen
  Eigen::Vector2d residual_px;  // seen − predicted
  bool inlier = true;
  Eigen::Vector2d position_in_sample_mm{0, 0};
};

struct PhotoEstimate {
  std::string name;
  int camera = 0;
  std::string rejected;  // why; empty: accepted
  Rigid3 camera_from_sample;
  double sigma_rotation_deg = 0;  // root of the mean variance about three axes
  double sigma_position_mm = 0;   // of the camera's centre, likewise
  double tilt_deg = 0;            // between the optical axis and the board's normal
  double rms_px = 0;              // of inliers: root mean ‖residual‖²
  std::vector<CornerResidual> corners;
  // Of the pose: a rotation vector (radian) and a shift (mm) applied in the camera's frame after
  // camera_from_sample; and with the camera's parameters (6 × as many as the model has).
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::MatrixXd covariance_with_camera;

  int inliers() const;
};

struct BundleResult {
  std::vector<CameraEstimate> cameras;  // as in the problem
  std::vector<PhotoEstimate> photos;    // as in the problem, rejected ones included
  std::optional<BoardBend> bend;        // where one is known or was solved for
  double rms_px = 0;                    // over all inliers: root mean ‖residual‖²
  double sigma_px = 0;                  // of one coordinate of a corner, by the degrees of freedom
  int corners = 0, inliers = 0;         // of accepted photos
  int rounds = 0;                       // of solving and rejecting

  // One line on the whole, then one per camera parameter: value ± σ.
  std::string BriefReport() const;
};

// Throws UserError when no photo or too few corners are given, or when the photos do not determine
// the intrinsics (all fronto-parallel); ComputationError when the solution does not converge.
BundleResult AdjustBundle(const BundleProblem& problem, const BundleOptions& options = {});

// A corner's place on the board, bent or flat.
Eigen::Vector3d BoardPoint(const std::optional<BoardBend>& bend,
                           const Eigen::Vector2d& position_in_sample_mm);

}  // namespace glint
