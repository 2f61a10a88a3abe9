#include "datasets/evaluation/held_out_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/rectified_set.h"
#include "base/images/image.h"
#include "base/programs/subprocess.h"
#include "datasets/evaluation/experiment.h"
#include "datasets/evaluation/link_files.h"
#include "datasets/evaluation/predicted_deviation.h"
#include "datasets/evaluation/their_rendering.h"
#include "datasets/looks/looks_figures.h"
#include "datasets/looks/view_error.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> Pieces(const std::string& text, char separator) {
  std::vector<std::string> pieces(1);
  for (const char c : text) {
    if (c == separator) {
      pieces.emplace_back();
    } else if (!std::isspace(static_cast<unsigned char>(c))) {
      pieces.back() += c;
    }
  }
  return pieces;
}

bool IsNumber(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(),
                                      [](unsigned char c) { return std::isdigit(c) != 0; });
}

// Of a set: the views that a split lists and the others.
struct SplitViews {
  std::vector<RectifiedView> fitted, held_out;
};

SplitViews Divide(const RectifiedSet& set, const HoldoutSplit& split) {
  std::vector<std::string> names;
  for (const std::string& listed : split.listed) {
    if (!IsNumber(listed)) {
      names.push_back(listed);
      continue;
    }
    const size_t index = std::stoul(listed);
    if (index >= set.views.size()) {
      throw UserError(set.manifest_file, "views", std::to_string(set.views.size()) + " of them",
                      "photograph " + listed + " of \"" + split.name +
                          "\" does not exist; numbering starts at 0");
    }
    names.push_back(set.views[index].name);
  }
  SplitViews views;
  const std::vector<RectifiedView> listed = SelectViews(set, names, {});
  std::vector<RectifiedView> others;
  for (const RectifiedView& view : set.views) {
    const auto same = [&](const RectifiedView& v) { return v.name == view.name; };
    if (std::none_of(listed.begin(), listed.end(), same)) others.push_back(view);
  }
  if (others.empty()) {
    throw UserError("splits: \"" + split.name + "\" lists every photograph of " +
                    set.manifest_file.string() + "; leave some for the other side");
  }
  return split.fitted ? SplitViews{listed, others} : SplitViews{others, listed};
}

HoldoutFigures FiguresOf(const FittedMaps& fit, const std::optional<StatedDeviations>& stated,
                         const RectifiedSet& set, const std::vector<RectifiedView>& views,
                         int threads) {
  HoldoutFigures figures;
  std::vector<Looks> looks;
  double squares = 0, count = 0;
  for (const RectifiedView& view : views) {
    const RectifiedImage photograph = PhotographOfFit(fit, set, view);
    const std::vector<float> rendered = RenderFit(fit, set, view, threads);
    const ViewError error = CompareView(rendered, photograph, view.ldr);
    looks.push_back(CompareLooks(rendered, photograph, view.ldr));
    figures.log_l1 += error.log_l1 / static_cast<double>(views.size());
    figures.mse += error.mse / static_cast<double>(views.size());
    if (!stated) continue;
    const std::vector<float> deviation = PredictedDeviation(fit, *stated, set, view, threads);
    const std::vector<float> residuals = LogResiduals(rendered, photograph, view.ldr);
    for (size_t k = 0; k < residuals.size(); ++k) {
      if (!std::isfinite(residuals[k])) continue;  // masked
      squares += std::pow(residuals[k] / deviation[k], 2);
      count += 1;
    }
  }
  if (count > 0) figures.standardised = std::sqrt(squares / count);
  figures.looks = MeanLooks(looks);
  return figures;
}

bool HasRectifiedViews(const fs::path& set) { return fs::exists(ViewsManifest(set / "glint")); }

// One set's runs.
class SetRuns {
 public:
  SetRuns(const HoldoutExperiment& experiment, const CommonOptions& common, fs::path source)
      : experiment_(experiment), common_(common), source_(std::move(source)) {
    source_ = fs::weakly_canonical(source_);
    name_ = source_.filename().string();
    folder_ = experiment.work / name_;
    if (experiment.size > 0) folder_ /= "size_" + std::to_string(experiment.size);
    rectified_ = Rectified();
    set_ = ReadRectifiedSet(rectified_ / "manifest.json");
  }

  const std::string& name() const { return name_; }

  HoldoutEntry Evaluate(const HoldoutSplit& split, const std::string& method,
                        const ProgramFolder& programs) const {
    const SplitViews views = Divide(set_, split);
    HoldoutEntry entry = Named(split, Label(method, programs), views);
    const NamedRun run = Run(split, views, method, programs);
    entry.manifest = run.manifest;
    entry.views = rectified_ / "manifest.json";
    const FittedMaps fit = ReadFittedMaps(run.manifest);
    const auto stated = run.refined ? ReadStatedDeviations(run.manifest) : std::nullopt;
    entry.fitted = FiguresOf(fit, std::nullopt, set_, views.fitted, common_.threads);
    entry.held_out = FiguresOf(fit, stated, set_, views.held_out, common_.threads);
    return entry;
  }

  // Another program's renderings, where the set has any of all photographs.
  std::optional<HoldoutEntry> EvaluateTheirs(const HoldoutSplit& split) const {
    const SplitViews views = Divide(set_, split);
    HoldoutEntry entry = Named(split, kTheirs, views);
    const auto figures = [&](const std::vector<RectifiedView>& list, HoldoutFigures* sum) {
      std::vector<Looks> looks;
      for (const RectifiedView& view : list) {
        const fs::path file = source_ / kTheirs / fs::path(view.photo).filename();
        if (!fs::exists(file)) return false;
        const RectifiedImage photograph = ReadRectifiedImage(set_, view);
        const std::vector<float> rendered =
            ReadTheirRendering(file, photograph.width, photograph.height);
        const ViewError error = CompareView(rendered, photograph, view.ldr);
        looks.push_back(CompareLooks(rendered, photograph, view.ldr));
        sum->log_l1 += error.log_l1 / static_cast<double>(list.size());
        sum->mse += error.mse / static_cast<double>(list.size());
      }
      sum->looks = MeanLooks(looks);
      return true;
    };
    if (!figures(views.fitted, &entry.fitted) || !figures(views.held_out, &entry.held_out)) {
      return std::nullopt;
    }
    return entry;
  }

 private:
  struct NamedRun {
    fs::path manifest;
    bool refined = false;
  };

  static std::string Label(const std::string& method, const ProgramFolder& programs) {
    return programs.name.empty() ? method : programs.name + ":" + method;
  }

  HoldoutEntry Named(const HoldoutSplit& split, const std::string& method,
                     const SplitViews& views) const {
    HoldoutEntry entry;
    entry.set = name_;
    entry.split = split.name;
    entry.method = method;
    entry.fitted_views = static_cast<int>(views.fitted.size());
    entry.held_out_views = static_cast<int>(views.held_out.size());
    for (const RectifiedView& view : views.held_out) entry.held_out_names.push_back(view.name);
    return entry;
  }

  // Folder of the rectified views: the capture's own, or those of an import.
  fs::path Rectified() const {
    if (HasRectifiedViews(source_)) return ViewsManifest(source_ / "glint").parent_path();
    const fs::path capture = folder_ / "capture";
    std::vector<std::string> arguments{source_.string(), capture.string()};
    if (experiment_.size > 0) {
      arguments.insert(arguments.end(), {"--size", std::to_string(experiment_.size)});
    }
    Program(SiblingProgram("glint-import"), arguments, experiment_.import_arguments,
            folder_ / "capture.log");
    return ImportedViewsManifest(capture / "glint").parent_path();
  }

  NamedRun Run(const HoldoutSplit& split, const SplitViews& views, const std::string& method_name,
               const ProgramFolder& programs) const {
    const Method method =
        NamedMethod(method_name, experiment_.fit_arguments, experiment_.refine_arguments);
    const std::string prefix = programs.name.empty() ? "" : programs.name + "_";
    const fs::path capture = folder_ / split.folder / (prefix + method.capture);
    const fs::path log = folder_ / split.folder / (prefix + method.name + ".log");
    const fs::path views_folder = capture / "glint" / rectified_.filename();
    if (!fs::exists(views_folder / "manifest.json")) {
      LinkFolder(rectified_, views_folder);
      // Neither photographs nor board: its work begins at fit, with the programs' own options.
      WriteFileAtomically(
          capture / "capture.toml",
          fmt::format("[sample]\nsize_mm = [{}, {}]\n", set_.plane.width_mm, set_.plane.height_mm));
    }
    std::string names;
    for (const RectifiedView& view : views.fitted) {
      names += (names.empty() ? "" : ",") + view.name;
    }
    Program(At(programs, "glint-fit"), {capture.string(), "--method", method.fit, "--views", names},
            method.fit_arguments, log);
    if (!method.refine) return {capture / "glint" / "fit" / "manifest.json", false};
    Program(At(programs, "glint-refine"), {capture.string()}, method.refine_arguments, log);
    return {capture / "glint" / "refine" / "manifest.json", true};
  }

  static fs::path At(const ProgramFolder& programs, const std::string& name) {
    return programs.name.empty() ? fs::path(SiblingProgram(name)) : programs.folder / name;
  }

  void Program(const fs::path& program, const std::vector<std::string>& first,
               const std::vector<std::string>& more, const fs::path& log) const {
    std::vector<std::string> argv{program.string()};
    argv.insert(argv.end(), first.begin(), first.end());
    argv.insert(argv.end(), {"--threads", std::to_string(common_.threads), "--seed",
                             std::to_string(common_.seed)});
    if (common_.force) argv.push_back("--force");
    argv.insert(argv.end(), more.begin(), more.end());
    fs::create_directories(log.parent_path());
    RunToLog(argv, log);
  }

  const HoldoutExperiment& experiment_;
  const CommonOptions& common_;
  fs::path source_, folder_, rectified_;
  std::string name_;
  RectifiedSet set_;
};

void CheckExperiment(const HoldoutExperiment& experiment) {
  if (experiment.sets.empty()) throw UserError("sets: found none; name at least one");
  if (experiment.splits.empty()) {
    throw UserError("pairs: found none, and no --shown; say which photographs to hold out");
  }
  if (experiment.work.empty()) {
    throw UserError("work: found nothing; name a folder for the results");
  }
  std::vector<std::string> names;
  for (const fs::path& set : experiment.sets) {
    if (!fs::is_directory(set)) {
      throw UserError(set, "", "no folder", "name folders that glint-import reads, or captures");
    }
    if (experiment.size > 0 && HasRectifiedViews(set)) {
      throw UserError(set, "size", std::to_string(experiment.size),
                      "its views are rectified already; leave out --size, or make them at that "
                      "size (glint rectify --resolution, glint import --size)");
    }
    const std::string name = fs::weakly_canonical(set).filename().string();
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      throw UserError("sets: two are called \"" + name + "\"; results are kept by name");
    }
    names.push_back(name);
  }
}

}  // namespace

std::vector<HoldoutSplit> ParseSplits(const std::string& text, bool fitted) {
  std::vector<HoldoutSplit> splits;
  for (const std::string& group : Pieces(text, ';')) {
    if (group.empty()) continue;
    HoldoutSplit split;
    split.fitted = fitted;
    split.folder = fitted ? "only" : "out";
    for (const std::string& listed : Pieces(group, ',')) {
      if (listed.empty()) {
        throw UserError("splits: found \"" + text + "\"; write 2,6;7,8 (commas within a group)");
      }
      split.listed.push_back(listed);
      split.name += (split.name.empty() ? "" : ",") + listed;
      split.folder += "_" + fs::path(listed).filename().string();
    }
    split.name += fitted ? " fitted" : " held out";
    splits.push_back(split);
  }
  return splits;
}

HoldoutResult RunHoldout(const HoldoutExperiment& experiment, const CommonOptions& common,
                         const std::function<void(const std::string&)>& said) {
  CheckExperiment(experiment);
  std::vector<ProgramFolder> programs = experiment.programs;
  programs.push_back({});
  HoldoutResult result;
  const auto add = [&](const HoldoutEntry& entry) {
    said(fmt::format("{}, {}, {}: log-L1 {:.4f} fitted, {:.4f} held out", entry.set, entry.split,
                     entry.method, entry.fitted.log_l1, entry.held_out.log_l1));
    result.entries.push_back(entry);
  };
  for (const fs::path& source : experiment.sets) {
    const SetRuns runs(experiment, common, source);
    for (const HoldoutSplit& split : experiment.splits) {
      if (const auto theirs = runs.EvaluateTheirs(split)) add(*theirs);
      for (const ProgramFolder& folder : programs) {
        for (const std::string& method : experiment.methods) {
          add(runs.Evaluate(split, method, folder));
        }
      }
    }
  }
  return result;
}

}  // namespace glint
