// How bright and of what colour the light was in each photograph of a camera that stood still.
//
// Lamps of a dome differ by tens of per cent and in colour, a lamp held by hand stands nearer or
// farther. Their directions are known, so that a matte surface tells their strengths
// (semi-calibrated photometric stereo: Cho, Matsushita, Tai, Kweon 2016): of point p, photograph v
// and channel c,
//
//   log I_vpc = log a_vc + log b_pc + log cos(n_p, l_vp) − 2 log d_vp + e_vp
//
// with strengths a, albedos b, normals n with slopes N(0, .15²) about a level surface, and e of a
// scale that is each point's own: gilding, which is no matte surface, says little. Lamps are
// medians over points, points robust least squares over lamps, in turns. The sample is level in the
// mean: lamps that are brighter to one side and a sample that is tilted look alike.
//
// What gloss adds, and what a tilt of the sample does, is smooth over the directions of light. So
// is what a dome's lamps differ by from ring to ring: the two cannot be told apart here, and what
// is smooth is taken out of the strengths. Refinement, which knows gloss, finds what was the
// lamps'.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/moving_light/lamp_problem.h"

namespace glint {

struct LampStrength {
  double exposure = 1;              // relative to the mean (of logarithms) of all
  Eigen::Vector3d colour{1, 1, 1};  // R, G, B over those of the mean lamp; their product is 1
  double used_share = 0;            // of the points that are neither clipped nor dark
};

struct LampStrengths {
  std::vector<LampStrength> lamps;
  double point_sd = 0;   // median over points of their scale of e
  double colour_sd = 0;  // of lamps' colours about their mean, log, after what gloss feigns
};

// The same for any number of threads. Of fewer than three photographs all are 1. Throws
// std::invalid_argument: numbers that do not fit.
LampStrengths EstimateLampStrengths(const LampProblem& problem, int threads);

}  // namespace glint
