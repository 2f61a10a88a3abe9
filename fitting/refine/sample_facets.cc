// What of texels' normals no height field has.
#include <algorithm>
#include <map>

#include "base/model/substances.h"
#include "fitting/refine/sample_model.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

// Once round four texels by the trapezoidal rule, y up: 0 on a height field (nearly, where waves
// are as short as two texels). Errors of a texel's
// slopes, independent and of variance v, give it the variance 2v.
double AroundFour(const TexelValues& top_left, const TexelValues& top_right,
                  const TexelValues& bottom_left, const TexelValues& bottom_right) {
  const double across = top_left[kSlopeX] + top_right[kSlopeX] -  //
                        bottom_left[kSlopeX] - bottom_right[kSlopeX];
  const double down = top_left[kSlopeY] + bottom_left[kSlopeY] -  //
                      top_right[kSlopeY] - bottom_right[kSlopeY];
  return 0.5 * (across + down);
}

}  // namespace

// The curl of texels solved by themselves, beyond what their errors explain. Of a large sample one
// texel in several is at hand, whose slopes have curl whatever they are: 0.
void SampleModel::MeasureFacets(Sampling blocks) {
  if (part_->problem().plane.whole.stride > 1) return;
  Solve({.views = all_views_}, &blocks);
  std::map<size_t, const SampledTexel*> seen;
  double errors = 0;
  const double variance = residuals_.scale() * residuals_.scale();
  for (size_t k = 0; k < blocks.texels.size(); ++k) {
    const SampledTexel& solved = blocks.solved[k];
    if (solved.views == 0) continue;
    seen[blocks.texels[k]] = &solved;
    for (const int axis : {kSlopeX, kSlopeY}) {
      errors += 0.5 * variance * solved.inverse[static_cast<size_t>(axis * (kTexelParameters + 1))];
    }
  }
  const auto width = static_cast<size_t>(part_->initial().width);
  double squares = 0, loops = 0;
  for (const auto& [texel, solved] : seen) {
    if ((texel + 1) % width == 0) continue;
    const auto right = seen.find(texel + 1), below = seen.find(texel + width),
               diagonal = seen.find(texel + width + 1);
    if (right == seen.end() || below == seen.end() || diagonal == seen.end()) continue;
    const double around = AroundFour(solved->values, right->second->values, below->second->values,
                                     diagonal->second->values);
    squares += around * around;
    loops += 1;
  }
  if (loops == 0) return;
  const double curl = 0.5 * squares / loops;
  const double explained = constants::kErrorsOverStated * constants::kErrorsOverStated * errors /
                           static_cast<double>(seen.size());
  facet_variance_ = std::max(curl - explained, 0.0);
}

}  // namespace glint
