"""Glint in Python: captures as NumPy arrays, the differentiable renderer, and the pipeline.

    capture = glint.Capture("wood")
    maps = capture.maps()                          # normal, diffuse, roughness, specular
    image = glint.render(maps, camera_mm=(0, 0, 300), light_mm=(100, 50, 300))
    glint.run("wood", progress=print)

Frames, units and the reflectance model are those of docs/conventions.md: millimetres in the sample
frame (origin at the sample's centre, x right, y up, z toward the viewer), row 0 of arrays at +y,
linear Rec.709 radiance, float32.
"""

from ._glint import __version__
from .capture import STAGES, Capture, View
from .errors import ComputationError, EnvironmentError, Error, UserError
from .fitting import Fit, export, fit
from .maps import CHANNELS, Confidence, MapPlanes, Maps
from .programs import Progress, call, run
from .rendering import (brdf, render, render_gradients, tangent, to_srgb, white_light_rgb,
                        write_png)

__all__ = [
    "CHANNELS", "STAGES", "Capture", "ComputationError", "Confidence", "Error", "Fit", "MapPlanes",
    "Maps", "Progress", "UserError", "View", "brdf", "call", "export", "fit", "render",
    "render_gradients", "run", "tangent", "to_srgb", "white_light_rgb", "write_png",
    # EnvironmentError is left out: `from glint import *` would hide Python's.
]
