"""blender -b --factory-startup -P blender_scene.py -- SCRIPT OUT.exr: runs an exported script, renders its
plane from straight above (orthographic) under a point light with Cycles, and compares that with Glint's
reflectance of the exported maps. Exit code 1 where the mean log-L1 is more than the manifest states for
the script."""
import json
import math
import os
import re
import runpy
import sys

import bpy
import numpy as np

script, out = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
exported = runpy.run_path(script, run_name="__main__")
scene = bpy.context.scene
(plane,) = bpy.data.objects
width, height = plane.dimensions[0], plane.dimensions[1]
distance = 3 * width

camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.data.type, camera.data.ortho_scale = "ORTHO", max(width, height)
camera.location = (0, 0, distance)
light = bpy.data.objects.new("light", bpy.data.lights.new("light", "POINT"))
# So that a matte white texel under it, straight, has radiance 1.
light.data.energy = 4 * math.pi ** 2 * distance ** 2
light.data.shadow_soft_size = 0
light.location = (0.8 * width, 0.4 * width, distance)
for thing in (camera, light):
    scene.collection.objects.link(thing)
scene.camera = camera
scene.world = bpy.data.worlds.new("dark")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs[1].default_value = 0

scene.render.engine = "CYCLES"
scene.cycles.samples, scene.cycles.use_denoising = 16, False
scene.cycles.filter_width = 0.01  # pixels; wider, and neighbouring texels would be mixed
# A pixel's centre on every texel's, where Cycles' interpolation gives the texel itself.
folder = os.path.dirname(os.path.abspath(script))
texels = bpy.data.images.load(os.path.join(folder, exported["ROUGHNESS"]))
scene.render.resolution_x, scene.render.resolution_y = texels.size
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.view_settings.view_transform = "Raw"
scene.render.filepath = out
bpy.ops.render.render(write_still=True)


def pixels(file, colour):
    """Rows from the top, linear."""
    image = bpy.data.images.load(file)
    image.colorspace_settings.name = "Non-Color"
    values = np.array(image.pixels[:]).reshape(image.size[1], image.size[0], 4)[::-1, :, :3]
    if not colour:
        return values
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


diffuse, specular, rough, normal = (
    pixels(os.path.join(folder, exported[name]), colour)
    for name, colour in (("DIFFUSE", True), ("SPECULAR", True), ("ROUGHNESS", False), ("NORMAL", False)))
rows, columns = rough.shape[:2]
if not exported["DIFFUSE_WHOLE"]:
    diffuse = diffuse * (1 - specular)
rough = rough[..., :1]
normal = 2 * normal - 1
normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
x = ((np.arange(columns) + 0.5) / columns - 0.5) * width
y = (0.5 - (np.arange(rows) + 0.5) / rows) * height
place = np.stack(np.meshgrid(x, y) + [np.zeros((rows, columns))], -1)
to_light = np.array(light.location) - place
squared = (to_light ** 2).sum(-1, keepdims=True)
to_light /= np.sqrt(squared)
to_camera = np.array([0.0, 0.0, 1.0])
half = to_light + to_camera
half /= np.linalg.norm(half, axis=-1, keepdims=True)


def dot(a, b):
    return np.maximum((a * b).sum(-1, keepdims=True), 1e-8)


n_l, n_v, n_h, v_h = dot(normal, to_light), dot(normal, to_camera), dot(normal, half), dot(to_camera, half)


def stretched_sine(convention):
    """sin² between normals and half vectors, by the convention's anisotropy."""
    found = re.search(r"anisotropy=([\d.e-]+)@([\d.e-]+)", convention)
    ratio, azimuth = (float(found[1]), math.radians(float(found[2]))) if found else (1.0, 0.0)
    direction = np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
    tangent = direction - (normal * direction).sum(-1, keepdims=True) * normal
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    along = (half * tangent).sum(-1, keepdims=True) ** 2
    return along / ratio + (1 - n_h ** 2 - along) * ratio


def reflected(roughness, f0, sine):
    """Of one specular lobe."""
    alpha = np.clip(roughness, 0.03, 1) ** 2
    lobe = (alpha / (n_h ** 2 * alpha ** 2 + sine)) ** 2 / math.pi
    masking = (n_l * (1 - alpha / 2) + alpha / 2) * (n_v * (1 - alpha / 2) + alpha / 2)
    fresnel = f0 + (1 - f0) * 2 ** (v_h * (-5.55473 * v_h - 6.98316))
    return lobe * fresnel / (4 * masking)


with open(os.path.join(folder, "manifest.json")) as file:
    data = json.load(file)["data"]
sine, scales, share = (stretched_sine(data["convention"]), exported["LOBE_SCALES"], exported["NARROW_SHARE"])
brdf = diffuse / math.pi + (1 - share) * reflected(scales[0] * rough, specular, sine)
if len(scales) == 2:
    brdf = brdf + share * reflected(scales[1] * rough, exported["COAT_F0"] or specular, sine)
ours = math.pi * distance ** 2 / squared * n_l * brdf

image = bpy.data.images.load(out)
image.colorspace_settings.name = "Non-Color"
theirs = np.array(image.pixels[:]).reshape(image.size[1], image.size[0], 4)[::-1, :, :3]
error = float(np.abs(np.log(theirs + 0.01) - np.log(ours + 0.01)).mean())
(stated,) = (m["log_l1"] for m in data["materials"] if m["file"] == os.path.basename(script))
print(f"{script}: plane {width:.4f} x {height:.4f} m, Cycles against Glint: mean log-L1 {error:.4f} (stated {stated:.4f})")
sys.exit(0 if error <= stated else 1)
