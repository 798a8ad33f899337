"""Numerical integration: four steps, the loop around a step, and two ways to judge a step.

A step takes a system from time t to t + h. ``accel(t, q, v)`` gives the acceleration, an array like q.
Replace each ``raise`` with your code; keep the names and the arguments. README.md has the formulae.
"""

import math  # noqa: F401 - yours to use

import numpy as np  # noqa: F401 - yours to use


def explicit_euler_step(accel, t, q, v, h):
    """One step of explicit Euler: position and velocity move with their rates at time t.

    accel: called as accel(t, q, v), once; returns the acceleration, shape (d,)
    t: time at the start of the step, s
    q, v: position and velocity at that time, shape (d,); do not change them
    h: step, s
    Returns (q_next, v_next), new arrays of shape (d,).
    """
    raise NotImplementedError


def semi_implicit_euler_step(accel, t, q, v, h):
    """One step of semi-implicit Euler: one of position and velocity moves, then the other with the new value.

    Same arguments and result as explicit_euler_step; one call of accel.
    """
    raise NotImplementedError


def velocity_verlet_step(accel, t, q, v, h):
    """One step of velocity Verlet: half a kick, a whole drift, half a kick.

    Same arguments and result as explicit_euler_step; one or two calls of accel.
    """
    raise NotImplementedError


def rk4_step(accel, t, q, v, h):
    """One step of the classical Runge-Kutta method of order four, on q and v together.

    Same arguments and result as explicit_euler_step; four calls of accel.
    """
    raise NotImplementedError


def integrate(step, accel, q0, v0, t_end, h):
    """Step from time 0 to t_end and return every state.

    step: one of the functions above, or any other called the same way
    q0, v0: state at time 0, shape (d,); may contain whole numbers; do not change them
    t_end: end, s; a whole number N of steps
    h: step, s
    Returns (t, q, v) of shapes (N+1,), (N+1, d), (N+1, d); row 0 is the initial state.
    Raises ValueError if t_end / h is further than 1e-6 from a whole number.
    """
    raise NotImplementedError


def observed_order(hs, errors):
    """The power p in error = C * h**p: least-squares slope of log error over log step.

    hs, errors: two or more positive numbers each, in any order
    Returns p as a float.
    """
    raise NotImplementedError


def max_stable_step(step, omega):
    """The largest h, in s, up to which a step stays stable on a spring of angular frequency omega.

    step: called as step(accel, t, q, v, h) with arrays of shape (1,)
    omega: rad/s
    Returns the limit to 1 %; 0.0 if h = 0.05 / omega is unstable already; math.inf if no h below
    10 / omega is unstable.
    """
    raise NotImplementedError
