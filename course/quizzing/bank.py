"""The bank of questions, and what one seed makes of it.

A seed decides everything a student sees: for each question the variant, its numbers and the order of the
options. Nothing but SHA-256 is used to draw, so a seed means the same questions on every machine and every
version of Python, and a grading run can pose an attempt again from its seed alone.

    >>> from course.catalog.load import Catalog
    >>> bank = Bank.of(Catalog())
    >>> [posed.question for posed in bank.pose(7)] == list(bank.ids)
    True
"""

from __future__ import annotations

import hashlib
import math
import re
import secrets
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from course.catalog.load import Catalog
from course.catalog.questions import Question, Variant, read_questions
from course.catalog.reading import Document
from course.errors import NotFoundError, UsageError
from course.formulas import FormulaError, read_formula
from course.printable import counted

MAX_SEED = 2**31 - 1
LETTERS = "abcd"

#: Two numbers closer than this share of the larger one are too close to choose between.
LEAST_GAP = 0.02

#: Units that are others times a factor, or the same in words.
_UNITS = {
    "km": (1e3, "m"), "cm": (1e-2, "m"), "mm": (1e-3, "m"), "metres?": (1.0, "m"), "meters?": (1.0, "m"),
    "ms": (1e-3, "s"), "[µμ]s": (1e-6, "s"), "min": (60.0, "s"), "seconds?": (1.0, "s"),
    "g": (1e-3, "kg"), "kJ": (1e3, "j"), "kN": (1e3, "n"), "%": (1.0, "%"), "per ?cent": (1.0, "%"),
}  # fmt: skip
_QUANTITY = re.compile(
    r"(?P<sign>(?<![\w.])[-−])?(?P<number>\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?)"
    rf"(?:\s*(?P<unit>{'|'.join(_UNITS)})(?![\w/²³^]))?",
    re.IGNORECASE,
)
#: Words beside a number that make no other answer of it.
_FILLER = {"about", "almost", "approximately", "around", "exactly", "just", "nearly", "roughly", "some"}
_WORDLESS = re.compile(r"[\s.,;:!?=()~≈]+")
#: A number with its unit, and nothing more.
_BARE = re.compile(r"# [^\s#]+")


@dataclass(frozen=True, slots=True)
class Choice:
    """One option as it is shown.

    Attributes:
        letter: its place, "a" first.
        misconception: of a wrong one, the name of the belief behind it; empty for the right one.
        belief: that misconception in the words of who holds it.
    """

    letter: str
    id: str
    text: str
    explanation: str
    right: bool
    misconception: str
    belief: str


@dataclass(frozen=True, slots=True)
class PosedQuestion:
    """One question as one seed asks it."""

    question: str
    title: str
    variant: str
    prompt: str
    choices: tuple[Choice, ...]
    source: str
    read: str

    @property
    def lesson(self) -> str:
        """The lesson that explains it; empty if none."""
        return self.read.partition("#")[0]

    @property
    def key(self) -> Choice:
        return next(choice for choice in self.choices if choice.right)

    def choice(self, name: str) -> Choice | None:
        """The choice with this id, letter or number ("1" is "a"); None if there is none."""
        name = name.strip().lower()
        return next((c for i, c in enumerate(self.choices, 1) if name in {c.id, c.letter, str(i)}), None)


class Bank:
    """The questions of one course, in their order."""

    def __init__(self, documents: Sequence[Document[Question]]) -> None:
        self.documents = tuple(documents)
        self._by_id = {document.value.id: document for document in self.documents}

    @classmethod
    def of(cls, catalog: Catalog) -> Bank:
        """The bank of a course.

        Raises:
            ContentError: a question is wrong.
            NotFoundError: the course has no quiz.
        """
        documents = read_questions(catalog.content.quiz)
        if not documents:
            problem = "This course has no quiz."
            fix = f"Its questions would be in {catalog.content.quiz}."
            raise NotFoundError(problem, help=fix, code="quiz_not_found")
        return cls(documents)

    @property
    def ids(self) -> tuple[str, ...]:
        return tuple(self._by_id)

    @property
    def digest(self) -> str:
        """SHA-256 of all the question files: changes when any of them does."""
        total = hashlib.sha256()
        for document in self.documents:
            total.update(hashlib.sha256(document.path.read_bytes()).digest())
        return total.hexdigest()

    def pose(self, seed: int, only: Sequence[str] | None = None) -> tuple[PosedQuestion, ...]:
        """The questions as ``seed`` asks them; ``only`` these, or all.

        Raises:
            ContentError: a variant's numbers make two of its options the same.
        """
        chosen = self.ids if only is None else [name for name in self.ids if name in only]
        return tuple(self._pose(self._by_id[name], seed) for name in chosen)

    def variant(self, question: str, seed: int) -> str:
        """Id of the variant that ``seed`` picks for a question."""
        return self._pick(self._by_id[question].value, seed)[1].id

    def _pick(self, question: Question, seed: int) -> tuple[int, Variant]:
        index = draw(seed, question.id, "variant") % len(question.variant)
        return index, question.variant[index]

    def _pose(self, document: Document[Question], seed: int) -> PosedQuestion:
        question = document.value
        index, variant = self._pick(question, seed)
        case = draw(seed, question.id, variant.id, "case") % variant.cases
        posed = pose_case(document, index, case)
        if (clash := clashing(posed.choices)) is not None:
            one, other = clash
            document.fail(
                ("variant", index, "option", other, "text"),
                f"in case {case} options {posed.choices[one].id} and {posed.choices[other].id} are too "
                "close to tell apart.",
                fix="Change a formula, or the values it is computed from.",
            )
        shuffled = sorted(posed.choices, key=lambda choice: draw(seed, question.id, variant.id, choice.id))
        placed = (replace(choice, letter=letter) for choice, letter in zip(shuffled, LETTERS, strict=True))
        return replace(posed, choices=tuple(placed))


def draw(seed: int, *words: str) -> int:
    """A whole number that depends on all of its arguments and nothing else."""
    return int.from_bytes(hashlib.sha256("/".join((str(seed), *words)).encode()).digest()[:8], "big")


def pose_case(document: Document[Question], variant_index: int, case: int) -> PosedQuestion:
    """A variant with the numbers of one of its cases, options in the order of the file.

    Raises:
        ContentError: a formula has no finite value there.
    """
    question = document.value
    variant = question.variant[variant_index]
    shown = _numbers(document, variant_index, case)
    choices = tuple(
        Choice(
            letter=LETTERS[index],
            id=option.id,
            text=_fill(option.text, shown),
            explanation=_fill(option.explanation, shown),
            right=option.right,
            misconception=option.misconception,
            belief=question.misconceptions.get(option.misconception, ""),
        )
        for index, option in enumerate(variant.option)
    )
    return PosedQuestion(
        question=question.id,
        title=question.title,
        variant=variant.id,
        prompt=_fill(variant.prompt, shown),
        choices=choices,
        source=variant.source,
        read=question.lesson,
    )


def _numbers(document: Document[Question], variant_index: int, case: int) -> dict[str, str]:
    """The numbers of one case, as they are shown."""
    values: dict[str, float] = {}
    shown: dict[str, str] = {}
    for index, number in enumerate(document.value.variant[variant_index].number):
        if number.values:
            case, place = divmod(case, len(number.values))
            values[number.name] = number.values[place]
            shown[number.name] = f"{number.values[place]:,}"
            continue
        try:
            values[number.name] = read_formula(number.formula).value(values)
        except FormulaError as error:
            given = ", ".join(f"{name} = {value:g}" for name, value in values.items())
            document.fail(
                ("variant", variant_index, "number", index, "formula"),
                f"`formula` of {number.name} fails for {given}: it {error}.",
                fix="Change the formula, or the values it is computed from.",
            )
        shown[number.name] = significant(values[number.name], number.digits)
    return shown


def significant(value: float, digits: int) -> str:
    """``value`` with so many significant digits and never an exponent; a whole number (int) in full."""
    if isinstance(value, int):
        return f"{value:,}"
    if value == 0:
        return "0"
    # The rounded value decides where the digits begin: 0.09996 with three of them is 0.100.
    rounded = float(f"{value:.{digits - 1}e}")
    decimals = digits - 1 - math.floor(math.log10(abs(rounded)))
    return f"{rounded:,.{max(decimals, 0)}f}"


def _fill(text: str, shown: Mapping[str, str]) -> str:
    """``text`` on one line per paragraph, its placeholders replaced."""
    paragraphs = (" ".join(part.split()) for part in re.split(r"\n\s*\n", text.strip()))
    return re.sub(r"\{([^{}]*)\}", lambda match: shown[match[1]], "\n\n".join(paragraphs))


def clashing(choices: Sequence[Choice]) -> tuple[int, int] | None:
    """The first two choices that cannot be told apart, by their places; None if all can."""
    pairs = ((one, other) for other in range(len(choices)) for one in range(other))
    return next((pair for pair in pairs if same_answer(*(choices[place].text for place in pair))), None)


def same_answer(one: str, other: str) -> bool:
    """True if two options say the same: the same words, and numbers that are equal or nearly so.

    "0.10 m" and "10 cm" are the same; so are 0.0980 and 0.0981, which a reader who rounds once more than the
    author cannot tell apart, and "0.5 s" and "0.5 s, because ...": who means the second may pick the first.
    """
    (words, numbers), (others, theirs) = _read(one), _read(other)
    if words != others:
        short, long = sorted((words, others), key=len)
        if not (_BARE.fullmatch(short) and long.startswith(f"{short} ")):
            return False
    return all(abs(a - b) <= LEAST_GAP * max(abs(a), abs(b)) for a, b in zip(numbers, theirs, strict=False))


def _read(text: str) -> tuple[str, list[float]]:
    """A text's words, with ``#`` for each number, and the numbers, in units without a prefix."""
    numbers: list[float] = []

    def read(match: re.Match[str]) -> str:
        scale, unit = next(
            (to for name, to in _UNITS.items() if re.fullmatch(name, match["unit"] or "", re.IGNORECASE)),
            (1.0, match["unit"] or ""),
        )
        numbers.append((-1 if match["sign"] else 1) * scale * float(match["number"].replace(",", "")))
        return f" # {unit} "

    words = _WORDLESS.split(_QUANTITY.sub(read, text).lower())
    return " ".join(word for word in words if word and word not in _FILLER), numbers


#: The share of the questions that passes. A fraction: 0.7 as a float is a little less than 7/10.
PASS_SHARE = Fraction(7, 10)

#: How many seeds to try for one that changes every question: with four variants each, about one in four does.
_TRIES = 200
#: Times as many tries as all first variants take on average: they are missed once in 20,000 attempts.
_PATIENCE = 10


@dataclass(frozen=True, slots=True)
class MarkedQuestion:
    posed: PosedQuestion
    chosen: Choice

    @property
    def right(self) -> bool:
        return self.chosen.right


@dataclass(frozen=True, slots=True)
class Result:
    """A scored attempt; one point a question."""

    marked: tuple[MarkedQuestion, ...]

    @property
    def score(self) -> int:
        return sum(marked.right for marked in self.marked)

    @property
    def total(self) -> int:
        return len(self.marked)

    @property
    def passed(self) -> bool:
        return self.score >= needed(self.total)


def needed(total: int) -> int:
    """How many of ``total`` questions must be right: the smallest whole number that reaches the share."""
    return -(-total * PASS_SHARE.numerator // PASS_SHARE.denominator)


def mark_sentence(total: int) -> str:
    """The pass mark as it is shown: "You need 4 right answers out of 5 to pass"."""
    return f"You need {counted(needed(total), 'right answer')} out of {total} to pass"


def mark(posed: Sequence[PosedQuestion], answers: Mapping[str, str]) -> Result:
    """Score answers: option ids (or letters) by question id.

    Raises:
        KeyError: a question is not answered, or with an option it has not.
    """
    marked = []
    for question in posed:
        chosen = question.choice(answers[question.question])
        if chosen is None:
            raise KeyError(answers[question.question])
        marked.append(MarkedQuestion(question, chosen))
    return Result(tuple(marked))


def check_seed(seed: int) -> int:
    if not 0 <= seed <= MAX_SEED:
        problem = f"{seed} is not a seed."
        raise UsageError(problem, help=f"Use a whole number from 0 to {MAX_SEED}.", code="invalid_seed")
    return seed


def fresh_seed(
    bank: Bank, seen: Mapping[str, int], draw: Callable[[], int] = lambda: secrets.randbelow(MAX_SEED + 1)
) -> int:
    """A seed that asks a question's first variant the first time, and later on another one than last time.

    The first variants are the questions of the chapter that the course was made from. One seed decides all
    questions, so a seed that suits them all is looked for; the best one found is taken.

    Args:
        seen: by question id, the seed it was last asked with.
        draw: gives a random seed.
    """
    last = {name: bank.variant(name, seed) for name, seed in seen.items() if name in bank.ids}
    first = {document.value.id: document.value.variant[0].id for document in bank.documents}

    def misses(seed: int) -> int:
        """The number of questions for which a seed is unsuitable."""
        variants = ((name, bank.variant(name, seed)) for name in bank.ids)
        return sum(one == last[name] if name in last else one != first[name] for name, one in variants)

    new = [len(document.value.variant) for document in bank.documents if document.value.id not in last]
    best, least = draw(), len(bank.ids) + 1
    for _ in range(_TRIES + _PATIENCE * math.prod(new) * bool(new)):
        if (missed := misses(seed := draw())) < least:
            best, least = seed, missed
        if not least:
            break
    return best
