// Plane and homographies from what windows tell of each, robustly, and what is common to such fits.
#pragma once

#include <array>
#include <vector>

#include "calib/registration/detail_pictures.h"
#include "calib/registration/predicted_shifts.h"
#include "calib/registration/window_heights.h"

namespace glint {

// Standard deviations of homographies' values: of their translations, of what is affine beside
// them, and of what is projective.
using HomographySpreads = std::array<double, 3>;

// Which of them a homography's value has.
inline constexpr std::array<size_t, 8> kSpreadOfValue = {1, 1, 0, 1, 1, 0, 2, 2};

struct PlaceSolution {
  SamplePlaces places;
  HomographySpreads spreads{};  // as they are found to be
  Eigen::Matrix3d plane_covariance = Eigen::Matrix3d::Zero();
};

// `start` with the plane through the windows' heights above it; the plane's prior is the problem's.
PlaceSolution FitPlane(const RegistrationProblem& problem, const SamplePlaces& start,
                       const HomographySpreads& spreads, const std::vector<WindowHeight>& heights);

// Whether a sample exactly in the plane of its prior is more probable than one in the plane that
// was found: both were as probable before, and of all planes that the prior allows few are as near.
bool LiesAsSaid(const RegistrationProblem& problem, const PlaceSolution& found);

// `start` with homographies that undo the displacements, its plane held.
PlaceSolution FitHomographies(const RegistrationProblem& problem, const DetailPictures& pictures,
                              const SamplePlaces& start, const HomographySpreads& spreads,
                              const std::vector<PredictedShift>& shifts);

// Of the values other than `held`, given the problem's expectation (MacKay 1992).
HomographySpreads LearnedSpreads(const RegistrationProblem& problem, const SamplePlaces& places,
                                 const HomographySpreads& spreads, const std::vector<int>& held);

}  // namespace glint
