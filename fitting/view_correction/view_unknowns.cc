#include "fitting/view_correction/view_unknowns.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/reflectance/brdf.h"

namespace glint {
namespace {}  // namespace

ViewUnknowns::ViewUnknowns(const PhotographSet& set, const UnknownKinds& kinds)
    : set_(set), kinds_(kinds) {
  for (const Photograph& photograph : set.photographs) {
    const Vec3d& light = photograph.view.light_in_sample_mm;
    light_distance_mm_.push_back(std::hypot(light[0], light[1], light[2]));
    const TexelGeometry<double> centre =
        TexelGeometryInView(photograph.view, set.convention.falloff, 0.0, 0.0);
    environment_unit_ += (centre.irradiance[0] + centre.irradiance[1] + centre.irradiance[2]) /
                         (3 * std::numbers::pi * photograph.view.exposure *
                          static_cast<double>(set.photographs.size()));
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

double ViewUnknowns::LeastEnvironment(int channel) const {
  const size_t c = static_cast<size_t>(channel);
  const double even = set_.environment.any() ? set_.environment.radiance_rgb[0][c] : 0;
  double least = -1e9;
  for (int v = 0; v < views(); ++v) {
    const Vec3d& ambient_rgb = set_.photographs[At(v)].view.ambient_rgb;
    least = std::max(least, -(ambient_rgb[c] / std::numbers::pi + even) / environment_unit_);
  }
  return least;
}

View ViewUnknowns::ViewAt(int view, const Eigen::VectorXd& unknowns) const {
  return CorrectedView(set_.photographs[At(view)].view, CorrectionAt(view, unknowns));
}

ViewCorrection ViewUnknowns::CorrectionAt(int view, const Eigen::VectorXd& unknowns) const {
  ViewCorrection correction;
  for (int i = 0; kinds_.light && i < 3; ++i) {
    correction.light_offset_mm[At(i)] = unknowns[light(view) + i] * light_distance_mm(view);
  }
  if (kinds_.exposure) correction.exposure = std::exp(unknowns[exposure(view)]);
  for (int i = 0; kinds_.registration && i < 4; ++i) {
    correction.shifts.column[i] = unknowns[shift(view) + i];
    correction.shifts.row[i] = unknowns[shift(view) + 4 + i];
  }
  return correction;
}

EnvironmentLighting ViewUnknowns::EnvironmentOf(const Eigen::VectorXd& unknowns) const {
  EnvironmentLighting light;
  light.radiance_rgb.resize(At(kinds_.environment_terms));
  for (int j = 0; j < kinds_.environment_terms; ++j) {
    for (int c = 0; c < 3; ++c) {
      light.radiance_rgb[At(j)][At(c)] = unknowns[environment(c) + j] * environment_unit_;
    }
  }
  return light;
}

EnvironmentLighting ViewUnknowns::EnvironmentAt(const Eigen::VectorXd& unknowns) const {
  EnvironmentLighting light = set_.environment;
  light.Add(EnvironmentOf(unknowns));
  return light;
}

ViewCorrections ViewUnknowns::CorrectionsAt(const Eigen::VectorXd& unknowns) const {
  ViewCorrections corrections;
  for (int v = 0; v < views(); ++v) corrections.views.push_back(CorrectionAt(v, unknowns));
  corrections.environment = EnvironmentOf(unknowns);
  return corrections;
}

Eigen::VectorXd ViewUnknowns::Of(const ViewCorrections& corrections) const {
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(size());
  for (int j = 0; j < std::min(kinds_.environment_terms, corrections.environment.terms()); ++j) {
    for (int c = 0; c < 3; ++c) {
      unknowns[environment(c) + j] =
          corrections.environment.radiance_rgb[At(j)][At(c)] / environment_unit_;
    }
  }
  for (int v = 0; v < views(); ++v) {
    const ViewCorrection& correction = corrections.views[At(v)];
    for (int i = 0; kinds_.light && i < 3; ++i) {
      unknowns[light(v) + i] = correction.light_offset_mm[At(i)] / light_distance_mm(v);
    }
    if (kinds_.light) {
      unknowns.segment<3>(shared_light()) +=
          LightFrame(v).transpose() * unknowns.segment<3>(light(v)) / views();
    }
    if (kinds_.exposure) unknowns[exposure(v)] = std::log(correction.exposure);
    for (int i = 0; kinds_.registration && i < 4; ++i) {
      unknowns[shift(v) + i] = correction.shifts.column[i];
      unknowns[shift(v) + 4 + i] = correction.shifts.row[i];
    }
  }
  return unknowns;
}

}  // namespace glint
