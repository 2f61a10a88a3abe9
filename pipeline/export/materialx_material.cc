#include "pipeline/export/materialx_material.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/reflectance/brdf.h"

namespace glint {
namespace {

std::string Input(const std::string& name, const std::string& type, const std::string& rest) {
  return "      <input name=\"" + name + "\" type=\"" + type + "\" " + rest + " />\n";
}

std::string Node(const std::string& category, const std::string& name, const std::string& type,
                 const std::string& inputs) {
  return "    <" + category + " name=\"" + name + "\" type=\"" + type + "\">\n" + inputs +
         "    </" + category + ">\n";
}

std::string From(const std::string& node) { return "nodename=\"" + node + "\""; }
std::string Value(const std::string& value) { return "value=\"" + value + "\""; }

std::string Picture(const std::string& name, const std::string& type, const std::string& file,
                    bool srgb) {
  const std::string space = srgb ? " colorspace=\"srgb_texture\"" : "";
  return Node("image", name, type, Input("file", "filename", Value(file) + space));
}

// The node "along": the direction in which lobes are wider.
std::string TurnedTangent(double direction_deg) {
  const double direction_rad = direction_deg * (std::numbers::pi / 180);
  const auto times = [](const std::string& of, double factor) {
    return Node("multiply", of + "_part", "vector3",
                Input("in1", "vector3", From(of)) +
                    Input("in2", "float", Value(fmt::format("{:.6g}", factor))));
  };
  return Node("tangent", "tangent", "vector3", Input("space", "string", Value("world"))) +
         Node("bitangent", "bitangent", "vector3", Input("space", "string", Value("world"))) +
         times("tangent", std::cos(direction_rad)) + times("bitangent", std::sin(direction_rad)) +
         Node("add", "along", "vector3",
              Input("in1", "vector3", From("tangent_part")) +
                  Input("in2", "vector3", From("bitangent_part")));
}

// The specular lobe `name` of the roughness map times `scale`, at most 1, with the F0 `f0`: a
// picture or a value; α is the roughness's square.
std::string Glossy(const std::string& name, double scale, const std::string& f0,
                   const Anisotropy& anisotropy) {
  std::string nodes;
  std::string roughness = "roughness", of = name == "glossy" ? "" : "_" + name;
  if (scale != 1) {
    nodes += Node("multiply", "scaled" + of, "float",
                  Input("in1", "float", From("roughness")) +
                      Input("in2", "float", Value(fmt::format("{:.6g}", scale))));
    nodes += Node("min", "roughness" + of, "float",
                  Input("in1", "float", From("scaled" + of)) + Input("in2", "float", Value("1")));
    roughness += of;
  }
  nodes += Node("multiply", "alpha" + of, "float",
                Input("in1", "float", From(roughness)) + Input("in2", "float", From(roughness)));
  const std::string both = "alpha_both" + of;
  nodes +=
      Node("combine2", anisotropy.any() ? "alpha_mean" + of : both, "vector2",
           Input("in1", "float", From("alpha" + of)) + Input("in2", "float", From("alpha" + of)));
  std::string tangent;
  if (anisotropy.any()) {  // along the tangent and across
    const double root = std::sqrt(anisotropy.ratio);
    nodes +=
        Node("multiply", both, "vector2",
             Input("in1", "vector2", From("alpha_mean" + of)) +
                 Input("in2", "vector2", Value(fmt::format("{:.6g}, {:.6g}", root, 1 / root))));
    tangent = Input("tangent", "vector3", From("along"));
  }
  return nodes + Node("generalized_schlick_bsdf", name, "BSDF",
                      Input("color0", "color3", f0) + Input("color90", "color3", Value("1, 1, 1")) +
                          Input("exponent", "float", Value("5")) +
                          Input("roughness", "vector2", From(both)) +
                          Input("normal", "vector3", From("bent")) + tangent +
                          Input("scatter_mode", "string", Value("R")));
}

}  // namespace

std::string MaterialXOf(const ExportedMaterial& material,
                        const std::function<std::string(const std::string& map)>& file_of) {
  const bool whole = material.convention.diffuse_weight == DiffuseWeight::kOne;
  std::string graph;
  graph += Picture("diffuse", "color3", file_of("diffuse"), true);
  graph += Picture("specular", "color3", file_of("specular"), true);
  graph += Picture("roughness", "float", file_of("roughness"), false);
  graph += Picture("normal", "vector3", file_of("normal_gl"), false);
  graph += Node("normalmap", "bent", "vector3", Input("in", "vector3", From("normal")));
  if (!whole) {  // the diffuse lobe has weight 1 − F0
    graph += Node("invert", "left", "color3", Input("in", "color3", From("specular")));
    graph += Node("multiply", "albedo", "color3",
                  Input("in1", "color3", From("diffuse")) + Input("in2", "color3", From("left")));
  }
  graph +=
      Node("oren_nayar_diffuse_bsdf", "matte", "BSDF",
           Input("color", "color3", From(whole ? "diffuse" : "albedo")) +
               Input("roughness", "float", Value("0")) + Input("normal", "vector3", From("bent")));
  const SpecularLobes& lobes = material.convention.lobes;
  if (lobes.anisotropy.any()) graph += TurnedTangent(lobes.anisotropy.direction_deg);
  if (lobes.two()) {
    const LobeMix<double> mix = LobeMixOf<double>(lobes);
    const std::string f0 = fmt::format("{0:.6g}, {0:.6g}, {0:.6g}", mix.coat_f0);
    graph += Glossy("wide", mix.scale[0], From("specular"), lobes.anisotropy);
    graph +=
        Glossy("narrow", mix.scale[1], mix.coat() ? Value(f0) : From("specular"), lobes.anisotropy);
    graph += Node("mix", "glossy", "BSDF",
                  Input("fg", "BSDF", From("narrow")) + Input("bg", "BSDF", From("wide")) +
                      Input("mix", "float", Value(fmt::format("{}", lobes.narrow_share))));
  } else {
    graph += Glossy("glossy", 1, From("specular"), lobes.anisotropy);
  }
  graph += Node("add", "both", "BSDF",
                Input("in1", "BSDF", From("matte")) + Input("in2", "BSDF", From("glossy")));
  graph += Node("surface", "reflectance", "surfaceshader", Input("bsdf", "BSDF", From("both")));
  graph += "    <output name=\"out\" type=\"surfaceshader\" nodename=\"reflectance\" />\n";
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<materialx version=\"1.38\" colorspace=\"lin_rec709\">\n"
         "  <nodegraph name=\"svbrdf\">\n" +
         graph +
         "  </nodegraph>\n"
         "  <surfacematerial name=\"" +
         material.name +
         "\" type=\"material\">\n"
         "    <input name=\"surfaceshader\" type=\"surfaceshader\" nodegraph=\"svbrdf\" "
         "output=\"out\" />\n"
         "  </surfacematerial>\n"
         "</materialx>\n";
}

}  // namespace glint
