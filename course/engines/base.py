"""The interface of every engine: build a scene, step it, report the motion.

Scenes are three-dimensional, z up, in SI units. Bodies are balls and cubes, whose inertia is the same about
every axis, so that mechanical energy needs no orientation. An engine in the plane uses x and z.
"""

from __future__ import annotations

import functools
import itertools
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from importlib.resources import files
from typing import Any, Literal, Protocol

import msgspec
import numpy as np
from numpy.typing import NDArray

from course.errors import CourseError

Array = NDArray[np.float64]


Vector = tuple[float, float, float]


class EngineDivergedError(CourseError):
    """An engine gave a position or a velocity that is not a number."""

    default_code = "engine_diverged"


class NotApplicableError(CourseError):
    """A scene needs something that an engine cannot express."""

    default_code = "not_applicable"


@dataclass(frozen=True, slots=True)
class Body:
    """A body that moves.

    Attributes:
        shape: ``ball`` or ``cube``.
        size: radius or half an edge, m.
        mass: kg.
        position: of the centre, m.
        velocity: m/s.
    """

    shape: Literal["ball", "cube"]
    size: float
    mass: float
    position: Vector
    velocity: Vector = (0.0, 0.0, 0.0)

    @property
    def inertia(self) -> float:
        """About any axis through the centre, kg m²."""
        return (0.4 if self.shape == "ball" else 2.0 / 3.0) * self.mass * self.size**2


@dataclass(frozen=True, slots=True)
class Wall:
    """A box that does not move: its centre and half its edges, m."""

    position: Vector
    half: Vector


@dataclass(frozen=True, slots=True)
class Scene:
    """Everything an engine needs to know.

    Attributes:
        bodies: those that move, in the order in which ``World.motion`` reports them.
        gravity: m/s².
        friction, restitution: the coefficients that must act between any two surfaces. An adapter sets the
            values that its engine's rule for two materials turns into these.
        floor: there is a plane z = 0.
        pivots: for a chain: body i hangs by a hinge about the y axis at ``pivots[i]`` on body i - 1, the
            first on the world. Bodies of a chain do not collide.
        dt: the step, s.
    """

    bodies: tuple[Body, ...]
    gravity: Vector = (0.0, 0.0, -9.81)
    friction: float = 0.0
    restitution: float = 0.0
    floor: bool = False
    walls: tuple[Wall, ...] = ()
    pivots: tuple[Vector, ...] = ()
    dt: float = 1.0 / 240.0


@dataclass(frozen=True, slots=True)
class Motion:
    """Where the bodies are.

    Attributes:
        x: centres, (n, 3), m.
        v: velocities of the centres, (n, 3), m/s.
        w: angular velocities, (n, 3), rad/s, in the world's axes.
    """

    x: Array
    v: Array
    w: Array

    def checked(self) -> Motion:
        """Itself.

        Raises:
            EngineDivergedError: something in it is not a number.
        """
        if not all(np.isfinite(part).all() for part in (self.x, self.v, self.w)):
            raise EngineDivergedError("A position or a velocity stopped being a number.")
        return self


class World(Protocol):
    """A scene inside an engine."""

    def step(self, n: int = 1) -> None:
        """Advance by ``n`` steps of the scene's length."""

    def motion(self) -> Motion:
        """The state after the steps so far; arrays of its own."""

    def overlaps(self) -> list[float]:
        """How deep bodies overlap at each point of contact in the last step, m."""


@dataclass(frozen=True, slots=True)
class Tuning:
    """Options that differ from an engine's defaults, and why.

    Attributes:
        options: as the adapter's ``build`` takes them.
        why: one sentence per option, in the same order.
    """

    options: Mapping[str, Any] = field(default_factory=dict)
    why: tuple[str, ...] = ()


#: The engine with its own defaults.
AS_IT_COMES = Tuning()


#: An engine: puts a scene into it. The options are empty for the engine as it comes, otherwise the result of
#: ``tuning``; it raises NotApplicableError if it cannot express the scene. The class ``EngineWorld`` of an
#: adapter's module is one.
Adapter = Callable[[Scene, Mapping[str, Any]], World]


def energy(scene: Scene, motion: Motion) -> float:
    """Kinetic energy plus potential energy in the scene's gravity, J; zero height is the origin."""
    mass = np.array([body.mass for body in scene.bodies])
    inertia = np.array([body.inertia for body in scene.bodies])
    kinetic = 0.5 * (mass * (motion.v**2).sum(1)).sum() + 0.5 * (inertia * (motion.w**2).sum(1)).sum()
    return float(kinetic - (mass * (motion.x @ np.array(scene.gravity))).sum())


def momentum(scene: Scene, motion: Motion) -> Array:
    """Total linear momentum, (3,), kg m/s."""
    return np.array([body.mass for body in scene.bodies]) @ motion.v


# ---
# How engines are set for a test, by two rules that are the same for all of them.
#
# *As it comes*: every option keeps the value that the installed package gives it. Only what defines the test
# is set: the step (one call advances by exactly one), gravity, shapes, masses and inertias, the start, and
# the values that the engine's rule for two materials needs. Three things are switched off everywhere, because
# with them the test would measure something else: sleeping, motors that hold joints, and contacts between the
# bodies of a chain.
#
# *Well set*: an engine's options are listed in ``options/<engine>.toml``, each with what it does, the
# documentation it was read from, and the values worth trying for a topic; those left alone are listed as
# well. Of all combinations, including the defaults, the one whose mean over the phases of a step is closest
# to the truth is used; of equally good ones, the one that changes the fewest options. No engine's solver gets
# more than ``BUDGET`` iterations a step, and all have the same step. So no engine is worse well set than as
# it comes, and none is judged by options that were not tried. ``tests/benchmarks/engines_settings.py`` makes
# the choice and writes ``well_set.json``.


#: The largest number of iterations that a solver may get in a step.
BUDGET = 100
#: The topic of each scenario; only the options of this topic are tried in it.
TOPICS = {
    "free-fall": "motion",
    "pendulum": "joint",
    "double-pendulum": "joint",
    "long-step": "joint",
    "clash": "impact",
    "bounce": "impact",
    "small-drop": "impact",
    "slide": "friction",
    "stick": "friction",
    "diagonal": "friction",
    "stack": "pile",
    "mass-ratio": "pile",
    "thin-wall": "sweep",
    "boxes": "pile",
}


class Option(msgspec.Struct, frozen=True, kw_only=True):
    """One option that may be set.

    Attributes:
        key: its name in the adapter's ``build``.
        name: its name in the engine.
        default: its value in the package, in words.
        does: its effect.
        source: where that was read; empty for the engine's ``documented``.
        values: those tried, by topic (``try`` in the file).
    """

    key: str
    name: str
    default: str
    does: str
    source: str = ""
    values: dict[str, list[Any]] = msgspec.field(name="try", default_factory=dict)


class UnusedOption(msgspec.Struct, frozen=True, kw_only=True):
    """One option that keeps its default in every test."""

    name: str
    does: str
    source: str = ""


class Options(msgspec.Struct, frozen=True, kw_only=True):
    """The options of one engine."""

    documented: str
    option: tuple[Option, ...] = ()
    left: tuple[UnusedOption, ...] = ()


class Choice(msgspec.Struct, frozen=True, kw_only=True):
    """The settings chosen for one engine in one scenario, and the number of combinations tried."""

    options: dict[str, Any]
    tried: int


@functools.cache
def options_of(engine: str) -> Options:
    """The options of an engine, as its file lists them."""
    path = files("course").joinpath("engines", "options", f"{engine}.toml")
    return msgspec.convert(tomllib.loads(path.read_text(encoding="utf-8")), Options)


@functools.cache
def choices() -> dict[str, dict[str, Choice]]:
    path = files("course").joinpath("engines", "well_set.json")
    return msgspec.json.decode(path.read_bytes(), type=dict[str, dict[str, Choice]])


def candidates(engine: str, scenario: str) -> Iterator[dict[str, Any]]:
    """Every combination of the values worth trying, the defaults first."""
    topic = TOPICS[scenario]
    axes = [
        [{}, *({option.key: value} for value in option.values[topic])]
        for option in options_of(engine).option
        if topic in option.values
    ]
    for parts in itertools.product(*axes):
        yield {key: value for part in parts for key, value in part.items()}


def tuning(engine: str, scenario: str) -> Tuning:
    """The options of an engine well set for a scenario, each with what it does."""
    chosen = choices().get(engine, {}).get(scenario)
    if chosen is None or not chosen.options:
        return AS_IT_COMES
    known = {option.key: option for option in options_of(engine).option}
    why = tuple(
        f"{key} {value} instead of {known[key].default}: {known[key].does}."
        for key, value in chosen.options.items()
    )
    return Tuning(chosen.options, why)
