"""The words of an exercise's diagnoses: ``diagnoses.toml``, one table for each code."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Literal

import msgspec

from course.catalog.reading import read_document

if TYPE_CHECKING:
    from pathlib import Path

    from course.scoring.divergence import Divergence

__all__ = ["FILE", "KEPT", "NOT_FINITE", "OWN_WORDS", "STATE", "Diagnosis", "Entry", "Words", "read_words"]


FILE = "diagnoses.toml"


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """Which mistake a failure looks like.

    Attributes:
        code: stable name, upper case with underscores.
        looks_like: one sentence, without values, that says what the student's code seems to do.
        advice: what to change, without values.
        divergence: where the trajectory first left the reference, if that was looked for.
    """

    code: str
    looks_like: str
    advice: str
    divergence: Divergence | None = None


#: Codes of values that are nan or infinite where a number belongs, from any cause.
NOT_FINITE = frozenset({"NOT_A_NUMBER", "NOT_FINITE"})
#: Codes of exercises for something that is kept between two calls: probes that say them have seen it.
STATE = frozenset({"STALE_CACHE", "STATE_IN_MODULE", "STATE_KEPT"})
#: Codes whose words are true of it, too, and say what of it matters: they win once it was seen.
OWN_WORDS = STATE | {"BIAS_CARRIED_OVER", "WALLS_NOT_READ", "LAG_WITHOUT_DT", "GAINS_HARD_CODED"}
#: What is said of it where an exercise has no words of its own.
KEPT = Diagnosis(
    "STATE_KEPT",
    "The same call gives another result when other calls come before it: something is kept between calls.",
    "What a call returns may depend on its arguments alone. Look for what one call changes and a later one "
    "reads: a variable at the top of the file, an array or a dict that is filled again, a default argument.",
)


class Entry(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One diagnosis in words.

    Attributes:
        looks_like, advice: as in ``Diagnosis``.
        kind: "cause" of wrong values; "consequence", which says what is broken but not why; "fact", which the
            check saw directly and which is true whatever else is wrong; "nan", the origin of a nan or an
            infinity.
    """

    looks_like: str
    advice: str
    kind: Literal["cause", "consequence", "fact", "nan"] = "cause"


class _File(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    format_version: int
    diagnosis: dict[str, Entry]


class Words:
    """The diagnoses of one exercise by their codes."""

    def __init__(self, entries: dict[str, Entry]) -> None:
        self.entries = entries

    def __call__(self, code: str, divergence: Divergence | None = None) -> Diagnosis:
        """The diagnosis of that code.

        Raises:
            KeyError: ``diagnoses.toml`` has no words for it.
        """
        if code == KEPT.code and code not in self.entries:
            return KEPT
        if code not in self.entries:
            raise KeyError(f"diagnoses.toml has no words for {code}")
        entry = self.entries[code]
        return Diagnosis(code, entry.looks_like, entry.advice, divergence)

    def kind(self, code: str) -> str:
        """Its kind; a code without an entry is a fact that was found while reading a value."""
        if code in self.entries:
            return self.entries[code].kind
        return "nan" if code in NOT_FINITE else "fact"


@cache
def read_words(path: Path) -> Words:
    """The words in a ``diagnoses.toml``.

    Raises:
        ContentError: the file is wrong; the message names the line.
    """
    return Words(read_document(path, _File).value.diagnosis)
