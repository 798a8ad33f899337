"""ODE, Bullet, PhysX and MuJoCo as they were measured for this course, as reports to choose from.

An engine with its settings is a model, so each appears twice: as it comes, and well set for each test. Every
number is one of the reference measurements that ``course engines compare`` shows; all were made on a
processor, PhysX's too. The cost is the processor time of a step with a hundred boxes, in units of pymunk's.
"""

from __future__ import annotations

import functools
import math

from course.engines import reference

#: Whether there is a version of the engine for graphics cards (PhysX itself; MJX and MuJoCo Warp), and
#: whether Gazebo Classic runs on it unless told otherwise.
_ON_GRAPHICS_CARDS = {"physx", "mujoco"}
_OF_GAZEBO_CLASSIC = {"ode"}

ENGINES = ("ode", "bullet", "physx", "mujoco")
SETTINGS = {"as it comes": "default", "well set": "tuned"}


def reports():
    """The eight reports by name, "ode, as it comes" and so on; new dicts at every call."""
    return {
        f"{engine}, {words}": dict(_report(engine, words, setting))
        for engine in ENGINES
        for words, setting in SETTINGS.items()
    }


@functools.cache
def _report(engine, words, setting):
    def row(scenario):
        return reference.row(engine, scenario, setting)

    rate = _short(row("boxes").value)
    clash = row("clash")
    return {
        "fall_error": _short(abs(row("free-fall").value) / 100),
        "slope_error": _short(abs(row("slide").value) / 100),
        "rebound_m": _short(row("bounce").value),
        "pendulum_loss": _short(row("double-pendulum").value / 100),
        "clash_error": _short(max(abs(clash.lowest), abs(clash.highest)) / 100),
        "stack_mm": _short(row("stack").value),
        "tonne_mm": _short(row("mass-ratio").value),
        "diagonal": _short(row("diagonal").value),
        "rate": rate,
        "as_it_comes": words == "as it comes",
        "graphics_card": engine in _ON_GRAPHICS_CARDS,
        "gazebo_classic": engine in _OF_GAZEBO_CLASSIC,
        "cost": _short(1 / rate),
    }


def _short(value):
    """Three digits: what a reader compares, and more than a rate deserves."""
    return value if value == 0 else round(value, 2 - math.floor(math.log10(abs(value))))


def need(key, op, value):
    """One hard requirement."""
    return {"key": key, "op": op, "value": value}


#: Jobs, as requirements on what was measured, and the engine that answers them. Each limit is what the job
#: can bear, and lies well away from every measured value: no rounding and no phase of a step decides.
QUESTIONS = {
    "an old Gazebo Classic project: boxes slide down a chute and come to rest on each other": (
        [
            need("gazebo_classic", "==", True),
            need("slope_error", "<=", 0.001),
            need("stack_mm", "<=", 1.0),
        ],
        "ode, well set",
    ),
    "parcels that bounce and are stacked, and nobody to set an option": (
        [
            need("as_it_comes", "==", True),
            need("rebound_m", ">=", 0.2),
            need("rebound_m", "<=", 0.28),
            need("stack_mm", "<=", 3.0),
        ],
        "physx, as it comes",
    ),
    "a swing in a game, as it comes, that goes on": (
        [need("as_it_comes", "==", True), need("pendulum_loss", "<=", 0.05)],
        "bullet, as it comes",
    ),
    "thousands of robots at once, on a graphics card, that bump into things and slide": (
        [
            need("graphics_card", "==", True),
            need("clash_error", "<=", 0.01),
            need("slope_error", "<=", 0.001),
        ],
        "physx, well set",
    ),
    "research on control, where energy must not leak": (
        [need("pendulum_loss", "<=", 0.0001), need("clash_error", "<=", 0.01)],
        "mujoco, well set",
    ),
    "a loader that sets a tonne down on a small foot": (
        [need("tonne_mm", "<=", 1.0), need("diagonal", "<=", 1.1)],
        "mujoco, well set",
    ),
}
