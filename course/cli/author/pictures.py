"""``course author pictures``: the README's pictures, from the program's real output, and how figures look.

A file beside the README's has the digest of each picture's source. A test computes the digests again, which
takes seconds, and names each picture that is out of date.
"""

import contextlib
import hashlib
import io
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

from course.cli.frame.console import current
from course.cli.frame.here import load_catalog
from course.cli.frame.options import argument, figure_ids, option
from course.cli.frame.replies import Envelope
from course.errors import InternalError, UsageError
from course.progress.workspace import write_atomically


class AuthorPictures(Envelope, tag="course.author-pictures/1", frozen=True, kw_only=True):
    """``stale`` names the pictures that were not up to date; without ``--check`` they are now."""

    stale: tuple[str, ...]


#: The digests, beside the pictures.
_MADE_FROM = "made-from.json"
_COLUMNS = 84
_SCENE = "newtons-cradle"
#: Between the samples in the film's digest, in s; positions are rounded to a millimetre or less.
_EVERY, _DECIMALS = 0.25, 3


def pictures(
    figure: Annotated[
        list[str] | None,
        argument("[FIGURE]...", "Keep how these figures of lessons look now, instead.", complete=figure_ids),
    ] = None,
    check: Annotated[bool, option("--check", "Write nothing; exit code 1 if a picture is stale.")] = False,
) -> int:
    """Make the README's pictures, or keep how figures look.

    The README's are made from the output of `course demo` and a run of the sandbox, into docs/pictures. Of a
    figure that is named, its picture without letters and its words are kept in tests/fixtures/golden, where
    `course author check` compares it.
    """
    console, root = current(), load_catalog().content.root
    if figure:
        return _keep(figure, root / "tests" / "fixtures" / "golden")
    folder = root / "docs" / "pictures"
    known: dict[str, str] = {}
    with contextlib.suppress(OSError, ValueError):  # missing or damaged: make every picture again
        known |= json.loads((folder / _MADE_FROM).read_text(encoding="utf-8"))
    stale = []
    for name, (source, picture) in PICTURES.items():
        digest = hashlib.sha256(source()).hexdigest()
        path = folder / name
        if known.get(name) == digest and path.is_file():
            console.line(f"{name} is up to date.")
            continue
        stale.append(name)
        if check:
            console.line(f"{name} is stale: course author pictures makes it again.")
            continue
        folder.mkdir(parents=True, exist_ok=True)
        write_atomically(path, picture())  # generated, and under version control: no copy
        known[name] = digest
        write_atomically(folder / _MADE_FROM, f"{json.dumps(known, indent=2)}\n".encode())
        console.line(f"Wrote {path}")
    return console.answer(AuthorPictures(exit_code=1 if check and stale else 0, stale=tuple(stale)))


def _keep(figures: list[str], folder: Path) -> int:
    from course.figures.looks import picture_and_words

    if not folder.is_dir():
        problem = f"There is no {folder}."
        raise UsageError(problem, help="Figures belong to a checkout of the course: run this there.")
    console = current()
    kept = {name: picture_and_words(name) for name in figures}
    for name, (picture, words) in kept.items():
        write_atomically(folder / f"{name}.png", picture)  # under version control: no copy
        write_atomically(folder / f"{name}.txt", words)
        console.line(f"Wrote {folder / name}.png and .txt")
    return console.answer(AuthorPictures(stale=tuple(kept)))


def _run(*arguments: str, colour: bool = False) -> str:
    """The program's output in a terminal of a fixed width."""
    environ = {key: value for key, value in os.environ.items() if key not in {"NO_COLOR", "COURSE_CONTENT"}}
    environ |= {"COLUMNS": str(_COLUMNS), "TERM": "xterm-256color", "COLORTERM": "truecolor"}
    environ |= {"PYTHONUTF8": "1"} | ({"FORCE_COLOR": "1"} if colour else {})
    line = [sys.executable, "-m", "course", *arguments]
    done = subprocess.run(line, env=environ, capture_output=True, check=False, encoding="utf-8")
    if done.returncode:
        problem = f"`course {' '.join(arguments)}` failed: {done.stderr.strip()[-300:]}"
        raise InternalError(problem, code="picture_failed")
    return done.stdout


def _until_fixed(text: str) -> str:
    """The demonstration up to the passing checks; its picture has no place in a small one."""
    return text.partition("3. What the mistake hid")[0].rstrip()


def _diagnosis() -> bytes:
    """The screen as SVG; the same output gives the same bytes."""
    from rich.console import Console as RichConsole
    from rich.text import Text

    screen = Text.from_ansi(_run("demo", colour=True))
    shown = screen[: len(_until_fixed(screen.plain))]
    recorder = RichConsole(file=io.StringIO(), record=True, width=_COLUMNS, force_terminal=True)
    recorder.print(shown)
    return recorder.export_svg(title="course demo", unique_id="diagnosis").encode()


def _film_source() -> bytes:
    """Where everything was, and how it is drawn."""
    import course.sandbox.runs.recording as drawing

    with tempfile.TemporaryDirectory(prefix="course-pictures-") as folder:
        table = Path(folder) / "run.csv"
        _run("sandbox", "play", _SCENE, "--headless", "--csv", str(table), "--every", str(_EVERY))
        rows = [line.split(",") for line in table.read_text(encoding="utf-8").splitlines()]
    for row in rows:
        for place, cell in enumerate(row):
            with contextlib.suppress(ValueError):  # a heading or a name
                row[place] = f"{round(float(cell), _DECIMALS) + 0.0:.{_DECIMALS}f}"
    rounded = "\n".join(",".join(row) for row in rows)
    return rounded.encode() + Path(str(drawing.__file__)).read_bytes()


def _film() -> bytes:
    with tempfile.TemporaryDirectory(prefix="course-pictures-") as folder:
        film = Path(folder) / "film.gif"
        _run("sandbox", "play", _SCENE, "--gif", str(film))
        return film.read_bytes()


#: Each picture: what it is made from, and how.
PICTURES: dict[str, tuple[Callable[[], bytes], Callable[[], bytes]]] = {
    "diagnosis.svg": (lambda: _until_fixed(_run("demo", "--plain")).encode(), _diagnosis),
    "sandbox.gif": (_film_source, _film),
}
