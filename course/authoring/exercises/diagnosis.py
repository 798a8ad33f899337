"""The diagnosis of every known wrong program: hypothesis by diagnosis, at home and in a grading run.

The programs are the course's own, so they run unprotected and fast, each against the checks of its own task.
The table is kept with the solution, and the page about the graders shows it.
"""

from __future__ import annotations

import ast
import contextlib
import hashlib
import itertools
import json
import math
import re
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, is_dataclass
from operator import attrgetter
from pathlib import Path
from types import ModuleType
from typing import Any

import msgspec
import numpy as np

from course.authoring.exercises.grading import (
    LocalSubmission,
    accepted_files,
    compose,
    exercise_graders,
    solution_path,
    solutions_folder,
)
from course.authoring.exercises.mutants import mutant_path
from course.authoring.exercises.source import parse
from course.authoring.report import Findings, Progress
from course.catalog.load import Catalog
from course.catalog.locate import content
from course.catalog.models import Exercise
from course.catalog.reading import read_text
from course.errors import ContentError, CourseError
from course.progress.workspace import write_atomically
from course.scoring import kit
from course.scoring.checks.collected import companion_path, words
from course.scoring.explain.fingerprint import numbers_of
from course.scoring.explain.story import (
    TABLE,
    WORDS,
    Row,
    Table,
    is_right,
    matching,
    read_table,
    read_words,
    table_bytes,
)
from course.scoring.failures import place_of, reason_of
from course.scoring.judging.explaining import answer_numbers, answers, tasks_asked
from course.scoring.judging.session import GradingSession, Scope
from course.scoring.judging.submission import Submission, Terms
from course.scoring.verdict import Status

# ---
# ``hypotheses.json``: computed on the author's machine, and part of the exercise.
#
# The wheel has no solutions. So that a diagnosis at home is as good as in a grading run, this module writes
# the answers of each known wrong program to the questions of an exercise, as fingerprints, and the expected
# values of its public checks for their fixed inputs. The audit refuses a file that is older than what it was
# made from.


HYPOTHESES = "hypotheses.py"
#: Files of an exercise, and of its solution, that the table follows from.
SOURCES = (
    ("questions.py", "checking/paths.py"),
    (HYPOTHESES, "formulas.py", "motions.py", "draws.py", "mutants.toml"),
)
#: How many programs with two mistakes are kept for a task: students hardly write more, and the wheel would
#: grow.
_MOST_PAIRS = 260


def build(catalog: Catalog, exercise: Exercise) -> Path | None:
    """Write the table of an exercise; None if it is there already, has no words or there are no questions.

    Beside its mutants an exercise may have more wrong programs, in ``hypotheses.py``.
    """
    needed = exercise.readme_path.with_name(WORDS), companion_path(exercise.id, "questions")
    if not all(path.is_file() for path in needed):
        return None
    path = exercise.readme_path.with_name(TABLE)
    data = table_bytes(table_of(catalog, exercise))
    with contextlib.suppress(OSError, ValueError):
        if _alike(json.loads(path.read_bytes()), json.loads(data)):
            return None
    write_atomically(path, data)
    return path


def _alike(one: Any, other: Any) -> bool:
    """Equal but for rounding, which differs from machine to machine."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_alike(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_alike, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=1e-9, abs_tol=1e-12)
    return bool(one == other)


def digest(catalog: Catalog, exercise: Exercise) -> str:
    """A digest of everything that the table of an exercise is computed from."""
    solutions = solutions_folder(catalog, exercise)
    own, theirs = SOURCES
    files = [exercise.readme_path.parent / name for name in own] + [solutions / name for name in theirs]
    files += [solution_path(catalog, exercise), *accepted_files(catalog, exercise)]
    files += sorted((solutions / "mutants").glob("*.py"))
    made_from = hashlib.sha256()
    for path in files:
        if path.is_file():
            made_from.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return made_from.hexdigest()[:16]


def table_of(catalog: Catalog, exercise: Exercise) -> Table:
    with _blamed(companion_path(exercise.id, "questions")):
        return _table_of(catalog, exercise)


def _table_of(catalog: Catalog, exercise: Exercise) -> Table:
    questions = kit.companion(exercise.id, "questions")
    within: dict[str, float] = getattr(questions, "WITHIN", {})
    tasks = sorted(tasks_asked(questions))
    for task in tasks:
        if task not in {task.id for task in exercise.task}:
            path = companion_path(exercise.id, "questions")
            raise ContentError(path, None, f"{task!r} is no function of the exercise.", help="Correct it.")
    right: dict[str, set[tuple[float, ...]]] = {}
    for task in tasks:
        for function in _right(catalog, exercise, task):
            for name, sums in sums_of(questions, task, function).items():
                right.setdefault(name, set()).add(sums)
    made = Table(
        made_from=digest(catalog, exercise),
        within=within,
        right={name: tuple(sorted(sums)) for name, sums in right.items()},
        answers=_plain(_expected(exercise)),
    )
    rows: dict[str, dict[tuple[float, ...], dict[tuple[str, ...], Row]]] = {name: {} for name in right}
    says = {task: _says(questions, task, next(_right(catalog, exercise, task))) for task in tasks}
    for task, codes, function in hypotheses_of(catalog, exercise):
        if len(codes) > 1 and 4 * _says(questions, task, function) < says[task]:
            continue
        for name, sums in sums_of(questions, task, function).items():
            known = rows[name].setdefault(sums, {})
            if not is_right(made, name, sums) and not any(len(other) < len(codes) for other in known):
                known.setdefault(codes, Row(codes, sums))
    made.rows.update({name: _kept(some) for name, some in rows.items()})
    return made


def _says(questions: ModuleType, task: str, function: Callable[..., Any]) -> int:
    """How many different numbers are among a function's answers.

    Two mistakes that leave hardly any, so that nothing is ever hit, would fit whatever else hits nothing.
    """
    calls = questions.QUESTIONS.get(task, ())
    local: Any = LocalSubmission("", replaced={task: function})
    return len({*numbers_of(answers(local, task, calls)).round(9)})


def _kept(rows: dict[tuple[float, ...], dict[tuple[str, ...], Row]]) -> tuple[Row, ...]:
    """All programs with one mistake, and a limited number with two, spread evenly over all of them."""
    every = [row for known in rows.values() for row in known.values()]
    single = [row for row in every if len(row.codes) == 1]
    double = [row for row in every if len(row.codes) > 1]
    return (*single, *double[:: max(1, math.ceil(len(double) / _MOST_PAIRS))])


def sums_of(questions: ModuleType, task: str, function: Callable[..., Any]) -> dict[str, tuple[float, ...]]:
    """A function's answers to the questions of its task, by name, if they are the same each time.

    A function that draws from its own generator gives different answers each time, so it cannot be
    recognised.
    """
    local: Any = LocalSubmission("", replaced={task: function})
    within = getattr(questions, "WITHIN", {}).get(task)
    found, again = (
        answer_numbers(questions, task, lambda calls: answers(local, task, calls), within) for _ in range(2)
    )
    return {
        name: numbers if within is None else tuple(float(f"{number:.5g}") for number in numbers)
        for name, numbers in found.items()
        if numbers == again[name]
    }


def hypotheses_of(
    catalog: Catalog, exercise: Exercise
) -> Iterator[tuple[str, tuple[str, ...], Callable[..., Any]]]:
    """Task, codes and function of every known wrong program: the mutants, then ``hypotheses.py``.

    Mutants whose diagnosis is not in the exercise's own words are left out: they are found while reading a
    value.
    """
    solution = solution_path(catalog, exercise)
    told = words(exercise.id).entries
    for mutant in (mutant for mutant in catalog.mutants(exercise) if mutant.diagnosis in told):
        file = mutant_path(catalog, exercise, mutant)
        with _blamed(file):
            function = _executed(compose(solution, file))[mutant.task]
        yield mutant.task, (mutant.diagnosis,), function
    path, more = solutions_folder(catalog, exercise) / HYPOTHESES, _hypotheses(exercise)
    if more is not None:
        tasks = {task.id for task in exercise.task}
        with _blamed(path):
            programs = [(task, codes, function) for task, codes, function in more.hypotheses()]
        for task, codes, function in programs:
            if task not in tasks:
                raise ContentError(
                    path, None, f"{task!r} is no function of the exercise.", help="Correct it."
                )
            for code in codes:
                if code not in told:
                    raise ContentError(path, None, f"{WORDS} has no words for {code}.", help="Write them.")
            yield task, codes, function


def _hypotheses(exercise: Exercise) -> ModuleType | None:
    """``hypotheses.py`` of an exercise; None if it has none."""
    folder = content().solution_folder(exercise.id)
    if folder is None or not (folder / HYPOTHESES).is_file():
        return None
    with _blamed(folder / HYPOTHESES):
        return kit.reference(exercise.id, "hypotheses")


@contextlib.contextmanager
def _blamed(path: Path) -> Iterator[None]:
    """What an author's code raises, as a fault of its own file and line, or else of ``path``."""
    try:
        yield
    except CourseError:
        raise
    except Exception as error:
        place = place_of(error)
        file, line = (content().root / place[0], place[1]) if place else (path, None)
        if isinstance(error, SyntaxError) and error.filename:
            file, line = Path(error.filename), error.lineno
        problem = f"it raises {reason_of(error)}."
        raise ContentError(file, line, problem, help="Correct that line, or what it needs.") from error


def _right(catalog: Catalog, exercise: Exercise, task: str) -> Iterator[Callable[..., Any]]:
    solution = solution_path(catalog, exercise)
    yield _executed(solution.read_bytes())[task]
    for path in accepted_files(catalog, exercise):
        yield _executed(compose(solution, path))[task]


def _executed(source: bytes) -> dict[str, Any]:
    namespace: dict[str, Any] = {"__name__": "submission"}
    exec(compile(source, "<submission>", "exec", dont_inherit=True), namespace)
    return namespace


def _expected(exercise: Exercise) -> dict[str, Any]:
    """The answers that public checks expect for their fixed inputs, by check."""
    known: Callable[[], dict[str, Any]] | None = (
        getattr(kit.companion(exercise.id, "bundles"), "known", None)
        if companion_path(exercise.id, "bundles").is_file()
        else None
    )
    return known() if known else {}


def _plain(value: Any) -> Any:
    """Plain values that JSON has, from which ``known_answers`` makes the same again; infinities as text."""
    if is_dataclass(value) and not isinstance(value, type):
        return [_plain(item) for item in asdict(value).values()]
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, np.ndarray):
        return {"array": _plain(value.tolist())}
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, tuple | list):
        items = [_plain(item) for item in value]
        return {"tuple": items} if isinstance(value, tuple) else items
    return str(value) if isinstance(value, float) and math.isinf(value) else value


CONFUSION = "confusion.json"
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
    paths += [path for path in others if path not in (solution, solution.with_name(HYPOTHESES))]
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
    also: dict[str, tuple[str, ...]] = getattr(_hypotheses(exercise), "ALSO", {})

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
    path = solutions_folder(catalog, exercise) / CONFUSION
    fate = fate_of(exercise)
    with _blamed(path.with_name(HYPOTHESES)):  # what the page and the audit will ask of each row
        for row in (row for rows in table.rows.values() for row in rows):
            fate(row)
    text = msgspec.json.encode(table).decode().replace("],[", "],\n[")
    write_atomically(path, f"{text}\n".encode())
    return path


def read_confusion(catalog: Catalog, exercise: Exercise) -> Confusion | None:
    """The table of an exercise; None if it has none."""
    path = solutions_folder(catalog, exercise) / CONFUSION
    return msgspec.json.decode(path.read_bytes(), type=Confusion) if path.is_file() else None


# ---
# The audit of an exercise's diagnoses: the table is up to date, and codes and entries match.


_CODE = re.compile(r"[A-Z][A-Z0-9]*(_[A-Z0-9]+)*")


def audit_diagnoses(catalog: Catalog, exercise: Exercise, findings: Findings) -> None:
    """Report missing files, stale tables, codes without words, and words that are given where untrue."""
    words_path = exercise.readme_path.with_name(WORDS)
    table_path = exercise.readme_path.with_name(TABLE)
    if not words_path.is_file():
        if (solutions_folder(catalog, exercise) / HYPOTHESES).is_file():
            findings.add(words_path, None, "words", "there are hypotheses and no words.", "Write it.")
        return
    words = read_words(words_path)
    for code, entry in words.entries.items():
        if entry.kind == "cause" and entry.looks_like.startswith("Here "):
            message = f"{code} is about one run, but as a cause it is said by every check of its task."
            findings.add(words_path, None, "words", message, 'Give it `kind = "consequence"`.')
    questions = companion_path(exercise.id, "questions")
    if not questions.is_file():
        message = f"it is missing, and {WORDS} is there: what would tell wrong programs apart?"
        findings.add(questions, None, "words", message, "Write it.")
        return
    # A warm-up's wrong programs are its mutants, each of which is graded.
    again = f"Run `course author build {exercise.id}{'' if exercise.is_warm_up else ' --confusion'}`."
    if not table_path.is_file():
        for _ in hypotheses_of(catalog, exercise):
            pass
        findings.add(table_path, None, "words", "it is missing.", again)
        return
    table = read_table(table_path)
    if table.made_from != digest(catalog, exercise):
        for _ in hypotheses_of(catalog, exercise):
            pass  # what building would refuse comes before the advice to build
        findings.add(
            table_path,
            None,
            "stale",
            "it was made from other questions, hypotheses, mutants or solutions than there are now.",
            again,
        )
    elif not exercise.is_warm_up:
        _audit_confusion(catalog, exercise, findings, again)
    _audit_codes(catalog, exercise, table, findings)


def _audit_confusion(catalog: Catalog, exercise: Exercise, findings: Findings, again: str) -> None:
    path = solutions_folder(catalog, exercise) / CONFUSION
    kept = read_confusion(catalog, exercise)
    if kept is None:
        findings.add(path, None, "stale", "it is missing.", again)
        return
    if kept.made_from != made_from(catalog, exercise):
        message = "the kept diagnoses of known wrong programs are out of date."
        findings.add(path, None, "stale", message, again)
        return
    fate = fate_of(exercise)
    for row in (row for rows in kept.rows.values() for row in rows if fate(row) == "otherwise"):
        message = f"{row.task}: programs with {', '.join(row.codes)} are told {row.said}, which is untrue."
        findings.add(path, None, "words", message, "Narrow the probe that says it.")
    for row in kept.rows["full"]:
        if len(row.codes) == 1 and row.said == "survives":
            message = f"{row.task}: no check fails for a program that is said to have {row.codes[0]}."
            findings.add(path, None, "words", message, "Add a check, or correct `hypotheses.py`.")


def _audit_codes(catalog: Catalog, exercise: Exercise, table: Table, findings: Findings) -> None:
    words_path = exercise.readme_path.with_name(WORDS)
    entries = read_words(words_path).entries
    known = {code for rows in table.rows.values() for row in rows for code in row.codes}
    given = set(_literals(catalog, exercise))
    for code in sorted(known - entries.keys()):
        path = exercise.readme_path.with_name(TABLE)
        findings.add(path, None, "words", f"{WORDS} has no words for {code}.", "Write them.")
    lines = read_text(words_path).split("\n")
    for code in sorted(entries.keys() - known - given):
        line = next((at for at, text in enumerate(lines, 1) if text == f"[diagnosis.{code}]"), None)
        named = any(code in (mutant.diagnosis, *mutant.also) for mutant in catalog.mutants(exercise))
        fix = "Add a question that its mutant answers in its own way." if named else "Take it out."
        findings.add(words_path, line, "words", f"nothing gives the diagnosis {code}.", fix)


def _literals(catalog: Catalog, exercise: Exercise) -> Iterator[str]:
    """Codes that stand as text in the checks of an exercise and their helpers."""
    folders: list[Path] = [exercise.readme_path.parent, exercise_graders(catalog, exercise)]
    for folder in folders:
        for path in sorted(folder.rglob("*.py")):
            for node in ast.walk(parse(path)):
                if (
                    isinstance(node, ast.Constant)
                    and isinstance(node.value, str)
                    and _CODE.fullmatch(node.value)
                ):
                    yield node.value
