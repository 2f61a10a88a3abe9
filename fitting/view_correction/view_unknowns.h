// What is unknown about the views, as one vector: the environment lighting (by the channel, term by
// term: the irradiance of a uniform environment that is as bright, by the flash's mean); by the
// view the light's offset by the light's distance (3); what these offsets share, in the frame of
// each light (3); by the view the logarithm of the exposure; by the view the displacement of the
// picture's corners (columns 4, rows 4).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fitting/view_correction/view_correction.h"

namespace glint {

// What is taken as unknown.
struct UnknownKinds {
  bool light = true;
  bool exposure = true;
  bool registration = true;
  int environment_terms = kEnvironmentTerms;  // of the environment lighting, 0: none
};

class ViewUnknowns {
 public:
  // `set` must outlive this.
  ViewUnknowns(const PhotographSet& set, const UnknownKinds& kinds);

  int views() const { return static_cast<int>(light_distance_mm_.size()); }
  const UnknownKinds& kinds() const { return kinds_; }
  int size() const { return first_shift() + (kinds_.registration ? 8 * views() : 0); }
  // Where they begin, if their kind is unknown.
  int environment(int channel) const { return kinds_.environment_terms * channel; }
  int light(int view) const { return 3 * kinds_.environment_terms + 3 * view; }
  int shared_light() const { return light(views()); }
  int exposure(int view) const { return first_exposure() + view; }
  int first_shift() const { return first_exposure() + (kinds_.exposure ? views() : 0); }
  int shift(int view) const { return first_shift() + 8 * view; }

  double light_distance_mm(int view) const { return light_distance_mm_[At(view)]; }
  // Of the flash at the sample's centre, unexposed, mean of channels and views, by π: what the
  // environment lighting, which is the same for all views, is measured by.
  double environment_unit() const { return environment_unit_; }
  // Toward the light as it was said to be.
  Vec3d LightDirection(int view) const;
  // The least turn that takes z there: what is beside an upright camera's lens, in the sample's
  // frame.
  Eigen::Matrix3d LightFrame(int view) const;
  // Least value of the even term of a channel: environment lighting is not negative.
  double LeastEnvironment(int channel) const;

  View ViewAt(int view, const Eigen::VectorXd& unknowns) const;
  // The set's and what is unknown of it.
  EnvironmentLighting EnvironmentAt(const Eigen::VectorXd& unknowns) const;
  ViewCorrections CorrectionsAt(const Eigen::VectorXd& unknowns) const;
  // The unknowns that say so; what the lights share is their mean.
  Eigen::VectorXd Of(const ViewCorrections& corrections) const;

 private:
  int first_exposure() const {
    return 3 * kinds_.environment_terms + (kinds_.light ? 3 * views() + 3 : 0);
  }
  static size_t At(int view) { return static_cast<size_t>(view); }
  ViewCorrection CorrectionAt(int view, const Eigen::VectorXd& unknowns) const;
  EnvironmentLighting EnvironmentOf(const Eigen::VectorXd& unknowns) const;

  const PhotographSet& set_;
  UnknownKinds kinds_;
  std::vector<double> light_distance_mm_;
  double environment_unit_ = 0;
};

}  // namespace glint
