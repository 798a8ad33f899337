"""The files that ``course sandbox`` reads and writes, and the settings on its command line."""

from __future__ import annotations

import csv
import io
from pathlib import Path  # noqa: TC003 - functions here take paths, and annotations are read
from typing import TYPE_CHECKING

from course.cli.frame import files
from course.cli.frame.files import target
from course.cli.frame.here import cwd
from course.cli.sandbox.replies import SandboxFile
from course.errors import UsageError
from course.sandbox.scene.loading import choose

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.cli.frame.terminal.console import Console
    from course.sandbox.runs.running import Run
    from course.sandbox.scene.loading import Chosen

__all__ = ["chosen", "pairs", "table", "target", "write"]


def pairs(settings: Sequence[str]) -> dict[str, object]:
    """``KEY=VALUE`` as numbers.

    Raises:
        UsageError: one is not such a pair, or its value is not a number.
    """
    found: dict[str, object] = {}
    for pair in settings:
        key, sign, value = pair.partition("=")
        if not sign or not key:
            raise UsageError(f"--set {pair}: write KEY=VALUE.", help="For example --set gravity=1.62.")
        try:
            number = float(value)
        except ValueError:
            raise UsageError(
                f"--set {pair}: {value[:40]!r} is not a number.",
                help=f"For example --set {key}=1.",
                code="bad_parameter",
            ) from None
        found[key.strip()] = int(number) if key == "seed" and number.is_integer() else number
    return found


def chosen(scene: str, settings: Sequence[str]) -> Chosen:
    """The scene of this name, or of this file in the current folder, with its settings."""
    if scene.endswith(".toml"):
        from pathlib import Path

        scene = str(cwd() / Path(scene).expanduser())
    return choose(scene, pairs(settings))


def write(console: Console, path: Path, data: bytes, kind: str) -> SandboxFile:
    """Write a file, keep a copy of an earlier one, and say so."""
    file = files.write(path, data, why="sandbox")
    if file.backup:
        console.line(f"There was a file of that name; it is kept at {file.backup.backup}.")
    console.line(f"Wrote {file.path}")
    return SandboxFile(kind=kind, path=file.path, backup=file.backup)


def table(run: Run) -> bytes:
    """The samples of a run as CSV: a line of names with units, then a row for each body and time."""
    from course.sandbox.runs.running import COLUMNS

    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for t, names, state in run.samples:
        for name, row in zip(names, state.tolist(), strict=True):
            writer.writerow([repr(round(t, 9)), name, *map(repr, row)])
    return text.getvalue().encode()
