"""Which of many cases an ordinary run tries; the others are tried under ``soak``, or on other days."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest


def soak_unless(chosen: Iterable[Any], cases: Iterable[Any]) -> list[Any]:
    """The cases as parameters, those marked ``soak`` that are not among the chosen.

    Args:
        cases: values of one parameter, or tuples of several.
    """
    ordinary = list(chosen)

    def parameters(case: Any) -> Any:
        values = case if isinstance(case, tuple) else (case,)
        return pytest.param(*values, marks=() if case in ordinary else pytest.mark.soak)

    return [parameters(case) for case in cases]


def of_other_days(items: Iterable[pytest.Item], day: int) -> list[pytest.Item]:
    """Of each file's tests that come in turn, ``turns(N)``, those that are not one of the N of this day.

    Long ones (``soak``) have slices of their own, and are left to them.
    """
    later = []
    places = Counter[tuple[Path, int]]()
    for item in items:
        marker = None if item.get_closest_marker("soak") else item.get_closest_marker("turns")
        if marker:
            of = marker.args[0]
            if (places[item.path, of] + day) % of:
                later.append(item)
            places[item.path, of] += 1
    return later
