"""What a wrong answer has in common with the right one, and what the text of a function shows of itself.

It is said where no mistake is named. Nothing here guesses: each sentence is computed from the numbers that
the student reads below it, or true of the code whatever it is called with.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from course.printable import counted
from course.scoring.explain.fingerprint import functions_of
from course.scoring.explain.story import Diagnosis
from course.scoring.verdict import Places

Array = NDArray[np.float64]

#: Two numbers are the same if they differ by less than this share of the larger one.
_SAME = 1e-9
_TIMES = {
    2.0: "twice the right one",
    0.5: "half the right one",
    1 / 3: "a third of the right one",
    0.25: "a quarter of the right one",
    math.sqrt(2.0): "the right one times the square root of 2",
    math.sqrt(0.5): "the right one over the square root of 2",
    math.pi: "the right one times pi",
    2 * math.pi: "the right one times 2 pi",
    0.5 / math.pi: "the right one over 2 pi",
    180 / math.pi: "the right one times 180/pi, as if it were in degrees",
    math.pi / 180: "the right one times pi/180, as if it were turned from degrees to radians",
    9.81: "the right one times 9.81",
    1 / 9.81: "the right one over 9.81",
    math.log(2.0): "the right one times ln 2, as of logarithms with two bases",
    1 / math.log(2.0): "the right one over ln 2, as of logarithms with two bases",
    math.log(10.0): "the right one times ln 10, as of logarithms with two bases",
    1 / math.log(10.0): "the right one over ln 10, as of logarithms with two bases",
}
_TIMES |= {float(n): f"{n} times the right one" for n in (3, 4, 6, 10, 12, 100, 1000)}
_TIMES |= {1 / n: f"the right one over {n}" for n in (6, 10, 12, 100, 1000)}
#: Inputs that are whole numbers below it are not compared with a simple factor: too many things are 2.
_BY_CHANCE = 20
#: A result with fewer significant digits is a rounded one, or the value of an input, by chance.
_DIGITS = 2
#: One with fewer is a rounded one, of which others are the same by chance.
_ROUNDED = 3
_PLACES = ("first", "second", "third", "fourth", "fifth", "sixth")


def likeness(actual: Any, expected: Any, given: Mapping[str, Any] | None = None) -> str:
    """One sentence on what two values have in common; "" if nothing worth saying.

    Args:
        actual, expected: plain values, as a finding has them.
        given: the inputs by name, as it has them.
    """
    if isinstance(actual, dict) and isinstance(expected, dict) and actual.keys() == expected.keys():
        actual, expected = list(actual.values()), list(expected.values())
        if len(actual) == 1:
            (actual,), (expected,) = actual, expected
    a, e = _array(actual), _array(expected)
    with np.errstate(all="ignore"):
        if a is None or e is None:
            return _of_kinds(actual, expected, a, given or {})
        if not a.ndim and not e.ndim:
            return _of_numbers(actual, expected, given or {})
        return _of_arrays(a, e, given or {}) if a.shape == e.shape else _of_lengths(a, e)


def of_cases(cases: Sequence[tuple[Any, Any, Mapping[str, Any]]]) -> str:
    """What all wrong results of a check have in common, which one may have by chance; "" if nothing.

    Args:
        cases: actual value, expected value and inputs of each, the one first that is shown.
    """
    said = [likeness(*case) for case in cases]
    here = "Here your result is "
    if len(cases) < 2 or not said[0].startswith(here):
        # Which of several numbers are wrong is seen; a factor is, where all pairs have it.
        return said[0] if said[0] else _of_every(cases)
    return f"Each wrong result is {said[0].removeprefix(here)}" if len(set(said)) == 1 else _of_every(cases)


def _of_every(cases: Sequence[tuple[Any, Any, Mapping[str, Any]]]) -> str:
    """What two or more wrong numbers are: all the same, or all made of the right ones in one way."""
    pairs = [(a, e) for a, e, _ in cases if isinstance(a, int | float) and isinstance(e, int | float)]
    if not len(cases) == len(pairs) > 1 or any(isinstance(one, bool) for pair in pairs for one in pair):
        return ""
    said = _of_pairs(pairs)
    return f"Each wrong result is {said}." if said else ""


def _of_pairs(pairs: Sequence[tuple[float, float]]) -> str:
    """The one value, factor, distance or rounding of some numbers."""
    a, e = np.array(pairs, dtype=float).T
    with np.errstate(all="ignore"):
        ratio, apart = a / e, a - e
    if not np.ptp(a):
        return f"{a[0]:g}" if np.ptp(e) else ""
    if _steady(ratio):
        return f"{ratio[0]:.6g} times the right one"
    if _steady(apart):
        return f"too {'large' if apart[0] > 0 else 'small'} by {abs(apart[0]):.6g}"
    if np.all(a == np.trunc(e)):
        return "the right one without its decimals"
    places = next((n for n in range(10) if all(one == round(right, n) for one, right in pairs)), None)
    if places is None or all(_digits(one) <= _ROUNDED for one in a):
        return ""
    return f"the right one rounded to {counted(places, 'decimal')}"


def _steady(numbers: Array) -> bool:
    """Whether numbers, none of them zero, are all the same."""
    first = numbers[0]
    return bool(np.isfinite(first) and first and np.max(np.abs(numbers - first)) <= 1e-8 * abs(first))


def _of_kinds(actual: Any, expected: Any, a: Array | None, given: Mapping[str, Any]) -> str:
    """The likeness of two texts, and of a number where None is right."""
    if isinstance(actual, str) and isinstance(expected, str):
        alike = actual != expected and actual.strip().casefold() == expected.strip().casefold()
        return "Only capitals or spaces are different." if alike else ""
    if a is None or expected != "None":
        return ""
    if np.isfinite(a).any():
        taken = "" if a.ndim else _taken(float(a), _inputs(given))
        return f"Here your result is the same as {taken}." if taken else ""
    return f"Where there is no answer give None, not {a.flat[0]:g}."


def _of_numbers(actual: float, expected: float, given: Mapping[str, Any]) -> str:
    if actual == expected and type(actual) is not type(expected):
        kinds = type(actual).__name__, type(expected).__name__
        return "Its value is right; its type is {}, and {} is asked for.".format(*kinds)
    # A count or an index has no factor.
    if isinstance(actual, int) and isinstance(expected, int) and abs(actual - expected) != 1:
        return ""
    said = _of_two_numbers(float(actual), float(expected), given)
    return f"Here your result is {said}." if said else ""


def _array(value: Any) -> Array | None:
    """Numbers as an array; None for anything else."""
    if not all(isinstance(one, int | float) and not isinstance(one, bool) for one in _leaves(value)):
        return None
    try:
        array = np.array(value, dtype=float)
    except (ValueError, OverflowError):  # rows of different lengths
        return None
    return array if array.size else None


def _leaves(value: Any) -> Iterator[Any]:
    if isinstance(value, list | tuple):
        for item in value:
            yield from _leaves(item)
    else:
        yield value


def _same(a: Any, e: Any) -> bool:
    """Whether numbers, or arrays of one shape, are equal but for rounding."""
    a, e = np.asarray(a), np.asarray(e)
    return a.shape == e.shape and bool(np.all(np.abs(a - e) <= _SAME * np.max(np.abs(e), initial=0.0)))


# -- one number -----------------------------------------------------------------------------------------


def _of_two_numbers(a: float, e: float, given: Mapping[str, Any]) -> str:
    """What a wrong number is, to follow "your result is"."""
    if not (math.isfinite(a) and math.isfinite(e)) or _same(a, e):
        return ""
    inputs = _inputs(given)
    taken = _taken(a, inputs)
    if not (a and e):
        return f"the same as {taken}" if taken else ""
    if _same(a, -e):
        return "right but for its sign"
    return (
        _of_ratio(a, e, inputs)
        or (f"the same as {taken}" if taken else "")
        or _of_difference(a, e, inputs)
        or _of_powers(a, e)
        or _of_digits(a, e)
    )


def _taken(a: float, inputs: Sequence[tuple[str, float]]) -> str:
    """The input that a number is; "" if it is none. A one among several values is so by chance."""
    return next((name for name, value in inputs if _digits(value) >= _DIGITS and _same(a, value)), "")


def _digits(value: float) -> int:
    """How many significant digits a number has, as it is written."""
    return len(f"{abs(value):.12e}".partition("e")[0].replace(".", "").rstrip("0"))


def _inputs(given: Mapping[str, Any]) -> list[tuple[str, float]]:
    """The numbers of the input with their names; of a list, the first and the last."""
    found: list[tuple[str, float]] = []
    for name, value in given.items():
        if isinstance(value, list | tuple) and value:
            found += [(f"the first of `{name}`", value[0]), (f"the last of `{name}`", value[-1])]
        else:
            found.append((f"`{name}`", value))
    numbers = [(n, float(v)) for n, v in found if isinstance(v, int | float) and not isinstance(v, bool)]
    return [(n, v) for n, v in numbers if math.isfinite(v)]  # infinity is no factor


def _of_ratio(a: float, e: float, inputs: Sequence[tuple[str, float]]) -> str:
    """The factor between two numbers: a known one, or one of the inputs."""
    ratio = a / e
    known = next((words for factor, words in _TIMES.items() if _same(abs(ratio), factor)), "")
    if known:
        some = [(n, v) for n, v in inputs if n[0] == "`" and v and not (_is_small(v) or _is_small(1.0 / v))]
        also = [n for n, v in some if _same(v, abs(ratio)) or _same(v * abs(ratio), 1.0)]
        turned = ", with the other sign" if ratio < 0 else ""
        return known + turned + (f" ({also[0]} is {dict(inputs)[also[0]]:g})" if len(also) == 1 else "")
    for power, words in ((1, "times {}"), (-1, "over {}"), (2, "times {} squared"), (-2, "over {} squared")):
        # A factor in [] would be one value of several, which no formula multiplies with.
        names = [n for n, v in inputs if n[0] == "`" and v > 0 and v != 1.0 and _same(abs(ratio), v**power)]
        if len(names) == 1:
            return f"the right one {words.format(names[0])}" + (", with the other sign" if ratio < 0 else "")
    return ""


def _is_small(value: float) -> bool:
    """Whether it is a whole number that others are by chance."""
    return value.is_integer() and abs(value) < _BY_CHANCE


def _of_difference(a: float, e: float, inputs: Sequence[tuple[str, float]]) -> str:
    """By how much a number is off, where that is one, or one of the inputs."""
    some = [(n, v) for n, v in inputs if n[0] == "`" and v > 0 and not _is_small(v)]
    by = next((n for n, v in some if abs(abs(a - e) - v) <= _SAME * max(v, abs(e))), "")
    if not by and _same(abs(a - e), 1.0):
        by = "1"
    return f"too {'large' if a > e else 'small'} by {by}" if by else ""


def _of_powers(a: float, e: float) -> str:
    if _same(a * e, 1.0):
        return "one over the right one"
    for x, y, words in ((e, a, "the square of the right one"), (a, e, "the square root of the right one")):
        # Of a number with few digits something else may be the square: 3/2 of 1.5 is.
        if x > 0.0 and _same(y, x * x) and _digits(x) > _DIGITS:
            return words
    return "the arctangent of the right one" if _same(a, math.atan(e)) else ""


def _of_digits(a: float, e: float) -> str:
    if abs(a) == 1.0:  # a ratio is one for many reasons
        return ""
    if _digits(a) <= _ROUNDED:
        return ""
    if a == math.trunc(e):
        return "the right one without its decimals"
    places = next((n for n in range(7) if a == round(e, n)), None)
    return f"the right one rounded to {counted(places, 'decimal')}" if places is not None else ""


# -- several --------------------------------------------------------------------------------------------


def _of_arrays(a: Array, e: Array, given: Mapping[str, Any]) -> str:
    if not np.isfinite(a).all():
        where = tuple(int(i) for i in np.argwhere(~np.isfinite(a))[0])
        return f"The first {a[where]:g} is at {list(where)}."
    if not np.isfinite(e).all() or _same(a, e) or a.size < 2:
        return ""
    places = "" if _same(a, -e) else _of_order(a, e)  # of (-1, 1) for (1, -1), the signs say more
    return places or _of_parts(a, e, given) or _of_all(a, e, given)


def _of_order(a: Array, e: Array) -> str:
    """The right values in other places."""
    if a.ndim == 2 and _same(a, e.T):
        return "Your matrix is the right one with rows and columns exchanged."
    if _same(a, e[::-1]) and len(e) > 1:
        two = "Each of the two stands in the other's place."
        return two if len(e) == 2 else "The values are right, in reverse order."
    if e.ndim == 1 and _same(np.sort(a), np.sort(e)):
        return "The values are right, in another order."
    if len(e) > 3 and np.ptp(e) > 0:
        if _same(a[1:], e[:-1]):
            return "From the second on, your values are the right ones, one place late."
        if _same(a[:-1], e[1:]):
            return "Your values are the right ones, one place early."
    return ""


def _of_parts(a: Array, e: Array, given: Mapping[str, Any]) -> str:
    """Which of the values are wrong, where some are right."""
    if _same(np.abs(a), np.abs(e)):
        signed = np.abs(e) > _SAME * np.max(np.abs(e))  # what rounding left of a zero has none
        off = np.argwhere(signed & (np.sign(a) != np.sign(e)))
        if len(off) == np.count_nonzero(signed):
            return "Only the signs are wrong."
        if len(off) > 2:
            return f"Only signs are wrong: {len(off)} of these {a.size} numbers have the other one."
        some = "sign" if len(off) == 1 else "signs"
        return f"Only the {some} of {_named(off, a)} {'is' if len(off) == 1 else 'are'} wrong."
    off = np.argwhere(np.abs(a - e) > _SAME * np.max(np.abs(e)))
    if not 0 < len(off) < a.size or a.ndim > 1 or len(off) > 2:
        return ""
    said = f"Only {_named(off, a)} is wrong" if len(off) == 1 else f"Only {_named(off, a)} are wrong"
    more = _of_two_numbers(float(a[tuple(off[0])]), float(e[tuple(off[0])]), given) if len(off) == 1 else ""
    return f"{said}: it is {more}." if more else f"{said}."


def _named(off: NDArray[np.intp], a: Array) -> str:
    if a.ndim > 1:
        return " and ".join(str([int(i) for i in one]) for one in off[:2])
    places = [int(one[0]) for one in off]
    if max(places) >= len(_PLACES):
        return " and ".join(f"[{i}]" for i in places)
    return " and ".join(f"the {_PLACES[i]}" for i in places) + " of these numbers"


def _of_all(a: Array, e: Array, given: Mapping[str, Any]) -> str:
    """What is the same in every place: a factor, a distance, a value."""
    unchanged = next((n for n, v in given.items() if (x := _array(v)) is not None and _same(a, x)), "")
    if unchanged:
        return f"Your result is `{unchanged}`, unchanged."
    if not a.any():
        return ""
    if _same(a, np.full_like(a, a.flat[0])) and np.ptp(e) > 0:
        return f"All your values are the same{'' if a.size < 3 else f': {a.flat[0]:.6g}'}."
    some = e != 0.0
    if np.count_nonzero(some) > 1 and not a[~some].any():
        ratios = a[some] / e[some]
        if _same(ratios, np.full_like(ratios, ratios[0])):
            said = _of_ratio(float(ratios[0]), 1.0, _inputs(given))
            return f"Every value is {said or f'{ratios[0]:.6g} times the right one'}."
    if _same(a - e + np.max(np.abs(e)), np.full_like(a, a.flat[0] - e.flat[0]) + np.max(np.abs(e))):
        by = float(a.flat[0] - e.flat[0])
        return f"Every value is too {'large' if by > 0 else 'small'} by the same {abs(by):.6g}."
    return ""


def _of_lengths(a: Array, e: Array) -> str:
    """What is missing, or too much, where one value is."""
    if a.ndim != e.ndim or not a.ndim or a.shape[1:] != e.shape[1:]:
        return ""
    pairs = (
        (a, e[1:], "The first is missing, the others are right."),
        (a, e[:-1], "The last is missing, the others are right."),
        (a[1:], e, "There is one too many, at the beginning."),
        (a[:-1], e, "There is one too many, at the end."),
    )
    return next((words for yours, right, words in pairs if _same(yours, right)), "")


# -- a function's own text -------------------------------------------------------------------------------

#: A loop that its own ``return`` ends in the first pass.
RETURN_IN_LOOP = "RETURN_IN_LOOP"


def return_in_a_loop(source: bytes, task: str, places: Places) -> Diagnosis | None:
    """A ``for`` loop of the task's function, or of a helper of it, that cannot have a second pass."""
    for function in functions_of(source, task):
        parts = list(ast.walk(function))
        goes_on = _around(parts, [part for part in parts if isinstance(part, ast.Continue)])
        for loop in parts:
            if isinstance(loop, ast.For) and isinstance(loop.body[-1], ast.Return) and loop not in goes_on:
                line = places.phrase(loop.body[-1].lineno)
                return Diagnosis(
                    RETURN_IN_LOOP,
                    f"The `return` {line} stands inside the loop, so the loop ends in its first pass.",
                    "Move that `return` out of the loop: indent it as far as the `for`.",
                )
    return None


def _around(parts: Sequence[ast.AST], inner: Collection[ast.AST]) -> set[ast.AST]:
    """Those of some parts, each before what is in it, that are, or have in them, one of the inner ones.

    In one pass: to search each of thousands would hold the grader, which has no deadline, for minutes.
    """
    found = set(inner)
    for part in reversed(parts):
        if not found.isdisjoint(ast.iter_child_nodes(part)):
            found.add(part)
    return found


def why_none(source: bytes, task: str, places: Places, name: str = "") -> str:
    """The advice where a function gives None instead of a value; "" if its text does not tell more.

    Args:
        name: what is None, as the finding calls it: the result, or an entry of the dict that is returned.
    """
    function = next(iter(functions_of(source, task)), None)
    if function is None:
        return ""
    own = list(_own(function))
    given = [part for part in own if isinstance(part, ast.Return) and _is_value(part.value)]
    if several := _several([part.value for part in given], name):
        return f"{several}, and `{name}` is None. Which line should have set it?"
    if given:
        around = _around(own, given)
        tests = [part for part in own if isinstance(part, ast.If) and part in around]
        if not tests or function.body[-1] in given:  # it does not end without a `return`
            what = f"`{name}`" if name.isidentifier() else "what it gives"
            return f"There is a `return`, and {what} is None here. Which line should have set it?"
        where = places.phrase(tests[-1].lineno)
        return f"There is a `return`. Was the condition {where} never met for this input?"
    if any(isinstance(part, ast.Call) and getattr(part.func, "id", "") == "print" for part in own):
        return "It prints its result. Give it back: write `return` where `print` stands."
    return ""


def _several(returned: list[ast.expr | None], name: str) -> str:
    """That there are other values beside the one called ``name``; "" if a ``return`` shows none."""
    keys = [key for value in returned if isinstance(value, ast.Dict) for key in value.keys]
    if any(isinstance(key, ast.Constant) and key.value == name for key in keys):
        return "A dict is returned"
    beside = name.isidentifier() and any(isinstance(value, ast.Tuple) for value in returned)
    return "Several values are returned" if beside else ""


def _own(function: ast.FunctionDef) -> Iterator[ast.AST]:
    """The parts of a function that belong to no function inside it."""
    left: list[ast.AST] = list(function.body)
    for part in left:  # it grows meanwhile
        yield part
        if not isinstance(part, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda | ast.ClassDef):
            left += ast.iter_child_nodes(part)


def _is_value(value: ast.expr | None) -> bool:
    return value is not None and not (isinstance(value, ast.Constant) and value.value is None)


def names_of(source: bytes, task: str) -> tuple[str, ...]:
    """The names of a function's arguments, in order."""
    function = next(iter(functions_of(source, task)), None)
    return tuple(arg.arg for arg in function.args.args) if function else ()
