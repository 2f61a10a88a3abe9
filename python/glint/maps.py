"""SVBRDF maps, their gradients and their standard deviations as NumPy arrays."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

from . import _glint
from ._types import ArrayLike, Doubles, Floats, Path
from .errors import UserError

CHANNELS = (
    "normal.X", "normal.Y", "normal.Z",
    "diffuse.R", "diffuse.G", "diffuse.B",
    "specular.R", "specular.G", "specular.B",
    "roughness.Y",
)
_CONFIDENCE_CHANNELS = tuple(name for name in CHANNELS if name != "normal.Z")
_Array = TypeVar("_Array", bound="np.ndarray[Any, Any]")
_CONVENTION = "reflectance_convention"
_LARGEST_NORMAL_ERROR = 0.01


def channels_last(planes: Floats) -> Floats:
    """Planes C x H x W seen as H x W x C, without a copy."""
    return np.moveaxis(planes, 0, -1)


def planar(image: ArrayLike) -> Floats:
    """An image H x W x C as planes C x H x W, float32 and contiguous; copies only if it must."""
    return np.ascontiguousarray(np.moveaxis(np.asarray(image), -1, 0), dtype=np.float32)


def frozen(array: _Array) -> _Array:
    """The array, which can no longer be written to."""
    array.flags.writeable = False
    return array


class MapPlanes:
    """Ten planes of numbers, one for each channel of svbrdf.exr: maps, or a gradient by them.

    `normal`, `diffuse`, `specular` (H x W x 3) and `roughness` (H x W) are views of `planes`,
    float32 and 10 x H x W in the order of `glint.CHANNELS`: writing to one writes to the other.
    """

    planes: Floats

    def __init__(self, planes: ArrayLike) -> None:
        array: Floats = np.ascontiguousarray(planes, dtype=np.float32)
        if array.ndim != 3 or array.shape[0] != len(CHANNELS):
            raise ValueError(f"planes: found an array of shape {array.shape}; "
                             f"{len(CHANNELS)} x H x W is expected")
        self.planes = array

    @property
    def shape(self) -> tuple[int, int]:
        """(H, W), texels."""
        return self.planes.shape[1], self.planes.shape[2]

    @property
    def normal(self) -> Floats:
        """H x W x 3: unit, sample frame, x right, y up (toward row 0), z toward the viewer."""
        return channels_last(self.planes[0:3])

    @property
    def diffuse(self) -> Floats:
        """H x W x 3: diffuse albedo k_d, linear Rec.709, 0 to 1."""
        return channels_last(self.planes[3:6])

    @property
    def specular(self) -> Floats:
        """H x W x 3: specular albedo k_s = F0, linear, 0 to 1."""
        return channels_last(self.planes[6:9])

    @property
    def roughness(self) -> Floats:
        """H x W: r in (0, 1]; the GGX alpha is r squared."""
        plane: Floats = self.planes[9]
        return plane


class Maps(MapPlanes):
    """SVBRDF maps of a flat sample. Row 0 is at +y; values are linear float32.

    Args:
        normal: H x W x 3, or one normal (3) for all texels; unit, +y up (OpenGL).
        diffuse: H x W x 3, one colour (3) or one number: diffuse albedo, 0 to 1.
        roughness: H x W or one number, in (0, 1]; the GGX alpha is its square.
        specular: H x W x 3, one colour (3) or one number: F0, 0 to 1.
        size_mm: (width, height) of the sample in millimetres, or one number for a square texel
            grid's longer side.
        shape: (H, W), needed only where no map has one.
        convention: reflectance convention, "photograph", "dir2019", "materialgan" or its words
            (docs/conventions.md).

    Raises:
        ValueError: shapes that do not agree, normals that are not unit, a size that is not
            positive, an unknown convention.

    Attributes:
        planes: 10 x H x W, float32, contiguous; the maps are views of it.
        size_mm: (width, height), millimetres.
        convention: in the words of manifests.
        light_scale_rgb: (3,) multiplies `light_rgb` of the capture's views, whose power was
            perhaps a guess; 1 where it was known.
    """

    size_mm: tuple[float, float]
    convention: str
    light_scale_rgb: Doubles

    def __init__(self, normal: ArrayLike, diffuse: ArrayLike, roughness: ArrayLike,
                 specular: ArrayLike, *, size_mm: ArrayLike, shape: tuple[int, int] | None = None,
                 convention: str = "photograph") -> None:
        given = {"normal": np.asarray(normal), "diffuse": np.asarray(diffuse),
                 "roughness": np.asarray(roughness), "specular": np.asarray(specular)}
        shapes = [values.shape[:2] for name, values in given.items()
                  if values.ndim == (2 if name == "roughness" else 3)]
        height, width = shape or (shapes[0] if shapes else (1, 1))
        super().__init__(np.empty((len(CHANNELS), height, width), np.float32))
        for name, values in given.items():
            target = getattr(self, name)
            try:
                target[...] = values
            except ValueError:
                raise ValueError(f"{name}: found an array of shape {values.shape}; the maps are "
                                 f"{height} x {width} texels") from None
        length = np.sqrt(np.sum(np.square(self.normal), axis=-1))
        if not np.all(np.abs(length - 1) < _LARGEST_NORMAL_ERROR):
            raise ValueError("normal: found vectors that are not of length 1; normalise them")
        self._describe(size_mm, convention)

    @classmethod
    def from_planes(cls, planes: ArrayLike, *, size_mm: ArrayLike,
                    convention: str = "photograph") -> Maps:
        """Maps of planes 10 x H x W in the order of `glint.CHANNELS`; float32 is not copied."""
        maps = cls.__new__(cls)
        MapPlanes.__init__(maps, planes)
        maps._describe(size_mm, convention)
        return maps

    @classmethod
    def load(cls, file: Path, *, size_mm: ArrayLike) -> Maps:
        """Reads an svbrdf.exr.

        Raises:
            UserError: no such file, a missing channel, or no reflectance convention in its header.
        """
        planes, _, attributes = _glint.read_exr(str(file), list(CHANNELS))
        if _CONVENTION not in attributes:
            raise UserError(f"{file}: glint:{_CONVENTION}: found no such attribute; write the "
                            "reflectance convention into the header (docs/conventions.md)")
        return cls.from_planes(planes, size_mm=size_mm, convention=attributes[_CONVENTION])

    def save(self, file: Path) -> None:
        """Writes an svbrdf.exr: float32, the channels of docs/conventions.md.

        Raises:
            EnvironmentError: the file cannot be written.
        """
        _glint.write_exr(str(file), self.planes, list(CHANNELS), {_CONVENTION: self.convention})

    def copy(self) -> Maps:
        """The same maps in memory of their own, which can be written to."""
        maps = Maps.from_planes(self.planes.copy(), size_mm=self.size_mm,
                                convention=self.convention)
        maps.light_scale_rgb = self.light_scale_rgb.copy()
        return maps

    def texel_centres_mm(self) -> tuple[Doubles, Doubles]:
        """(x, y): float64 arrays of W and H texel centres in the sample frame, millimetres."""
        def centres(count: int, size: float) -> Doubles:
            place: Doubles = (np.arange(count) + 0.5) / count - 0.5
            if "sampling=corner_to_corner" in self.convention:
                place = np.arange(count) / max(count - 1, 1) - 0.5 * (count > 1)
            return place * size
        height, width = self.shape
        return centres(width, self.size_mm[0]), -centres(height, self.size_mm[1])

    def _describe(self, size_mm: ArrayLike, convention: str) -> None:
        height, width = self.shape
        size = np.asarray(size_mm, dtype=float)
        if size.ndim == 0:
            size = size * np.array([width, height]) / max(width, height)
        if size.shape != (2,) or not np.all(np.isfinite(size)) or not np.all(size > 0):
            raise ValueError(f"size_mm: found {size_mm!r}; two lengths above 0 are expected")
        self.size_mm = (float(size[0]), float(size[1]))
        self.convention = _glint.convention(convention)
        self.light_scale_rgb = np.ones(3)


class Confidence:
    """One standard deviation of every map, in the map's units; float32, read-only.

    Attributes:
        planes: 9 x H x W, of which the properties are views.
        cost: H x W, what refinement's residuals and priors cost a texel; None: not of refinement.
    """

    def __init__(self, planes: Floats, cost: Floats | None = None) -> None:
        self.planes = planes
        self.cost = cost

    @classmethod
    def load(cls, file: Path) -> Confidence:
        """Reads a confidence.exr.

        Raises:
            UserError: no such file, or a missing channel.
        """
        planes, names, _ = _glint.read_exr(str(file))
        rows = []
        for name in _CONFIDENCE_CHANNELS:
            if name not in names:
                raise UserError(f"{file}: {name}: found no such channel; the file has "
                                + ", ".join(names))
            rows.append(names.index(name))
        cost = planes[names.index("cost.Y")] if "cost.Y" in names else None
        return cls(frozen(planes[rows]), None if cost is None else frozen(cost))

    @property
    def normal(self) -> Floats:
        """H x W x 2: of the normal's x and y."""
        return channels_last(self.planes[0:2])

    @property
    def diffuse(self) -> Floats:
        """H x W x 3."""
        return channels_last(self.planes[2:5])

    @property
    def specular(self) -> Floats:
        """H x W x 3."""
        return channels_last(self.planes[5:8])

    @property
    def roughness(self) -> Floats:
        """H x W."""
        plane: Floats = self.planes[8]
        return plane
