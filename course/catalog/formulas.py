"""Arithmetic that a content file may contain: numbers, names, + - * / ** and a few functions.

A formula is parsed once and walked; nothing of it is ever executed as Python.

    >>> Formula("9.81 * h * t / 2").value({"h": 0.01, "t": 2})
    0.0981
"""

from __future__ import annotations

import ast
import math
import operator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

__all__ = ["FUNCTIONS", "Formula", "FormulaError"]

_BINARY: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: math.pow,  # a float: it neither takes for ever nor turns complex
}

#: ``round`` and ``ceil`` give whole numbers, which are shown without decimals.
FUNCTIONS: dict[str, Callable[[float], float]] = {
    "abs": abs,
    "ceil": math.ceil,
    "exp": math.exp,
    "log": math.log,
    "round": round,
    "sqrt": math.sqrt,
}


class FormulaError(ValueError):
    """A formula that cannot be read or has no finite value; the text says why."""


class Formula:
    """One formula.

    Args:
        text: for example ``"2 * sqrt(m / k)"``.

    Attributes:
        names: the names whose values it needs.

    Raises:
        FormulaError: it is not arithmetic.
    """

    def __init__(self, text: str) -> None:
        try:
            self._body = ast.parse(text.strip(), mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise FormulaError("it is not arithmetic") from None
        self.names = frozenset(_names(self._body))

    def value(self, given: Mapping[str, float]) -> float:
        """The value; an int where only whole numbers and ``round`` or ``ceil`` were involved.

        Raises:
            FormulaError: there is no finite real value.
        """
        try:
            result = _value(self._body, given)
            if math.isfinite(result):
                return result
        except ZeroDivisionError:
            raise FormulaError("it divides by zero") from None
        except (ValueError, OverflowError):
            pass
        raise FormulaError("it has no finite value")


def _names(node: ast.expr) -> set[str]:
    """Every name in a formula, after a check that each of its parts is allowed."""
    match node:
        case ast.Constant(value=bool() | complex() | str() | bytes() | None):
            pass
        case ast.Constant(value=int() | float()):
            return set()
        case ast.Name(id=name):
            return {name}
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=operand):
            return _names(operand)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
            return _names(left) | _names(right)
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in FUNCTIONS:
            return _names(argument)
    raise FormulaError(
        f"{ast.unparse(node)[:60]!r} is not one of: numbers, names, + - * / **, {', '.join(FUNCTIONS)}"
    )


def _value(node: ast.expr, given: Mapping[str, float]) -> float:
    match node:
        case ast.Constant(value=int() | float() as number):
            return number
        case ast.Name(id=name):
            return given[name]
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_value(operand, given)
        case ast.UnaryOp(operand=operand):
            return _value(operand, given)
        case ast.BinOp(left=left, op=op, right=right):
            return _BINARY[type(op)](_value(left, given), _value(right, given))
        case ast.Call(func=ast.Name(id=name), args=[argument]):
            return FUNCTIONS[name](_value(argument, given))
    raise FormulaError("it is not arithmetic")
