"""ODE, Bullet, PhysX and MuJoCo as they were measured for this course, as reports to choose from.

An engine with its settings is a model, so each appears twice: as it comes, and well set for each test. The
numbers are those of the lesson ``engines``; ``steps_per_s`` is the middle of what was seen with 100 boxes,
and the cost is the processor time of one such step, in ms.
"""

from __future__ import annotations

#: Whether the engine computes on graphics cards, and whether Gazebo Classic runs on it unless told otherwise.
_ON_GRAPHICS_CARDS = {"physx"}
_OF_GAZEBO_CLASSIC = {"ode"}

#: fall and slope errors (share), height of a rebound that should be 0.25 m, energy a pendulum loses in 10 s
#: (share), error of an elastic clash (share), steps a second with 100 boxes.
_MEASURED = {
    ("ode", "as it comes"): (0.005, 8e-7, 0.247, 0.080, 0.005, 1000.0),
    ("ode", "well set"): (0.005, 8e-7, 0.247, 0.145, 0.005, 1000.0),
    ("bullet", "as it comes"): (0.005, 1.03, 0.278, 0.085, 0.33, 2500.0),
    ("bullet", "well set"): (0.005, 0.033, 0.278, 0.080, 0.33, 2500.0),
    ("physx", "as it comes"): (0.005, 3e-5, 0.252, 1.0, 0.75, 8150.0),
    ("physx", "well set"): (0.005, 3e-5, 0.252, 0.097, 0.0, 8150.0),
    ("mujoco", "as it comes"): (0.005, 0.019, 0.0, 0.097, 0.73, 3300.0),
    ("mujoco", "well set"): (0.005, 0.023, 0.251, 1.5e-6, 0.003, 3300.0),
}


def reports():
    """The eight reports by name, "ode, as it comes" and so on; new dicts at every call."""
    return {
        f"{engine}, {settings}": {
            "fall_error": fall,
            "slope_error": slope,
            "rebound_m": rebound,
            "pendulum_loss": pendulum,
            "clash_error": clash,
            "steps_per_s": rate,
            "as_it_comes": settings == "as it comes",
            "graphics_card": engine in _ON_GRAPHICS_CARDS,
            "gazebo_classic": engine in _OF_GAZEBO_CLASSIC,
            "cost": 1000.0 / rate,
        }
        for (engine, settings), (fall, slope, rebound, pendulum, clash, rate) in _MEASURED.items()
    }


def need(key, op, value):
    """One hard requirement."""
    return {"key": key, "op": op, "value": value}


#: What each engine is often recommended for, put as requirements that a measurement can answer.
QUESTIONS = {
    "a robot in an old Gazebo Classic project, where boxes must slide as they should": (
        [
            need("gazebo_classic", "==", True),
            need("slope_error", "<=", 0.001),
            need("pendulum_loss", "<=", 0.1),
        ],
        "ode, as it comes",
    ),
    "general simulation without setting anything: things bounce, swing on, and it is fast": (
        [
            need("as_it_comes", "==", True),
            need("rebound_m", ">=", 0.2),
            need("pendulum_loss", "<=", 0.1),
            need("steps_per_s", ">=", 2000.0),
        ],
        "bullet, as it comes",
    ),
    "thousands of robots at once, on a graphics card, that bounce and slide": (
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
}
