"""The diagnosis of every known wrong program: hypothesis by diagnosis, at home and in a grading run.

The programs are the course's own, so they run unprotected and fast, each against the checks of its own task.
The table is kept with the solution, and the page about the graders shows it.
"""

from __future__ import annotations

import hashlib
import itertools
import json
from collections import Counter
from dataclasses import dataclass
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import msgspec

from course.authoring.exercises.diagnosis.build import digest, hypotheses_of, sums_of
from course.authoring.exercises.unprotected import LocalSubmission
from course.authoring.exercises.variants import exercise_graders, solution_path, solutions_folder
from course.grading import kit
from course.scoring.checks.companions import words
from course.scoring.explain.table import FILE as TABLE
from course.scoring.explain.table import matching, read_table
from course.scoring.judging.session import GradingSession, Scope, Submission
from course.scoring.judging.terms import Terms
from course.scoring.verdict import Status

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from course.authoring.report import Progress
    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = [
    "FILE",
    "Confusion",
    "Reported",
    "Tally",
    "as_one",
    "code_of",
    "confusion_of",
    "fate_of",
    "made_from",
    "read_confusion",
    "tally",
    "write_confusion",
]

FILE = "confusion.json"
#: Task, codes of what is wrong, and function.
_Program = tuple[str, tuple[str, ...], "Callable[..., Any]"]
#: Programs that are tried for a task: all with one mistake, and of those with two as many as are missing.
_EACH = 200


class Reported(msgspec.Struct, frozen=True, array_like=True):
    """How often programs with these mistakes get this diagnosis.

    Attributes:
        codes: of the mistakes in them.
        said: diagnosis, "" for none, "survives" where no check fails.
    """

    task: str
    codes: tuple[str, ...]
    said: str
    count: int


class Confusion(msgspec.Struct, frozen=True, kw_only=True):
    """``confusion.json``: rows at home ("public") and in a grading run ("full")."""

    made_from: str
    rows: dict[str, tuple[Reported, ...]]


class _Rehearsal(GradingSession):
    """A session that grades one wrong program after the other, in this process."""

    program: tuple[str, Callable[..., Any]]
    source: str

    def _load(self, submission: Submission) -> Any:  # noqa: ARG002 - the program is at hand
        task, function = self.program
        return LocalSubmission(self.source, self._terms.seed, {task: function})


def confusion_of(
    catalog: Catalog, exercise: Exercise, *, on_progress: Progress | None = None, each: int = _EACH
) -> Confusion:
    """Try ``each`` known wrong programs for every task: all with one mistake, then some with two."""
    known = list(hypotheses_of(catalog, exercise))
    chosen = [item for item in known if len(item[1]) == 1]
    for task in (task.id for task in exercise.task):
        left = each - sum(item[0] == task for item in chosen)
        pairs = [item for item in known if len(item[1]) > 1 and item[0] == task]
        # Spread evenly over all there are.
        some = [pairs[i * len(pairs) // left] for i in range(left)] if left < len(pairs) else pairs
        chosen += [as_one(exercise, item) for item in some]
    rows: dict[str, tuple[Reported, ...]] = {}
    done, scopes = 0, ("public", "full")
    for scope in scopes:
        counts: Counter[tuple[str, tuple[str, ...], str]] = Counter()
        for task, codes, said in _tried(catalog, exercise, scope, chosen):  # type: ignore[arg-type]
            counts[task, codes, said] += 1
            done += 1
            if on_progress:
                on_progress(done, len(scopes) * len(chosen), exercise.id)
        rows[scope] = tuple(Reported(*key, count) for key, count in sorted(counts.items()))
    return Confusion(made_from=made_from(catalog, exercise), rows=rows)


def as_one(exercise: Exercise, program: _Program) -> _Program:
    """A program with two mistakes; if it answers every question like one with a single mistake, it is that.

    If it answers like others with two, and the table has only those, it is one of them.
    Two terms of a formula may be changed so that one mistake results: Runge and Kutta's four slopes, of which
    only the ends count and the last starts from the first, are Heun's method.
    """
    task, codes, function = program
    table = read_table(exercise.readme_path.with_name(TABLE))
    fits = [
        matching(table, name, sums)
        for name, sums in sums_of(kit.companion(exercise.id, "questions"), task, function).items()
    ]
    rows = fits[0] if len(fits) == 1 else ()
    if rows and (len(rows[0].codes) == 1 or set(codes) not in [set(row.codes) for row in rows]):
        codes = rows[0].codes
    return task, codes, function


def made_from(catalog: Catalog, exercise: Exercise) -> str:
    """A digest of every file that affects the diagnosis of a wrong program; how it is worded does not."""
    code = code_of(catalog, exercise, "*.py", "hypotheses.json")
    found = hashlib.sha256(digest(catalog, exercise).encode() + code)
    kinds = {code: entry.kind for code, entry in words(exercise.id).entries.items()}
    found.update(json.dumps(kinds, sort_keys=True).encode())
    return found.hexdigest()[:16]


def code_of(catalog: Catalog, exercise: Exercise, *patterns: str) -> bytes:
    """The files that decide about a program, in a row: the exercise's, its graders' and the references'."""
    folders = (exercise.readme_path.parent, exercise_graders(catalog, exercise))
    paths = [
        path
        for folder in folders
        for path in sorted(itertools.chain(*map(folder.rglob, patterns)), key=attrgetter("name"))
    ]
    solution = solution_path(catalog, exercise)
    others = sorted(solution.parent.glob("*.py"))
    paths += [path for path in others if path not in (solution, solution.with_name("hypotheses.py"))]
    return b"".join(path.name.encode() + b"\0" + path.read_bytes() + b"\0" for path in paths)


def _tried(
    catalog: Catalog,
    exercise: Exercise,
    scope: Scope,
    chosen: list[_Program],
) -> Iterator[tuple[str, tuple[str, ...], str]]:
    source = solution_path(catalog, exercise).read_text(encoding="utf-8")
    own = words(exercise.id)
    with _Rehearsal(exercise, catalog, scope=scope, terms=Terms(timeout=60.0)) as session:
        session.source = source
        every = session._checks.in_order()
        for task, codes, function in chosen:
            session.program = task, function
            session._checks.in_order = lambda task=task: [c for c in every if c.task == task]  # type: ignore[method-assign, misc]
            verdict = session.grade(Submission({exercise.module: source.encode()}))
            said = [check.diagnosis or "" for check in verdict.checks if check.status is not Status.PASS]
            yield task, codes, _main(said, codes, own.kind) if said else "survives"


def _main(said: list[str], codes: tuple[str, ...], kind: Callable[[str], str]) -> str:
    """The diagnosis for several failed checks: the common one, else the first cause, else a fact."""
    if set(said) & set(codes):
        wrong = [code for code in said if code and code not in codes and kind(code) == "cause"]
        return wrong[0] if wrong else next(code for code in codes if code in said)
    ranked = sorted(
        filter(None, said), key=lambda code: ("cause", "nan", "consequence", "fact").index(kind(code))
    )
    return ranked[0] if ranked else ""


@dataclass(frozen=True, slots=True)
class Tally:
    """How the programs of one task are diagnosed.

    Attributes:
        named: diagnosed with a mistake that they have, under any name of the same program.
        general: diagnosed with a consequence, with a wrong kind of value, or not at all.
        otherwise: diagnosed with a mistake that they do not have.
        survived: no check fails; a program with two mistakes may be right by chance.
    """

    named: int = 0
    general: int = 0
    otherwise: int = 0
    survived: int = 0

    def __add__(self, other: Tally) -> Tally:
        return Tally(
            self.named + other.named,
            self.general + other.general,
            self.otherwise + other.otherwise,
            self.survived + other.survived,
        )


def tally(fate: Callable[[Reported], str], rows: tuple[Reported, ...]) -> Tally:
    """How the programs of these rows are diagnosed."""
    return sum((Tally(**{fate(row): row.count}) for row in rows), Tally())


def fate_of(exercise: Exercise) -> Callable[[Reported], str]:
    """Says under which field of ``Tally`` the programs of a row are counted.

    ``ALSO`` in ``hypotheses.py`` has, by code, what else is true of a program with that mistake.
    """
    own, names = words(exercise.id), _names(exercise)
    also: dict[str, tuple[str, ...]] = getattr(kit.reference(exercise.id, "hypotheses"), "ALSO", {})

    def fate(row: Reported) -> str:
        if row.said == "survives":
            return "survived"
        if any(
            row.said in {code, *also.get(code, ())} or (row.task, code, row.said) in names
            for code in row.codes
        ):
            return "named"
        return "general" if not row.said or own.kind(row.said) != "cause" else "otherwise"

    return fate


def _names(exercise: Exercise) -> set[tuple[str, str, str]]:
    """(task, code, code) of programs with one mistake and the same answers to every question."""
    found = set()
    for name, rows in read_table(exercise.readme_path.with_name(TABLE)).rows.items():
        task = name.partition(".")[0]  # parts of a task are "task.part"
        same: dict[tuple[float, ...], set[str]] = {}
        for row in rows:
            if len(row.codes) == 1:
                same.setdefault(row.sums, set()).add(row.codes[0])
        found |= {(task, one, other) for codes in same.values() for one in codes for other in codes}
    return found


def write_confusion(catalog: Catalog, exercise: Exercise, table: Confusion) -> Path:
    """Write the table beside the solution, one row a line."""
    path = solutions_folder(catalog, exercise) / FILE
    text = msgspec.json.encode(table).decode().replace("],[", "],\n[")
    path.write_text(text + "\n", encoding="utf-8")
    return path


def read_confusion(catalog: Catalog, exercise: Exercise) -> Confusion | None:
    """The table of an exercise; None if it has none."""
    path = solutions_folder(catalog, exercise) / FILE
    return msgspec.json.decode(path.read_bytes(), type=Confusion) if path.is_file() else None
