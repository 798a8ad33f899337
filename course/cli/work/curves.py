"""The curve of a failed check over the right one: drawn where the terminal can, and always in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.cli.work.replies import CurveReply

if TYPE_CHECKING:
    from collections.abc import Iterator

    from course.catalog.models import Exercise
    from course.cli.frame.terminal.console import Console
    from course.figures.drawing.curves import Curve
    from course.scoring.judging.session import GradingSession
    from course.scoring.verdict import Verdict

__all__ = ["curve_replies", "show_curve"]


def curve_replies(exercise: Exercise, verdict: Verdict, session: GradingSession) -> tuple[CurveReply, ...]:
    """The curves as ``--json`` prints them."""
    return tuple(_reply(check, curve) for check, curve in _curves(exercise, verdict, session))


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
    check, curve = next(_curves(exercise, verdict, session, focus), ("", None))
    if console.quiet or curve is None:
        return
    from course.figures.drawing.curves import plot_of
    from course.figures.drawing.plots import draw

    if not drawn and console.fancy:
        console.blank()
    elif console.fancy:
        console.figure(lambda: draw(plot_of(curve)))
    console.line((f"{check}: {curve.description}", "dim"))
    if console.fancy:
        console.blank()


def _curves(
    exercise: Exercise, verdict: Verdict, session: GradingSession, focus: str = ""
) -> Iterator[tuple[str, Curve]]:
    """Id and curve of each check that has one, in the order of the tasks."""
    order = [focus, *(task.id for task in exercise.task)]
    for check in sorted(
        (check for check in verdict.checks if check.id in session.curves),
        key=lambda check: order.index(check.task) if check.task in order else len(order),
    ):
        yield check.id, session.curves[check.id]


def _reply(check: str, curve: Curve) -> CurveReply:
    from course.figures.drawing.curves import thinned

    few = thinned(curve)
    return CurveReply(
        check, curve.quantity, curve.units, curve.right_is, curve.parts_at, curve.description,
        tuple(few.t.tolist()), tuple(few.yours.tolist()), tuple(few.right.tolist()),
    )  # fmt: skip
