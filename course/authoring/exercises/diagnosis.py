"""The diagnosis of every known wrong program: hypothesis by diagnosis, at home and in a grading run.

The programs are the course's own, so they run unprotected and fast, each against the checks of its own task.
What comes of it is kept with the solution, as its record.
"""

from __future__ import annotations

import ast
import contextlib
import hashlib
import inspect
import math
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, is_dataclass
from functools import partial
from operator import attrgetter
from pathlib import Path
from types import ModuleType
from typing import Any

import msgspec
import numpy as np

from course.authoring.exercises.files import digest_of
from course.authoring.exercises.grading import (
    LocalSubmission,
    accepted_files,
    accepted_sources,
    blamed,
    ending,
    exercise_graders,
    mistakes_of,
    mistakes_path,
    solution_path,
    solutions_folder,
    source_of,
)
from course.authoring.exercises.proofs import (
    Record,
    Reported,
    read_record,
    record_path,
    run_mutants,
    write_record,
)
from course.authoring.exercises.source import parse
from course.authoring.mistakes import CODE, Mistakes, Wrong
from course.authoring.report import Findings, Progress
from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.errors import ContentError
from course.progress.workspace import write_atomically
from course.scoring import kit
from course.scoring.checks.collected import companion_path, questions_of, questions_path, words
from course.scoring.explain.fingerprint import numbers_of
from course.scoring.explain.story import (
    Row,
    Table,
    forget_tables,
    is_right,
    matching,
    read_table,
    table_path,
    tables_in,
    words_in,
)
from course.scoring.judging.explaining import Explainer, answer_numbers, answers, tasks_asked
from course.scoring.judging.session import GradingSession, Scope
from course.scoring.judging.submission import Submission, Terms
from course.scoring.verdict import Status

# ---
# ``diagnoses.json``: computed on the author's machine, and part of the exercise.
#
# The wheel has no solutions. So that a diagnosis at home is as good as in a grading run, this module writes
# the words of ``mistakes.py``, the answers of each known wrong program to the questions of an exercise, as
# fingerprints, and the expected values of its public checks for their fixed inputs. The audit refuses a file
# that is older than what it was made from.


#: Files of an exercise, and of its solution beside ``mistakes.py``, that the table follows from.
SOURCES = (("checking/paths.py",), ("formulas.py", "motions.py", "draws.py"))
#: How many programs with two mistakes are kept for a task, if the exercise's questions have no ``PAIRS``:
#: students hardly write more, and the wheel would grow.
_MOST_PAIRS = 260


def build(catalog: Catalog, exercise: Exercise) -> Path | None:
    """Write the table of an exercise; None if it is there already, or nothing is known of its mistakes."""
    if not mistakes_of(catalog, exercise).words:
        return None
    folder = exercise.readme_path.parent
    path = questions_path(exercise.id)
    with blamed(path):
        questions = questions_of(exercise.id) if path.is_file() else None
        made = _table_of(catalog, exercise, questions)
    with contextlib.suppress(ContentError):
        if _alike(msgspec.to_builtins(read_table(folder)), msgspec.to_builtins(made)):
            return None
    return _write_table(folder, made)


def _write_table(folder: Path, table: Table) -> Path:
    """Write the table of the exercise in this folder, an entry or a row a line; warm-ups share a file."""
    path = table_path(folder)
    if path.parent == folder:
        text = _lines(table)
    else:
        every = (tables_in(path) if path.is_file() else {}) | {folder.name: table}
        kept = sorted(name for name in every if (path.parent / name).is_dir())
        text = "{" + ",\n".join(f'"{name}": {_lines(every[name])}' for name in kept) + "}"
    write_atomically(path, f"{text}\n".encode())
    forget_tables()
    words_in(folder)  # for the probes that are loaded already
    return path


def _lines(table: Table) -> str:
    text = msgspec.json.format(msgspec.json.encode(table), indent=0).decode().replace("\n", "")
    return text.replace("]],[[", "]],\n[[").replace('"},"', '"},\n"')


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
    file = mistakes_path(catalog, exercise)
    return _digest(catalog, exercise, file.read_bytes() if file.is_file() else b"")


def _digest(catalog: Catalog, exercise: Exercise, mistakes: bytes) -> str:
    solutions = solutions_folder(catalog, exercise)
    own, theirs = SOURCES
    files = [exercise.readme_path.parent / name for name in own] + [solutions / name for name in theirs]
    files += [
        questions_path(exercise.id),
        solution_path(catalog, exercise),
        *accepted_files(catalog, exercise),
    ]
    return digest_of(files, mistakes)


def _table_of(catalog: Catalog, exercise: Exercise, questions: ModuleType | None) -> Table:
    made = Table(
        made_from=digest(catalog, exercise),
        words=mistakes_of(catalog, exercise).words,
        within=getattr(questions, "WITHIN", {}),
        answers=_plain(_expected(exercise)),
    )
    if questions is None:
        return made
    tasks = sorted(tasks_asked(questions))
    for task in tasks:
        if task not in {task.id for task in exercise.task}:
            raise _no_task(questions_path(exercise.id), None, task)
    right: dict[str, set[tuple[float, ...]]] = {}
    for task in tasks:
        _expect_callable(questions, exercise.id, task, next(_right(catalog, exercise, task)))
        for function in _right(catalog, exercise, task):
            for name, sums in sums_of(questions, task, function).items():
                right.setdefault(name, set()).add(sums)
    made.right.update({name: tuple(sorted(sums)) for name, sums in right.items()})
    rows: dict[str, dict[tuple[float, ...], dict[tuple[str, ...], Row]]] = {name: {} for name in right}
    says = {task: _says(questions, task, next(_right(catalog, exercise, task))) for task in tasks}
    for task, codes, function in hypotheses_of(catalog, exercise):
        with ending(_PATIENCE, partial(_endless, catalog, exercise, task, codes)):
            if len(codes) > 1 and 4 * _says(questions, task, function) < says[task]:
                continue
            found = sums_of(questions, task, function)
        for name, sums in found.items():
            known = rows[name].setdefault(sums, {})
            if not is_right(made, name, sums) and not any(len(other) < len(codes) for other in known):
                known.setdefault(codes, Row(codes, sums))
    most = getattr(questions, "PAIRS", _MOST_PAIRS)
    made.rows.update({name: _kept(some, most) for name, some in rows.items()})
    return made


#: s, for all of a program's questions; each of the course's own programs ends within it.
_PATIENCE = 60.0


def _endless(catalog: Catalog, exercise: Exercise, task: str, codes: tuple[str, ...]) -> ContentError:
    mistakes = mistakes_of(catalog, exercise)
    line = next((one.line for one in mistakes.wrong if (one.task, one.code) == (task, codes[0])), None)
    return ContentError(
        mistakes_path(catalog, exercise),
        line or mistakes.lines.get(codes[0]),
        f"{task}: after {_PATIENCE:.0f} s {' and '.join(codes)} left the questions unanswered.",
        help="What never ends is named as that, whatever its words: write one that ends, or take it out.",
    )


def _expect_callable(questions: ModuleType, exercise_id: str, task: str, function: Any) -> None:
    """Each question has as many arguments as the function takes."""
    path, asked = questions_path(exercise_id), questions.QUESTIONS.get(task, ())
    calls = asked if task not in getattr(questions, "ASK", {}) else ()
    for number, args in enumerate(calls, 1):
        try:
            inspect.signature(function).bind(*args)
        except TypeError as error:
            said = f"question {number} of {task} cannot be asked: {error}."
            raise ContentError(path, None, said, help="Correct its arguments.") from None


def _says(questions: ModuleType, task: str, function: Callable[..., Any]) -> int:
    """How many different numbers are among a function's answers.

    Two mistakes that leave hardly any, so that nothing is ever hit, would fit whatever else hits nothing.
    """
    calls = questions.QUESTIONS.get(task, ())
    local: Any = LocalSubmission("", replaced={task: function})
    return len({*numbers_of(answers(local, task, calls)).round(9)})


def _kept(rows: dict[tuple[float, ...], dict[tuple[str, ...], Row]], most: int) -> tuple[Row, ...]:
    """All programs with one mistake, and a limited number with two, spread evenly over all of them."""
    every = [row for known in rows.values() for row in known.values()]
    single = [row for row in every if len(row.codes) == 1]
    double = [row for row in every if len(row.codes) > 1]
    return (*single, *double[:: max(1, math.ceil(len(double) / most))])


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


def hypotheses_of(catalog: Catalog, exercise: Exercise) -> Iterator[Wrong]:
    """Task, codes and function of every known wrong program: those that are texts first.

    Those whose code has no words of the exercise's own are left out: it is found while reading a value.
    """
    mistakes, file = mistakes_of(catalog, exercise), mistakes_path(catalog, exercise)
    tasks = {task.id for task in exercise.task}
    for variant in (variant for variant in mistakes.wrong if variant.code in mistakes.words):
        source = source_of(catalog, exercise, variant)
        if variant.task not in tasks:
            raise _no_task(file, variant.line, variant.task)
        with blamed(file, variant.line):
            function = _executed(source)[variant.task]
        yield variant.task, (variant.code,), function
    with blamed(file):
        programs = [(task, codes, function) for task, codes, function in mistakes.functions()]
    for task, codes, function in programs:
        if task not in tasks:
            raise _no_task(file, None, task)
        for code in codes:
            if code not in mistakes.words:
                raise ContentError(file, None, f"there are no words for {code}.", help="Write them.")
        yield task, codes, function


def _no_task(file: Path, line: int | None, task: str) -> ContentError:
    return ContentError(file, line, f"{task!r} is no function of the exercise.", help="Correct it.")


def _right(catalog: Catalog, exercise: Exercise, task: str) -> Iterator[Callable[..., Any]]:
    yield _executed(solution_path(catalog, exercise).read_bytes())[task]
    for source in accepted_sources(catalog, exercise).values():
        yield _executed(source)[task]


def _executed(source: bytes) -> dict[str, Any]:
    namespace: dict[str, Any] = {"__name__": "submission"}
    exec(compile(source, "<submission>", "exec", dont_inherit=True), namespace)
    return namespace


def _expected(exercise: Exercise) -> dict[str, Any]:
    """The answers that public checks expect for their fixed inputs, by check."""
    if not companion_path(exercise.id, "bundles").is_file():
        return {}
    known: Callable[[], dict[str, Any]] = getattr(kit.companion(exercise.id, "bundles"), "known", dict)
    return known()


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


#: Programs that are tried for a task: all with one mistake, and of those with two as many as are missing.
_EACH = 200


class _Rehearsal(GradingSession):
    """A session that grades one wrong program after the other, in this process."""

    program: tuple[str, Callable[..., Any]]
    source: str

    def _load(self, submission: Submission) -> Any:  # noqa: ARG002 - the program is at hand
        task, function = self.program
        return LocalSubmission(self.source, self._terms.seed, {task: function})


def rows_of(
    catalog: Catalog,
    exercise: Exercise,
    *,
    scopes: tuple[str, ...] = ("public", "full", "alone"),
    on_progress: Progress | None = None,
) -> dict[str, tuple[Reported, ...]]:
    """Try known wrong programs for every task: all with one mistake, then some with two.

    Returns:
        By scope, what they are told at home ("public"), in a grading run ("full"), and in one that knows none
        of them ("alone"; those with one mistake): as a program that nobody foresaw, only a check's own probe
        can name it.
    """
    known = list(hypotheses_of(catalog, exercise))
    single = [item for item in known if len(item[1]) == 1]
    chosen = list(single)
    for task in (task.id for task in exercise.task):
        left = _EACH - sum(item[0] == task for item in chosen)
        pairs = [item for item in known if len(item[1]) > 1 and item[0] == task]
        # As if by lot, by their names alone: another program moves few of those that are tried.
        seen: Counter[tuple[str, ...]] = Counter()
        lots = []
        for item in pairs:
            seen[item[1]] += 1
            lots.append((hashlib.sha256(f"{task} {item[1]} {seen[item[1]]}".encode()).digest(), item))
        chosen += [as_one(exercise, item) for _, item in sorted(lots, key=lambda lot: lot[0])[: max(left, 0)]]
    tried = {scope: single if scope == "alone" else chosen for scope in scopes}
    rows: dict[str, tuple[Reported, ...]] = {}
    done, total = 0, sum(map(len, tried.values()))
    for scope, programs in tried.items():
        counts: Counter[tuple[str, tuple[str, ...], str]] = Counter()
        for task, codes, said in _tried(catalog, exercise, scope, programs):
            counts[task, codes, said] += 1
            done += 1
            if on_progress:
                on_progress(done, total, exercise.id)
        rows[scope] = tuple(Reported(*key, count) for key, count in sorted(counts.items()))
    return rows


def as_one(exercise: Exercise, program: Wrong) -> Wrong:
    """A program with two mistakes; if it answers every question like one with a single mistake, it is that.

    If it answers like others with two, and the table has only those, it is one of them.
    Two terms of a formula may be changed so that one mistake results: Runge and Kutta's four slopes, of which
    only the ends count and the last starts from the first, are Heun's method.
    """
    task, codes, function = program
    table, questions = read_table(exercise.readme_path.parent), questions_of(exercise.id)
    if table is None or questions is None:
        return program
    fits = [matching(table, name, sums) for name, sums in sums_of(questions, task, function).items()]
    rows = fits[0] if len(fits) == 1 else ()
    if rows and (len(rows[0].codes) == 1 or set(codes) not in [set(row.codes) for row in rows]):
        codes = rows[0].codes
    return task, codes, function


def made_from(catalog: Catalog, exercise: Exercise) -> str:
    """A digest of every file that affects the diagnosis of a wrong program; how it is worded does not."""
    file = mistakes_path(catalog, exercise)
    mistakes = parse(file) if file.is_file() else ast.Module([], [])
    for node in ast.walk(mistakes):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "mistakes":
            node.args[1:] = []
    code = _digest(catalog, exercise, _dumped(mistakes).encode()).encode() + code_of(catalog, exercise)
    return hashlib.sha256(code).hexdigest()[:16]


def code_of(catalog: Catalog, exercise: Exercise) -> bytes:
    """The code that decides about a program, in a row: the exercise's, its graders' and the references'.

    How it is worded does not decide: comments, docstrings (a check's is its title) and what is said beside a
    comparison are left out.
    """
    solution = solution_path(catalog, exercise)
    folders = (exercise.readme_path.parent, exercise_graders(catalog, exercise))
    paths = [p for folder in folders for p in sorted(folder.rglob("*.py"), key=attrgetter("name"))]
    paths = [path for path in paths if path.name != "report.py"]  # it draws what was decided
    others = sorted(solution.parent.glob("*.py"))
    paths += [path for path in others if path not in (solution, mistakes_path(catalog, exercise))]
    return b"".join(path.name.encode() + b"\0" + _unworded(path) + b"\0" for path in paths)


#: Arguments of a check's comparison that are only read.
_WORDS = frozenset({"message", "help", "quantity", "source"})


def _unworded(path: Path) -> bytes:
    tree = parse(path)
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Module | ast.FunctionDef | ast.ClassDef)
            and ast.get_docstring(node) is not None
        ):
            node.body[:1] = []
        if isinstance(node, ast.Call):
            node.keywords = [
                one
                for one in node.keywords
                if one.arg not in _WORDS or not isinstance(one.value, ast.Constant)
            ]
    return _dumped(tree).encode()


def _dumped(node: Any) -> str:
    """A tree as text; `ast.dump` writes empty lists in some versions of Python and not in others."""
    if isinstance(node, list):
        return f"[{','.join(map(_dumped, node))}]"
    if not isinstance(node, ast.AST):
        return repr(node)
    fields = (f"{name}={_dumped(value)}" for name, value in ast.iter_fields(node) if value not in (None, []))
    return f"{type(node).__name__}({','.join(fields)})"


def _tried(
    catalog: Catalog, exercise: Exercise, scope: str, chosen: list[Wrong]
) -> Iterator[tuple[str, tuple[str, ...], str]]:
    source = solution_path(catalog, exercise).read_text(encoding="utf-8")
    own, table = words(exercise.id), read_table(exercise.readme_path.parent)
    of_checks: Scope = "public" if scope == "public" else "full"
    with _Rehearsal(exercise, catalog, scope=of_checks, terms=Terms(timeout=60.0)) as session:
        session.source = source
        if scope == "alone" and table is not None and (questions := questions_of(exercise.id)):
            session._explainer = Explainer(msgspec.structs.replace(table, rows={}), questions)
        for task, codes, function in chosen:
            session.program = task, function
            own_checks = [check.id for check in session.checks if check.task == task]
            if not own_checks:  # which would mean all of them
                yield task, codes, "survives"
                continue
            with warnings.catch_warnings():  # a program only warns, whatever this process makes of warnings
                warnings.simplefilter("ignore")
                verdict = session.grade(Submission({exercise.module: source.encode()}), only=own_checks)
            said = [check.diagnosis or "" for check in verdict.checks if check.status is not Status.PASS]
            yield task, codes, _main(said, codes, own.kind) if said else "survives"


def _main(said: list[str], codes: tuple[str, ...], kind: Callable[[str], str]) -> str:
    """The diagnosis for several failed checks: the common one, else the first cause, else a fact."""
    if set(said) & set(codes):
        wrong = [code for code in said if code and code not in codes and kind(code) == "cause"]
        return wrong[0] if wrong else next(code for code in codes if code in said)
    ranks = ("cause", "nan", "consequence", "fact")
    ranked = sorted(filter(None, said), key=lambda code: ranks.index(kind(code)))
    return ranked[0] if ranked else ""


#: How a program is diagnosed: with a mistake that it has, under any name of the same program; with a
#: consequence, with a wrong kind of value, or not at all; with a mistake that it does not have; no check
#: fails, for one with two mistakes may be right by chance.
FATES = ("named", "general", "otherwise", "survived")


def fate_of(catalog: Catalog, exercise: Exercise) -> Callable[[Reported], str]:
    """Says which of ``FATES`` the programs of a row have."""
    own, names, also = words(exercise.id), _names(exercise), mistakes_of(catalog, exercise).true_too

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
    table = read_table(exercise.readme_path.parent)
    for name, rows in table.rows.items() if table else ():
        task = name.partition(".")[0]  # parts of a task are "task.part"
        same: dict[tuple[float, ...], set[str]] = {}
        for row in rows:
            if len(row.codes) == 1:
                same.setdefault(row.sums, set()).add(row.codes[0])
        found |= {(task, one, other) for codes in same.values() for one in codes for other in codes}
    return found


@dataclass(frozen=True, slots=True)
class Accepted:
    """A new record, and what it says otherwise than the one before.

    Attributes:
        changes: a sentence for each program that is caught or named otherwise.
        told: how many of the programs that are functions have each of ``FATES`` in a grading run.
    """

    path: Path
    changes: tuple[str, ...]
    told: dict[str, int]


def accept(catalog: Catalog, exercise: Exercise, *, on_progress: Progress | None = None) -> Accepted:
    """Grade every wrong program of an exercise, and write what comes of it as its record."""
    before = read_record(catalog, exercise) or Record()
    outcomes = run_mutants(catalog, exercise, on_progress=on_progress)
    caught = {one.mutant.name: one.by for one in outcomes}
    changes = [
        f"{name}: caught by {caught[name] or 'no check'}, and was by {check}."
        for name, check in before.caught.items()
        if name in caught and caught[name] != check
    ]
    changes += [
        f"{one.mutant.name}: told {one.diagnosis or 'nothing'}, not {one.mutant.code}."
        for one in outcomes
        if (one.diagnosis or "") not in (one.mutant.code, *one.mutant.also)
    ]
    rows, fate = rows_of(catalog, exercise, on_progress=on_progress), fate_of(catalog, exercise)
    for scope, where in {"full": "", "alone": " by a check alone"}.items():
        named = {(r.task, r.codes) for r in before.rows.get(scope, ()) if fate(r) == "named"}
        still = {(r.task, r.codes) for r in rows[scope] if fate(r) == "named"}
        known = {(r.task, r.codes) for r in rows[scope]}
        changes += [
            f"{task}: {' and '.join(codes)} is no longer named{where}."
            for task, codes in sorted(named & known - still)
        ]
    record = Record(made_from=made_from(catalog, exercise), caught=caught, rows=rows)
    path = write_record(catalog, exercise, record)
    told = dict.fromkeys(FATES, 0)
    for row in rows["full"]:
        told[fate(row)] += row.count
    return Accepted(path, tuple(changes), told)


# ---
# The audit of an exercise's diagnoses: the table is up to date, and codes and entries match.


def audit_diagnoses(catalog: Catalog, exercise: Exercise, findings: Findings) -> None:
    """Report missing files, stale tables, codes without words, and words that are given where untrue."""
    mistakes, file = mistakes_of(catalog, exercise), mistakes_path(catalog, exercise)
    for code, entry in mistakes.words.items():
        if entry.kind == "cause" and entry.looks_like.startswith("Here "):
            message = f"{code} is about one run, but as a cause it is said by every check of its task."
            findings.add(file, mistakes.lines[code], "words", message, 'Give it `kind="consequence"`.')
    if mistakes.words:
        questions = questions_path(exercise.id)
        with blamed(questions):
            asked = questions_of(exercise.id) if questions.is_file() else None
        if not asked:
            if not exercise.is_warm_up:  # whose checks may have them
                questions = exercise.checks_path.with_name("questions.py")
            message = "it asks no QUESTIONS, and there are words: what would tell wrong programs apart?"
            findings.add(questions, None, "words", message, "Write it.")
            return
        path, table = table_path(exercise.readme_path.parent), read_table(exercise.readme_path.parent)
        if table is None or table.made_from != digest(catalog, exercise):
            with blamed(questions):  # what building would refuse comes before the advice to build
                _table_of(catalog, exercise, asked)
            message = "it was made from other questions, mistakes or solutions than there are now."
            code, message = ("stale", message) if table else ("words", f"it has nothing on {exercise.id}.")
            findings.add(path, None, code, message, f"Run `course author build {exercise.id}`.")
            return
        _audit_codes(catalog, exercise, table, mistakes, findings)
    if not exercise.is_warm_up:
        _audit_record(catalog, exercise, findings)


def is_older(catalog: Catalog, exercise: Exercise) -> bool:
    """Whether the record of an exercise is of other programs or checks than there are, or is not there."""
    if exercise.is_warm_up:
        return False
    kept, mistakes = read_record(catalog, exercise) or Record(), mistakes_of(catalog, exercise)
    # Without words nothing is told but what checks say by themselves, and that is graded each time.
    told = kept.made_from == made_from(catalog, exercise) or not mistakes.words
    return not told or kept.caught.keys() != {variant.name for variant in mistakes.wrong}


def _audit_record(catalog: Catalog, exercise: Exercise, findings: Findings) -> None:
    path, kept = record_path(catalog, exercise), read_record(catalog, exercise)
    again = f"Run `course author build {exercise.id} --accept`, and read what it says."
    if kept is None:
        findings.add(path, None, "stale", "it is missing.", again)
        return
    if is_older(catalog, exercise):
        message = "the record of what wrong programs are told is out of date."
        findings.add(path, None, "stale", message, again)
        return
    fate = fate_of(catalog, exercise)
    # What a probe says "alone" is often a wider name for the same, and true.
    said = (row for scope, rows in kept.rows.items() if scope != "alone" for row in rows)
    for row in (row for row in said if fate(row) == "otherwise"):
        message = f"{row.task}: programs with {', '.join(row.codes)} are told {row.said}, which is untrue."
        findings.add(path, None, "words", message, "Narrow the probe that says it.")
    for row in kept.rows.get("full", ()):
        if len(row.codes) == 1 and row.said == "survives":
            message = f"{row.task}: no check fails for a program that is said to have {row.codes[0]}."
            findings.add(path, None, "words", message, "Add a check, or correct `mistakes.py`.")


def _audit_codes(
    catalog: Catalog, exercise: Exercise, table: Table, mistakes: Mistakes, findings: Findings
) -> None:
    """Every code with words is given by something."""
    file = mistakes_path(catalog, exercise)
    known = {code for rows in table.rows.values() for row in rows for code in row.codes}
    given, named = set(_literals(catalog, exercise)), {variant.code for variant in mistakes.wrong}
    for code in sorted(mistakes.words.keys() - known - given):
        fix = "Take it out."
        if code in named:
            fix = "Add a question that its program answers in its own way, or see whether it is wrong at all."
        findings.add(file, mistakes.lines[code], "words", f"nothing gives the diagnosis {code}.", fix)


def _literals(catalog: Catalog, exercise: Exercise) -> Iterator[str]:
    """Codes that stand as text in the checks of an exercise and their helpers."""
    for folder in (exercise.readme_path.parent, exercise_graders(catalog, exercise)):
        for path in sorted(folder.rglob("*.py")):
            texts = (node.value for node in ast.walk(parse(path)) if isinstance(node, ast.Constant))
            yield from (text for text in texts if isinstance(text, str) and CODE.fullmatch(text))
