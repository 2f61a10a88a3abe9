"""Captures on disk: manifests as dicts, images as NumPy arrays, read when they are asked for."""

from __future__ import annotations

import json
import pathlib
from typing import Any, Callable, TypeVar

import numpy as np

from . import _glint
from ._types import Doubles, Floats, Path
from .errors import UserError
from .maps import CHANNELS, Confidence, Maps, channels_last, frozen
from .rendering import render

STAGES: tuple[str, ...] = tuple(_glint.stages())
_VIEWS_STAGE = _glint.views_stage()
_MANIFEST_FORMAT = 1
_T = TypeVar("_T")
_ARRAYS = {"rotation": (3, 3), "registration": (3, 3)}  # row-major in files


def _with_arrays(value: Any, name: str = "") -> Any:
    """Lists of numbers as float64 arrays, rotations and homographies as 3 x 3."""
    if isinstance(value, dict):
        return {key: _with_arrays(item, key) for key, item in value.items()}
    if not isinstance(value, list):
        return value
    numbers = all(isinstance(item, (int, float)) and not isinstance(item, bool) for item in value)
    if value and numbers:
        return np.array(value, dtype=float).reshape(_ARRAYS.get(name, -1))
    return [_with_arrays(item) for item in value]


class View:
    """One rectified photograph: how it was taken, and its pixels, which are read when asked for.

    Attributes:
        name: "view_000".
        photo: the photograph it came from, relative to the capture's folder.
        file: path of the EXR.
        ldr: whether the photograph clips at radiance 1.
        camera_in_sample_mm, light_in_sample_mm: (3,) positions in the sample frame, millimetres.
        light_rgb: (3,) power, radiance mm^2 (irradiance where the convention has no falloff); a
            first guess where the light's power was not known, see `Maps.light_scale_rgb`.
        ambient_rgb: (3,) irradiance of a uniform surround.
        exposure: relative to the first photograph's.
    """

    camera_in_sample_mm: Doubles
    light_in_sample_mm: Doubles
    light_rgb: Doubles
    ambient_rgb: Doubles

    def __init__(self, file: pathlib.Path, data: dict[str, Any]) -> None:
        self.file = file
        self.name: str = data["name"]
        self.photo: str = data["photo"]
        self.ldr: bool = data["ldr"]
        for key in ("camera_in_sample_mm", "light_in_sample_mm", "light_rgb", "ambient_rgb"):
            setattr(self, key, frozen(np.array(data[key], dtype=float)))
        self.exposure = float(data["exposure"])
        self._planes: Floats | None = None

    def _read(self) -> Floats:
        if self._planes is None:
            self._planes = frozen(_glint.read_exr(str(self.file), ["R", "G", "B", "mask.Y"])[0])
        return self._planes

    @property
    def radiance(self) -> Floats:
        """H x W x 3 float32, linear, 1 where the photograph clips; read-only."""
        return channels_last(self._read()[0:3])

    @property
    def mask(self) -> Floats:
        """H x W float32: 1 usable; 0 outside the photograph, or clipped; read-only."""
        mask: Floats = self._read()[3]
        return mask

    def render(self, maps: Maps, *, threads: int = 0) -> Floats:
        """Renders maps as this view saw the sample: its camera, light, surround and exposure.

        `maps.light_scale_rgb` is applied; refinement's corrections of single views are not.

        Returns:
            H x W x 3 float32, comparable with `radiance`.
        """
        return render(maps, self.camera_in_sample_mm, self.light_in_sample_mm,
                      self.light_rgb * maps.light_scale_rgb, ambient_rgb=self.ambient_rgb,
                      exposure=self.exposure, threads=threads)

    def __repr__(self) -> str:
        return f"<glint.View {self.name} of {self.photo}>"


class Capture:
    """A capture's folder: what its stages have written under `glint/`.

    Nothing is read before it is asked for, and once only, until a stage runs again. Arrays are
    read-only; `Maps.copy` gives maps that can be changed.

    Args:
        folder: of the capture, or its capture.toml.

    Raises:
        UserError: there is no capture.toml.

    Attributes:
        folder: pathlib.Path.
    """

    def __init__(self, folder: Path) -> None:
        path = pathlib.Path(folder)
        self.folder = path.parent if path.name == "capture.toml" else path
        # (stage, what): (stamp of the manifest, value)
        self._cache: dict[tuple[str, str], tuple[tuple[int, int] | None, Any]] = {}
        file = self.folder / "capture.toml"
        if not file.is_file():
            raise UserError(f"{file}: found no such file; give a capture's folder, or make it one "
                            f"with: glint init {self.folder}")

    @property
    def stages(self) -> list[str]:
        """Names of the stages that have a result, in the order in which they run."""
        return [stage for stage in STAGES if self._manifest_file(stage).is_file()]

    def manifest(self, stage: str) -> dict[str, Any]:
        """The stage's manifest.json as a dict (docs/manifest.md); not to be changed.

        Raises:
            ValueError: no stage has that name.
            UserError: the stage has not run, or its manifest is damaged or of another version of
                Glint.
        """
        return self._cached(stage, "manifest", lambda: self._read_manifest(stage))

    @property
    def calibration(self) -> dict[str, Any]:
        """`data` of calib's manifest: a dict with `cameras`, `photos`, `light_rgb` and the rest.

        Lists of numbers are float64 arrays, `rotation` and `registration` 3 x 3; lengths are in
        millimetres. An imported capture has none.

        Raises:
            UserError: as `manifest`.
        """
        def read() -> dict[str, Any]:
            data: dict[str, Any] = _with_arrays(self.manifest("calib")["data"])
            return data
        return self._cached("calib", "calibration", read)

    @property
    def size_mm(self) -> tuple[float, float]:
        """(width, height) of the rectified sample, millimetres.

        Raises:
            UserError: as `manifest` of rectify.
        """
        data = self.manifest(_VIEWS_STAGE)["data"]
        return float(data["width_mm"]), float(data["height_mm"])

    @property
    def views(self) -> list[str]:
        """Names of the rectified views, in the order of the photographs.

        Raises:
            UserError: as `manifest` of rectify.
        """
        return [view["name"] for view in self.manifest(_VIEWS_STAGE)["data"]["views"]]

    def view(self, name: str | int) -> View:
        """The rectified `View` of a name, a photograph's file name, or a number from 0.

        Raises:
            UserError: no view has that name, or as `manifest` of rectify.
        """
        views = self._cached(_VIEWS_STAGE, "views", self._make_views)
        if isinstance(name, int):
            return views[name]
        for view in views:
            photo = pathlib.PurePosixPath(view.photo)
            if name in (view.name, view.photo, photo.name, photo.stem):
                return view
        known = ", ".join(f"{view.name} ({view.photo})" for view in views)
        raise UserError(f"{self._manifest_file(_VIEWS_STAGE)}: views: found no view named "
                        f"'{name}'; use a view's or photograph's name: {known}")

    def maps(self, stage: str = "refine") -> Maps:
        """The `Maps` that a stage wrote: "fit", "refine" or "tile".

        Raises:
            UserError: as `manifest`; or a stage that writes no maps.
        """
        return self._cached(stage, "maps", lambda: self._read_maps(stage))

    def confidence(self, stage: str = "refine") -> Confidence:
        """The `Confidence` of a stage's maps, "refine" or "fit".

        Raises:
            UserError: as `manifest`; or there is none, as beside maps fitted without the
                estimator.
        """
        def read() -> Confidence:
            return Confidence.load(self._output(stage, "confidence.exr"))
        return self._cached(stage, "confidence", read)

    def __repr__(self) -> str:
        return f"<glint.Capture {self.folder}: {', '.join(self.stages) or 'no results'}>"

    def _manifest_file(self, stage: str) -> pathlib.Path:
        return self.folder / "glint" / stage / "manifest.json"

    def _cached(self, stage: str, what: str, make: Callable[[], _T]) -> _T:
        try:
            status = self._manifest_file(stage).stat()
            stamp: tuple[int, int] | None = (status.st_mtime_ns, status.st_ino)
        except OSError:
            stamp = None
        known = self._cache.get((stage, what))
        if known is None or known[0] != stamp:
            known = self._cache[stage, what] = (stamp, make())
        value: _T = known[1]
        return value

    def _read_manifest(self, stage: str) -> dict[str, Any]:
        if stage not in STAGES and not stage.startswith("refine-"):
            raise ValueError(f"stage: found '{stage}'; the stages are: {', '.join(STAGES)}")
        file = self._manifest_file(stage)
        try:
            manifest: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        except FileNotFoundError:
            raise UserError(f"{file}: found no such file; run first: glint {stage} {self.folder} "
                            f"(or all stages: glint run {self.folder})") from None
        except ValueError as error:
            raise UserError(f"{file}: found no valid JSON ({error}); run the stage that wrote it "
                            "again") from None
        version = manifest.get("glint_manifest") if isinstance(manifest, dict) else None
        if version != _MANIFEST_FORMAT:
            raise UserError(f"{file}: glint_manifest: found {version}; this package reads version "
                            f"{_MANIFEST_FORMAT}; run the stage again with this version of Glint")
        return manifest

    def _output(self, stage: str, name: str) -> pathlib.Path:
        names = [output["path"] for output in self.manifest(stage)["outputs"]]
        if name not in names:
            raise UserError(f"{self._manifest_file(stage)}: outputs: found no {name}; it has "
                            + ", ".join(names))
        return self._manifest_file(stage).parent / name

    def _make_views(self) -> list[View]:
        folder = self._manifest_file(_VIEWS_STAGE).parent
        return [View(folder / data["file"], data)
                for data in self.manifest(_VIEWS_STAGE)["data"]["views"]]

    def _read_maps(self, stage: str) -> Maps:
        file = self._output(stage, "svbrdf.exr")
        data = self.manifest(stage)["data"]
        planes, _, attributes = _glint.read_exr(str(file), list(CHANNELS))
        size_mm = data["size_mm"] if "size_mm" in data else self.size_mm
        convention = data.get("convention") or attributes["reflectance_convention"]
        maps = Maps.from_planes(frozen(planes), size_mm=size_mm, convention=convention)
        maps.light_scale_rgb = np.array(data.get("light_scale_rgb", (1, 1, 1)), dtype=float)
        return maps
