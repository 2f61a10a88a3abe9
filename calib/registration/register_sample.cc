#include "calib/registration/register_sample.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/model/registration.h"
#include "base/model/solver.h"
#include "base/parallel/parallel.h"
#include "calib/registration/coarse_plane.h"
#include "calib/registration/detail_pictures.h"
#include "calib/registration/factor_analysis.h"
#include "calib/registration/place_problem.h"
#include "calib/registration/sample_moves.h"
#include "calib/registration/window_shifts.h"

namespace glint {
namespace {

// First by pairs of views, in windows in parts of the sample's longer side.
struct Round {
  double window;
  UnknownPlaces unknown;
};
constexpr Round kPairRounds[] = {
    {constants::kPairWindows[0], UnknownPlaces::kPlane},
    {constants::kPairWindows[1], UnknownPlaces::kTranslations},
    {constants::kPairWindows[2], UnknownPlaces::kPlaneAndAffine},
    {constants::kPairWindows[3], UnknownPlaces::kPlaneAndHomographies}};

// Windows by which metrics report how far photographs are displaced.
constexpr double kJudged = 1.0 / 4;

class Registration {
 public:
  Registration(RegistrationProblem problem, int threads)
      : problem_(std::move(problem)),
        pictures_(problem_, constants::kCoarseDetail),
        fine_(problem_, constants::kFineDetail),
        threads_(threads) {}

  bool fixed() const {
    return pictures_.views() < 2 || (problem_.height_sd_mm <= 0 && problem_.homography_sd_mm <= 0);
  }

  void FindCoarsePlane() {
    if (!fixed()) coarse_ = CoarsePlane(problem_, fine_, threads_);
  }

  SampleMoves Moves() const {
    return fixed() ? SampleMoves{} : FindMoves(problem_, pictures_, coarse_);
  }

  SampleRegistration Register() {
    SampleRegistration result = Unregistered(problem_);
    if (fixed()) return result;
    places_.unit_mm = 0.5 * std::max(problem_.sample_width_mm, problem_.sample_height_mm);
    places_.homographies.resize(problem_.views.size());
    places_.plane[0] = problem_.height_mm;
    spreads_.fill(problem_.homography_sd_mm / places_.unit_mm);
    result.displaced_before_mm = Displaced_mm(&result);
    places_.plane = coarse_;
    const double reach_mm = constants::kNeedsPairs * 2 * places_.unit_mm;
    const bool few = FactorsOf(pictures_.views()) == 0;
    const bool loose = problem_.homography_sd_mm > reach_mm;
    if (few && loose) return result;  // of two or three, all could be displaced by anything
    if (few || loose) ComparePairs(few, &result);
    for (int round = 0; round < constants::kCommonRounds && !few; ++round) {
      const SamplePlaces before = places_;
      CompareInCommon(round > 0, &result);
      const double pixel_mm = pictures_.PixelSide_mm(pictures_.OwnSize());
      if (Moved_mm(before) < constants::kStill_px * pixel_mm) break;
    }
    if (!result.told) return Unregistered(problem_);
    result.displaced_after_mm = Displaced_mm(&result);
    result.plane = places_.plane;
    for (size_t i = 0; i < problem_.views.size(); ++i) {
      result.homographies[i] = HomographyMatrix(places_.homographies[i], places_.unit_mm).inverse();
    }
    return result;
  }

 private:
  // Of few views the plane alone, as far as shading lets pairs tell it.
  void ComparePairs(bool few, SampleRegistration* result) {
    const auto pairs = PairsOf(pictures_.views());
    for (const Round& round : kPairRounds) {
      if (few && round.unknown != UnknownPlaces::kPlane) break;
      const std::vector<WindowShift> shifts = Shifts(round.window, pairs, nullptr);
      if (shifts.empty()) return;
      result->told = true;
      Take(SolvePlaces(problem_, pictures_, places_, spreads_, shifts, pictures_.OwnSize(),
                       round.unknown),
           result);
    }
    if (!few || problem_.height_sd_mm <= 0) return;
    const double longest_mm = std::max(problem_.sample_width_mm, problem_.sample_height_mm);
    const Eigen::Vector3d shading(constants::kPairsHeightSd * longest_mm, constants::kPairsHeightSd,
                                  constants::kPairsHeightSd);
    result->plane_covariance.diagonal() += shading.cwiseAbs2();
    if (LiesAsSaid(problem_, {places_, spreads_, result->plane_covariance})) {
      places_.plane = {problem_.height_mm, 0, 0};
    }
  }

  // Improves plane and homographies by what all views have in common.
  void CompareInCommon(bool near, SampleRegistration* result) {
    const cv::Size size = fine_.OwnSize();
    if (problem_.height_sd_mm > 0) {
      const std::vector<WindowHeight> heights = WindowHeights(fine_, places_, size, near, threads_);
      result->told = std::ssize(heights) >= constants::kLeastHeights;
      if (result->told) {
        const PlaceSolution plane = FitPlane(problem_, places_, spreads_, heights);
        Take(plane, result);
        if (LiesAsSaid(problem_, plane)) places_.plane = {problem_.height_mm, 0, 0};
      }
    }
    if (problem_.homography_sd_mm <= 0 || (problem_.height_sd_mm > 0 && !result->told)) return;
    const std::vector<PredictedShift> shifts = PredictedShifts(fine_, places_, size, threads_);
    if (shifts.empty()) return;
    result->told = true;
    const PlaceSolution solution = FitHomographies(problem_, fine_, places_, spreads_, shifts);
    places_ = solution.places;
    spreads_ = solution.spreads;
  }

  // The most that a corner of the sample is elsewhere in a view.
  double Moved_mm(const SamplePlaces& before) const {
    double most = 0;
    for (int view = 0; view < pictures_.views(); ++view) {
      for (const double x : {-0.5, 0.5}) {
        for (const double y : {-0.5, 0.5}) {
          const Eigen::Vector2d corner(x * problem_.sample_width_mm, y * problem_.sample_height_mm);
          most = std::max(most, (pictures_.AssumedPoint(view, places_, corner) -
                                 pictures_.AssumedPoint(view, before, corner))
                                    .norm());
        }
      }
    }
    return most;
  }

  void Take(const PlaceSolution& solution, SampleRegistration* result) {
    places_ = solution.places;
    spreads_ = solution.spreads;
    result->plane_covariance = solution.plane_covariance;
  }

  std::vector<WindowShift> Shifts(double window, const std::vector<std::pair<int, int>>& pairs,
                                  int* windows) const {
    const cv::Size size = pictures_.OwnSize();
    std::vector<cv::Mat> looked_up(problem_.views.size());
    ForEachPiece(pictures_.views(), threads_, [&](int view) {
      looked_up[static_cast<size_t>(view)] = pictures_.LookUp(view, places_, size);
    });
    const int longest_px = std::max(size.width, size.height);
    const int window_px = 2 * static_cast<int>(std::lround(0.5 * window * longest_px));
    return WindowShifts(looked_up, pairs, window_px, constants::kLongestShift * longest_px,
                        threads_, windows);
  }

  // Median over windows and neighbouring views; counts them.
  double Displaced_mm(SampleRegistration* result) const {
    std::vector<std::pair<int, int>> neighbours;
    for (int i = 0; i + 1 < pictures_.views(); ++i) neighbours.emplace_back(i, i + 1);
    std::vector<double> lengths;
    for (const WindowShift& shift : Shifts(kJudged, neighbours, &result->windows)) {
      lengths.push_back(std::hypot(shift.dx_px, shift.dy_px));
    }
    result->measured = static_cast<int>(lengths.size());
    if (lengths.empty()) return 0;
    const auto middle = lengths.begin() + std::ssize(lengths) / 2;
    std::nth_element(lengths.begin(), middle, lengths.end());
    return *middle * pictures_.PixelSide_mm(pictures_.OwnSize());
  }

  const RegistrationProblem problem_;
  const DetailPictures pictures_, fine_;
  const int threads_;
  PlaneValues coarse_{0, 0, 0};
  SamplePlaces places_;
  HomographySpreads spreads_{};
};

// What a homography does, as a motion.
SampleMove MotionOf(const Eigen::Matrix3d& homography) {
  return {0.5 * (homography(1, 0) - homography(0, 1)), homography.topRightCorner<2, 1>()};
}

SampleMove MeanOf(const std::vector<SampleMove>& moves, const std::vector<size_t>& views) {
  SampleMove mean;
  for (const size_t view : views) {
    mean.turn_rad += moves[view].turn_rad / static_cast<double>(views.size());
    mean.shift_mm += moves[view].shift_mm / static_cast<double>(views.size());
  }
  return mean;
}

// Improves motions by where each view is displaced against the others once they are undone; those
// of views that were moved together are one.
std::vector<SampleMove> FineMoves(const RegistrationProblem& problem,
                                  const std::vector<int>& textures, std::vector<SampleMove> moves,
                                  int threads) {
  RegistrationProblem loose = WithoutMoves(problem, moves);
  loose.homography_sd_mm =
      constants::kImportedPlaceSd * std::max(problem.sample_width_mm, problem.sample_height_mm);
  Registration registration(std::move(loose), threads);
  registration.FindCoarsePlane();
  const std::vector<Eigen::Matrix3d> left = registration.Register().homographies;
  std::vector<std::vector<size_t>> together = MovedTogether(problem, moves);
  if (!textures.empty()) {  // of another one nothing is known here
    for (auto& views : together) {
      std::erase_if(views, [&](size_t view) { return textures[view] != 0; });
    }
  }
  std::vector<SampleMove> fine = moves;
  SampleMove unmoved;
  for (size_t i = 0; i < moves.size(); ++i) {
    const SampleMove motion = MotionOf(left[i]);
    fine[i].turn_rad += motion.turn_rad;
    fine[i].shift_mm += Eigen::Rotation2Dd(moves[i].turn_rad) * motion.shift_mm;
  }
  for (size_t i = 0; i < moves.size(); ++i) {
    if (moves[i].none() && !together[i].empty()) unmoved = MeanOf(fine, together[i]);
  }
  for (size_t i = 0; i < moves.size(); ++i) {
    if (moves[i].none()) continue;
    const SampleMove mean = MeanOf(fine, together[i]);
    const double turn_rad = mean.turn_rad - unmoved.turn_rad;
    moves[i] = {turn_rad, mean.shift_mm - Eigen::Rotation2Dd(turn_rad) * unmoved.shift_mm};
  }
  return moves;
}

}  // namespace

double SampleRegistration::height_sd_mm() const { return std::sqrt(plane_covariance(0, 0)); }

SampleRegistration Unregistered(const RegistrationProblem& problem) {
  SampleRegistration prior;
  prior.plane[0] = problem.height_mm;
  const double height = problem.height_sd_mm, slope = height > 0 ? problem.slope_sd : 0;
  prior.plane_covariance.diagonal() << height * height, slope * slope, slope * slope;
  prior.homographies.assign(problem.views.size(), Eigen::Matrix3d::Identity());
  return prior;
}

SampleRegistration RegisterSample(const RegistrationProblem& problem, int threads) {
  if (problem.views.empty()) return Unregistered(problem);
  Registration registration(problem, threads);
  registration.FindCoarsePlane();
  const SampleMoves found = problem.may_have_moved ? registration.Moves() : SampleMoves{};
  SampleRegistration result;
  if (found.moves.empty()) {
    result = registration.Register();
  } else {
    std::vector<SampleMove> moves = found.moves;
    for (int pass = 0; pass < constants::kMoveSweeps; ++pass) {
      moves = FineMoves(problem, found.textures, std::move(moves), threads);
    }
    Registration without(WithoutMoves(problem, moves), threads);
    without.FindCoarsePlane();
    result = without.Register();
    result.moves = moves;
  }
  result.textures = found.textures;
  return result;
}

}  // namespace glint
