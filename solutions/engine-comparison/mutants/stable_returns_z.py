"""Wrong: the product of step and omega instead of the step."""

_z = _max_stable_z


def _max_stable_z(engine, omega):
    return _z(engine, omega) * omega
