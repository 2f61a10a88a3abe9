#include "calib/chart/chart_result.h"

#include <fmt/format.h>

namespace glint {
namespace {

std::vector<double> ListOf(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json PatchesOf(const ChartResult& result) {
  Json patches = Json::array();
  for (const PatchColour& seen : result.solution.patches) {
    const ChartPatch& patch = result.chart.patches[seen.patch];
    Json json = {{"patch", patch.name},
                 {"rgb_linear", ListOf(result.readings[seen.patch].rgb)},
                 {"reference_lab", ListOf(patch.lab)},
                 {"lab", ListOf(seen.lab)},
                 {"delta_e_uncorrected", seen.uncorrected}};
    if (!result.grey()) {
      json["delta_e"] = seen.delta_e;
      json["delta_e_held_out"] = seen.held_out;
    }
    patches.push_back(json);
  }
  return patches;
}

}  // namespace

std::string NamesOfLeftOut(const Chart& chart, const std::vector<PatchReading>& readings) {
  constexpr int kMost = 6;
  std::string text;
  int left_out = 0;
  for (size_t i = 0; i < readings.size(); ++i) {
    if (readings[i].usable() || ++left_out > kMost) continue;
    text += (text.empty() ? "" : ", ") + chart.patches[i].name;
  }
  return left_out > kMost ? text + fmt::format(" and {} more", left_out - kMost) : text;
}

Json ToJson(const ChartResult& result) {
  const ChartSolution& solution = result.solution;
  Json json = {{"photo", result.photo},
               {"kind", result.chart.kind},
               {"model", std::string(ColourModelName(solution.correction.model))},
               {"found", result.found},
               {"patches", solution.patches.size()},
               {"left_out", result.readings.size() - solution.patches.size()},
               {"white_rgb", ListOf(solution.white_rgb)},
               {"white_from", result.white_from},
               {"delta_e_uncorrected_mean", solution.UncorrectedMean()},
               {"findings", result.findings}};
  for (const Eigen::Vector2d& corner : result.corners_px) {
    json["corners_px"].push_back({corner.x(), corner.y()});
  }
  if (!result.grey()) {
    json["delta_e_mean"] = solution.MeanDeltaE();
    json["delta_e_worst"] = solution.WorstDeltaE();
    json["delta_e_held_out_mean"] = solution.HeldOutMean();
    json["delta_e_held_out_worst"] = solution.HeldOutWorst();
    json["light"] = {solution.light.a, solution.light.b, solution.light.g};
  }
  json["by_patch"] = PatchesOf(result);
  return json;
}

std::string TextOf(const ChartResult& result) {
  const ChartSolution& solution = result.solution;
  std::string text;
  if (result.grey()) {
    const Eigen::Vector3d cast = solution.white_rgb / solution.white_rgb.y();
    text = fmt::format(
        "colours: grey card in {}: R/G {:.3f}, B/G {:.3f} as stored, {:.1f} dE00 from neutral\n",
        result.photo, cast.x(), cast.z(), solution.UncorrectedMean());
  } else {
    text = fmt::format(
        "colours: {} of {} patches of {} in {}: dE00 {:.2f} (worst {:.2f}), held out {:.2f} (worst "
        "{:.2f}), uncorrected {:.2f}\n",
        solution.patches.size(), result.readings.size(), result.chart.kind, result.photo,
        solution.MeanDeltaE(), solution.WorstDeltaE(), solution.HeldOutMean(),
        solution.HeldOutWorst(), solution.UncorrectedMean());
  }
  for (const std::string& finding : result.findings) text += "  note: " + finding + "\n";
  return text;
}

}  // namespace glint
