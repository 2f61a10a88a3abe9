// A stage's run: is its result up to date, where do new outputs go, and their commit in one step.
//
//   Stage stage(capture / "glint/rectify", {"rectify", kVersion}, options, common, inputs);
//   if (stage.UpToDate()) return Said(stage);
//   WriteExr(stage.Output("view_000.exr"), …);
//   stage.Commit(data, metrics);
//
// Outputs are written into a sibling folder (".rectify.new"); Commit writes the manifest last,
// syncs, and exchanges the two folders atomically. Killed at any moment, the old or the new result
// stands, and the next run clears what was left over.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/files/files.h"
#include "base/formats/manifest.h"
#include "base/programs/options.h"
#include "base/programs/program.h"

namespace glint {

struct StageInfo {
  std::string name;  // "calib"
  int version = 1;   // raised whenever the same inputs give other bytes
};

// Thrown by Stage's constructor under --status; the front end prints it and ends with exit code 0.
struct StageCheck {
  std::string stage;
  std::string why_stale;  // empty: up to date
};
std::string ToText(const StageCheck& check);
Json ToJson(const StageCheck& check);

class Stage {
 public:
  // `inputs`: every file the result depends on (hashed here). Takes the stage folder's lock.
  // With `force` (or --force) the result is never up to date; under --status throws StageCheck and
  // touches nothing.
  Stage(std::filesystem::path folder, StageInfo info, const OptionSet& options,
        const CommonOptions& common, std::vector<std::filesystem::path> inputs, bool force = false);

  // The manifest on disk has this run's key (stage version, options, input hashes) and its outputs
  // still hash right.
  bool UpToDate() const { return up_to_date_; }

  // Path to write the output `name` to (may contain '/'); it is listed in the manifest.
  std::filesystem::path Output(const std::string& name);

  // Where that output lies until Commit().
  std::filesystem::path StagedOutput(const std::string& name) const { return staging() / name; }

  // Makes the new result the stage's result. Image outputs get width, height, channels.
  void Commit(const Json& data, const Json& metrics);

  std::filesystem::path manifest_file() const { return folder_ / "manifest.json"; }
  const std::filesystem::path& folder() const { return folder_; }
  // The line a program prints when UpToDate().
  std::string UpToDateText() const;
  // What a stage's program says then. `more`: further fields of the JSON.
  ProgramResult UpToDateResult(const Json& more = Json::object()) const;

 private:
  std::filesystem::path staging() const;
  void WriteRunFacts() const;
  // Why the result on disk is not this run's; empty when it is.
  std::string WhyStale() const;

  std::filesystem::path folder_;
  StageInfo info_;
  Json options_, run_options_, command_line_;
  int threads_;
  std::unique_ptr<FileLock> lock_;
  std::vector<ManifestInput> inputs_;
  std::vector<std::string> outside_inputs_;  // absolute paths, for run.json
  std::vector<std::string> outputs_;
  bool up_to_date_ = false;
  double started_s_ = 0;
};

}  // namespace glint
