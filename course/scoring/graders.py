"""The files of a grader process: one list, and the version of an exercise's graders, a digest of its part.

A run, ``author check`` and the tests' audit, a cluster and Gradescope's container all grade from these files,
unpacked into a folder of their own, and from nothing else. So a check that reads a file which is not listed
here fails wherever it is graded first, and that is at its author's.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Collection, Iterator
from pathlib import Path

import msgspec

from course.catalog.load import Catalog
from course.catalog.locate import PLACES, Content
from course.catalog.models import Exercise
from course.scoring.explain.story import read_table, table_path

_PACKAGE = Path(__file__).resolve().parents[1]
#: The parts of this package that a grader process imports, and those that checks may import.
_CODE = (
    "catalog", "engines", "figures", "handed_in", "isolation", "physics", "progress", "scoring",
    "simulations",
)  # fmt: skip
_FILES = (
    "grading/__init__.py", "grading/pipes.py", "grading/running/__init__.py", "grading/running/grader.py",
)  # fmt: skip
#: Files and folders without a part in grading: an exercise's wrong and its unusual solutions.
LEFT_OUT = frozenset({"accepted", "mistakes.py", "record.json"})
_NOT_READ = frozenset({".md", ".pyc"})
#: Of this package's code, what every exercise's score depends on.
_DECIDES = ("scoring", "isolation", "physics")


def grader_files(content: Content, exercises: Collection[str] | None = None) -> Iterator[tuple[str, Path]]:
    """Each file's name in an unpacked grader (``course/...``, ``content/...``), and where it is now.

    Args:
        exercises: ids, where the others and the quiz are not to be graded; None for all.
    """
    for path in _PACKAGE.glob("*.py"):
        if path.name != "__main__.py":
            yield f"course/{path.name}", path
    yield from ((f"course/{name}", _PACKAGE / name) for name in _FILES)
    for name in _CODE:
        yield from _below(f"course/{name}", _PACKAGE / name)
    yield "content/lessons/syllabus.toml", content.syllabus
    for name in PLACES:
        folder = content.place(name)
        if folder is None:
            continue
        if exercises is None:
            yield from _below(f"content/{name}", folder)
            continue
        for place in map(content.place_of, exercises):
            yield from _below(f"content/{name}/{place.as_posix()}", folder / place)
            table = table_path(folder / place)
            if table.parent != folder / place and table.is_file():  # one for all warm-ups
                yield f"content/{name}/{table.relative_to(folder).as_posix()}", table
    if exercises is None:
        yield from _below("content/quiz", content.quiz)


def _below(name: str, folder: Path) -> Iterator[tuple[str, Path]]:
    for here, folders, files in os.walk(folder):
        folders[:] = [one for one in folders if one not in LEFT_OUT and one != "__pycache__"]
        inside = Path(name, Path(here).relative_to(folder)).as_posix()
        for path in (Path(here, file) for file in files if file not in LEFT_OUT):
            if path.suffix not in _NOT_READ and path.is_file():
                yield f"{inside}/{path.name}", path


def grader_version(exercise: Exercise, catalog: Catalog, package: Path = _PACKAGE) -> str:
    """A digest of everything that decides an exercise's score: its files in a grader, and what runs them.

    Args:
        package: the folder of ``course``; the one that is running, unless it is a grader's own.
    """
    content, place = catalog.content, catalog.content.place_of(exercise.id)
    folders = {name: package / name for name in _DECIDES}
    folders |= {name: folder / place for name in PLACES if (folder := content.place(name)) is not None}
    digest = hashlib.sha256()
    for label, path in sorted(file for name, folder in folders.items() for file in _below(name, folder)):
        digest.update(label.encode() + b"\0" + path.read_bytes() + b"\0")
    if exercise.is_warm_up:  # its own part of the table that warm-ups share
        digest.update(msgspec.json.encode(read_table(Path(exercise.folder))))
    return digest.hexdigest()[:16]
