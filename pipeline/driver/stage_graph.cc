#include "pipeline/driver/stage_graph.h"

#include <algorithm>

#include "base/errors/errors.h"
#include "base/photos/photo_name.h"
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

bool RunsHere(const StageKind& stage, const Capture& capture, const RunChoices& choices) {
  switch (stage.runs) {
    case Runs::kFromPhotographs:
      return !capture.imported();
    case Runs::kRefining:
      return choices.refines();
    case Runs::kTiling:
      return capture.tiles;
    case Runs::kAlways:
      break;
  }
  return true;
}

// Stages that come before, in their order, whether this run has them or an import stands for them.
using EarlierStages = std::vector<const StageKind*>;

std::string LastWith(const EarlierStages& earlier, const auto& has) {
  const auto found = std::find_if(earlier.rbegin(), earlier.rend(),
                                  [&](const StageKind* stage) { return has(*stage); });
  return found == earlier.rend() ? "" : std::string((*found)->name);
}

std::string LastGivingOf(const EarlierStages& earlier, Gives what) {
  return LastWith(earlier, [&](const StageKind& stage) { return stage.gives == what; });
}

std::string MapsFor(const StageKind& stage, const EarlierStages& earlier) {
  return LastWith(earlier,
                  [&](const StageKind& other) { return GivesMaps(other, stage.reads.maps); });
}

std::vector<std::string> FilesFor(const StageKind& stage, const Capture& capture) {
  std::vector<std::string> files;
  if (!stage.reads.photographs) return files;
  std::vector<std::string> photographs = capture.photos;
  if (stage.reads.board_photographs) {
    photographs.insert(photographs.end(), capture.board_photos.begin(), capture.board_photos.end());
  }
  files = FilesOfPhotos(photographs);
  if (stage.reads.board_photographs && !capture.board_file.empty()) {
    files.push_back(capture.board_file);
  }
  if (capture.encoding_is_file()) files.push_back(capture.encoding);
  return files;
}

std::vector<std::string> StagesFor(const StageKind& stage, const EarlierStages& earlier) {
  std::vector<std::string> names;
  if (stage.reads.every_stage) {
    for (const StageKind* other : earlier) names.emplace_back(other->name);
    return names;
  }
  if (stage.reads.calibration) names.push_back(LastGivingOf(earlier, Gives::kCalibration));
  if (stage.reads.views) names.push_back(LastGivingOf(earlier, Gives::kViews));
  if (stage.reads.maps != ReadsMaps::kNone) {
    const std::string maps = MapsFor(stage, earlier);
    if (!maps.empty()) names.push_back(maps);
  }
  return names;
}

void TellMethod(const std::string& method, StageStep* step) {
  if (method.empty()) return;
  const auto tell = [&](const std::string& option, const std::string& value) {
    step->arguments.insert(step->arguments.end(), {"--" + option, value});
  };
  tell("method", method == "refined" ? "latent" : method);
  if (method == "initial") step->cost = "initial";
  if (method != "latent") return;
  // Nothing comes after it that finds what is finer, or that converges.
  const FitOptions whole = FitOptions::Latent();
  tell("finest-size", std::to_string(whole.finest_size));
  tell("iterations", std::to_string(whole.coarse_iterations));
  tell("fine-iterations", std::to_string(whole.fine_iterations));
}

void TellSelection(const RunChoices& choices, StageStep* step) {
  if (!choices.exclude.empty()) {
    step->arguments.insert(step->arguments.end(), {"--exclude", Joined(choices.exclude, ",")});
  }
  if (!choices.views.empty()) {
    step->arguments.insert(step->arguments.end(), {"--views", Joined(choices.views, ",")});
  }
}

StageStep StepOf(const StageKind& stage, const Capture& capture, const RunChoices& choices,
                 const EarlierStages& earlier) {
  StageStep step =
      Step(std::string(stage.name), FilesFor(stage, capture), StagesFor(stage, earlier));
  if (stage.is_told.method) TellMethod(choices.method, &step);
  if (stage.is_told.selected_views) TellSelection(choices, &step);
  if (stage.is_told.maps_from) {
    step.arguments.insert(step.arguments.end(), {"--from", MapsFor(stage, earlier)});
  }
  if (choices.seed != 0) {
    step.arguments.insert(step.arguments.end(), {"--seed", std::to_string(choices.seed)});
  }
  return step;
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

std::vector<StageStep> StageSteps(const Capture& capture, const RunChoices& choices,
                                  std::span<const StageKind> stages) {
  const bool imported = capture.imported();
  if (!imported && capture.photos.empty()) {
    throw UserError(capture.file, "photos.files", "no such key",
                    "write for example: [photos] files = [\"photos/*.jpg\"]");
  }
  std::vector<StageStep> steps;
  EarlierStages earlier;
  for (const StageKind& stage : stages) {
    if (RunsHere(stage, capture, choices)) {
      steps.push_back(StepOf(stage, capture, choices, earlier));
    } else if (!imported || !stage.imported) {
      continue;
    }
    earlier.push_back(&stage);
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
