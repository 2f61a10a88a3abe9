#include "base/board/dictionary.h"

#include <algorithm>
#include <utility>

#include "base/board/aruco.h"

namespace glint {
namespace {

cv::Ptr<cv::aruco::Dictionary> OpenCvDictionary(const std::string& name) {
  return aruco::Dictionary(DictionaryNumber(name).value());
}

}  // namespace

const std::vector<std::string>& DictionaryNames() {
  // In the order of OpenCV's enumeration, which starts at 0.
  static const std::vector<std::string> names = {
      "DICT_4X4_50",         "DICT_4X4_100",       "DICT_4X4_250",       "DICT_4X4_1000",
      "DICT_5X5_50",         "DICT_5X5_100",       "DICT_5X5_250",       "DICT_5X5_1000",
      "DICT_6X6_50",         "DICT_6X6_100",       "DICT_6X6_250",       "DICT_6X6_1000",
      "DICT_7X7_50",         "DICT_7X7_100",       "DICT_7X7_250",       "DICT_7X7_1000",
      "DICT_ARUCO_ORIGINAL", "DICT_APRILTAG_16h5", "DICT_APRILTAG_25h9", "DICT_APRILTAG_36h10",
      "DICT_APRILTAG_36h11"};
  static_assert(cv::aruco::DICT_4X4_50 == 0 && cv::aruco::DICT_APRILTAG_36h11 == 20);
  return names;
}

std::optional<int> DictionaryNumber(const std::string& name) {
  const auto& names = DictionaryNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<int>(found - names.begin());
}

std::string DictionaryFromAnyName(const std::string& name) {
  if (name.rfind("tag", 0) == 0 && DictionaryNumber("DICT_APRILTAG_" + name.substr(3))) {
    return "DICT_APRILTAG_" + name.substr(3);
  }
  return name;
}

int DictionarySize(const std::string& name) { return OpenCvDictionary(name)->bytesList.rows; }

MarkerCells CellsOfMarker(const std::string& name, int id) {
  const auto dictionary = OpenCvDictionary(name);
  MarkerCells marker;
  marker.cells = dictionary->markerSize + 2;
  const cv::Mat bits = cv::aruco::Dictionary::getBitsFromByteList(
      dictionary->bytesList.rowRange(id, id + 1), dictionary->markerSize);
  const cv::Rect inside(1, 1, bits.cols, bits.rows);  // of a rim of ink
  marker.paper.reserve(static_cast<size_t>(marker.cells) * marker.cells);
  for (int row = 0; row < marker.cells; ++row) {
    for (int column = 0; column < marker.cells; ++column) {
      marker.paper.push_back(
          inside.contains({column, row}) && bits.at<unsigned char>(row - 1, column - 1) != 0 ? 1
                                                                                             : 0);
    }
  }
  return marker;
}

}  // namespace glint
