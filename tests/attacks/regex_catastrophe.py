"""Matches a pattern that backtracks without end."""

import re


def scale(values, factor):
    re.match(r"(a+)+$", "a" * 60 + "b")
    return values
