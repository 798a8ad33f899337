"""Prints without end."""

import sys


def scale(values, factor):
    for _ in range(3000):
        print("x" * 10_000)
        sys.stderr.write("y" * 10_000)
    return values
