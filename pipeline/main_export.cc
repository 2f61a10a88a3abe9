// glint-export: maps as PNG files.
#include "pipeline/contract/capture.h"
#include "pipeline/contract/program.h"
#include "pipeline/contract/svbrdf_file.h"
#include "pipeline/export/export_maps.h"

namespace {

using namespace glint;

ProgramResult Export(const std::filesystem::path& folder, OptionSet* set, ExportOptions* options,
                     const CommonOptions& common) {
  const Capture capture = ReadCapture(folder);
  set->LoadToml(capture.file, "export");
  const auto source = capture.work() / options->from / "manifest.json";
  const Manifest manifest = ReadManifest(source, options->from);
  Stage stage(capture.work() / "export", {"export", kExportVersion}, *set, common, {source});
  if (stage.UpToDate()) {
    return {stage.UpToDateText(), {{"stage", "export"}, {"up_to_date", true}}};
  }
  VerifyOutputs(source, manifest);
  ReflectanceConvention convention;
  const SvbrdfMaps maps = ReadSvbrdf(source.parent_path() / "svbrdf.exr", &convention);
  const Json files = WriteMapPictures(MapPictures(maps, *options), *options, &stage);
  stage.Commit({{"convention", ToString(convention)}, {"maps", files}}, Json::object());
  return {"export: " + std::to_string(files.size()) + " PNG files in " + stage.folder().string(),
          {{"stage", "export"}, {"up_to_date", false}, {"maps", files}}};
}

}  // namespace

int main(int argc, char** argv) {
  std::filesystem::path folder = ".";
  ExportOptions options;
  OptionSet set;
  set.AddPositional("CAPTURE", &folder, "folder of the capture", false);
  AddExportOptions(&set, &options);
  return RunProgram(
      argc, argv,
      {"glint-export", "Writes the maps of fit or refine as PNG files.", GLINT_VERSION,
       "Example: glint export wood --normal-y=- --metallic"},
      &set, [&](const CommonOptions& common) { return Export(folder, &set, &options, common); });
}
