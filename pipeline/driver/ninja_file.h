// glint/build.ninja: the stages of a capture as a graph that Ninja (or another engine) can run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/driver/stage_graph.h"

namespace glint {

// One edge of the graph: a step and what is known of it on this disk.
struct NinjaEdge {
  StageStep step;
  std::filesystem::path program;
  // Files that the last result says it read, besides the step's inputs (weights, say).
  std::vector<std::string> more_inputs;
  // Hash of what people put there: files among the step's inputs that no stage writes. Times tell
  // less: a photograph may be replaced by an older one.
  std::string content;
  // Runs the program whatever the times of the files say.
  bool always = false;
};

// `runner` is the program that runs an edge's program and notes how it ended (see edge.h). Paths
// are relative to the capture's folder, where Ninja is started (ninja -C CAPTURE -f
// glint/build.ninja). Throws UserError for a file name that Ninja cannot hold (a line break).
std::string NinjaText(const std::vector<NinjaEdge>& edges, const std::filesystem::path& runner,
                      const RunChoices& choices);

// The choices a build.ninja was written with; the default ones where it is absent or not ours.
RunChoices ReadChoices(const std::filesystem::path& ninja_file);

}  // namespace glint
