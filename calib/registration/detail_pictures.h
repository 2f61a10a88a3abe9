// The views' texture: log radiance without its coarse part, and the same looked up where a plane
// and homographies put it.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "calib/registration/register_sample.h"

namespace glint {

// What is estimated. Homographies take a point that the plane alone puts at q to the sample's point
// (the inverses of SampleRegistration's).
struct SamplePlaces {
  PlaneValues plane{0, 0, 0};
  std::vector<HomographyValues> homographies;  // by view
  double unit_mm = 1;                          // theirs: half the sample's longer side
};

class DetailPictures {
 public:
  // Without structure coarser than `coarse` of the sample's longer side. Throws
  // std::invalid_argument as RegisterSample does.
  DetailPictures(const RegistrationProblem& problem, double coarse);

  int views() const { return static_cast<int>(details_.size()); }
  // Whether the views show what is beside the sample.
  bool surrounded() const { return problem_.margin > 1; }
  const Eigen::Vector3d& camera_mm(int view) const {
    return problem_.views[static_cast<size_t>(view)].camera_mm;
  }
  // Of pictures as they are looked up: square pixels, `longest` along the sample's longer side.
  cv::Size SizeOf(int longest) const;
  cv::Size OwnSize() const;  // with the views' own pixels
  // The sample's point at a picture's coordinate (pixel centres at .5).
  Eigen::Vector2d SamplePoint(const cv::Size& size, double x_px, double y_px) const;
  double PixelSide_mm(const cv::Size& size) const { return problem_.sample_width_mm / size.width; }

  // Where view `view` shows the sample's point: on the assumed plane.
  Eigen::Vector2d AssumedPoint(int view, const SamplePlaces& places,
                               const Eigen::Vector2d& point_mm) const;
  // CV_32F of `size`; 0 (no detail) beyond the view.
  cv::Mat LookUp(int view, const SamplePlaces& places, const cv::Size& size) const {
    return LookUp(view, places, size, {{0, 0}, size});
  }
  // A part of it.
  cv::Mat LookUp(int view, const SamplePlaces& places, const cv::Size& size,
                 const cv::Rect& part) const;

 private:
  // The smallest level that is as fine as a picture of that size.
  const cv::Mat& LevelFor(int view, const cv::Size& size) const;
  Eigen::Matrix3d AssumedFromPlace(int view, const SamplePlaces& places) const;

  const RegistrationProblem& problem_;
  std::vector<std::vector<cv::Mat>> details_;  // by view: a pyramid, the finest first
};

}  // namespace glint
