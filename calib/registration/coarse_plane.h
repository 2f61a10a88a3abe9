// The sample's plane to within what finer comparisons reach, by trying heights.
#pragma once

#include "calib/registration/detail_pictures.h"

namespace glint {

// The most probable height of a plane parallel to the assumed one, given its prior, among heights a
// pixel of small pictures apart, where the views have most in common (window_heights.h); and the
// plane through the heights about it at which single windows have. The problem's height_mm where it
// is held.
PlaneValues CoarsePlane(const RegistrationProblem& problem, const DetailPictures& pictures,
                        int threads);

}  // namespace glint
