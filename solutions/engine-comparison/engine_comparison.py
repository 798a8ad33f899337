"""An engine's report by experiment, a choice by hard requirements, and facts with source and date."""

import math
import operator

import numpy as np


def characterise(engine):
    info = engine.info()
    return {
        "order": _order(engine, info["omega"]),
        "symplectic": abs(np.linalg.det(_spring_step(engine, info["omega"], 0.5)) - 1) < 1e-6,
        "linear_damping": _linear_damping(engine, info["dt"]),
        "max_stable_step": _max_stable_z(engine, info["omega"]) / info["omega"],
        "friction_anisotropy": _anisotropy(engine, info),
        "rest_penetration": max(0.0, info["radius"] - _settled(engine, info)[2]),
        "restitution": _slow_hit(engine, info)[0],
        "tunnelling_speed": _tunnelling_speed(engine, info),
        "deterministic": _deterministic(engine, info["dt"]),
    }


# -- the method: no contact needed ---------------------------------------------------------------


def _order(engine, omega):
    """Over one fixed time, the change from n to 2n steps is 2**order times that from 2n to 4n."""

    def end(n):
        q, v = engine.run("spring", [1.0], [0.7 * omega], 1.3 / omega / n, n, [0.0])
        return np.array([q[-1][0], v[-1][0] / omega])

    coarse, middle, fine = end(16), end(32), end(64)
    return round(math.log2(np.linalg.norm(coarse - middle) / np.linalg.norm(middle - fine)))


def _spring_step(engine, omega, z):
    """The matrix of one spring step of h = z/omega on (q, v/omega)."""
    columns = []
    for q0, v0 in ((1.0, 0.0), (0.0, omega)):
        q, v = engine.run("spring", [q0], [v0], z / omega, 1, [0.0])
        columns.append((q[1][0], v[1][0] / omega))
    return np.transpose(columns)


def _linear_damping(engine, dt):
    h, n = dt / 1000, 100
    _, v = engine.run("free", [0.0], [1.0], h, n, [0.0])
    return -math.log(v[-1][0]) / (n * h)


def _max_stable_z(engine, omega):
    def stable(z):
        return max(abs(np.linalg.eigvals(_spring_step(engine, omega, z)))) <= 1 + 1e-8

    low = 0.05
    if not stable(low):
        return 0.0
    # No unstable range is narrower than 1/omega: walking up by half of that misses none.
    while stable(low + 0.5):
        low += 0.5
        if low >= 10:
            return math.inf
    return _bisect(stable, low, low + 0.5, 0.004 * low)


def _bisect(fits, low, high, width):
    """Where ``fits`` ends between low, which fits, and high, which does not."""
    while high - low > width:
        middle = (low + high) / 2
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


# -- the floor -----------------------------------------------------------------------------------


def _settled(engine, info):
    q, _ = engine.run(
        "floor", [0, 0, info["radius"]], [0, 0, 0], info["dt"], round(5 / info["dt"]), [0, 0, 0]
    )
    return q[-1]


def _anisotropy(engine, info):
    start, n = _settled(engine, info), round(0.5 / info["dt"])
    most = 5 * info["mu"] * info["mass"] * info["g"]

    def least_force(angle):
        def sticks(force):
            push = [force * math.cos(angle), force * math.sin(angle), 0]
            _, v = engine.run("floor", start, [0, 0, 0], info["dt"], n, push)
            return max(math.hypot(vx, vy) for vx, vy, _ in v) <= 0.01

        return _bisect(sticks, 0.0, most, 0.001 * most)

    return least_force(math.pi / 4) / least_force(0.0)


# -- the wall ------------------------------------------------------------------------------------


def _slow_hit(engine, info):
    """Restitution at 2 m/s, and where the body is when the engine stops it."""
    start = -(info["radius"] + info["wall_thickness"] / 2) - 3.5 * 2 * info["dt"]
    q, v = engine.run("wall", [start], [2.0], info["dt"], 10, [0])
    hit = next(i for i in range(11) if v[i][0] <= 0)
    return -v[hit][0] / v[hit - 1][0], q[hit][0]


def _tunnelling_speed(engine, info):
    dt = info["dt"]
    _, face = _slow_hit(engine, info)

    def stopped(speed):
        """The unluckiest start puts one sample just short of the wall's face."""
        n = math.ceil(4 / (speed * dt)) + 2
        first = -1 - speed * dt
        q, _ = engine.run("free", [first], [speed], dt, n, [0])
        short = max((x for (x,) in q if x <= face), default=face)
        start = min(first + (face - short) - 1e-9, -1)
        q, _ = engine.run("wall", [start], [speed], dt, n, [0])
        return q[-1][0] < 0

    if stopped(199.9):
        return math.inf
    return _bisect(stopped, 1.0, 199.9, 0.1)


def _deterministic(engine, dt):
    first, second = (engine.run("spring", [1.0], [0.5], dt, 50, [0.0]) for _ in range(2))
    return bool(np.array_equal(first, second))


# -- choosing ------------------------------------------------------------------------------------

_OPERATORS = {"<=": operator.le, ">=": operator.ge, "==": operator.eq}


def choose_engine(reports, requirements):
    def fits(report):
        return all(
            report.get(r["key"]) is not None and _OPERATORS[r["op"]](report[r["key"]], r["value"])
            for r in requirements
        )

    return min(
        (name for name, report in reports.items() if fits(report)),
        key=lambda name: reports[name]["cost"],
        default=None,
    )


# -- facts ---------------------------------------------------------------------------------------

_AS_OF = "2026-11-21"
_FACTS = {
    "ode": {
        "licence": ("LGPL-2.1-or-later OR BSD-3-Clause", "https://github.com/odedevs/ode"),
        "language": ("C++", "https://github.com/odedevs/ode"),
        "default_integrator": ("semi_implicit_euler", "https://ode.org/wiki/index.php/Manual"),
        "default_step_s": (None, "https://ode.org/wiki/index.php/Manual"),
        "used_by": (["Gazebo Classic", "Webots"], "https://classic.gazebosim.org"),
    },
    "bullet": {
        "licence": ("Zlib", "https://github.com/bulletphysics/bullet3"),
        "language": ("C++", "https://github.com/bulletphysics/bullet3"),
        "default_integrator": ("semi_implicit_euler", "https://github.com/bulletphysics/bullet3"),
        "default_step_s": (1 / 60, "https://github.com/bulletphysics/bullet3"),
        "used_by": (["PyBullet", "Blender"], "https://pybullet.org"),
    },
    "physx": {
        "licence": ("BSD-3-Clause", "https://github.com/NVIDIA-Omniverse/PhysX"),
        "language": ("C++", "https://github.com/NVIDIA-Omniverse/PhysX"),
        "default_integrator": ("semi_implicit_euler", "https://nvidia-omniverse.github.io/PhysX/"),
        "default_step_s": (None, "https://nvidia-omniverse.github.io/PhysX/"),
        "used_by": (["Isaac Sim", "Unity"], "https://github.com/NVIDIA-Omniverse/PhysX"),
    },
    "mujoco": {
        "licence": ("Apache-2.0", "https://github.com/google-deepmind/mujoco"),
        "language": ("C++", "https://github.com/google-deepmind/mujoco"),
        "default_integrator": (
            "semi_implicit_euler",
            "https://mujoco.readthedocs.io/en/stable/XMLreference.html",
        ),
        "default_step_s": (0.002, "https://mujoco.readthedocs.io/en/stable/XMLreference.html"),
        "used_by": (["Gymnasium", "dm_control"], "https://gymnasium.farama.org"),
    },
}


def engine_facts():
    return [
        {"engine": engine, "field": field, "value": value, "source": source, "as_of": _AS_OF}
        for engine, fields in _FACTS.items()
        for field, (value, source) in fields.items()
    ]
