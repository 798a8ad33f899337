"""Arithmetic that a content file may contain: ``2 * sqrt(m / k)``.

A question's numbers and a scene's theory are formulas, and a student's own scene may come from anywhere. Each
is read once as a syntax tree of numbers, names, ``+ - * / **`` and a handful of functions, and none runs
as Python.
"""

from __future__ import annotations

import ast
import math
import operator
import warnings
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import TypeAlias

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
    ast.Pow: math.pow,  # a float: it neither takes for ever nor turns complex
}
#: ``round`` and ``ceil`` give whole numbers, which are shown without decimals.
_FUNCTIONS: dict[str, Callable[..., float]] = {
    "abs": abs,
    "atan": math.atan,
    "atan2": math.atan2,
    "ceil": math.ceil,
    "comb": _comb,
    "cos": math.cos,
    "degrees": math.degrees,
    "exp": math.exp,
    "log": math.log,
    "max": max,
    "min": min,
    "radians": math.radians,
    "round": round,
    "sin": math.sin,
    "sqrt": math.sqrt,
    "tan": math.tan,
}
_CONSTANTS = {"pi": math.pi}

#: The value of a formula, or of a part of it, from those of its names.
_Computed: TypeAlias = "Callable[[Mapping[str, float]], float]"


class FormulaError(ValueError):
    """A formula that cannot be read or has no finite value; the text is a predicate: "is not a formula"."""


class Formula:
    """One formula; ``read_formula`` keeps those that were read.

    Args:
        text: for example ``"2 * sqrt(m / k)"``; ``ball.mass`` is one name.

    Attributes:
        names: the names whose values it needs.

    Raises:
        FormulaError: it is not arithmetic.
    """

    def __init__(self, text: str) -> None:
        if len(text) > _MAX_LENGTH:
            raise FormulaError(f"is longer than {_MAX_LENGTH} letters")
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # about odd escapes in what will be refused anyway
                body = ast.parse(text.strip(), mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise FormulaError("is not a formula") from None
        self._computed, used = _compiled(body)
        self.names = used - _CONSTANTS.keys()

    def value(self, given: Mapping[str, float]) -> float:
        """The value; an int where only whole numbers and ``round`` or ``ceil`` were involved.

        Raises:
            FormulaError: there is no finite real value.
        """
        known = {**_CONSTANTS, **given}
        try:
            result = self._computed(known)
            if math.isfinite(result):
                return result
            why = "too large a number"
        except (ArithmeticError, ValueError, TypeError) as error:
            why = str(error)
        raise FormulaError(f"has no value ({why})")


def _compiled(node: ast.expr, level: int = 1) -> tuple[_Computed, frozenset[str]]:
    """What a part of a formula computes, and the names in it; a part that is not allowed is refused."""
    if level > _MAX_DEPTH:
        raise FormulaError("is nested too deeply")
    match node:
        case ast.Constant(value=bool()):
            raise FormulaError("may hold numbers, not True or False")
        case ast.Constant(value=int() | float() as number):
            return lambda _: number, frozenset()
        case ast.Name() | ast.Attribute(value=ast.Name()):
            name = ast.unparse(node)
            return lambda given: given[name], frozenset({name})
        case ast.UnaryOp(op=ast.UAdd() | ast.USub() as sign, operand=operand):
            value, names = _compiled(operand, level + 1)
            return (lambda given: -value(given)) if isinstance(sign, ast.USub) else value, names
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
            operate = _BINARY[type(op)]
            (one, ones), (other, others) = _compiled(left, level + 1), _compiled(right, level + 1)
            return lambda given: operate(one(given), other(given)), ones | others
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]) if name in _FUNCTIONS:
            function, parts = _FUNCTIONS[name], [_compiled(argument, level + 1) for argument in arguments]
            return lambda given: function(*(part(given) for part, _ in parts)), frozenset().union(
                *(names for _, names in parts)
            )
    raise FormulaError(f"may use + - * / **, numbers, names and {', '.join(_FUNCTIONS)}")


#: Reading a scene asks for each of its formulas a dozen times.
read_formula = lru_cache(maxsize=256)(Formula)
