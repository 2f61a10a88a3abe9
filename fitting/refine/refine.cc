#include "fitting/refine/refine.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "base/resampling/resampling.h"
#include "fitting/refine/estimate_sample.h"
#include "fitting/refine/refine_rows.h"

namespace glint {
namespace {

void CheckProblem(const RefineProblem& problem, const SvbrdfMaps& start) {
  const SamplePlane& plane = problem.plane;
  const size_t texels = static_cast<size_t>(plane.width) * plane.height;
  if (problem.views.empty()) throw std::invalid_argument("refine: no photographs");
  if (start.width != plane.width || start.height != plane.height) {
    throw std::invalid_argument("refine: the start's size is not the photographs'");
  }
  if (!problem.initial_sd.empty() && problem.initial_sd.size() != kDeviationPlanes * texels) {
    throw std::invalid_argument("refine: the start's deviations are not of the plane's size");
  }
  for (const RefineView& view : problem.views) {
    if (view.rgb.size() != 3 * texels || view.mask.size() != texels) {
      throw std::invalid_argument("refine: a photograph's size is not the plane's");
    }
  }
  const auto finite = [](float x) { return std::isfinite(x); };
  if (!std::all_of(start.planes.begin(), start.planes.end(), finite)) {
    throw std::invalid_argument("refine: the start has values that are not finite");
  }
}

// Every stride-th texel of a problem, and what its spans show.
struct PickedProblem {
  PickedProblem(const RefineProblem& from, const SvbrdfMaps& from_start, int stride)
      : problem(from) {
    const auto pick = [&](std::span<const float> planes) {
      return PickEvery(planes, from.plane.width, from.plane.height, stride);
    };
    problem.plane = from.plane.Every(stride);
    start = SvbrdfMaps(problem.plane.width, problem.plane.height);
    start.planes = pick(from_start.planes);
    values.reserve(2 * from.views.size() + 1);
    if (!from.initial_sd.empty()) problem.initial_sd = values.emplace_back(pick(from.initial_sd));
    for (RefineView& view : problem.views) {
      view.rgb = values.emplace_back(pick(view.rgb));
      view.mask = values.emplace_back(pick(view.mask));
    }
  }
  RefineProblem problem;
  SvbrdfMaps start;
  std::vector<std::vector<float>> values;
};

SampleEstimate EstimateFrom(const RefineProblem& problem, const SvbrdfMaps& start,
                            const RefineOptions& options, int threads) {
  const int stride = EstimationStride(problem.plane, options.estimation_size);
  if (stride == 1) return EstimateSample(problem, start, options, threads);
  const PickedProblem picked(problem, start, stride);
  return EstimateSample(picked.problem, picked.start, options, threads);
}

}  // namespace

std::string RefineOptions::Check() const {
  if (iterations < 1) return "iterations must be at least 1";
  if (starts < 1) return "starts must be at least 1";
  if (substances < 1 || substances > kMostSubstances) return "substances must be from 1 to 8";
  if (estimation_size < 16) return "the estimation size must be at least 16 texels";
  if (estimation_rounds < 0) return "estimation rounds must be at least 0";
  if (neighbour_passes < 0) return "neighbour passes must be at least 0";
  if (!(flash_offset >= 0.0)) return "the expected flash offset must be at least 0";
  if (!(flash_beam >= 0.0)) return "the expected gradient of the flash's beam must be at least 0";
  if (!(kinds.light_power_spread > 0.0)) return "the spread of the light's power must be above 0";
  if (!(kinds.metal_share > 0.0 && kinds.metal_share < 1.0)) {
    return "the share of metals must be between 0 and 1";
  }
  if (!(distance_power >= 0.0)) return "the expected power of distance must be at least 0";
  if (!(toe >= 0.0)) return "the expected toe must be at least 0";
  if (!(shoulder >= 0.0)) return "the expected shoulder must be at least 0";
  if (!(exposure_spread >= 0.0)) return "the expected exposure spread must be at least 0";
  if (!(residual_sigma > 0.0)) return "the expected scale of residuals must be above 0";
  if (!(light_spread >= 0.0)) return "the expected light spread must be at least 0";
  if (!(point_spread_px >= 0.0)) return "the point spread must be at least 0";
  if (!(prior >= 0.0)) return "the prior's weight must be at least 0";
  if (!(robust_scale > 0.0)) return "the robust scale must be above 0";
  return "";
}

std::string RefineSummary::BriefReport() const {
  std::ostringstream text;
  text.precision(3);
  text << "cost " << start_cost << " -> " << final_cost << " per texel, residuals "
       << 100 * residual_sigma << " % (model discrepancy " << 100 * discrepancy << " %), "
       << effective_views << " effective views, ";
  if (std::isfinite(normal_spread)) {  // more than one photograph
    text << substances << " substances (roughness spread " << roughness_spread
         << "), normals scatter " << normal_spread * 180 / M_PI << " deg, ";
  }
  if (lobes.two()) {
    text << "a second specular lobe (share " << lobes.narrow_share << ", " << lobes.narrow_ratio
         << " times as rough as the other" << (lobes.coat_f0 > 0 ? ", a coat's" : "") << "), ";
  }
  if (lobes.tail_exponent > 2) {
    text << "lobes with tails shorter than GGX's (exponent " << lobes.tail_exponent << "), ";
  }
  if (lobes.anisotropy.any()) {
    text << "lobes " << lobes.anisotropy.ratio << " times as wide at "
         << lobes.anisotropy.direction_deg << " deg as across, ";
  }
  if (!curve.straight()) {
    text << "the photographs' tone curve has a toe of " << curve.toe << " and a shoulder of "
         << curve.shoulder << ", ";
  }
  if (exposure_spread > 0) text << "exposures scatter " << 100 * exposure_spread << " %, ";
  text << 100.0 * converged << " % converged";
  return text.str();
}

RefineResult Refine(const RefineProblem& problem, const SvbrdfMaps& start,
                    const RefineOptions& options, int threads,
                    const std::function<void(std::int64_t, std::int64_t)>& progress) {
  const std::string wrong = options.Check();
  if (!wrong.empty()) throw std::invalid_argument("refine: " + wrong);
  CheckProblem(problem, start);
  const SampleEstimate estimate = EstimateFrom(problem, start, options, std::max(threads, 1));
  RowRefiner refiner(estimate, options, problem, {0, start.height}, {}, threads, progress);
  std::optional<RowRefiner::Rows> rows;
  refiner.Take(problem, start, 0, 0);
  for (int step = 0; step < refiner.steps(); ++step) rows = refiner.Do(step);
  return {std::move(rows->maps), std::move(rows->confidence),
          Summarise(estimate, refiner.sums(), start.width)};
}

}  // namespace glint
