"""The quiz's questions, explanations and dates, on the screen and as parts of a reply."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from textwrap import shorten

import msgspec

from course.catalog.models import CourseRef
from course.cli.frame.console import Console
from course.cli.frame.here import Here
from course.cli.frame.replies import Envelope, NextStep, filled
from course.cli.home.overview import day
from course.errors import CourseError, UsageError
from course.printable import counted
from course.progress.quiz import Attempt, QuizHistory, quiz_history
from course.quizzing.bank import (
    LETTERS,
    Bank,
    Choice,
    MarkedQuestion,
    PosedQuestion,
    Result,
    fresh_seed,
    mark_sentence,
    needed,
)
from course.quizzing.desk import GAP_DAYS, ROUNDS, Due, begun, caught_up, fits, schedule

# ---
# The replies of ``course quiz ... --json``, as types.


class QuizOption(msgspec.Struct, frozen=True, kw_only=True):
    """One option of a question that was answered. ``belief`` is the misconception in plain words."""

    letter: str
    id: str
    text: str
    right: bool
    chosen: bool
    explanation: str
    misconception: str | None = None
    belief: str | None = None


class QuizQuestion(msgspec.Struct, frozen=True, kw_only=True):
    """One question that was answered; ``answer`` is the id of the option chosen."""

    id: str
    title: str
    variant: str
    prompt: str
    answer: str
    right: bool
    options: tuple[QuizOption, ...]
    source: str
    lesson: str | None = None
    read: str | None = None


class QuizPlace(msgspec.Struct, frozen=True):
    """One option of a question."""

    letter: str
    id: str
    text: str


class QuizAsked(msgspec.Struct, frozen=True):
    """One question to answer; it does not say which option is right."""

    id: str
    title: str
    prompt: str
    options: tuple[QuizPlace, ...]


class QuizDue(msgspec.Struct, frozen=True):
    """A question under review: the day it is due, and right answers in a row so far."""

    question: str
    due_on: str
    rounds: int


class Quiz(Envelope, tag="course.quiz/1", frozen=True, kw_only=True):
    """A scored attempt. ``ok`` and ``passed`` are the same; ``mark`` is the pass mark in words."""

    course: CourseRef
    seed: int
    resumed: bool
    score: int
    max_score: int
    needed: int
    passed: bool
    mark: str
    questions: tuple[QuizQuestion, ...]
    review: tuple[QuizDue, ...]
    next: NextStep
    warnings: tuple[str, ...] = ()


class QuizQuestions(Envelope, tag="course.quiz-questions/1", frozen=True, kw_only=True):
    """Questions to answer in a file; ``template`` is that file, to fill in."""

    course: CourseRef
    seed: int
    mark: str
    questions: tuple[QuizAsked, ...]
    template: str
    next: NextStep
    warnings: tuple[str, ...] = ()


class QuizReview(Envelope, tag="course.quiz-review/1", frozen=True, kw_only=True):
    """A review. ``ok`` is "no question was missed again"; ``next_due`` is None with none under review."""

    course: CourseRef
    seed: int | None
    questions: tuple[QuizQuestion, ...]
    review: tuple[QuizDue, ...]
    next_due: str | None
    next: NextStep
    warnings: tuple[str, ...] = ()


class QuizAttempt(msgspec.Struct, frozen=True, kw_only=True):
    """One attempt. ``state`` is "finished", "open" or "left"; ``counts`` is False for a seed seen before."""

    seed: int
    state: str
    started_at: str
    finished_at: str | None
    version: str
    answered: int
    score: int | None
    max_score: int
    passed: bool
    counts: bool


class QuizHistoryReply(Envelope, tag="course.quiz-history/1", frozen=True, kw_only=True):
    course: CourseRef
    mark: str
    attempts: tuple[QuizAttempt, ...]
    best: int | None
    passed: bool
    review: tuple[QuizDue, ...]
    next: NextStep


_PROMPT = "Your answer: "
KEYS = f"Type {LETTERS[0]} to {LETTERS[-1]} or 1 to {len(LETTERS)}, then Enter; q stops."
#: Width of the longest label beside an option: "Your answer".
_LABEL = 11


def show_mark(console: Console, total: int) -> None:
    """The pass mark, before the first question."""
    console.line((f"{mark_sentence(total)}.", "bold"))


def ask(console: Console, posed: PosedQuestion, number: int, total: int) -> Choice | None:
    """Ask one question; None if the student stops, by Ctrl-C too, or the input ends."""
    console.blank()
    _show_question(console, posed, number, total)
    while True:
        try:
            typed = console.ask(_PROMPT)
        except KeyboardInterrupt:
            console.blank()  # ends the line of the prompt
            return None
        if typed is None or typed.lower() in {"q", "quit"}:
            return None
        if (choice := posed.choice(typed)) is not None:
            return choice
        console.line(KEYS)


def _show_question(console: Console, posed: PosedQuestion, number: int, total: int) -> None:
    console.heading(f"Question {number} of {total}", posed.title)
    _show_prompt(console, posed)
    for choice in posed.choices:
        console.item(choice.letter, choice.text, style="bold")


def _show_prompt(console: Console, posed: PosedQuestion, indent: int = 0) -> None:
    for paragraph in posed.prompt.split("\n\n"):
        console.line(paragraph, indent=indent)


def show_result(console: Console, result: Result) -> None:
    """The score, then each question; of a missed one both answers, and why the student's is wrong."""
    verdict = ("passed", "green") if result.passed else ("not passed", "red")
    with console.paged():
        console.blank()
        score = f"{result.score} of {result.total} right, {needed(result.total)} needed: "
        console.line((score, "bold"), verdict, (". All options: course quiz history --all", "dim"))
        for number, marked in enumerate(result.marked, start=1):
            _show_outcome(console, marked, number)
            if marked.right:
                continue
            answer = _lettered(marked.chosen)
            if console.fancy:  # it was read a moment ago, and a line of it says which it was
                answer = shorten(answer, max(20, console.width - _LABEL - 4), placeholder=" …")
            console.item("Your answer", answer, style="red", width=_LABEL)
            console.line(marked.chosen.explanation, indent=4)
            console.item("Right", _lettered(marked.posed.key), style="green", width=_LABEL)


def _show_outcome(console: Console, marked: MarkedQuestion, number: int) -> None:
    outcome = ("right", "green") if marked.right else ("missed", "red")
    console.line((f"{number}. {marked.posed.title}: ", "bold"), outcome)


def show_marked(console: Console, marked: MarkedQuestion, number: int) -> None:
    """One answered question and why its options are right or wrong."""
    posed, chosen = marked.posed, marked.chosen
    console.blank()
    _show_outcome(console, marked, number)
    if not marked.right:
        _show_prompt(console, posed, indent=2)
        _show_choice(console, "Your answer", chosen, "red")
    _show_choice(console, "Right", posed.key, "green")
    if not marked.right:
        for choice in posed.choices:
            if choice is not chosen and not choice.right:
                _show_choice(console, "Wrong", choice, "yellow")
        console.line((f"Source: {posed.source}", "dim"), indent=2)
        if posed.read:
            console.line((f"Read again: course lesson {posed.read}", "dim"), indent=2)


def _show_choice(console: Console, label: str, choice: Choice, style: str) -> None:
    console.item(label, _lettered(choice), style=style, width=_LABEL)
    console.line(choice.explanation, indent=4)
    if choice.belief:
        console.line(f'The belief behind it: "{choice.belief}"', indent=4)


def _lettered(choice: Choice) -> str:
    return f"{choice.letter}. {choice.text}"


def show_due(console: Console, due: Sequence[Due], today: date) -> None:
    """The day on which each question under review is due, a line for those that stand alike."""
    if not due:
        return
    console.blank()
    console.heading("Under review", f"until right {ROUNDS} times in a row, {GAP_DAYS} days or more apart")
    alike: dict[str, list[str]] = {}
    for entry in due:
        state = f"{when(entry.on, today)}; right {entry.rounds} of {ROUNDS} times"
        alike.setdefault(state, []).append(entry.question)
    for state, questions in alike.items():
        console.line(f"{', '.join(questions)}: {state}", indent=2)


def when(day: date, today: date) -> str:
    days = (day - today).days
    if days <= 0:
        return "due now"
    return f"due {day.isoformat()} ({'tomorrow' if days == 1 else f'in {days} days'})"


def show_attempts(console: Console, attempts: Sequence[QuizAttempt], best: Attempt | None) -> None:
    if not attempts:
        console.line("No attempt yet.")
        return
    rows = []
    for attempt in attempts:
        score = "" if attempt.score is None else f"{attempt.score} of {attempt.max_score}"
        said = f"{attempt.answered} of {attempt.max_score} answered, {attempt.state}"
        if attempt.state == "finished":
            said = "passed" if attempt.passed else "not passed"
            said += "" if attempt.counts else "; same seed as before, does not count"
        rows.append((day(attempt.finished_at or attempt.started_at), score, said, str(attempt.seed)))
    console.table(("When", "Score", "Result", "Seed"), rows)
    if best is not None:
        console.line(f"Best: {best.score} of {best.total}; the best attempt counts.")


def hand_out(console: Console, here: Here, posed: Sequence[PosedQuestion], seed: int, command: str) -> int:
    """Print questions, and below them the file to fill in."""
    step = f"course quiz {command} --answers answers.toml"
    answers = "".join(f'{question.question} = ""\n' for question in posed)
    template = f"format_version = 1\nseed = {seed}\n\n[answers]\n{answers}"
    asked = []
    for number, one in enumerate(posed, start=1):
        console.blank()
        _show_question(console, one, number, len(posed))
        places = tuple(filled(QuizPlace, choice) for choice in one.choices)
        asked.append(QuizAsked(one.question, one.title, one.prompt, places))
    console.blank()
    console.heading("Answers", "save this as answers.toml, with a letter in each pair of quotes")
    console.block(template)
    console.note(f"Then: {step}")
    return here.answer(
        QuizQuestions(
            course=here.course,
            seed=seed,
            mark=mark_sentence(len(posed)) if command == "take" else "",
            questions=tuple(asked),
            template=template,
            next=NextStep(step),
            warnings=tuple(here.warnings),
        )
    )


def question_reply(marked: MarkedQuestion) -> QuizQuestion:
    """An answered question as a script reads it."""
    posed, options = marked.posed, []
    for one in posed.choices:
        behind = {"misconception": one.misconception or None, "belief": one.belief or None}
        options.append(filled(QuizOption, one, chosen=one is marked.chosen, **behind))
    more = {"options": tuple(options), "lesson": posed.lesson or None, "read": posed.read or None}
    return filled(QuizQuestion, marked, posed, id=posed.question, answer=marked.chosen.id, **more)


def due_reply(due: Sequence[Due]) -> tuple[QuizDue, ...]:
    """The questions under review, as a script reads them."""
    return tuple(QuizDue(entry.question, entry.on.isoformat(), entry.rounds) for entry in due)


def attempt_replies(history: QuizHistory) -> tuple[QuizAttempt, ...]:
    """Attempts as a script reads them; attempts without an answer are left out."""
    shown = [a for a in history.attempts if a.finished or a.answers or a is history.open]
    return tuple(
        filled(
            QuizAttempt,
            attempt,
            state="finished" if attempt.finished else "open" if attempt is history.open else "left",
            started_at=attempt.started.isoformat(),
            finished_at=attempt.finished.isoformat() if attempt.finished else None,
            answered=len(attempt.answers),
            score=attempt.score if attempt.finished else None,
            max_score=attempt.total,
            counts=attempt in history.counting,
        )
        for attempt in shown
    )


# ---
# A student's side of the quiz: the questions, the record, and the present attempt.


@dataclass
class Desk:
    """A student's side of the quiz."""

    here: Here
    bank: Bank
    history: QuizHistory

    @classmethod
    def load(cls) -> Desk:
        """Raises what finding the workspace, reading the questions and reading the record raise."""
        here = Here.load()
        return cls(here, Bank.of(here.catalog), quiz_history(here.workspace.store.events()))

    def new_seed(self) -> int:
        """A seed that asks no question in the same way as last time."""
        return fresh_seed(self.bank, self.history.last_seeds())

    def begin(self, seed: int) -> Attempt:
        return begun(self.bank, seed, self.here.catalog.version, self.here.record)

    def catch_up(self, attempt: Attempt) -> None:
        """Take over what another terminal has answered meanwhile: the first answer of each question counts.

        Raises:
            UsageError: the attempt was finished there.
        """
        self._read_again()
        if there := caught_up(attempt, self.history):
            problem = f"This attempt was finished in another terminal: {there.score} of {there.total} right."
            fix = "`course quiz history` shows it; `course quiz take` begins another one."
            raise UsageError(problem, help=fix, code="attempt_finished")

    def _read_again(self) -> None:
        try:
            self.history = quiz_history(self.here.workspace.store.events())
        except CourseError as error:
            if (told := f"{error.message} {error.help}") not in self.here.warnings:
                self.here.warnings.append(told)

    def kept(self, attempt: Attempt) -> str:
        """How much of an attempt that its student leaves is in the record."""
        self._read_again()
        there = next((one for one in self.history.attempts if one.id == attempt.id), None)
        if there is None:
            return "Your attempt is not kept."
        lost = len(attempt.answers) - len(there.answers)
        asked = f", and asks again what could not be recorded ({counted(lost, 'answer')})" if lost else ""
        return f"Your attempt is kept: `course quiz take` continues it{asked}."

    def reviews(self) -> tuple[Due, ...]:
        """The questions under review, from the record as it is now."""
        self._read_again()
        return schedule(self.history.outcomes(), self.bank.ids)


def open_or_new(console: Console, desk: Desk, seed: int | None) -> Attempt:
    """The attempt to go on with, or a new one."""
    open_one = desk.history.open
    if open_one is not None and seed in (None, open_one.seed):
        if fits(desk.bank, open_one):
            return open_one
        console.line("The questions have changed since you left your last attempt, so a new one begins.")
    elif open_one is not None and open_one.answers:
        left = f"{len(open_one.answers)} of {len(open_one.questions)} answered"
        console.line(f"This is another attempt; the one you left (seed {open_one.seed}, {left}) ends here.")
    return desk.begin(desk.new_seed() if seed is None else seed)


def agrees(bank: Bank, attempt: Attempt, seed: int, answers: Mapping[str, str]) -> bool:
    """Whether a file completes an open attempt and does not contradict it."""
    same = attempt.seed == seed and fits(bank, attempt)
    return same and all(answers[name] == option for name, option in attempt.answers.items())
