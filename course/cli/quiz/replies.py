"""The replies of ``course quiz ... --json``, as types."""

from __future__ import annotations

import msgspec

from course.catalog.models import CourseRef
from course.cli.frame.replies import Envelope, NextStep

__all__ = [
    "Quiz",
    "QuizAsked",
    "QuizAttempt",
    "QuizDue",
    "QuizHistoryReply",
    "QuizOption",
    "QuizPlace",
    "QuizQuestion",
    "QuizQuestions",
    "QuizReview",
]


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
