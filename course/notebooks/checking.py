"""The public checks on a student's code from anywhere, recorded as `course check` does."""

from __future__ import annotations

import inspect
import sys
import textwrap
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from course.errors import CourseError, NotFoundError, UngradableError, UsageError
from course.notebooks.findings import CheckTable
from course.notebooks.typed import at_hand, defines_all, given

if TYPE_CHECKING:
    from collections.abc import Iterable

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise
    from course.notebooks import Source
    from course.scoring.judging.submission import Submission
    from course.scoring.verdict import Verdict

__all__ = ["check", "checked", "must_have"]

#: The size of a file that a grading run takes at most, in bytes.
_MOST = 1_000_000


def check(exercise_id: str, task: str | None, source: Source | None) -> CheckTable:
    """See ``course.notebooks.check``."""
    from course.catalog.load import Catalog

    catalog = Catalog()
    exercise = catalog.exercise(exercise_id)
    must_have(exercise, task)
    return checked(catalog, exercise, _submission(exercise, source), task, prints=source is not None)


def must_have(exercise: Exercise, task: str | None) -> None:
    """Raise NotFoundError for a function that an exercise does not have."""
    known = [one.id for one in exercise.task]
    if task is not None and task not in known:
        raise NotFoundError(
            f"{exercise.id} has no function {task}.", help=f"It has: {', '.join(known)}.", code="no_such_task"
        )


def checked(
    catalog: Catalog, exercise: Exercise, submission: Submission, task: str | None, *, prints: bool = False
) -> CheckTable:
    """Run the public checks, record the attempt, and show those of one function, or all.

    Args:
        prints: show what the code printed while it was loaded; a cell that was run has shown it already.
    """
    from course.scoring.judging.session import GradingSession
    from course.scoring.judging.terms import Terms

    begin = time.perf_counter()
    with GradingSession(exercise, catalog, scope="public", terms=Terms(home=True)) as session:
        verdict, curves = session.grade(submission), session.curves
    seconds = time.perf_counter() - begin
    source, known = submission.files[exercise.module], [one.id for one in exercise.task]
    only = task if task is not None and not defines_all(source, known) else ""
    if only:
        # A function that was not run yet is not missing: the attempt is about this one alone.
        verdict = _of_task(verdict, exercise, only)
    note = _recorded(catalog, exercise, verdict, source, seconds, only=only)
    printed = session.printed if prints else ""
    return CheckTable(verdict, task, note, printed=printed, scored=not exercise.is_warm_up, curves=curves)


# -- what was written ------------------------------------------------------------------------------------


def _submission(exercise: Exercise, source: Source | None) -> Submission:
    if source is None:
        return at_hand(_shell(), exercise).submission(exercise)
    if isinstance(source, str) and "\n" not in source and source.endswith((".py", ".ipynb")):
        source = Path(source)
    if isinstance(source, Path):
        return _of_file(exercise, source)
    if isinstance(source, str):
        return _of_text(exercise, source.encode("utf-8", "replace"))
    return _of_pieces(exercise, source)


def _shell() -> Any:
    """The IPython shell this runs in, if any; asking does not import IPython."""
    found = sys.modules.get("IPython")
    shell = found.get_ipython() if found is not None else None
    if shell is None:
        raise UsageError(
            "There is no IPython here that knows which cells were run.",
            help="Say what to check: source=[your_function, ...], source=Path('file.py'), or a text.",
            code="no_source",
        )
    return shell


def _of_file(exercise: Exercise, path: Path) -> Submission:
    if path.suffix == ".ipynb":
        from course.handed_in.cells import read_notebook
        from course.handed_in.notebook import notebook_source

        return notebook_source(read_notebook(path), exercise, path.name).submission(exercise)
    try:
        return _of_text(exercise, path.read_bytes())
    except OSError as error:
        raise NotFoundError(f"{path} cannot be read: {error.strerror or error}.", code="no_file") from error


def _of_text(exercise: Exercise, text: bytes) -> Submission:
    from course.scoring.judging.submission import Submission

    if len(text) > _MOST:
        raise UngradableError(
            f"This is more than {_MOST:,} bytes of code.",
            help="Keep data out of it; the exercise needs none.",
            code="too_large",
        )
    return Submission({exercise.module: text})


def _of_pieces(exercise: Exercise, pieces: Iterable[Any]) -> Submission:
    """Functions and texts, below the exercise's own imports and constants."""
    texts = [*given(exercise), *(piece if isinstance(piece, str) else _source(piece) for piece in pieces)]
    return _of_text(exercise, "\n\n\n".join(texts).encode("utf-8", "replace"))


def _source(piece: Any) -> str:
    try:
        return textwrap.dedent(inspect.getsource(piece)).strip("\n")
    except (OSError, TypeError) as error:
        raise UsageError(
            f"The source of {piece!r:.80} cannot be found.",
            help="source takes functions and classes that stand in a file or a cell, and texts.",
            code="no_source",
        ) from error


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


def _recorded(
    catalog: Catalog, exercise: Exercise, verdict: Verdict, source: bytes, seconds: float, *, only: str = ""
) -> str:
    """Record an attempt in the workspace, if this kernel runs in one; returns why that failed, or ""."""
    from course.progress.history import check_data
    from course.progress.workspace import Workspace

    try:
        workspace = Workspace.find(Path.cwd())
        if workspace.course_id != catalog.course_id:
            return f"This was not recorded: {workspace.root} is a workspace of another course."
        data = check_data(verdict, source, seconds, catalog.version, only=only)
        workspace.store.append("check", exercise.id, data)
    except (NotFoundError, FileNotFoundError):  # also where the folder is gone
        return ""
    except CourseError as error:
        return f"This was not recorded: {error.message} {error.help}"
    return ""
