"""ODE, Bullet, PhysX and MuJoCo as they were measured for this course, as reports to choose from.

An engine with its settings is a model, so each appears twice: as it comes, and well set for each test. Every
number is one of the reference measurements that ``course engines compare`` shows; all were made on a processor,
PhysX's too. The cost is the processor time of a step with a hundred boxes, as a multiple of pymunk's.
"""

from __future__ import annotations

import math

from course.engines import reference

#: Whether there is a version of the engine for graphics cards (PhysX itself; MJX and MuJoCo Warp), and whether
#: Gazebo Classic runs on it unless told otherwise.
_ON_GRAPHICS_CARDS = {"physx", "mujoco"}
_OF_GAZEBO_CLASSIC = {"ode"}

ENGINES = ("ode", "bullet", "physx", "mujoco")
SETTINGS = {"as it comes": "default", "well set": "tuned"}


def reports():
    """The eight reports by name, "ode, as it comes" and so on; new dicts at every call."""
    return {
        f"{engine}, {words}": _report(engine, words, setting)
        for engine in ENGINES
        for words, setting in SETTINGS.items()
    }


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
