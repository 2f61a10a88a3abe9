#include "datasets/evaluation/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <set>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/hash.h"
#include "base/formats/manifest.h"
#include "base/formats/svbrdf_file.h"
#include "base/programs/subprocess.h"
#include "datasets/evaluation/capture_store.h"
#include "datasets/evaluation/corrected_lights.h"
#include "datasets/evaluation/shipped_models.h"
#include "datasets/looks/view_error.h"
#include "datasets/statistics/population.h"
#include "fitting/latent/fit_stage.h"
#include "fitting/refine/refine_stage.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

Table1Row RowOf(const fs::path& file, const Json& json) {
  Table1Row row;
  row.maps.diffuse = RequireNumber(file, json, "errors", "diffuse");
  row.maps.specular = RequireNumber(file, json, "errors", "specular");
  row.maps.roughness = RequireNumber(file, json, "errors", "roughness");
  row.maps.normal = RequireNumber(file, json, "errors", "normal");
  row.render = RequireNumber(file, json, "errors", "render");
  return row;
}

// What is not as in the paper's plain views.
Json DisturbanceSettings(const ViewSetOptions& views) {
  const Disturbance& disturbance = views.disturbance;
  Json json = Json::object();
  const auto add = [&](const char* name, double value) {
    if (value != 0) json[name] = value;
  };
  add("light_off_deg", disturbance.light_off_deg);
  if (disturbance.light_together) json["light_together"] = true;
  add("registration_texel", disturbance.registration_texel);
  add("environment_percent", disturbance.environment_percent);
  add("exposure_stops", views.exposure_stops);
  add("least_tilt_deg", views.least_tilt_deg);
  add("discrepancy", views.discrepancy);
  if (disturbance.environment_percent > 0 && !disturbance.environment.empty()) {
    json["environment"] = HashFile(disturbance.environment);
  }
  return json;
}

// Share of texels with a channel that an 8-bit photograph shows as 255.
double SaturatedShare(const SvbrdfMaps& maps, const ViewSetOptions& views,
                      const CommonOptions& common) {
  ViewSetOptions exact = views;
  exact.bits = "float";
  const PlannedViews planned = PlanViews(exact, common.seed, maps.width, maps.height);
  size_t saturated = 0;
  for (int i = 0; i < views.count; ++i) {
    const RectifiedImage image = RenderPlannedView(maps, planned, i, exact, common.threads);
    const size_t n = maps.texels();
    for (size_t t = 0; t < n; ++t) {
      saturated += std::max({image.rgb[t], image.rgb[n + t], image.rgb[2 * n + t]}) >= 1;
    }
  }
  return static_cast<double>(saturated) / (static_cast<double>(maps.texels()) * views.count);
}

std::string HashOf(const SvbrdfMaps& maps) {
  return HashBytes(
      {reinterpret_cast<const char*>(maps.planes.data()), maps.planes.size() * sizeof(float)});
}

// The runs for one material under one condition.
class Runs {
 public:
  Runs(const Experiment& experiment, const CommonOptions& common, const MaterialSource& material,
       const Condition& condition, ShippedModels* models)
      : experiment_(experiment),
        common_(common),
        material_(material),
        condition_(condition),
        truth_(HashOf(material.maps)),
        folder_(experiment.work / material.name / condition.folder),
        store_(material, condition.views, common),
        models_(models) {}

  // Fills in the errors of `method`; true: from the kept result.
  bool Evaluate(const Method& method, ExperimentEntry* entry) {
    const fs::path file = folder_ / (method.name + ".json");
    const Json settings = Settings(method);
    const std::optional<Json> kept = Kept(file, settings);
    const Json json = kept ? *kept : Computed(method, settings);
    if (!kept) WriteFileAtomically(file, json.dump(2) + "\n");
    entry->errors = RowOf(file, RequireField(file, json, "", "errors"));
    if (experiment_.compare_lights) {
      const Json& lights = RequireField(file, json, "", "light_off_deg");
      entry->light_mean_deg = RequireNumber(file, lights, "light_off_deg", "mean");
      entry->light_worst_deg = RequireNumber(file, lights, "light_off_deg", "largest");
    }
    return kept.has_value();
  }

 private:
  std::optional<Json> Kept(const fs::path& file, const Json& settings) const {
    if (common_.force || !fs::exists(file)) return std::nullopt;
    const Json json = Json::parse(ReadTextFile(file), nullptr, false);
    if (!json.is_object() || json.value("settings", Json()) != settings) return std::nullopt;
    if (json.value("truth", truth_) != truth_) return std::nullopt;
    if (json.contains("models") && !models_->AreStill(json["models"])) return std::nullopt;
    if (experiment_.compare_lights && !json.contains("light_off_deg")) return std::nullopt;
    return json;
  }

  Json Computed(const Method& method, const Json& settings) {
    Run(method);
    const fs::path manifest = ResultManifest(experiment_, material_.name, condition_, method);
    const FittedMaps result = ReadFittedMaps(manifest);
    const Table1Row row =
        EvaluateMaps(ToUnitWeight(result.maps, result.convention), material_.maps, common_.threads);
    Json models = models_->UsedBy(manifest.parent_path().parent_path() / "fit" / "manifest.json");
    models.update(models_->UsedBy(manifest));
    Json json = {
        {"settings", settings}, {"truth", truth_}, {"models", models}, {"errors", ErrorsJson(row)}};
    if (experiment_.compare_lights) {
      const PlannedViews planned =
          PlanViews(condition_.views, common_.seed, material_.maps.width, material_.maps.height);
      const LightAngles lights = CompareLights(planned, manifest);
      json["light_off_deg"] = {{"mean", lights.mean_deg}, {"largest", lights.worst_deg}};
    }
    return json;
  }

  Json Settings(const Method& method) const {
    const ViewSetOptions& views = condition_.views;
    Json settings = {{"method", method.name},
                     {"size", experiment_.size},
                     {"rule", views.rule},
                     {"bits", views.bits},
                     {"encoding", views.encoding},
                     {"seed", common_.seed},
                     {"fit_arguments", method.fit_arguments}};
    settings["versions"] = {{"fit", kFitVersion}};
    if (method.refine) {
      settings["refine_arguments"] = method.refine_arguments;
      settings["versions"]["refine"] = kRefineVersion;
    }
    const Json disturbance = DisturbanceSettings(views);
    if (!disturbance.empty()) settings["disturbance"] = disturbance;
    for (const fs::path& file : method.files) settings["files"].push_back(HashFile(file));
    return settings;
  }

  // Runs what `method` needs. The programs themselves keep what is up to date, so that an
  // interrupted experiment goes on where it was.
  void Run(const Method& method) {
    const fs::path capture = folder_ / method.capture;
    const fs::path fitted = method.fit_of.empty() ? capture : folder_ / method.fit_of;
    store_.Provide(fitted);
    std::vector<std::string> arguments{"--method", method.fit};
    if (method.start) {
      const fs::path file = folder_ / (method.capture + "_start.exr");
      WriteSvbrdf(file, method.start(material_.maps), store_.convention());
      arguments.insert(arguments.end(), {"--start", file.string()});
    }
    Program("glint-fit", fitted, arguments, method.fit_arguments);
    if (fitted != capture) {
      store_.Provide(capture);
      store_.ShareFit(fitted, capture);
    }
    if (method.refine) Program("glint-refine", capture, {}, method.refine_arguments);
  }

  void Program(const std::string& name, const fs::path& capture,
               const std::vector<std::string>& first, const std::vector<std::string>& more) {
    std::vector<std::string> argv{SiblingProgram(name).string(), capture.string()};
    argv.insert(argv.end(), first.begin(), first.end());
    argv.insert(argv.end(), {"--threads", std::to_string(common_.threads), "--seed",
                             std::to_string(common_.seed)});
    if (common_.force) argv.push_back("--force");
    argv.insert(argv.end(), more.begin(), more.end());
    RunToLog(argv, folder_ / (capture.filename().string() + ".log"));
  }

  const Experiment& experiment_;
  const CommonOptions& common_;
  const MaterialSource& material_;
  const Condition& condition_;
  std::string truth_;  // hash of the true maps: generators and files change
  fs::path folder_;
  CaptureStore store_;
  ShippedModels* models_;
};

void CheckExperiment(const Experiment& experiment) {
  if (experiment.methods.empty()) throw UserError("methods: found none; name at least one");
  if (experiment.conditions.empty()) throw UserError("counts: found none; name at least one");
  if (experiment.materials.empty()) throw UserError("materials: found none; name at least one");
  for (const Condition& condition : experiment.conditions) {
    const int count = condition.views.count;
    if (count < 1) throw UserError(fmt::format("counts: found {}; use 1 or more", count));
  }
  if (experiment.size < 8 || experiment.size > 4096) {
    throw UserError(fmt::format("size: found {}; use 8 to 4096", experiment.size));
  }
}

// Appends procedural:A … procedural:B for "procedural:A..B"; false: `text` is no range.
bool AppendRange(const std::string& text, std::vector<std::string>* list) {
  constexpr std::string_view kPrefix = "procedural:";
  constexpr std::uint64_t kMost = 100000;
  const size_t dots = text.find("..");
  if (!text.starts_with(kPrefix) || dots == std::string::npos) return false;
  std::uint64_t first = 0, last = 0;
  const auto read = [](std::string_view digits, std::uint64_t* value) {
    const char* end = digits.data() + digits.size();
    const auto parsed = std::from_chars(digits.data(), end, *value);
    return parsed.ec == std::errc() && parsed.ptr == end;
  };
  const std::string_view whole = text;
  if (!read(whole.substr(kPrefix.size(), dots - kPrefix.size()), &first) ||
      !read(whole.substr(dots + 2), &last) || last < first || last - first >= kMost) {
    throw UserError("materials: found \"" + text +
                    "\"; write procedural:FIRST..LAST with whole numbers, at most " +
                    std::to_string(kMost) + " of them");
  }
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    list->push_back(std::string(kPrefix) + std::to_string(seed));
  }
  return true;
}

}  // namespace

Method NamedMethod(const std::string& name, const std::vector<std::string>& fit_arguments,
                   const std::vector<std::string>& refine_arguments) {
  static const std::vector<std::string> known{"initial", "classic", "latent",
                                              "refined", "direct",  "uncorrected"};
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    throw UserError("methods: found \"" + name +
                    "\"; use initial, classic, latent, refined, direct, uncorrected");
  }
  const bool uncorrected = name == "uncorrected", direct = name == "direct";
  Method method;
  method.name = name;
  method.refine = name == "refined" || direct || uncorrected;
  method.capture = name == "refined" ? "latent" : name;
  method.fit = direct ? "initial" : method.refine ? "latent" : name;
  method.fit_arguments = fit_arguments;
  method.refine_arguments = refine_arguments;
  if (uncorrected) {
    method.fit_of = "latent";
    method.refine_arguments.insert(method.refine_arguments.end(), {"--correct-views", "never"});
  }
  return method;
}

std::vector<std::string> ExpandMaterials(const std::vector<std::string>& named) {
  constexpr int kSmall = 8;  // texels a side: only the name is wanted
  std::vector<std::string> all;
  for (const std::string& text : named) {
    if (AppendRange(text, &all)) continue;
    const auto found = FindMaterials({text});
    all.insert(all.end(), found.begin(), found.end());
  }
  std::set<std::string> names;
  for (const std::string& text : all) {
    const std::string name = LoadMaterial(text, kSmall).name;
    if (!names.insert(name).second) {
      throw UserError("materials: found two named \"" + name + "\"; results are kept by name");
    }
  }
  return all;
}

fs::path ResultManifest(const Experiment& experiment, const std::string& material,
                        const Condition& condition, const Method& method) {
  return experiment.work / material / condition.folder / method.capture / "glint" /
         (method.refine ? "refine" : "fit") / "manifest.json";
}

ExperimentResult RunExperiment(const Experiment& experiment, const CommonOptions& common,
                               const std::function<void(const std::string&)>& said) {
  CheckExperiment(experiment);
  // Waiting threads that spin slow a busy machine down by far more than they win.
  ::setenv("OMP_WAIT_POLICY", "passive", 0);
  ExperimentResult result;
  result.name = experiment.name;
  ShippedModels models;
  for (const std::string& name : experiment.materials) {
    const MaterialSource material = LoadMaterial(name, experiment.size);
    for (const Condition& condition : experiment.conditions) {
      Runs runs(experiment, common, material, condition, &models);
      ExperimentEntry entry;
      entry.material = material.name;
      entry.count = condition.views.count;
      entry.condition = condition.name;
      if (experiment.count_saturated) {
        entry.saturated = SaturatedShare(material.maps, condition.views, common);
      }
      for (const Method& method : experiment.methods) {
        entry.method = method.name;
        const bool kept = runs.Evaluate(method, &entry);
        result.entries.push_back(entry);
        said(fmt::format("{} n={}{}{} {}: map average {:.6f}, render {:.6f}{}", material.name,
                         entry.count, condition.name.empty() ? "" : ", ", condition.name,
                         method.name, entry.errors.maps.average(), entry.errors.render,
                         kept ? " (kept)" : ""));
      }
    }
  }
  return result;
}

}  // namespace glint
