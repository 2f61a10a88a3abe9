// A sample that was moved on its plane between photographs, or exchanged: further than what
// RegisterSample's other comparisons reach.
#pragma once

#include <vector>

#include "calib/registration/detail_pictures.h"
#include "calib/registration/sample_place.h"

namespace glint {

struct SampleMoves {
  // By view, against where most views have the sample; empty where it was not moved.
  std::vector<SampleMove> moves;
  // By view: which texture it shows, 0 that of most, 1 another one; −1 where that cannot be told.
  // Empty where they all show one.
  std::vector<int> textures;
};

// `plane`: as far as it is known (coarse_plane.h). From the view that is nearest to the vertical
// on, the next one is each time brought to those before: at the shift, and the turn, at which they
// explain most of its texture (common_texture.h). Relief that is lit from another side seems to be
// moved; it seems so in proportion to the camera's direction, like a height (common_motion.h), and
// less the better its texture is explained. What is left beyond constants::kMove_sd of that, is
// longer than constants::kLeastMove, and leaves less than constants::kMoveExplains of what no
// motion leaves, is a motion. Nothing is found of fewer than four views, which any displacement
// explains.
SampleMoves FindMoves(const RegistrationProblem& problem, const DetailPictures& pictures,
                      const PlaneValues& plane);

// Views that were moved alike, were moved together: by view of `moves`, all of its kind.
std::vector<std::vector<size_t>> MovedTogether(const RegistrationProblem& problem,
                                               const std::vector<SampleMove>& moves);

// The views as they would be had the sample not been moved.
RegistrationProblem WithoutMoves(RegistrationProblem problem, const std::vector<SampleMove>& moves);

}  // namespace glint
