"""Writes to its output past Python, as much as it can."""

import os


def scale(values, factor):
    for target in (1, 2):
        try:
            for _ in range(2000):
                os.write(target, b"z" * 100_000)
        except OSError:
            pass
    return values
