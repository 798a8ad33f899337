"""Results of checks and problems of submissions, as the words and fields of a verdict."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterable, Sequence
from typing import Any

import msgspec

from course.catalog.models import Exercise
from course.isolation.failures import StudentFailure
from course.isolation.inside import statements
from course.isolation.session import LOOP, LoadFault, LoadRefusedError
from course.printable import ended
from course.scoring.checks.collected import Check
from course.scoring.elsewhere import absent, lacking, unread
from course.scoring.explain.likeness import likeness, names_of, return_in_a_loop, why_none
from course.scoring.explain.story import NOT_FINITE, said_once
from course.scoring.judging.submission import Submission
from course.scoring.remote import RemoteSubmission
from course.scoring.values import kind_of, plain
from course.scoring.verdict import (
    ENTRIES,
    EVALUATIONS,
    CheckResult,
    Finding,
    Places,
    Problem,
    Status,
    Visibility,
)

#: Diagnosis of a check that broke on a student's value and not on the model solution's.
NOT_JUDGED = "NOT_JUDGED"
_MOST_NOTES = 5


def result(check: Check, status: Status, **fields: Any) -> CheckResult:
    return CheckResult(
        id=check.id,
        title=check.title,
        task=check.task,
        status=status,
        visibility=check.visibility,
        points=fields.pop("points", 0.0),
        max_points=check.points,
        **fields,
    )


def found(check: Check, status: Status, finding: Finding, duration_ms: float, **extra: Any) -> CheckResult:
    """A result with all that its finding says; both have the same names for it."""
    told = msgspec.structs.asdict(finding)
    told["input"] = plain(finding.input, 4)  # a dict of arrays, such as one of matrices
    told |= {"expected": plain(finding.expected), "actual": plain(finding.actual)}
    return result(check, status, duration_ms=duration_ms, **told, **extra)


def skipped(check: Check, blocking: str) -> CheckResult:
    message, advice = "Not run: it builds on a check that did not pass.", "Repair that one first."
    return result(check, Status.SKIP, blocked_by=blocking, message=message, help=advice)


def told_more(
    judged: CheckResult,
    source: bytes,
    places: Places,
    args: tuple[Any, ...] | None = None,
    fact: str | None = None,
) -> CheckResult:
    """The result of a failed check with what its student's code, or the numbers below it, show beyond doubt.

    Only where no mistake is named. Numbers are compared where they are shown, so of public checks alone.

    Args:
        args: of the call that raised.
        fact: what several numbers of the check have in common, in the place of what one shows.
    """
    public = judged.visibility is Visibility.PUBLIC
    if args and judged.input is None and public:
        named = dict(zip(names_of(source, judged.task), args, strict=False))
        judged = msgspec.structs.replace(judged, input=plain(named, 4) or None)
    if judged.diagnosis == "RETURNS_NOTHING":
        name = judged.message.partition("` is ")[0].removeprefix("`")
        if advice := why_none(source, judged.task, places, name):
            return msgspec.structs.replace(judged, help=advice)
    unnamed = judged.diagnosis is None
    if unnamed and (found := return_in_a_loop(source, judged.task, places)):
        message, advice = said_once(judged.message, found.looks_like), found.advice
        return msgspec.structs.replace(judged, diagnosis=found.code, message=message, help=advice)
    if judged.status is Status.FAIL and public and (unnamed or judged.diagnosis in NOT_FINITE):
        counted = judged.quantity.startswith((ENTRIES, EVALUATIONS))
        if fact is None:
            fact = "" if counted else likeness(judged.actual, judged.expected, judged.input)
        return msgspec.structs.replace(judged, message=f"{judged.message} {fact}".strip())
    return judged


def unjudged(returned: tuple[str, Any] | None, *, proven: bool) -> Finding:
    """The finding where the check's own code raised an exception on the submission's value.

    Args:
        returned: name and value of the function that returned last; None if none did.
        proven: the same check passes the model solution, so it is the value that is out of the ordinary.
    """
    what = f"what `{returned[0]}` returned: {kind_of(returned[1])}" if returned else "this submission"
    message = f"This check could not judge {what}."
    advice = (
        "The README says what to return, and what each part is. Call the function yourself and "
        "print the result: is every number finite, and of an ordinary size?"
    )
    if not proven:
        message += " There is no model solution here to tell whether the value or the check is wrong."
        advice += " If all is as the README says, report the check to your instructor."
    return Finding(message, advice, NOT_JUDGED)


def load_problem(refused: LoadRefusedError, places: Places, exercise: str) -> Problem:
    failure = refused.failure
    module = places.module
    where = places.heading(failure.line) if failure.line else module
    if refused.stage == "syntax":
        return Problem("syntax_error", *_unreadable(refused, where, exercise))
    if refused.stage == "timeout":
        loop = " The loop that begins on that line was still running." if failure.type == LOOP else ""
        advice = "Move work out of the top level of the file, into functions."
        return Problem("import_timeout", f"{where}: it did not finish loading in time.{loop}", advice)
    if refused.stage == "import" and failure.type == "ImportNotDeclaredError":
        advice = "Take it out. Plots and experiments belong in a file of your own that imports this one."
        advice = absent(failure, refused.code) or advice
        return Problem("import_error", f"{where}: {failure.message}.", advice)
    if refused.stage == "import":
        said = f": {failure.message.rstrip(' .')}" if failure.message else ""
        advice = lacking(failure, refused.code)
        advice = advice or "Make that line work when the file is loaded, or take it out."
        return Problem("import_error", ended(f"{where}: loading it raises {failure.type}{said}"), advice)
    message = f"{module} ends its process while it is loaded ({failure.message})."
    advice = "Remove what exits, kills or exhausts the process at the top level."
    return Problem("import_crash", message, advice)


def left_out_notes(remote: RemoteSubmission, places: Places, tasks: Collection[str]) -> list[str]:
    """What of a file was left out so that the rest could be checked, a sentence each.

    Args:
        tasks: the exercise's functions: of one that is no Python its checks tell.
    """
    notes = []
    missing = frozenset(tasks) - frozenset(remote.functions)
    if remote.without is not None:
        problem = load_problem(remote.without, places, "")
        notes.append(f"{problem.message} Only what your functions need was loaded.")
    faults = [one for one in remote.faults if one.stage != "syntax" or missing.isdisjoint(one.names)]
    told = [note for fault in faults if (note := _left_out(fault, remote.faults, places))]
    notes += dict.fromkeys(told[:_MOST_NOTES])
    if len(told) > _MOST_NOTES:
        notes.append("More of the file was left out.")
    return notes


def _left_out(fault: LoadFault, faults: Sequence[LoadFault], places: Places) -> str:
    where = places.heading(fault.failure.line) if fault.failure.line else places.module
    if fault.stage == "magic":
        return f"{where}: left out, since it is not Python: {fault.code.strip()}"
    if fault.failure.type == "ImportNotDeclaredError":
        advice = absent(fault.failure, fault.code)
        # A plot costs nothing, so a package that something stands for is worth a word only where it is used.
        worth = advice or fault.stage == "import"
        return f"{where}: {fault.failure.message}.{_after(advice)}" if worth else ""
    return f"{where}: left out{_reason(fault, faults, places)}"


def _reason(fault: LoadFault, faults: Sequence[LoadFault], places: Places) -> str:
    failure = fault.failure
    brief = failure.message.partition("\\n")[0].rstrip(" .:")  # of several lines the first
    said = f": {brief}" if failure.message else ""
    if fault.stage == "syntax" and fault.code.startswith(statements.MERGE):
        return ". It is the mark of a merge: keep one of the two versions, and delete the marks."
    if fault.stage == "syntax":
        return ended(f", since Python cannot read it{said}") + _after(unread(failure, fault.code))
    if (line := _line_needed(failure, faults)) is not None:
        return f", since it needs what was left out {places.phrase(line)}."
    lacks = lacking(failure, fault.code)
    return f". {lacks}" if lacks else ended(f", since it raises {failure.type} when it is loaded{said}")


def _line_needed(failure: StudentFailure, faults: Sequence[LoadFault]) -> int | None:
    """The line that would have defined the name that is missing."""
    name = failure.message.partition("'")[2].partition("'")[0] if failure.type == "NameError" else ""
    found = (fault.failure for fault in faults if name in fault.names and fault.failure is not failure)
    return next((one.line for one in found if name and one.line), None)


def _after(sentence: str) -> str:
    return f" {sentence}" if sentence else ""


def _unreadable(refused: LoadRefusedError, where: str, exercise: str) -> tuple[str, str]:
    """The finding for a file that is not valid Python."""
    failure = refused.failure
    # A MemoryError, which is what deep nesting ends in, says nothing, or that the parser has no room left.
    reason = failure.message
    if not reason or failure.type == "MemoryError":
        reason = "it is nested more deeply than Python can read"
    encoded = "UnicodeError" in failure.bases or "missing encoding" in reason or "codec can't" in reason
    if encoded or not failure.line:
        said = "it is saved in another encoding than UTF-8, or it is no text" if encoded else reason
        message = f"{where}{': this' if failure.line else ''} is not Python source: {said}."
        stub = f"`course reset {exercise}` puts the stub back, and keeps a copy."
        if not encoded and "encoding" not in reason:
            return message, f"Was something else saved under its name? {stub}"
        # Python says the same of a letter in another encoding, which is likelier, and of what is no text.
        letters = "Save it as UTF-8, or declare its encoding in the first line."
        return message, f"{letters} If it is no text at all: {stub}"
    shown = f": `{refused.text.strip()}`" if refused.text.strip() else ""
    message = ended(f"{where}: Python cannot read this file: {failure.message}{shown}")
    if "triple-quoted" in failure.message:
        # The line is where the last quotes stand, not where they are missing.
        return message, "Three quotes are missing there or further up. Look at what you changed last."
    return message, unread(failure, refused.code) or "Look at that line and the one above it."


def no_functions(exercise: Exercise) -> Problem:
    message = f"{exercise.module} defines none of the functions of this exercise."
    names = ", ".join(task.id for task in exercise.task)
    return Problem("no_declared_functions", message, f"Keep the names the stub gave: {names}.")


# -- functions as they were handed out -----------------------------------------------------------------------


def untouched(exercise: Exercise, submission: Submission) -> frozenset[str]:
    """The tasks whose functions, and what these use of their file, are still the stub's.

    A stub's function may run and return something: a measurement of nothing, a program to mend.
    """
    try:
        stub = _definitions(exercise.stub_path.read_bytes())
        mine = _definitions(submission.files[exercise.module])
    except (OSError, KeyError, SyntaxError, ValueError, RecursionError):
        return frozenset()
    changed = {name for name in {*stub, *mine} if stub.get(name) != mine.get(name)}
    while more := {name for name, (_, uses) in mine.items() if name not in changed and uses & changed}:
        changed |= more
    return frozenset(task.id for task in exercise.task) - changed


def _definitions(source: bytes) -> dict[str, tuple[str, frozenset[str]]]:
    """The functions, classes and constants of a module: the tree of each, and the names that it uses."""
    found: dict[str, tuple[str, frozenset[str]]] = {}
    for node in ast.parse(source).body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            names = [node.name]
        else:
            targets = node.targets if isinstance(node, ast.Assign) else []
            names = [target.id for target in targets if isinstance(target, ast.Name)]
        uses = frozenset(part.id for part in ast.walk(node) if isinstance(part, ast.Name))
        found |= {name: (ast.dump(node), uses) for name in names}
    return found


def to_do(results: Iterable[CheckResult], tasks: Collection[str]) -> list[CheckResult]:
    """The results, with what fails of functions that nobody has touched yet said as work to do."""
    return [
        msgspec.structs.replace(
            result,
            message="This function is as it was handed out.",
            help="Its docstring says what it is to do.",
            diagnosis="NOT_IMPLEMENTED",
            expected=None, actual=None, input=None, tolerance=None, first_divergence=None, traceback=None,
        )
        if result.task in tasks
        and result.status in {Status.FAIL, Status.ERROR}
        and result.diagnosis != "NOT_IMPLEMENTED"
        else result
        for result in results
    ]  # fmt: skip
