#include "pipeline/export/blender_script.h"

#include <fmt/format.h>

#include <cmath>

#include "base/files/json.h"
#include "base/reflectance/brdf.h"

namespace glint {
namespace {

// After the material's own values.
constexpr char kBody[] = R"PY(

def _node(tree, kind, x, y, **inputs):
    node = tree.nodes.new(kind)
    node.location = (x, y)
    for name, value in inputs.items():
        node.inputs[name.replace("_", " ")].default_value = value
    return node


def _picture(tree, file, colour, y):
    node = _node(tree, "ShaderNodeTexImage", -900, y)
    node.image = bpy.data.images.load(os.path.join(FOLDER, file), check_existing=True)
    node.image.colorspace_settings.name = "sRGB" if colour else "Non-Color"
    return node.outputs["Color"]


def _fresnel(tree, schlick, y):
    """F0 + (1 - F0) times Schlick's weight; F0 is Color1."""
    fresnel = _node(tree, "ShaderNodeMixRGB", -200, y, Color2=(1, 1, 1, 1))
    tree.links.new(schlick.outputs["Value"], fresnel.inputs["Fac"])
    return fresnel


def _glossy_node(tree, y):
    """Before Blender 4 there were two, and one of them had no anisotropy."""
    kinds = ["ShaderNodeBsdfGlossy", "ShaderNodeBsdfAnisotropic"]
    if ANISOTROPY:
        kinds.reverse()
    node = _node(tree, next(kind for kind in kinds if hasattr(bpy.types, kind)), 0, y)
    if ANISOTROPY:
        node.inputs["Anisotropy"].default_value = ANISOTROPY
        node.inputs["Rotation"].default_value = ANISOTROPY_TURN
        # Without a tangent of the UV map Blender takes one around the object's centre.
        tangent = _node(tree, "ShaderNodeTangent", -200, y - 150)
        tangent.direction_type = "UV_MAP"
        tangent.uv_map = "UVMap"
        tree.links.new(tangent.outputs["Tangent"], node.inputs["Tangent"])
    return node


def _glossy(tree, fresnel, roughness, bend, scale, y):
    """A GGX lobe of the roughness map times scale, at most 1."""
    glossy = _glossy_node(tree, y)
    glossy.distribution = "GGX"
    tree.links.new(fresnel.outputs["Color"], glossy.inputs["Color"])
    if scale != 1:
        times = _node(tree, "ShaderNodeMath", -200, y)
        times.operation = "MULTIPLY"
        times.inputs[1].default_value = scale
        times.use_clamp = True
        tree.links.new(roughness, times.inputs[0])
        roughness = times.outputs["Value"]
    tree.links.new(roughness, glossy.inputs["Roughness"])
    tree.links.new(bend.outputs["Normal"], glossy.inputs["Normal"])
    return glossy


def make_material():
    """diffuse / pi + D G F / (4 NoL NoV), F = F0 + (1 - F0) (1 - NoV)^5."""
    material = bpy.data.materials.new(NAME)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    link = tree.links.new
    diffuse = _picture(tree, DIFFUSE, True, 600)
    specular = _picture(tree, SPECULAR, True, 300)
    roughness = _picture(tree, ROUGHNESS, False, 0)
    normal = _picture(tree, NORMAL, False, -300)

    bend = _node(tree, "ShaderNodeNormalMap", -600, -300)
    link(normal, bend.inputs["Color"])
    if not DIFFUSE_WHOLE:
        left = _node(tree, "ShaderNodeInvert", -600, 450)
        link(specular, left.inputs["Color"])
        times = _node(tree, "ShaderNodeMixRGB", -400, 600, Fac=1.0)
        times.blend_type = "MULTIPLY"
        link(diffuse, times.inputs["Color1"])
        link(left.outputs["Color"], times.inputs["Color2"])
        diffuse = times.outputs["Color"]

    # Facing is 1 - (1 - NoV) at a blend of one half.
    facing = _node(tree, "ShaderNodeLayerWeight", -600, 150, Blend=0.5)
    link(bend.outputs["Normal"], facing.inputs["Normal"])
    schlick = _node(tree, "ShaderNodeMath", -400, 150)
    schlick.operation = "POWER"
    schlick.inputs[1].default_value = 5.0
    link(facing.outputs["Facing"], schlick.inputs[0])
    fresnel = _fresnel(tree, schlick, 300)
    link(specular, fresnel.inputs["Color1"])
    fresnels = [fresnel, fresnel]
    if COAT_F0 > 0:
        fresnels[1] = _fresnel(tree, schlick, 500)
        fresnels[1].inputs["Color1"].default_value = (COAT_F0, COAT_F0, COAT_F0, 1)

    matte = _node(tree, "ShaderNodeBsdfDiffuse", 0, 400, Roughness=0.0)
    link(diffuse, matte.inputs["Color"])
    link(bend.outputs["Normal"], matte.inputs["Normal"])
    glossy = [_glossy(tree, fresnels[i], roughness, bend, scale, 200 - 200 * i)
              for i, scale in enumerate(LOBE_SCALES)]
    shine = glossy[0].outputs["BSDF"]
    if len(glossy) == 2:  # a wide and a narrow lobe
        mix = _node(tree, "ShaderNodeMixShader", 200, 100, Fac=NARROW_SHARE)
        link(glossy[0].outputs["BSDF"], mix.inputs[1])
        link(glossy[1].outputs["BSDF"], mix.inputs[2])
        shine = mix.outputs["Shader"]
    both = _node(tree, "ShaderNodeAddShader", 200, 300)
    link(matte.outputs["BSDF"], both.inputs[0])
    link(shine, both.inputs[1])
    output = _node(tree, "ShaderNodeOutputMaterial", 400, 300)
    link(both.outputs["Shader"], output.inputs["Surface"])

    # Used where the material's displacement method is "Displacement"; bumps are the normals'.
    height = _picture(tree, HEIGHT, False, -600)
    displace = _node(tree, "ShaderNodeDisplacement", 200, -300,
                     Midlevel=-HEIGHT_LOW_M / max(HEIGHT_RANGE_M, 1e-9), Scale=HEIGHT_RANGE_M)
    link(height, displace.inputs["Height"])
    if USE_DISPLACEMENT:
        link(displace.outputs["Displacement"], output.inputs["Displacement"])
        # A property of the material since Blender 4.1, of Cycles' settings alone before.
        owner = material if hasattr(material, "displacement_method") else material.cycles
        owner.displacement_method = "DISPLACEMENT"
    return material


def make_plane(material):
    x, y = WIDTH_M / 2, HEIGHT_M / 2
    mesh = bpy.data.meshes.new(NAME)
    mesh.from_pydata([(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)], [], [(0, 1, 2, 3)])
    corners = mesh.uv_layers.new(name="UVMap").data
    for corner, place in zip(corners, [(0, 0), (1, 0), (1, 1), (0, 1)]):
        corner.uv = place
    mesh.materials.append(material)
    plane = bpy.data.objects.new(NAME, mesh)
    bpy.context.collection.objects.link(plane)
    return plane


if __name__ == "__main__":
    make_plane(make_material())
)PY";

// A Python string: JSON's quotes and escapes are Python's too.
std::string Quoted(const std::string& text) { return Json(text).dump(); }

// "(1.0,)", "(1.58, 0.63)"
std::string LobeScales(const SpecularLobes& lobes) {
  if (!lobes.two()) return "(1.0,)";
  const LobeMix<double> mix = LobeMixOf<double>(lobes);
  return fmt::format("({:.6g}, {:.6g})", mix.scale[0], mix.scale[1]);
}

std::string Digits(double x) { return fmt::format("{:.6g}", x); }

// α is α/(1 + anisotropy) along the tangent and α·(1 + anisotropy) across.
std::string BlenderAnisotropy(const SpecularLobes& lobes) {
  return Digits(1 / std::sqrt(lobes.anisotropy.ratio) - 1);
}

}  // namespace

std::string BlenderScriptOf(const ExportedMaterial& material,
                            const std::function<std::string(const std::string& map)>& file_of) {
  const SpecularLobes& lobes = material.convention.lobes;
  const double low_mm = material.height_range_mm[0], high_mm = material.height_range_mm[1];
  return fmt::format(
             R"(# Makes the material and a plane of its true size (metres). In Blender: Scripting > Open > Run
# Script; or  blender --python {0}_blender.py
import os

import bpy

FOLDER = os.path.dirname(os.path.abspath(
    bpy.context.space_data.text.filepath
    if getattr(bpy.context, "space_data", None) and getattr(bpy.context.space_data, "text", None)
    else __file__))
NAME = {1}
WIDTH_M, HEIGHT_M = {2}, {3}
DIFFUSE, SPECULAR = {4}, {5}
ROUGHNESS, NORMAL, HEIGHT = {6}, {7}, {8}
HEIGHT_LOW_M, HEIGHT_RANGE_M = {9}, {10}
DIFFUSE_WHOLE = {11}  # False: the diffuse lobe has weight 1 - F0
LOBE_SCALES, NARROW_SHARE = {12}, {13}  # of roughness, of each specular lobe
COAT_F0 = {14}  # of a narrow lobe that is a coat's; 0: it has the specular map's
ANISOTROPY, ANISOTROPY_TURN = {15}, {16}  # below 0: lobes are wider along the turned x axis; 0: round
USE_DISPLACEMENT = False  # True: moves the surface too; subdivide the plane first
)",
             material.name, Quoted(material.name), material.width_mm / 1000,
             material.height_mm / 1000, Quoted(file_of("diffuse")), Quoted(file_of("specular")),
             Quoted(file_of("roughness")), Quoted(file_of("normal_gl")), Quoted(file_of("height")),
             low_mm / 1000, (high_mm - low_mm) / 1000,
             material.convention.diffuse_weight == DiffuseWeight::kOne ? "True" : "False",
             LobeScales(lobes), lobes.narrow_share, lobes.coat_f0, BlenderAnisotropy(lobes),
             Digits(lobes.anisotropy.direction_deg / 360)) +
         kBody;
}

}  // namespace glint
