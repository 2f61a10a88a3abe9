// What physics knows of substances' specular albedos: each is a dielectric or a metal
// (base/reflectance/material_kinds.h, docs/model.md "What is known of a texel beforehand").
//
// Which of the two a substance is follows from its specular albedo and from its channels'
// departures from their mean: a dielectric's highlight has no colour. Where the light's power is
// known within a factor only, all substances of a sample are off by that factor together.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/model/substances.h"
#include "base/reflectance/material_kinds.h"

namespace glint {

// A substance's specular albedo by channel.
using SpecularMean = Eigen::Vector3d;

struct KindsPriorOptions {
  double light_power_spread = constants::kLightPowerSd;  // standard deviation of its logarithm, > 0
  double metal_share = MetalShareOf("rare");  // prior share of metals among substances, 0 to 1
};

// A Gaussian in place of the prior near some means: what a Newton step on them adds. Values in the
// order of substances and channels.
struct KindsPrior {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;  // of the log prior
  double log_power = 0;      // of the light, most probable: what all substances are off by
  double metal_share = 0;    // of substances, as probably as they are metals
};

// Expectation maximisation of which kind each substance is and of the light's power, which is then
// integrated out.
KindsPrior PriorOfKinds(const std::vector<SpecularMean>& means, const KindsPriorOptions& options);

}  // namespace glint
