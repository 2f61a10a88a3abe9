// Finds what is wrong with the views before they are refined from: whether to look, at which size,
// and whether what was found is worth taking.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/model/view_correction.h"
#include "fitting/photographs/photographs.h"
#include "fitting/refine/refine.h"
#include "fitting/view_correction/view_correction.h"

namespace glint {

struct CorrectionOptions {
  std::string when = "auto";  // auto: with views enough; always; never
  // Of the set (residual_model.h), from which on "auto" looks.
  double distinct_views = constants::kLeastDistinctViews;
  // ViewCorrectionResult::GainOver() up to which nothing is taken: views that are right stay
  // untouched.
  double least_gain = constants::kLeastGain;
  // Terms of environment lighting where that is all that is corrected: polished samples mirror it.
  int environment_terms = kEnvironmentTerms;
  // Lights, exposures and registration are corrected only where that explains so much more than
  // environment lighting alone does: what remains of it is a little like lights that are off.
  double least_views_gain = constants::kLeastViewsGain;
  // Corrections and refinements in turn, at most: texels in wrong minima keep views from their
  // correct values, and leave these minima once they are refined with views that are nearly right.
  int rounds = constants::kCorrectionRounds;
  // Texels along the longer side; larger sets are averaged down.
  int working_size = constants::kCorrectionSize_texel;
  ViewCorrectionOptions view;

  bool Wanted(double distinct_views_of_set) const;
  // Width and height that corrections are found at.
  std::pair<int, int> WorkingSize(const SamplePlane& plane) const;
  // Empty: all is well; otherwise what is wrong.
  std::string Check() const;
};

struct CorrectionResult {
  bool taken = false;
  double cost_before = 0, cost_after = 0;  // 0: not looked
  ViewCorrections corrections;             // at the photographs' size; no views: not taken
};

// The problem that Refine() solves for these photographs; its spans are of `set`.
RefineProblem ProblemOf(const PhotographSet& set);

// `start` has the set's size. `progress` (may be empty) is called with the steps done and all steps
// there can be. Throws as Refine() and CorrectViews() do.
CorrectionResult FindCorrections(
    const PhotographSet& set, const SvbrdfMaps& start, const RefineOptions& refine,
    const CorrectionOptions& options, int threads,
    const std::function<void(std::int64_t done, std::int64_t total)>& progress = {});

}  // namespace glint
