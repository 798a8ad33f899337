"""A verdict as its student may read it; everything that students get is made from this."""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.scoring.verdict import CheckResult, Problem, for_student

if TYPE_CHECKING:
    from course.scoring.verdict import Verdict

__all__ = ["checks_for_student", "problem_for_student"]

#: The message of a broken check may contain its hidden values.
_OUR_FAULT = Problem(
    "grader_error",
    "A fault of the grader, not of yours, kept this from being graded.",
    "It will be graded again. Your instructor knows of it.",
)


def checks_for_student(verdict: Verdict) -> tuple[CheckResult, ...]:
    """The checks, hidden values dropped; none where the grader itself failed."""
    if verdict.state == "grader_error":
        return ()
    return tuple(for_student(check) for check in verdict.checks)


def problem_for_student(verdict: Verdict) -> Problem | None:
    """Why there is no grade; details of a fault in the grader stay with the instructor."""
    return _OUR_FAULT if verdict.state == "grader_error" else verdict.error
