"""Small tests with known right answers, the same for every engine.

Each one builds its scenes, runs them and reduces the outcome to one number, to be compared with the right
one. A scene gives the friction and the restitution that must act; the adapter finds the values to set.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

from course.engines.scenarios import contact, motion
from course.errors import NotFoundError

if TYPE_CHECKING:
    from collections.abc import Callable

    from course.engines.base import Scene, World

    Build = Callable[[Scene], World]

__all__ = ["BOXES", "DT", "IMPACTS", "SCENARIOS", "Outcome", "Scenario", "get"]

#: The default step of comparisons, s.
DT = 1.0 / 240.0
#: The scenario that measures speed; everything else measures accuracy.
BOXES = "boxes"
#: Scenarios whose value is the mean over phases of a step.
IMPACTS = ("clash", "bounce", "small-drop")


@dataclass(frozen=True, slots=True)
class Outcome:
    """The result of one run.

    Attributes:
        value: the number that is compared.
        samples: ``value`` is their mean or median: one for each phase of the step, or each start; empty
            where there is one run.
        details: further results.
    """

    value: float
    samples: tuple[float, ...] = ()
    details: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Scenario:
    """One test.

    Attributes:
        id, title: its names.
        question: a question to answer before seeing the numbers.
        quantity: the meaning of ``value``.
        unit: of ``value`` and ``truth``; "%" and "mm" are meant for reading.
        truth: the right value; None where there is none (a speed), inf for "any speed".
        source: where the truth comes from.
        digits: decimals worth showing.
        measure: given how to build a scene, the step (s) and whether it should be quick, gives an Outcome.
        planar: an engine in the plane can do it.
        converges: a curve of its error against the step makes sense, because only the integrator matters.
        better: whether the value nearer the truth is better, or the larger one.
    """

    id: str
    title: str
    question: str
    quantity: str
    unit: str
    truth: float | None
    source: str
    digits: int
    measure: Callable[[Build, float, bool], tuple[float, dict[str, Any]]]
    planar: bool = True
    converges: bool = False
    better: Literal["near", "large"] = "near"

    def run(self, build: Build, dt: float, quick: bool = False) -> Outcome:
        """Measure once.

        Raises:
            EngineDivergedError: the engine gave something that is not a number.
            NotApplicableError: the engine has no word for what the scene asks.
        """
        value, details = self.measure(build, dt, quick)
        samples = tuple(details.pop("samples", ()))
        return Outcome(value, samples, details)

    def error(self, value: float) -> float | None:
        """How far a value is from the truth, in the scenario's unit; None if the truth is unknown."""
        if self.truth is None or not math.isfinite(self.truth):
            return None
        return value - self.truth


SCENARIOS: dict[str, Scenario] = {
    one.id: one
    for one in (
        Scenario(
            "free-fall",
            "A free fall",
            "Only gravity acts. Which engines let a body fall too far, which not far enough, by how much?",
            "error of the distance fallen",
            "%",
            0.0,
            "g t² / 2",
            3,
            motion.free_fall,
            converges=True,
        ),
        Scenario(
            "pendulum",
            "A pendulum on a hinge",
            "One ball on a rod swings from the horizontal for two seconds. How far does it stray?",
            "largest distance from the true path, in per cent of the rod",
            "%",
            0.0,
            "the pendulum's equation, solved with RK4 at a step of at most 1 ms",
            4,
            motion.pendulum,
            converges=True,
        ),
        Scenario(
            "double-pendulum",
            "A double pendulum's energy",
            "Two hinges, no friction, ten seconds. How much of the energy is left?",
            "largest change of energy within 10 s, median over the starts",
            "%",
            0.0,
            "conservation of energy",
            3,
            motion.double_pendulum,
        ),
        Scenario(
            "long-step",
            "A long step",
            "The same double pendulum, with the step doubled again and again. How long may it be?",
            "longest step that keeps the energy within 10 % for 10 s, from every start",
            "ms",
            math.inf,
            "conservation of energy",
            1,
            motion.long_step,
            better="large",
        ),
        Scenario(
            "clash",
            "An elastic collision of masses 1 and 3",
            "The light ball meets the resting heavy one at 1 m/s. Is the energy still there afterwards?",
            "change of kinetic energy, mean over phases of a step",
            "%",
            0.0,
            "restitution 1 conserves kinetic energy",
            3,
            contact.clash,
        ),
        Scenario(
            "bounce",
            "A bounce",
            "A ball falls from 1 m on a floor; restitution 0.5. How high does it come back?",
            "height of the rebound, mean over phases of a step",
            "m",
            0.25,
            "e² h",
            4,
            contact.bounce,
        ),
        Scenario(
            "small-drop",
            "A bounce from 2 cm",
            "The same ball, dropped from two centimetres. Does it still bounce?",
            "height of the rebound, mean over phases of a step",
            "mm",
            5.0,
            "e² h",
            2,
            contact.small_drop,
        ),
        Scenario(
            "slide",
            "A box slides down a slope",
            "30 degrees, friction 0.3. Is the acceleration right?",
            "error of the acceleration",
            "%",
            0.0,
            "g (sin a - mu cos a)",
            3,
            contact.slide,
        ),
        Scenario(
            "stick",
            "A box sticks to a slope",
            "20 degrees, friction 0.5: it must stay. Does it creep?",
            "distance moved down the slope in 2 s",
            "mm",
            0.0,
            "tan a < mu",
            3,
            contact.stick,
        ),
        Scenario(
            "diagonal",
            "Friction along the diagonal",
            "A box is pushed until it slips, along an edge and along the diagonal. Cone or pyramid?",
            "force at which the box slips along the diagonal, divided by that along an edge",
            "1",
            1.0,
            "Coulomb's cone has no preferred direction",
            3,
            contact.diagonal,
            planar=False,
        ),
        Scenario(
            "stack",
            "A stack of ten boxes",
            "Nothing should move. What does?",
            "largest movement of any box, median over the starts",
            "mm",
            0.0,
            "it stands in equilibrium",
            2,
            contact.stack,
        ),
        Scenario(
            "mass-ratio",
            "A tonne on a kilogram",
            "A cube of 1000 kg on one of 1 kg. Does the small one hold?",
            "largest movement of either, median over the starts",
            "mm",
            0.0,
            "it stands in equilibrium",
            2,
            contact.mass_ratio,
        ),
        Scenario(
            "thin-wall",
            "A thin wall and a fast ball",
            "A ball of 10 cm flies at a wall of 2 cm, faster each time. When does it get through?",
            "speed of the fastest ball that was stopped, as every slower one was",
            "m/s",
            math.inf,
            "solid bodies do not pass through each other",
            0,
            contact.thin_wall,
            better="large",
        ),
        Scenario(
            BOXES,
            "A hundred boxes, for speed",
            "Columns of boxes in contact. How many steps a second, and how many times pymunk's rate is that?",
            "rate, as a multiple of pymunk's in the same run",
            "x",
            None,
            "",
            2,
            contact.boxes,
            better="large",
        ),
    )
}


def get(scenario_id: str) -> Scenario:
    """The scenario of this name.

    Raises:
        NotFoundError: there is none.
    """
    if scenario_id in SCENARIOS:
        return SCENARIOS[scenario_id]
    raise NotFoundError(
        f"There is no scenario {scenario_id!r}.",
        help=f"The scenarios are {', '.join(SCENARIOS)}.",
        code="scenario_not_found",
    )
