"""The examples run as their users would run them."""

import os
import pathlib
import subprocess
import sys

EXAMPLES = pathlib.Path(os.environ.get(
    "GLINT_EXAMPLES", pathlib.Path(__file__).parent.parent.parent / "python" / "examples"))


def run(example, *arguments):
    done = subprocess.run([sys.executable, str(EXAMPLES / example), *map(str, arguments)],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_load_and_plot(synthetic, tmp_path):
    out = run("load_and_plot.py", synthetic, tmp_path / "sheet.png")
    assert "64 x 64 texels" in out
    assert (tmp_path / "sheet.png").stat().st_size > 1000


def test_relight(synthetic, tmp_path):
    run("relight.py", synthetic, tmp_path / "frames", "--frames", 4)
    frames = sorted((tmp_path / "frames").iterdir())
    assert [frame.name for frame in frames] == [f"frame_{i:03}.png" for i in range(4)]
    assert len({frame.read_bytes() for frame in frames}) == 4


def test_fit_arrays():
    out = run("fit_arrays.py", "--size", 48, "--photographs", 4)
    assert "held-out" in out
