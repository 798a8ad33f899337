"""One story for each function: the common diagnosis of all the failed checks of a task."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Literal, TypeVar

import msgspec

from course.errors import ContentError
from course.ids import WARM_UPS
from course.scoring.verdict import Divergence

#: How much the fingerprints of equal programs may differ: those of right programs in other styles differed by
#: 1e-7, from rounding in simulations of several hundred steps; sums are stored with seven decimals. At 3e-5,
#: RK4 in two half steps was the same as RK4 with two stages at wrong times.
SAME = 1e-6

# ---
# The words of an exercise's diagnoses, one entry for each code.


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


Kind = Literal["cause", "consequence", "fact", "nan"]


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
    kind: Kind = "cause"


class Words:
    """The diagnoses of one exercise by their codes."""

    def __init__(self, entries: dict[str, Entry]) -> None:
        self.entries = entries

    def __call__(self, code: str, divergence: Divergence | None = None) -> Diagnosis:
        """The diagnosis of that code; KeyError if the exercise has no words for it."""
        if code == KEPT.code and code not in self.entries:
            return KEPT
        if code not in self.entries:
            raise KeyError(f"there are no words for {code}")
        entry = self.entries[code]
        return Diagnosis(code, entry.looks_like, entry.advice, divergence)

    def kind(self, code: str) -> str:
        """Its kind; a code without an entry is a fact that was found while reading a value."""
        if code in self.entries:
            return self.entries[code].kind
        return "nan" if code in NOT_FINITE else "fact"


@dataclass(frozen=True, slots=True)
class Failure:
    """One failed check of a task.

    Attributes:
        guess: the probe's diagnosis; None if it has none.
        finite: False if a compared value was nan or infinite.
        looked: its own probe was asked, on the numbers that it shows.
    """

    check: str
    guess: Diagnosis | None
    finite: bool = True
    looked: bool = False


@dataclass(frozen=True, slots=True)
class Story:
    """The diagnosis of a task's failed checks.

    Attributes:
        diagnosis: the mistake; None if none is recognised.
        own: ids of checks that keep their own diagnosis: facts that they saw directly.
        bare: ids of checks that it is not said of: they saw another mistake, or not this consequence.
    """

    diagnosis: Diagnosis | None
    own: frozenset[str]
    bare: frozenset[str] = frozenset()


def story_of(failures: Sequence[Failure], fits: Sequence[Row], words: Words, *, kept: bool = False) -> Story:
    """The story of a task.

    Something that is kept between two calls is said first, for it can look like anything else; where the
    exercise has a code for it, that one. Then a program that fits decides. If none fits, the probes decide:
    first the origin of a nan, then causes, then consequences. Of several causes, the one that most checks
    name is taken, and none if two are named equally often. A cause is said of every check that saw no other,
    unless its own probe looked at its own numbers and did not find it;
    a consequence, and where a nan comes from, only of those that saw it. Beside a nan, or where none is named
    most, consequences stay with the checks that saw them.

    Args:
        failures: its failed checks, in order.
        fits: known wrong programs that give the same answers as the student's.
        kept: the same call was seen to give another result after other calls.
    """
    own = frozenset(f.check for f in failures if f.guess and words.kind(f.guess.code) == "fact")
    left = [failure for failure in failures if failure.check not in own]
    guesses = [failure.guess for failure in left if failure.guess]
    shared = common(fits, [guess.code for guess in guesses])
    codes = OWN_WORDS if kept else STATE
    state = next((guess for guess in guesses if guess.code in codes), None)
    if kept and state is None:
        state = merged(shared, words, fits) if shared and shared[0] in OWN_WORDS else KEPT
    if state:
        return Story(state, own)
    if shared:
        return Story(merged(shared, words, fits), own)
    # Beside a nan, or where no consequence prevails, what a check saw of its own stays with it.
    saw = {f.check for f in left if f.finite and f.guess and words.kind(f.guess.code) == "consequence"}
    seen = own | saw
    if not all(failure.finite for failure in left):
        return Story(_origin(left, words), seen, frozenset(f.check for f in left if f.finite))
    for kind in ("cause", "nan", "consequence"):
        said = [guess for guess in guesses if words.kind(guess.code) == kind]
        if said:
            named = _most_named(said)
            keeps = kind == "nan" or (kind == "consequence" and named is None)
            return Story(named, seen if keeps else own, _contradicted(left, named, words))
    return Story(None, own)


def common(fits: Sequence[Row], guesses: Sequence[str] = ()) -> tuple[str, ...]:
    """The codes that all the fitting programs share, in the order of the first.

    Programs with one mistake and the same answers to all questions are one program under two names, and both
    names are true. The result is the name that a probe also gives, or else the first one, which a mutant has.
    """
    if not fits:
        return ()
    if len(fits[0].codes) == 1:
        names = [row.codes[0] for row in fits]
        return (next((code for code in guesses if code in names), names[0]),)
    shared = set(fits[0].codes).intersection(*(row.codes for row in fits[1:]))
    return tuple(dict.fromkeys(code for code in fits[0].codes if code in shared))


def merged(codes: Sequence[str], words: Words, fits: Sequence[Row]) -> Diagnosis:
    """One diagnosis of the mistakes that the fitting programs share, under the code of the first."""
    parts = [words(code) for code in codes]
    if all(len(row.codes) == 1 for row in fits):
        return parts[0]
    both = "There seem to be two mistakes."
    if len(parts) == 1:
        return Diagnosis(parts[0].code, f"{both} One of them: {parts[0].looks_like}", parts[0].advice)
    looks = [both, *(f"{place}: {part.looks_like}" for place, part in zip(_PLACES, parts, strict=False))]
    advice = [f"{place}: {part.advice}" for place, part in zip(_PLACES, parts, strict=False)]
    return Diagnosis(parts[0].code, " ".join(looks), " ".join(advice))


#: How the mistakes of a program that has several are counted.
_PLACES = ("First", "Second", "Third")
#: Two sentences that begin with so many words alike say the same, and the second says more.
_ALIKE = 5


def said_once(message: str, more: str) -> str:
    """A check's message and what is added to it, without the sentences that both have."""
    begins = {tuple(sentence.split()[:_ALIKE]) for sentence in _sentences(more)}
    kept = [one for one in _sentences(message) if tuple(one.split()[:_ALIKE]) not in begins]
    return " ".join([*kept, more]).strip()


def _sentences(text: str) -> list[str]:
    return re.split(r"(?<=[.!?]) +(?=[A-Z`])", text.strip()) if text.strip() else []


def _origin(failures: Sequence[Failure], words: Words) -> Diagnosis | None:
    """The origin of a nan, if all checks that met one agree on it; otherwise only that there is one."""
    guesses = [one.guess for one in failures if not one.finite and one.guess]
    said = {guess.code: guess for guess in guesses if words.kind(guess.code) == "nan"}
    if len(said) == 1:
        return next(iter(said.values()))
    return next((guess for code, guess in said.items() if code in NOT_FINITE), None)


def _contradicted(failures: Sequence[Failure], named: Diagnosis | None, words: Words) -> frozenset[str]:
    """The checks of which ``named`` is not known to be true."""
    if named is None:
        return frozenset()
    kind = words.kind(named.code)
    if kind != "cause":
        return frozenset(f.check for f in failures if not f.guess or f.guess.code != named.code)
    others = (f for f in failures if f.guess and f.guess.code != named.code)
    refuted = (f.check for f in failures if f.looked and f.guess is None)
    return frozenset((*(f.check for f in others if f.guess and words.kind(f.guess.code) == kind), *refuted))


def _most_named(guesses: Sequence[Diagnosis]) -> Diagnosis | None:
    votes = Counter(guess.code for guess in guesses).most_common(2)
    if len(votes) > 1 and votes[0][1] == votes[1][1]:
        return None
    best = [guess for guess in guesses if guess.code == votes[0][0]]
    return next((guess for guess in best if guess.divergence), best[0])


# ---
# What is shipped of an exercise's mistakes: ``diagnoses.json``, made by a command.
#
# The file is part of the exercise, so that a diagnosis at home is as good as in a grading run. It contains
# nothing that solves the exercise: words, what wrong programs answer to the exercise's questions, as
# fingerprints, and the answers to public checks with fixed inputs. Warm-ups share one, beside their folders.


TABLE = "diagnoses.json"


_Kind = TypeVar("_Kind")


class Row(msgspec.Struct, frozen=True, array_like=True):
    """One wrong program: the codes of its mistakes, and its answers.

    Attributes:
        codes: one for each mistake.
        sums: its fingerprint, or the answers themselves where a task is compared within a tolerance.
    """

    codes: tuple[str, ...]
    sums: tuple[float, ...]


class Table(msgspec.Struct, frozen=True, kw_only=True):
    """What ``diagnoses.json`` holds of an exercise.

    Attributes:
        made_from: digest of what it was computed from.
        within: relative tolerance of the tasks whose answers are stored directly.
        rows: by task; programs with one mistake come first.
        right: fingerprints of right programs, by task.
        answers: those that public checks with fixed inputs expect, by check and in its order.
    """

    format_version: int = 1
    made_from: str = ""
    words: dict[str, Entry] = {}
    within: dict[str, float] = {}
    rows: dict[str, tuple[Row, ...]] = {}
    right: dict[str, tuple[tuple[float, ...], ...]] = {}
    answers: dict[str, list[Any]] = {}


def table_path(folder: Path) -> Path:
    """Where the table of the exercise in this folder is kept, whether or not it is there."""
    return (folder.parent if folder.parent.name == WARM_UPS else folder) / TABLE


def read_table(folder: Path) -> Table | None:
    """The table of the exercise in this folder; None if it has none.

    Raises:
        ContentError: it is damaged.
    """
    path = table_path(folder)
    if not path.is_file():
        return None
    return _own(path) if path.parent == folder else tables_in(path).get(folder.name)


def words_in(folder: Path) -> Words:
    """The words of the exercise in this folder, as its table is now.

    Probes ask once, when they are imported, and keep what they get; so all who asked get the same object, and
    it has the new words as soon as anybody asks after a table was written.
    """
    table = read_table(folder)
    found = _given.setdefault(folder, Words({}))
    found.entries = table.words if table else {}
    return found


_given: dict[Path, Words] = {}


@cache
def _own(path: Path) -> Table:
    return _decoded(path, Table)


@cache
def tables_in(path: Path) -> dict[str, Table]:
    """The tables of all warm-ups, by id."""
    return _decoded(path, dict[str, Table])


def forget_tables() -> None:
    """Read them again when they are asked for: one was just written."""
    _own.cache_clear()
    tables_in.cache_clear()


def _decoded(path: Path, kind: type[_Kind]) -> _Kind:
    try:
        return msgspec.json.decode(path.read_bytes(), type=kind)
    except (OSError, msgspec.DecodeError) as error:
        problem = f"what is known about mistakes cannot be read: {error}."
        raise ContentError(path, None, problem, help="`course author build`") from None


def matching(table: Table, task: str, sums: Sequence[float]) -> tuple[Row, ...]:
    """The programs with these sums, and of these only the ones with the fewest mistakes."""
    within = table.within.get(task, 0.0)
    fits = [row for row in table.rows.get(task, ()) if _same(row.sums, sums, within)]
    fewest = min((len(row.codes) for row in fits), default=0)
    return tuple(row for row in fits if len(row.codes) == fewest)


def is_right(table: Table, task: str, sums: Sequence[float]) -> bool:
    """Whether a right program has these sums."""
    within = table.within.get(task, 0.0)
    return any(_same(right, sums, within) for right in table.right.get(task, ()))


def _same(a: Sequence[float], b: Sequence[float], within: float) -> bool:
    if len(a) != len(b):
        return False
    if not within:
        return all(abs(x - y) <= SAME for x, y in zip(a, b, strict=True))
    return all(x == y or abs(x - y) <= within * max(abs(x), abs(y)) for x, y in zip(a, b, strict=True))
