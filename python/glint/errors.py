"""How Glint says that something is wrong, by the exit codes of its programs."""

from __future__ import annotations


class Error(Exception):
    """Base of Glint's errors; the message names the file, the field, what was found and the remedy.

    Attributes:
        exit_code: of the program that would have failed so (1, 2 or 3).
        program: name of the program that failed ("glint-fit"); None: no program was run.
    """

    exit_code: int = 1
    program: str | None = None


class ComputationError(Error):
    """The computation failed (exit code 1): too few corners, say."""

    exit_code = 1


class UserError(Error):
    """Incorrect usage or invalid input (exit code 2)."""

    exit_code = 2


class EnvironmentError(Error):  # noqa: A001, the name of C++ and of the documents
    """A problem in the environment (exit code 3): disk full, missing program, interrupted."""

    exit_code = 3


def error_type(exit_code: int) -> type[Error]:
    """The class of errors that a program reports by `exit_code`."""
    return {2: UserError, 3: EnvironmentError}.get(exit_code, ComputationError)
