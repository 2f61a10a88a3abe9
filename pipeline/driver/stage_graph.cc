#include "pipeline/driver/stage_graph.h"

#include <algorithm>

#include "base/errors/errors.h"
#include "base/photos/photo_name.h"
#include "base/stages/stages.h"
#include "fitting/latent/fit.h"

namespace glint {
namespace {

std::string Joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

StageStep Step(const std::string& stage, std::vector<std::string> files,
               std::vector<std::string> waits_for) {
  StageStep step;
  step.stage = step.cost = stage;
  step.manifest = ManifestPath(stage);
  step.inputs = {"capture.toml"};
  step.inputs.insert(step.inputs.end(), files.begin(), files.end());
  for (const std::string& earlier : waits_for) step.inputs.push_back(ManifestPath(earlier));
  step.waits_for = std::move(waits_for);
  return step;
}

std::vector<std::string> NamesOf(const std::vector<StageStep>& steps) {
  std::vector<std::string> names(steps.size());
  std::transform(steps.begin(), steps.end(), names.begin(),
                 [](const StageStep& step) { return step.stage; });
  return names;
}

void AddSelection(const RunChoices& choices, StageStep* step) {
  if (!choices.exclude.empty()) {
    step->arguments.insert(step->arguments.end(), {"--exclude", Joined(choices.exclude, ",")});
  }
  if (!choices.views.empty()) {
    step->arguments.insert(step->arguments.end(), {"--views", Joined(choices.views, ",")});
  }
}

size_t Find(const std::vector<StageStep>& steps, const std::string& stage,
            const std::string& option) {
  if (FindStage(stage) == nullptr) {
    throw UserError("--" + option + ": found the unknown stage '" + stage +
                    "'; use one of: " + StageNamesText());
  }
  const auto found = std::find_if(steps.begin(), steps.end(),
                                  [&](const StageStep& step) { return step.stage == stage; });
  if (found == steps.end()) {
    throw UserError(
        "--" + option + ": found '" + stage +
        "', which this run does not have; its stages are: " + Joined(NamesOf(steps), ", "));
  }
  return static_cast<size_t>(found - steps.begin());
}

}  // namespace

Json ToJson(const RunChoices& choices) {
  return {{"method", choices.method},
          {"exclude", choices.exclude},
          {"views", choices.views},
          {"seed", choices.seed}};
}

RunChoices RunChoicesFromJson(const Json& json) {
  RunChoices choices;
  choices.method = json.value("method", "");
  choices.exclude = json.value("exclude", std::vector<std::string>());
  choices.views = json.value("views", std::vector<std::string>());
  choices.seed = json.value("seed", std::uint64_t{0});
  return choices;
}

const std::vector<std::string>& StageNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const StageKind& stage : Stages()) list.emplace_back(stage.name);
    return list;
  }();
  return names;
}

std::vector<StageStep> StageSteps(const Capture& capture, const RunChoices& choices) {
  const bool imported = capture.imported();
  if (!imported && capture.photos.empty()) {
    throw UserError(capture.file, "photos.files", "no such key",
                    "write for example: [photos] files = [\"photos/*.jpg\"]");
  }
  std::vector<StageStep> steps;
  if (!imported) {
    std::vector<std::string> all = capture.photos;
    all.insert(all.end(), capture.board_photos.begin(), capture.board_photos.end());
    std::vector<std::string> calib_files = FilesOfPhotos(all);
    std::vector<std::string> rectify_files = FilesOfPhotos(capture.photos);
    if (!capture.board_file.empty()) calib_files.push_back(capture.board_file);
    if (capture.encoding_is_file()) {
      calib_files.push_back(capture.encoding);
      rectify_files.push_back(capture.encoding);
    }
    steps.push_back(Step("calib", calib_files, {}));
    steps.push_back(Step("rectify", rectify_files, {"calib"}));
  }
  const std::string views(LastGiving(Gives::kViews).name);
  steps.push_back(Step("fit", {}, {views}));
  const std::string& method = choices.method;
  if (!method.empty()) {
    steps.back().arguments = {"--method", method == "refined" ? "latent" : method};
    if (method == "initial") steps.back().cost = "initial";
    // Nothing comes after it that finds what is finer, or that converges.
    if (method == "latent") {
      const FitOptions whole = FitOptions::Latent();
      steps.back().arguments.insert(steps.back().arguments.end(),
                                    {"--finest-size", std::to_string(whole.finest_size),
                                     "--iterations", std::to_string(whole.coarse_iterations),
                                     "--fine-iterations", std::to_string(whole.fine_iterations)});
    }
  }
  AddSelection(choices, &steps.back());
  if (choices.refines()) {
    steps.push_back(Step("refine", {}, {views, "fit"}));
    AddSelection(choices, &steps.back());
  }
  const std::string last = choices.refines() ? "refine" : "fit";
  if (capture.tiles) {
    steps.push_back(Step("tile", {}, {last}));
    steps.back().arguments = {"--from", last};
  }
  const std::string exported = capture.tiles ? "tile" : last;
  steps.push_back(Step("export", {}, {exported}));
  std::vector<std::string> all_stages = NamesOf(steps);
  if (imported) all_stages.insert(all_stages.begin(), "rectify");
  steps.push_back(Step("report", {}, all_stages));
  for (StageStep& step : steps) {
    if (step.stage == "export") {
      step.arguments.insert(step.arguments.end(), {"--from", exported});
    }
    if (step.stage == "report") {
      step.arguments.insert(step.arguments.end(), {"--from", last});
    }
    if (choices.seed != 0) {
      step.arguments.insert(step.arguments.end(), {"--seed", std::to_string(choices.seed)});
    }
  }
  return steps;
}

std::vector<StageStep> SelectSteps(const std::vector<StageStep>& steps, const std::string& from,
                                   const std::string& until) {
  const size_t first = from.empty() ? 0 : Find(steps, from, "from");
  const size_t last = until.empty() ? steps.size() - 1 : Find(steps, until, "until");
  if (first > last) {
    throw UserError("--from, --until: found '" + from + "' after '" + until +
                    "'; give them in the order of the stages");
  }
  return {steps.begin() + static_cast<std::ptrdiff_t>(first),
          steps.begin() + static_cast<std::ptrdiff_t>(last) + 1};
}

}  // namespace glint
