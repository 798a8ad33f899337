"""The end of the search is returned as if it were a limit."""

_search = max_stable_step


def max_stable_step(step, omega):
    return min(_search(step, omega), 10 / omega)
