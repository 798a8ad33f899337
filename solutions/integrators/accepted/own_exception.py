"""A refusal with its own kind of exception, which is also a ValueError."""


class StepError(ValueError):
    pass


_integrate = integrate


def integrate(step, accel, q0, v0, t_end, h):
    if abs(math.remainder(t_end, h)) > 1e-6 * h:
        raise StepError("steps of h do not end at t_end")
    return _integrate(step, accel, q0, v0, t_end, h)
