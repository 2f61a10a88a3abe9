"""The differentiable renderer and the BRDF: the same C++ that fitting uses."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _glint
from ._types import ArrayLike, Doubles, Floats, Path
from .maps import MapPlanes, Maps, channels_last, planar


def _vector(name: str, value: ArrayLike) -> Doubles:
    vector: Doubles = np.asarray(value, dtype=float)
    if vector.shape != (3,) or not np.all(np.isfinite(vector)):
        raise ValueError(f"{name}: found {value!r}; three finite numbers are expected")
    return vector


def _position(name: str, value: ArrayLike) -> Doubles:
    position = _vector(name, value)
    if position[2] <= 0:
        raise ValueError(f"{name}: found z = {position[2]:g}; it must stand in front of the sample "
                         "(z > 0)")
    return position


def _colour(name: str, value: ArrayLike) -> Doubles:
    return _vector(name, np.broadcast_to(value, (3,)) if np.ndim(value) == 0 else value)


def white_light_rgb(light_mm: ArrayLike, convention: str = "photograph") -> Doubles:
    """Power with which a white Lambertian plane that faces the light has radiance 1.

    It is pi d^2 with d the distance from `light_mm` to the sample's centre, or pi where the
    convention has no falloff. The default of `render`.

    Returns:
        (3,) radiance mm^2, or irradiance where the convention has no falloff.
    """
    if "light=none" in _glint.convention(convention):
        return np.full(3, np.pi)
    return np.full(3, np.pi * np.dot(light_mm, light_mm))


def _scene(maps: Maps, camera_mm: ArrayLike, light_mm: ArrayLike, light_rgb: ArrayLike | None,
           ambient_rgb: ArrayLike, exposure: float, threads: int) -> dict[str, Any]:
    light = _position("light_mm", light_mm)
    if light_rgb is None:
        light_rgb = white_light_rgb(light, maps.convention)
    return {
        "size_mm": maps.size_mm,
        "convention": maps.convention,
        "camera_mm": _position("camera_mm", camera_mm),
        "light_mm": light,
        "light_rgb": _colour("light_rgb", light_rgb),
        "ambient_rgb": _colour("ambient_rgb", ambient_rgb),
        "exposure": float(exposure),
        "threads": int(threads),
    }


def render(maps: Maps, camera_mm: ArrayLike, light_mm: ArrayLike,
           light_rgb: ArrayLike | None = None, *, ambient_rgb: ArrayLike = 0.0,
           exposure: float = 1.0, threads: int = 0) -> Floats:
    """Renders maps under a point light, as `exposure * (E f NoL + ambient_rgb (w k_d + k_s) / pi)`.

    The image is of the texels: the top view of the sample, every texel with the radiance that it
    sends to the camera. The model is that of docs/conventions.md.

    Args:
        maps: `Maps`, H x W texels of `maps.size_mm`.
        camera_mm: (3,) projection centre in the sample frame, millimetres: origin at the sample's
            centre, x right, y up, z toward the viewer; z > 0.
        light_mm: (3,) position of the light, likewise.
        light_rgb: power, radiance mm^2 (E = light_rgb / d^2), or irradiance where the convention
            has no falloff; 3 numbers or one. None: `white_light_rgb(light_mm)`.
        ambient_rgb: irradiance of a uniform surround; 3 numbers or one.
        exposure: factor on everything.
        threads: 0: one per core. The result does not depend on it.

    Returns:
        H x W x 3 float32, linear radiance; a view of planes, contiguous by channel.

    Raises:
        ValueError: a camera or light behind the sample, or numbers of the wrong count.
    """
    scene = _scene(maps, camera_mm, light_mm, light_rgb, ambient_rgb, exposure, threads)
    return channels_last(_glint.render(maps.planes, **scene))


def render_gradients(maps: Maps, radiance_gradient: ArrayLike, camera_mm: ArrayLike,
                     light_mm: ArrayLike, light_rgb: ArrayLike | None = None, *,
                     ambient_rgb: ArrayLike = 0.0, exposure: float = 1.0,
                     threads: int = 0) -> MapPlanes:
    """The vector-Jacobian product of `render`: the gradient of a loss by the maps.

    Args:
        radiance_gradient: H x W x 3, the loss's derivatives by the rendered radiance.
        maps, camera_mm, light_mm, light_rgb, ambient_rgb, exposure, threads: as for `render`.

    Returns:
        `MapPlanes`, the loss's derivatives by normal, diffuse, specular and roughness. The normal's
        components are taken as free: where it is kept unit, use `tangent(maps, gradient)`.

    Raises:
        ValueError: as `render`, or a gradient of another size than the maps.
    """
    if np.shape(radiance_gradient) != (*maps.shape, 3):
        raise ValueError("radiance_gradient: found an array of shape "
                         f"{np.shape(radiance_gradient)}; the maps need {(*maps.shape, 3)}")
    scene = _scene(maps, camera_mm, light_mm, light_rgb, ambient_rgb, exposure, threads)
    return MapPlanes(_glint.render_gradients(maps.planes, planar(radiance_gradient), **scene))


def tangent(maps: Maps, gradient: MapPlanes) -> Floats:
    """The normal's gradient without its part along the normal, which normalising cancels.

    Returns:
        H x W x 3 float32.
    """
    along = np.sum(gradient.normal * maps.normal, axis=-1, keepdims=True)
    across: Floats = gradient.normal - along * maps.normal
    return across


def _unit(name: str, vectors: ArrayLike) -> Doubles:
    array: Doubles = np.asarray(vectors, dtype=float)
    if array.ndim < 1 or array.shape[-1] != 3:
        raise ValueError(f"{name}: found an array of shape {array.shape}; (..., 3) is expected")
    length = np.linalg.norm(array, axis=-1, keepdims=True)
    if not np.all(length > 0):
        raise ValueError(f"{name}: found a vector of length 0")
    unit: Doubles = array / length
    return unit


def _colours(value: ArrayLike) -> Doubles:
    colours: Doubles = np.asarray(value, dtype=float)
    return np.broadcast_to(colours, (3,)) if colours.ndim == 0 else colours


def brdf(light: ArrayLike, camera: ArrayLike, normal: ArrayLike, diffuse: ArrayLike,
         specular: ArrayLike, roughness: ArrayLike, *, diffuse_weight: str = "one",
         narrow_lobe: tuple[float, ...] = (0.0, 1.0), tail: int = 2,
         anisotropy: tuple[float, float] = (1.0, 0.0)) -> Doubles:
    """The BRDF f, without the cosine; vectorised, in double precision.

    Arguments broadcast against each other as NumPy's do, the last axis aside.

    Args:
        light, camera: (..., 3) directions from the texel to the light and to the camera; they are
            normalised.
        normal: (..., 3), normalised.
        diffuse, specular: (..., 3) albedo and F0, linear, or one number.
        roughness: (...), in (0, 1]; the GGX alpha is its square.
        diffuse_weight: "one" or "one_minus_specular", the weight w of the diffuse lobe.
        narrow_lobe: share and ratio of roughnesses of a second specular lobe, as a convention's
            "narrow_lobe=0.5x0.4"; share 0: one lobe. A third number, as in "0.5x0.4@0.04", is the
            F0 of a coat, which the narrow lobe then has in place of `specular`.
        tail: exponent of the lobes' tails, as a convention's "tail=4"; 2: GGX.
        anisotropy: ratio of alpha along a direction of the sample to alpha across it, and that
            direction in degrees from x toward y, as a convention's "anisotropy=1.5@90".

    Returns:
        (..., 3) float64, 1/sr.

    Raises:
        ValueError: shapes that do not agree, a vector of length 0, an unknown weight, a share that
            is not in [0, 1), a ratio that is not in (0, 1], an F0 that is not in [0, 1], a tail
            that is no whole number from 2 to 32, an anisotropy whose ratio is not in [1, 100] or
            whose direction is not in [0, 180).
    """
    if diffuse_weight not in ("one", "one_minus_specular"):
        raise ValueError(f"diffuse_weight: found {diffuse_weight!r}; "
                         "'one' or 'one_minus_specular' is expected")
    share, ratio, coat_f0 = (*narrow_lobe, 0.0, 0.0)[:3]
    if not (len(narrow_lobe) in (2, 3) and 0 <= share < 1 and 0 < ratio <= 1 and 0 <= coat_f0 <= 1):
        raise ValueError(f"narrow_lobe: found {narrow_lobe!r}; a share from 0 to below 1, a "
                         "ratio of roughnesses above 0, up to 1, and perhaps the F0 of a coat, up "
                         "to 1, are expected")
    if tail not in range(2, 33):
        raise ValueError(f"tail: found {tail!r}; a whole number from 2 to 32 is expected")
    ratio_of_alpha, direction_deg = anisotropy
    if not (1 <= ratio_of_alpha <= 100 and 0 <= direction_deg < 180):
        raise ValueError(f"anisotropy: found {anisotropy!r}; a ratio from 1 to 100 and a direction "
                         "from 0 to below 180 degrees are expected")
    vectors = [_unit("light", light), _unit("camera", camera), _unit("normal", normal),
               _colours(diffuse), _colours(specular)]
    widths = np.asarray(roughness, dtype=float)
    shape = np.broadcast_shapes(widths.shape, *(vector.shape[:-1] for vector in vectors))
    rows = [np.broadcast_to(vector, (*shape, 3)).reshape(-1, 3) for vector in vectors]
    values = _glint.brdf(rows[0], rows[1], rows[2], rows[3], rows[4],
                         np.broadcast_to(widths, shape).reshape(-1),
                         diffuse_weight == "one_minus_specular", share, ratio, coat_f0,
                         tail, ratio_of_alpha, direction_deg)
    return values.reshape((*shape, 3))


def to_srgb(linear: ArrayLike) -> Floats:
    """Linear values as sRGB has them, clipped to [0, 1]; same shape, float32."""
    values = np.clip(np.asarray(linear, dtype=np.float32), 0, 1)
    return np.where(values <= 0.0031308, 12.92 * values,
                    1.055 * np.power(values, np.float32(1 / 2.4)) - 0.055).astype(np.float32)


def write_png(file: Path, image: ArrayLike, *, encoding: str = "srgb", bits: int = 8) -> None:
    """Writes a PNG.

    Args:
        file: path of the file.
        image: H x W x 3 or H x W, linear.
        encoding: "srgb" for radiance and albedos, "linear" for data such as roughness.
        bits: 8 or 16 per channel.

    Raises:
        ValueError: another shape, encoding or number of bits.
        EnvironmentError: the file cannot be written.
    """
    if encoding not in ("srgb", "linear"):
        raise ValueError(f"encoding: found {encoding!r}; 'srgb' or 'linear' is expected")
    values = to_srgb(image) if encoding == "srgb" else np.asarray(image)
    if values.ndim == 2:
        values = values[..., np.newaxis]
    _glint.write_png(str(file), planar(values), bits)
