#include "calib/chart/read_chart.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "base/errors/errors.h"

namespace glint {

size_t UsableCount(const std::vector<PatchReading>& readings) {
  return static_cast<size_t>(std::count_if(readings.begin(), readings.end(),
                                           [](const PatchReading& r) { return r.usable(); }));
}

void ChartReader::Measure(ChartResult* result) const {
  result->readings = MeasureChart(photo_, result->chart, result->corners_px);
  for (PatchReading& reading : result->readings) {
    reading.rgb = reading.rgb.cwiseQuotient(white_balance_);
  }
}

std::optional<ChartResult> ChartReader::TurnedBy(const ChartResult& result, size_t quarters) const {
  ChartResult turned = result;
  for (size_t i = 0; i < 4; ++i) turned.corners_px[i] = result.corners_px[(i + quarters) % 4];
  Measure(&turned);
  if (UsableCount(turned.readings) < static_cast<size_t>(FewestPatches(model_))) {
    return std::nullopt;
  }
  try {
    turned.solution = SolveChart(turned.chart, turned.readings, model_);
  } catch (const ComputationError& error) {
    spdlog::debug("{}: turned by {} quarters: {}", result.photo, quarters, error.what());
    return std::nullopt;
  }
  return turned;
}

std::optional<ChartResult> ChartReader::BestTurn(const ChartResult& result) const {
  std::optional<ChartResult> best;
  for (size_t quarters = 0; quarters < 4; ++quarters) {
    auto turned = TurnedBy(result, quarters);
    if (!turned) continue;
    if (best && turned->solution.MeanDeltaE() >= best->solution.MeanDeltaE()) continue;
    best = std::move(turned);
  }
  return best;
}

}  // namespace glint
