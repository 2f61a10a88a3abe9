// glint-refine: the fitted maps, refined texel by texel.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/errors/errors.h"
#include "base/formats/capture.h"
#include "base/formats/rectified_set.h"
#include "base/programs/cost_model.h"
#include "base/programs/program.h"
#include "base/text/name_list.h"
#include "fitting/refine/refine_stage.h"

namespace glint {
namespace {

// `parts`: from how many it was joined; 0: it was refined.
ProgramResult Summarise(const Stage& stage, const RefineStageResult& refined, int parts) {
  const double texels = static_cast<double>(refined.width) * refined.height;
  const std::string how =
      parts > 0 ? fmt::format("joined from {} parts in {:.1f} s", parts, refined.seconds)
                : fmt::format("{} views in {:.1f} s ({:.0f} texels/s)", refined.views.size(),
                              refined.seconds, texels / refined.seconds);
  ProgramResult result;
  result.text = fmt::format("refine: {}x{} texels {}{}\n  {}\n", refined.width, refined.height,
                            parts > 0 ? "" : "from ", how, refined.summary.BriefReport());
  result.summary = fmt::format("{} view{}, residuals {:.3g} %, {} substances", refined.views.size(),
                               refined.views.size() == 1 ? "" : "s",
                               100 * refined.summary.residual_sigma, refined.summary.substances);
  const Json& correction = refined.metrics["correction"];
  if (refined.correction.taken && !correction["views_moved"].get<bool>()) {
    result.text += fmt::format(
        "  ambient illumination found: {:.1f} % of the flash; lights and pictures unchanged\n",
        100 * correction["ambient_of_flash"].get<double>());
  } else if (refined.correction.taken) {
    result.text += fmt::format(
        "  views corrected: lights turned by {:.1f} deg, pictures moved by {:.2f} texels, ambient "
        "light {:.1f} % of the flash (means)\n",
        correction["light_turned_deg"].get<double>(),
        correction["registration_texel"].get<double>(),
        100 * correction["ambient_of_flash"].get<double>());
  }
  for (const Json& view : refined.metrics["views"]) {
    result.text += fmt::format("  {}  {:<28} loss {:.3g}\n", view["name"].get<std::string>(),
                               view["photo"].get<std::string>(), view["log_l1"].get<double>());
  }
  std::vector<std::string> blurred;
  for (const Json& view : refined.metrics["blurred_views"]) {
    blurred.push_back(fmt::format("{} (counts for {:.0f} %)", view["photo"].get<std::string>(),
                                  100 * view["weight"].get<double>()));
  }
  if (!blurred.empty()) {
    result.text +=
        "  blurred more than the others, whose finer detail was added: " + NameList(blurred) + "\n";
  }
  result.json = {{"stage", "refine"},
                 {"up_to_date", false},
                 {"manifest", stage.manifest_file().string()},
                 {"metrics", refined.metrics}};
  return result;
}

void WarnOfOddViews(const RefineStageResult& refined) {
  const Json& odd = refined.metrics["odd_views"];
  for (const Json& view : refined.metrics["views"]) {
    if (std::find(odd.begin(), odd.end(), view["name"]) == odd.end()) continue;
    spdlog::warn(
        "the maps explain {} much worse than the other photographs (residuals of {:.2g} in log "
        "radiance; {:.2g} in the mean of all): was something on the sample, did a shadow fall on "
        "it, "
        "was it moved, or is the photograph edited? Compare it with its rendering on the report's "
        "page, and leave it out with [photos] left_out",
        view["photo"].get<std::string>(), view["log_l1"].get<double>(),
        refined.metrics["log_l1"].get<double>());
  }
}

// What every result of refinement depends on.
struct Sources {
  std::filesystem::path work, views_manifest;
  RefineStart start;
  std::vector<std::filesystem::path> inputs;
};

Sources ReadSources(const Capture& capture, const RefineStageOptions& options) {
  Sources sources{capture.work(),
                  ViewsManifest(capture.work()),
                  ResolveRefineStart(capture.work(), options),
                  {}};
  const std::filesystem::path& manifest = sources.views_manifest;
  ReadRectifiedSet(manifest);  // checks it and its images
  const RefineStart& start = sources.start;
  sources.inputs = {manifest, start.manifest_file.empty() ? start.maps_file : start.manifest_file};
  return sources;
}

Stage PartOf(const Sources& sources, const RowPart& part, const OptionSet& set,
             const CommonOptions& common) {
  const std::string name = PartStage(part);
  return Stage(sources.work / name, {name, kRefineVersion}, set, common, sources.inputs);
}

// Whether the whole has been refined, asked without its lock: parts run side by side.
bool IsRefined(const Sources& sources, const OptionSet& set, CommonOptions common) {
  if (common.force) return false;
  common.check = true;
  try {
    const Stage whole(sources.work / "refine", {"refine", kRefineVersion}, set, common,
                      sources.inputs);
  } catch (const StageCheck& check) {
    return check.why_stale.empty();
  }
  return false;
}

ProgramResult RunPart(const Capture& capture, const Sources& sources, const OptionSet& set,
                      const RefineStageOptions& options, const CommonOptions& common) {
  const RowPart part = ParseRowPart(options.part);
  if (!common.check && IsRefined(sources, set, common)) {
    return {"refine: up to date as a whole; no part is needed\n",
            {{"stage", "refine"}, {"up_to_date", true}}};
  }
  Stage stage = PartOf(sources, part, set, common);
  if (stage.UpToDate()) return stage.UpToDateResult();
  RequireMemoryForStage("refine", capture, SizeOfMaps(capture), common.threads);
  const RowRange rows =
      RunRefinePart(sources.views_manifest, sources.start, options, part, common.threads, &stage);
  ProgramResult result;
  result.text = fmt::format("refine: part {} of {}, rows {} to {} of {}\n", part.part, part.of,
                            rows.first + 1, rows.first + rows.rows, rows.of);
  result.json = {{"stage", PartStage(part)},
                 {"up_to_date", false},
                 {"manifest", stage.manifest_file().string()}};
  return result;
}

// The parts' results, all of them up to date, and locked for as long as they are held.
std::vector<Stage> Parts(const std::filesystem::path& folder, const Sources& sources,
                         const OptionSet& set, int parts, CommonOptions common) {
  common.force = false;  // they are joined as they are
  std::vector<Stage> results;
  for (int k = 1; k <= parts; ++k) {
    results.push_back(PartOf(sources, {k, parts}, set, common));
    if (results.back().UpToDate()) continue;
    throw UserError(results.back().folder(), "", fmt::format("no up-to-date result of part {}", k),
                    fmt::format("run glint refine {} --part {}/{}, with the same options",
                                folder.string(), k, parts));
  }
  return results;
}

void LoadToml(const Capture& capture, OptionSet* set, RefineStageOptions* options) {
  const std::pair asked(options->part, options->join);
  set->LoadToml(capture.file, "refine");
  if (std::pair(options->part, options->join) != asked) {
    throw UserError(capture.file, "[refine] part, join", "a value",
                    "these apply to one job; give them on the command line");
  }
  if (!options->part.empty() && options->join > 0) {
    throw UserError("--part, --join: found both; refine all parts, then join them");
  }
}

ProgramResult Run(const std::filesystem::path& folder, OptionSet* set, RefineStageOptions* options,
                  const CommonOptions& common) {
  const Capture capture = ReadCapture(folder);
  LoadToml(capture, set, options);
  const Sources sources = ReadSources(capture, *options);
  if (!options->part.empty()) return RunPart(capture, sources, *set, *options, common);
  Stage stage(sources.work / "refine", {"refine", kRefineVersion}, *set, common, sources.inputs);
  if (stage.UpToDate()) {
    RemoveParts(sources.work);
    return stage.UpToDateResult();
  }
  RequireMemoryForStage("refine", capture, SizeOfMaps(capture), common.threads);
  const std::vector<Stage> parts = Parts(folder, sources, *set, options->join, common);
  std::vector<std::filesystem::path> folders;
  folders.reserve(parts.size());
  for (const Stage& part : parts) folders.push_back(part.folder());
  const RefineStageResult result = RunRefineStage(sources.views_manifest, sources.start, *options,
                                                  folders, common.threads, &stage);
  RemoveParts(sources.work);
  WarnOfOddViews(result);
  return Summarise(stage, result, options->join);
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  std::filesystem::path folder = ".";
  glint::RefineStageOptions options;
  glint::OptionSet set;
  set.AddPositional("capture", &folder, "the capture's folder", false);
  glint::AddRefineOptions(&set, &options);
  const glint::ProgramInfo info{"glint-refine",
                                "Refines the fitted maps texel by texel, staying close to them "
                                "where the photographs determine little.",
                                GLINT_VERSION,
                                "Example: glint refine wood --exclude view_003,view_007"};
  return glint::RunProgram(argc, argv, info, &set, [&](const glint::CommonOptions& common) {
    return glint::Run(folder, &set, &options, common);
  });
}
