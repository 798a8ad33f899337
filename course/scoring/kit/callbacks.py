"""Callbacks that count the calls from the student's code, and black boxes for it to experiment with."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from course.isolation.failures import StudentFailure
from course.scoring.failures import CheckFailed
from course.scoring.kit.expectations import fail
from course.scoring.values import as_number, as_vector
from course.scoring.verdict import Divergence

if TYPE_CHECKING:
    Array = NDArray[np.float64]


class Counted:
    """A callback that remembers how it was called.

    Attributes:
        calls: positional arguments of each call, arrays copied.
        refusal: why it refused a call's arguments, if it did.
    """

    def __init__(self, fn: Callable[..., Any]) -> None:
        self._fn = fn
        self.calls: list[tuple[Any, ...]] = []
        self.refusal: CheckFailed | None = None

    @property
    def count(self) -> int:
        """How often the student's code has called it."""
        return len(self.calls)

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        self.calls.append(tuple(arg.copy() if isinstance(arg, np.ndarray) else arg for arg in args))
        try:
            return self._fn(*args, **kwargs)
        except CheckFailed as refusal:
            self.refusal = self.refusal or refusal
            raise

    def during(self, call: Callable[[], Any]) -> Any:
        """The value of ``call()``; if this callback refused its arguments meanwhile, that is the finding.

        An exception from a callback reaches the student's code first, which may catch it or end with it. In
        both cases the refusal says more than what comes after it.
        """
        try:
            value = call()
        except StudentFailure:
            if self.refusal is not None:
                raise self.refusal from None
            raise
        if self.refusal is not None:
            raise self.refusal
        return value


def counted(fn: Callable[..., Any]) -> Counted:
    """``fn`` as a callback that counts; hand it to the student's code and read ``.count`` after.

    The function runs on this side: the student's code sees neither it nor the count. ``fn`` must accept any
    plain arguments; for an acceleration, use ``acceleration`` instead.
    """
    return Counted(fn)


def acceleration(fn: Callable[[float, Array, Array], ArrayLike], d: int) -> Counted:
    """``fn(t, q, v)`` as a counted callback that refuses anything but a time and two vectors.

    Args:
        fn: the right-hand side, evaluated on this side.
        d: number of coordinates; q and v must have shape (d,).
    """

    def checked(*args: Any, **kwargs: Any) -> Array:
        try:
            t, q, v = (*args, *(kwargs[name] for name in ("t", "q", "v")[len(args) :]))
            t, q, v = as_number(t, "t"), as_vector(q, d, "q"), as_vector(v, d, "v")
        except (CheckFailed, KeyError, ValueError):
            fail(
                "Your code calls accel with something other than a time, a position and a velocity.",
                help="Call it as accel(t, q, v): a number, then two arrays of the shape your step was given.",
                diagnose="ACCEL_MISUSED",
                expected=f"accel(t, q, v) with q and v of shape ({d},)",
                actual=list(args),
            )
        with np.errstate(all="ignore"):
            return np.asarray(fn(t, q, v), dtype=float)

    return Counted(checked)


def black_box(**methods: Callable[..., Any]) -> dict[str, Any]:
    """An object for the student's code to experiment with: its methods are functions evaluated on this side.

    Pass it to ``call`` of a submission as an argument. The student's code sees an object with these methods,
    but not what is behind them.
    """
    return {"$methods": methods}


def first_divergence(
    t: ArrayLike, actual: dict[str, Array], expected: dict[str, Array], allowed: ArrayLike
) -> Divergence | None:
    """Where a trajectory first leaves a reference by more than ``allowed``, or None.

    Args:
        t: times, shape (n,), s.
        actual, expected: arrays of shape (n, d) by the name they have in the finding: "q", "v".
        allowed: allowed deviation, one number or shape (n,).
    """
    times = np.asarray(t, dtype=float)
    limit = np.broadcast_to(np.asarray(allowed, dtype=float), times.shape)
    first: tuple[int, str] | None = None
    for name, values in actual.items():
        with np.errstate(all="ignore"):
            off = np.argwhere(~(np.abs(values - expected[name]) <= limit[:, None]))
        if off.size and (first is None or off[0][0] < first[0]):
            first = int(off[0][0]), f"{name}[{int(off[0][1])}]"
    return None if first is None else Divergence(t=float(times[first[0]]), step=first[0], quantity=first[1])
