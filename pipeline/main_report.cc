// glint-report: one HTML page showing the whole result.
#include "base/files/files.h"
#include "base/formats/capture.h"
#include "base/programs/cost_model.h"
#include "base/programs/program.h"
#include "base/programs/stage.h"
#include "pipeline/report/report.h"

namespace {

using namespace glint;

ProgramResult WriteReport(const std::filesystem::path& folder, OptionSet* set,
                          ReportOptions* options, const CommonOptions& common) {
  const Capture capture = ReadCapture(folder);
  set->LoadToml(capture.file, "report");
  Stage stage(capture.work() / "report", {"report", kReportVersion}, *set, common,
              ReportManifests(capture.work(), options->from));
  const std::string page = (capture.work() / "report" / "index.html").string();
  if (stage.UpToDate()) {
    return stage.UpToDateResult({{"page", page}});
  }
  RequireMemoryForStage("report", capture, SizeOfMaps(capture), common.threads);
  const ReportInput input = ReadReportInput(capture.work(), options->from);
  const Report report = MakeReport(input, *options, common.threads);
  WriteFileAtomically(stage.Output("index.html"), report.html);
  WriteFileAtomically(stage.Output("thumbnail.jpg"), report.thumbnail_jpeg);
  stage.Commit(Json::object(), report.metrics);
  return {"report: " + page,
          {{"stage", "report"}, {"up_to_date", false}, {"page", page}, {"metrics", report.metrics}},
          "page written"};
}

}  // namespace

int main(int argc, char** argv) {
  std::filesystem::path folder = ".";
  ReportOptions options;
  OptionSet set;
  set.AddPositional("CAPTURE", &folder, "folder of the capture", false);
  AddReportOptions(&set, &options);
  return RunProgram(
      argc, argv,
      {"glint-report",
       "Writes one HTML file with maps, photographs beside re-renderings, cameras, lights and the "
       "key numbers of every stage.",
       GLINT_VERSION, "Example: glint report wood --from fit"},
      &set,
      [&](const CommonOptions& common) { return WriteReport(folder, &set, &options, common); });
}
