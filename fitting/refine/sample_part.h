// Texels of a sample with what is known of each before refinement: all of them, consecutive rows,
// or every so many-th.
#pragma once

#include <vector>

#include "fitting/refine/refine.h"
#include "fitting/refine/sample_look.h"
#include "fitting/refine/substances.h"

namespace glint {

// What a sample is made of, and by what that is told of a texel.
struct SampleSubstances {
  SampleLook look;
  Substances substances;
};

// What the problem's texels are told apart by; views nominal. `with_gloss` false: by colour alone.
TexelLooks LooksOf(const RefineProblem& problem, const SvbrdfMaps& initial, const SampleLook& look,
                   bool with_gloss, int threads);

class SamplePart {
 public:
  // `problem` and `initial` must outlive this. `looks`: of LooksOf().
  SamplePart(const RefineProblem& problem, const SvbrdfMaps& initial, SampleSubstances known,
             const TexelLooks& looks, int threads);
  SamplePart(const RefineProblem& problem, const SvbrdfMaps& initial, const SampleSubstances& known,
             int threads);

  const RefineProblem& problem() const { return problem_; }
  const SvbrdfMaps& initial() const { return initial_; }
  const SampleSubstances& known() const { return known_; }
  const Substances& substances() const { return known_.substances; }
  size_t texels() const { return initial_.texels(); }
  // Of the texel, of each substance.
  const float* shares(size_t texel) const {
    return shares_.data() + texel * static_cast<size_t>(substances().count());
  }

 private:
  const RefineProblem& problem_;
  const SvbrdfMaps& initial_;
  SampleSubstances known_;
  std::vector<float> shares_;
};

}  // namespace glint
