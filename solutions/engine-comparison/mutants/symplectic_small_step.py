"""Wrong: the determinant at a step so small that RK4 passes."""

_whole_step = _spring_step


def _spring_step(engine, omega, z):
    return _whole_step(engine, omega, 0.05 if z == 0.5 else z)
