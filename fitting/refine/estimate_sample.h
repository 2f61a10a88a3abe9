// What refinement finds out about a sample as a whole before it solves for texels: docs/model.md.
#pragma once

#include <vector>

#include "fitting/refine/refine.h"
#include "fitting/refine/sample_model.h"

namespace glint {

struct SampleEstimate {
  // The views' places in the problem, in an order that does not depend on how they were given: the
  // same sums whatever the order of the photographs. What follows is in this order.
  std::vector<int> order;
  std::vector<View> said, found;  // views as said, and with their deviations
  SampleSubstances substances;
  SampleModel model;      // to be put On() a part
  RefineSummary summary;  // what it says of the whole sample

  // The problem with its views in this order, as they are said to be, and the sample's lobes.
  RefineProblem InOrder(RefineProblem problem) const;
};

// `problem` and `start`: texels that stand for the sample. They need not outlive the call.
SampleEstimate EstimateSample(const RefineProblem& problem, const SvbrdfMaps& start,
                              const RefineOptions& options, int threads);

// Stride at which texels stand for the sample: all of them (1) up to `size` along the longer side.
// Odd, so that there is a middle of each stride × stride.
int EstimationStride(const SamplePlane& plane, int size);

}  // namespace glint
