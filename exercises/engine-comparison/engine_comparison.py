"""Comparing engines: measure an engine whose inside you cannot see, choose an engine, know four real ones.

Replace each ``None`` in characterise with your measurement, one key at a time, and each ``raise`` with your
code; keep the names and the arguments. README.md says what each key means and how to measure it.
"""

import math  # noqa: F401 - yours to use

import numpy as np  # noqa: F401 - yours to use


def characterise(engine):
    """Measure an engine by experiment.

    engine: an object with two methods
        info() -> {"dt", "omega", "mass", "g", "mu", "radius", "wall_thickness"}
        run(scene, q0, v0, h, n, force) -> (q, v), each of shape (n + 1, d), the initial state first
    Returns a dict with exactly the nine keys below. A value of None counts as not measured yet, and costs
    only its own key. Move long measurements into functions of your own.
    """
    # Start with linear_damping, which the README works out; it also has order, in pieces.
    # spring, free
    order = None  # whole number: one fixed time with n, 2n and 4n steps; compare the ends
    symplectic = None  # True or False: the determinant of one spring step at h = 0.5/omega, to 1e-6
    linear_damping = None  # 1/s: how fast ln|v| of a free body falls as h -> 0
    max_stable_step = None  # s: go up from 0.05/omega; 0.0 and math.inf are answers too
    # floor
    friction_anisotropy = None  # F(45 degrees) / F(0 degrees), the least forces that make a body slide
    rest_penetration = None  # m: max(0, radius - z), five seconds after touching
    # wall
    restitution = None  # speed after over speed before, met at 2 m/s
    tunnelling_speed = None  # m/s: the largest at which no start gets through; math.inf: none below 200
    # any scene in which something moves
    deterministic = None  # True or False: do identical runs agree bit for bit?
    return {
        "order": order,
        "symplectic": symplectic,
        "linear_damping": linear_damping,
        "max_stable_step": max_stable_step,
        "friction_anisotropy": friction_anisotropy,
        "rest_penetration": rest_penetration,
        "restitution": restitution,
        "tunnelling_speed": tunnelling_speed,
        "deterministic": deterministic,
    }


def choose_engine(reports, requirements):
    """The cheapest engine that meets every requirement.

    reports: {name: report}, each report a dict with "cost" among its keys; values may be missing or None
    requirements: list of {"key", "op", "value"}, op one of "<=", ">=", "=="
    Returns the name, or None if no engine meets all of them. Must not change its arguments.
    """
    raise NotImplementedError


def engine_facts():
    """Facts about four real engines, with sources and dates.

    Returns a list of twenty dicts {"engine", "field", "value", "source", "as_of"}: each of "ode", "bullet",
    "physx", "mujoco" with each of "licence", "language", "default_integrator", "default_step_s", "used_by".
    """
    raise NotImplementedError
