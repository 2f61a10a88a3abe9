// What is unknown about the views, as one vector. By the view: the light's offset by the light's
// distance (3), the logarithm of the exposure, and the displacement of the picture's corners
// (columns 4, rows 4; last of all, and only with registration). For all views: what the lights'
// offsets share, in the frame of each light (3), and the ambient irradiance by the flash's mean
// (3).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fitting/view_correction/view_correction.h"

namespace glint {

class ViewUnknowns {
 public:
  // `set` must outlive this.
  ViewUnknowns(const PhotographSet& set, bool registration);

  int views() const { return static_cast<int>(light_distance_mm_.size()); }
  bool registration() const { return registration_; }
  int size() const { return first_shift() + (registration_ ? 8 * views() : 0); }
  static int light(int view) { return 3 * view; }
  int shared_light() const { return 3 * views(); }
  int ambient() const { return shared_light() + 3; }
  int exposure(int view) const { return ambient() + 3 + view; }
  int first_shift() const { return exposure(views()); }
  int shift(int view) const { return first_shift() + 8 * view; }

  double light_distance_mm(int view) const { return light_distance_mm_[At(view)]; }
  // Of the flash at the sample's centre, unexposed, mean of channels and views: what the ambient
  // light, which is the same for all views, is measured by.
  double irradiance() const { return irradiance_; }
  // Toward the light as it was said to be.
  Vec3d LightDirection(int view) const;
  // The least turn that takes z there: what is beside an upright camera's lens, in the sample's
  // frame.
  Eigen::Matrix3d LightFrame(int view) const;
  // Least value of the ambient unknown of a channel: the surroundings take no light.
  double LeastAmbient(int channel) const;

  View ViewAt(int view, const Eigen::VectorXd& unknowns) const;
  ViewCorrection CorrectionAt(int view, const Eigen::VectorXd& unknowns) const;
  // The unknowns that say so; what the lights share is their mean.
  Eigen::VectorXd Of(const std::vector<ViewCorrection>& corrections) const;

 private:
  static size_t At(int view) { return static_cast<size_t>(view); }

  const PhotographSet& set_;
  bool registration_;
  std::vector<double> light_distance_mm_;
  double irradiance_ = 0;
};

}  // namespace glint
