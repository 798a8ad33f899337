"""How the time that something takes grows with the size of what it is given.

For tests under ``soak``: a ratio of times measured in one process, not a time, yet still a measurement, which
does not belong into a run that decides.
"""

import gc
from collections.abc import Callable
from time import process_time

#: The geometric mean of 8, which is linear, and 64, which is quadratic, for a size eight times as large.
LIMIT = 22.6


def growth(make: Callable[[int], Callable[[], object]], size: int) -> float:
    """CPU time for eight times the size over that for the size: of three rounds the fastest of each.

    Args:
        make: prepares the work of a size; what it returns is timed. What disturbs a measurement makes it
            slower, and collecting garbage, which looks at all that the process holds, is put off.
    """
    took: dict[int, float] = {}
    for n in [size, 8 * size] * 3:
        work = make(n)
        gc.collect()
        gc.disable()
        try:
            start = process_time()
            work()
            took[n] = min(took.get(n, 1e9), process_time() - start)
        finally:
            gc.enable()
    return took[8 * size] / took[size]
