// Maps as PNG files under the names that other programs look for.
//
//   NAME_basecolor  sRGB     NAME_metallic   linear, grey    what a metal-roughness material has
//   NAME_roughness  linear r (α = r²), grey                  (metal_roughness.h)
//   NAME_normal_gl, NAME_normal_dx   (n + 1)/2, +Y up (OpenGL) and −Y up (DirectX)
//   NAME_height     linear, grey, 16 bits; the manifest has the millimetres of 0 and 1
//   NAME_ao         linear, grey: share of the sky that the relief leaves (ambient_occlusion.h)
//   NAME_orm        ao, roughness and metallic in red, green and blue
//   exact/NAME_diffuse, exact/NAME_specular   sRGB: albedo and F0 as they were fitted
//   exact/NAME_diffuse_layered                sRGB: albedo under a layer that lets 1 − F0 through,
//                                             for programs whose diffuse lobe is weighted so
//
// 8-bit files lie in the stage's folder, 16-bit ones beside them in its folder 16bit/, linear EXR
// files in exr/.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/files/files.h"
#include "base/files/json.h"
#include "base/images/image.h"
#include "base/programs/options.h"
#include "base/programs/stage.h"
#include "base/reflectance/svbrdf_maps.h"
#include "fitting/relief/height_field.h"
#include "pipeline/export/metal_roughness.h"

namespace glint {

inline constexpr int kExportVersion = 13;

struct ExportOptions {
  std::string name = "material";  // of the files; letters, digits, - _ .
  std::string from = "refine";    // stage whose maps are taken: refine, fit, tile
  std::string bits = "8";         // 8, 16, both, exr; the height has 16
  // Longest waves of the relief that are kept, of the sample's shorter side (height_field.h).
  double height_longest = 0.25;
  int border = 1;                  // rings of texels that mix with the sample's surroundings
  double occlusion_reach = 0.125;  // how far walls hide the sky, of the sample's shorter side
  // Height and occlusion are computed of the whole sample at once, and graphics cards take no
  // larger pictures than this in a .glb: texels along the longer side, at most.
  int material_size = 4096;
  MetalRoughnessOptions metal;
  std::vector<std::string> formats;  // of material files; empty: all (material_formats.h)
};

void AddExportOptions(OptionSet* set, ExportOptions* options);

// A picture of one map with values in [0, 1] as the file stores them.
struct MapPicture {
  std::string map;          // "basecolor"
  std::string encoding;     // "sRGB", "linear", "normal +Y", "normal -Y"
  Image image;              // one or three channels
  std::string folder = {};  // or "exact/"
  int bits = 0;             // 0: as the options say
};

// What other programs get of one material.
struct ExportedMaterial {
  std::string name;
  SvbrdfMaps maps;
  ReflectanceConvention convention = {};
  double width_mm = 0, height_mm = 0;
  MetalRoughness metal;
  std::array<double, 2> height_range_mm{0, 0};  // of 0 and 1 in the height map
};

// Linear, up to 1: diffuse_layered.
std::array<double, 3> LayeredDiffuse(const ExportedMaterial& material, size_t texel);

// All pictures, in the order of the list above.
std::vector<MapPicture> MapPictures(const ExportedMaterial& material, const HeightField& relief,
                                    const std::vector<float>& occlusion);

// Height above `range_mm[0]`, of its range.
MapPicture HeightPicture(const HeightField& field, const std::array<double, 2>& range_mm);
// Lowest and highest point.
std::array<double, 2> HeightRange(const HeightField& field);

// "exact/wood_diffuse.png", of the material's name and the picture.
std::string FileOf(const std::string& name, const MapPicture& picture);

// The files of the pictures, written by rows as outputs of `stage`.
class MapFiles {
 public:
  // `width`, `height`: of the whole maps. `material`: its name, size and range of heights.
  MapFiles(const ExportedMaterial& material, int width, int height, const ExportOptions& options,
           Stage* stage);
  ~MapFiles();
  // The next rows of every picture, from the top.
  void Write(const std::vector<MapPicture>& rows, int threads);
  // After the last row. The manifest's data.maps.
  Json Close();

 private:
  struct File;
  void Open(const std::vector<MapPicture>& pictures);
  const ExportedMaterial& material_;
  int width_, height_;
  const ExportOptions& options_;
  Stage* stage_;
  std::vector<File> files_;
  Json entries_ = Json::array();
};

// All rows at once.
Json WriteMapPictures(const ExportedMaterial& material, const std::vector<MapPicture>& pictures,
                      const ExportOptions& options, int threads, Stage* stage);

}  // namespace glint
