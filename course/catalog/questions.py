"""The quiz's questions: one TOML file each under ``quiz/``, read into frozen types.

A question has several variants. A variant has four options and may have numbers: those with ``values`` are
drawn from a list, those with ``formula`` are computed from them, and texts name both as ``{name}``. The lists
are finite, so every case a student can ever meet can be gone through beforehand (``course.quizzing.desk``).
``docs/quiz-format.md`` describes the files for authors.
"""

import itertools
import math
import re
from pathlib import Path
from typing import Any

import msgspec

from course.catalog.reading import Document, Keys, read_document, refuse_blanks
from course.formulas import FormulaError, read_formula
from course.ids import SLUG, QuestionId
from course.printable import counted

#: Options of every question. Five questions of four options are passed by guessing in 1.6 % of attempts.
OPTIONS = 4
#: Cases of one variant; more would only make proving it slow.
MAX_CASES = 500
_DIGITS = range(1, 7)

_PLACEHOLDER = re.compile(r"\{([^{}]*)\}")


class Number(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A number of a variant: drawn from ``values`` or computed by ``formula`` from the numbers above it.

    Attributes:
        digits: significant digits a computed number is shown with.
    """

    name: str
    values: tuple[int | float, ...] = ()
    formula: str = ""
    digits: int = 3


class Option(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One answer to choose from.

    Attributes:
        misconception: of a wrong one, what a student who picks it believes: a key of the question's table.
        explanation: why it is right or wrong; shown after the attempt.
    """

    id: str
    text: str
    explanation: str
    right: bool = False
    misconception: str = ""


class Variant(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One way of asking a question.

    Attributes:
        source: where its facts come from, with a year; or what its numbers are computed from.
    """

    id: str
    prompt: str
    source: str
    option: tuple[Option, ...]
    number: tuple[Number, ...] = ()

    @property
    def cases(self) -> int:
        """In how many ways its numbers can be drawn."""
        return math.prod(len(number.values) for number in self.number if number.values)


class Question(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A file of the quiz.

    Attributes:
        order: position in the quiz, 1 first.
        misconceptions: common wrong beliefs, in students' words, by name.
        lesson: the place to read again, "lesson#section" or a lesson; may be empty.
    """

    format_version: int
    id: str
    order: int
    title: str
    misconceptions: dict[str, str]
    variant: tuple[Variant, ...]
    lesson: str = ""


def read_questions(folder: Path) -> tuple[Document[Question], ...]:
    """The questions of a quiz in their order, with the lines they stand on; none where there is no folder."""
    if not folder.is_dir():
        return ()
    documents = sorted(map(_read, folder.glob("*.toml")), key=lambda d: (d.value.order, d.value.id))
    for one, other in itertools.pairwise(documents):
        if one.value.order == other.value.order:
            problem = f"question {one.value.id} has the order {one.value.order} too."
            other.fail(("order",), problem, fix="Give each question a place of its own.")
    return tuple(documents)


def _read(path: Path) -> Document[Question]:
    refuse_blanks(path)
    document = read_document(path, Question)
    question = document.value
    document.check_own_id(question.id, QuestionId)
    document.check_words(("title",), question.title)
    if question.order < 1:
        document.fail(("order",), "`order` must be 1 or more.", fix="Number the questions from 1.")
    for name, belief in question.misconceptions.items():
        _check_slug(document, ("misconceptions", name), name, "misconception")
        document.check_words(("misconceptions", name), belief)
    if not question.variant:
        document.fail((), "there is no variant.", fix="Add a [[variant]] with four [[variant.option]].")
    _check_distinct(document, ("variant",), [variant.id for variant in question.variant], "variant")
    for index, variant in enumerate(question.variant):
        _check_variant(document, ("variant", index), variant)
    return document


def _check_variant(document: Document[Question], where: Keys, variant: Variant) -> None:
    _check_slug(document, (*where, "id"), variant.id, "variant")
    document.check_words((*where, "prompt"), variant.prompt)
    document.check_words((*where, "source"), variant.source)
    if len(variant.option) != OPTIONS:
        fix = f"Give it {OPTIONS}: one that is right and {OPTIONS - 1} that are not."
        document.fail(where, f"variant {variant.id} has {counted(len(variant.option), 'option')}.", fix=fix)
    right = [index for index, option in enumerate(variant.option) if option.right]
    if len(right) != 1:
        problem = f"variant {variant.id} has {len(right)} right options."
        fix = "Mark exactly one with `right = true`."
        document.fail((*where, "option", right[1]) if right else where, problem, fix=fix)
    _check_distinct(document, (*where, "option"), [option.id for option in variant.option], "option")
    for index, option in enumerate(variant.option):
        _check_option(document, (*where, "option", index), option)
    _check_numbers(document, where, variant)
    _check_placeholders(document, where, variant)


def _check_option(document: Document[Question], where: Keys, option: Option) -> None:
    _check_slug(document, (*where, "id"), option.id, "option")
    if len(option.id) == 1:
        problem = f"`id` is the letter {option.id}."
        document.fail((*where, "id"), problem, fix="Use a word: letters name places on screen.")
    document.check_words((*where, "text"), option.text)
    document.check_words((*where, "explanation"), option.explanation)
    known = document.value.misconceptions
    if option.right and option.misconception:
        problem = "the right option names a misconception."
        document.fail((*where, "misconception"), problem, fix="Remove the line.")
    if not option.right and option.misconception not in known:
        said = f"{option.misconception!r} is not among them" if option.misconception else "it names none"
        problem = f"a wrong option names one of the [misconceptions], and {said}."
        fix = f"Known: {', '.join(known) or 'none; write the table first'}."
        document.fail((*where, "misconception") if option.misconception else where, problem, fix=fix)


def _check_numbers(document: Document[Question], where: Keys, variant: Variant) -> None:
    known: set[str] = set()
    for index, number in enumerate(variant.number):
        at = (*where, "number", index)
        if not number.name.isidentifier() or number.name in known:
            problem = f"{number.name!r} is not a new, valid name."
            document.fail((*at, "name"), problem, fix="Use letters, each name once: t_end")
        if bool(number.values) == bool(number.formula):
            problem = f"number {number.name} needs either `values` or `formula`."
            document.fail(at, problem, fix="Keep one of the two.")
        if len(set(number.values)) != len(number.values) or not all(map(math.isfinite, number.values)):
            problem = "`values` repeats one or holds nan or inf."
            document.fail((*at, "values"), problem, fix="List finite numbers, each once.")
        if number.digits not in _DIGITS:
            document.fail((*at, "digits"), "`digits` must lie between 1 and 6.", fix="Write: digits = 3")
        if number.formula:
            _check_formula(document, (*at, "formula"), number.formula, known)
        known.add(number.name)
    if variant.cases > MAX_CASES:
        problem = f"variant {variant.id} has {variant.cases} cases."
        document.fail(where, problem, fix=f"List fewer values: {MAX_CASES} at most.")


def _check_formula(document: Document[Question], where: Keys, text: str, known: set[str]) -> None:
    try:
        formula = read_formula(text)
    except FormulaError as error:
        document.fail(where, f"`formula` {error}.", fix="Write for example: 2 * sqrt(m / k)")
    unknown = sorted(formula.names - known)
    if unknown:
        problem = f"`formula` uses {unknown[0]}, which is not given above it."
        document.fail(where, problem, fix=f"Given above: {', '.join(sorted(known)) or 'nothing'}.")


def _check_placeholders(document: Document[Question], where: Keys, variant: Variant) -> None:
    known = {number.name for number in variant.number}
    texts: list[tuple[Keys, str]] = [((*where, "prompt"), variant.prompt)]
    for index, option in enumerate(variant.option):
        texts += [((*where, "option", index, key), getattr(option, key)) for key in ("text", "explanation")]
    used: set[str] = set()
    for at, text in texts:
        names = _PLACEHOLDER.findall(text)
        if (stray := next((name for name in names if name not in known), None)) is not None:
            problem = f"{{{stray}}} names no number."
            document.fail(at, problem, fix=f"Numbers here: {', '.join(sorted(known)) or 'none'}.")
        if re.search(r"[{}]", _PLACEHOLDER.sub("", text)):
            document.fail(at, "a brace stands alone.", fix="Braces hold the name of a number: {h}.")
        used.update(names)
    for number in variant.number:
        if number.formula:
            used |= read_formula(number.formula).names
    for index, number in enumerate(variant.number):
        if number.name not in used:
            fix = "Use it in a text or a formula, or remove it."
            document.fail((*where, "number", index), f"number {number.name} is used nowhere.", fix=fix)


def _check_slug(document: Document[Any], where: Keys, name: str, kind: str) -> None:
    if not SLUG.fullmatch(name):
        problem = f"{name!r} is not a valid name of a {kind}."
        document.fail(where, problem, fix="Use lower-case words joined by hyphens: looks-are-everything")


def _check_distinct(document: Document[Any], where: Keys, names: list[str], kind: str) -> None:
    for index, name in enumerate(names):
        if name in names[:index]:
            document.fail((*where, index), f"{kind} {name} is there twice.", fix="Rename one of the two.")
