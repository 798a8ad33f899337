"""Command lines of ``course``: in this process, or as a process where that is what a test is about.

Both give what ``subprocess.run`` gives, and neither has anything to read on its standard input. A process
takes a third of a second longer. Signals, terminals, the encoding of a console, what is imported and the
program's own entry point need one.
"""

import contextlib
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import IO
from unittest.mock import patch

from course.cli.frame import app, console

ROOT = Path(__file__).resolve().parents[1]


def as_process(
    *words: object, cwd: Path | None = None, env: Mapping[str, str] = os.environ
) -> subprocess.CompletedProcess[str]:
    """Run a line with ``python -m course`` of this checkout."""
    path = os.pathsep.join(filter(None, [str(ROOT), env.get("PYTHONPATH", "")]))
    return subprocess.run(
        [sys.executable, "-m", "course", *map(str, words)],
        cwd=cwd, env={**env, "PYTHONPATH": path}, stdin=subprocess.DEVNULL,
        capture_output=True, text=True, encoding="utf-8", timeout=120, check=False,
    )  # fmt: skip


def in_process(
    *words: object, cwd: Path | None = None, env: Mapping[str, str] = os.environ
) -> subprocess.CompletedProcess[str]:
    """Run a line here; folder, environment, streams and console are afterwards what they were."""
    arguments = [str(word) for word in words]
    with (
        contextlib.chdir(cwd or Path.cwd()),
        patch.dict(os.environ, dict(env), clear=True),
        patch.object(console, "_installed", None),
        Path(os.devnull).open(encoding="utf-8") as nothing,
        patch.object(sys, "stdin", nothing),
        _written("stdout", 1) as out,
        _written("stderr", 2) as err,
    ):
        code = app.run(arguments)
        said = [_all_of(out), _all_of(err)]
    return subprocess.CompletedProcess(["course", *arguments], code, *said)


@contextlib.contextmanager
def _written(name: str, number: int) -> Iterator[IO[bytes]]:
    """What is written to a stream, also by a program that is started meanwhile."""
    kept = os.dup(number)
    with tempfile.TemporaryFile() as file:
        os.dup2(file.fileno(), number)
        try:
            with (
                open(number, "w", encoding="utf-8", closefd=False) as stream,
                patch.object(sys, name, stream),
            ):
                yield file
        finally:
            os.dup2(kept, number)
            os.close(kept)


def _all_of(file: IO[bytes]) -> str:
    sys.stdout.flush()
    sys.stderr.flush()
    file.seek(0)
    return file.read().decode("utf-8").replace(os.linesep, "\n")
