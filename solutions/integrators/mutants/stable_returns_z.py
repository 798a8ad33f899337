"""The product h omega comes back instead of h."""

_in_seconds = max_stable_step


def max_stable_step(step, omega):
    return _in_seconds(step, omega) * omega
