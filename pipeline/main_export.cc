// glint-export: maps as PNG files.
#include <algorithm>

#include "pipeline/contract/capture.h"
#include "pipeline/contract/files.h"
#include "pipeline/contract/program.h"
#include "pipeline/contract/svbrdf_file.h"
#include "pipeline/export/export_maps.h"
#include "pipeline/export/gltf_material.h"

namespace {

using namespace glint;

Json WriteHeight(const SvbrdfMaps& maps, const SamplePlane& plane, double longest, Stage* stage) {
  const double longest_mm = longest * std::min(plane.width_mm, plane.height_mm);
  std::array<double, 2> range_mm;
  const MapPicture picture = HeightPicture(IntegrateNormals(maps, plane, longest_mm), &range_mm);
  WritePng(stage->Output("16bit/height.png"), picture.image, 16);
  return {{"file", "16bit/height.png"},
          {"map", "height"},
          {"encoding", picture.encoding},
          {"bits", 16},
          {"range_mm", range_mm}};
}

std::string WriteGltf(const Capture& capture, const SvbrdfMaps& maps,
                      const ReflectanceConvention& convention, Stage* stage) {
  // Not the folder's name: a capture that is moved keeps its bytes.
  const GltfMaterial material{"material", capture.sample_size_mm[0], capture.sample_size_mm[1]};
  WriteFileAtomically(stage->Output("material.glb"), GlbOf(material, maps, convention));
  return "material.glb";
}

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
  const SamplePlane plane{maps.width, maps.height, capture.sample_size_mm[0],
                          capture.sample_size_mm[1], convention.sampling};
  Json files = WriteMapPictures(MapPictures(maps, *options), *options, &stage);
  if (options->height) files.push_back(WriteHeight(maps, plane, options->height_longest, &stage));
  Json data = {{"convention", ToString(convention)}, {"maps", files}};
  if (options->gltf) data["gltf"] = WriteGltf(capture, maps, convention, &stage);
  stage.Commit(data, Json::object());
  return {"export: " + std::to_string(files.size()) + " PNG files" +
              (options->gltf ? " and " + data["gltf"].get<std::string>() : "") + " in " +
              stage.folder().string(),
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
      {"glint-export", "Writes the maps of fit or refine as PNG files and as a glTF material.",
       GLINT_VERSION, "Example: glint export wood --normal-y=- --metallic"},
      &set, [&](const CommonOptions& common) { return Export(folder, &set, &options, common); });
}
