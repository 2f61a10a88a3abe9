// Texels of a sample with what is known of each before refinement: all of them, consecutive rows,
// or every so many-th.
#pragma once

#include <optional>
#include <vector>

#include "fitting/refine/refine.h"
#include "fitting/refine/sample_look.h"
#include "fitting/refine/substances.h"

namespace glint {

// What a sample is made of, and what of.
struct SampleSubstances {
  SampleLook look;
  Substances substances;
};

class SamplePart {
 public:
  // `problem` and `initial` must outlive this, views as they are said to be. `known`: the sample's
  // substances; none: they are found among these texels, at most `most`.
  SamplePart(const RefineProblem& problem, const SvbrdfMaps& initial,
             const std::optional<SampleSubstances>& known, int most, int threads);

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
  struct Found {
    SampleSubstances known;
    std::vector<float> shares;
  };
  static Found Find(const RefineProblem& problem, const SvbrdfMaps& initial,
                    const std::optional<SampleSubstances>& known, int most, int threads);
  SamplePart(const RefineProblem& problem, const SvbrdfMaps& initial, Found found);

  const RefineProblem& problem_;
  const SvbrdfMaps& initial_;
  SampleSubstances known_;
  std::vector<float> shares_;
};

}  // namespace glint
