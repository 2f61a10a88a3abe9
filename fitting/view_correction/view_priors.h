// The Gaussian priors of the views' errors, as residuals.
#pragma once

#include <vector>

#include "fitting/view_correction/normal_equations.h"
#include "fitting/view_correction/view_unknowns.h"

namespace glint {

class ViewPriors {
 public:
  // `usable`: per view, whether it shows anything; the others have no prior of their own.
  ViewPriors(const ViewUnknowns& unknowns, const ViewExpectations& expected,
             const std::vector<bool>& usable);

  // Half the sum of squares; added to `equations` unless they are null.
  double Add(const Eigen::VectorXd& x, NormalEquations* equations) const;

  // The expectations with the lights' own offsets as large as those found at `x`, if that is more:
  // lights that are all far off are no surprise for each of them. Never less than `least`.
  ViewExpectations Learned(const Eigen::VectorXd& x, const ViewExpectations& least) const;

 private:
  double AddLight(int view, const Eigen::VectorXd& x, NormalEquations* equations) const;

  const ViewUnknowns& unknowns_;
  ViewExpectations expected_;
  std::vector<bool> usable_;
};

}  // namespace glint
