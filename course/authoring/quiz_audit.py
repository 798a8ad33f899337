"""The audit of the quiz: every question, every variant, every case its numbers can take."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from course.authoring.exercises.files import blanks_in
from course.authoring.lessons.links import LinkChecker
from course.catalog.questions import read_questions
from course.errors import ContentError
from course.quizzing.proof import faults_in

if TYPE_CHECKING:
    from course.authoring.report import Findings
    from course.catalog.load import Catalog
    from course.catalog.questions import Question
    from course.catalog.reading import Document

__all__ = ["LEAST_VARIANTS", "audit_quiz"]

#: With fewer, a retake is likely to repeat a question that was just explained.
LEAST_VARIANTS = 4

#: The id under which a gradebook keeps the quiz.
_TAKEN = "quiz"

_YEAR = re.compile(r"\b(?:19|20)\d\d\b")


def audit_quiz(catalog: Catalog, findings: Findings, only: str | None = None) -> tuple[str, ...]:
    """Check the questions; returns their ids.

    Args:
        only: id of one question; None for all.
    """
    folder = catalog.content.quiz
    blank = [path for path in sorted(folder.glob("*.toml")) if blanks_in(path, findings)]
    if (catalog.content.exercises / _TAKEN).is_dir():
        findings.add(
            catalog.content.exercises / _TAKEN,
            None,
            "quiz",
            "an exercise is called quiz, and that is what gradebooks call the quiz.",
            "Rename the exercise.",
        )
    if blank:
        return tuple(path.stem for path in blank)
    try:
        documents = read_questions(folder)
    except ContentError as error:
        findings.add_error(error)
        return (error.file.stem,)
    chosen = [document for document in documents if only in (None, document.value.id)]
    for document in chosen:
        _audit_question(catalog, document, findings)
    return tuple(document.value.id for document in chosen)


def _audit_question(catalog: Catalog, document: Document[Question], findings: Findings) -> None:
    question = document.value

    def wrong(where: tuple[str | int, ...], message: str, fix: str) -> None:
        findings.add(document.path, document.lines.line(where), "quiz", message, fix)

    if len(question.variant) < LEAST_VARIANTS:
        wrong(
            (),
            f"question {question.id} has {len(question.variant)} variants, and needs {LEAST_VARIANTS}.",
            "Add variants: new numbers or a new situation for the same idea.",
        )
    if question.lesson:
        LinkChecker(catalog, findings).check_question(document)
    used = {option.misconception for variant in question.variant for option in variant.option}
    for name in question.misconceptions:
        if name not in used:
            wrong(
                ("misconceptions", name),
                f"no option is tied to the misconception {name}.",
                "Tie a wrong option to it, or remove it.",
            )
    for index, variant in enumerate(question.variant):
        if not _YEAR.search(variant.source) and not any(number.formula for number in variant.number):
            wrong(
                ("variant", index, "source"),
                f"the source of variant {variant.id} has no date.",
                "Name who says so and in which year.",
            )
    for fault in faults_in(document):
        findings.add(document.path, fault.line, "quiz", fault.message, fault.fix)
