"""An attempt: the public checks on a student's work, run as in a grading run, timed and recorded."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from course.catalog.models import Exercise
from course.errors import CourseError, NotFoundError, UngradableError
from course.printable import meant, one_line
from course.progress.history import fingerprint
from course.scoring.verdict import CheckResult, Problem, Verdict

if TYPE_CHECKING:
    from course.catalog.load import Catalog
    from course.figures.described import Curve
    from course.scoring.judging.session import GradingSession
    from course.scoring.judging.submission import Submission


@dataclass(frozen=True)
class Attempt:
    """One run of the public checks.

    Attributes:
        only: the one requested check or function; empty for all.
        printed: the module's output while it was loaded.
        curves: by id of a failed check, the student's curve and the right one.
    """

    exercise: Exercise
    source: bytes
    verdict: Verdict
    seconds: float
    only: str = ""
    printed: str = ""
    curves: Mapping[str, Curve] = field(default_factory=dict)

    @property
    def problem(self) -> CourseError | None:
        """The error to report in place of a verdict that has no checks to show; None if it has."""
        if self.verdict.state == "graded":
            return None
        state = self.verdict.state
        error = self.verdict.error or Problem(state, "The file could not be checked.")
        if state == "ungradable":
            return UngradableError(error.message, help=error.help, code=error.code)
        advice = error.help or "This is a fault of the course, not of your work."
        return CourseError(error.message, help=advice, code=error.code)

    def data(self, version: str, *, one_of_many: bool = False) -> dict[str, object]:
        """The data of its event, of kind "check", in the form that ``history_of`` reads.

        Args:
            version: of the course's content.
            one_of_many: every exercise was checked, so the student did not choose this one.
        """
        verdict = self.verdict
        return {
            "state": verdict.state,
            "only": self.only,
            "all": one_of_many,
            "score": verdict.score,
            "max_score": verdict.max_score,
            "passed": verdict.passed,
            "all_pass": verdict.all_pass,
            "seconds": round(self.seconds, 3),
            "fingerprint": fingerprint(self.source),
            "sha256": hashlib.sha256(self.source).hexdigest(),
            "version": version,
            "checks": [_kept(check) for check in verdict.checks],
        }


def open_session(exercise: Exercise, catalog: Catalog) -> GradingSession:
    """A grading session over the public checks of an exercise; a context manager."""
    from course.scoring.judging.session import GradingSession
    from course.scoring.judging.submission import Terms

    return GradingSession(exercise, catalog, scope="public", terms=Terms(home=True))


def attempt(exercise: Exercise, catalog: Catalog, submission: Submission, only: str = "") -> Attempt:
    """Run the public checks once.

    Args:
        only: run this check and those it requires, and no others.

    Raises:
        NotFoundError: there is no check ``only``.
    """
    begin = time.perf_counter()
    with open_session(exercise, catalog) as session:
        made = attempt_in(session, submission, begin, only)
    return replace(made, seconds=time.perf_counter() - begin)


def attempt_in(session: GradingSession, submission: Submission, begin: float, only: str = "") -> Attempt:
    """The same in a session that stays open.

    Args:
        begin: when it began, by ``time.perf_counter``.
    """
    exercise = session.exercise
    known = [check.id for check in session.checks]
    if only and only not in known:
        message = f"{exercise.id} has no public check called {only!r}."
        raise NotFoundError(
            message, help=meant(only, known, f"Known: {', '.join(known)}."), code="check_not_found"
        )
    verdict = session.grade(submission, only=[only] if only else ())
    seconds, source = time.perf_counter() - begin, submission.files[exercise.module]
    return Attempt(exercise, source, verdict, seconds, only, session.printed, dict(session.curves))


def _kept(check: CheckResult) -> dict[str, object]:
    kept = {"id": check.id, "task": check.task, "status": str(check.status)}
    more = {"diagnosis": check.diagnosis, "numbers": numbers_of(check), "raised": raised_by(check)}
    return kept | {key: value for key, value in more.items() if value}


# ---
# The numbers of a failed check as words, which a hint may use: what went in, what came back, what is right.
#
# Public checks only: what a student may not see in a finding is not in a hint either.


#: Longest list and longest text that a sentence can hold.
_ITEMS, _LETTERS = 8, 40
#: The most of an exception that is kept, in characters.
_RAISED = 120
#: Numbers beyond it are not compared: they come from a program that ran away.
_HUGE = 1e150


def numbers_of(check: CheckResult) -> dict[str, str]:
    """The fields that a hint may name.

    Returns:
        each input by its name; ``expected`` and ``got``; where they are numbers, ``off``, which is got minus
        expected, and ``ratio``, got over expected; where one entry of an array was compared, ``at``, which
        names it. None, a ratio of 0 or 1 and values too long for a sentence are left out, and all of them
        where the check passed or is a hidden one.
    """
    if check.status != "fail" or check.visibility != "public":
        return {}
    # The entries of a list may be told apart by a late digit only.
    fields = {k: _words(x, 10 if isinstance(x, list) else 4) for k, x in (check.input or {}).items()}
    expected, got, fields["at"] = _compared(check.expected, check.actual)
    right, own = _apart(expected, got)
    fields["expected"], fields["got"] = "" if expected is None else right, "" if got is None else own
    if _is_number(expected) and _is_number(got):
        fields["off"] = f"{'+' * (got > expected)}{_words(got - expected)}"
        ratio = _words(got / expected) if expected and got else ""
        fields["ratio"] = "" if ratio == "1" else ratio
    return {name: words for name, words in fields.items() if words}


def raised_by(check: CheckResult) -> str:
    """The exception that ended a public check, in its own words; "" if none did."""
    if check.status != "error" or check.visibility != "public" or not isinstance(check.actual, str):
        return ""
    return one_line(check.actual, _RAISED)


def _compared(expected: Any, got: Any) -> tuple[Any, Any, str]:
    """What was expected, what came, and of which entry: that of {"q[2]": 0.5} and {"q[2]": 0.4} is q[2]."""
    if not isinstance(expected, dict) or len(expected) != 1:
        return expected, got, ""
    ((name, value),) = expected.items()
    if name in {"at least", "at most"}:
        return f"{name} {_words(value)}", got, ""
    if isinstance(got, dict) and got.keys() == expected.keys():
        return value, got[name], str(name)
    return expected, got, ""


def _apart(expected: Any, got: Any) -> tuple[str, str]:
    """Both with four digits, or with so many that they differ."""
    pairs = ((_words(expected, digits), _words(got, digits)) for digits in (4, 8, 16))
    return next(((right, own) for right, own in pairs if right != own), ("", ""))


def _words(value: Any, digits: int = 4) -> str:
    """The value for a sentence; "" if it is too long for one."""
    if isinstance(value, bool | None):
        return str(value)
    if isinstance(value, int):
        return str(value) if abs(value) < _HUGE else ""
    if isinstance(value, float):
        return f"{value + 0.0:.{digits}g}"  # no "-0"
    if isinstance(value, list | tuple) and 0 < len(value) <= _ITEMS:
        items = [_words(item, digits) for item in value]
        return f"[{', '.join(items)}]" if all(items) else ""
    return value if isinstance(value, str) and len(value) <= _LETTERS else ""


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _HUGE
