// Which way round a checkerboard lies that looks the same upside down.
//
// Turned by 180°, a board of which columns and rows are both odd, or both even, is itself. Each
// photograph's corners are then numbered as if it had been taken from the camera's own side, and
// who walks round the table gets half of the photographs upside down. The sample's texture tells:
// in all photographs it must be the same way up.
#pragma once

#include <string>
#include <vector>

#include "base/formats/capture.h"
#include "calib/capture/detect_photos.h"

namespace glint {

// Where the sample's centre may lie by the corners as they are numbered first.
std::vector<Eigen::Vector2d> PlacesOfSample(const Board& board);

// Numbers the corners of photographs from the other side anew. Returns what a person should know:
// which were turned, or that the texture does not tell; empty where the board has but one way up.
std::vector<std::string> SettleBoardSides(const Capture& capture,
                                          std::vector<DetectedPhoto>* photos);

}  // namespace glint
