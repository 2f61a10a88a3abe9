"""Running Glint's programs: results as dicts, progress as calls, errors as exceptions."""

from __future__ import annotations

import json
import logging
import os
import pathlib
import selectors
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from typing import Any, Callable

from ._types import Path
from .errors import EnvironmentError, Error, error_type

_log = logging.getLogger("glint")
_LEVELS = {"debug": logging.DEBUG, "info": logging.INFO, "warning": logging.WARNING}
_PATIENCE_S = 10  # with a program that was told to end


@dataclass(frozen=True)
class Progress:
    """How far a program has got.

    Attributes:
        label: what is being done, usually a stage's name.
        share: 0 to 1: of the whole run if `run` planned to run this stage, otherwise of what the
            label describes.
        remaining_s: seconds; None while no estimate is available.
        note: further text from the program; may be empty.
    """

    label: str
    share: float
    remaining_s: float | None
    note: str


def program_folders() -> list[str]:
    """Where programs are looked for: $GLINT_BIN, beside a build's package, $PATH."""
    folders = [os.environ["GLINT_BIN"]] if os.environ.get("GLINT_BIN") else []
    folders.append(str(pathlib.Path(__file__).parent.parent.parent / "bin"))
    return folders + os.environ.get("PATH", os.defpath).split(os.pathsep)


def _program() -> str:
    program = shutil.which("glint", path=os.pathsep.join(program_folders()))
    if program is None:
        raise EnvironmentError("glint: found no such program in $GLINT_BIN or $PATH; install the "
                               "package glint, or set GLINT_BIN to the folder that holds it")
    return program


def _option(name: str, value: Any) -> list[str]:
    flag = "--" + name.rstrip("_").replace("_", "-")
    if value is None:
        return []
    if isinstance(value, bool):
        return [flag if value else "--no-" + flag[2:]]
    if isinstance(value, (list, tuple)):
        value = ",".join(str(item) for item in value)
    return [f"{flag}={value}"]


class _ProgressPipe:
    """A named pipe that programs write their progress to (GLINT_PROGRESS_FILE)."""

    def __enter__(self) -> _ProgressPipe:
        self._folder = tempfile.TemporaryDirectory(prefix="glint-")
        self.path = os.path.join(self._folder.name, "progress")
        os.mkfifo(self.path)
        # Open for writing too: it does not end when a program closes it.
        self.descriptor = os.open(self.path, os.O_RDWR | os.O_NONBLOCK)
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self.descriptor)
        self._folder.cleanup()


class _Lines:
    """Calls `take(line)` for each whole line of what a descriptor has to say."""

    def __init__(self, take: Callable[[str], None]) -> None:
        self._take = take
        self._rest = b""

    def add(self, data: bytes) -> None:
        *lines, self._rest = (self._rest + data).split(b"\n")
        for line in lines:
            self._take(line.decode(errors="replace"))

    def end(self) -> None:
        if self._rest:
            self._take(self._rest.decode(errors="replace"))
        self._rest = b""


class _Words:
    """What programs say on stderr: remarks go to the logger "glint", errors are kept."""

    def __init__(self) -> None:
        self.error: list[str] = []  # lines from the last "glint-fit: error: " on
        self.program: str | None = None

    def take(self, line: str) -> None:
        program, _, text = line.partition(": ")
        level, _, message = text.partition(": ")
        if program.startswith("glint") and level == "error":
            self.program, self.error = program, [message]
        elif program.startswith("glint") and level in _LEVELS:
            _log.log(_LEVELS[level], "%s: %s", program, message)
        elif self.error:
            self.error.append(line)
        elif line.strip():
            _log.info("%s", line)


def _listen(process: subprocess.Popen[bytes], pipe: _ProgressPipe,
            progress: Callable[[Progress], Any] | None) -> tuple[bytes, _Words]:
    """Reads all that the program says until it ends; its stdout, and its words."""
    assert process.stdout is not None and process.stderr is not None
    output: list[bytes] = []
    words = _Words()

    def report(line: str) -> None:
        if progress is not None:
            progress(Progress(**json.loads(line)))

    errors, reports = _Lines(words.take), _Lines(report)
    takers: dict[int, Callable[[bytes], None]] = {
        process.stdout.fileno(): output.append,
        process.stderr.fileno(): errors.add,
        pipe.descriptor: reports.add,
    }
    with selectors.DefaultSelector() as selector:
        for descriptor in takers:
            selector.register(descriptor, selectors.EVENT_READ)
        while len(selector.get_map()) > 1:  # the pipe does not end
            for key, _ in selector.select():
                data = os.read(key.fd, 1 << 16)
                if data:
                    takers[key.fd](data)
                else:
                    selector.unregister(key.fd)
    try:
        reports.add(os.read(pipe.descriptor, 1 << 16))
    except BlockingIOError:
        pass
    errors.end()
    return b"".join(output), words


def _stop(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(_PATIENCE_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _failure(process: subprocess.Popen[bytes], words: _Words, name: str) -> Error:
    code = process.returncode
    message = "\n".join(words.error).strip()
    if not message:
        how = f"was ended by signal {-code}" if code < 0 else f"failed (exit code {code})"
        message = f"{name} {how} without an error message"
    error = error_type(code)(message)
    error.program = words.program or name
    return error


def call(verb: str, *arguments: Any, progress: Callable[[Progress], Any] | None = None,
         **options: Any) -> dict[str, Any]:
    """Runs `glint VERB ARGUMENTS --OPTIONS --json` and returns its result.

    Args:
        verb, arguments: what to do, and with what: `call("synth", "views", "procedural:7", "set")`.
        progress: called with a `Progress` several times a second, in this thread. An exception
            that it raises, like KeyboardInterrupt, stops the program and is passed on; results of
            stages that are done are kept.
        options: the program's options with underscores for dashes: `finest_size=128`. Lists are
            joined by commas, True and False switch a flag on and off, None leaves an option out,
            and an underscore at the end is dropped (`from_`).

    Returns:
        The program's JSON as a dict.

    Raises:
        UserError, ComputationError, EnvironmentError: by the exit code, with the program's message.
    """
    argv = [_program(), verb, *(str(argument) for argument in arguments)]
    for name, value in options.items():
        argv += _option(name, value)
    argv.append("--json")
    with _ProgressPipe() as pipe:
        environment = dict(os.environ, GLINT_PROGRESS_FILE=pipe.path)
        with subprocess.Popen(argv, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, env=environment) as process:
            try:
                output, words = _listen(process, pipe, progress)
                process.wait()
            except BaseException:
                _stop(process)
                raise
    if process.returncode != 0:
        raise _failure(process, words, "glint-" + verb)
    result: dict[str, Any] = json.loads(output) if output.strip() else {}
    return result


def run(folder: Path, stage: str | None = None, *,
        progress: Callable[[Progress], Any] | None = None, **options: Any) -> dict[str, Any]:
    """Runs the stages of a capture that are out of date, or one stage.

    Args:
        folder: of the capture.
        stage: None: `glint run` with its options (`from_`, `until`, `method`, `quick`, `exclude`,
            `views`, `force`, `threads`, `memory`, `seed`). A stage's name: that stage alone, with
            its own options (`run("wood", "fit", iterations=200)`).
        progress, options: as for `call`.

    Returns:
        What the program prints with --json; for a whole run, `{"capture", "stages": [{"stage",
        "state", "manifest"}], "started"}`.

    Raises:
        UserError, ComputationError, EnvironmentError: as `call`.
    """
    return call(stage or "run", folder, progress=progress, **options)
