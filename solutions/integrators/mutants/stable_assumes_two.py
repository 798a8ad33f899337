"""The textbook limit of one method, whatever step is given."""


def max_stable_step(step, omega):
    return 2.0 / omega
