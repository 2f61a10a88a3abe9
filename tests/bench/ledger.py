#!/usr/bin/env python3
"""Where the time of a run goes, stage by stage, next to its lower bound.

Runs `glint run` on a capture at each size, in a separate folder, and prints a table for each size: what
every stage took, from the run.json that it wrote during that run (docs/manifest.md), what the whole
run took, and in brackets the lower bound of a figure if it has one:

  wall, cpu      decoding the stage's photographs once, on all cores (measured by decode_photos)
  decodes        the number of photographs
  read           the files that the stage's manifest lists as read, once; from an earlier stage, its
                 views or maps. Whole run: the files that no stage has written
  written        the files that the stage's manifest lists as written (except the manifest itself, which
                 is written after run.json). Whole run: all of these, and the manifests

"between" is the time of the whole run minus that of its stages: starting and ending processes, Ninja,
hashes. Idle is the share of the cores' time that the run did not use. The share used by other processes,
which slows the run down, is printed above the table. Figures are comparable only if it is small.
"""

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from dataclasses import asdict, dataclass, field
from typing import Any, Iterable, Optional

# Inputs of stages that are no photographs.
DESCRIPTIONS = {".json", ".toml", ".lp", ".relight", ".dome", ".csv"}
VIDEOS = {".mp4", ".mov", ".m4v", ".avi", ".mkv", ".webm", ".3gp"}
DECODINGS = 3  # of which the fastest is the floor


class LedgerError(Exception):
    """What happened, where, and what to do."""


@dataclass
class Figures:
    """None: unknown, or nothing that has a floor."""

    wall_s: Optional[float] = None
    processor_s: Optional[float] = None
    bytes_read: Optional[int] = None
    bytes_written: Optional[int] = None
    photographs_decoded: Optional[int] = None
    photographs_decoded_reduced: Optional[int] = None
    peak_memory_bytes: Optional[int] = None


@dataclass
class Row:
    name: str
    figures: Figures
    floor: Figures = field(default_factory=Figures)

    def idle_share(self, cores: int) -> float:
        """Of the cores' time, while the wall clock ran."""
        wall_s = self.figures.wall_s or 0
        return max(0.0, 1 - (self.figures.processor_s or 0) / (cores * wall_s)) if wall_s > 0 else 0.0


@dataclass
class Decoding:
    """All photographs, each once, on all cores."""

    photographs: int
    pixels: int
    wall_s: float
    processor_s: float


# ---- what a stage says of itself


def read_json(file: pathlib.Path) -> Any:
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise LedgerError(f"{file}: cannot be read ({error}); run the ledger again") from error


def stage_figures(work: pathlib.Path, stage: str) -> Figures:
    facts = read_json(work / stage / "run.json")

    def fact(name: str) -> Any:
        if name in facts:
            return facts[name]
        raise LedgerError(
            f"{work / stage / 'run.json'}: no field {name}; glint-{stage} is older than this ledger: build it again"
        )

    return Figures(
        wall_s=fact("process_seconds"),
        processor_s=fact("processor_seconds"),
        bytes_read=fact("bytes_read"),
        bytes_written=fact("bytes_written"),
        photographs_decoded=fact("photographs_decoded"),
        photographs_decoded_reduced=fact("photographs_decoded_reduced"),
        peak_memory_bytes=fact("peak_memory_bytes"),
    )


def own_inputs(work: pathlib.Path, stage: str) -> list[pathlib.Path]:
    """What a stage reads that no stage has written, by its manifest."""
    listed = [entry["path"] for entry in read_json(work / stage / "manifest.json")["inputs"]]
    files = [work / stage / path for path in listed if not path.startswith("outside:")]
    files = [pathlib.Path(os.path.normpath(file)) for file in files]
    outside = read_json(work / stage / "run.json").get("outside", [])
    inside = [file for file in files if work not in file.parents]
    return inside + [pathlib.Path(file) for file in outside]


def photographs_of(work: pathlib.Path, stage: str) -> list[pathlib.Path]:
    photographs = []
    for file in own_inputs(work, stage):
        if file.suffix.lower() in VIDEOS:
            raise LedgerError(f"{file}: a video, whose frames are no files; name a capture of photographs")
        if work.parent in file.parents and file.suffix.lower() not in DESCRIPTIONS:
            photographs.append(file)
    return photographs


def size_of(files: Iterable[pathlib.Path]) -> int:
    return sum(file.stat().st_size for file in files if file.is_file())


def read_from_stages(work: pathlib.Path, stage: str) -> list[pathlib.Path]:
    """The manifests of earlier stages that a stage reads, with their views or maps."""
    files = []
    for entry in read_json(work / stage / "manifest.json")["inputs"]:
        if entry["path"].startswith("outside:"):
            continue
        manifest = pathlib.Path(os.path.normpath(work / stage / entry["path"]))
        if work not in manifest.parents:
            continue
        files.append(manifest)
        names = [output["path"] for output in read_json(manifest)["outputs"]] if manifest.suffix == ".json" else []
        files += [manifest.parent / name for name in names if name.endswith(".exr") and name != "confidence.exr"]
    return files


def written_by(work: pathlib.Path, stage: str) -> list[pathlib.Path]:
    folder = work / stage
    return [folder / output["path"] for output in read_json(folder / "manifest.json")["outputs"]]


def stage_floor(work: pathlib.Path, stage: str, decoding: Decoding) -> Figures:
    photographs = len(photographs_of(work, stage))
    share = photographs / decoding.photographs
    return Figures(
        wall_s=share * decoding.wall_s if photographs else None,
        processor_s=share * decoding.processor_s if photographs else None,
        bytes_read=size_of(own_inputs(work, stage)) + size_of(read_from_stages(work, stage)),
        bytes_written=size_of(written_by(work, stage)),
        photographs_decoded=photographs,
    )


# ---- the rows of a run


def run_floor(work: pathlib.Path, stages: list[str], decoding: Decoding) -> Figures:
    inputs = {file for stage in stages for file in own_inputs(work, stage)}
    return Figures(
        wall_s=decoding.wall_s,
        processor_s=decoding.processor_s,
        bytes_read=size_of(inputs),
        bytes_written=size_of(
            file for stage in stages for file in [work / stage / "manifest.json", *written_by(work, stage)]
        ),
        photographs_decoded=decoding.photographs,
    )


def between(run: Row, stages: list[Row]) -> Row:
    """What the run took beside its stages."""

    def rest(name: str) -> Any:
        return getattr(run.figures, name) - sum(getattr(row.figures, name) for row in stages)

    names = ("wall_s", "processor_s", "bytes_read", "bytes_written")
    return Row("between", Figures(**{name: rest(name) for name in names}))


def rows_of_run(work: pathlib.Path, stages: list[str], whole: Figures, decoding: Decoding) -> list[Row]:
    """Every stage, "between", and the whole run, to whose figures the others add up."""
    rows = [Row(stage, stage_figures(work, stage), stage_floor(work, stage, decoding)) for stage in stages]
    for name in ("photographs_decoded", "photographs_decoded_reduced"):
        setattr(whole, name, sum(getattr(row.figures, name) for row in rows))
    run = Row("glint run", whole, run_floor(work, stages, decoding))
    return rows + [between(run, rows), run]


# ---- running


def bytes_moved() -> tuple[int, int]:
    """By this process and its children that have ended: rchar and wchar, as the stages count."""
    facts = dict(line.split(": ") for line in pathlib.Path("/proc/self/io").read_text().splitlines())
    return int(facts["rchar"]), int(facts["wchar"])


def busy_s() -> float:
    """Of all processors, all processes together, since the machine started."""
    names = ("user", "nice", "system", "idle", "iowait", "irq", "softirq", "steal")
    ticks = dict(zip(names, map(int, pathlib.Path("/proc/stat").read_text().split()[1:])))
    return (sum(ticks.values()) - ticks["idle"] - ticks["iowait"]) / os.sysconf("SC_CLK_TCK")


def program(folder: pathlib.Path, name: str) -> str:
    file = folder / name
    if not os.access(file, os.X_OK):
        raise LedgerError(f"{file}: no such program; build it (./dev build), or name its folder with --bin")
    return str(file.resolve())


def output_of(command: list[str]) -> str:
    """A program's stdout; what it says on stderr is passed on."""
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        raise LedgerError(f"{' '.join(command)}: ended with exit code {done.returncode}; see its message above")
    return done.stdout


def timed_run(programs: pathlib.Path, capture: pathlib.Path) -> tuple[list[str], Figures, float]:
    """Every stage anew; their names, what the whole run took, and what other processes took meanwhile, in seconds."""
    shutil.rmtree(capture / "glint", ignore_errors=True)
    command = [program(programs, "glint-run"), str(capture), "--json"]
    read_before, written_before = bytes_moved()
    busy_before_s = busy_s()
    began_s = time.monotonic()
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        said = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        wall_s = time.monotonic() - began_s
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise LedgerError(f"{' '.join(command)}: ended with exit code {process.returncode}; see its message above")
    read_after, written_after = bytes_moved()
    processor_s = usage.ru_utime + usage.ru_stime
    others_s = max(0.0, busy_s() - busy_before_s - processor_s)
    stages = [entry["stage"] for entry in json.loads(said)["stages"]]
    whole = Figures(
        wall_s=wall_s,
        processor_s=processor_s,
        bytes_read=read_after - read_before,
        bytes_written=written_after - written_before,
        peak_memory_bytes=usage.ru_maxrss * 1024,
    )
    return stages, whole, others_s


def measure_decoding(programs: pathlib.Path, photographs: list[pathlib.Path]) -> Decoding:
    command = [program(programs, "decode_photos"), *map(str, photographs)]
    fastest = min((json.loads(output_of(command)) for _ in range(DECODINGS)), key=lambda said: float(said["seconds"]))
    return Decoding(fastest["photographs"], fastest["pixels"], fastest["seconds"], fastest["processor_seconds"])


# ---- the capture


def with_resolution(text: str, size_px: int, file: pathlib.Path) -> str:
    """capture.toml with another [sample] resolution_px."""
    table = re.search(r"^[ \t]*\[sample\][^\n]*\n(?:(?!\s*\[)[^\n]*(?:\n|\Z))*", text, re.MULTILINE)
    if table:
        kept = re.sub(r"^\s*resolution_px\s*=[^\n]*\n?", "", table[0], flags=re.MULTILINE)
        head, _, rest = kept.partition("\n")
        text = text[: table.start()] + f"{head}\nresolution_px = {size_px}\n{rest}" + text[table.end() :]
    try:
        if tomllib.loads(text)["sample"]["resolution_px"] == size_px:
            return text
    except (tomllib.TOMLDecodeError, KeyError, TypeError):
        pass
    raise LedgerError(f"{file}: resolution_px cannot be set; write [sample] as a table, with a key on every line")


def copied_capture(capture: pathlib.Path, folder: pathlib.Path) -> pathlib.Path:
    """A copy of a capture without its results, over the last such copy."""
    if not (capture / "capture.toml").is_file():
        raise LedgerError(f"{capture / 'capture.toml'}: no such file; name a capture's folder (glint init writes one)")
    source, target = capture.resolve(), folder / "copy"
    if source == target or source in target.parents or target in source.parents:
        raise LedgerError(f"--folder {folder}: lies in the capture {capture}, or holds it as its copy; name another")
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(source, target, ignore=lambda at, names: {"glint"} & set(names) if at == str(source) else set())
    return target


def synthetic_capture(programs: pathlib.Path, folder: pathlib.Path) -> pathlib.Path:
    """That of `glint demo`: twelve photographs of 12 megapixels; made once."""
    capture = folder / "synthetic"
    if not capture.exists():
        fresh = folder / "synthetic.new"
        shutil.rmtree(fresh, ignore_errors=True)
        words = ["capture", str(fresh), "--family", "leather", "--seed", "3", "--resolution", "512"]
        output_of([program(programs, "glint-synth"), *words])
        fresh.rename(capture)
    return capture


# ---- the table


def cell(figure: str, floor: str) -> str:
    return f"{figure} ({floor})" if floor else figure


def seconds_text(value: Optional[float]) -> str:
    return "" if value is None else f"{value:.2f}"


def megabytes_text(value: Optional[int]) -> str:
    return "" if value is None else f"{value / 1e6:.1f}"


def decodes_text(figures: Figures) -> str:
    if figures.photographs_decoded is None:
        return ""
    reduced = figures.photographs_decoded_reduced or 0
    return str(figures.photographs_decoded) + (f" + {reduced} reduced" if reduced else "")


def cells(row: Row, cores: int) -> list[str]:
    figures, floor = row.figures, row.floor
    return [
        row.name,
        cell(seconds_text(figures.wall_s), seconds_text(floor.wall_s)),
        cell(seconds_text(figures.processor_s), seconds_text(floor.processor_s)),
        f"{100 * row.idle_share(cores):.0f}",
        cell(decodes_text(figures), decodes_text(floor)),
        cell(megabytes_text(figures.bytes_read), megabytes_text(floor.bytes_read)),
        cell(megabytes_text(figures.bytes_written), megabytes_text(floor.bytes_written)),
        "" if figures.peak_memory_bytes is None else f"{figures.peak_memory_bytes / 1e6:.0f}",
    ]


def table(rows: list[Row], cores: int) -> str:
    """In Markdown, aligned."""
    heads = ["stage", "wall, s", "cpu, s", "idle, %", "decodes", "read, MB", "written, MB", "peak, MB"]
    lines = [heads] + [cells(row, cores) for row in rows]
    widths = [max(len(line[i]) for line in lines) for i in range(len(heads))]
    ruled = ["-" * widths[0]] + ["-" * (width - 1) + ":" for width in widths[1:]]

    def text(line: list[str]) -> str:
        aligned = [line[0].ljust(widths[0])] + [part.rjust(width) for part, width in zip(line[1:], widths[1:])]
        return "| " + " | ".join(aligned) + " |"

    return "\n".join(text(line) for line in [heads, ruled, *lines[1:]])


def as_json(row: Row, cores: int) -> dict[str, Any]:
    name = {"stage": row.name} if row.name not in ("between", "glint run") else {}
    floor = {key: value for key, value in asdict(row.floor).items() if value is not None}
    return {**name, **asdict(row.figures), "idle_share": row.idle_share(cores), "floor": floor}


def processor_name() -> str:
    found = re.search(r"^model name\s*:\s*(.+)$", pathlib.Path("/proc/cpuinfo").read_text(), re.MULTILINE)
    return found[1] if found else "unknown processor"


# ---- the command


def sizes(text: str) -> list[int]:
    try:
        found = [int(word) for word in text.split(",")]
    except ValueError:
        found = []
    if not found or any(not 8 <= size <= 8192 for size in found):
        raise argparse.ArgumentTypeError(f"found '{text}'; give sides of 8 to 8192 texels, such as 512,1024")
    return found


def measure(o: argparse.Namespace, folder: pathlib.Path) -> dict[str, Any]:
    cores = len(os.sched_getaffinity(0))
    capture = copied_capture(o.capture, folder) if o.capture else synthetic_capture(o.bin, folder)
    description = capture / "capture.toml"
    decoding: Optional[Decoding] = None
    ledger: dict[str, Any] = {
        "date": time.strftime("%Y-%m-%d", time.gmtime()),
        "processor": processor_name(),
        "cores": cores,
        "runs": [],
    }
    for size_px in o.sizes:
        text = description.read_text(encoding="utf-8")
        description.write_text(with_resolution(text, size_px, description), encoding="utf-8")
        stages, whole, others_s = timed_run(o.bin, capture)
        others_share = others_s / ((os.cpu_count() or cores) * (whole.wall_s or 1))
        if decoding is None:
            photographs = sorted({file for stage in stages for file in photographs_of(capture / "glint", stage)})
            if not photographs:
                raise LedgerError(f"{description}: no photographs that a stage reads; name a capture that has some")
            decoding = measure_decoding(o.bin, photographs)
            ledger["decoding"] = asdict(decoding)
        rows = rows_of_run(capture / "glint", stages, whole, decoding)
        megapixels = decoding.pixels / decoding.photographs / 1e6
        print(
            f"\n{size_px}²: {decoding.photographs} photographs of {megapixels:.1f} MP, {cores} cores of "
            f"{ledger['processor']}, {ledger['date']}; other processes took {100 * others_share:.0f} % of the "
            f"cores\n\n{table(rows, cores)}",
            flush=True,
        )
        as_dicts = [as_json(row, cores) for row in rows]
        ledger["runs"].append(
            {
                "size_px": size_px,
                "other_processes_share": others_share,
                "stages": as_dicts[:-2],
                "between": as_dicts[-2],
                "run": as_dicts[-1],
            }
        )
    return ledger


def arguments(words: Optional[list[str]]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="./dev bench run", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "capture",
        nargs="?",
        type=pathlib.Path,
        help="a capture, which is copied and not changed; if omitted: the synthetic one of glint demo",
    )
    parser.add_argument(
        "--sizes", type=sizes, default=[512, 1024], help="sides of the maps in texels (default: 512,1024)"
    )
    parser.add_argument(
        "--folder", type=pathlib.Path, help="keep the capture and the last run here (default: a temporary folder)"
    )
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also write all figures to this file")
    parser.add_argument(
        "--bin", type=pathlib.Path, default=pathlib.Path("build/bin"), help="Glint's programs (default: build/bin)"
    )
    return parser.parse_args(words)


def main(words: Optional[list[str]] = None) -> int:
    o = arguments(words)
    try:
        if o.json and not o.json.resolve().parent.is_dir():
            raise LedgerError(f"--json {o.json}: no such folder; make it, or name a file in another")
        if o.folder:
            o.folder.mkdir(parents=True, exist_ok=True)
            ledger = measure(o, o.folder.resolve())
        else:
            with tempfile.TemporaryDirectory(prefix="glint-ledger-") as folder:
                ledger = measure(o, pathlib.Path(folder).resolve())
        if o.json:
            o.json.write_text(json.dumps(ledger, indent=2) + "\n", encoding="utf-8")
    except LedgerError as error:
        print(f"bench run: error: {error}", file=sys.stderr)
        return 2
    except (OSError, shutil.Error) as error:
        print(f"bench run: error: {error}; check the path, its permissions and the free space", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main())
