"""``course next`` names the next step, and ``course go`` runs it."""

from __future__ import annotations

import shlex

from course.cli.frame.app import again
from course.cli.frame.console import Console, current
from course.cli.frame.here import Here
from course.cli.frame.replies import NextStep
from course.cli.home.advice import exercise_ahead, next_in_course
from course.cli.home.replies import Go, Next

#: A step in words, by its command.
_WHY = {
    "lesson": "the next lesson you have not read to its end",
    "lessons": "everything this course has was read",
    "warmup": "a small task of the lesson you read",
    "start": "the exercise of the lesson you read",
    "check": "the exercise you started",
    "report": "what your code shows",
    "reflect": "the question that no check can judge",
    "quiz": "the quiz",
    "submit": "everything is done: hand it in",
}


def next_command() -> int:
    """Name what is next, and open nothing.

    `course go` does it.
    """
    console, here = current(), Here.load()
    step = next_in_course(here.catalog, here.standing())
    console.line(step)
    why = _why(here, step)
    console.note((why, "dim"))
    return here.answer(Next(next=NextStep(step), why=why))


def go() -> int:
    """Open what is next: a lesson, a task or the quiz.

    Runs the next command: a lesson, its predictions and small tasks, its exercise, the next lesson, and at
    last the quiz and `course submit`. In a terminal it asks before each further step. With --json it runs
    nothing and says what it would run.
    """
    console, here = current(), Here.load()
    standing = here.standing()
    step = next_in_course(here.catalog, standing)
    if console.json:
        console.emit(Go(next=NextStep(step), why=_why(here, step)))
        return 0
    ahead = exercise_ahead(here.catalog, standing, step)
    while True:
        words = _as_run(console, step)
        covered = words[0] == "lesson" and console.fills_the_screen
        if not covered:  # the reader covers it and tells where it continues
            console.note((f"course {shlex.join(words)}", "bold"), (f"  {_why(here, step)}", "dim"))
        if ahead:  # also above the reader, which leaves it on the screen
            console.note(ahead)
            ahead = ""
        code = _led(console, words)
        if not console.interactive:
            return code
        here = Here.load()
        before, step = step, next_in_course(here.catalog, here.standing())
        if step == before:
            left = "" if words[0] == "lesson" else f"Not finished yet: {step}. "  # a lesson says it itself
            console.note(f"{left}Go on at any time with: course go")
            return code
        console.note((f"Next: course {shlex.join(_as_run(console, step))}", "bold"), f"  {_why(here, step)}")
        if covered:  # q was pressed there, and Enter would have gone on
            console.note("Go on at any time with: course go")
            return code
        if not console.go_on(""):
            return 0


def _led(console: Console, words: list[str]) -> int:
    """Run a command; at a terminal what comes next is said once, by the loop."""
    console.led = console.interactive
    try:
        return again(words)
    finally:
        console.led = False


def _why(here: Here, step: str) -> str:
    _, name, *rest = step.split()
    if name == "check" and rest and here.catalog.exercise(rest[0]).is_warm_up:
        return "the small task you started"
    return _WHY.get(name, "")


def _as_run(console: Console, step: str) -> list[str]:
    """The words of a step, in the form for a user at a terminal who continues."""
    words = shlex.split(step)[1:]
    if not console.interactive:
        return words
    if words[0] == "check":
        words[0] = "watch"
    if words[0] == "lesson" and console.plain:
        words.append("--page")  # a lesson that is only printed does not count as read
    return words
