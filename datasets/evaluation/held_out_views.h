// How well maps predict photographs that they were not fitted to: the experiment behind
// `glint-eval holdout`. Photographs are left out, the programs fit the others, and both kinds of
// views are rendered and compared with their photographs.
//
// On disk, below `work`:
//   SET/capture/                   the imported set
//   SET/SPLIT/METHOD/              a capture of its own, its rectified views hard links
//   SET/SPLIT/METHOD.log           what the programs said
// and where a size is given all of these below SET/size_N.
// Every run asks the programs again; they keep what is up to date, so an interrupted experiment
// goes on where it was.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "base/programs/program.h"
#include "datasets/looks/looks.h"

namespace glint {

// Which photographs are held out.
struct HoldoutSplit {
  std::string name;                 // "02,06 held out", "00 fitted"
  std::string folder;               // "out_02_06", "only_00"
  std::vector<std::string> listed;  // numbers from 0 on in the set's order, or names
  bool fitted = false;              // `listed` are fitted and all others held out
};

// "2,6;7,8" as splits; `fitted`: what is listed is fitted. Throws UserError.
std::vector<HoldoutSplit> ParseSplits(const std::string& text, bool fitted);

// A build of the programs to compare with: its results are methods of their own, "NAME:refined".
struct ProgramFolder {
  std::string name;  // empty: the programs beside glint-eval
  std::filesystem::path folder;
};

struct HoldoutExperiment {
  // Sets that glint-import reads, or captures with rectified views.
  std::vector<std::filesystem::path> sets;
  std::vector<HoldoutSplit> splits;
  std::vector<std::string> methods;  // of start, classic, latent, refined
  std::vector<ProgramFolder> programs;
  std::vector<std::string> import_arguments, fit_arguments, refine_arguments;
  std::filesystem::path work;
  int size = 0;  // texels across at which sets are imported; 0: as the images are
};

// Means over views, each view's over its usable texels.
struct HoldoutFigures {
  double log_l1 = 0, mse = 0;
  // RMS of residuals in log radiance over their predicted standard deviation
  // (predicted_deviation.h); below 0: the method states none.
  double standardised = -1;
  Looks looks;
};

struct HoldoutEntry {
  std::string set, split, method;
  int fitted_views = 0, held_out_views = 0;
  HoldoutFigures fitted, held_out;
  std::vector<std::string> held_out_names;
  std::filesystem::path manifest, views;  // of the maps and of the rectified views; empty: theirs
};

struct HoldoutResult {
  std::vector<HoldoutEntry> entries;  // by set, split and method

  // Averaged over the sets: set "mean".
  std::vector<HoldoutEntry> Means() const;
  // One line a set and split: held-out log-L1 of every method, and of the last one also the fitted
  // views'. Below it how held-out renderings of the last method look, and in the mean the fitted.
  std::string Markdown() const;
  std::string Csv() const;
  Json ToJson() const;
};

// Name of the method for a set's folder `theirs`: another program's renderings of the photographs,
// by the photographs' names. What they were fitted to is theirs to say.
inline constexpr char kTheirs[] = "theirs";

// Throws UserError, and what the programs ended with. `said` is told of each result.
HoldoutResult RunHoldout(const HoldoutExperiment& experiment, const CommonOptions& common,
                         const std::function<void(const std::string&)>& said);

}  // namespace glint
