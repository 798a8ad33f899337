"""The quiz records of a submission, scored again.

A record holds the seed, the questions and the answers. Only these are used: the questions are posed again
from the seed and scored here, and the score in the record must agree. An inconsistent record (unknown
questions or options, missing answers, another score) makes that student's quiz ``ungradable:
quiz_record_inconsistent``; the rest of the submission is graded as usual.

Of several attempts the best one counts. Two with the same seed have the same questions, and by the second the
student has read the explanations: only the first of each seed counts.
"""

import hashlib
import json
from dataclasses import dataclass
from typing import Annotated

import msgspec

from course.errors import ContentError, UngradableError
from course.printable import one_line
from course.progress.quiz import MAX_RECORDS
from course.quizzing.bank import MAX_SEED, Bank, MarkedQuestion, Result, mark, needed
from course.scoring.verdict import CheckResult, Problem, Status, Verdict, Visibility, not_graded

#: The quiz's id among the exercises of a gradebook; no exercise may have it.
EXERCISE_ID = "quiz"
#: Increased when the scoring of records changes; part of the grader's version.
GRADER_REVISION = 1

CODE = "quiz_record_inconsistent"

_Slug = Annotated[str, msgspec.Meta(pattern=r"^[a-z][a-z0-9-]{0,59}$")]


class _Record(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One attempt as ``course submit`` writes it."""

    seed: Annotated[int, msgspec.Meta(ge=0, le=MAX_SEED)]
    version: Annotated[str, msgspec.Meta(max_length=60)]
    finished_at: Annotated[str, msgspec.Meta(max_length=60)]
    questions: Annotated[tuple[_Slug, ...], msgspec.Meta(max_length=100)]
    answers: Annotated[dict[_Slug, _Slug], msgspec.Meta(max_length=100)]
    score: Annotated[int, msgspec.Meta(ge=0, le=100)]


_Records = Annotated[tuple[_Record, ...], msgspec.Meta(max_length=MAX_RECORDS)]


@dataclass(frozen=True, slots=True)
class QuizScore:
    """The attempt that counts.

    Attributes:
        attempts: how many were handed in.
        repeated: how many of them did not count because an earlier one had the same seed.
    """

    result: Result
    seed: int
    attempts: int
    repeated: int


def score_record(bank: Bank, record: object) -> QuizScore | None:
    """Score the attempts of one student again; None if there are none.

    Args:
        bank: the questions of the course that grades.
        record: the value of "quiz" in ``submission.json``, unchecked; it may be anything.

    Raises:
        UngradableError: ``quiz_record_inconsistent``; the message says which attempt and what is wrong.
    """
    if isinstance(record, str):  # the reason why there is none
        why = one_line(record, 400)
        advice = (
            "Leave one zip of `course submit` in the student's folder, unchanged, and grade with --resume."
        )
        raise UngradableError(f"The quiz cannot be scored. {why}.", help=advice, code=CODE)
    if (fault := _fault(record)) is not None:
        raise _inconsistent(f"The quiz record is malformed ({fault}).")
    attempts: tuple[_Record, ...] = msgspec.convert(record, _Records)
    if not attempts:
        return None
    results: dict[int, Result] = {}
    for number, attempt in enumerate(attempts, start=1):
        results.setdefault(attempt.seed, _score(bank, attempt, f"Attempt {number} of the quiz"))
    seed = max(results, key=lambda seed: results[seed].score)
    return QuizScore(results[seed], seed, len(attempts), len(attempts) - len(results))


def grade_quiz(bank: Bank, record: object) -> Verdict | None:
    """The verdict on a student's quiz, in the form every export knows; None if no attempt was handed in.

    One public check and one point a question; a wrong answer's diagnosis is its misconception. No student
    code runs, so ``isolation`` is empty.
    """
    total = float(len(bank.ids))
    try:
        score = score_record(bank, record)
    except UngradableError as error:
        return not_graded(EXERCISE_ID, total, "ungradable", Problem(error.code, error.message, error.help))
    except ContentError as error:
        # A fault in the question files is ours; it never costs a student points.
        return not_graded(EXERCISE_ID, total, "grader_error", Problem(error.code, error.message, error.help))
    if score is None:
        return None
    repeated = f", {score.repeated} of them with questions already seen" if score.repeated else ""
    said = f"Best of {score.attempts} attempts{repeated}." if score.attempts > 1 else ""
    return Verdict(
        exercise=EXERCISE_ID,
        scope="full",
        state="graded",
        score=float(score.result.score),
        max_score=total,
        passed=score.result.score >= needed(len(bank.ids)),
        checks=tuple(_check(marked, score.seed) for marked in score.result.marked),
        isolation="",
        warnings=(said,) if said else (),
    )


def checked_record(record: object) -> object:
    """A record if it has the right form, None if it is empty, else words that say what is wrong.

    Anything else that JSON can hold (a list a thousand deep, half a surrogate) stops here.
    """
    return (_fault(record) or record) if record else None


def record_sha256(record: object) -> str:
    """Digest of a record: the key of its result in a gradebook."""
    try:
        text = json.dumps(record, sort_keys=True, separators=(",", ":"))
    except (TypeError, ValueError, RecursionError):
        text = "unreadable"
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def quiz_version(bank: Bank) -> str:
    """The grader's version for the quiz: changes with any question file or with the way of scoring."""
    return hashlib.sha256(f"{GRADER_REVISION}/{bank.digest}".encode()).hexdigest()


def _fault(record: object) -> str | None:
    try:
        msgspec.convert(record, _Records)
    except (msgspec.ValidationError, UnicodeError, RecursionError, OverflowError) as error:
        # msgspec's message names our own places and types; anything quoted from the record is escaped.
        return ascii(str(error))[1:-1][:200]
    return None


def _score(bank: Bank, attempt: _Record, which: str) -> Result:
    def wrong(said: str) -> UngradableError:
        return _inconsistent(f"{which} {said}.", attempt.version)

    if sorted(attempt.questions) != sorted(bank.ids):
        strange = sorted(set(attempt.questions) ^ set(bank.ids))
        named = f": {', '.join(strange[:5])}" if strange else ""
        raise wrong(f"is not about the questions of this quiz{named}")
    missing = sorted(set(bank.ids) - set(attempt.answers))
    if missing:
        raise wrong(f"has no answer to {missing[0]}")
    if len(attempt.answers) > len(bank.ids):
        strange = sorted(set(attempt.answers) - set(bank.ids))
        raise wrong(f"answers {strange[0]}, which was not asked")
    posed = bank.pose(attempt.seed)
    for question in posed:
        given = attempt.answers[question.question]
        if given not in {choice.id for choice in question.choices}:
            said = f"answers {question.question} with {given!r}, which seed {attempt.seed} does not offer"
            raise wrong(said)
    result = mark(posed, attempt.answers)
    if result.score != attempt.score:
        raise wrong(f"claims {attempt.score} of {result.total}, and its answers score {result.score}")
    return result


def _inconsistent(message: str, version: str = "") -> UngradableError:
    made = f" The attempt says it was made with version {version!a} of the course." if version else ""
    advice = (
        "Ask the student to run `course submit` again and upload the zip unchanged; where the quiz "
        f"changed in between, grade with the version it was taken with.{made}"
    )
    return UngradableError(message, help=advice, code=CODE)


def _check(marked: MarkedQuestion, seed: int) -> CheckResult:
    posed, chosen = marked.posed, marked.chosen
    return CheckResult(
        id=posed.question,
        title=posed.title,
        task=EXERCISE_ID,
        status=Status.PASS if marked.right else Status.FAIL,
        visibility=Visibility.PUBLIC,
        points=float(marked.right),
        max_points=1.0,
        input={"seed": seed, "variant": posed.variant},
        expected=posed.key.id,
        actual=chosen.id,
        diagnosis=None if marked.right else chosen.misconception.replace("-", "_").upper(),
        message="" if marked.right else f"Chosen: {chosen.text}",
        help="" if marked.right else chosen.explanation,
    )
