// glint-export: the material for other programs.
#include <fmt/format.h>

#include "base/errors/errors.h"
#include "base/formats/capture.h"
#include "base/programs/cost_model.h"
#include "base/programs/program.h"
#include "pipeline/export/export_stage.h"

namespace {

using namespace glint;

// Of the maps: the sample's, or the piece's that repeats.
std::array<double, 2> SizeOf(const Capture& capture, const Manifest& manifest,
                             const std::filesystem::path& file) {
  if (manifest.stage != "tile") return capture.sample_size_mm;
  const auto size = manifest.data.value("size_mm", std::vector<double>());
  if (size.size() != 2 || !(size[0] > 0) || !(size[1] > 0)) {
    throw UserError(file, "data.size_mm", "something other than two lengths",
                    "run glint tile again");
  }
  return {size[0], size[1]};
}

ProgramResult Export(const std::filesystem::path& folder, OptionSet* set, ExportOptions* options,
                     const CommonOptions& common) {
  const Capture capture = ReadCapture(folder);
  set->LoadToml(capture.file, "export");
  if (options->name != FileNameOf(options->name)) {
    throw UserError(capture.file, "export.name", "'" + options->name + "'",
                    "use letters, digits, '-', '_' and '.', beginning with a letter or digit");
  }
  const std::vector<MaterialFormat> formats = ChosenFormats(options->formats);
  const auto source = capture.work() / options->from / "manifest.json";
  if (!std::filesystem::exists(source)) {
    throw UserError(source, "", "no such file",
                    "run first: glint " + options->from + " " + folder.string());
  }
  const Manifest manifest = ReadManifest(source, options->from);
  Stage stage(capture.work() / "export", {"export", kExportVersion}, *set, common, {source});
  if (stage.UpToDate()) {
    return stage.UpToDateResult();
  }
  RequireMemoryForStage("export", capture, SizeOfMaps(capture), common.threads);
  VerifyOutputs(source, manifest);
  ExportTask task{source, SizeOf(capture, manifest, source), manifest.stage == "tile"};
  task.metals = MetalsOf(source, manifest);
  const Json data = ExportMaterial(task, *options, formats, common.threads, &stage);
  stage.Commit(data, Json::object());
  const Json &files = data["maps"], &materials = data["materials"];
  return {"export: " + std::to_string(files.size()) + " map files and " +
              std::to_string(materials.size()) + " material files in " + stage.folder().string(),
          {{"stage", "export"}, {"up_to_date", false}, {"maps", files}, {"materials", materials}},
          fmt::format("{} maps, {} material files", files.size(), materials.size())};
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
      {"glint-export",
       "Exports the material for other programs: maps as PNG files, named as those programs "
       "expect, and complete materials for glTF, MaterialX, USD and Blender.",
       GLINT_VERSION, "Example: glint export wood --bits both --formats gltf,blender"},
      &set, [&](const CommonOptions& common) { return Export(folder, &set, &options, common); });
}
