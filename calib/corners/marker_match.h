// Markers seen, as markers of a board: which of them lie where the description has them.
#pragma once

#include <vector>

#include "calib/corners/detector.h"
#include "calib/corners/local_homography.h"
#include "calib/corners/markers.h"

namespace glint::corners {

// A marker seen, with the places of its four corners on the board.
struct MarkerMatch {
  int id = 0;
  PlanePoint corners[4];
  double side_px = 0;
};

// Of the board's ids; others are left out.
std::vector<MarkerMatch> MatchMarkers(const Board& board, const std::vector<SeenMarker>& seen);

std::vector<PlanePoint> MatchedPoints(const std::vector<MarkerMatch>& matches);

// The largest set of markers that one homography explains; homographies come from pairs, which are
// gone through in a fixed order. A single marker has nobody to agree with.
std::vector<MarkerMatch> Consensus(const std::vector<MarkerMatch>& matches);

// The same for a marker frame whose markers may all be turned alike by quarters: programs differ in
// what they call a marker's top left (OpenCV draws AprilTags upside down), and the markers' places
// tell. Where several turns explain as many, the described one.
std::vector<MarkerMatch> ConsensusOfFrame(const Board& board, const std::vector<SeenMarker>& seen);

// Whether the picture, turned left for right, shows markers of the board where they belong.
bool ShowsMirroredMarkers(const GrayImage& image, const Board& board,
                          const DetectorOptions& options);
inline constexpr char kMirrored[] =
    "the picture is mirrored (its markers can be read left for right only); switch off the "
    "camera's mirroring, or mirror the file back";

}  // namespace glint::corners
