#include "fitting/refine/correct_views.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/formats/svbrdf_file.h"
#include "base/resampling/resampling.h"
#include "fitting/refine/residual_model.h"

namespace glint {
namespace {

// What is corrected, and what was found of it.
struct Finding {
  ViewCorrectionOptions options;
  ViewCorrectionResult result;
};

Finding Find(const PhotographSet& set, const SvbrdfMaps& start, const CorrectionOptions& options,
             const ViewCorrectionOptions& view, int threads) {
  Finding all{view, CorrectViews(set, start, view, threads)};
  if (options.environment_terms == 0) return all;
  ViewCorrectionOptions environment_alone = view;
  environment_alone.light = environment_alone.exposure = environment_alone.registration = false;
  environment_alone.environment_terms = options.environment_terms;
  Finding environment{environment_alone, CorrectViews(set, start, environment_alone, threads)};
  const bool views_tell =
      all.result.GainOver(environment.result.cost_after) > options.least_views_gain;
  return views_tell ? all : environment;
}

}  // namespace

std::pair<int, int> CorrectionOptions::WorkingSize(const SamplePlane& plane) const {
  return SizeAtMost(plane.width, plane.height, working_size);
}

bool CorrectionOptions::Wanted(double distinct_views_of_set) const {
  return when == "always" || (when == "auto" && distinct_views_of_set >= distinct_views);
}

std::string CorrectionOptions::Check() const {
  if (when != "auto" && when != "always" && when != "never") {
    return "the correction of views must be auto, always or never";
  }
  if (!(least_gain >= 0 && least_gain < 1) || !(least_views_gain >= 0 && least_views_gain < 1)) {
    return "the least gain must be from 0 to 1";
  }
  if (rounds < 1) return "at least one round of corrections is needed";
  if (working_size < 16) return "the working size must be at least 16 texels";
  return view.Check();
}

RefineProblem ProblemOf(const PhotographSet& set) {
  RefineProblem problem;
  problem.plane = set.plane;
  problem.convention = set.convention;
  problem.environment = set.environment;
  problem.systematic_sd = set.systematic_sd;
  for (const Photograph& p : set.photographs) {
    problem.views.push_back({.view = p.view,
                             .ldr = p.ldr,
                             .rgb = p.rgb,
                             .mask = p.mask,
                             .pixels_per_texel = p.pixels_per_texel,
                             .blur_px = p.blur_px,
                             .hidden_variance = p.hidden_variance,
                             .spread_variance = p.spread_variance});
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
  const auto [width, height] = options.WorkingSize(set.plane);
  const PhotographSet small = Downsampled(set, width, height, threads);
  ViewCorrectionOptions view = options.view;
  view.robust_scale = refine.robust_scale;
  const SvbrdfMaps small_start = ResampleSvbrdf(start, width, height);
  Finding finding = Find(small, small_start, options, view, threads);
  ViewCorrectionResult& found = finding.result;
  result.cost_before = found.cost_before;
  result.cost_after = found.cost_after;
  result.taken = found.GainOver(found.cost_before) > options.least_gain;
  if (!result.taken) {
    report(steps);
    return result;
  }
  // CorrectViews() knows of no curve, nor must the maps that it begins with.
  RefineOptions straight = refine;
  straight.toe = straight.shoulder = 0;
  for (int round = 1; round < options.rounds; ++round) {
    report(2 * round - 1);
    const PhotographSet corrected = Corrected(small, found.corrections, threads);
    const SvbrdfMaps maps = Refine(ProblemOf(corrected), small_start, straight, threads).maps;
    report(2 * round);
    ViewCorrectionResult next =
        CorrectViews(small, maps, finding.options, threads, found.corrections);
    if (!(next.cost_after < result.cost_after)) break;  // maps that went astray
    const bool settled = next.cost_after > (1 - options.least_gain) * result.cost_after;
    result.cost_after = next.cost_after;
    found = std::move(next);
    if (settled) break;
  }
  report(steps);
  result.corrections = AtSize(found.corrections, width, height, set.plane.width, set.plane.height);
  return result;
}

}  // namespace glint
