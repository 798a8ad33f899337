"""The quiz as a notebook: questions, cells to answer in, and an explanation of every option."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from html import escape

from course.catalog.load import Catalog
from course.notebooks.cells import Cell, code, document, escaped, markdown, opening
from course.quizzing.bank import (
    LETTERS,
    Bank,
    MarkedQuestion,
    PosedQuestion,
    Result,
    mark,
    mark_sentence,
    needed,
)

#: A notebook's questions stay the same; ``course quiz take`` draws new ones each time.
SEED = 1

_HEAD = """\
# Quiz

{mark}. In a workspace the next cell is an attempt that counts, as `course quiz take` in a terminal is one;
an attempt begun there continues here."""
_PRACTICE = """\
## Practice

The same questions in one of their variants, without a record. Write the letter of your answer between the
quotation marks, run every cell, and run the last one to see which were right and why."""


def quiz_notebook(catalog: Catalog) -> bytes:
    """The notebook file of the quiz.

    Raises:
        NotFoundError: the course has no quiz.
        ContentError: a question is wrong.
    """
    posed = Bank.of(catalog).pose(SEED)
    cells = [
        opening(_HEAD.format(mark=mark_sentence(len(posed)))),
        code("from course.notebooks.predicting import take\n\ntake()", role="quiz-take"),
        markdown(_PRACTICE),
        code("answers = {}", role="quiz-setup"),
    ]
    for number, question in enumerate(posed, 1):
        cells += _question(number, len(posed), question)
    cells.append(markdown("## Marks"))
    marks = f"from course.notebooks.quiz import marked\n\nmarked({SEED}, answers)"
    cells.append(code(marks, role="quiz-marks"))
    return document(cells, kind="quiz", id="quiz", version=catalog.version, seed=SEED)


def _question(number: int, total: int, posed: PosedQuestion) -> list[Cell]:
    choices = "\n".join(f"- **{choice.letter}.** {escaped(choice.text)}" for choice in posed.choices)
    text = f"## Question {number} of {total}: {escaped(posed.title)}\n\n{escaped(posed.prompt)}\n\n{choices}"
    answer = f'answers["{posed.question}"] = ""'
    return [markdown(text), code(answer, role="quiz-answer", task=posed.question)]


def marked(seed: int, answers: Mapping[str, str]) -> Marks | None:
    """The score of a notebook's answers, for Jupyter to show; None, with a sentence, until all are given.

    Args:
        answers: letters by question id.
    """
    posed = Bank.of(Catalog()).pose(seed)
    for number, question in enumerate(posed, 1):
        given = str(answers.get(question.question, "")).strip()
        if question.choice(given) is None:
            problem = f"is answered {given[:20]!r}" if given else "is not answered yet"
            letters = f"{LETTERS[0]} to {LETTERS[len(question.choices) - 1]}"
            advice = f"Write a letter from {letters} into its cell, and run both cells."
            print(f"Question {number} {problem}. {advice}")  # noqa: T201 - a cell's output is its screen
            return None
    return Marks(mark(posed, {key: str(value).strip() for key, value in answers.items()}))


@dataclass(frozen=True)
class Marks:
    """A scored attempt as Jupyter shows it: each missed question, with every option explained."""

    result: Result

    @property
    def summary(self) -> str:
        verdict = "passed" if self.result.passed else "not passed"
        total = self.result.total
        return f"{self.result.score} of {total} right, {needed(total)} needed: {verdict}."

    def __repr__(self) -> str:
        lines = [self.summary]
        for number, one in enumerate(self.result.marked, 1):
            lines.append(f"{number}. {one.posed.title}: {'right' if one.right else 'missed'}")
            lines += [f"   {label}: {text} {why}" for label, text, why in _told(one)]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        parts = [f"<p><b>{escape(self.summary)}</b></p>"]
        for number, one in enumerate(self.result.marked, 1):
            outcome = "✓ right" if one.right else "✗ missed"
            told = "".join(
                f"<li><b>{escape(label)}:</b> {escape(text)}<br><small>{escape(why)}</small></li>"
                for label, text, why in _told(one)
            )
            parts.append(f"<p>{number}. <b>{escape(one.posed.title)}</b>: {outcome}</p><ul>{told}</ul>")
        return "".join(parts)


def _told(one: MarkedQuestion) -> list[tuple[str, str, str]]:
    """(what it is, the option, why) of each option worth showing."""
    key = one.posed.key
    told = [] if one.right else [("Your answer", one.chosen.text, one.chosen.explanation)]
    told.append(("Right", key.text, key.explanation))
    if not one.right:
        rest = [each for each in one.posed.choices if each.letter not in (key.letter, one.chosen.letter)]
        told += [(f"Not {each.letter}", each.text, each.explanation) for each in rest]
    return told
