"""Whether a function answers the same question the same way, whatever it was asked before.

The calls of failed checks are made again in a worker of its own, the last one first. Only functions that
could keep something are listened to (``explain.calls.may_remember``), so most submissions pay nothing.
"""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING, Any

import numpy as np

from course.isolation.session import LoadRefusedError
from course.scoring.explain.fingerprint import numbers_of
from course.scoring.failures import CheckFailed, StudentFailure

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from course.scoring.remote import Heard, RemoteSubmission

__all__ = ["depends_on_the_past"]

#: Calls that are made again, at most: mistakes of this kind show within a few.
_MOST = 100
#: Rounding may depend on where in memory an array lies.
_SAME = {"rtol": 1e-9, "atol": 1e-12}


def depends_on_the_past(
    heard: Sequence[Heard], task: str, anew: Callable[[], RemoteSubmission], patience: float
) -> bool:
    """Whether calls give something else in the opposite order.

    A function that draws numbers of its own, or measures a time, gives something else every time: it is
    asked twice, and nothing is said of it.

    Args:
        heard: calls of functions, in order.
        anew: loads the submission in another worker.
        patience: seconds of CPU time for each of the two times.
    """
    asked = heard[: -_MOST - 1 : -1]
    first = _again(asked, task, anew, patience)
    if first is None or _alike(first, [call.value for call in asked]):
        return False
    second = _again(asked, task, anew, patience)
    return second is not None and _alike(first, second)


def _again(
    asked: Sequence[Heard], task: str, anew: Callable[[], RemoteSubmission], patience: float
) -> list[Any] | None:
    """The values of the calls in a worker of their own; None if one of them fails."""
    try:
        remote = anew()
    except LoadRefusedError:  # it was loaded before, so it is not loaded the same way every time
        return None
    try:
        remote.begin_check(task, patience)
        return [getattr(remote, call.method)(*copy.deepcopy(call.args)) for call in asked]
    except (StudentFailure, CheckFailed):
        return None
    finally:
        remote.close()


def _alike(one: list[Any], other: list[Any]) -> bool:
    """Whether two lists of results are the same."""
    a, b = numbers_of(one), numbers_of(other)
    return a.shape == b.shape and bool(np.allclose(a, b, equal_nan=True, **_SAME))
