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

void AddCorrections(const std::vector<ViewCorrection>& more, std::vector<ViewCorrection>* total) {
  for (size_t i = 0; i < more.size(); ++i) {
    ViewCorrection& sum = (*total)[i];
    for (size_t k = 0; k < 3; ++k) {
      sum.light_offset_mm[k] += more[i].light_offset_mm[k];
      sum.ambient_rgb[k] += more[i].ambient_rgb[k];
    }
    sum.exposure *= more[i].exposure;
    for (int k = 0; k < 4; ++k) {
      sum.shifts.column[k] += more[i].shifts.column[k];
      sum.shifts.row[k] += more[i].shifts.row[k];
    }
  }
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
                                 int threads) {
  const std::string wrong = options.Check();
  if (!wrong.empty()) throw std::invalid_argument("correct views: " + wrong);
  CorrectionResult result;
  if (!options.Wanted(DistinctViews(ProblemOf(set)))) return result;
  const PhotographSet small = AtWorkingSize(set, options.working_size, threads);
  const int width = small.plane.width, height = small.plane.height;
  const SvbrdfMaps small_start = ResampleSvbrdf(start, width, height);
  std::vector<ViewCorrection> total(small.photographs.size());
  PhotographSet corrected = small;
  ViewCorrectionOptions view = options.view;
  for (int round = 0; round < options.rounds; ++round) {
    const SvbrdfMaps maps = Refine(ProblemOf(corrected), small_start, refine, threads).maps;
    const ViewCorrectionResult found = CorrectViews(corrected, maps, view);
    if (round == 0) result.cost_before = result.cost_after = found.cost_before;
    // What the round before settled on, with maps of its own.
    if (round > 0) result.cost_after = std::min(result.cost_after, found.cost_before);
    if (!(found.cost_after < (1 - options.further_gain) * result.cost_after)) break;
    result.cost_after = found.cost_after;
    AddCorrections(found.views, &total);
    corrected = Corrected(small, total, threads);
    if (found.residual_rms < 1) view.evidence = options.settled_evidence;
  }
  result.taken = result.cost_after < (1 - options.least_gain) * result.cost_before;
  if (result.taken) {
    result.corrections = AtSize(total, width, height, set.plane.width, set.plane.height);
  }
  return result;
}

}  // namespace glint
