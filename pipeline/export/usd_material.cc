#include "pipeline/export/usd_material.h"

#include <fmt/format.h>
#include <cctype>

namespace glint {
namespace {

// Names of prims are identifiers.
std::string PrimName(const std::string& name) {
  std::string prim = name;
  for (char& c : prim) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  if (prim.empty() || std::isdigit(static_cast<unsigned char>(prim[0])) != 0) prim = "_" + prim;
  return prim;
}

struct Texture {
  const char* name;
  const char* map;
  const char* space;  // sourceColorSpace
  const char* output;
  const char* type;
  const char* extra;
};

constexpr Texture kTextures[] = {
    {"DiffuseTexture", "diffuse_layered", "sRGB", "rgb", "float3", ""},
    {"SpecularTexture", "specular", "sRGB", "rgb", "float3", ""},
    {"RoughnessTexture", "roughness", "raw", "r", "float", ""},
    {"NormalTexture", "normal_gl", "raw", "rgb", "float3",
     "                float4 inputs:bias = (-1, -1, -1, 0)\n"
     "                float4 inputs:scale = (2, 2, 2, 1)\n"},
};

std::string TextureText(const Texture& texture, const std::string& material,
                        const std::string& file, const std::string& extra) {
  return fmt::format(R"(
            def Shader "{}"
            {{
                uniform token info:id = "UsdUVTexture"
                asset inputs:file = @{}@
                token inputs:sourceColorSpace = "{}"
                float2 inputs:st.connect = <{}/Coordinates.outputs:result>
                token inputs:wrapS = "repeat"
                token inputs:wrapT = "repeat"
{}                {} outputs:{}
            }}
)",
                     texture.name, file, texture.space, material, extra, texture.type,
                     texture.output);
}

}  // namespace

std::string UsdOf(const ExportedMaterial& material,
                  const std::function<std::string(const std::string& map)>& file_of) {
  const std::string root = "/" + PrimName(material.name), shading = root + "/Material";
  const double x = material.width_mm / 2000, y = material.height_mm / 2000;
  std::string text = fmt::format(R"(#usda 1.0
(
    defaultPrim = "{0}"
    metersPerUnit = 1
    upAxis = "Y"
)

def Xform "{0}"
{{
    def Mesh "Plane" (
        prepend apiSchemas = ["MaterialBindingAPI"]
    )
    {{
        float3[] extent = [({1}, {2}, 0), ({3}, {4}, 0)]
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)] (
            interpolation = "vertex"
        )
        point3f[] points = [({1}, {2}, 0), ({3}, {2}, 0), ({3}, {4}, 0), ({1}, {4}, 0)]
        texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (
            interpolation = "vertex"
        )
        uniform token subdivisionScheme = "none"
        rel material:binding = <{5}>
    }}

    def Material "Material"
    {{
        token outputs:surface.connect = <{5}/Surface.outputs:surface>
        token outputs:displacement.connect = <{5}/Surface.outputs:displacement>

            def Shader "Surface"
            {{
                uniform token info:id = "UsdPreviewSurface"
                int inputs:useSpecularWorkflow = 1
                color3f inputs:diffuseColor.connect = <{5}/DiffuseTexture.outputs:rgb>
                color3f inputs:specularColor.connect = <{5}/SpecularTexture.outputs:rgb>
                float inputs:roughness.connect = <{5}/RoughnessTexture.outputs:r>
                normal3f inputs:normal.connect = <{5}/NormalTexture.outputs:rgb>
                float inputs:displacement.connect = <{5}/HeightTexture.outputs:r>
                token outputs:surface
                token outputs:displacement
            }}

            def Shader "Coordinates"
            {{
                uniform token info:id = "UsdPrimvarReader_float2"
                string inputs:varname = "st"
                float2 outputs:result
            }}
)",
                                 PrimName(material.name), -x, -y, x, y, shading);
  for (const Texture& texture : kTextures) {
    text += TextureText(texture, shading, file_of(texture.map), texture.extra);
  }
  const double low = material.height_range_mm[0] / 1000;
  const double range = (material.height_range_mm[1] - material.height_range_mm[0]) / 1000;
  const Texture height{"HeightTexture", "height", "raw", "r", "float", ""};
  text += TextureText(height, shading, file_of("height"),
                      fmt::format("                float4 inputs:bias = ({0}, {0}, {0}, 0)\n"
                                  "                float4 inputs:scale = ({1}, {1}, {1}, 1)\n",
                                  low, range));
  return text + "    }\n}\n";
}

}  // namespace glint
