"""Four ways to step a system forward, a loop that uses one, and two ways to judge it."""


def explicit_euler_step(accel, t, q, v, h):
    raise NotImplementedError


def semi_implicit_euler_step(accel, t, q, v, h):
    raise NotImplementedError


def velocity_verlet_step(accel, t, q, v, h):
    raise NotImplementedError


def rk4_step(accel, t, q, v, h):
    raise NotImplementedError


def integrate(step, accel, q0, v0, t_end, h):
    raise NotImplementedError


def observed_order(hs, errors):
    raise NotImplementedError


def max_stable_step(step, omega):
    raise NotImplementedError
