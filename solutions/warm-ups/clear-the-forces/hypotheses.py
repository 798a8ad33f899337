"""Sums that are cleared in a wrong way."""


def reset_to_force(mass, force, h, n):
    return h * force / mass * (2 * n - 1)


def hypotheses():
    yield "final_speed", ("RESET_TO_THE_FORCE",), reset_to_force
    yield "final_speed", ("STEP_IGNORED",), lambda mass, force, h, n: force / mass * n
