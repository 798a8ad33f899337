"""One story for each function: the common diagnosis of all the failed checks of a task."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from course.scoring.explain.words import KEPT, NOT_FINITE, OWN_WORDS, STATE, Diagnosis

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.scoring.explain.table import Row
    from course.scoring.explain.words import Words

__all__ = ["Failure", "Story", "story_of"]


@dataclass(frozen=True, slots=True)
class Failure:
    """One failed check of a task.

    Attributes:
        check: its id.
        guess: the probe's diagnosis; None if it has none.
        finite: False if a compared value was nan or infinite.
    """

    check: str
    guess: Diagnosis | None
    finite: bool = True


@dataclass(frozen=True, slots=True)
class Story:
    """The diagnosis of a task's failed checks.

    Attributes:
        diagnosis: the mistake; None if none is recognised.
        certain: True if a known wrong program answers every question like the student's.
        own: ids of checks that keep their own diagnosis: facts that they saw directly.
        bare: ids of checks that it is not said of: they saw another mistake, or not this consequence.
    """

    diagnosis: Diagnosis | None
    certain: bool
    own: frozenset[str]
    bare: frozenset[str] = frozenset()


def story_of(failures: Sequence[Failure], fits: Sequence[Row], words: Words, *, kept: bool = False) -> Story:
    """The story of a task.

    Something that is kept between two calls is said first, for it can look like anything else; where the
    exercise has a code for it, that one. Then a program that fits decides. If none fits, the probes decide:
    first the origin of a nan, then causes, then consequences. Of several causes, the one that most checks
    name is taken, and none if two are named equally often. A cause is said of every check that saw no other;
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
        return Story(state, True, own)
    if shared:
        return Story(merged(shared, words, fits), True, own)
    # Beside a nan, or where no consequence prevails, what a check saw of its own stays with it.
    saw = {f.check for f in left if f.finite and f.guess and words.kind(f.guess.code) == "consequence"}
    seen = own | saw
    if not all(failure.finite for failure in left):
        return Story(_origin(left, words), False, seen, frozenset(f.check for f in left if f.finite))
    for kind in ("cause", "nan", "consequence"):
        said = [guess for guess in guesses if words.kind(guess.code) == kind]
        if said:
            named = _most_named(said)
            keeps = kind == "nan" or (kind == "consequence" and named is None)
            return Story(named, False, seen if keeps else own, _contradicted(left, named, words))
    return Story(None, False, own)


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
    # Of a program with one of them alone; with both at once it need not be so.
    looks = " Of the other: ".join(part.looks_like for part in parts)
    advice = " And for the other: ".join(part.advice for part in parts)
    both = "Two mistakes at once would give these results. What is said of one of them alone: "
    return Diagnosis(parts[0].code, both + looks, advice)


def _origin(failures: Sequence[Failure], words: Words) -> Diagnosis | None:
    """The origin of a nan, if all checks that met one agree on it; otherwise only that there is one."""
    said = {
        f.guess.code: f.guess
        for f in failures
        if not f.finite and f.guess and words.kind(f.guess.code) == "nan"
    }
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
    return frozenset(f.check for f in others if f.guess and words.kind(f.guess.code) == kind)


def _most_named(guesses: Sequence[Diagnosis]) -> Diagnosis | None:
    votes = Counter(guess.code for guess in guesses).most_common(2)
    if len(votes) > 1 and votes[0][1] == votes[1][1]:
        return None
    best = [guess for guess in guesses if guess.code == votes[0][0]]
    return next((guess for guess in best if guess.divergence), best[0])
