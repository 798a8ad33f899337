"""The only interface between authoring and grading: the checks, and verdicts on sources."""

from __future__ import annotations

import ast
import contextlib
import os
import signal
import threading
import traceback
import types
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

import msgspec
import numpy as np

from course.authoring.mistakes import Mistakes, Variant
from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.catalog.pack import pack_bytes
from course.catalog.reading import read_text
from course.errors import ContentError, CourseError, UsageError
from course.grading.intake.students import Entry
from course.grading.running.batch import Graders
from course.grading.running.snapshot import Snapshot, frozen
from course.isolation.failures import StudentFailure
from course.isolation.inside import loops
from course.isolation.inside.worker import shares_memory
from course.physics.systems import SYSTEMS
from course.progress.workspace import write_atomically
from course.scoring import kit
from course.scoring.checks.collected import Check, CollectedChecks
from course.scoring.explain.fingerprint import reached_from
from course.scoring.failures import opened_at, reason_of
from course.scoring.judging.session import check_files
from course.scoring.judging.submission import Submission, Terms
from course.scoring.values import Inspected, as_march, overwritten
from course.scoring.verdict import Verdict

# ---
# The submissions that prove an exercise: its stub, its solution, and the variants of the solution.
#
# A file in ``accepted/`` holds only the definitions that differ. It is appended to the model solution, so
# that its definitions win; what ``mistakes.py`` has is put there likewise.


def solutions_folder(catalog: Catalog, exercise: Exercise) -> Path:
    return catalog.content.instructors()[0] / exercise.place


def exercise_graders(catalog: Catalog, exercise: Exercise) -> Path:
    """Where the hidden checks of an exercise lie; a warm-up has none."""
    return catalog.content.instructors()[1] / exercise.place


def solution_path(catalog: Catalog, exercise: Exercise) -> Path:
    return solutions_folder(catalog, exercise) / exercise.module


def accepted_files(catalog: Catalog, exercise: Exercise) -> tuple[Path, ...]:
    """Correct but unusual variants, by name."""
    return tuple(sorted((solutions_folder(catalog, exercise) / "accepted").glob("*.py")))


def mistakes_path(catalog: Catalog, exercise: Exercise) -> Path:
    return solutions_folder(catalog, exercise) / "mistakes.py"


def mistakes_of(catalog: Catalog, exercise: Exercise) -> Mistakes:
    """What ``mistakes.py`` of an exercise says; nothing where there is none.

    Raises:
        ContentError: it cannot be read or raises; the message names its line.
    """
    path = mistakes_path(catalog, exercise)
    if not path.is_file():
        return Mistakes()
    with blamed(path):
        found = getattr(kit.reference(exercise.id, path.stem), "mistakes", None)
    if not isinstance(found, Mistakes):
        raise ContentError(path, 1, "it makes no `mistakes`.", help="Write: mistakes = Mistakes()")
    return found


@contextlib.contextmanager
def blamed(path: Path, at: int | None = None) -> Iterator[None]:
    """What an author's code raises, as a fault of its own file and line, or else of ``path`` and ``at``."""
    try:
        yield
    except CourseError:
        raise
    except Exception as error:
        problem, fix = f"it raises {reason_of(error)}.", "Correct that line, or what it needs."
        raise ContentError(*opened_at(error, path, at), problem, help=fix) from error


def accepted_sources(catalog: Catalog, exercise: Exercise) -> dict[str, bytes]:
    """Correct but unusual programs by name: files in ``accepted/``, and those of ``mistakes.py``."""
    solution = solution_path(catalog, exercise)
    found = {path.name: compose(solution, path) for path in accepted_files(catalog, exercise)}
    right = mistakes_of(catalog, exercise).right
    return found | {variant.name: source_of(catalog, exercise, variant) for variant in right}


def source_of(catalog: Catalog, exercise: Exercise, variant: Variant) -> bytes:
    """The model solution with a program of ``mistakes.py`` put after it."""
    model = read_text(solution_path(catalog, exercise))
    return variant.composed(model, mistakes_path(catalog, exercise)).encode()


def compose(solution: Path, variant: Path) -> bytes:
    """The model solution with a variant's definitions put after it."""
    model, own = read_text(solution), read_text(variant)
    if not own.lstrip().startswith(('"""', "#")):
        raise ContentError(
            variant, 1, "the file does not say what is unusual about it.", help="Start it with a docstring."
        )
    whole = f"{model.rstrip()}\n\n\n{own}"
    try:
        compile(whole, str(variant), "exec")
    except (SyntaxError, ValueError) as error:
        above = model.rstrip().count("\n") + 3
        line = getattr(error, "lineno", None)
        raise ContentError(
            variant,
            line - above if line and line > above else None,
            f"the model solution with this appended is not valid Python: {getattr(error, 'msg', error)}.",
            help="Keep only plain definitions in the file; __future__ imports belong in the solution.",
        ) from None
    return whole.encode("utf-8")


#: How many gradings of small exercises take as long as starting one more process.
_WORTH_A_GRADER = 25

GradeSources: TypeAlias = "Callable[[Sequence[tuple[Exercise, bytes]]], Iterator[tuple[int, Verdict]]]"


def grade_sources(
    sources: Sequence[tuple[Exercise, bytes]], *, graders: int | None = None
) -> Iterator[tuple[int, Verdict]]:
    """Grade sources as a grading run does: by grader processes, from a snapshot of the course as it is now.

    The seed is fixed: the same files get the same verdicts, in any order. Most sources
    are the model solution with a few definitions after it. A check that uses none of the changed functions,
    directly or through others, has the same result as for the model, and is not run again.

    Args:
        graders: processes, at most; None for as many as are worth it.

    Yields:
        Index and verdict, in the order in which they are reached.

    Raises:
        CourseError: nothing can be graded here.
    """
    from course.engines.results import this_machine

    if not sources:
        return
    if graders is None:
        graders = min(this_machine().cores, 1 + len(sources) // _WORTH_A_GRADER)
    catalog = Catalog()
    with (
        frozen(Snapshot.take(catalog.content)) as frozen_graders,
        Graders(Terms(graders=frozen_graders.snapshot.sha256), graders) as those,
    ):
        models = _models(catalog, dict.fromkeys(exercise for exercise, _ in sources), those)
        same: list[tuple[int, Verdict]] = []  # as the model solution, which is graded already

        def entries() -> Iterator[Entry]:
            for index, (exercise, source) in enumerate(sources):
                model, submission = models[exercise], Submission({exercise.module: source})
                if model.verdict and source.decode("utf-8", "replace").rstrip() == model.source:
                    same.append((index, model.verdict))
                else:
                    yield Entry(str(index), exercise, submission, only=model.concerned(source))

        for graded in those.grade(entries()):
            exercise, verdict = graded.entry.exercise, graded.verdict
            if graded.entry.only and verdict.state == "graded":
                verdict = models[exercise].completed(verdict, exercise)
            yield int(graded.entry.student), verdict
        yield from same


def _models(catalog: Catalog, exercises: Iterable[Exercise], graders: Graders) -> dict[Exercise, _Model]:
    """The model solution of each exercise, graded where that can save something."""
    models = dict.fromkeys(exercises, _Model())
    sources = {
        exercise: read_text(solution_path(catalog, exercise))
        for exercise in models
        if len(exercise.task) > 1  # where there is one function, every check asks for it
    }
    whole = [_model_entry(exercise, source) for exercise, source in sources.items()]
    for graded in graders.grade(whole):
        exercise, verdict = graded.entry.exercise, graded.verdict
        if verdict.state == "graded" and verdict.passed:
            asked = {check: frozenset(used) for check, used in graded.asked.items()}
            models[exercise] = _Model(sources[exercise].rstrip(), verdict, asked)
    # What an earlier check asked for and kept is asked for again where that check is not run.
    silent = [
        _model_entry(exercise, sources[exercise], checks)
        for exercise, model in models.items()
        if model.verdict is not None
        for task in exercise.task
        if (checks := model.silent(task.id))
    ]
    for graded in graders.grade(silent):
        used = frozenset(name for names in graded.asked.values() for name in names)
        models[graded.entry.exercise].asked.update(dict.fromkeys(graded.entry.only, used))
    return models


def _model_entry(exercise: Exercise, source: str, only: tuple[str, ...] = ()) -> Entry:
    return Entry("", exercise, Submission({exercise.module: source.encode()}), only=only, asks=True)


@dataclass(frozen=True, slots=True)
class _Model:
    """The model solution, its verdict, and the functions that each check used; empty if it is not graded."""

    source: str = ""
    verdict: Verdict | None = None
    asked: dict[str, frozenset[str]] = field(default_factory=dict)

    def silent(self, task: str) -> tuple[str, ...]:
        """Ids of a task's checks that used no function."""
        checks = self.verdict.checks if self.verdict else ()
        return tuple(check.id for check in checks if check.task == task and not self.asked[check.id])

    def concerned(self, source: bytes) -> tuple[str, ...]:
        """Ids of the checks that a source's changes can affect; empty means all."""
        changed = _changed(source.decode("utf-8", "replace"), self.source) if self.verdict else ()
        if not changed or self.verdict is None:
            return ()
        reach = reached_from(source, frozenset().union(*self.asked.values()))
        return tuple(
            check.id
            for check in self.verdict.checks
            if any(changed & {name, *reach.get(name, ())} for name in self.asked[check.id] or changed)
        )

    def completed(self, verdict: Verdict, exercise: Exercise) -> Verdict:
        """A verdict on the checks concerned, with the model's results for the others."""
        assert self.verdict is not None
        own = {check.id: check for check in verdict.checks}
        checks = tuple(own.get(check.id, check) for check in self.verdict.checks)
        score, most = sum(check.points for check in checks), self.verdict.max_score
        passed = score >= exercise.pass_mark * most - 1e-9  # as in GradingSession: only for rounding
        return msgspec.structs.replace(verdict, checks=checks, score=score, max_score=most, passed=passed)


def _changed(source: str, model: str) -> frozenset[str]:
    """The names that a source defines after the model solution; empty if it is not of that kind."""
    if not source.startswith(f"{model}\n"):
        return frozenset()
    try:
        tree = ast.parse(source.removeprefix(model))
    except (SyntaxError, ValueError):
        return frozenset()
    names: set[str] = set()
    for node in tree.body:
        match node:
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                names.add(name)
            case ast.Assign() | ast.AnnAssign():
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                if not all(isinstance(target, ast.Name) for target in targets):
                    return frozenset()  # it reaches into something
                names |= {target.id for target in targets if isinstance(target, ast.Name)}
            case ast.Import() | ast.ImportFrom():
                names |= {(alias.asname or alias.name).partition(".")[0] for alias in node.names}
            case ast.Expr(value=ast.Constant()):
                pass
            case _:
                return frozenset()
    return frozenset(names)


def declared_checks(exercise: Exercise, catalog: Catalog) -> dict[str, Check]:
    """The checks as pytest collects them, by id: markers whose values are computed have them here."""
    with contextlib.closing(CollectedChecks(check_files(exercise, catalog, "full"))) as collected:
        return {check.id: check for check in collected.checks}


# ---
# A submission run in this process, with the interface that checks use and no protection.
#
# It is only for the course's own programs: to find the diagnosis of every known wrong one, to calibrate
# checks, and as the unprotected side of the benchmark. It reproduces what the boundary does to values (tuples
# become lists, numpy scalars plain numbers, arrays are copied) so that a check cannot come to rely on
# something that would not cross.


_SYSTEM_TYPES = tuple(SYSTEMS.values())
_FILE = "<submission>"


class LocalSubmission:
    """One student's module, loaded here.

    Args:
        replaced: functions to put in the place of the module's own, by name.
    """

    def __init__(self, source: str, seed: int = 0, replaced: Mapping[str, Any] | None = None) -> None:
        self.seed = seed
        self.returned: tuple[str, Any] | None = None
        self.asked: set[str] = set()
        self.asking = self.marched = None
        self.faults, self.without = (), None
        self.used = 0.0
        self.heard: list[Any] = []
        self._module = types.ModuleType("submission")
        exec(compile(source, _FILE, "exec", dont_inherit=True), self._module.__dict__)
        self._module.__dict__.update(replaced or {})

    @property
    def functions(self) -> frozenset[str]:
        """Names of what can be called."""
        return frozenset(name for name, value in vars(self._module).items() if callable(value))

    def not_charged(self, seconds: float) -> None:
        """It has no limit to begin with."""

    def begin_check(self, task: str = "", patience: float | None = None) -> None:  # noqa: ARG002 - of the interface
        """Forget which functions the last check used; there is no deadline."""
        self.asked = set()

    def printed(self) -> str:
        """Empty: its output goes to this process's own."""
        return ""

    def close(self) -> None:
        """Nothing to end."""

    def call(self, name: str, *args: Any, **kwargs: Any) -> Any:
        """Call the student's function with copies of the arguments; its value as plain data."""
        return self._inspect(name, args, kwargs).value

    def call_inspect(self, name: str, *args: Any) -> Inspected:
        """Call it, and report its value and its arguments after the call."""
        return self._inspect(name, args, {})

    def call_each(self, name: str, calls: Any) -> list[Any]:
        """Call the student's function once for each sequence of arguments."""
        function = self._function(name)
        escaped: list[BaseException] = []
        given = [[_given(arg, escaped) for arg in args] for args in calls]
        values, changed = self._loop(lambda: loops.each(function, given), escaped)
        if changed is not None:
            raise overwritten(name)
        return [_plain(value) for value in values]

    def fold(self, name: str, state: Any, calls: Any, *, keep: Any = None) -> Any:
        function = self._function(name)
        escaped: list[BaseException] = []
        given = [[_given(arg, escaped) for arg in args] for args in calls]
        values, last = self._loop(lambda: loops.fold(function, _plain(state), given, keep), escaped)
        return [_plain(value) for value in (values if keep is None else [*values[:-1], last])]

    def ref(self, name: str) -> Any:
        """The student's own function, to be passed back as an argument."""
        return self._function(name)

    def march(
        self, step_name: str, system: Any, q0: Any, v0: Any, h: float, n: int, t0: float = 0.0
    ) -> tuple[Any, Any, Any]:
        """n steps in a row; times (n + 1,), positions and velocities (n + 1, d)."""
        return self.march_each(step_name, [(system, q0, v0, h, n, t0)])[0]

    def march_each(self, step_name: str, marches: Any) -> list[tuple[Any, Any, Any]]:
        """Several marches, (system, q0, v0, h, n, t0) each."""
        return [self._march(step_name, *march) for march in marches]

    def _march(self, step_name: str, system: Any, q0: Any, v0: Any, h: float, n: int, t0: float) -> Any:
        step = self._function(step_name)
        q, v = as_march(_guarded(lambda: loops.march(step, system, q0, v0, t0, h, n)), n, len(q0))
        return t0 + h * np.arange(n + 1), q, v

    def _inspect(self, name: str, args: Any, kwargs: Any) -> Inspected:
        function = self._function(name)
        escaped: list[BaseException] = []
        given = [_given(arg, escaped) for arg in args]
        named = {key: _given(arg, escaped) for key, arg in kwargs.items()}
        value = self._loop(lambda: function(*given, **named), escaped)
        after = [
            None if callable(arg) or isinstance(arg, np.random.Generator | loops.Methods) else _plain(arg)
            for arg in given
        ]
        return Inspected(_plain(value), after, shares_memory(value, given))

    def _loop(self, loop: Any, escaped: list[BaseException]) -> Any:
        """The value of student code; a callback that refused its arguments is the finding."""
        try:
            result = _guarded(loop)
        except StudentFailure:
            if not escaped:
                raise
        if escaped:
            raise escaped[0]
        return result

    def _function(self, name: str) -> Any:
        self.asked.add(name)
        function = getattr(self._module, name, None)
        if not callable(function):
            raise StudentFailure.missing(name)
        return function


class _TooLongError(KeyboardInterrupt):
    """Raised in student code that does not end: no ``except Exception`` there keeps it."""


@contextlib.contextmanager
def ending(seconds: float, said: Callable[[], ContentError]) -> Iterator[None]:
    """Stop what does not end, and keep what it prints to itself; where there is no such timer, wait.

    Raises:
        ContentError: ``said()``, after so many seconds.
    """

    def stop(*_: object) -> None:
        raise _TooLongError

    timed = hasattr(signal, "setitimer") and threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGALRM, stop) if timed else None
    try:
        if timed:
            # Again and again: a program may catch the first.
            signal.setitimer(signal.ITIMER_REAL, seconds, 1.0)
        with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere):  # noqa: PTH123
            yield
    except _TooLongError:
        raise said() from None
    finally:
        if timed:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            signal.signal(signal.SIGALRM, before or signal.SIG_DFL)


def _guarded(fn: Any) -> Any:
    """``fn()``, with the student code's exceptions as StudentFailure."""
    try:
        with np.errstate(all="ignore"):
            return fn()
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        frames = [f for f in traceback.extract_tb(error.__traceback__) if f.filename == _FILE]
        raise StudentFailure(
            "error",
            type=type(error).__name__,
            message=str(error),
            line=frames[-1].lineno if frames else None,
            traceback="".join(traceback.format_list(frames)),
            bases=[cls.__name__ for cls in type(error).__mro__],
        ) from None


def _given(value: Any, escaped: list[BaseException]) -> Any:
    """An argument as student code gets it: arrays copied, tuples as lists, callbacks behind a wrapper."""
    if isinstance(value, dict) and value.keys() == {"$methods"}:
        return loops.Methods(**{name: _given(fn, escaped) for name, fn in value["$methods"].items()})
    if isinstance(value, np.random.Generator):  # crosses as a seed
        return np.random.default_rng(int(value.integers(2**62)))
    if isinstance(value, _SYSTEM_TYPES) or not callable(value):
        return _plain(value)

    def callback(*args: Any, **kwargs: Any) -> Any:
        try:
            return _plain(value(*map(_crossing, args), **{k: _crossing(a) for k, a in kwargs.items()}))
        except BaseException as error:  # noqa: BLE001 - whatever it is, the check raises it
            escaped.append(error)
            raise ValueError("the grader's function refused its arguments") from None

    callback.original = value  # type: ignore[attr-defined]
    return callback


def _crossing(value: Any) -> Any:
    """The form in which a value arrives at a callback; a callback that is passed back arrives unchanged."""
    return getattr(value, "original", value) if callable(value) else _plain(value)


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in "fiubc":
            raise StudentFailure("protocol", message=f"an array of dtype {value.dtype}")
        return np.array(value)
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if value is None or isinstance(value, bool | int | float | str) or callable(value):
        return value
    raise StudentFailure("protocol", message=f"a value of type {type(value).__name__}")


def write_pack(catalog: Catalog, exercise_ids: Sequence[str], output: Path) -> dict[str, tuple[str, ...]]:
    """Write a pack with the model solution, and its prose if there is any, of each exercise.

    Args:
        exercise_ids: at least one; one that is named twice goes in once.
        output: must not exist; it appears whole or not at all.

    Returns:
        The names of the files that went in, by exercise.

    Raises:
        NotFoundError: there is no such exercise.
        UsageError: no exercise is named, or ``output`` cannot be written.
        MissingCapabilityError: this installation has no solutions.
    """
    catalog.content.instructors()
    if output.exists():
        raise UsageError(
            f"{output} exists, and nothing is overwritten.", help="Name another file with -o.", code="exists"
        )
    solutions = {exercise_id: _files(catalog, exercise_id) for exercise_id in exercise_ids}
    data = pack_bytes(catalog.course_id, catalog.version, solutions)
    if not os.access(output.parent, os.W_OK):
        problem = f"{output} cannot be written: {output.parent} is no folder that you can write to."
        raise UsageError(problem, help="Name a file in a folder you can write to.")
    write_atomically(output, data)
    return {exercise_id: tuple(sorted(files)) for exercise_id, files in solutions.items()}


def _files(catalog: Catalog, exercise_id: str) -> dict[str, bytes]:
    exercise = catalog.exercise(exercise_id)
    paths = [solution_path(catalog, exercise), solutions_folder(catalog, exercise) / "README.md"]
    if not paths[0].is_file():
        raise ContentError(paths[0], None, "the model solution is missing.", help="Write it first.")
    return {path.name: path.read_bytes() for path in paths if path.is_file()}
