// From diffuse and specular albedo to base colour and metalness, for programs that know only those.
#pragma once

#include <array>

namespace glint {

inline constexpr double kDielectricF0 = 0.04;

struct BaseColorMetallic {
  std::array<float, 3> base_color{0, 0, 0};  // linear
  float metallic = 0;
};

// The conversion of glTF's KHR_materials_pbrSpecularGlossiness (Khronos, example
// convert-between-workflows): metalness solves  diffuse·(1 − max(specular)) and specular  as a
// blend of a dielectric of F0 = 0.04 and a metal, in perceived brightness; base colour blends what
// either lobe says of it. Exact for what a metal-roughness material can be, a compromise for the
// rest.
BaseColorMetallic ToBaseColorMetallic(const std::array<float, 3>& diffuse,
                                      const std::array<float, 3>& specular);

}  // namespace glint
