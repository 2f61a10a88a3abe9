// The stages of a capture: the one list of them. pipeline/driver/stage_graph.h makes a capture's
// steps from it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// A stage's work and memory are sums of parts (cost_model.h). Fitted to six captures of 5 to 12
// photographs of 2 and 12 megapixels at 256² to 2048², on two cores of an EPYC with AVX-512 and
// bfloat16 (docs/experiments/run-time.md).
struct StageCost {
  double start_s = 0;  // programs, weights, files
  // Per pair of photographs, whatever their size and the maps'; beyond 40 photographs no more:
  // fewer texels are then taken for them.
  double photograph_pair_s = 0;
  double network_s = 0;            // in the networks; twice as long without bfloat16
  double photograph_px_us = 0;     // per pixel of every photograph
  double texel_us = 0;             // per texel
  double photograph_texel_us = 0;  // per texel of every photograph
  double start_MB = 0;
  double photograph_MB = 0;           // per photograph, whatever its size and the maps'
  double decoded_px_bytes = 0;        // per pixel of the photographs that are decoded at once
  double texel_bytes = 0;             // per texel
  double photograph_texel_bytes = 0;  // per texel of every photograph …
  double most_MB = 0;                 // … of both at most, where texels pass by rows; 0: no bound
  // Per texel of every photograph, of 256² texels at most, as the networks see them.
  double network_texel_bytes = 0;
};

// What a stage's result is for those that read it.
enum class Gives { kCalibration, kViews, kMaps, kFiles };

// Which captures go through a stage.
enum class Runs {
  kAlways,
  kFromPhotographs,  // those that were not imported as rectified photographs
  kRefining,         // those whose run refines
  kTiling            // those with a table [tile]
};

// Maps come from the last of the stages before that gives them and runs; whole maps are those that
// no tiling stage has cut.
enum class ReadsMaps { kNone, kWhole, kAny };

// What a stage reads beside capture.toml. Of manifests, those of the last stage before that gives
// it.
struct StageReads {
  bool photographs = false;        // with a measured tone curve, if there is one
  bool board_photographs = false;  // those of the board alone too, and its description
  bool calibration = false;
  bool views = false;
  ReadsMaps maps = ReadsMaps::kNone;
  bool every_stage = false;  // all that ran before it
};

// What a stage's program is told of the choices for a run, by options of these names.
struct StageIsTold {
  bool method = false;          // --method, of fitting
  bool selected_views = false;  // --views, --exclude
  bool maps_from = false;       // --from, the stage whose maps it reads
};

// A stage's program is glint-NAME, its folder CAPTURE/glint/NAME, its options are the table [NAME]
// of capture.toml.
struct StageKind {
  std::string_view name;
  std::string_view summary;  // one line, for lists of commands
  StageCost cost;
  Runs runs = Runs::kAlways;
  StageReads reads = {};
  StageIsTold is_told = {};
  Gives gives = Gives::kFiles;
  bool by_parts = false;  // whether several jobs can share it: --part K/N, then --join N
  // The one whose result glint-import and glint-synth write: imported captures begin after it.
  bool imported = false;
};

// In the order in which they run, whether or not a capture needs them.
std::span<const StageKind> Stages();

// Null for a name that is no stage's.
const StageKind* FindStage(std::string_view name);

// The last of the stages that give views, say: what later stages read; `reader` reads what stages
// before it give. Null: none does.
const StageKind* LastGiving(Gives what, std::string_view reader = {});

// The one that is marked so.
const StageKind& ImportedStage();

// Whether it gives maps of that kind: whole ones are not those that a tiling stage gives.
bool GivesMaps(const StageKind& stage, ReadsMaps which);

// Names of the stages that do, in their order.
std::vector<std::string> StagesWithMaps(ReadsMaps which);

// Relative to the capture's folder: "glint/<stage>/manifest.json".
std::string ManifestPath(std::string_view stage);

// "calib, rectify, …", for messages.
std::string StageNamesText();

}  // namespace glint
