"""Which of many cases an ordinary run tries; the others are tried under ``soak``."""

from __future__ import annotations

from collections.abc import Iterable
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
