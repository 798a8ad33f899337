"""Predict, run, compare: a guess, a formula and a simulation side by side."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import msgspec

from course.sandbox.scene.expression import evaluate
from course.sandbox.scene.wording import fill

if TYPE_CHECKING:
    from collections.abc import Mapping

    from course.sandbox.scene.model import Prediction

__all__ = ["NO_GUESS", "Comparison", "compare", "guess_of"]

#: What is said of a text that holds none.
NO_GUESS = "Not a number: try something like 2.5 or -1e3, in the unit of the question."


class Comparison(msgspec.Struct, frozen=True, kw_only=True):
    """The three numbers.

    Attributes:
        question, unit: as the scene asks, with the numbers of this run.
        guess: the student's; None if none was made.
        theory: what the formula gives.
        simulation: what the run gave; "nan" if what was asked for did not happen.
        guess_right: the guess is close to theory or simulation, whichever is nearer; None without a guess.
        agree: theory and simulation are as close as the scene says they should be.
        verdict: one sentence.
        why: the reasoning behind the formula, with the numbers of this run.
    """

    question: str
    unit: str
    guess: float | None
    theory: float
    simulation: float
    guess_right: bool | None
    agree: bool
    verdict: str
    why: str


def guess_of(text: str, unit: str) -> float | None:
    """The number in a typed text, with comma or point, with its unit or without; None if there is none."""
    try:
        value = float(text.strip().removesuffix(unit).replace(",", "."))
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def compare(
    asked: Prediction, simulation: float, values: Mapping[str, float], guess: float | None
) -> Comparison:
    """Put guess, theory and simulation side by side.

    Args:
        asked: the scene's question.
        simulation: the number the run gave.
        values: the values of the names in formula and texts.
        guess: the student's number.

    Raises:
        UsageError: the formula, or one in the texts, has no value for these parameters.
    """
    theory = evaluate(asked.theory, values)
    agree = abs(simulation - theory) <= max(asked.agrees * abs(theory), asked.agrees_abs)
    right = None if guess is None else _near(asked, guess, theory) or _near(asked, guess, simulation)
    return Comparison(
        question=fill(asked.question, values),
        unit=asked.unit,
        guess=guess,
        theory=theory,
        simulation=simulation,
        guess_right=right,
        agree=agree,
        verdict=_verdict(asked, guess, right, theory, simulation, agree),
        why=fill(asked.why, values),
    )


def _near(asked: Prediction, guess: float, answer: float) -> bool:
    return abs(guess - answer) <= max(asked.near * abs(answer), asked.near_abs, 1e-12)


def _verdict(
    asked: Prediction, guess: float | None, right: bool | None, theory: float, simulation: float, agree: bool
) -> str:
    if math.isnan(simulation):
        return "What the question asks about did not happen in this run."
    if agree:
        text = "Theory and simulation agree."
    else:
        text = (
            "Theory and simulation do not agree here: one of them leaves something out. "
            "Look for what, and which of the two speaks of the world."
        )
    if guess is None:
        return text
    if right:
        return f"Your guess is right. {text}"
    off = guess - theory
    if theory * guess > 0.0:
        return f"Your guess is {100 * abs(off / theory):.0f} % too {'high' if off > 0 else 'low'}. {text}"
    return f"Your guess is off by {abs(off):.3g} {asked.unit}. {text}"
