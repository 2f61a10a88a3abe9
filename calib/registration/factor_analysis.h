// What the views' textures have in common: factor analysis.
//
// Away from its highlights a flat sample's log radiance is, in every texel, a few numbers (its
// albedo and the two slopes of its relief) that each photograph mixes in its own proportion, which
// depends on where its flash is; what a photograph has of its own, highlights above all, is noise
// of a variance of its own. So the views' values at a texel are normal with covariance Λ Λᵀ + Ψ, Ψ
// diagonal. Neither lights nor materials need be known: the proportions Λ are estimated too.
// Photographs that are out of place need more factors, and are less likely.
#pragma once

#include <Eigen/Core>

namespace glint {

struct FactorModel {
  Eigen::MatrixXd covariance;  // Λ Λᵀ + Ψ
  // −2/n · log likelihood of the views' values, each scaled to a variance of 1, up to a constant:
  // what they have in common, and not how much they show.
  double misfit = 0;
};

// The factors that so many views can tell, at most three: (views − factors)² > views + factors
// (Lawley & Maxwell 1971). 0: none.
int FactorsOf(int views);
// Of those that show any texture, more than a hundredth of the most.
int FactorsOf(const Eigen::MatrixXd& sample);

// Maximum likelihood by the principal-factor iteration (Lawley & Maxwell), in a number of steps
// that is fixed. `sample` is the covariance of the views' values; views without any are left as
// noise.
FactorModel FitFactors(const Eigen::MatrixXd& sample, int factors);

}  // namespace glint
