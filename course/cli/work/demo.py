"""``course demo``: what checking looks like, for someone who has installed the course a minute ago.

An untouched stub first, then a small finished example, both through the very session that grades a class.
Everything happens in a temporary folder.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from course.catalog.load import read_toml
from course.catalog.models import Exercise
from course.cli.frame.console import Console, current
from course.cli.frame.here import load_catalog
from course.cli.frame.replies import Demo
from course.cli.work.checking import reply_to
from course.cli.work.verdicts import show_verdict
from course.errors import InternalError

if TYPE_CHECKING:
    from course.catalog.load import Catalog
    from course.scoring.verdict import Verdict

__all__ = ["WORKED", "demo", "worked_example"]

#: The finished example, a folder beside the lessons; it is no exercise.
WORKED = "worked/free-fall"


def demo() -> int:
    """See what checking looks like, without a workspace.

    Checks the first exercise as it is handed out, with nothing written yet, and then a worked example.
    Leaves nothing behind.
    """

    console, catalog = current(), load_catalog()
    if not catalog.exercises():
        raise InternalError("This course has no exercise to show.", code="demo_failed")
    exercise, example = catalog.exercises()[0], worked_example(catalog)
    stub = _checked(console, catalog, exercise, f"1. {exercise.title}: the file as it is handed out")
    console.note(
        f"Every function waits for you: `course start {exercise.id}` puts this file into a workspace."
    )
    console.blank()
    worked = _checked(console, catalog, example, f"2. {example.title}: a worked example, finished")
    console.note(f"Read it at {example.folder}")
    console.blank()
    if stub.all_pass or not worked.all_pass:
        raise InternalError(
            "The demonstration went wrong: the stub must fail its checks and the example pass them.",
            help="Run `course doctor`; if it finds nothing, please report this.",
            code="demo_failed",
        )
    console.note(("Next: course init my-course", "bold"))
    course = catalog.ref
    console.emit(Demo(stub=reply_to(course, stub), worked=reply_to(course, worked)))
    return 0


def worked_example(catalog: Catalog) -> Exercise:
    """The finished example, in the form of an exercise, so that the same session can check it."""
    import msgspec

    folder = catalog.content.lessons / WORKED
    if not folder.is_dir():
        # Another course need not have one; the one that came with the program always does.
        folder = Path(__file__).resolve().parents[2] / "lessons" / WORKED
    return msgspec.structs.replace(read_toml(folder / "exercise.toml", Exercise), folder=str(folder))


def _checked(console: Console, catalog: Catalog, exercise: Exercise, title: str) -> Verdict:
    """Check the module in the exercise's own folder, from a copy, and show the verdict."""
    from course.cli.work.checking import grade_once, open_session, unlike_verdict
    from course.scoring.session import Submission

    console.heading(title)
    with tempfile.TemporaryDirectory(prefix="course-demo-") as folder:
        copy = Path(folder) / exercise.module
        copy.write_bytes(exercise.stub_path.read_bytes())
        with console.working("Checking"), open_session(exercise, catalog) as session:
            verdict = grade_once(session, Submission({exercise.module: copy.read_bytes()}))
    problem = unlike_verdict(verdict)
    if problem is not None:
        raise InternalError(problem.message, help=problem.help, code=problem.code)
    show_verdict(console, exercise, verdict)
    return verdict
