"""Swallows every exception for ever."""

import time


def scale(values, factor):
    end = time.monotonic() + 30
    while time.monotonic() < end:
        try:
            while time.monotonic() < end:
                pass
        except BaseException:
            pass
