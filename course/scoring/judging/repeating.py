"""Whether a function answers the same question the same way, whatever it was asked before.

The calls of failed checks are made again in a worker of its own, the last one first. Only functions that
could keep something are listened to (``explain.calls.may_remember``), so most submissions pay nothing.
"""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from course.isolation.session import LoadRefusedError
from course.scoring.explain.fingerprint import numbers_of
from course.scoring.failures import CheckFailed, StudentFailure

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from course.scoring.remote import Heard, RemoteSubmission

__all__ = ["Again"]

#: Calls that are made again, at most: mistakes of this kind show within a few.
_MOST = 100
#: Rounding may depend on where in memory an array lies.
_SAME = {"rtol": 1e-9, "atol": 1e-12}


class Again:
    """Asks a submission again, in two workers of its own that all of its tasks share.

    Args:
        anew: loads the submission in another worker.
    """

    def __init__(self, anew: Callable[[], RemoteSubmission]) -> None:
        self._anew = anew
        self._workers: dict[int, RemoteSubmission] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        while self._workers:
            self._workers.popitem()[1].close()

    def depends_on_the_past(self, heard: Sequence[Heard], task: str, patience: float) -> bool:
        """Whether calls give something else in the opposite order.

        A function that draws numbers of its own, or measures a time, gives something else every time: it is
        asked twice, and nothing is said of it.

        Args:
            heard: calls of functions, in order.
            patience: seconds of CPU time for each of the two times.
        """
        asked = heard[: -_MOST - 1 : -1]
        first = self._values(0, asked, task, patience)
        if first is None or _alike(first, [call.value for call in asked]):
            return False
        second = self._values(1, asked, task, patience)
        return second is not None and _alike(first, second)

    def _values(self, which: int, asked: Sequence[Heard], task: str, patience: float) -> list[Any] | None:
        """The values of the calls in one of the workers; None if one of them fails."""
        try:
            if which not in self._workers:
                self._workers[which] = self._anew()
            remote = self._workers[which]
            remote.begin_check(task, patience)
            return [getattr(remote, call.method)(*copy.deepcopy(call.args)) for call in asked]
        except LoadRefusedError:  # it was loaded before, so it is not loaded the same way every time
            return None
        except (StudentFailure, CheckFailed):
            self._workers.pop(which).close()  # it may have died, or stopped halfway
            return None


def _alike(one: list[Any], other: list[Any]) -> bool:
    """Whether two lists of results are the same."""
    a, b = numbers_of(one), numbers_of(other)
    return a.shape == b.shape and bool(np.allclose(a, b, equal_nan=True, **_SAME))
