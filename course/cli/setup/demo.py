"""``course demo``: a mistake found, explained and fixed, for a user who has just installed the course.

A worked example is checked with its mistake and without it, through the session that grades a class, and
both motions are drawn. On a terminal the user types the line that is right. Nothing is written anywhere.
"""

import difflib
import os
import shutil
import sys
import textwrap
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.catalog.reading import read_document
from course.cli.frame.console import Console, current
from course.cli.frame.here import load_catalog
from course.cli.frame.replies import Envelope
from course.cli.work.checking import Check, reply_to
from course.cli.work.verdict import show_verdict
from course.errors import InternalError
from course.figures.described import Panel, Plot, Series
from course.handed_in import attempts
from course.handed_in.attempts import Attempt
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission
from course.scoring.verdict import Verdict


class Demo(Envelope, tag="course.demo/2", frozen=True, kw_only=True):
    """A worked example with a mistake, and without it.

    ``change`` is the corrected line as a diff. ``energy`` is the energy of each motion in units of its energy
    at the start: the least and the most over ``steps`` steps of ``step_size`` seconds.
    """

    before: Check
    after: Check
    change: tuple[str, ...]
    steps: int
    step_size: float
    energy_before: tuple[float, float]
    energy_after: tuple[float, float]


#: The worked example, a folder beside the lessons; not an exercise.
WORKED = "worked/spring"
#: The same module with one line wrong.
MISTAKEN = "mistaken.py"

#: The drawn motion: stretch in m, rate in rad/s, step in s, number of steps. 10 s, about three periods.
STRETCH, RATE, STEP, STEPS = 0.1, 2.0, 0.05, 200
#: A line that is wrong so often is followed by the answer.
TRIES = 3
#: Two panels stand side by side from this width on, in columns.
_WIDE = 70
_PANEL_ROWS = 17
#: Lines beside the picture: the heading, what grey is, the description, where to read on.
_WORDS = 10
#: Where a virtual environment says how it is activated.
_ACTIVATE = ("bin/activate", "Scripts/activate")


@dataclass(frozen=True)
class _Motion:
    """The checks' results of a module, and the motion it computed: positions (m) and velocities (m/s)."""

    verdict: Verdict
    x: np.ndarray[Any, Any]
    v: np.ndarray[Any, Any]

    @property
    def energy(self) -> tuple[float, float]:
        """The least and the most energy, in units of the energy at the start."""
        energy = self.v**2 + (RATE * self.x) ** 2
        return float(min(energy) / energy[0]), float(max(energy) / energy[0])


def demo() -> int:
    """Find and fix a mistake, without a workspace.

    An integrator that says Euler and does something else is checked. In a terminal you fix its one wrong
    line, and what you type is checked as your own code will be. It leaves nothing behind.
    """
    console, catalog = current(), load_catalog()
    example = worked_example(catalog)
    mistaken, right = (
        (Path(example.folder) / name).read_text(encoding="utf-8") for name in (MISTAKEN, example.module)
    )
    with attempts.open_session(example, catalog) as session:
        before = _motion(console, session, _checked(console, session, mistaken), passes=False)
        with console.paged():
            console.heading("1. This function calls itself explicit Euler. Each of its steps:")
            # The body of the function's loop up to where it keeps the step: the method itself.
            body = mistaken.partition("for _ in range(n):\n")[2].partition("        xs.append")[0]
            console.block(textwrap.dedent(body).rstrip(), "python", indent=2)
            console.blank()
            show_verdict(console, example, before.verdict, whole=False, brief=True)
        if console.converses:
            fixed = _ask(console, session, mistaken, right)
        else:
            fixed = _checked(console, session, right)
        if fixed is None:
            _say_next(console)
            return 0
        after = _motion(console, session, fixed, passes=True)
    # The lines that differ, as a diff without its head, indented as little as possible.
    lines = difflib.ndiff(mistaken.splitlines(), fixed.source.decode().splitlines())
    changed = [line for line in lines if line[:2] in {"- ", "+ "}]
    margin = min(len(line) - 2 - len(line[2:].lstrip()) for line in changed)
    change = tuple(line[:2] + line[2 + margin :] for line in changed)
    _show_fixed(console, example, before, after, change)
    _say_next(console)
    return console.answer(
        Demo(
            before=reply_to(catalog.ref, before.verdict),
            after=reply_to(catalog.ref, after.verdict),
            change=change,
            steps=STEPS,
            step_size=STEP,
            energy_before=before.energy,
            energy_after=after.energy,
        )
    )


def _checked(console: Console, session: GradingSession, source: str) -> Attempt:
    # What a terminal cannot decode it hands over as lone surrogates; a file with them is no text either.
    submission = Submission({session.exercise.module: source.encode(errors="surrogatepass")})
    with console.working("Checking"):
        return attempts.attempt_in(session, submission, time.perf_counter())


def _motion(console: Console, session: GradingSession, made: Attempt, *, passes: bool) -> _Motion:
    """The motion of a version whose checks must pass, or must not."""
    if made.problem is not None:
        raise InternalError(made.problem.message, help=made.problem.help, code=made.problem.code)
    if made.verdict.all_pass != passes:
        raise InternalError(
            "The demonstration failed: the file with the mistake must fail its checks, and the corrected "
            "file pass them.",
            help="Run `course doctor`; if it finds nothing, please report this.",
            code="demo_failed",
        )
    exercise = session.exercise
    with console.working("Computing both motions"):
        x, v = session.using(
            Submission({exercise.module: made.source}),
            lambda live: live.call(exercise.task[0].id, STRETCH, RATE, STEP, STEPS),
        )
    return _Motion(made.verdict, np.array(x), np.array(v))


def _ask(console: Console, session: GradingSession, mistaken: str, right: str) -> Attempt | None:
    """The module as the user fixes it, or ``right`` if they do not; None if they leave.

    What is typed replaces the wrong line and is checked as any submission is.
    """
    wrong = next(line for line in mistaken.splitlines() if line not in right.splitlines())
    indent = wrong[: len(wrong) - len(wrong.lstrip())]
    console.blank()
    console.line(("Your turn. ", "bold"), f"This line is wrong: {wrong.strip()}")
    again = "Type it as it should be (Enter shows the answer, q leaves): "
    question, tries = again, 0
    while True:
        typed = console.ask(question)
        if typed is None or typed.lower() in {"q", "quit"}:
            return None
        if not typed:
            return _checked(console, session, right)
        if typed.split() == wrong.split():
            question = f"That is the line as it was. {again}"
            continue
        made = _checked(console, session, mistaken.replace(wrong, indent + typed))
        if made.verdict.all_pass:
            return made
        _show_finding(console, made.verdict)
        tries += 1
        if tries == TRIES:
            console.line("This is the answer:")
            return _checked(console, session, right)
        question = "Type the line again (Enter shows the answer, q leaves): "


def _show_finding(console: Console, verdict: Verdict) -> None:
    """What is wrong with a typed line, in brief: the first check that fails, or why none ran."""
    found = next((check for check in verdict.checks if check.status not in {"pass", "skip"}), None)
    # Advice for a file that cannot be read, or for code that raises, does not help with one line.
    if found is None:
        said = verdict.error.message if verdict.error else "It could not be checked."
    else:
        raised = found.status == "error" and isinstance(found.actual, str)
        said = f"It raises {found.actual}." if raised else f"{found.message} {found.help}".rstrip()
    console.line(("Not yet. ", "red"), said)


def _show_fixed(
    console: Console, example: Exercise, before: _Motion, after: _Motion, change: tuple[str, ...]
) -> None:
    """The line and both motions; where a person reads, the motions wait for Enter, and q leaves them out."""
    console.blank()
    console.heading("2. The one line, fixed")
    console.block("\n".join(change), "diff", indent=2)
    console.blank()
    show_verdict(console, example, after.verdict)
    if not console.pause("Next: both motions."):
        return
    console.blank()
    console.heading("3. What the mistake hid")
    _draw(console, before, after)
    low, high = before.energy
    console.line(
        f"Explicit Euler gains energy: over {STEP * STEPS:g} s of this spring, the fixed function's energy "
        f"grows to {after.energy[1]:.2f} times its initial value. With the mistake it stays between "
        f"{low:.2f} and {high:.2f} times that value, because it turned the steps into those of "
        "another method. Explicit Euler would have looked better than it is."
    )


def _say_next(console: Console) -> None:
    """The next command, and how to make it work where the environment was not activated."""
    activate = next((path for path in map(Path(sys.prefix).joinpath, _ACTIVATE) if path.exists()), None)
    if activate is not None and shutil.which("course") is None:
        console.note("First, so that `course` works in every folder:")
        console.note(f"{'' if os.name == 'nt' else '. '}{activate}", indent=2)
    console.note(("Next: course init my-course", "bold"))


def worked_example(catalog: Catalog) -> Exercise:
    """The worked example as an exercise, so that the same session can check it."""
    folder = catalog.content.lessons / WORKED
    if not folder.is_dir():
        # Another course need not have one; the one that came with the program always does.
        folder = Path(__file__).resolve().parents[2] / "lessons" / WORKED
    return msgspec.structs.replace(
        read_document(folder / "exercise.toml", Exercise).value, folder=str(folder)
    )


def _draw(console: Console, before: _Motion, after: _Motion) -> None:
    """Both motions, where the terminal can show a picture."""
    if not console.draws:
        return
    from course.cli.frame.pictures import in_half_blocks
    from course.figures.plots import draw

    wide = console.width >= _WIDE
    columns, rows = console.width, _PANEL_ROWS * (1 if wide else 2)
    if console.interactive:  # otherwise the output is a file, or the picture of a page
        rows = max(_PANEL_ROWS // 2, min(rows, console.height - _WORDS))
    # Each with the other in grey: then both have the same axes, and the growth shows.
    panels = tuple(
        Panel(
            "position / m",
            "velocity / (m/s)",
            (Series("", other.x, other.v, quiet=True), Series("", motion.x, motion.v)),
            title=title,
        )
        for title, motion, other in (("before", before, after), ("after", after, before))
    )
    plot = Plot("", panels, columns=2 if wide else 1)
    with console.working("Drawing"):
        lines = in_half_blocks(lambda: draw(plot), columns, rows)
    for line in lines:
        console.rich().print(line)
    console.line(("Grey: the motion of the other panel.", "dim"))
