"""What the inputs of a check's wrong results have to do with it, where no mistake is named.

Like ``likeness``, it says only what was computed: where results are right, and which other inputs would make
all of them right.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

#: What a number or a list may be, and how it is said.
_RESPECTS: tuple[tuple[str, Callable[[Any], bool]], ...] = (
    ("is negative", lambda value: _is_number(value) and value < 0),
    ("is 0", lambda value: _is_number(value) and value == 0),
    ("is 1", lambda value: _is_number(value) and value == 1),
    ("has one value", lambda value: _length(value) == 1),
    ("has two values", lambda value: _length(value) == 2),
    (
        "has a negative value",
        lambda value: _length(value) > 0 and any(_is_number(v) and v < 0 for v in value),
    ),
)

#: Another value for a number, and how it is said of one called ``{}``.
_INSTEAD: tuple[tuple[str, Callable[[float], float]], ...] = (
    ("the other sign of {}", lambda value: -value),
    ("one over {}", lambda value: 1.0 / value),
    ("the square of {}", lambda value: value * value),
    ("the root of {}", math.sqrt),
    ("{} in degrees", math.degrees),
    ("{} in radians", math.radians),
)


def where_right(right: Sequence[Mapping[str, Any]], wrong: Sequence[Mapping[str, Any]]) -> str:
    """What only the inputs with right results have in common, or only those with wrong ones.

    Args:
        right, wrong: the inputs of each result by name.

    Returns:
        What follows "it is right"; "" if there is no such thing, or more than one.
    """
    names = set.intersection(*(set(given) for given in (*right, *wrong)))
    found = []
    for name, (is_so, holds) in itertools.product(sorted(names), _RESPECTS):
        of_right = {holds(given[name]) for given in right}
        of_wrong = {holds(given[name]) for given in wrong}
        if (of_right, of_wrong) == ({True}, {False}):
            found.append(f", where `{name}` {is_so}")
        elif (of_right, of_wrong) == ({False}, {True}):
            found.append(f", and wrong where `{name}` {is_so}")
    return found[0] if len(found) == 1 else ""


def other_inputs(calls: Sequence[Mapping[str, Any]]) -> Iterator[tuple[str, list[tuple[Any, ...]]]]:
    """Other arguments for some calls of a function, with how the change is said.

    Args:
        calls: the arguments of each call, by name. Nothing is given if not all have the same ones.
    """
    names = list(calls[0])
    if any(list(given) != names for given in calls):
        return
    for i, j in itertools.combinations(range(len(names)), 2):
        columns = [{_kind(given[name]) for given in calls} for name in (names[i], names[j])]
        if columns[0] == columns[1] and len(columns[0]) == 1:
            places = list(range(len(names)))
            places[i], places[j] = j, i
            swapped = [tuple(given[names[k]] for k in places) for given in calls]
            yield f"`{names[i]}` and `{names[j]}` exchanged", swapped
    for name, (instead, value) in itertools.product(names, _INSTEAD):
        changed = []
        for given in calls:
            try:
                changed.append(tuple({**given, name: value(given[name])}.values()))
            except (TypeError, ValueError, ArithmeticError):
                break
        if len(changed) == len(calls):
            yield f"{instead.format(f'`{name}`')} in its place", changed


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _length(value: Any) -> int:
    return len(value) if isinstance(value, list | tuple) else 0


def _kind(value: Any) -> tuple[str, int]:
    return ("number", 0) if _is_number(value) else (type(value).__name__, _length(value))
