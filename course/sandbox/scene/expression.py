"""The formulas of a scene, and the texts that hold them: ``course.formulas`` with a scene's own refusals."""

import re
import string
from collections.abc import Iterator, Mapping

from course.errors import UsageError
from course.formulas import Formula, FormulaError, read_formula


def evaluate(text: str, values: Mapping[str, float]) -> float:
    """The number that a formula gives.

    Args:
        text: the formula. ``name.field`` is looked up as one name, hyphens in it written as underscores.

    Raises:
        UsageError: it is not a formula, names something unknown, or has no value (a division by zero, say).
    """
    read = _read(text)
    for name in sorted(read.names - values.keys()):
        plain = sorted(known for known in values if "." not in known)
        fields = dict.fromkeys(known.partition(".")[2] for known in values if "." in known)
        of_bodies = f", and a body's {', '.join(fields)}" if fields else ""
        help_ = f"Known: {', '.join(plain)}{of_bodies}."
        raise _refused(name, "is not a name that this scene knows", help=help_)
    try:
        return float(read.value(values))
    except FormulaError as error:
        raise _refused(text, str(error), help="Choose other numbers, or correct it.") from error


def names(text: str) -> frozenset[str]:
    """The names a formula uses, functions and constants left out.

    Raises:
        UsageError: it is no formula.
    """
    return _read(text).names


def _read(text: str) -> Formula:
    try:
        return read_formula(text)
    except FormulaError as error:
        raise _refused(text if len(text) <= 300 else text[:40] + "...", str(error)) from None


def _refused(text: str, why: str, help: str = "Write plain arithmetic: sqrt(2 * g * drop).") -> UsageError:  # noqa: A002
    return UsageError(f"The formula {text!r} {why}.", help=help, code="bad_formula")


# ---
# Texts of a scene that hold numbers: ``{restitution}``, ``{speed * step:.2f}``.
#
# A number that a setting can change is never written out in a question or its explanation, because the text
# would then become false. The formulas are those above, and no text is ever handed to ``str.format``, whose
# fields reach into objects.


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
            said = f"{formula}:{shape or conversion}"
            raise _refused_text(said, "has a format other than .2f, .3g or +.1e")
        yield words, formula, shape or _USUAL


def _shown(value: float, shape: str) -> str:
    shown = format(value, shape)
    return shown.lstrip("-") if float(shown) == 0.0 else shown


def _refused_text(text: str, why: str) -> UsageError:
    short = text if len(text) <= 60 else text[:57] + "..."
    return UsageError(f"The text {short!r} {why}.", help=_HELP, code="bad_formula")
