// Texels of a sample with what is known of each before refinement: all of them, consecutive rows,
// or every so many-th.
#pragma once

#include <optional>
#include <vector>

#include "fitting/refine/refine.h"
#include "fitting/refine/substances.h"

namespace glint {

class SamplePart {
 public:
  // `problem` and `initial` must outlive this, views as they are said to be. `known`: the sample's
  // substances; none: they are found among these texels, at most `most`.
  SamplePart(const RefineProblem& problem, const SvbrdfMaps& initial,
             const std::optional<Substances>& known, int most, int threads);

  const RefineProblem& problem() const { return problem_; }
  const SvbrdfMaps& initial() const { return initial_; }
  const Substances& substances() const { return substances_; }
  size_t texels() const { return initial_.texels(); }
  // Of the texel, of each substance.
  const float* shares(size_t texel) const {
    return shares_.data() + texel * static_cast<size_t>(substances_.count());
  }

 private:
  SamplePart(const RefineProblem& problem, const SvbrdfMaps& initial,
             const std::vector<float>& colour, const std::optional<Substances>& known, int most);

  const RefineProblem& problem_;
  const SvbrdfMaps& initial_;
  Substances substances_;
  std::vector<float> shares_;
};

}  // namespace glint
