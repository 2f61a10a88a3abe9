"""Captures that the tests read: synthetic ones of 64 x 64 texels."""

import numpy as np
import pytest

import glint


@pytest.fixture(scope="session")
def synthetic(tmp_path_factory):
    """Rectified views of known maps, fitted and refined; truth/svbrdf.exr is what they show."""
    folder = tmp_path_factory.mktemp("captures") / "set"
    glint.call("synth", "views", "procedural:7", folder, count=4, rule="photo", bits="float",
               resolution=64)
    glint.run(folder, from_="fit", until="fit", method="initial")
    glint.run(folder, "refine")
    return folder


@pytest.fixture
def capture(synthetic):
    return glint.Capture(synthetic)


@pytest.fixture
def truth(synthetic):
    return glint.Maps.load(synthetic / "truth" / "svbrdf.exr", size_mm=100)


@pytest.fixture
def random_maps():
    """Maps 12 x 17 with normals tilted up to 35 degrees."""
    random = np.random.default_rng(3)
    slopes = random.uniform(-0.5, 0.5, (12, 17, 2))
    normal = np.concatenate([slopes, np.ones((12, 17, 1))], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    return glint.Maps(normal, random.uniform(0.05, 0.9, (12, 17, 3)),
                      random.uniform(0.25, 0.9, (12, 17)), random.uniform(0.05, 0.9, (12, 17, 3)),
                      size_mm=(170, 120))
