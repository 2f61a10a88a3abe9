// Where to hold the phone next.
#pragma once

#include <vector>

#include "calib/guidance/coverage.h"

namespace glint {

// A photograph that does not exist yet: the camera looks at the sample's centre from the median
// distance of the others, its flash placed to it as theirs are on average.
struct Suggestion {
  Direction direction;
  GuidancePhoto photo;
  double gain_share = 0;  // of the sample, that sees a highlight with it and not without
};

// The photographs, at most `most` one after the other, that bring a highlight to most of what has
// none: the best of candidates every 2.5° of tilt (to 40°) and every 15° round; ties go to the
// smaller tilt. Stops where the next would gain less than `least_gain` of the sample.
std::vector<Suggestion> SuggestForHighlights(const Coverage& coverage,
                                             const std::vector<GuidancePhoto>& photos,
                                             double highlight_deg, int most = 3,
                                             double least_gain = 0.01);

// The largest gap between the azimuths of photographs tilted by `least_tilt_deg` or more, and its
// middle. 360 where there are none or one.
struct AzimuthGap {
  double width_deg = 360, middle_deg = 0;
};
AzimuthGap LargestGap(const std::vector<GuidancePhoto>& photos, double least_tilt_deg);

// "12° off vertical toward the top right"; sides as the maps show the sample.
std::string InWords(const Direction& direction);
// "right", "top right", "top" … of an azimuth.
std::string SideName(double azimuth_deg);

// What part of the sample the cells marked in `cells` are: "the right edge", "the top left corner",
// "the rim", "the middle", "most of it", "all of it".
std::string RegionName(const CoverageGrid& grid, const std::vector<bool>& cells);

}  // namespace glint
