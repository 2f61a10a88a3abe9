// ArUco dictionaries by the names OpenCV gives them.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace glint {

// Every name that a board's description may carry ("DICT_4X4_50" … "DICT_APRILTAG_36h11").
const std::vector<std::string>& DictionaryNames();

// OpenCV's number of the dictionary (cv::aruco::PREDEFINED_DICTIONARY_NAME); nullopt: unknown name.
std::optional<int> DictionaryNumber(const std::string& name);

// OpenCV's name for a family by AprilTag's own ("tag36h11"); other names as they are.
std::string DictionaryFromAnyName(const std::string& name);

// How many markers the dictionary holds. `name` must be known.
int DictionarySize(const std::string& name);

// Cells of one marker, its black border included: cells × cells values, row-major from the top
// left, 0 ink, 1 paper. `name` must be known and 0 ≤ id < DictionarySize(name).
struct MarkerCells {
  int cells = 0;
  std::vector<unsigned char> paper;
};
MarkerCells CellsOfMarker(const std::string& name, int id);

}  // namespace glint
