"""Loops around a student's function that run in its process, so that many calls cost one message.

A copy of this file lies next to a stranger's code; it imports numpy and nothing of this course.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

_MAX_DEPTH = 32  # of a value that is recorded; the wire refuses a deeper one anyway


class Methods:
    """An object whose methods are the grader's functions; it contains nothing else."""

    def __init__(self, **methods: Callable[..., Any]) -> None:
        self.__dict__.update(methods)

    def __repr__(self) -> str:
        return f"<object with {', '.join(sorted(self.__dict__))}>"


def march(step: Any, rhs: Any, q0: Any, v0: Any, t0: float, h: float, n: int) -> Any:
    """Take ``n`` steps from (q0, v0) and record each; the loop that the checks of a step share.

    Each step gets copies, so that a step which changes its arguments spoils only its own result, not the
    record.

    Returns:
        [q, v] of shape (n + 1, d), or {"bad": ..., "step": i} where step i returned something else than
        two vectors of d numbers.
    """
    d = len(q0)
    q = np.empty((n + 1, d))
    v = np.empty((n + 1, d))
    q[0], v[0] = q0, v0
    for i in range(n):
        result = step(rhs, t0 + i * h, q[i].copy(), v[i].copy(), h)
        try:
            q_next, v_next = result
            if np.shape(q_next) != (d,) or np.shape(v_next) != (d,):
                return {"bad": f"shapes {np.shape(q_next)} and {np.shape(v_next)}", "step": i}
            q[i + 1], v[i + 1] = q_next, v_next
        except (TypeError, ValueError) as error:
            return {"bad": f"{type(result).__name__}: {error}"[:200], "step": i}
    return [q, v]


def each(function: Any, calls: Iterable[list[Any]]) -> list[Any]:
    """The result of ``function`` for each list of arguments, copied at once.

    Returns:
        The values, and the number of the first that a later call changed; None if they all stayed.
    """
    values: list[Any] = []
    record: list[Any] = []
    for args in calls:
        values.append(function(*args))
        record.append(_snapshot(values[-1]))
    changed = (i for i, (value, kept) in enumerate(zip(values, record, strict=True)) if _changed(value, kept))
    return [record, next(changed, None)]


def fold(function: Any, state: Any, calls: Iterable[list[Any]], keep: list[str] | None = None) -> list[Any]:
    """Pass the state through ``function(state, *args)``, once for each list of arguments.

    Args:
        keep: of states that are dicts, the keys to record.

    Returns:
        The states, the first one included. And with ``keep``, the last of them whole, else None.
    """
    record = [_snapshot(_part(state, keep))]
    for args in calls:
        state = function(state, *args)
        record.append(_snapshot(_part(state, keep)))
    return [record, None if keep is None else _snapshot(state)]


def _part(value: Any, keep: list[str] | None) -> Any:
    """The kept keys of a dict; any other value complete, so that the reader sees what it is."""
    if keep is None or not isinstance(value, dict):
        return value
    return {key: value[key] for key in keep if key in value}


def _changed(value: Any, kept: Any, depth: int = _MAX_DEPTH) -> bool:
    """Whether a value is no longer what its snapshot kept."""
    if isinstance(value, np.ndarray):
        return value.shape != kept.shape or not np.array_equal(
            value, kept, equal_nan=value.dtype.kind in "fc"
        )
    if depth and isinstance(value, list | tuple):
        return len(value) != len(kept) or any(map(_changed, value, kept, [depth - 1] * len(kept)))
    if depth and isinstance(value, dict):
        return value.keys() != kept.keys() or any(_changed(value[key], kept[key], depth - 1) for key in kept)
    return value is not kept and bool(value != kept)


def _snapshot(value: Any, depth: int = _MAX_DEPTH) -> Any:
    """A copy of plain containers and arrays: the student's code may use them again in the next call."""
    if isinstance(value, np.ndarray):
        return value.copy()
    if depth and isinstance(value, list | tuple):
        return [_snapshot(item, depth - 1) for item in value]
    if depth and isinstance(value, dict):
        return {key: _snapshot(item, depth - 1) for key, item in value.items()}
    return value
