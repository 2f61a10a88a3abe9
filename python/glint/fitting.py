"""Maps from arrays of photographs, and files for other programs from maps."""

from __future__ import annotations

import json
import pathlib
import shutil
import tempfile
from dataclasses import dataclass
from typing import Any, Callable, Sequence

import numpy as np

from . import _glint
from ._types import ArrayLike, Path
from .capture import Capture
from .maps import Confidence, Maps, planar
from .programs import Progress, call, run


@dataclass(frozen=True)
class Fit:
    """What `fit` found.

    Attributes:
        maps: `Maps`.
        confidence: `Confidence`, one standard deviation of every map; None: none is stated.
        metrics: a dict, what a person wants to know of the fit (`metrics` of its manifest).
    """

    maps: Maps
    confidence: Confidence | None
    metrics: dict[str, Any]


def _rows(name: str, value: ArrayLike, count: int) -> list[list[float]]:
    rows = np.asarray(value, dtype=float)
    if rows.shape != (count, 3):
        raise ValueError(f"{name}: found an array of shape {rows.shape}; {count} x 3 is expected, "
                         "one row for each photograph")
    listed: list[list[float]] = rows.tolist()
    return listed


def _positions(name: str, value: ArrayLike, count: int) -> list[list[float]]:
    positions = _rows(name, value, count)
    for index, position in enumerate(positions):
        if not position[2] > 0:
            raise ValueError(f"{name}[{index}]: found z = {position[2]:g}; it must stand in front "
                             "of the sample (z > 0)")
    return positions


def _write_photograph(folder: pathlib.Path, index: int, photograph: ArrayLike) -> str:
    """Writes one photograph in a format that holds its numbers exactly; the file's name."""
    pixels = np.asarray(photograph)
    if pixels.ndim != 3 or pixels.shape[2] != 3:
        raise ValueError(f"photographs[{index}]: found an array of shape {pixels.shape}; "
                         "H x W x 3 is expected")
    if pixels.dtype in (np.uint8, np.uint16):
        file = f"{index:03}.png"
        largest = np.float32(np.iinfo(pixels.dtype).max)
        _glint.write_png(str(folder / file), planar(pixels / largest), 8 * pixels.dtype.itemsize)
        return file
    if not np.all(np.isfinite(pixels)):
        raise ValueError(f"photographs[{index}]: found values that are not finite")
    file = f"{index:03}.exr"
    _glint.write_exr(str(folder / file), planar(pixels), ["R", "G", "B"], {})
    return file


def _light_fields(light_rgb: ArrayLike | None,
                  count: int) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """Fields of views.json: of the set, and of each view."""
    if light_rgb is None:
        return {"light_power": "estimate"}, [{}] * count
    power = np.asarray(light_rgb, dtype=float)
    if power.ndim < 2:
        return {"light_power": power.tolist()}, [{}] * count
    rows = _rows("light_rgb", power, count)
    return {"light_power": rows[0]}, [{"light_power": row} for row in rows]


def _write_views(folder: pathlib.Path, photographs: Sequence[ArrayLike], camera_mm: ArrayLike,
                 light_mm: ArrayLike | None, size_mm: ArrayLike, light_rgb: ArrayLike | None,
                 exposure: ArrayLike, ambient_rgb: ArrayLike, encoding: str,
                 convention: str) -> None:
    """Writes views.json (docs/views.md) and the photographs beside it."""
    count = len(photographs)
    if count == 0:
        raise ValueError("photographs: found none; give one at least")
    cameras = _positions("camera_mm", camera_mm, count)
    lights = cameras if light_mm is None else _positions("light_mm", light_mm, count)
    exposures = np.broadcast_to(np.asarray(exposure, dtype=float), (count,)).tolist()
    of_set, of_views = _light_fields(light_rgb, count)
    height, width = np.shape(photographs[0])[:2]
    size = np.asarray(size_mm, dtype=float)
    if size.ndim == 0:
        size = size * np.array([width, height]) / max(width, height)
    views = [{"image": _write_photograph(folder, index, photographs[index]),
              "camera_in_sample_mm": cameras[index], "light_in_sample_mm": lights[index],
              "exposure": exposures[index], **of_views[index]} for index in range(count)]
    described = {"glint_views": 1, "size_mm": size.tolist(), "encoding": encoding,
                 "convention": convention, "ambient": np.asarray(ambient_rgb, dtype=float).tolist(),
                 **of_set, "views": views}
    (folder / "views.json").write_text(json.dumps(described))


def fit(photographs: Sequence[ArrayLike], camera_mm: ArrayLike, light_mm: ArrayLike | None = None,
        *, size_mm: ArrayLike, light_rgb: ArrayLike | None = None, exposure: ArrayLike = 1.0,
        ambient_rgb: ArrayLike = 0.0, encoding: str = "auto", convention: str = "photograph",
        registration: str = "auto", method: str = "refined", folder: Path | None = None,
        progress: Callable[[Progress], Any] | None = None, **options: Any) -> Fit:
    """Fits maps to rectified photographs in memory.

    The photographs are top views of the sample, all of one size. Glint's programs do the work: the
    arrays are written to a temporary folder, which is removed at the end (about 25 bytes per texel
    and photograph).

    Args:
        photographs: N x H x W x 3, or a list of N arrays H x W x 3; row 0 at +y. Floats are linear
            and do not clip; uint8 and uint16 clip at their largest value and are decoded by
            `encoding`.
        camera_mm: N x 3 projection centres in the sample frame, millimetres: origin at the sample's
            centre, x right, y up, z toward the viewer; z > 0.
        light_mm: N x 3 positions of the light, likewise; None: at the camera.
        size_mm: (width, height) of what the photographs show, or the longer side.
        light_rgb: power, radiance mm^2 in units where photographs clip at 1: a number, 3, or N x 3;
            None: not known, one common factor is estimated with the maps.
        exposure: everything in a photograph is that much brighter: a number, or N.
        ambient_rgb: irradiance of a uniform surround, a number or 3.
        encoding: "auto" (floats linear, integers gamma 2.2), "srgb", "gamma2.2" or "linear".
        convention: reflectance convention, as of `Maps`.
        registration: "auto" brings photographs into one frame; "none" takes them as they are.
        method: "refined" (the most probable maps, with standard deviations), "latent", "classic",
            or "initial" (the estimator's maps, unfitted).
        folder: keep the capture here, and use it with `Capture`; None: a temporary folder.
        progress, options: as for `call`; options of `glint run` (`threads`, `seed`, `exclude`).

    Returns:
        `Fit`.

    Raises:
        ValueError: shapes that do not agree, a camera or light behind the sample, values that are
            not finite.
        UserError, ComputationError, EnvironmentError: as `call`.
    """
    stage = "refine" if method == "refined" else "fit"
    with tempfile.TemporaryDirectory(prefix="glint-") as temporary:
        source = pathlib.Path(temporary) / "views"
        source.mkdir()
        _write_views(source, photographs, camera_mm, light_mm, size_mm, light_rgb, exposure,
                     ambient_rgb, encoding, convention)
        target = pathlib.Path(folder) if folder is not None else pathlib.Path(temporary) / "capture"
        call("import", source, target, registration=registration)
        run(target, until=stage, method=method, progress=progress, **options)
        capture = Capture(target)
        outputs = [output["path"] for output in capture.manifest(stage)["outputs"]]
        confidence = capture.confidence(stage) if "confidence.exr" in outputs else None
        return Fit(capture.maps(stage), confidence, capture.manifest(stage)["metrics"])


def _write_capture(folder: pathlib.Path, maps: Maps) -> None:
    """A capture whose refine stage wrote `maps`."""
    height, width = maps.shape
    stage = folder / "glint" / "refine"
    stage.mkdir(parents=True)
    (folder / "capture.toml").write_text(
        f"[sample]\nsize_mm = [{maps.size_mm[0]!r}, {maps.size_mm[1]!r}]\n"
        f"resolution_px = [{width}, {height}]\n")
    maps.save(stage / "svbrdf.exr")
    output = {"path": "svbrdf.exr", "hash": _glint.hash_file(str(stage / "svbrdf.exr"))}
    manifest = {"glint_manifest": 1, "stage": "refine", "stage_version": 1, "inputs": [],
                "options": {}, "outputs": [output], "data": {"convention": maps.convention},
                "metrics": {}}
    (stage / "manifest.json").write_text(json.dumps(manifest))


def _export(source: pathlib.Path, folder: pathlib.Path | None,
            progress: Callable[[Progress], Any] | None,
            options: dict[str, Any]) -> list[pathlib.Path]:
    call("export", source, progress=progress, **options)
    written = source / "glint" / "export"
    names = [output["path"] for output in Capture(source).manifest("export")["outputs"]]
    if folder is None:
        return [written / name for name in names]
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(written / name, folder / name)
    return [folder / name for name in names]


def export(source: Capture | Maps | Path, folder: Path | None = None, *,
           progress: Callable[[Progress], Any] | None = None,
           **options: Any) -> list[pathlib.Path]:
    """Writes PNG maps and glTF, MaterialX, USD and Blender materials (docs/use.md).

    Args:
        source: `Capture` or its folder: `glint export` runs there. Or `Maps`.
        folder: where the files go; needed for `Maps`. None: the capture's `glint/export`.
        progress, options: as for `call`; options of `glint export` (`name`, `from_`, `bits`,
            `formats`, `border`).

    Returns:
        Paths of the files, a list of pathlib.Path.

    Raises:
        ValueError: maps without a folder.
        UserError, ComputationError, EnvironmentError: as `call`.
    """
    target = None if folder is None else pathlib.Path(folder)
    if not isinstance(source, Maps):
        capture = source.folder if isinstance(source, Capture) else pathlib.Path(source)
        return _export(capture, target, progress, options)
    if target is None:
        raise ValueError("folder: found none; maps in memory are exported to a folder")
    with tempfile.TemporaryDirectory(prefix="glint-") as temporary:
        capture = pathlib.Path(temporary)
        _write_capture(capture, source)
        return _export(capture, target, progress, options)
