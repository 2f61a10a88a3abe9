#include "fitting/refine/correct_views.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fitting/refine/refine_prior.h"
#include "pipeline/contract/svbrdf_file.h"

namespace glint {
namespace {

PhotographSet AtWorkingSize(const PhotographSet& set, int working_size, int threads) {
  const int longer = std::max(set.plane.width, set.plane.height);
  if (longer <= working_size) return set;
  const double scale = static_cast<double>(working_size) / longer;
  const auto scaled = [&](int texels) {
    return std::max(1, static_cast<int>(std::lround(texels * scale)));
  };
  return Downsampled(set, scaled(set.plane.width), scaled(set.plane.height), threads);
}

}  // namespace

bool CorrectionOptions::Wanted(double distinct_views_of_set) const {
  return when == "always" || (when == "auto" && distinct_views_of_set >= distinct_views);
}

std::string CorrectionOptions::Check() const {
  if (when != "auto" && when != "always" && when != "never") {
    return "views are corrected auto, always or never";
  }
  if (!(least_gain >= 0 && least_gain < 1)) return "the least gain must be from 0 to 1";
  if (rounds < 1) return "at least one round of corrections is needed";
  if (working_size < 16) return "the working size must be at least 16 texels";
  return view.Check();
}

RefineProblem ProblemOf(const PhotographSet& set) {
  RefineProblem problem;
  problem.plane = set.plane;
  problem.convention = set.convention;
  for (const Photograph& p : set.photographs) {
    problem.views.push_back({p.view, p.ldr, p.rgb, p.mask});
  }
  return problem;
}

CorrectionResult FindCorrections(const PhotographSet& set, const SvbrdfMaps& start,
                                 const RefineOptions& refine, const CorrectionOptions& options,
                                 int threads,
                                 const std::function<void(std::int64_t, std::int64_t)>& progress) {
  const std::string wrong = options.Check();
  if (!wrong.empty()) throw std::invalid_argument("correct views: " + wrong);
  CorrectionResult result;
  if (!options.Wanted(DistinctViews(ProblemOf(set)))) return result;
  const std::int64_t steps = 2 * options.rounds - 1;  // a correction; then refinements and others
  const auto report = [&](std::int64_t done) {
    if (progress) progress(done, steps);
  };
  report(0);
  const PhotographSet small = AtWorkingSize(set, options.working_size, threads);
  const int width = small.plane.width, height = small.plane.height;
  ViewCorrectionOptions view = options.view;
  view.robust_scale = refine.robust_scale;
  const SvbrdfMaps small_start = ResampleSvbrdf(start, width, height);
  ViewCorrectionResult found = CorrectViews(small, small_start, view, threads);
  result.cost_before = found.cost_before;
  result.cost_after = found.cost_after;
  result.taken = found.gain > options.least_gain;
  if (!result.taken) {
    report(steps);
    return result;
  }
  for (int round = 1; round < options.rounds; ++round) {
    report(2 * round - 1);
    const PhotographSet corrected = Corrected(small, found.views, threads);
    const SvbrdfMaps maps = Refine(ProblemOf(corrected), small_start, refine, threads).maps;
    report(2 * round);
    found = CorrectViews(small, maps, view, threads, found.views);
    const bool settled = found.cost_after > (1 - options.least_gain) * result.cost_after;
    result.cost_after = found.cost_after;
    if (settled) break;
  }
  report(steps);
  result.corrections = AtSize(found.views, width, height, set.plane.width, set.plane.height);
  return result;
}

}  // namespace glint
