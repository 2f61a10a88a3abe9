#include "pipeline/report/report.h"

#include <tuple>

#include "base/errors/errors.h"
#include "base/formats/rectified_set.h"
#include "base/resampling/resampling.h"
#include "base/stages/stages.h"
#include "pipeline/report/corrections_section.h"
#include "pipeline/report/downloads_section.h"
#include "pipeline/report/guidance_section.h"
#include "pipeline/report/html.h"
#include "pipeline/report/sections.h"
#include "pipeline/report/shown_views.h"
#include "pipeline/report/thumbnail.h"
#include "pipeline/report/viewer_section.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> StagesShown(const std::string& from) {
  std::vector<std::string> stages;
  for (const StageKind& stage : Stages()) {
    const bool unused = stage.name == "refine" && from != "refine";
    if (stage.gives != Gives::kFiles && !unused) stages.emplace_back(stage.name);
  }
  return stages;
}

std::vector<std::string> StagesRead(const std::string& from) {
  std::vector<std::string> stages = StagesShown(from);
  stages.push_back("export");
  return stages;
}

// Names of the views that the maps were fitted to; all of the set where the fit does not say.
std::vector<std::string> UsedViews(const Manifest& manifest, const RectifiedSet& set) {
  std::vector<std::string> names;
  const auto found = manifest.data.find("views");
  if (found != manifest.data.end() && found->is_array()) {
    for (const Json& name : *found) {
      if (name.is_string()) names.push_back(name.get<std::string>());
    }
    return names;
  }
  for (const RectifiedView& view : set.views) names.push_back(view.name);
  return names;
}

}  // namespace

void AddReportOptions(OptionSet* set, ReportOptions* options) {
  set->AddChoice("from", &options->from, StagesWithMaps(ReadsMaps::kWhole),
                 "stage whose maps to show");
  set->AddRange(
      "picture-px", &options->picture_px, 64, 4096,
      "longest side of the map images, in pixels; photographs are shown at half that size");
  set->AddRange("viewer-px", &options->viewer_px, 16, 4096,
                "longest side of the maps that the page's viewer relights");
}

std::vector<fs::path> ReportManifests(const fs::path& work, const std::string& from) {
  std::vector<fs::path> files;
  for (const std::string& stage : StagesRead(from)) {
    const fs::path file = work / stage / "manifest.json";
    if (fs::exists(file)) files.push_back(file);
  }
  return files;
}

ReportInput ReadReportInput(const fs::path& work, const std::string& from, int most_side) {
  ReportInput input;
  input.work = work;
  for (const std::string& stage : StagesRead(from)) {
    const fs::path file = work / stage / "manifest.json";
    const bool needed = file == ViewsManifest(work) || stage == from;
    if (!needed && !fs::exists(file)) continue;
    const Manifest manifest = ReadManifest(file, stage);
    VerifyOutputs(file, manifest);
    input.manifests.emplace(stage, manifest);
  }
  input.set = ReadRectifiedSet(ViewsManifest(work));
  input.fit = ReadFittedMaps(work / from / "manifest.json", most_side);
  input.shown = input.set;
  SamplePlane& plane = input.shown.plane;
  std::tie(plane.width, plane.height) = SizeAtMost(plane.width, plane.height, most_side);
  input.used_views = UsedViews(input.manifests.at(from), input.set);
  return input;
}

Report MakeReport(const ReportInput& input, const ReportOptions& options, int threads) {
  Report report;
  report.metrics = Json::object();
  const std::vector<ShownView> shown = ShowViews(input, options, threads);
  const std::string views = ViewsSection(input, shown, &report.metrics);
  std::string body = TitleSection(input);
  body += ViewerSection(input, options, shown, threads);
  body += MapsSection(input, options);
  body += DownloadsSection(input, options);
  body += TileSection(input, options);
  body += OverviewSection(input, report.metrics);
  body += GuidanceSection(input);
  std::string details = CorrectionsSection(input);
  details += views;
  details += GeometrySection(input);
  for (const std::string& stage : StagesShown(options.from)) {
    if (input.Has(stage)) details += StageSection(input, stage);
  }
  body += Folded("Photographs, cameras and every stage in detail", details);
  report.html = HtmlPage(MaterialName(input) + ": material report", body + ViewerScript());
  report.thumbnail_jpeg = ThumbnailJpeg(input.fit.maps, input.fit.convention);
  return report;
}

}  // namespace glint
