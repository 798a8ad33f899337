"""Ignores every signal and spins."""

import signal
import time

for number in range(1, 65):
    try:
        signal.signal(number, signal.SIG_IGN)
    except (OSError, ValueError):
        pass
try:
    signal.pthread_sigmask(signal.SIG_BLOCK, range(1, 65))
except (OSError, ValueError):
    pass


def scale(values, factor):
    end = time.monotonic() + 30
    while time.monotonic() < end:
        pass
