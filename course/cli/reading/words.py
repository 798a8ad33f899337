"""Words shared by all ways of printing a lesson."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from course.errors import NotFoundError

if TYPE_CHECKING:
    from course.catalog.load import Catalog

__all__ = ["LABELS", "link_words", "value_spoken", "value_text"]

#: The heading of a passage with a role.
LABELS = {
    "predict": "Predict first",
    "answer": "Answer",
    "myth": "Myth",
    "fact": "Fact",
    "analogy": "Analogy",
    "remember": "Remember",
    "note": "Note",
}

_SCIENTIFIC = re.compile(r"^([-+−]?[\d.]+)e([-+]?\d+)")
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def value_text(text: str) -> str:
    """A quoted number as people write it: 4.4e8 is 4.4 × 10⁸, a hyphen is a minus sign."""
    shown = _SCIENTIFIC.sub(lambda m: _power(m[1], m[2]), text)
    return re.sub(r"^-", "−", shown)


def _power(mantissa: str, exponent: str) -> str:
    power = "10" + str(int(exponent)).translate(_RAISED)
    return power if mantissa == "1" else f"{mantissa} × {power}"


def value_spoken(text: str) -> str:
    """A quoted number as people say it."""
    spoken = _SCIENTIFIC.sub(lambda m: f"{m[1]} times 10 to the power {int(m[2])}", text)
    return re.sub(r"(^|(?<=power ))[-−]", "minus ", spoken)


def link_words(catalog: Catalog, target: str, words: str) -> str:
    """The words of a link and, unless they say it already, where it leads."""
    kind, _, rest = target.partition(":")
    name = rest.partition("#")[0]
    if kind == "https":
        return words if target.removeprefix("https://") == words else f"{words} ({target})"
    if target.startswith("#"):
        return words
    command = f"course lesson {name}" if kind == "lesson" else f"course start {name}"
    try:
        (catalog.lesson if kind == "lesson" else catalog.exercise)(name)
    except NotFoundError:
        return words
    return f"{words} ({command})"
