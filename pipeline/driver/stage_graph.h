// Which stages a capture goes through, what each reads, and with which options it runs, by the list
// of base/stages/stages.cc.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "base/formats/capture.h"
#include "base/stages/stages.h"

namespace glint {

// What a person chose for the whole run; capture.toml's tables hold everything else.
struct RunChoices {
  // "refined": latent fit, then refinement per texel; "latent", "classic", "initial": the fit
  // alone, with that method; "": as "refined", but the fit's method is left to capture.toml.
  std::string method;
  std::vector<std::string> exclude;  // photographs held out from fit and refine
  std::vector<std::string> views;    // the only photographs fit and refine see; empty: all
  std::uint64_t seed = 0;

  bool refines() const { return method.empty() || method == "refined"; }
};

Json ToJson(const RunChoices& choices);
RunChoices RunChoicesFromJson(const Json& json);

// One stage of a capture. Paths are relative to the capture's folder.
struct StageStep {
  std::string stage;                   // "fit"; its program is glint-fit
  std::vector<std::string> arguments;  // after the capture's folder
  std::vector<std::string> kept;       // further ones, see kept_options.h
  std::vector<std::string> inputs;     // files; those of earlier stages are their manifests
  std::vector<std::string> waits_for;  // stages among the steps whose manifests are inputs
  std::string manifest;                // "glint/fit/manifest.json"
  std::string cost;                    // what it costs, by the names of cost_model.h
};

// "calib", "rectify", … in order, whether or not a capture needs them.
const std::vector<std::string>& StageNames();

// Those of `stages` that `capture` goes through, in an order in which they can run. A capture
// without a board was imported: it starts after ImportedStage(), from the rectified set that is
// already there. Throws UserError when the capture has a board and no photographs.
std::vector<StageStep> StageSteps(const Capture& capture, const RunChoices& choices,
                                  std::span<const StageKind> stages = Stages());

// The steps from `from` to `until` ("": first, last). Throws UserError for a stage that is unknown
// or not among the steps, and for an empty range.
std::vector<StageStep> SelectSteps(const std::vector<StageStep>& steps, const std::string& from,
                                   const std::string& until);

}  // namespace glint
