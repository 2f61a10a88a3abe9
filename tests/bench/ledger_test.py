#!/usr/bin/env python3
"""The ledger on programs that stand in for Glint's: its rows add up to the run, it can be run twice,
a capture that is named stays as it is, and figures that a stage did not write are asked for."""

import contextlib
import io
import json
import pathlib
import tempfile
import unittest

import ledger

# Two stages: calib reads two photographs, fit what calib has written. The run itself moves bytes too.
GLINT_RUN = """#!/usr/bin/env python3
import json, pathlib, sys, tomllib
capture = pathlib.Path(sys.argv[1])
assert not (capture / "glint").exists(), "results of an earlier run"
size = tomllib.loads((capture / "capture.toml").read_text())["sample"]["resolution_px"]
(capture / "run.log").open("a").write(f"{size} ")
def stage(name, inputs, output, decoded):
    folder = capture / "glint" / name
    folder.mkdir(parents=True)
    (folder / output).write_text("x" * 1000)
    entries = [{"path": path} for path in inputs]
    (folder / "manifest.json").write_text(json.dumps({"inputs": entries, "outputs": [{"path": output}]}))
    facts = {"process_seconds": 0.01, "processor_seconds": 0.005, "bytes_read": 100, "bytes_written": 50,
             "photographs_decoded": decoded, "photographs_decoded_reduced": 1, "peak_memory_bytes": 1000000}
    facts.pop(LACKING, None)
    (folder / "run.json").write_text(json.dumps(facts))
stage("calib", ["../../photos/a.jpg", "../../photos/b.jpg", "../../board.json"], "view_000.exr", 4)
stage("fit", ["../calib/manifest.json"], "svbrdf.exr", 0)
print(json.dumps({"stages": [{"stage": "calib"}, {"stage": "fit"}]}))
"""
GLINT_SYNTH = """#!/usr/bin/env python3
import pathlib, sys
CAPTURE = pathlib.Path(sys.argv[2])
(CAPTURE / "photos").mkdir(parents=True)
(CAPTURE / "photos/a.jpg").write_text("aaa")
(CAPTURE / "photos/b.jpg").write_text("bbbbb")
(CAPTURE / "board.json").write_text("{}")
(CAPTURE / "capture.toml").write_text("[sample]\\nresolution_px = 512\\nsize_mm = [1, 1]\\n[board]\\n")
"""
DECODE_PHOTOS = """#!/usr/bin/env python3
import sys
n = len(sys.argv) - 1
print(f'{{"photographs": {n}, "pixels": {n}000000, "threads": 1, "seconds": 0.25, "processor_seconds": 0.5}}')
"""


class Ledger(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write_program("glint-run", GLINT_RUN.replace("LACKING", "None"))
        self.write_program("glint-synth", GLINT_SYNTH)
        self.write_program("decode_photos", DECODE_PHOTOS)

    def write_program(self, name, text):
        file = self.folder / "bin" / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
        file.chmod(0o755)

    def run_ledger(self, *words):
        """Exit code, what was written as JSON, and what was said."""
        said = io.StringIO()
        file = self.folder / "ledger.json"
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            code = ledger.main(["--bin", str(self.folder / "bin"), "--json", str(file), *map(str, words)])
        return code, json.loads(file.read_text()) if code == 0 else None, said.getvalue()

    def test_stages_and_what_is_between_add_up_to_the_run(self):
        _, found, _ = self.run_ledger("--sizes", "64,128")
        self.assertEqual([run["size_px"] for run in found["runs"]], [64, 128])
        for run in found["runs"]:
            parts = run["stages"] + [run["between"]]
            for figure in ("wall_s", "processor_s", "bytes_read", "bytes_written"):
                self.assertAlmostEqual(sum(part[figure] for part in parts), run["run"][figure], msg=figure)
            for figure in ("photographs_decoded", "photographs_decoded_reduced"):
                self.assertEqual(sum(stage[figure] for stage in run["stages"]), run["run"][figure], figure)

    def test_floors_count_everything_once(self):
        _, found, _ = self.run_ledger("--sizes", "64")
        calib, fit = (stage["floor"] for stage in found["runs"][0]["stages"])
        run = found["runs"][0]["run"]["floor"]
        self.assertEqual([calib["photographs_decoded"], run["photographs_decoded"]], [2, 2])
        self.assertEqual([calib["wall_s"], run["wall_s"], run["processor_s"]], [0.25, 0.25, 0.5])
        self.assertNotIn("wall_s", fit)
        self.assertEqual(calib["bytes_read"], 3 + 5 + 2)
        self.assertGreater(fit["bytes_read"], 1000)  # calib's view and its manifest
        self.assertEqual(run["bytes_read"], calib["bytes_read"])
        self.assertEqual([calib["bytes_written"], fit["bytes_written"]], [1000, 1000])
        self.assertGreater(run["bytes_written"], 2000)  # and the manifests

    def test_runs_twice_with_the_same_photographs(self):
        words = ("--folder", self.folder / "kept", "--sizes", "64,32")
        for _ in range(2):
            self.assertEqual(self.run_ledger(*words)[0], 0)
        self.assertEqual((self.folder / "kept/synthetic/run.log").read_text(), "64 32 64 32 ")

    def test_a_named_capture_is_not_changed(self):
        self.run_ledger("--folder", self.folder / "kept", "--sizes", "64")
        capture = self.folder / "kept/synthetic"
        contents = {file: file.read_bytes() for file in capture.rglob("*") if file.is_file()}
        for _ in range(2):
            code, _, said = self.run_ledger(capture, "--folder", self.folder / "other", "--sizes", "128")
            self.assertEqual(code, 0, said)
        self.assertEqual(contents, {file: file.read_bytes() for file in capture.rglob("*") if file.is_file()})
        copy = self.folder / "other/copy"
        for named, folder in ((copy, copy.parent), (capture, capture / "work")):
            code, _, said = self.run_ledger(named, "--folder", folder)
            self.assertEqual((code, "name another" in said), (2, True))

    def test_a_program_that_is_older_is_named(self):
        self.write_program("glint-run", GLINT_RUN.replace("LACKING", "'bytes_read'"))
        code, _, said = self.run_ledger("--sizes", "64")
        self.assertEqual(code, 2)
        self.assertIn("no field bytes_read; glint-calib is older", said)

    def test_the_resolution_is_set_whatever_stood_there(self):
        for text in ("[sample]\nsize_mm = [1, 1]\n", "[a]\nresolution_px = 1\n[sample] # mine\nresolution_px = [4, 2]"):
            self.assertIn("resolution_px = 64", ledger.with_resolution(text, 64, pathlib.Path("c")))
        with self.assertRaises(ledger.LedgerError):
            ledger.with_resolution("sample = {size_mm = [1, 1]}\n", 64, pathlib.Path("c"))


if __name__ == "__main__":
    unittest.main()
