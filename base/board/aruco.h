// OpenCV's marker dictionaries, of 4.6 (Debian 12), which hands them out by pointer, and since 4.7
// (Debian 13), by value. Only for sources that include OpenCV anyway.
#pragma once

#include <opencv2/aruco.hpp>

namespace glint::aruco {

inline cv::Ptr<cv::aruco::Dictionary> Pointer(const cv::Ptr<cv::aruco::Dictionary>& dictionary) {
  return dictionary;
}
inline cv::Ptr<cv::aruco::Dictionary> Pointer(const cv::aruco::Dictionary& dictionary) {
  return cv::makePtr<cv::aruco::Dictionary>(dictionary);
}

// By its number in OpenCV's enumeration.
inline cv::Ptr<cv::aruco::Dictionary> Dictionary(int number) {
  return Pointer(cv::aruco::getPredefinedDictionary(number));
}

}  // namespace glint::aruco
