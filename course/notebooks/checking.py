"""The public checks on a student's code from anywhere, recorded as `course check` does."""

from __future__ import annotations

import ast
import contextlib
import inspect
import os
import re
import sys
import textwrap
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.errors import CourseError, NotFoundError, UngradableError, UsageError
from course.figures.described import Curve, plot_of
from course.handed_in.attempts import Attempt, attempt
from course.handed_in.limits import SOURCES, must_fit, read_notebook
from course.handed_in.notebook import (
    SETUP,
    CodeCell,
    NotebookSource,
    code_cells,
    notebook_source,
    source_of,
    typed_cell,
)
from course.isolation.inside import statements
from course.notebooks.build import pieces
from course.notebooks.show import ReportPage, image_of
from course.printable import counted, some
from course.progress.history import fingerprint
from course.progress.workspace import Recorder, Workspace, not_recorded, same_text
from course.scoring.judging.submission import Submission
from course.scoring.verdict import CheckResult, Verdict, format_points, in_points, numbers_of
from course.strangers import read_bytes

if TYPE_CHECKING:
    from course.notebooks import Source


# ---
# The outcome of checks as a notebook shows it: a table, with the same words as in a terminal.


_MOST_LINES = 6  # lines of what was printed
_MARKS = {"pass": "✓", "skip": "–"}
_STYLE = (
    "<style>.course-checks{border-collapse:collapse}.course-checks td{text-align:left!important;"
    "vertical-align:top;padding:.35em .6em}.course-checks td:first-child{white-space:nowrap}"
    ".course-checks small{opacity:.8}</style>"
)


@dataclass
class CheckTable:
    """Checks and what they found; Jupyter shows it as a table, a plain terminal as lines.

    Attributes:
        verdict: on all public checks.
        task: show those of this function only; None shows all.
        note: another sentence to show.
        printed: what the code printed while it was loaded.
        scored: points are shown; a warm-up has none.
        curves: by id of a failed check, the student's curve and the right one; the first is drawn.
        report: what the code does on public data, shown below; None if there is none.
    """

    verdict: Verdict
    task: str | None
    note: str
    printed: str
    scored: bool
    curves: Mapping[str, Curve]
    report: ReportPage | None = None

    @property
    def checks(self) -> tuple[CheckResult, ...]:
        """Those that are shown."""
        return tuple(check for check in self.verdict.checks if self.task in (None, check.task))

    @property
    def _curve(self) -> Curve | None:
        return next((self.curves[check.id] for check in self.checks if check.id in self.curves), None)

    @property
    def passed(self) -> bool:
        return bool(self.checks) and all(check.status == "pass" for check in self.checks)

    @property
    def summary(self) -> str:
        if self.verdict.state != "graded":
            problem = self.verdict.error
            return f"{problem.message} {problem.help}" if problem else "Nothing could be checked."
        passing = sum(check.status == "pass" for check in self.checks)
        points = sum(check.points for check in self.checks)
        most = sum(check.max_points for check in self.checks)
        of = f" of {self.task}" if self.task else ""
        score = f": {format_points(points)} of {in_points(most)}" if self.scored else ""
        if len(self.checks) == 1:
            verb = "is to do" if self.checks[0].unwritten else "passes" if self.passed else "fails"
            return f"The one public check{of} {verb}{score}."
        if self.passed:
            return f"All {len(self.checks)} public checks{of} pass{score}."
        pass_ = "passes" if passing == 1 else "pass"
        return f"{passing} of {counted(len(self.checks), 'public check')}{of} {pass_}{score}."

    def __repr__(self) -> str:
        lines = _first_lines(self.printed)
        curve = self._curve.description if self._curve else ""
        report = repr(self.report) if self.report else ""
        below = [text for text in (curve, *self._notes, report) if text]
        for check in self.checks:
            mark, state = _state(check)
            lines.append(f"{mark} {check.title}{f' [{check.task}]' if self._of_several else ''}: {state}")
            lines += [f"    {text}" for text in _words(check)]
        return "\n".join([*lines, self.summary, *below])

    def _repr_html_(self) -> str:
        rows = "".join(_row(check, scored=self.scored, named=self._of_several) for check in self.checks)
        table = f'<table class="course-checks">{rows}</table>' if rows else ""
        note = "".join(f"<p>{_coded(text)}</p>" for text in self._notes)
        lines = "\n".join(_first_lines(self.printed))
        printed = f"<pre>{escape(lines)}</pre>" if lines else ""
        report = self.report._repr_html_() if self.report is not None else ""
        return f"{_STYLE}{printed}{table}<p><b>{escape(self.summary)}</b></p>{self._drawn()}{note}{report}"

    @property
    def _of_several(self) -> bool:
        """Whether there are checks of more than one function: a title alone may not say of which."""
        return len({check.task for check in self.checks}) > 1

    @property
    def _notes(self) -> Iterable[str]:
        """What to do about functions that are not written yet, once each, and all else there is to say."""
        failed = [check for check in self.checks if check.status != "pass" and not check.unwritten]
        if self.scored and not all(check.max_points for check in failed):
            yield "What fails without points costs none here; the grading run judges it."
        yield from dict.fromkeys(check.help for check in self.checks if check.unwritten)
        yield from filter(None, (*self.verdict.warnings, self.note))

    def _drawn(self) -> str:
        """The first curve, and where it leaves the right one."""
        curve = self._curve
        if curve is None:
            return ""
        # The words stand below the picture; a screen reader must not read them twice.
        image = image_of(replace(plot_of(curve), description="Your curve over the right one."))
        return f"{image}<p><small>{escape(curve.description)}</small></p>"


def _state(check: CheckResult) -> tuple[str, str]:
    """A mark and a word; what is not written yet is no mistake."""
    return ("–", "to do") if check.unwritten else (_MARKS.get(check.status, "✗"), str(check.status))


def _row(check: CheckResult, *, scored: bool, named: bool) -> str:
    of = f" <code>{check.task}</code>" if named else ""
    mark, state = _state(check)
    words = "".join(
        f"<br>{_coded(text)}" if index < 2 else f"<br><small>{escape(text)}</small>"
        for index, text in enumerate(_words(check))
    )
    reached = f"{format_points(check.points)}/{format_points(check.max_points)}" if check.max_points else ""
    points = f"<td>{reached}</td>" if scored else ""
    return f"<tr><td>{mark} {escape(state)}</td><td><b>{escape(check.title)}</b>{of}{words}</td>{points}</tr>"


def _coded(text: str) -> str:
    """Words as HTML, with code marked as code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(text))


def _words(check: CheckResult) -> list[str]:
    """Message, advice, then numbers, where there are any."""
    if check.status == "pass" or check.unwritten:
        return []
    lines = [text for text in (check.message, check.help) if text]
    lines += [f"{label}: {text}" for label, text in numbers_of(check)]
    printed = _first_lines(check.stdout or "")
    return [*lines, "your code printed:", *printed] if printed else lines


def _first_lines(text: str) -> list[str]:
    """The first printed lines, and how many more there are."""
    lines = text.rstrip().splitlines()
    left = len(lines) - _MOST_LINES
    return [*lines[:_MOST_LINES], f"and {left} more"] if left > 0 else lines


# ---
# The code that a student has in a notebook: what its file holds, or would hold if it were saved now.
#
# What is handed in is the file, so a check judges the file: its cells in their order, whatever else the
# kernel has run. Cells that were run after the file was saved take the place of what it has of them. Where
# the file is not known, the cells that were run are all there is.


#: What a note on cells that were run and not saved begins with, after the notebook's name.
NOT_SAVED = "is not saved as you ran it"
#: Cells that are not in the file get numbers from here on.
_UNSAVED = 1_000_000
#: Cells that a note names.
_NAMED = 5


@dataclass(frozen=True)
class Run:
    """A cell that was run.

    Attributes:
        number: as the notebook shows it: In [5].
        cell: its id, where the notebook's program tells it.
        at: seconds since 1970; 0 if it was not seen.
    """

    number: int
    text: str
    cell: str = ""
    at: float = 0.0


class Runs:
    """The cells that a shell runs from now on, and those that were deleted meanwhile.

    Args:
        shell: of IPython.
    """

    def __init__(self, shell: Any) -> None:
        self._shell = shell
        self._seen: dict[int, Run] = {}
        self.deleted: dict[str, float] = {}
        shell.events.register("pre_run_cell", self._before)

    def _before(self, info: Any) -> None:
        now = time.time()
        if info.store_history:
            number = len(self._shell.history_manager.input_hist_raw)  # it is put there next
            self._seen[number] = Run(number, info.raw_cell, str(getattr(info, "cell_id", None) or ""), now)
        with contextlib.suppress(Exception):  # what a program says beside a cell may have any form
            told = self._shell.get_parent().get("metadata", {}).get("deletedCells", ())
            self.deleted.update(dict.fromkeys(map(str, told), now))

    def so_far(self) -> list[Run]:
        """All cells that were run, oldest first, without the current one."""
        texts = typed_in(self._shell)
        return [self._seen.get(number, Run(number, text)) for number, text in enumerate(texts, 1)]


def typed_in(shell: Any) -> list[str]:
    """The cells that were run in a shell so far, oldest first, without the current one."""
    return list(shell.history_manager.input_hist_raw[1:-1])


def at_hand(shell: Any, exercise: Exercise) -> NotebookSource:
    """The module that the notebook of a shell makes up.

    Raises:
        UngradableError: it has none of the exercise's functions.
    """
    seen: Runs | None = getattr(shell, "course_runs", None)
    runs = seen.so_far() if seen else [Run(n, text) for n, text in enumerate(typed_in(shell), 1)]
    path = _file_of(shell, exercise, runs)
    if path is not None:
        with contextlib.suppress(CourseError, OSError):
            saved, at = code_cells(read_notebook(path), path.name), path.stat().st_mtime
            deleted = {cell for cell, when in seen.deleted.items() if when > at} if seen else set()
            kept = [cell for cell in saved if cell.id not in deleted or not cell.id]
            module = _as_saved_now(kept, at, runs, exercise, path.name)
            return replace(module, notes=(*module.notes, *_not_handed_in(path, exercise)))
    return module_of([run.text for run in runs], exercise)


def _not_handed_in(path: Path, exercise: Exercise) -> Iterable[str]:
    """A sentence if `course submit` in this workspace takes another file than a notebook."""
    with contextlib.suppress(CourseError, OSError):
        workspace = Workspace.find(Path.cwd())
        module = workspace.path(exercise.place, exercise.module)
        own = module.with_suffix(".ipynb")
        if exercise.is_warm_up:
            return
        if not own.exists() or not own.samefile(path):
            yield (
                f"{path.name} is not what is handed in: that is {workspace.shown(own)}. Give this notebook"
                " that name, or copy your cells there."
            )
            return
        given = workspace.given(exercise.place, module.name) or exercise.stub_path.read_bytes()
        if module.is_file() and not same_text(given, module.read_bytes()):
            yield f"{module.name} was worked in too: that is what is handed in, and not {path.name}."


def _file_of(shell: Any, exercise: Exercise, runs: Sequence[Run]) -> Path | None:
    """The file of the notebook that a shell belongs to, as its program tells it; or the likely one."""
    told = os.environ.get("JPY_SESSION_NAME"), shell.user_ns.get("__vsc_ipynb_file__")
    with contextlib.suppress(OSError, ValueError):
        for name in told:
            if isinstance(name, str) and name.endswith(".ipynb") and Path(name).is_file():
                return Path(name)
        likely = Path(exercise.module).with_suffix(".ipynb")
        texts = {run.text.strip() for run in runs} - {""}
        if likely.is_file():
            with contextlib.suppress(CourseError):
                there = {cell.raw.strip() for cell in code_cells(read_notebook(likely), likely.name)}
                return likely if 2 * len(texts & there) >= len(texts) else None
    return None


def _as_saved_now(
    saved: list[CodeCell], at: float, runs: Sequence[Run], exercise: Exercise, name: str
) -> NotebookSource:
    """The module of a file, with what was run after it was saved.

    Args:
        saved: its cells.
        at: when it was saved, s since 1970.
    """
    last, new = _placed(saved, at, runs)
    cells: list[CodeCell] = []
    called: dict[int, str] = {}
    unsaved: list[int] = []
    changed: list[str] = []
    for index, cell in enumerate(saved):
        run = last.get(index)
        if run is not None and run.text.strip() == cell.raw.strip():
            called[cell.number] = f"In [{run.number}]"
        elif run is not None and run.at > at:
            called[cell.number] = f"In [{run.number}]"
            unsaved.append(run.number)
            cells.append(replace(typed_cell(cell.number, run.text), tags=cell.tags))
            continue
        elif run is not None and _names(cell):
            changed.append(f"In [{run.number}]")
        cells.append(cell)
    for run in new:
        number = _UNSAVED + run.number
        called[number] = f"In [{run.number}]"
        cells.append(typed_cell(number, run.text))
        if cells[-1].text.replace("pass", "").strip():  # not a magic alone
            unsaved.append(run.number)
    module = source_of(cells, exercise, name, called)
    notes = list(module.notes)
    with contextlib.suppress(UngradableError):
        if fingerprint(source_of(saved, exercise, name).source) == fingerprint(module.source):
            unsaved = []  # none that counts
    if unsaved:
        listed = some([f"In [{number}]" for number in sorted(unsaved)], _NAMED)
        notes.append(f"{name} {NOT_SAVED}: {listed}. Only what is saved is handed in: save it.")
    if changed:
        notes.append(
            f"Changed since you ran it: {some(changed, _NAMED)}. This check took it as it is in the file now."
        )
    return replace(module, notes=tuple(notes))


def _placed(saved: list[CodeCell], at: float, runs: Sequence[Run]) -> tuple[dict[int, Run], list[Run]]:
    """The last run of each cell of a file, and runs of cells that it does not have yet."""
    ids = {cell.id: index for index, cell in enumerate(saved) if cell.id}
    texts = {cell.raw.strip(): index for index, cell in enumerate(saved)}
    defining = {name: index for index, cell in enumerate(saved) for name in _names(cell)}
    last: dict[int, Run] = {}
    new: dict[str, Run] = {}
    for run in runs:
        text, names = run.text.strip(), _names(typed_cell(1, run.text))
        index = ids.get(run.cell, texts.get(text))
        if index is None and not (run.cell and ids):
            index = next((defining[name] for name in sorted(names) if name in defining), None)
        if index is not None:
            last[index] = run
        elif run.at > at and text:
            new[run.cell or text] = run
    return last, list(new.values())


def module_of(history: Sequence[str], exercise: Exercise) -> NotebookSource:
    """The module that the cells that were run make up, where there is no file of them.

    Only the newest version of a cell counts: one is left out once everything it defined has been defined
    again.

    Args:
        history: what was run, oldest first, magics included.

    Raises:
        UngradableError: none of the exercise's functions was run yet.
    """
    marks = given(exercise)
    cells = [
        replace(typed_cell(number, text), tags=marks.get(text.strip(), {}))
        for number, text in enumerate(history, 1)
        if text.strip()
    ]
    kept: list[CodeCell] = []
    later: set[str] = set()
    for cell in reversed(cells):
        names = _names(cell) or {cell.raw.strip()}
        if names <= later:
            continue
        later |= names
        kept.append(cell)
    called = {cell.number: f"In [{cell.number}]" for cell in cells}
    return source_of(kept[::-1], exercise, "This notebook", called)


def given(exercise: Exercise) -> dict[str, dict[str, str]]:
    """The metadata of the cells in an exercise's original notebook, by their text.

    A kernel does not see metadata; and an import in such a cell counts whether it is used or not.
    """
    parts = pieces(exercise.stub_path.read_text(encoding="utf-8"), {task.id for task in exercise.task})[1]
    marks = {"exercise": exercise.id, "role": SETUP}
    return {part.text.strip(): marks for part in parts if not part.task}


def defines_all(source: bytes, names: Sequence[str]) -> bool:
    """Whether a module defines every name. True for text that is not Python: it cannot run anyway."""
    tree = typed_cell(1, source.decode()).tree
    if tree is None:
        return True
    return set(names) <= {name for node in tree.body for name in statements.bound(node)}


def _names(cell: CodeCell) -> set[str]:
    """The functions and classes that a cell defines, or would define if its syntax were right."""
    if cell.tree is None:
        return set(statements.defined_in(cell.text))
    return {
        node.name
        for node in cell.tree.body
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)
    }


def check(
    exercise_id: str, task: str | None = None, source: Source | None = None, *, shell: Any = None
) -> CheckTable:
    """Run the public checks, record the attempt, and show those of one function, or all.

    Args:
        source: see ``course.notebooks.check``.
        shell: of IPython, whose notebook is checked where there is no source; None takes the running one.

    Raises:
        NotFoundError: there is no such exercise or function.
        UngradableError: there is nothing to check yet.
    """
    catalog = Catalog()
    exercise = catalog.exercise(exercise_id)
    known = [one.id for one in exercise.task]
    if task is not None and task not in known:
        problem = f"{exercise.id} has no function {task}."
        raise NotFoundError(problem, help=f"It has: {', '.join(known)}.", code="no_such_task")
    if source is None:
        submission = at_hand(shell if shell is not None else _shell(), exercise).submission(exercise)
    else:
        submission = _submission(exercise, source)
    made = attempt(exercise, catalog, submission)
    if task is not None and not defines_all(made.source, known):
        # A function that was not run yet is not missing: the attempt is about this one alone.
        made = replace(made, verdict=_of_task(made.verdict, exercise, task), only=task)
    stub = exercise.stub_path.read_bytes()
    return CheckTable(
        made.verdict,
        task,
        note="" if fingerprint(made.source) == fingerprint(stub) else _recorded(catalog, made),
        # A cell that was run has shown what it printed.
        printed=made.printed if source is not None else "",
        scored=not exercise.is_warm_up,
        curves=made.curves,
    )


# -- what was written ------------------------------------------------------------------------------------


def _submission(exercise: Exercise, source: Source) -> Submission:
    if isinstance(source, str) and "\n" not in source and source.endswith(SOURCES):
        source = Path(source)
    if isinstance(source, Path):
        return _of_file(exercise, source)
    if isinstance(source, str):
        return _of_text(exercise, source.encode("utf-8", "replace"))
    texts = [*given(exercise), *(piece if isinstance(piece, str) else _source(piece) for piece in source)]
    return _of_text(exercise, "\n\n\n".join(texts).encode("utf-8", "replace"))


def _shell() -> Any:
    """The IPython shell this runs in, if any; asking does not import IPython."""
    found = sys.modules.get("IPython")
    shell = found.get_ipython() if found is not None else None
    if shell is None:
        problem = "There is no IPython here that knows which cells were run."
        fix = "Say what to check: source=[your_function, ...], source=Path('file.py'), or a text."
        raise UsageError(problem, help=fix, code="no_source")
    return shell


def _of_file(exercise: Exercise, path: Path) -> Submission:
    if path.suffix == ".ipynb":
        return notebook_source(read_notebook(path), exercise, path.name).submission(exercise)
    try:
        return _of_text(exercise, read_bytes(path))
    except OSError as error:
        raise NotFoundError(f"{path} cannot be read: {error.strerror or error}.", code="no_file") from error


def _of_text(exercise: Exercise, text: bytes) -> Submission:
    must_fit(len(text), "This code is")
    return Submission({exercise.module: text})


def _source(piece: Any) -> str:
    try:
        return textwrap.dedent(inspect.getsource(piece)).strip("\n")
    except (OSError, TypeError) as error:
        problem = f"The source of {piece!r:.80} cannot be found."
        fix = "source takes functions and classes that stand in a file or a cell, and texts."
        raise UsageError(problem, help=fix, code="no_source") from error


# -- the record ------------------------------------------------------------------------------------------


def _of_task(verdict: Verdict, exercise: Exercise, task: str) -> Verdict:
    """The part of a verdict that is about one function."""
    import msgspec

    if verdict.state != "graded":
        return verdict
    checks = tuple(check for check in verdict.checks if check.task == task)
    score, most = sum(check.points for check in checks), sum(check.max_points for check in checks)
    return msgspec.structs.replace(
        verdict, checks=checks, score=score, max_score=most, passed=score >= exercise.pass_mark * most
    )


def _recorded(catalog: Catalog, made: Attempt) -> str:
    """Record an attempt in the workspace, if this kernel runs in one; returns why that failed, or ""."""
    try:
        record = Recorder.of_kernel(catalog.course_id)
    except CourseError as error:
        return not_recorded(error)
    if record is None:
        return ""
    record("check", made.exercise.id, made.data(catalog.version))
    return record.trouble
