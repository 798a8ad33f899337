"""The quiz's questions: one TOML file each under ``quiz/``, read into frozen types.

A question has several variants. A variant has four options and may have numbers: those with ``values`` are
drawn from a list, those with ``formula`` are computed from them, and texts name both as ``{name}``. The lists
are finite, so every case a student can ever meet can be gone through beforehand (``course.quizzing.desk``).
``docs/quiz-format.md`` describes the files for authors.
"""

import ast
import itertools
import math
import operator
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeAlias

import msgspec

from course.catalog.reading import Document, Keys, read_document, refuse_blanks
from course.ids import SLUG, QuestionId
from course.printable import counted

# ---
# Arithmetic that a content file may contain: numbers, names, + - * / ** and a few functions.
#
# A formula is parsed and walked once; nothing of it is ever executed as Python.
#
#     >>> Formula("9.81 * h * t / 2").value({"h": 0.01, "t": 2})
#     0.0981


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

#: The value of a formula, or of a part of it, from those of its names.
_Computed: TypeAlias = "Callable[[Mapping[str, float]], float]"


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
            body = ast.parse(text.strip(), mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise FormulaError("it is not arithmetic") from None
        self._computed, self.names = _compiled(body)

    def value(self, given: Mapping[str, float]) -> float:
        """The value; an int where only whole numbers and ``round`` or ``ceil`` were involved.

        Raises:
            FormulaError: there is no finite real value.
        """
        try:
            result = self._computed(given)
            if math.isfinite(result):
                return result
        except ZeroDivisionError:
            raise FormulaError("it divides by zero") from None
        except (ValueError, OverflowError):
            pass
        raise FormulaError("it has no finite value")


def _compiled(node: ast.expr) -> tuple[_Computed, frozenset[str]]:
    """What a part of a formula computes, and the names in it; a part that is not allowed is refused."""
    match node:
        case ast.Constant(value=bool()):
            pass
        case ast.Constant(value=int() | float() as number):
            return lambda _: number, frozenset()
        case ast.Name(id=name):
            return lambda given: given[name], frozenset({name})
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return _compiled(operand)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            value, names = _compiled(operand)
            return lambda given: -value(given), names
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
            operate, (one, ones), (other, others) = _BINARY[type(op)], _compiled(left), _compiled(right)
            return lambda given: operate(one(given), other(given)), ones | others
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in FUNCTIONS:
            function, (value, names) = FUNCTIONS[name], _compiled(argument)
            return lambda given: function(value(given)), names
    raise FormulaError(
        f"{ast.unparse(node)[:60]!r} is not one of: numbers, names, + - * / **, {', '.join(FUNCTIONS)}"
    )


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
    documents = sorted(
        (_read(path) for path in folder.glob("*.toml")), key=lambda d: (d.value.order, d.value.id)
    )
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
        formula = Formula(text)
    except FormulaError as error:
        document.fail(where, f"`formula` cannot be read: {error}.", fix="Write for example: 2 * sqrt(m / k)")
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
            used |= Formula(number.formula).names
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
