// Maps as PNG files, for programs that read pictures.
//
//   normal      (n + 1)/2, OpenGL (+Y up) or DirectX (−Y)
//   diffuse     sRGB-encoded albedo          specular   sRGB-encoded F0
//   roughness   linear r (α = r²), grey
//   basecolor   sRGB-encoded                 metallic   linear, grey        (on request)
//   height      linear, grey, 16 bits alone; the manifest has the millimetres of 0 and 1
//
// 8-bit files lie in the stage's folder, 16-bit files in its folder 16bit/.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "fitting/reflectance/svbrdf_maps.h"
#include "fitting/relief/height_field.h"
#include "pipeline/contract/image.h"
#include "pipeline/contract/json.h"
#include "pipeline/contract/options.h"
#include "pipeline/contract/stage.h"

namespace glint {

inline constexpr int kExportVersion = 3;

struct ExportOptions {
  std::string from = "refine";  // stage whose maps are taken: refine, fit
  std::string bits = "both";    // 8, 16, both
  std::string normal_y = "+";   // "+": OpenGL, "-": DirectX
  bool metallic = false;        // base colour and metalness as well
  bool height = true;           // the relief that the normals say
  // Longest waves of the relief that are kept, of the sample's shorter side (height_field.h).
  double height_longest = 0.25;
  bool gltf = true;  // the material as NAME.glb (gltf_material.h)
};

void AddExportOptions(OptionSet* set, ExportOptions* options);

// A picture of one map with values in [0, 1] as the file stores them.
struct MapPicture {
  std::string name;      // "diffuse"
  std::string encoding;  // "sRGB", "linear", "normal +Y", "normal -Y"
  Image image;           // one or three channels
};

std::vector<MapPicture> MapPictures(const SvbrdfMaps& maps, const ExportOptions& options);

// Of the relief (fitting/relief), its lowest point 0 and its highest 1; `range_mm`: what these are.
MapPicture HeightPicture(const HeightField& field, std::array<double, 2>* range_mm);

// sRGB's transfer function (IEC 61966-2-1), of a value clamped to [0, 1].
float SrgbFromLinear(float linear);

// Writes the files as outputs of `stage`; returns the manifest's data.
Json WriteMapPictures(const std::vector<MapPicture>& pictures, const ExportOptions& options,
                      Stage* stage);

}  // namespace glint
