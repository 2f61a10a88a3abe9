// glint-export: the material for other programs.
#include <fmt/format.h>

#include <algorithm>

#include "fitting/reflectance/border.h"
#include "fitting/relief/ambient_occlusion.h"
#include "fitting/relief/height_field.h"
#include "pipeline/contract/capture.h"
#include "pipeline/contract/cost_model.h"
#include "pipeline/contract/errors.h"
#include "pipeline/contract/files.h"
#include "pipeline/contract/image.h"
#include "pipeline/contract/program.h"
#include "pipeline/contract/svbrdf_file.h"
#include "pipeline/export/export_maps.h"
#include "pipeline/export/material_formats.h"

namespace {

using namespace glint;

// Where each map's picture lies: the 8-bit one where there are both.
std::string FileOfMap(const Json& files, const std::string& map) {
  for (const Json& entry : files) {
    if (entry["map"] == map) return entry["file"].get<std::string>();
  }
  throw std::logic_error("no picture of " + map);
}

// Writes the material files; data.materials.
Json WriteMaterials(const ExportedMaterial& material, const std::vector<MaterialFormat>& formats,
                    const Json& maps, Stage* stage) {
  const auto file_of = [&](const std::string& map) { return FileOfMap(maps, map); };
  Json files = Json::array();
  for (const MaterialFormat& format : formats) {
    const std::string file = material.name + format.suffix;
    WriteFileAtomically(stage->Output(file), format.write(material, file_of));
    const double error = ShadingError(material.maps, material.diffuse_weight,
                                      [&](size_t texel, const DirectionPair& pair) {
                                        return format.brdf(material, texel, pair);
                                      });
    files.push_back({{"file", file}, {"format", format.name}, {"log_l1", error}});
  }
  return files;
}

// Of the maps: the sample's, or the piece's that repeats.
std::array<double, 2> SizeOf(const Capture& capture, const Manifest& manifest,
                             const std::filesystem::path& file) {
  if (manifest.stage != "tile") return capture.sample_size_mm;
  const auto size = manifest.data.value("size_mm", std::vector<double>());
  if (size.size() != 2 || !(size[0] > 0) || !(size[1] > 0)) {
    throw UserError(file, "data.size_mm", "not two lengths", "run glint tile again");
  }
  return {size[0], size[1]};
}

ExportedMaterial MaterialOf(const std::array<double, 2>& size_mm, SvbrdfMaps maps,
                            const ReflectanceConvention& convention, const ExportOptions& options,
                            int threads) {
  ExportedMaterial material;
  material.name = options.name;
  material.maps = std::move(maps);
  material.diffuse_weight = convention.diffuse_weight;
  material.width_mm = size_mm[0];
  material.height_mm = size_mm[1];
  material.metal = ToMetalRoughness(material.maps, material.diffuse_weight, options.metal, threads);
  return material;
}

// Of the normals, from the confidence that is stated beside the maps; empty where none is.
std::vector<float> TrustOf(const std::filesystem::path& maps_manifest, const SvbrdfMaps& maps) {
  const auto file = maps_manifest.parent_path() / "confidence.exr";
  if (!std::filesystem::exists(file)) return {};
  const Image confidence = ReadExr(file);
  const int x = confidence.ChannelIndex("normal.X"), y = confidence.ChannelIndex("normal.Y");
  if (x < 0 || y < 0 || confidence.width != maps.width || confidence.height != maps.height) {
    throw UserError(file, "normal.X, normal.Y", "not the deviations of these maps",
                    "run glint-refine again");
  }
  return TrustOfNormals(confidence.channel(x), confidence.channel(y));
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
  RequireMemoryForStage("export", capture, common.threads);
  VerifyOutputs(source, manifest);
  ReflectanceConvention convention;
  SvbrdfMaps maps = ReadSvbrdf(source.parent_path() / "svbrdf.exr", &convention);
  const std::array<double, 2> size_mm = SizeOf(capture, manifest, source);
  const bool repeats = manifest.stage == "tile";
  if (!repeats) ContinueBorder(&maps, options->border);
  const SamplePlane plane{maps.width, maps.height, size_mm[0], size_mm[1], convention.sampling};
  const double shorter_mm = std::min(plane.width_mm, plane.height_mm);
  ExportedMaterial material =
      MaterialOf(size_mm, std::move(maps), convention, *options, common.threads);
  const double longest_mm = options->height_longest * shorter_mm;
  const HeightField relief =
      repeats ? IntegrateRepeatingNormals(material.maps, plane, longest_mm)
              : IntegrateNormals(material.maps, plane, longest_mm, TrustOf(source, material.maps));
  material.height_range_mm = HeightRange(relief);
  OcclusionOptions occlusion;
  occlusion.reach_mm = options->occlusion_reach * shorter_mm;
  const Json files = WriteMapPictures(
      material, MapPictures(material, relief, AmbientOcclusion(relief, occlusion, common.threads)),
      *options, common.threads, &stage);
  const Json materials = WriteMaterials(material, formats, files, &stage);
  const double error = MetalRoughnessError(material.metal, material.maps, material.diffuse_weight);
  stage.Commit({{"convention", ToString(convention)},
                {"name", material.name},
                {"size_mm", size_mm},
                {"repeats", repeats},
                {"maps", files},
                {"metal_roughness", {{"log_l1", error}}},
                {"materials", materials}},
               Json::object());
  return {"export: " + std::to_string(files.size()) + " PNG files and " +
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
       "Writes the material for other programs: maps as PNG files under the names they look for, "
       "and whole materials for glTF, MaterialX, USD and Blender.",
       GLINT_VERSION, "Example: glint export wood --bits both --formats gltf,blender"},
      &set, [&](const CommonOptions& common) { return Export(folder, &set, &options, common); });
}
