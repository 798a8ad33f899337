"""The curve of a failed check over the right one: drawn where the terminal can, said in any case."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from course.catalog.models import Exercise
    from course.cli.frame.terminal.console import Console
    from course.scoring.judging.session import GradingSession
    from course.scoring.verdict import Verdict

__all__ = ["show_curve"]


def show_curve(
    console: Console,
    exercise: Exercise,
    verdict: Verdict,
    session: GradingSession,
    *,
    focus: str = "",
    drawn: bool = True,
) -> None:
    """Show the first failed check that has a curve; nothing if none has one.

    Args:
        focus: a function whose checks come before those of others.
        drawn: with a picture; else in words alone.
    """
    if console.quiet or not session.curves:
        return
    order = [focus, *(task.id for task in exercise.task)]
    failed = sorted(
        (check for check in verdict.checks if check.id in session.curves),
        key=lambda check: order.index(check.task) if check.task in order else len(order),
    )
    if not failed:
        return
    from course.figures.drawing.plots import draw
    from course.scoring.curves import plot_of

    plot = plot_of(session.curves[failed[0].id])
    if drawn:
        console.figure(lambda: draw(plot))
    console.line((f"{failed[0].id}: {plot.description}", "dim"))
    if console.fancy:
        console.blank()
