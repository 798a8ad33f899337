"""A student's files that no exercise was graded from: found, searched for functions, and proposed.

A file with another name, in another folder, or beside the one that was graded is always reported. Names of
functions are read in the process that reads submissions, which can be ended; nothing is run. An instructor
decides on the proposals with ``course grade assign``.
"""

from __future__ import annotations

import difflib
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import msgspec

from course.catalog.models import Exercise
from course.grading.intake.archives import RefusedError, reader
from course.grading.intake.downloads import IGNORED, Place, plain
from course.handed_in.limits import HANDED_IN
from course.printable import one_line

#: How far one student's folder is searched: depth of folders, entries, files read, and files that killed the
#: reading process, which may have taken ten seconds each.
_DEEP, _ENTRIES, _READ, _FATAL = 6, 2000, 60, 3
#: Code of one student that is parsed, in characters; a million of the densest take about 3 s of CPU.
_CODE = 3 << 20
#: How alike two names must be, up to 1, for one to count as a misspelling of the other: ``integrator`` for
#: ``integrators`` is 0.95, ``collision`` for ``integrators`` 0.3.
_ALIKE = 0.75
_SHOWN = 4


class Candidate(msgspec.Struct, frozen=True):
    """One file that may be meant for an exercise.

    Attributes:
        name: path from the student's folder; for a file in an archive, it continues after the archive's name.
        path: of the file, or of the archive it lies in, as the system has it: not every name is text.
        member: in the archive; empty for a file.
        sha256: digest of its content.
        defines: names of the functions in it; only an exercise's tasks, where it is listed for an exercise.
        proposed: it is the only match.
    """

    name: str
    path: bytes
    member: str = ""
    sha256: str = ""
    defines: tuple[str, ...] = ()
    proposed: bool = False


class Found(msgspec.Struct, frozen=True):
    """The files of one student that may be meant for an exercise, but not by their names.

    Attributes:
        reason: the code of the problem.
        times: who says when it was handed in, and when.
    """

    reason: str
    candidates: tuple[Candidate, ...]
    times: tuple[tuple[str, float | None], ...] = ()


@dataclass
class _Search:
    left: int = _ENTRIES
    files: list[tuple[str, Path]] = field(default_factory=list)


def survey(place: Place, used: set[tuple[str, str]], exercises: Sequence[Exercise]) -> list[Candidate]:
    """A student's files that no exercise was graded from.

    Args:
        used: path and member of the graded ones.
        exercises: look for their functions.
    """
    functions = tuple(dict.fromkeys(task.id for exercise in exercises for task in exercise.task))
    candidates: list[Candidate] = []
    left = _CODE
    for name, path in _files(place):
        fatal = sum(not one.sha256 for one in candidates)
        if len(candidates) >= _READ or fatal >= _FATAL:
            break
        if (str(path), "") not in used:
            skip = tuple(member for archive, member in used if archive == str(path) and member)
            found, parsed = _outlined(name, path, skip, functions if left > 0 else ())
            candidates += found
            left -= parsed
    return candidates[:_READ]


def _files(place: Place) -> list[tuple[str, Path]]:
    if place.files is not None:
        return [
            (name, path)
            for name, path in place.files
            if name.casefold().endswith(HANDED_IN) and path.is_file() and not path.is_symlink()
        ]
    search = _Search()
    _search(place.root, "", 0, search)
    return search.files


def _search(folder: Path, above: str, depth: int, search: _Search) -> None:
    try:
        entries = sorted(os.scandir(folder), key=lambda entry: entry.name)
    except OSError:
        return  # a folder that cannot be listed was refused with its reason elsewhere
    for entry in entries:
        search.left -= 1
        if search.left < 0:
            return
        if entry.name in IGNORED or entry.is_symlink():
            continue
        if entry.is_dir(follow_symlinks=False):
            if depth < _DEEP:
                _search(folder / entry.name, f"{above}{entry.name}/", depth + 1, search)
        elif entry.name.casefold().endswith(HANDED_IN) and entry.is_file(follow_symlinks=False):
            search.files.append((above + entry.name, folder / entry.name))


def _outlined(
    name: str, path: Path, skip: tuple[str, ...], functions: tuple[str, ...]
) -> tuple[list[Candidate], int]:
    """The functions in a file, or in an archive's files except those to skip; how much code was parsed."""
    shown = one_line(os.fsencode(name).decode("utf-8", "backslashreplace"))
    try:
        outlines = reader.outlines(path, skip, functions)
    except RefusedError:
        return [Candidate(shown, os.fsencode(path))], 0
    candidates = [
        Candidate(
            f"{shown}/{one_line(member)}" if member else shown, os.fsencode(path), member, sha256, defines
        )
        for member, sha256, defines, _ in outlines
    ]
    return candidates, sum(parsed for *_, parsed in outlines)


def found_for(exercise: Exercise, candidates: Iterable[Candidate], *, asked: bool) -> tuple[Candidate, ...]:
    """The files that may be meant for an exercise, the likeliest first, with the one match if there is one.

    Args:
        asked: the exercise was asked for by name, so any file may be meant for it.
    """
    tasks = [task.id for task in exercise.task]
    stem = Path(exercise.module).stem.casefold()
    ranked: list[tuple[float, Candidate]] = []
    for one in candidates:
        mine = tuple(name for name in tasks if name in one.defines)
        worth = len(mine) / len(tasks) if tasks else 0.0
        alike = difflib.SequenceMatcher(None, stem, Path(plain(Path(one.name).name)).stem).ratio()
        alike = alike if alike >= _ALIKE else 0.0
        if asked or worth >= 0.5 or alike:
            ranked.append((worth + alike / 10, msgspec.structs.replace(one, defines=mine)))
    ranked.sort(key=lambda item: (-item[0], item[1].name))
    distinct = {item[1].sha256: item[0] for item in reversed(ranked)}
    best = max(distinct.values(), default=0.0)
    # Two equally good files that differ: the grader must not decide which one counts.
    clear = best > 0 and list(distinct.values()).count(best) == 1
    return tuple(
        msgspec.structs.replace(one, proposed=clear and number == 0) for number, (_, one) in enumerate(ranked)
    )


def described(candidates: Sequence[Candidate]) -> str:
    """Files and their functions, as part of a sentence."""
    told = []
    for one in candidates[:_SHOWN]:
        names = ", ".join(one.defines[:_SHOWN]) + (", ..." if len(one.defines) > _SHOWN else "")
        told.append(f"{one.name} (defines {names})" if names else one.name)
    more = len(candidates) - _SHOWN
    return ", ".join(told) + (f" and {more} more" if more > 0 else "")
