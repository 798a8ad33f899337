"""What a function answers to a list of questions, in a few numbers that can be shipped and compared.

Answers are flattened to numbers, with None, True, each text, nan, infinities, lengths and exceptions as
numbers of their own, dicts by their values in the order of the keys, and projected: a few weighted sums over
all of them. Programs that agree in every answer agree in the sums; programs that differ anywhere differ in
them, save by a chance of one in millions. Sums cannot be turned back into answers.
"""

from __future__ import annotations

import math
import zlib
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

__all__ = ["SAME", "SUMS", "Answers", "fingerprint", "in_range", "read"]

Answers = list[Any]
#: Weighted sums of a fingerprint.
SUMS = 2
#: How far sums of one program may be apart: right programs in other styles were seen to differ by 1e-7, from
#: rounding in simulations of some hundred steps; sums are stored with five decimals.
SAME = 3e-5

_NONE, _TRUE, _FALSE, _TEXT, _NAN, _INFINITE, _RAISED, _OTHER = 0.7071, 1.1, -1.1, 2.3, 31.4, 27.2, 51.7, 43.1
_MOST = 20_000
_LARGEST = 1e300  # JSON has no infinity


def fingerprint(answers: Answers) -> tuple[float, ...]:
    """``SUMS`` numbers for the answers to the questions of a task.

    Args:
        answers: plain values, one for each question; an exception's class name as ``{"raised": name}``.
    """
    numbers = np.fromiter((x for answer in answers for x in _numbers(answer)), float, -1)[:_MOST]
    weights = np.random.default_rng(20260).uniform(-1.0, 1.0, (SUMS, _MOST))[:, : len(numbers)]
    # Large values count by their logarithm: a path that explodes is compared by its digits all the same.
    return tuple(round(float(total), 5) for total in weights @ np.arcsinh(numbers))


def read(answer: Any, reader: Callable[[Any], Any] | None) -> Any:
    """What counts of an answer: what the exercise's reader of it gives.

    Args:
        reader: from ``questions.READ``; an answer that it cannot read counts as an exception of its own.
    """
    if reader is None or (isinstance(answer, dict) and answer.keys() == {"raised"}):
        return answer
    try:
        return reader(answer)
    except Exception as error:  # noqa: BLE001 - a student's answer may be anything
        return {"raised": type(error).__name__}


def in_range(value: float) -> float:
    """A number that JSON has: infinities as the largest one, nan as -1, which no answer here is."""
    try:
        number = float(value)
    except OverflowError:
        return _LARGEST
    return -1.0 if math.isnan(number) else max(-_LARGEST, min(number, _LARGEST))


def _numbers(value: Any, depth: int = 8) -> Iterator[float]:
    if isinstance(value, dict) and value.keys() == {"raised"}:
        yield _RAISED
    elif isinstance(value, np.ndarray):
        yield from _array(value, depth)
    elif isinstance(value, list | tuple) and depth:
        yield float(len(value))
        for item in value:
            yield from _numbers(item, depth - 1)
    elif isinstance(value, dict) and depth:
        yield float(len(value))
        for key in sorted(value, key=str):  # in which order it was filled says nothing
            yield from _numbers(value[key], depth - 1)
    else:
        yield _number(value)


def _array(value: np.ndarray[Any, Any], depth: int) -> Iterator[float]:
    if value.ndim == 0:
        yield _number(value.item())
    elif depth:
        yield float(len(value))
        for row in value:
            yield from _array(row, depth - 1) if isinstance(row, np.ndarray) else _numbers(row.item())


def _number(value: Any) -> float:
    if isinstance(value, bool | np.bool_):
        return _TRUE if value else _FALSE
    if isinstance(value, int | float | np.integer | np.floating):
        try:
            number = float(value)
        except OverflowError:
            return _INFINITE
        if math.isnan(number):
            return _NAN
        return math.copysign(_INFINITE, number) if math.isinf(number) else number
    if isinstance(value, str):
        return _text(value)
    return _NONE if value is None else _OTHER


def _text(value: str) -> float:
    """A number of its own for every text, save by a chance of one in thousands."""
    return _TEXT + zlib.crc32(value.encode("utf-8", "replace")) / 2**32
