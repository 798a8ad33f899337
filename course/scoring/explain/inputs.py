"""What the inputs of a check's wrong results have to do with it, where no mistake is named.

Like ``likeness``, it says only what was computed: where results are right, and which other inputs would make
all of them right.
"""

from __future__ import annotations

import contextlib
import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

#: What an input may be where a result is right only by luck, and where one is wrong though others are right.
_LUCKY: tuple[tuple[str, Callable[[Any], bool]], ...] = (
    ("is 0", lambda value: _is_number(value) and value == 0),
    ("is 1", lambda value: _is_number(value) and value == 1),
    ("has two values", lambda value: _length(value) == 2),
)
_FORGOTTEN: tuple[tuple[str, Callable[[Any], bool]], ...] = (
    ("is negative", lambda value: _is_number(value) and value < 0),
    ("is 0", lambda value: _is_number(value) and value == 0),
    ("has one value", lambda value: _length(value) == 1),
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
    names = sorted(set.intersection(*(set(given) for given in (*right, *wrong))))
    # One wrong result makes no rule: another of its kind may be right.
    among = ", and wrong where" if len(wrong) > 1 else "; the other is the only one where"
    found = []
    for said, respects, these, those in (
        (", where", _LUCKY, right, wrong),
        (among, _FORGOTTEN, wrong, right),
    ):
        for name, (is_so, holds) in itertools.product(names, respects):
            if all(holds(one[name]) for one in these) and not any(holds(one[name]) for one in those):
                found.append(f"{said} `{name}` {is_so}")
    return found[0] if len(found) == 1 else ""


def other_inputs(calls: Sequence[Mapping[str, Any]]) -> Iterator[tuple[str, list[tuple[Any, ...]]]]:
    """Other arguments for some calls of a function, with how the change is said.

    Args:
        calls: the arguments of each call, by name. One that not all calls have, for its default, is kept.
    """
    names = [name for name in calls[0] if all(name in given for given in calls)]
    for one, other in itertools.combinations(names, 2):
        kinds = {_kind(given[name]) for given in calls for name in (one, other)}
        if len(kinds) == 1:
            exchanged = [{**given, one: given[other], other: given[one]} for given in calls]
            yield f"`{one}` and `{other}` exchanged", [tuple(given.values()) for given in exchanged]
    for name, (instead, value) in itertools.product(names, _INSTEAD):
        with contextlib.suppress(TypeError, ValueError, ArithmeticError):
            changed = [{**given, name: value(given[name])} for given in calls]
            yield f"{instead.format(f'`{name}`')} in its place", [tuple(given.values()) for given in changed]


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _length(value: Any) -> int:
    return len(value) if isinstance(value, list | tuple) else 0


def _kind(value: Any) -> tuple[str, int]:
    return ("number", 0) if _is_number(value) else (type(value).__name__, _length(value))
