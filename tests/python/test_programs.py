"""Running the programs: progress, errors, fitting arrays, exporting."""

import pathlib
import shutil

import numpy as np
import pytest

import glint


def test_progress_rises_with_the_run(synthetic, tmp_path):
    folder = tmp_path / "set"
    shutil.copytree(synthetic, folder, ignore=shutil.ignore_patterns("fit", "refine"))
    reports = []
    result = glint.run(folder, from_="fit", until="fit", progress=reports.append)
    assert [stage["state"] for stage in result["stages"]] == ["computed"]
    assert {report.label for report in reports} == {"fit"}
    shares = [report.share for report in reports]
    assert shares == sorted(shares) and shares[0] == 0 and 0 < shares[-1] <= 1
    again = glint.run(folder, from_="fit", until="fit")
    assert [stage["state"] for stage in again["stages"]] == ["up to date"]


@pytest.mark.parametrize("interruption", [KeyboardInterrupt, RuntimeError])
def test_an_exception_in_the_callback_stops_the_program(tmp_path, interruption):
    def stop(report):
        raise interruption
    with pytest.raises(interruption):
        glint.call("synth", "capture", tmp_path / "set", megapixels=2, photos=40, progress=stop)
    photos = list((tmp_path / "set").rglob("*.jpg"))
    assert len(photos) < 40


def test_errors_are_those_of_the_exit_codes(synthetic, monkeypatch, tmp_path):
    with pytest.raises(glint.UserError, match="finest-size.*not in range") as caught:
        glint.run(synthetic, "fit", finest_size=0)
    assert caught.value.exit_code == 2
    assert caught.value.program == "glint-fit"
    with pytest.raises(glint.UserError, match="absent: found no such folder"):
        glint.run(tmp_path / "absent")
    (tmp_path / "wood").write_text("")
    with pytest.raises(glint.EnvironmentError, match="wood"):
        glint.call("synth", "views", "procedural:1", tmp_path / "wood" / "set", resolution=8)
    monkeypatch.setattr("glint.programs.program_folders", lambda: [str(tmp_path)])
    with pytest.raises(glint.EnvironmentError, match="GLINT_BIN"):
        glint.run(synthetic)


def test_arrays_of_photographs_are_fitted_like_the_files_they_came_from(capture, tmp_path):
    views = [capture.view(name) for name in capture.views]
    found = glint.fit([view.radiance for view in views],
                      [view.camera_in_sample_mm for view in views],
                      [view.light_in_sample_mm for view in views], size_mm=100,
                      light_rgb=[view.light_rgb for view in views],
                      exposure=[view.exposure for view in views], registration="none",
                      folder=tmp_path / "set")
    kept = glint.Capture(tmp_path / "set")
    for view in views:
        same = kept.view(view.name)
        assert np.array_equal(same.radiance, view.radiance)
        np.testing.assert_allclose(same.light_in_sample_mm, view.light_in_sample_mm)
    assert np.array_equal(found.maps.planes, kept.maps().planes)
    assert found.maps.shape == found.confidence.roughness.shape == (64, 64)
    for view in views:
        error = np.abs(np.log(view.render(found.maps) + 0.01) - np.log(view.radiance + 0.01))
        assert np.mean(error) < 0.02


def test_photographs_of_8_and_16_bits_keep_their_values(tmp_path):
    for dtype in (np.uint8, np.uint16):
        levels = np.iinfo(dtype).max
        photograph = np.random.default_rng(7).integers(0, levels // 2, (32, 32, 3)).astype(dtype)
        folder = tmp_path / dtype.__name__
        glint.fit([photograph], [(0, 0, 300)], size_mm=50, encoding="linear", light_rgb=1e5,
                  method="initial", folder=folder)
        radiance = glint.Capture(folder).view(0).radiance
        np.testing.assert_allclose(radiance, photograph / levels, rtol=1e-3, atol=1e-4)


def test_what_is_wrong_with_arrays_is_told():
    photograph = np.zeros((16, 16, 3))
    with pytest.raises(ValueError, match="found none"):
        glint.fit([], [], size_mm=10)
    with pytest.raises(ValueError, match="camera_mm.*1 x 3 is expected"):
        glint.fit([photograph], (0, 0, 100), size_mm=10)
    with pytest.raises(ValueError, match=r"photographs\[0\].*not finite"):
        glint.fit([photograph * np.nan], [(0, 0, 100)], size_mm=10)
    with pytest.raises(ValueError, match=r"photographs\[0\].*H x W x 3"):
        glint.fit([np.zeros((16, 16, 4))], [(0, 0, 100)], size_mm=10)
    with pytest.raises(ValueError, match=r"camera_mm\[0\]: found z = -100"):
        glint.fit([photograph], [(0, 0, -100)], size_mm=10)


def test_maps_in_memory_are_exported_like_a_captures(capture, tmp_path):
    from_maps = glint.export(capture.maps(), tmp_path / "maps", name="wood", formats=["gltf"])
    names = {path.name for path in from_maps}
    assert {"wood.glb", "wood_basecolor.png", "wood_normal_gl.png"} <= names
    of_capture = glint.export(capture, name="wood", formats=["gltf"])
    assert {path.name for path in of_capture} == names
    copied = glint.export(capture.folder, tmp_path / "copied", name="wood", formats=["gltf"])
    for path in of_capture:
        assert path.read_bytes() == next(c for c in copied if c.name == path.name).read_bytes()
    # Heights trust normals by the confidence, which maps in memory do not have.
    colour = next(path for path in of_capture if path.name == "wood_basecolor.png")
    assert colour.read_bytes() == (tmp_path / "maps" / "wood_basecolor.png").read_bytes()
    with pytest.raises(ValueError, match="folder"):
        glint.export(capture.maps())


def test_pictures_are_written(tmp_path):
    image = np.linspace(0, 2, 8 * 9 * 3).reshape(8, 9, 3)
    for bits in (8, 16):
        glint.write_png(tmp_path / "image.png", image, bits=bits)
        assert (tmp_path / "image.png").read_bytes().startswith(b"\x89PNG")
    assert glint.to_srgb(0.5) == pytest.approx(0.7353569, abs=1e-6)
    with pytest.raises(glint.EnvironmentError):
        glint.write_png(tmp_path / "absent" / "image.png", image)
    assert not pathlib.Path(tmp_path / "absent").exists()
