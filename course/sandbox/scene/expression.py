"""Arithmetic in a scene's text: ``sqrt(2 * g * drop)``.

A scene is data, and a student's own scene may come from anywhere, so a formula in it is read as a syntax tree
of numbers, names, ``+ - * / **`` and a handful of functions, and never handed to ``eval``.
"""

from __future__ import annotations

import ast
import math
import operator
import re
import string
import warnings
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache

from course.errors import UsageError

_MAX_LENGTH = 300
#: Longest chain of operations; a deeper tree is not a formula that a person wrote.
_MAX_DEPTH = 40

#: Largest n of a binomial coefficient: beyond about a thousand the result is too large for a float.
_MOST = 1000


def _comb(n: float, k: float) -> float:
    if not 0 <= k <= n <= _MOST:
        raise ValueError(f"comb needs 0 <= k <= n <= {_MOST}")
    return float(math.comb(round(n), round(k)))


_BINARY: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: math.pow,
}
_FUNCTIONS: dict[str, Callable[..., float]] = {
    "abs": abs,
    "atan": math.atan,
    "atan2": math.atan2,
    "comb": _comb,
    "cos": math.cos,
    "degrees": math.degrees,
    "exp": math.exp,
    "log": math.log,
    "max": max,
    "min": min,
    "radians": math.radians,
    "sin": math.sin,
    "sqrt": math.sqrt,
    "tan": math.tan,
}
_CONSTANTS = {"pi": math.pi}


def evaluate(text: str, values: Mapping[str, float]) -> float:
    """The number that a formula gives.

    Args:
        text: the formula. ``name.field`` is looked up as one name, hyphens in it written as underscores.
        values: the value of each name.

    Raises:
        UsageError: it is not a formula, names something unknown, or has no value (a division by zero, say).
    """
    tree, used_names = _read(text)
    known = _CONSTANTS | {name: float(values[name]) for name in used_names if name in values}
    for name in sorted(used_names - known.keys()):
        help_ = f"Known: {', '.join(sorted(values))}."
        raise _refused(name, "is not a name that this scene knows", help=help_)
    try:
        return _value(tree, known)
    except (ArithmeticError, ValueError, OverflowError, TypeError) as error:
        raise _refused(
            text, f"has no value ({error})", help="Choose other numbers, or correct it."
        ) from error


def names(text: str) -> frozenset[str]:
    """The names a formula uses, functions and constants left out.

    Raises:
        UsageError: it is no formula.
    """
    return _read(text)[1] - _CONSTANTS.keys()


@lru_cache(maxsize=256)  # reading a scene asks for each of its formulas a dozen times
def _read(text: str) -> tuple[ast.expr, frozenset[str]]:
    """The tree of a formula, in which there is nothing but arithmetic, and the names in it."""
    if len(text) > _MAX_LENGTH:
        raise _refused(text[:40] + "...", f"is longer than {_MAX_LENGTH} letters")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about odd escapes in what will be refused anyway
            tree = ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise _refused(text, "is not a formula") from None
    return tree, frozenset(_names_in(tree, text))


def _names_in(node: ast.expr, text: str, level: int = 1) -> Iterator[str]:
    """The names in a tree; everything but arithmetic is refused."""
    if level > _MAX_DEPTH:
        raise _refused(text, "is nested too deeply")
    below: list[ast.expr] = []
    match node:
        case ast.Constant(value=bool()):
            raise _refused(text, "may hold numbers, not True or False")
        case ast.Constant(value=int() | float()):
            pass
        case ast.Name(id=name):
            yield name
        case ast.Attribute(value=ast.Name(id=name), attr=field):
            yield f"{name}.{field}"
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=inner):
            below = [inner]
        case ast.BinOp(left=left, op=sign, right=right) if type(sign) in _BINARY:
            below = [left, right]
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]) if name in _FUNCTIONS:
            below = arguments
        case _:
            raise _refused(text, f"may use + - * / **, numbers, names and {', '.join(sorted(_FUNCTIONS))}")
    for inner in below:
        yield from _names_in(inner, text, level + 1)


def _value(node: ast.expr, values: Mapping[str, float]) -> float:
    """The value of a tree that ``_names_in`` let pass."""
    match node:
        case ast.Constant(value=number):
            return float(number)  # type: ignore[arg-type]
        case ast.UnaryOp(op=sign, operand=inner):
            return _value(inner, values) * (-1 if isinstance(sign, ast.USub) else 1)
        case ast.BinOp(left=left, op=sign, right=right):
            return float(_BINARY[type(sign)](_value(left, values), _value(right, values)))
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return float(_FUNCTIONS[name](*(_value(argument, values) for argument in arguments)))
    return values[ast.unparse(node)]


def _refused(text: str, why: str, help: str = "Write plain arithmetic: sqrt(2 * g * drop).") -> UsageError:  # noqa: A002
    return UsageError(f"The formula {text!r} {why}.", help=help, code="bad_formula")


# ---
# Texts of a scene that hold numbers: ``{restitution}``, ``{speed * step:.2f}``.
#
# A number that a setting can change is never written out in a question or its explanation, because the text
# would then become false. The formulas are those of ``course.sandbox.scene.expression``, and no text is ever
# handed to ``str.format``, whose fields reach into objects.


#: The formats a number may have; few digits, because a text is not a table.
_SHAPE = re.compile(r"\+?(\.\d)?[efg]")
#: The default: 0.4, 30, 0.004167.
_USUAL = ".4g"
_HELP = "Write {speed * step} or {speed:.2f}; a brace that is meant as one is doubled: {{."


def fill(text: str, values: Mapping[str, float]) -> str:
    """A text with the value of each of its formulas in the formula's place.

    Args:
        text: formulas are in braces, with a format such as ``.2f`` after a colon where four digits are wrong.
        values: the value of each name; see ``course.sandbox.scene.loading.values_of``.

    Raises:
        UsageError: one is no formula, names something unknown or has no value, or a brace is left over.
    """
    return "".join(
        words + ("" if formula is None else _shown(evaluate(formula, values), shape))
        for words, formula, shape in _pieces(text)
    )


def used(text: str) -> frozenset[str]:
    """The names its formulas use.

    Raises:
        UsageError: see ``fill``.
    """
    found = (names(formula) for _, formula, _ in _pieces(text) if formula is not None)
    return frozenset(name for some in found for name in some)


def _pieces(text: str) -> Iterator[tuple[str, str | None, str]]:
    """Words, the formula after them if there is one, and how to show its value."""
    try:
        pieces = list(string.Formatter().parse(text))
    except ValueError as error:
        raise _refused_text(text, f"has a brace without its partner ({error})") from None
    for words, formula, shape, conversion in pieces:
        if conversion or (shape and not _SHAPE.fullmatch(shape)):
            raise _refused_text(
                f"{formula}:{shape or conversion}", "has a format other than .2f, .3g or +.1e"
            )
        yield words, formula, shape or _USUAL


def _shown(value: float, shape: str) -> str:
    shown = format(value, shape)
    return shown.lstrip("-") if float(shown) == 0.0 else shown


def _refused_text(text: str, why: str) -> UsageError:
    short = text if len(text) <= 60 else text[:57] + "..."
    return UsageError(f"The text {short!r} {why}.", help=_HELP, code="bad_formula")
