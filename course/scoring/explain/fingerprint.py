"""A function's answers to a list of questions, reduced to a few numbers that can be distributed and compared.

Answers are flattened to numbers: None, True, each text, nan, infinities, lengths and exceptions each have a
number of their own, and dicts contribute their values in the order of the keys. Then a few weighted sums are
taken over all of them. Programs with the same answers have the same sums; programs with any difference have
different sums, except by a chance of one in millions. The answers cannot be recovered from the sums.
"""

from __future__ import annotations

import array
import math
import zlib
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["SAME", "SUMS", "Answers", "fingerprint", "in_range", "numbers_of", "read"]

Answers = list[Any]
#: Weighted sums of a fingerprint.
SUMS = 2
#: How much the sums of equal programs may differ: right programs in other styles differed by 1e-7, from
#: rounding in simulations of several hundred steps; sums are stored with seven decimals. At 3e-5, RK4 in
#: two half steps was the same as RK4 with two stages at wrong times.
SAME = 1e-6

_NONE, _TRUE, _FALSE, _TEXT, _NAN, _INFINITE, _RAISED, _OTHER = 0.7071, 1.1, -1.1, 2.3, 31.4, 27.2, 51.7, 43.1
_MOST = 20_000
_LARGEST = 1e300  # JSON has no infinity


def fingerprint(answers: Answers) -> tuple[float, ...]:
    """``SUMS`` numbers for the answers to the questions of a task.

    Args:
        answers: plain values, one for each question; an exception's class name as ``{"raised": name}``.
    """
    numbers = numbers_of(answers)[:_MOST]
    weights = np.random.default_rng(20260).uniform(-1.0, 1.0, (SUMS, _MOST))[:, : len(numbers)]
    # Large values count by their logarithm, so that a path that diverges is still compared digit by digit.
    return tuple(round(float(total), 7) for total in weights @ np.arcsinh(numbers))


def numbers_of(answers: Answers) -> np.ndarray[Any, Any]:
    """All the numbers of plain values, in order: equal values have the same ones."""
    numbers = array.array("d")
    for answer in answers:
        _put(numbers, answer)
    return np.array(numbers)


def read(answer: Any, reader: Callable[[Any], Any] | None) -> Any:
    """The part of an answer that counts: the result of the exercise's reader.

    Args:
        reader: from ``questions.READ``; an answer that it cannot read counts like an exception.
    """
    if reader is None or (isinstance(answer, dict) and answer.keys() == {"raised"}):
        return answer
    try:
        return reader(answer)
    except Exception as error:  # noqa: BLE001 - a student's answer may be anything
        return {"raised": type(error).__name__}


def in_range(value: float) -> float:
    """A number that JSON can hold: infinity becomes the largest, nan becomes -1, which no answer is."""
    try:
        number = float(value)
    except OverflowError:
        return _LARGEST
    return -1.0 if math.isnan(number) else max(-_LARGEST, min(number, _LARGEST))


def _put(numbers: array.array[float], value: Any, depth: int = 8) -> None:
    if isinstance(value, dict) and value.keys() == {"raised"}:
        numbers.append(_RAISED)
    elif isinstance(value, np.ndarray):
        _put_array(numbers, value)
    elif isinstance(value, list | tuple) and depth:
        numbers.append(float(len(value)))
        if set(map(type, value)) == {float}:
            _put_floats(numbers, np.array(value))
        else:
            for item in value:
                _put(numbers, item, depth - 1)
    elif isinstance(value, dict) and depth:
        numbers.append(float(len(value)))
        for key in sorted(value, key=str):  # the order of insertion does not matter
            _put(numbers, value[key], depth - 1)
    else:
        numbers.append(_number(value))


def _put_array(numbers: array.array[float], value: np.ndarray[Any, Any]) -> None:
    if value.ndim == 0:
        numbers.append(_number(value.item()))
    else:
        _put_floats(numbers, _with_lengths(_as_numbers(value)))


def _as_numbers(value: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """An array's elements as ``_number`` has them, at the cost of an array and not of its elements."""
    if value.dtype.kind == "b":
        return np.where(value, _TRUE, _FALSE)
    return value.astype(float) if value.dtype.kind in "fiu" else np.full(value.shape, _OTHER)


def _with_lengths(value: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """An array as a vector, the length of each row before the row."""
    rows, width = value[..., np.newaxis], 1
    for axis in reversed(range(value.ndim)):
        outer, length = value.shape[:axis], value.shape[axis]
        lengths = np.full((*outer, 1), float(length))
        rows = np.concatenate([lengths, rows.reshape(*outer, length * width)], axis=-1)
        width = rows.shape[-1]
    return rows


def _put_floats(numbers: array.array[float], value: np.ndarray[Any, Any]) -> None:
    numbers.frombytes(np.nan_to_num(value, nan=_NAN, posinf=_INFINITE, neginf=-_INFINITE).tobytes())


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
    """A different number for every text, except by a chance of one in thousands."""
    return _TEXT + zlib.crc32(value.encode("utf-8", "replace")) / 2**32
