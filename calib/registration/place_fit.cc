#include "calib/registration/place_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/model/registration.h"
#include "base/model/solver.h"
#include "calib/registration/robust_fit.h"

namespace glint {
namespace {

constexpr double kMedianOfNormal = 0.6745;      // of |x|, by σ
constexpr double kMedianOfSquaredPair = 1.386;  // of x² + y², by σ²

struct HeightAt {
  Eigen::Vector2d point_mm;
  double height_mm, sigma_mm;
  template <class T>
  bool operator()(const T* plane, T* residual) const {
    residual[0] =
        (plane[0] + plane[1] * T(point_mm.x()) + plane[2] * T(point_mm.y()) - T(height_mm)) /
        T(sigma_mm);
    return true;
  }
};

// A view shows the sample's point at `seen_mm` of the plane as the plane alone puts it there.
struct SeenAt {
  Eigen::Vector2d seen_mm, point_mm;
  Eigen::Matrix2d root;  // of the information
  double unit_mm;
  template <class T>
  bool operator()(const T* homography, T* residual) const {
    T at[2];
    ApplyHomography(homography, unit_mm, T(seen_mm.x()), T(seen_mm.y()), at);
    const T off[2] = {at[0] - T(point_mm.x()), at[1] - T(point_mm.y())};
    for (int i = 0; i < 2; ++i) residual[i] = T(root(i, 0)) * off[0] + T(root(i, 1)) * off[1];
    return true;
  }
};

// By how much a plane seems higher where photographs are out of place by one millimetre each.
double HeightOfDisplacement(const RegistrationProblem& problem) {
  const auto count = static_cast<double>(problem.views.size());
  Eigen::Vector2d mean(0, 0);
  double squares = 0;
  for (const TopView& view : problem.views) {
    const Eigen::Vector2d tangents = view.camera_mm.head<2>() / view.camera_mm.z();
    mean += tangents / count;
    squares += tangents.squaredNorm();
  }
  // Least squares over the tangents' two components.
  return 1 / std::sqrt(std::max(squares - count * mean.squaredNorm(), 1e-12));
}

double Longest_mm(const RegistrationProblem& problem) {
  return std::max(problem.sample_width_mm, problem.sample_height_mm);
}

}  // namespace

HomographySpreads LearnedSpreads(const RegistrationProblem& problem, const SamplePlaces& places,
                                 const HomographySpreads& spreads, const std::vector<int>& held) {
  const double expected = problem.homography_sd_mm / places.unit_mm;
  std::array<double, 3> squares{}, count{};
  for (int i = 0; i < 8; ++i) {
    if (std::find(held.begin(), held.end(), i) != held.end()) continue;
    const auto value = static_cast<size_t>(i);
    const size_t kind = kSpreadOfValue[value];
    squares[kind] += constants::kHomographySdViews * expected * expected;
    count[kind] += constants::kHomographySdViews;
    for (const HomographyValues& values : places.homographies) {
      squares[kind] +=
          values[value] * values[value] - constants::kCommonShiftSd * constants::kCommonShiftSd;
      ++count[kind];
    }
  }
  HomographySpreads learned = spreads;
  for (size_t kind = 0; kind < 3; ++kind) {
    if (count[kind] > 0) learned[kind] = std::sqrt(std::max(squares[kind] / count[kind], 0.0));
  }
  return learned;
}

PlaceSolution FitPlane(const RegistrationProblem& problem, const SamplePlaces& start,
                       const HomographySpreads& spreads, const std::vector<WindowHeight>& heights) {
  PlaceSolution solution{start, spreads, {}};
  const double least_mm = constants::kLeastHeightSd * Longest_mm(problem);
  double sigma_mm = 0;
  std::vector<double> off;
  off.reserve(heights.size());
  for (const WindowHeight& window : heights) off.push_back(std::abs(window.height_mm));
  for (int pass = 0; pass < constants::kHeightPasses; ++pass) {
    sigma_mm = std::max(least_mm, Median(off) / kMedianOfNormal);
    const auto loss = RobustLoss(1);
    ceres::Problem fit(SharingLosses());
    double* plane = solution.places.plane.data();
    off.clear();
    for (const WindowHeight& window : heights) {
      // Heights were found parallel to the start's plane.
      const double height_mm = window.height_mm + start.plane[0] +
                               start.plane[1] * window.point_mm.x() +
                               start.plane[2] * window.point_mm.y();
      fit.AddResidualBlock(new ceres::AutoDiffCostFunction<HeightAt, 1, 3>(
                               new HeightAt{window.point_mm, height_mm, sigma_mm}),
                           loss.get(), plane);
    }
    AddPrior<3>({problem.height_mm, 0, 0},
                {problem.height_sd_mm, problem.slope_sd, problem.slope_sd}, plane, &fit);
    SolveRobustly(&fit);
    for (const WindowHeight& window : heights) {
      off.push_back(std::abs(window.height_mm + start.plane[0] - plane[0] +
                             (start.plane[1] - plane[1]) * window.point_mm.x() +
                             (start.plane[2] - plane[2]) * window.point_mm.y()));
    }
    solution.plane_covariance = CovarianceOfBlock(plane, &fit);
  }
  const double displaced_mm = spreads[0] * start.unit_mm * HeightOfDisplacement(problem);
  const double common_mm = std::hypot(constants::kCommonHeightSd * Longest_mm(problem),
                                      displaced_mm, constants::kCommonScatter * sigma_mm);
  const double common_slope = common_mm / Longest_mm(problem);
  const Eigen::Vector3d common(common_mm, common_slope, common_slope);
  solution.plane_covariance.diagonal() += common.cwiseAbs2();
  return solution;
}

bool LiesAsSaid(const RegistrationProblem& problem, const PlaceSolution& found) {
  if (!problem.often_as_said) return false;
  const Eigen::Vector3d off(found.places.plane[0] - problem.height_mm, found.places.plane[1],
                            found.places.plane[2]);
  const Eigen::LLT<Eigen::Matrix3d> root(found.plane_covariance);
  const double log_found = root.matrixLLT().diagonal().array().log().sum();
  const double log_expected = std::log(problem.height_sd_mm) + 2 * std::log(problem.slope_sd);
  return 0.5 * off.dot(root.solve(off)) < log_expected - log_found;
}

PlaceSolution FitHomographies(const RegistrationProblem& problem, const DetailPictures& pictures,
                              const SamplePlaces& start, const HomographySpreads& spreads,
                              const std::vector<PredictedShift>& shifts) {
  PlaceSolution solution{start, spreads, {}};
  std::vector<SeenAt> seen;
  const PlaneFrame<double> frame(start.plane.data());
  for (const PredictedShift& shift : shifts) {
    const Eigen::Vector2d assumed =
        pictures.AssumedPoint(shift.view, start, shift.point_mm + shift.shift_mm);
    SeenAt at{{}, shift.point_mm, shift.information.llt().matrixU(), start.unit_mm};
    frame.SampleFromAssumed(pictures.camera_mm(shift.view), assumed.x(), assumed.y(),
                            at.seen_mm.data());
    seen.push_back(at);
  }
  for (int pass = 0; pass < constants::kHomographyPasses; ++pass) {
    auto homography = [&](size_t i) {
      return solution.places.homographies[static_cast<size_t>(shifts[i].view)].data();
    };
    std::vector<double> squares;
    for (size_t i = 0; i < seen.size(); ++i) {
      double residual[2];
      seen[i](homography(i), residual);
      squares.push_back(residual[0] * residual[0] + residual[1] * residual[1]);
    }
    const double scale = std::sqrt(
        std::max(Median(squares) / kMedianOfSquaredPair, std::numeric_limits<double>::min()));
    const auto loss = RobustLoss(1 / constants::kTimesCounted);
    ceres::Problem fit(SharingLosses());
    for (size_t i = 0; i < seen.size(); ++i) {
      SeenAt* at = new SeenAt(seen[i]);
      at->root /= scale;
      fit.AddResidualBlock(new ceres::AutoDiffCostFunction<SeenAt, 2, 8>(at), loss.get(),
                           homography(i));
    }
    for (HomographyValues& values : solution.places.homographies) {
      if (!fit.HasParameterBlock(values.data())) continue;
      std::array<double, 8> sigma;
      for (size_t i = 0; i < 8; ++i) sigma[i] = solution.spreads[kSpreadOfValue[i]];
      if (*std::min_element(sigma.begin(), sigma.end()) <= 0) {
        values = {};
        fit.SetParameterBlockConstant(values.data());
        continue;
      }
      AddPrior<8>({}, sigma, values.data(), &fit);
    }
    SolveRobustly(&fit);
    solution.spreads = LearnedSpreads(problem, solution.places, solution.spreads, {});
  }
  return solution;
}

}  // namespace glint
