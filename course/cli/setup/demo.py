"""``course demo``: a mistake found, explained and mended, for a user who has just installed the course.

A worked example is checked with its mistake and without it, through the session that grades a class, and
both motions are drawn. Nothing is written anywhere.
"""

from __future__ import annotations

import difflib
import textwrap
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from course.catalog.load import read_toml
from course.catalog.models import Exercise
from course.cli.frame.here import load_catalog
from course.cli.frame.terminal.console import Console, current
from course.cli.setup.replies import Demo
from course.cli.work.checking import reply_to
from course.cli.work.verdict.screen import show_verdict
from course.errors import InternalError

if TYPE_CHECKING:
    import numpy as np

    from course.catalog.load import Catalog
    from course.figures.drawing.described import Plot
    from course.scoring.judging.session import GradingSession
    from course.scoring.verdict import Verdict

__all__ = ["MISTAKEN", "WORKED", "demo", "worked_example"]

#: The worked example, a folder beside the lessons; not an exercise.
WORKED = "worked/spring"
#: The same module with one line wrong.
MISTAKEN = "mistaken.py"

#: The drawn motion: stretch in m, rate in rad/s, step in s, number of steps. 10 s, about three periods.
STRETCH, RATE, STEP, STEPS = 0.1, 2.0, 0.05, 200
#: Two panels stand side by side from this width on, in columns.
_WIDE = 70
_PANEL_ROWS = 17
#: Lines beside the picture: the heading, the description, where to read on.
_WORDS = 9


@dataclass(frozen=True)
class _Motion:
    """A module, its checks' results, and the motion it computed: positions (m) and velocities (m/s)."""

    source: str
    verdict: Verdict
    x: np.ndarray[Any, Any]
    v: np.ndarray[Any, Any]

    @property
    def energy(self) -> tuple[float, float]:
        """The least and the most energy, in units of the energy at the start."""
        energy = self.v**2 + (RATE * self.x) ** 2
        return float(energy.min() / energy[0]), float(energy.max() / energy[0])


def demo() -> int:
    """See a mistake found and mended, without a workspace.

    An integrator that says Euler and does something else is checked, mended and checked again, as your own
    code will be. It leaves nothing behind.
    """

    from course.cli.work.checking import open_session

    console, catalog = current(), load_catalog()
    example = worked_example(catalog)
    sources = [
        (Path(example.folder) / name).read_text(encoding="utf-8") for name in (MISTAKEN, example.module)
    ]
    change = _change(*sources)
    with open_session(example, catalog) as session:
        before, after = (_motion(console, session, source) for source in sources)
    if before.verdict.all_pass or not after.verdict.all_pass:
        raise InternalError(
            "The demonstration failed: the file with the mistake must fail its checks, and the corrected "
            "file pass them.",
            help="Run `course doctor`; if it finds nothing, please report this.",
            code="demo_failed",
        )
    _show(console, example, before, after, change)
    console.note(("Next: course init my-course", "bold"))
    course = catalog.ref
    console.emit(
        Demo(
            before=reply_to(course, before.verdict),
            after=reply_to(course, after.verdict),
            change=change,
            steps=STEPS,
            step_size=STEP,
            energy_before=before.energy,
            energy_after=after.energy,
        )
    )
    return 0


def _show(
    console: Console, example: Exercise, before: _Motion, after: _Motion, change: tuple[str, ...]
) -> None:
    """Three screens; where a person reads, each waits for Enter, and q leaves out the rest."""
    with console.paged():
        console.heading("1. This function calls itself explicit Euler. Each of its steps:")
        console.block(_loop(before.source), "python", indent=2)
        console.blank()
        show_verdict(console, example, before.verdict, whole=False, brief=True)
    if not console.pause("Next: the mended line."):
        return
    console.blank()
    console.heading("2. The one line, mended")
    console.block("\n".join(change), "diff", indent=2)
    console.blank()
    show_verdict(console, example, after.verdict)
    if not console.pause("Next: both motions."):
        return
    console.blank()
    console.heading("3. What the mistake hid")
    _draw(console, before, after)
    console.line(_said(before, after))
    console.note(f"Read the example and its checks: {example.folder}")


def worked_example(catalog: Catalog) -> Exercise:
    """The worked example as an exercise, so that the same session can check it."""
    import msgspec

    folder = catalog.content.lessons / WORKED
    if not folder.is_dir():
        # Another course need not have one; the one that came with the program always does.
        folder = Path(__file__).resolve().parents[2] / "lessons" / WORKED
    return msgspec.structs.replace(read_toml(folder / "exercise.toml", Exercise), folder=str(folder))


def _motion(console: Console, session: GradingSession, source: str) -> _Motion:
    """Check a module and let it compute the motion that is drawn."""
    import numpy as np

    from course.cli.work.checking import error_without_checks, grade_once
    from course.scoring.judging.submission import Submission

    submission = Submission({session.exercise.module: source.encode()})
    with console.working("Checking"):
        verdict = grade_once(session, submission)
        problem = error_without_checks(verdict)
        if problem is not None:
            raise InternalError(problem.message, help=problem.help, code=problem.code)
        task = session.exercise.task[0].id
        x, v = session.using(submission, lambda live: live.call(task, STRETCH, RATE, STEP, STEPS))
    return _Motion(source, verdict, np.array(x), np.array(v))


def _loop(source: str) -> str:
    """The body of the function's loop up to where it keeps the step: the method itself."""
    body = source.partition("for _ in range(n):\n")[2].partition("        xs.append")[0]
    return textwrap.dedent(body).rstrip()


def _change(before: str, after: str) -> tuple[str, ...]:
    """The lines that differ, as a diff without its head, indented as little as possible."""
    lines = difflib.ndiff(before.splitlines(), after.splitlines())
    changed = [line for line in lines if line[:2] in {"- ", "+ "}]
    margin = min(len(line) - 2 - len(line[2:].lstrip()) for line in changed)
    return tuple(line[:2] + line[2 + margin :] for line in changed)


def _said(before: _Motion, after: _Motion) -> str:
    """The picture in words, with its numbers."""
    low, high = before.energy
    return (
        f"Explicit Euler is supposed to gain energy: over {STEP * STEPS:g} s of this spring, the mended "
        f"function's grows to {after.energy[1]:.2f} times its start. The mistaken one's stays between "
        f"{low:.2f} and {high:.2f} times, because it is another method. A comparison made with it would have "
        "praised Euler for what Euler cannot do."
    )


def _draw(console: Console, before: _Motion, after: _Motion) -> None:
    """Both motions, where the terminal can show a picture."""
    if not console.draws:
        return
    from course.cli.frame.terminal.half_blocks import half_blocks
    from course.figures.terminal import terminal_plot

    wide = console.width >= _WIDE
    columns, rows = console.width, _PANEL_ROWS * (1 if wide else 2)
    if console.interactive:  # otherwise the output is a file, or the picture of a page
        rows = max(_PANEL_ROWS // 2, min(rows, console.height - _WORDS))
    with console.working("Drawing"):
        drawn = terminal_plot(_plot(before, after, wide=wide), columns, rows)
    labels = [[one.column, one.row, one.text, one.ink, one.bold] for one in drawn.labels]
    for line in half_blocks(drawn.pixels.tobytes(), columns, rows, labels):
        console.rich().print(line)


def _plot(before: _Motion, after: _Motion, *, wide: bool) -> Plot:
    from course.figures.drawing.described import Panel, Plot, Series

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
    return Plot("", panels, columns=2 if wide else 1)
