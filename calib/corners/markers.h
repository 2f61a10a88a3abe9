// ArUco markers in a picture: identities, and places good enough to predict corners from.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "calib/corners/gray_image.h"

namespace glint {

struct SeenMarker {
  int id = 0;
  // Clockwise from the marker's own top left, ± a few pixels.
  std::array<Eigen::Vector2d, 4> corners_px;

  Eigen::Vector2d centre_px() const;
  double side_px() const;  // mean length of the four sides
};

// Looks on a reduced copy first (longest side `longest_px`), and on the full image when that shows
// fewer than `enough` markers. Ascending ids; an id seen twice is left out, as neither can be
// trusted.
std::vector<SeenMarker> FindMarkers(const GrayImage& image, const std::string& dictionary,
                                    int longest_px, int enough);

// The dictionary in which the picture shows most markers; "" when none shows three.
std::string GuessDictionary(const GrayImage& image, int longest_px, int* markers);

}  // namespace glint
