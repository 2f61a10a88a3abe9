// Stage "refine" of a capture: maps of fit and rectified views in, svbrdf.exr and confidence.exr
// out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/model/photographs.h"
#include "base/model/substances.h"
#include "base/model/uncalibrated_light.h"
#include "base/programs/stage.h"
#include "fitting/refine/correct_views.h"
#include "fitting/refine/refine.h"
#include "fitting/refine/row_parts.h"

namespace glint {

// Raised whenever the same inputs give other bytes.
inline constexpr int kRefineVersion = 48;

struct RefineStageOptions {
  RefineOptions refine;
  CorrectionOptions correction;
  // RefineOptions::flash_offset of sets whose light was not calibrated (of unknown power): phones'
  // flashes are 1 to 3 cm beside the lens, 20 to 40 cm away.
  double flash_offset = constants::kFlashOffsetSd;
  // Of the same sets, RefineOptions::exposure_spread and light_spread.
  double exposure_spread = constants::kExposureSd;
  double light_spread = constants::kLightPlaceSd;
  // Likewise RefineOptions::residual_sigma: what fourteen such samples were found to have.
  double residual_sigma = constants::kUncalibratedResidualSigma;
  // RefineOptions::lamp_gradient for a fixed camera: a dome half as bright on one side as on the
  // other; and level_spread: a degree, as panels lie in a dome or stand before a camera.
  double lamp_gradient = constants::kLampGradientSd;
  double level_spread = constants::kLampLevelSd;
  double flash_beam = constants::kFlashBeamSd;
  double distance_power = constants::kDistancePowerSd;
  double toe = constants::kToeSd, shoulder = constants::kShoulderSd;
  // Likewise KindsPriorOptions::light_power_spread: estimators find it within a half.
  double light_power_spread = constants::kUncalibratedLightPowerSd;
  int rows_at_once = 0;              // in memory; 0: as memory allows; never changes a value
  std::string part;                  // "K/N": that part alone; empty: all rows
  int join = 0;                      // this many parts; 0: refine
  std::vector<std::string> views;    // names of those to use; empty: those that fit used
  std::vector<std::string> exclude;  // names of those held out
  std::filesystem::path from;        // maps to start from (svbrdf.exr); empty: the result of fit
};

void AddRefineOptions(OptionSet* set, RefineStageOptions* options);

// What the stage starts from: file, light scale and the views that were used.
struct RefineStart {
  std::filesystem::path maps_file;
  std::filesystem::path deviations_file;  // of those maps; empty: not stated
  std::filesystem::path manifest_file;    // of fit; empty with `from`
  Vec3d light_scale_rgb{1, 1, 1};
  std::vector<std::string> views;
  std::string metals = "rare";  // FitStageOptions::metals
};

// Throws UserError (no result of fit, a damaged manifest, wrong options).
RefineStart ResolveRefineStart(const std::filesystem::path& work,
                               const RefineStageOptions& options);

struct RefineStageResult {
  Json data, metrics;
  RefineSummary summary;
  CorrectionResult correction;
  std::vector<std::string> views;
  int width = 0, height = 0;
  double seconds = 0;  // of corrections and refinement; for a person only
};

// Reads, refines, writes the stage's outputs and commits them. `parts`: folders of the results of
// all parts, to be joined instead of refining; none: it refines.
RefineStageResult RunRefineStage(const std::filesystem::path& rectify_manifest,
                                 const RefineStart& start, const RefineStageOptions& options,
                                 const std::vector<std::filesystem::path>& parts, int threads,
                                 Stage* stage);

struct RowRange {
  int first = 0, rows = 0, of = 0;
};

// One part (row_parts.h), as a result of its own: its rows of svbrdf.exr and confidence.exr, and
// sums.json. Throws UserError: more parts than rows.
RowRange RunRefinePart(const std::filesystem::path& rectify_manifest, const RefineStart& start,
                       const RefineStageOptions& options, const RowPart& part, int threads,
                       Stage* stage);

}  // namespace glint
