// A chart in one photograph, whichever way it is turned.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "calib/chart/chart_result.h"

namespace glint {

size_t UsableCount(const std::vector<PatchReading>& readings);

class ChartReader {
 public:
  // `white_balance` is divided out of the readings. `photo` must outlive the reader.
  ChartReader(const LinearPhoto& photo, const Eigen::Vector3d& white_balance, ColourModel model)
      : photo_(photo), white_balance_(white_balance), model_(model) {}

  // Fills result->readings, from its chart and corners.
  void Measure(ChartResult* result) const;
  // Measured and solved with the corners turned by so many quarters: what was the corner number
  // `quarters` becomes the top left. nullopt: too few usable patches, or no correction fits.
  std::optional<ChartResult> TurnedBy(const ChartResult& result, size_t quarters) const;
  // The turn whose colours fit best: for corners of a pattern that looks alike in several.
  std::optional<ChartResult> BestTurn(const ChartResult& result) const;

 private:
  const LinearPhoto& photo_;
  Eigen::Vector3d white_balance_;
  ColourModel model_;
};

}  // namespace glint
