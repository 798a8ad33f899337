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
from course.grading.intake.downloads import Place, plain
from course.grading.intake.kinds import is_clutter
from course.handed_in.limits import HANDED_IN, MANIFEST
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
#: Kinds of files that are read as code.
_READABLE = ("", "a text", "a notebook")


class Candidate(msgspec.Struct, frozen=True):
    """One file that may be meant for an exercise.

    Attributes:
        name: path from the student's folder; for a file in an archive, it continues after the archive's name.
        path: of the file, or of the archive it lies in, as the system has it: not every name is text.
        member: in the archive; empty for a file.
        sha256: digest of its content.
        defines: names of the functions in it; only an exercise's tasks, where it is listed for an exercise.
        kind: what it is, or why it cannot be read; empty for code and notebooks.
        proposed: it is the only match.
    """

    name: str
    path: bytes
    member: str = ""
    sha256: str = ""
    defines: tuple[str, ...] = ()
    proposed: bool = False
    kind: str = ""


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
    # What is most likely work comes first, should there be more than is read.
    for name, path in sorted(_files(place), key=lambda item: not item[0].casefold().endswith(HANDED_IN)):
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
        return [(name, path) for name, path in place.files if path.is_file() and not path.is_symlink()]
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
        if is_clutter(entry.name) or entry.is_symlink():
            continue
        if entry.is_dir(follow_symlinks=False):
            if depth < _DEEP and not (folder / entry.name / "pyvenv.cfg").exists():
                _search(folder / entry.name, f"{above}{entry.name}/", depth + 1, search)
        elif entry.is_file(follow_symlinks=False) and entry.name != MANIFEST:
            search.files.append((above + entry.name, folder / entry.name))


def _outlined(
    name: str, path: Path, skip: tuple[str, ...], functions: tuple[str, ...]
) -> tuple[list[Candidate], int]:
    """The functions in a file, or in an archive's files except those to skip; how much code was parsed."""
    shown = one_line(os.fsencode(name).decode("utf-8", "backslashreplace"))
    try:
        outlines = reader.outlines(path, skip, functions)
    except RefusedError as refused:
        killed = refused.problem.code == "unreadable"
        why = refused.problem.message.removeprefix(f"{path.name}: ").rstrip(".")
        return [Candidate(shown, os.fsencode(path), sha256="" if killed else shown, kind=why)], 0
    candidates = [
        Candidate(
            f"{shown}/{one_line(member)}" if member else shown,
            os.fsencode(path),
            member,
            sha256,
            defines,
            kind=kind,
        )
        for member, sha256, defines, _, kind in outlines
    ]
    return candidates, sum(parsed for *_, parsed, _ in outlines)


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
        if asked or worth or alike:
            # What cannot be read as code can be named, and not proposed.
            rank = worth + alike / 10 if one.kind in _READABLE else 0.0
            ranked.append((rank, msgspec.structs.replace(one, defines=mine)))
    ranked.sort(key=lambda item: (-item[0], not item[1].name.casefold().endswith(HANDED_IN), item[1].name))
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
        facts = [*filter(None, [one.kind]), *([f"defines {names}"] if names else [])]
        told.append(f"{one.name} ({', '.join(facts)})" if facts else one.name)
    more = len(candidates) - _SHOWN
    return ", ".join(told) + (f" and {more} more" if more > 0 else "")
