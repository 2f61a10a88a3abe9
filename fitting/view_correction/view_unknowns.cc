#include "fitting/view_correction/view_unknowns.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fitting/reflectance/brdf.h"

namespace glint {

ViewUnknowns::ViewUnknowns(const PhotographSet& set, bool registration)
    : set_(set), registration_(registration) {
  for (const Photograph& photograph : set.photographs) {
    const Vec3d& light = photograph.view.light_in_sample_mm;
    light_distance_mm_.push_back(std::hypot(light[0], light[1], light[2]));
    const TexelGeometry<double> centre =
        TexelGeometryInView(photograph.view, set.convention.falloff, 0.0, 0.0);
    irradiance_ += (centre.irradiance[0] + centre.irradiance[1] + centre.irradiance[2]) /
                   (3 * photograph.view.exposure * static_cast<double>(set.photographs.size()));
  }
}

Vec3d ViewUnknowns::LightDirection(int view) const {
  Vec3d direction = set_.photographs[At(view)].view.light_in_sample_mm;
  for (double& d : direction) d /= light_distance_mm(view);
  return direction;
}

Eigen::Matrix3d ViewUnknowns::LightFrame(int view) const {
  const Vec3d d = LightDirection(view);
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(),
                                            Eigen::Vector3d(d[0], d[1], d[2]))
      .toRotationMatrix();
}

double ViewUnknowns::LeastAmbient(int channel) const {
  double least = -1e9;
  for (int v = 0; v < views(); ++v) {
    const Vec3d& ambient_rgb = set_.photographs[At(v)].view.ambient_rgb;
    least = std::max(least, -ambient_rgb[static_cast<size_t>(channel)] / irradiance_);
  }
  return least;
}

View ViewUnknowns::ViewAt(int view, const Eigen::VectorXd& unknowns) const {
  View moved = set_.photographs[At(view)].view;
  for (int i = 0; i < 3; ++i) {
    const size_t k = static_cast<size_t>(i);
    moved.light_in_sample_mm[k] += unknowns[light(view) + i] * light_distance_mm(view);
    moved.ambient_rgb[k] += unknowns[ambient() + i] * irradiance_;
  }
  moved.exposure *= std::exp(unknowns[exposure(view)]);
  return moved;
}

ViewCorrection ViewUnknowns::CorrectionAt(int view, const Eigen::VectorXd& unknowns) const {
  ViewCorrection correction;
  for (int i = 0; i < 3; ++i) {
    const size_t k = static_cast<size_t>(i);
    correction.light_offset_mm[k] = unknowns[light(view) + i] * light_distance_mm(view);
    correction.ambient_rgb[k] = unknowns[ambient() + i] * irradiance_;
  }
  correction.exposure = std::exp(unknowns[exposure(view)]);
  for (int i = 0; registration_ && i < 4; ++i) {
    correction.shifts.column[i] = unknowns[shift(view) + i];
    correction.shifts.row[i] = unknowns[shift(view) + 4 + i];
  }
  return correction;
}

Eigen::VectorXd ViewUnknowns::Of(const std::vector<ViewCorrection>& corrections) const {
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(size());
  for (int v = 0; v < views(); ++v) {
    const ViewCorrection& correction = corrections[At(v)];
    for (int i = 0; i < 3; ++i) {
      const size_t k = static_cast<size_t>(i);
      unknowns[light(v) + i] = correction.light_offset_mm[k] / light_distance_mm(v);
      unknowns[ambient() + i] = correction.ambient_rgb[k] / irradiance_;
    }
    unknowns.segment<3>(shared_light()) +=
        LightFrame(v).transpose() * unknowns.segment<3>(light(v)) / views();
    unknowns[exposure(v)] = std::log(correction.exposure);
    for (int i = 0; registration_ && i < 4; ++i) {
      unknowns[shift(v) + i] = correction.shifts.column[i];
      unknowns[shift(v) + 4 + i] = correction.shifts.row[i];
    }
  }
  return unknowns;
}

}  // namespace glint
