#include "calib/registration/place_problem.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/model/registration.h"
#include "calib/registration/robust_fit.h"

namespace glint {
namespace {

// Two points of the assumed plane, one in each of two views, that show one point of the sample.
class SamePoint {
 public:
  struct Sight {
    Eigen::Vector3d camera_mm;
    Eigen::Vector2d assumed_mm;
  };
  SamePoint(Sight first, Sight second, double unit_mm)
      : first_(std::move(first)), second_(std::move(second)), unit_mm_(unit_mm) {}

  template <class T>
  bool operator()(const T* plane, const T* first, const T* second, T* residual) const {
    const PlaneFrame<T> frame(plane);
    T a[2], b[2];
    Sample(frame, first_, first, a);
    Sample(frame, second_, second, b);
    for (int i = 0; i < 2; ++i) residual[i] = a[i] - b[i];
    return true;
  }

 private:
  template <class T>
  void Sample(const PlaneFrame<T>& frame, const Sight& sight, const T* homography, T* point) const {
    T on_plane[2];
    frame.SampleFromAssumed(sight.camera_mm, T(sight.assumed_mm.x()), T(sight.assumed_mm.y()),
                            on_plane);
    ApplyHomography(homography, unit_mm_, on_plane[0], on_plane[1], point);
  }

  Sight first_, second_;
  double unit_mm_;
};

// Linear in what is unknown, from `start` on: displacements are of pixels. Ceres then spends its
// time on the loss.
class LinearSamePoint : public ceres::SizedCostFunction<2, 3, 8, 8> {
 public:
  LinearSamePoint(const SamePoint& cost, const double* const* start, double weight) {
    const ceres::AutoDiffCostFunction<SamePoint, 2, 3, 8, 8> exact(new SamePoint(cost));
    double* blocks[] = {by_plane_.data(), by_first_.data(), by_second_.data()};
    exact.Evaluate(start, at_start_.data(), blocks);
    Vector3 plane = Eigen::Map<const Vector3>(start[0]);
    at_start_ -= by_plane_ * plane + by_first_ * Eigen::Map<const Vector8>(start[1]) +
                 by_second_ * Eigen::Map<const Vector8>(start[2]);
    at_start_ *= weight;
    by_plane_ *= weight;
    by_first_ *= weight;
    by_second_ *= weight;
  }

  bool Evaluate(const double* const* x, double* residual, double** jacobians) const override {
    Eigen::Map<Eigen::Vector2d>(residual, 2) =
        at_start_ + by_plane_ * Eigen::Map<const Vector3>(x[0]) +
        by_first_ * Eigen::Map<const Vector8>(x[1]) + by_second_ * Eigen::Map<const Vector8>(x[2]);
    if (jacobians == nullptr) return true;
    Write(by_plane_, jacobians[0]);
    Write(by_first_, jacobians[1]);
    Write(by_second_, jacobians[2]);
    return true;
  }

 private:
  template <class Matrix>
  static void Write(const Matrix& matrix, double* to) {
    if (to != nullptr) std::copy(matrix.data(), matrix.data() + matrix.size(), to);
  }

  using Vector3 = Eigen::Matrix<double, 3, 1>;
  using Vector8 = Eigen::Matrix<double, 8, 1>;
  using ByPlane = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
  using ByHomography = Eigen::Matrix<double, 2, 8, Eigen::RowMajor>;

  Eigen::Vector2d at_start_;  // where all is 0, after the constructor
  ByPlane by_plane_;
  ByHomography by_first_, by_second_;
};

class PlaceProblem {
 public:
  PlaceProblem(const RegistrationProblem& problem, const DetailPictures& pictures,
               const SamplePlaces& start, const HomographySpreads& spreads,
               const std::vector<WindowShift>& shifts, const cv::Size& size, UnknownPlaces unknown)
      : problem_(problem),
        pictures_(pictures),
        shifts_(shifts),
        size_(size),
        unknown_(unknown),
        start_(start),
        places_(start),
        expected_spread_(problem.homography_sd_mm / start.unit_mm),
        spreads_(spreads) {
    for (const WindowShift& shift : shifts) {
      mean_response_ += shift.response / static_cast<double>(shifts.size());
    }
    // Of the pairs' displacements of a window only those of views − 1 are independent.
    const double pairs = static_cast<double>(PairsOf(pictures.views()).size());
    share_ = (pictures.views() - 1) / (pairs * constants::kTimesCounted);
  }

  PlaceSolution Solve() {
    // How wide residuals and homographies scatter is theirs to tell: a first solution does, a
    // second uses it.
    double sigma_mm = constants::kFirstShiftSd_px * pictures_.PixelSide_mm(size_);
    for (int pass = 0; pass < 2; ++pass) {
      Run(sigma_mm, pass == 1);
      sigma_mm = std::max(constants::kLeastShiftSd_px * pictures_.PixelSide_mm(size_),
                          std::sqrt(Median(Squares())) / kMedianOfLength);
      if (expected_spread_ > 0 && unknown_ != UnknownPlaces::kPlane) {
        spreads_ = LearnedSpreads(problem_, places_, spreads_, Held());
      }
    }
    return {places_, spreads_, covariance_};
  }

 private:
  static constexpr double kMedianOfLength = 1.177;  // of two normal numbers' length, by their σ

  SamePoint::Sight SightOf(int view, double x_px, double y_px) const {
    return {pictures_.camera_mm(view),
            pictures_.AssumedPoint(view, start_, pictures_.SamplePoint(size_, x_px, y_px))};
  }

  SamePoint CostOf(const WindowShift& shift) const {
    const double dx = shift.dx_px / 2, dy = shift.dy_px / 2;
    return {SightOf(shift.first, shift.x_px - dx, shift.y_px - dy),
            SightOf(shift.second, shift.x_px + dx, shift.y_px + dy), places_.unit_mm};
  }

  double* Homography(int view) { return places_.homographies[static_cast<size_t>(view)].data(); }

  void Run(double sigma_mm, bool with_covariance) {
    const auto loss = RobustLoss(share_);
    ceres::Problem problem(SharingLosses());
    // A displacement counts by its response, and so that what is
    // counted several times has the weight of once.
    for (const WindowShift& shift : shifts_) {
      const double weight = std::sqrt(shift.response / mean_response_) / sigma_mm;
      const double* const start[] = {places_.plane.data(), Homography(shift.first),
                                     Homography(shift.second)};
      problem.AddResidualBlock(new LinearSamePoint(CostOf(shift), start, weight), loss.get(),
                               places_.plane.data(), Homography(shift.first),
                               Homography(shift.second));
    }
    AddPriors(&problem);
    SolveRobustly(&problem);
    if (with_covariance && !plane_held()) {
      covariance_ = CovarianceOfBlock(places_.plane.data(), &problem);
    }
  }

  bool plane_held() const {
    return problem_.height_sd_mm <= 0 || unknown_ == UnknownPlaces::kTranslations;
  }

  void AddPriors(ceres::Problem* problem) {
    double* plane = places_.plane.data();
    if (plane_held()) {
      problem->SetParameterBlockConstant(plane);
    } else {
      AddPrior<3>({problem_.height_mm, 0, 0},
                  {problem_.height_sd_mm, problem_.slope_sd, problem_.slope_sd}, plane, problem);
    }
    for (int view = 0; view < pictures_.views(); ++view) {
      double* homography = Homography(view);
      if (!problem->HasParameterBlock(homography)) continue;  // no window of it tells anything
      if (expected_spread_ <= 0 || unknown_ == UnknownPlaces::kPlane) {
        problem->SetParameterBlockConstant(homography);
        continue;
      }
      std::array<double, 8> spreads;
      for (size_t i = 0; i < 8; ++i) spreads[i] = spreads_[kSpreadOfValue[i]];
      AddPrior<8>({}, spreads, homography, problem);
      const std::vector<int> held = Held();
      if (!held.empty()) problem->SetManifold(homography, new ceres::SubsetManifold(8, held));
    }
  }

  std::vector<int> Held() const {
    if (unknown_ == UnknownPlaces::kTranslations) return {0, 1, 3, 4, 6, 7};
    if (unknown_ == UnknownPlaces::kPlaneAndAffine) return {6, 7};
    return {};
  }

  // Squared lengths of what is left of the displacements, millimetres².
  std::vector<double> Squares() {
    std::vector<double> squares;
    for (const WindowShift& shift : shifts_) {
      double residual[2];
      CostOf(shift)(places_.plane.data(), Homography(shift.first), Homography(shift.second),
                    residual);
      squares.push_back(residual[0] * residual[0] + residual[1] * residual[1]);
    }
    return squares;
  }

  const RegistrationProblem& problem_;
  const DetailPictures& pictures_;
  const std::vector<WindowShift>& shifts_;
  cv::Size size_;
  UnknownPlaces unknown_;
  SamplePlaces start_, places_;
  double expected_spread_;
  HomographySpreads spreads_;
  double share_ = 1, mean_response_ = 0;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace

PlaceSolution SolvePlaces(const RegistrationProblem& problem, const DetailPictures& pictures,
                          const SamplePlaces& start, const HomographySpreads& spreads,
                          const std::vector<WindowShift>& shifts, const cv::Size& size,
                          UnknownPlaces unknown) {
  return PlaceProblem(problem, pictures, start, spreads, shifts, size, unknown).Solve();
}

}  // namespace glint
