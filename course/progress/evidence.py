"""The numbers of a failed check as words, which a hint may use: what went in, what came back, what is right.

Public checks only: what a student may not see in a finding is not in a hint either.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from course.printable import one_line

if TYPE_CHECKING:
    from collections.abc import Mapping

    class Finding(Protocol):
        """What is read of a check's result."""

        @property
        def status(self) -> str: ...
        @property
        def visibility(self) -> str: ...
        @property
        def input(self) -> Mapping[str, Any] | None: ...
        @property
        def expected(self) -> Any: ...
        @property
        def actual(self) -> Any: ...


__all__ = ["numbers_of", "raised_by"]

#: Longest list and longest text that a sentence can hold.
_ITEMS, _LETTERS = 8, 40
#: The most of an exception that is kept, in characters.
_RAISED = 120
#: Numbers beyond it are not compared: they come from a program that ran away.
_HUGE = 1e150


def numbers_of(check: Finding) -> dict[str, str]:
    """The fields that a hint may name.

    Returns:
        each input by its name; ``expected`` and ``got``; where they are numbers, ``off``, which is got minus
        expected, and ``ratio``, got over expected; where one entry of an array was compared, ``at``, which
        names it. None, a ratio of 0 or 1 and values too long for a sentence are left out, and all of them
        where the check passed or is a hidden one.
    """
    if check.status != "fail" or check.visibility != "public":
        return {}
    # The entries of a list may be told apart by a late digit only.
    fields = {k: _words(x, 10 if isinstance(x, list) else 4) for k, x in (check.input or {}).items()}
    expected, got, fields["at"] = _compared(check.expected, check.actual)
    right, own = _apart(expected, got)
    fields["expected"], fields["got"] = "" if expected is None else right, "" if got is None else own
    if _is_number(expected) and _is_number(got):
        fields["off"] = f"{'+' * (got > expected)}{_words(got - expected)}"
        ratio = _words(got / expected) if expected and got else ""
        fields["ratio"] = "" if ratio == "1" else ratio
    return {name: words for name, words in fields.items() if words}


def raised_by(check: Finding) -> str:
    """The exception that ended a public check, in its own words; "" if none did."""
    if check.status != "error" or check.visibility != "public" or not isinstance(check.actual, str):
        return ""
    return one_line(check.actual, _RAISED)


def _compared(expected: Any, got: Any) -> tuple[Any, Any, str]:
    """What was expected, what came, and of which entry: that of {"q[2]": 0.5} and {"q[2]": 0.4} is q[2]."""
    if not isinstance(expected, dict) or len(expected) != 1:
        return expected, got, ""
    ((name, value),) = expected.items()
    if name in {"at least", "at most"}:
        return f"{name} {_words(value)}", got, ""
    if isinstance(got, dict) and got.keys() == expected.keys():
        return value, got[name], str(name)
    return expected, got, ""


def _apart(expected: Any, got: Any) -> tuple[str, str]:
    """Both with four digits, or with so many that they differ."""
    pairs = ((_words(expected, digits), _words(got, digits)) for digits in (4, 8, 16))
    return next(((right, own) for right, own in pairs if right != own), ("", ""))


def _words(value: Any, digits: int = 4) -> str:
    """The value for a sentence; "" if it is too long for one."""
    if isinstance(value, bool | None):
        return str(value)
    if isinstance(value, int):
        return str(value) if abs(value) < _HUGE else ""
    if isinstance(value, float):
        return f"{value + 0.0:.{digits}g}"  # no "-0"
    if isinstance(value, list | tuple) and 0 < len(value) <= _ITEMS:
        items = [_words(item, digits) for item in value]
        return f"[{', '.join(items)}]" if all(items) else ""
    return value if isinstance(value, str) and len(value) <= _LETTERS else ""


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _HUGE
