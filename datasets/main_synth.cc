// glint-synth: synthetic materials, phone captures and rectified views.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/errors/errors.h"
#include "base/formats/board_file.h"
#include "base/formats/svbrdf_file.h"
#include "base/images/image.h"
#include "base/programs/verbs.h"
#include "datasets/material_pack/material_pack.h"
#include "datasets/procedural/material.h"
#include "datasets/statistics/comparison_files.h"
#include "datasets/synth/capture_writer.h"
#include "datasets/synth/dome_writer.h"
#include "datasets/synth/material_source.h"
#include "datasets/synth/view_set.h"

namespace {

using namespace glint;
namespace fs = std::filesystem;

std::array<double, 3> Triple(const std::vector<double>& numbers, const std::string& option) {
  if (numbers.size() != 3) {
    throw UserError(
        fmt::format("{}: found {} numbers; give three, as in 10,0,0", option, numbers.size()));
  }
  return {numbers[0], numbers[1], numbers[2]};
}

// "25@90": 25° from the normal, toward +y.
std::vector<CameraDirection> Directions(const std::vector<std::string>& words) {
  std::vector<CameraDirection> directions;
  for (const std::string& word : words) {
    CameraDirection& direction = directions.emplace_back();
    int end = 0;
    const int read =
        std::sscanf(word.c_str(), "%lf@%lf%n", &direction.tilt_deg, &direction.azimuth_deg, &end);
    if (read != 2 || static_cast<size_t>(end) != word.size()) {
      throw UserError("directions: found " + word + "; give tilt and azimuth, as in 25@90");
    }
  }
  return directions;
}

// Where maps come from, for all verbs: a file, or the generator at --family and --seed.
struct MaterialChoice {
  fs::path maps;
  std::string family;

  void AddTo(OptionSet* options) {
    options->Add("maps", &maps,
                 "svbrdf.exr, strip or folder of maps to use instead of generating them");
    options->Add("family", &family,
                 "family of the procedural material; if omitted, the seed determines it");
  }
  MaterialSource Load(std::uint64_t seed, int size) const {
    if (!maps.empty()) return LoadMaterial(maps.string(), size);
    const std::string which = family.empty() ? "" : family + ":";
    return LoadMaterial("procedural:" + which + std::to_string(seed), size);
  }
};

// Normal, diffuse, specular and roughness side by side, as a person looks at maps: colours in gamma
// 2.2, the others as they are.
void WritePreview(const fs::path& file, const SvbrdfMaps& maps) {
  Image image(4 * maps.width, maps.height, {"R", "G", "B"});
  const auto display = [](float v) { return std::pow(std::clamp(v, 0.0f, 1.0f), 1 / 2.2f); };
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < maps.height; ++y) {
      float* row = image.channel(c).data() + static_cast<size_t>(y) * image.width;
      for (int x = 0; x < maps.width; ++x) {
        row[x] = 0.5f * maps.at(kNormalX + c, y, x) + 0.5f;
        row[maps.width + x] = display(maps.at(kDiffuseR + c, y, x));
        row[2 * maps.width + x] = display(maps.at(kSpecularR + c, y, x));
        row[3 * maps.width + x] = maps.at(kRoughness, y, x);
      }
    }
  }
  WritePng(file, image);
}

ProgramResult ListFamilies() {
  ProgramResult result;
  result.json = Json::array();
  for (const auto& family : MaterialFamilies()) {
    result.text += std::string(family) + "\n";
    result.json.push_back(family);
  }
  return result;
}

int RunMaterial(int argc, char** argv, const ProgramInfo& info) {
  MaterialChoice choice;
  int size = 512;
  bool list = false, png = false;
  fs::path out;
  OptionSet options;
  options.AddPositional("out", &out, "file (….exr) or folder to write svbrdf.exr into", false);
  choice.AddTo(&options);
  options.AddRange("size", &size, 8, 8192, "texels per side");
  options.Add("png", &png, "also write a preview: normal, diffuse, specular, roughness");
  options.Add("list", &list, "list the families and do nothing else");
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    if (list) return ListFamilies();
    if (out.empty()) throw UserError("out: found nothing; name a file or folder to write to");
    const bool names_file = out.extension() == ".exr";
    const fs::path file = names_file ? out : out / "svbrdf.exr";
    const MaterialSource material = choice.Load(common.seed, size);
    if (!file.parent_path().empty()) fs::create_directories(file.parent_path());
    WriteSvbrdf(file, material.maps, ReflectanceConvention::Photograph());
    if (png) WritePreview(fs::path(file).replace_extension(".png"), material.maps);
    return ProgramResult{fmt::format("{}: {}, {} x {}", file.string(), material.name,
                                     material.maps.width, material.maps.height),
                         {{"file", file.string()}, {"material", material.name}}};
  });
}

// Folders of materials: themselves, or those inside, by name.
std::vector<fs::path> MaterialFolders(const std::vector<std::string>& given) {
  std::vector<fs::path> folders;
  for (const fs::path path : given) {
    std::vector<fs::path> inside;
    if (fs::is_directory(path)) {
      for (const auto& entry : fs::directory_iterator(path)) {
        if (entry.is_directory()) inside.push_back(entry.path());
      }
    }
    std::sort(inside.begin(), inside.end());
    if (inside.empty()) inside.push_back(path);
    folders.insert(folders.end(), inside.begin(), inside.end());
  }
  return folders;
}

int RunPack(int argc, char** argv, const ProgramInfo& info) {
  std::vector<std::string> given;
  fs::path out;
  int size = 512;
  OptionSet options;
  options.AddPositional("materials", &given,
                        "folders of maps, or folders that contain such folders", true);
  options.Add("out", &out, "pack to write, ….safetensors (required)");
  options.AddRange("size", &size, 8, 8192, "texels per side");
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions&) {
    if (out.empty()) throw UserError("out: found nothing; name a file to write");
    MaterialPack pack;
    for (const fs::path& folder : MaterialFolders(given)) {
      const MaterialSource material = LoadMaterial(folder.string(), size);
      pack.push_back(PackMaterial(material.name, material.maps));
    }
    WriteMaterialPack(out, pack);
    return ProgramResult{
        fmt::format("{}: {} materials of {} x {}", out.string(), pack.size(), size, size),
        {{"file", out.string()}, {"materials", pack.size()}, {"size", size}}};
  });
}

int RunCapture(int argc, char** argv, const ProgramInfo& info) {
  MaterialChoice choice;
  SyntheticCaptureOptions capture;
  CapturePlanOptions& plan = capture.plan;
  int texels = 1024;
  std::vector<double> distance_mm;
  std::vector<std::string> directions;
  std::vector<double> flash_mm(plan.flash_offset_mm.begin(), plan.flash_offset_mm.end());
  std::vector<double> tint(plan.flash_tint.begin(), plan.flash_tint.end());
  std::string board;
  fs::path out;
  OptionSet options;
  options.AddPositional("out", &out, "folder of the new capture", true);
  choice.AddTo(&options);
  options.Add("board", &board,
              "board.json of the board around the sample (default: a frame on A4), or none: a "
              "patterned table, for --poses colmap");
  options.AddRange("photos", &plan.photos, 1, 1000,
                   "number of photographs; the first is roughly a top view");
  options.AddRange("megapixels", &plan.megapixels, 0.05, 60, "size of a photograph, 4:3");
  options.AddRange("sample-mm", &plan.sample_mm, 10, 1000, "side of the square sample");
  options.AddRange("texels", &texels, 16, 8192, "texels per side of a procedural material");
  options.Add("distance-mm", &distance_mm,
              "camera's distance: nearest,farthest (default: 270,330 for a sample of 100 mm and "
              "for your own boards; in proportion to --sample-mm otherwise)");
  options.AddRange("tilt-deg", &plan.largest_tilt_deg, 0, 65, "largest tilt of the later views");
  options.Add(
      "directions", &directions,
      "where the photographs are taken from, tilt and azimuth (from the right over the top) "
      "in degrees: 0@0,25@90,… (default: drawn, --photos of them)");
  options.Add("flash-offset-mm", &flash_mm,
              "flash position in the camera frame: right,down,forward");
  options.Add("flash-tint", &tint, "colour of the flash: r,g,b in (0, 1]");
  options.AddRange("ambient", &plan.ambient, 0, 10, "ambient illumination relative to the flash");
  options.AddRange("vignetting", &plan.vignetting, 0, 0.8,
                   "fraction of the light lost in the picture's corners");
  options.AddRange("exposure-ev", &plan.exposure_ev, 0, 4,
                   "exposures spread over ± this many stops");
  options.AddRange("exif-error", &plan.exif_error, 0, 0.5,
                   "relative error (standard deviation) of the exposures recorded in EXIF");
  options.AddRange("jpeg-quality", &capture.jpeg_quality, 1, 100,
                   "JPEG quality of .jpg photographs");
  options.Add("tell-flash", &capture.tell_flash,
              "write the flash's offset into capture.toml; --no-tell-flash: leave it out");
  options.AddRange("paper-level", &plan.paper_level, 1e-3, 4,
                   "radiance of the paper at its brightest point; the sensor clips at 1");
  options.AddRange("noise", &capture.noise.scale, 0, 100, "sensor noise; 0: none, 1: a phone's");
  options.AddRange(
      "lens-blur-px", &capture.lens_blur_px, 0, kMostBlur_px,
      "standard deviation of the lens's point-spread function; 0: only the pixel's own box filter");
  options.AddChoice("format", &capture.format, {"jpg", "png", "exr"},
                    "file format of the photographs; exr: linear float, not clipped");
  options.AddChoice("encoding", &capture.encoding, {"gamma2.2", "srgb", "linear"},
                    "tone curve of 8-bit photographs");
  options.AddRange("resolution", &capture.resolution_px, 8, 8192,
                   "value of resolution_px in capture.toml");
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    if (!distance_mm.empty() && distance_mm.size() != 2) {
      throw UserError("distance-mm: give two numbers, as in 270,330");
    }
    plan.has_board = board != "none";
    if (plan.has_board && !board.empty()) plan.board = ReadBoardFile(board).board;
    plan.seed = common.seed;
    plan.directions = Directions(directions);
    if (!plan.directions.empty()) plan.photos = static_cast<int>(plan.directions.size());
    capture.overwrite = common.force;
    if (!distance_mm.empty()) {
      plan.nearest_mm = distance_mm[0];
      plan.farthest_mm = distance_mm[1];
    } else if (!plan.board) {  // the frame is as large as the sample asks for
      plan.nearest_mm *= plan.sample_mm / 100;
      plan.farthest_mm *= plan.sample_mm / 100;
    }
    plan.flash_offset_mm = Triple(flash_mm, "flash-offset-mm");
    plan.flash_tint = Triple(tint, "flash-tint");
    const MaterialSource material = choice.Load(common.seed, choice.maps.empty() ? texels : 0);
    const SyntheticCaptureSummary summary =
        WriteSyntheticCapture(out, material, capture, common.threads);
    return ProgramResult{
        fmt::format("{}: {}\n{}", out.string(), material.name, summary.BriefReport()),
        {{"folder", out.string()},
         {"material", material.name},
         {"photos", summary.photos},
         {"width_px", summary.width_px},
         {"height_px", summary.height_px},
         {"clipped_share", summary.clipped_share}}};
  });
}

int RunViews(int argc, char** argv, const ProgramInfo& info) {
  ViewSetOptions views;
  int resolution = 256;
  std::string maps;
  fs::path out;
  OptionSet options;
  options.AddPositional("maps", &maps, "maps, or procedural:SEED, or procedural:FAMILY:SEED", true);
  options.AddPositional("out", &out, "folder of the new capture", true);
  AddViewSetOptions(&views, &options);
  options.AddRange("resolution", &resolution, 8, 4096, "texels per side");
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    const MaterialSource material = LoadMaterial(maps, resolution);
    WriteViewSet(out, material, views, common);
    return ProgramResult{
        fmt::format("{}: {} views of {}", out.string(), views.count, material.name),
        {{"folder", out.string()}, {"material", material.name}, {"views", views.count}}};
  });
}

int RunDome(int argc, char** argv, const ProgramInfo& info) {
  MaterialChoice choice;
  DomeOptions dome;
  int texels = 256;
  fs::path out;
  OptionSet options;
  options.AddPositional("out", &out, "new folder for photographs and dirs.lp", true);
  choice.AddTo(&options);
  options.AddRange("texels", &texels, 16, 4096,
                   "side of the pictures and of the maps, in pixels and texels");
  options.AddRange("lights", &dome.lights, 1, 1000, "number of lamps, and of photographs");
  options.AddRange("lowest-deg", &dome.lowest_deg, 1, 89, "elevation of the lowest lamp");
  options.AddRange("highest-deg", &dome.highest_deg, 1, 90, "elevation of the highest lamp");
  options.AddRange("sample-mm", &dome.sample_mm, 1, 10000, "side of the square sample");
  options.AddRange(
      "distance-mm", &dome.distance_mm, 0, 1e6,
      "distance of the lamps from the sample's centre; 0: ten times the sample's side");
  options.AddRange("uneven", &dome.uneven, 0, 2,
                   "standard deviation of the logarithm of the lamps' intensities");
  options.AddRange(
      "lamp-colours", &dome.colours, 0, 1,
      "standard deviation of the logarithms of the lamps' red/green and blue/green ratios");
  options.AddRange(
      "jitter-deg", &dome.jitter_deg, 0, 30,
      "standard deviation of the error of the directions in dirs.lp, in each of two components");
  options.Add("shadows", &dome.shadows, "render the shadows that the relief casts");
  options.AddRange("blur-px", &dome.blur_px, 0, 10,
                   "standard deviation of the point-spread function of lens and pixel");
  options.AddRange("noise", &dome.noise.scale, 0, 100, "sensor noise; 0: none, 1: a phone's");
  options.AddChoice("format", &dome.format, {"png", "jpg"}, "file format of the photographs");
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    const auto seed = static_cast<std::uint64_t>(common.seed);
    const MaterialSource material = choice.Load(seed, texels);
    WriteDome(out, material, dome, seed, common.threads);
    return ProgramResult{
        fmt::format("{}: {} photographs of {}", out.string(), dome.lights, material.name),
        {{"folder", out.string()}, {"material", material.name}, {"lights", dome.lights}}};
  });
}

int RunStatistics(int argc, char** argv, const ProgramInfo& info) {
  std::vector<std::string> materials;
  std::string family;
  fs::path out;
  int seeds = 200, first = 0, size = 256;
  OptionSet options;
  options.AddPositional("materials", &materials,
                        "real maps to compare with, or folders that contain folders of maps", true);
  options.Add("out", &out, "folder for statistics.json, .csv and .png");
  options.Add("family", &family,
              "compare only this procedural family; if omitted, families are chosen at random");
  options.AddRange("seeds", &seeds, 1, 100000, "number of procedural materials");
  options.AddRange("first-seed", &first, 0, 2e9, "seed of the first one");
  options.AddRange("size", &size, 8, 2048, "texels per side, a power of two");
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    if (out.empty()) throw UserError("out: found nothing; name a folder to write to");
    const auto seed = static_cast<std::uint64_t>(first);
    const Comparison comparison =
        Compare(MeasureMaterials("real", FindMaterials(materials), size, common.threads),
                MeasureMaterials("generated", ProceduralMaterials(family, seed, seeds), size,
                                 common.threads));
    WriteComparison(out, comparison);
    return ProgramResult{comparison.BriefReport(), ComparisonJson(comparison)};
  });
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<Verb> verbs = {
      {"material", "Makes the maps of a procedural material, or converts maps to svbrdf.exr.",
       "Example: glint-synth material --family wood --seed 7 --size 1024 --png wood/", RunMaterial},
      {"capture",
       "Renders a phone's flash photographs of a printed board frame with a sample in its window.",
       "Example: glint-synth capture demo --seed 3 --megapixels 3\n"
       "Then: glint run demo; glint-eval cameras demo/truth demo/glint/calib/manifest.json",
       RunCapture},
      {"pack", "Packs folders of maps into one file that glint-train mixes into its training data.",
       "Example: glint-synth pack materials/train --out materials.safetensors", RunPack},
      {"views", "Renders rectified views from maps: a capture whose rectify stage is already done.",
       "Example: glint-synth views procedural:7 set --count 5 && glint-fit set", RunViews},
      {"dome",
       "Renders photographs taken by a fixed camera under the lamps of a dome or under a hand-held "
       "lamp, with their dirs.lp.",
       "Example: glint-synth dome icon --family wood --lights 60 --uneven 0.2\n"
       "Then: glint init icon --lights icon/dirs.lp --width-mm 100 && glint run icon",
       RunDome},
      {"statistics",
       "Compares the statistics of procedural materials with those of real ones: histograms, power "
       "spectra, correlations and variation across materials, and the distance between the two in "
       "each.",
       "Example: glint-synth statistics data/materials/train --out statistics", RunStatistics}};
  return RunVerb(
      argc, argv,
      {"glint-synth", "Makes synthetic materials, captures and views, with their ground truth.",
       GLINT_VERSION, ""},
      verbs);
}
