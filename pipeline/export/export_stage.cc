#include "pipeline/export/export_stage.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/images/exr_rows.h"
#include "base/programs/progress.h"
#include "base/resampling/resampling.h"
#include "fitting/relief/ambient_occlusion.h"
#include "fitting/relief/height_field.h"
#include "pipeline/export/material_rows.h"

namespace glint {
namespace {

// Of a map that is written at a time; some 350 bytes each are in memory.
constexpr int kTexelsAtOnce = 2 << 20;

// Where each map's picture lies: the 8-bit one where there are both.
std::string FileOfMap(const Json& files, const std::string& map) {
  for (const Json& entry : files) {
    if (entry["map"] == map) return entry["file"].get<std::string>();
  }
  throw std::logic_error("no picture of " + map);
}

// Writes the material files; data.materials, data.metal_roughness.
std::pair<Json, Json> WriteMaterials(const ExportedMaterial& material,
                                     const std::vector<MaterialFormat>& formats, const Json& maps,
                                     int threads, Stage* stage) {
  const auto file_of = [&](const std::string& map) { return FileOfMap(maps, map); };
  std::vector<Shading> shadings = {MetalRoughnessShading(material.metal, material.maps)};
  for (const MaterialFormat& format : formats) {
    shadings.push_back([&](size_t texel, const DirectionPair& pair) {
      return format.brdf(material, texel, pair);
    });
  }
  const std::vector<double> errors =
      ShadingErrors(material.maps, material.convention, shadings, threads);
  Json files = Json::array();
  for (size_t i = 0; i < formats.size(); ++i) {
    const std::string file = material.name + formats[i].suffix;
    WriteFileAtomically(stage->Output(file), formats[i].write(material, file_of, threads));
    files.push_back({{"file", file}, {"format", formats[i].name}, {"log_l1", errors[i + 1]}});
  }
  return {files, {{"log_l1", errors[0]}}};
}

// Of the normals, from the confidence that is stated beside the maps; empty where none is.
std::vector<float> TrustOf(const std::filesystem::path& maps_manifest, const MaterialRows& source,
                           const SvbrdfMaps& maps) {
  const auto file = maps_manifest.parent_path() / "confidence.exr";
  if (!std::filesystem::exists(file)) return {};
  const ImageHeader header = ReadExrHeader(file);
  if (header.width != source.width() || header.height != source.height()) {
    throw UserError(file, "normal.X, normal.Y", "deviations that do not belong to these maps",
                    "run glint-refine again");
  }
  const Image confidence = ReadExrAveraged(file, {"normal.X", "normal.Y"}, maps.width, maps.height);
  return TrustOfNormals(confidence.channel(0), confidence.channel(1));
}

// Rows of a plane that is made larger, or has that size.
class EnlargedRows {
 public:
  EnlargedRows(const std::vector<float>& plane, int width, int height, int to_width, int to_height)
      : plane_(plane),
        width_(width),
        height_(height),
        across_(TentTaps(width, to_width)),
        down_(TentTaps(height, to_height)) {}
  std::vector<float> Rows(int first, int count) const {
    if (static_cast<int>(across_.size()) == width_ && static_cast<int>(down_.size()) == height_) {
      return CutRows(plane_, width_, height_, first, count);
    }
    const auto down =
        std::span(down_).subspan(static_cast<size_t>(first), static_cast<size_t>(count));
    const TapGroup group = GroupTaps(down, height_).front();
    return ResamplePlanes(CutRows(plane_, width_, height_, group.first_input, group.inputs), width_,
                          group.inputs, across_, group.taps);
  }

 private:
  const std::vector<float>& plane_;
  int width_, height_;
  std::vector<Taps> across_, down_;
};

// Base colour and metalness by rows, with the neighbours that they depend on.
class MetalRows {
 public:
  MetalRows(const ReflectanceConvention& convention, const MetalRoughnessOptions& options,
            int threads)
      : converter_(convention, options, threads), radius_(options.radius) {}
  // `rows_of`: maps of rows; `height`: of them all. Also gives the maps of these rows.
  template <class RowsOfMaps>
  std::pair<SvbrdfMaps, MetalRoughness> Rows(const RowsOfMaps& rows_of, int height, int first,
                                             int count) {
    const int above = std::min(first, radius_), below = std::min(height - first - count, radius_);
    SvbrdfMaps maps = rows_of(first - above, above + count + below);
    MetalRoughness metal = converter_.Convert(maps, above, below);
    maps.planes = CutRows(maps.planes, maps.width, maps.height, above, count);
    maps.height = count;
    return {std::move(maps), std::move(metal)};
  }

 private:
  MetalConverter converter_;
  int radius_;
};

int RowsAtOnce(int width) { return std::max(16, kTexelsAtOnce / width); }

// Base colour and metalness of maps in memory.
MetalRoughness MetalOf(const SvbrdfMaps& maps, MetalRows* rows) {
  MetalRoughness all{maps.width, maps.height, std::vector<float>(3 * maps.texels()),
                     std::vector<float>(maps.texels())};
  const auto part_of = [&](int first, int count) {
    SvbrdfMaps part(maps.width, count);
    part.planes = CutRows(maps.planes, maps.width, maps.height, first, count);
    return part;
  };
  const int at_once = RowsAtOnce(maps.width);
  for (int first = 0; first < maps.height; first += at_once) {
    const int count = std::min(at_once, maps.height - first);
    const MetalRoughness part = rows->Rows(part_of, maps.height, first, count).second;
    PutRows(part.metallic, maps.width, maps.height, first, all.metallic);
    PutRows(part.base_color, maps.width, maps.height, first, all.base_color);
  }
  return all;
}

// The pictures of rows of the whole material.
Json WriteMapsByRows(const ExportedMaterial& whole, const HeightField& relief,
                     const std::vector<float>& occlusion, const ExportOptions& options,
                     int rows_at_once, int threads, MaterialRows* source, MetalRows* metal,
                     Stage* stage) {
  const int width = source->width(), height = source->height();
  const bool at_hand = whole.maps.width == width && whole.maps.height == height;
  const EnlargedRows heights(relief.height_mm, relief.width, relief.height, width, height);
  const EnlargedRows occlusions(occlusion, relief.width, relief.height, width, height);
  MapFiles files(whole, width, height, options, stage);
  Progress progress("export", height);
  const int at_once = rows_at_once > 0 ? rows_at_once : RowsAtOnce(width);
  for (int first = 0; first < height; first += at_once) {
    const int count = std::min(at_once, height - first);
    ExportedMaterial rows{whole.name,      {}, whole.convention,     whole.width_mm,
                          whole.height_mm, {}, whole.height_range_mm};
    if (at_hand) {
      rows.maps = SvbrdfMaps(width, count);
      rows.maps.planes = CutRows(whole.maps.planes, width, height, first, count);
      rows.metal = {width, count, CutRows(whole.metal.base_color, width, height, first, count),
                    CutRows(whole.metal.metallic, width, height, first, count)};
    } else {
      std::tie(rows.maps, rows.metal) =
          metal->Rows([&](int from, int n) { return source->Rows(from, n); }, height, first, count);
    }
    HeightField part{width, count, 0, 0, heights.Rows(first, count)};
    files.Write(MapPictures(rows, part, occlusions.Rows(first, count)), threads);
    progress.Set(first + count);
  }
  return files.Close();
}

}  // namespace

Json ExportMaterial(const ExportTask& task, const ExportOptions& options,
                    const std::vector<MaterialFormat>& formats, int threads, Stage* stage) {
  MaterialRows source(task.maps_manifest.parent_path() / "svbrdf.exr",
                      task.repeats ? 0 : options.border);
  const ReflectanceConvention& convention = source.convention();
  const auto [width, height] = SizeAtMost(source.width(), source.height(), options.material_size);
  ExportedMaterial material;
  material.name = options.name;
  material.maps = source.AtSize(width, height);
  material.convention = convention;
  material.width_mm = task.size_mm[0];
  material.height_mm = task.size_mm[1];
  MetalRoughnessOptions metal_options = options.metal;
  metal_options.metal_share = MetalShareOf(task.metals);
  MetalRows metal(material.convention, metal_options, threads);
  material.metal = MetalOf(material.maps, &metal);

  const SamplePlane plane{width, height, task.size_mm[0], task.size_mm[1], convention.sampling};
  const double shorter_mm = std::min(plane.width_mm, plane.height_mm);
  const double longest_mm = options.height_longest * shorter_mm;
  const HeightField relief =
      task.repeats ? IntegrateRepeatingNormals(material.maps, plane, longest_mm)
                   : IntegrateNormals(material.maps, plane, longest_mm,
                                      TrustOf(task.maps_manifest, source, material.maps), threads);
  material.height_range_mm = HeightRange(relief);
  OcclusionOptions occlusion;
  occlusion.reach_mm = options.occlusion_reach * shorter_mm;
  const Json files = WriteMapsByRows(material, relief, AmbientOcclusion(relief, occlusion, threads),
                                     options, task.rows_at_once, threads, &source, &metal, stage);
  const auto [materials, metal_roughness] =
      WriteMaterials(material, formats, files, threads, stage);
  return {{"convention", ToString(convention)},
          {"name", material.name},
          {"size_mm", task.size_mm},
          {"repeats", task.repeats},
          {"maps", files},
          {"metal_roughness", metal_roughness},
          {"materials", materials}};
}

}  // namespace glint
