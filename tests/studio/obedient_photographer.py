#!/usr/bin/python3
"""A simulated photographer who takes what Glint Studio asks for, and what becomes of it.

    tests/studio/obedient_photographer.py build/bin FOLDER [--seeds 10] [--most 12]

Three photographs of a synthetic sample from anywhere are sent to a running Studio, then one after
the other from where it asks, as well as a hand can, until it says that it is enough or there are
--most. The maps made of them are compared with those of the same sample from three good captures of
twelve (glint-synth's own: one photograph from the top, then in turn little and much tilted ones all
round), by the error of renderings: that of the maps is mostly of what does not show, such as the
roughness of a matte sample. Ends with exit code 1 where fewer than 8 of 10 reach the error of the
good ones, of which the worst counts. Photographs that are there are taken again.
"""
import argparse
import json
import math
import os
import pathlib
import random
import re
import subprocess
import sys
import time
import urllib.request

HAND_DEG, AROUND_DEG = 3, 8  # standard deviations of a hand's tilt and azimuth
START_TILT_DEG = 40
SHARE = 0.8
GOOD_ONES = 3


class Studio:
    """glint-studio on a folder, asked as its page asks."""

    def __init__(self, programs, folder):
        self.process = subprocess.Popen(
            [f"{programs}/glint-studio", "--no-browser", "--port", "0", str(folder)],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        for line in self.process.stdout:
            found = re.search(r"(http://127\.0\.0\.1:(\d+))/\?t=(\S+)", line)
            if found:
                break
        self.home, port, token = found.groups()
        self.headers = {"Cookie": f"glint_studio_{port}={token}", "Origin": self.home,
                        "X-Glint": "1"}

    def ask(self, path, body=None, kind="application/json"):
        if body is not None and kind == "application/json":
            body = json.dumps(body).encode()
        headers = dict(self.headers, **({"Content-Type": kind} if body is not None else {}))
        with urllib.request.urlopen(urllib.request.Request(self.home + path, body, headers)) as reply:
            return json.load(reply)

    def send(self, capture, file):
        body = (b"--part\r\nContent-Disposition: form-data; name=\"photographs\"; filename=\"" +
                file.name.encode() + b"\"\r\nContent-Type: image/jpeg\r\n\r\n" +
                file.read_bytes() + b"\r\n--part--\r\n")
        self.ask(f"/api/captures/{capture}/photographs", body,
                 "multipart/form-data; boundary=part")

    def checked(self, capture):
        """The capture once every photograph has its verdict."""
        while True:
            state = self.ask(f"/api/captures/{capture}")
            if all(p["state"] not in ("waiting", "checking") for p in state["photographs"]):
                return state
            time.sleep(0.05)


def synthesise(programs, folder, seed, o, board, directions=None, maps=None):
    command = [f"{programs}/glint-synth", "capture", str(folder), "--seed", str(seed), "--texels",
               o.resolution, "--resolution", o.resolution, "--megapixels", o.megapixels, "--board",
               str(board), "--force", "--log-level", "error"]
    if maps:
        command += ["--maps", str(maps)]
    if directions:
        command += ["--directions", ",".join(f"{t:.2f}@{a:.2f}" for t, a in directions)]
    subprocess.check_call(command, stdout=subprocess.DEVNULL)


def take_as_asked(programs, studio, folder, seed, o, board, board_id):
    """The directions of a capture that follows the advice, and whether Studio said enough."""
    hand = random.Random(seed)
    taken = [(hand.uniform(0, START_TILT_DEG), hand.uniform(0, 360)) for _ in range(3)]
    name = f"obeyed-{seed}"
    capture = studio.ask("/api/captures", {
        "name": name, "kind": "board", "size_mm": [100, 100], "height_mm": 0,
        "board": board_id})["id"]
    sent = 0
    while True:
        synthesise(programs, folder, seed, o, board, taken)
        files = sorted((folder / "photos").iterdir())
        for file in files[sent:]:
            studio.send(capture, file)
        sent = len(files)
        advice = studio.checked(capture)["advice"]
        if advice["enough"] or len(taken) >= o.most or not advice["target"]:
            return taken, advice
        target = advice["target"]
        taken.append((abs(target["tilt_deg"] + hand.gauss(0, HAND_DEG)),
                      target["azimuth_deg"] + hand.gauss(0, AROUND_DEG)))


def errors(programs, folder):
    """Mean squared errors of maps and of renderings."""
    environment = dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}")
    subprocess.run([f"{programs}/glint-run", str(folder), "--log-level", "error", "--until",
                    "refine"], env=environment, check=True, stdout=subprocess.DEVNULL)
    out = subprocess.check_output([f"{programs}/glint-eval", "maps",
                                   str(folder / "glint/refine/svbrdf.exr"),
                                   str(folder / "truth/svbrdf.exr"), "--json"], text=True)
    found = json.loads(out)
    return found["map_average"], found["render"]


def good_errors(programs, seed, k, o, board):
    """Of the k-th good capture of the sample."""
    folder = o.folder / f"good-{seed}-{k}"
    synthesise(programs, folder, seed + 1000 * k, o, board,
               maps=o.folder / f"obeyed-{seed}/truth/svbrdf.exr")
    return errors(programs, folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("programs")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--most", type=int, default=12)
    parser.add_argument("--resolution", default="256")
    parser.add_argument("--megapixels", default="3")
    o = parser.parse_args()
    programs = os.path.abspath(o.programs)
    library = o.folder / "studio"
    library.mkdir(parents=True, exist_ok=True)
    studio = Studio(programs, library)
    try:
        board_id = studio.ask("/api/boards", {"paper": "A4", "window_mm": [100, 100]})["id"]
        board = next((library / ".glint-studio/boards").glob("*/board.json"))
        reached = 0
        print("seed  photographs  verdict    renderings: obeyed  good ones               over the"
              " worst   maps: obeyed  good ones", flush=True)
        for seed in range(o.seeds):
            obeyed = o.folder / f"obeyed-{seed}"
            taken, advice = take_as_asked(programs, studio, obeyed, seed, o, board, board_id)
            maps, render = errors(programs, obeyed)
            good = [good_errors(programs, seed, k, o, board) for k in range(GOOD_ONES)]
            worst = max(render for _, render in good)
            reached += render <= worst
            print(f"{seed:4}  {len(taken):11}  {advice['verdict']:8}  {render:19.6f}",
                  *(f"{render:9.6f}" for _, render in good), f"{render / worst:9.2f} {maps:15.6f}",
                  *(f"{maps:9.6f}" for maps, _ in good), flush=True)
        print(f"{reached} of {o.seeds} reach the error of the good ones")
        return 0 if reached >= SHARE * o.seeds else 1
    finally:
        studio.process.terminate()


if __name__ == "__main__":
    sys.exit(main())
