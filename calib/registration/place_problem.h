// Plane and homographies from displacements of windows between pairs of views: a first answer, near
// enough for what views have in common to be compared. Shading that moves with the light is taken
// for displacement here.
#pragma once

#include <vector>

#include "calib/registration/detail_pictures.h"
#include "calib/registration/place_fit.h"
#include "calib/registration/window_shifts.h"

namespace glint {

// What is unknown in a round. Homographies are told best by small windows, which need photographs
// that are nearly in place.
enum class UnknownPlaces {
  kPlane,         // the homographies are held
  kTranslations,  // with the plane held
  kPlaneAndAffine,
  kPlaneAndHomographies
};

// Improves `start`, at which `shifts` of pictures of `size` were measured. `spreads` are
// those found so far, and the problem's at first. The plane's prior is the problem's.
PlaceSolution SolvePlaces(const RegistrationProblem& problem, const DetailPictures& pictures,
                          const SamplePlaces& start, const HomographySpreads& spreads,
                          const std::vector<WindowShift>& shifts, const cv::Size& size,
                          UnknownPlaces unknown);

}  // namespace glint
