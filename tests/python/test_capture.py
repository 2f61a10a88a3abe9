"""What a capture's folder says in arrays and dicts."""

import gzip
import json
import pathlib
import shutil
import subprocess

import numpy as np
import pytest

import glint


def numbers_in(file, channel, tmp_path):
    """A channel of an EXR as OpenImageIO's own tool reads it."""
    raw = tmp_path / "channel.zfile"  # gzip: a header of 136 bytes, then floats from the top down
    subprocess.run(["oiiotool", str(file), "--ch", channel, "-d", "float", "-o", str(raw)],
                   check=True, capture_output=True)
    data = gzip.decompress(raw.read_bytes())
    width, height = np.frombuffer(data, "<i2", 2, 4)
    return np.frombuffer(data, "<f4", -1, 136).reshape(height, width)


def test_maps_equal_the_file(capture, tmp_path):
    maps = capture.maps()
    file = capture.folder / "glint" / "refine" / "svbrdf.exr"
    for index, channel in enumerate(glint.CHANNELS):
        assert np.array_equal(maps.planes[index], numbers_in(file, channel, tmp_path)), channel
    assert np.array_equal(maps.normal[..., 1], maps.planes[1])
    assert np.array_equal(maps.diffuse[..., 2], maps.planes[5])
    assert np.array_equal(maps.specular[..., 0], maps.planes[6])
    assert np.array_equal(maps.roughness, maps.planes[9])
    assert maps.size_mm == (100, 100)


def test_confidence_equals_the_file(capture, tmp_path):
    confidence = capture.confidence()
    file = capture.folder / "glint" / "refine" / "confidence.exr"
    for values, channel in ((confidence.normal[..., 1], "normal.Y"),
                            (confidence.diffuse[..., 0], "diffuse.R"),
                            (confidence.specular[..., 2], "specular.B"),
                            (confidence.roughness, "roughness.Y"), (confidence.cost, "cost.Y")):
        assert np.array_equal(values, numbers_in(file, channel, tmp_path)), channel
    assert np.all(confidence.roughness > 0)


def test_views_equal_the_files(capture, tmp_path):
    assert capture.views == ["view_000", "view_001", "view_002", "view_003"]
    view = capture.view("view_002")
    for values, channel in ((view.radiance[..., 0], "R"), (view.radiance[..., 2], "B"),
                            (view.mask, "mask.Y")):
        assert np.array_equal(values, numbers_in(view.file, channel, tmp_path)), channel
    data = capture.manifest("rectify")["data"]["views"][2]
    assert np.array_equal(view.camera_in_sample_mm, data["camera_in_sample_mm"])
    assert capture.view(2) is view
    assert capture.view(pathlib.Path(view.photo).name) is view


def test_maps_are_views_of_one_array_that_is_read_once(capture):
    maps = capture.maps()
    assert capture.maps() is maps
    for array in (maps.normal, maps.diffuse, maps.specular, maps.roughness):
        assert np.shares_memory(array, maps.planes)
        with pytest.raises(ValueError):
            array[0, 0] = 0.5
    changed = maps.copy()
    changed.roughness[...] = 0.5
    assert not np.any(maps.roughness == changed.roughness)


def test_a_stage_that_ran_again_is_read_again(synthetic, tmp_path):
    folder = tmp_path / "set"
    shutil.copytree(synthetic, folder)
    capture = glint.Capture(folder)
    before = capture.maps("fit")
    glint.run(folder, "fit", method="initial", views=["view_000"])
    assert not np.array_equal(capture.maps("fit").planes, before.planes)


def test_manifests_are_the_files(capture):
    file = capture.folder / "glint" / "refine" / "manifest.json"
    assert capture.manifest("refine") == json.loads(file.read_text())
    assert capture.stages[:3] == ["rectify", "fit", "refine"]


def test_calibration_has_arrays(tmp_path):
    (tmp_path / "capture.toml").write_text("")
    (tmp_path / "glint" / "calib").mkdir(parents=True)
    pose = {"rotation": [1, 0, 0, 0, -1, 0, 0, 0, -1], "translation_mm": [1, 2, 300]}
    data = {"cameras": [{"model": "PINHOLE", "parameters": [1000, 1000, 500, 400]}],
            "light_rgb": [1e4, 2e4, 3e4], "light_power_known": True,
            "photos": [{"photo": "a.jpg", "camera": 0, "camera_from_sample": pose}]}
    (tmp_path / "glint" / "calib" / "manifest.json").write_text(
        json.dumps({"glint_manifest": 1, "stage": "calib", "data": data}))
    calibration = glint.Capture(tmp_path).calibration
    pose = calibration["photos"][0]["camera_from_sample"]
    assert np.array_equal(pose["rotation"], np.diag([1, -1, -1]))
    assert np.array_equal(pose["translation_mm"], [1, 2, 300])
    assert calibration["cameras"][0]["parameters"].shape == (4,)
    assert calibration["light_power_known"] is True


def test_errors_say_the_file_and_the_remedy(synthetic, capture, tmp_path):
    with pytest.raises(glint.UserError, match=r"capture\.toml: found no such file.*glint init"):
        glint.Capture(tmp_path)
    with pytest.raises(glint.UserError, match=r"tile.manifest\.json.*run first: glint tile"):
        capture.maps("tile")
    with pytest.raises(ValueError, match="the stages are: calib, rectify"):
        capture.manifest("refined")
    with pytest.raises(glint.UserError, match=r"no view named 'b\.jpg'.*view_003"):
        capture.view("b.jpg")
    with pytest.raises(glint.UserError, match=r"found no svbrdf\.exr; it has view_000"):
        capture.maps("rectify")
    newer = tmp_path / "newer"
    shutil.copytree(synthetic, newer)
    file = newer / "glint" / "refine" / "manifest.json"
    file.write_text(file.read_text().replace('"glint_manifest": 1', '"glint_manifest": 2'))
    with pytest.raises(glint.UserError, match=r"found 2; this package reads version 1"):
        glint.Capture(newer).maps()
    file.write_text("{")
    with pytest.raises(glint.UserError, match="found no valid JSON"):
        glint.Capture(newer).maps()
    (newer / "glint" / "fit" / "svbrdf.exr").write_bytes(b"no image")
    with pytest.raises(glint.UserError, match=r"svbrdf\.exr"):
        glint.Capture(newer).maps("fit")


def test_maps_survive_the_file(random_maps, tmp_path):
    random_maps.save(tmp_path / "svbrdf.exr")
    read = glint.Maps.load(tmp_path / "svbrdf.exr", size_mm=random_maps.size_mm)
    assert np.array_equal(read.planes, random_maps.planes)
    assert read.convention == random_maps.convention
