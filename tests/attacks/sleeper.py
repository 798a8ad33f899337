"""Sleeps instead of answering."""

import time


def scale(values, factor):
    time.sleep(30)
