// Synthetic phone captures whose light glint-calib finds from the board, against their truth.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/evaluation/light_error.h"
#include "datasets/evaluation/map_error.h"
#include "datasets/synth/capture_writer.h"

namespace glint {

struct LightExperimentOptions {
  std::filesystem::path work;  // DIR/seed_000/capture, DIR/seed_000/light.json …
  int seeds = 20, first_seed = 0;
  int map_seeds = 0;     // of these also maps, by the light of the board and by the paper's
  int resolution = 128;  // texels a side of the material and of the maps
  std::vector<std::string> fit_arguments, refine_arguments;
  SyntheticCaptureOptions capture;  // `plan.seed` is set per capture
  bool again = false;               // compute results that are there already
};

// A phone's capture: 3 MP, vignetting 30 %, flash 15 mm beside the lens, exposures ±1 EV, EXIF off
// by 3 %, ambient light 3 %, noise, JPEG of quality 92, capture.toml silent about the flash.
SyntheticCaptureOptions PhoneCapture();

struct LightSeedResult {
  int seed = 0;
  LightErrors light;
  bool has_maps = false;
  Table1Row board, camera;  // maps with --light board, and with --light camera
};

struct LightExperimentResult {
  std::vector<LightSeedResult> seeds;
  std::string Text() const;  // Markdown tables
  std::string Csv() const;
  Json ToJson() const;
};

// Runs glint-calib (and rectify, fit and refine for maps) beside the running program. A seed whose
// light.json is there is read and not computed again.
LightExperimentResult RunLightExperiment(const LightExperimentOptions& options, int threads);

}  // namespace glint
