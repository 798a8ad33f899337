"""``course quiz``: five questions, an explanation of every option, and a review of missed questions."""

from collections.abc import Sequence
from datetime import date, datetime
from pathlib import Path
from typing import Annotated

from course.cli.frame.console import Console, current
from course.cli.frame.options import option
from course.cli.frame.registry import COMMANDS, group
from course.cli.frame.replies import NextStep, filled
from course.cli.quiz import screen
from course.errors import INTERRUPTED, UsageError
from course.progress.quiz import Attempt
from course.quizzing.answers import AnswerFile, read_answers
from course.quizzing.bank import (
    MarkedQuestion,
    PosedQuestion,
    check_seed,
    mark,
    mark_sentence,
    needed,
)
from course.quizzing.desk import answered, finished, fits, reviewed

app = group(COMMANDS["quiz"].summary)

AnswersOption = Annotated[
    Path | None, option("--answers FILE", "Answers from a TOML or JSON file; nothing is asked.")
]
SeedOption = Annotated[
    int | None, option("--seed N", "Chooses variants, numbers and order; random if left out.")
]
QuestionsOption = Annotated[
    bool, option("--questions", "Print the questions and a file to fill in; nothing is asked.")
]


def today() -> date:
    """Today, in the student's time zone."""
    return datetime.now().astimezone().date()


@app.command(epilog="Example: course quiz take --answers answers.toml --seed 42")
def take(answers: AnswersOption = None, seed: SeedOption = None, questions: QuestionsOption = False) -> int:
    """Answer the questions; exit code 0 if passed, 1 below the mark.

    An interrupted attempt continues where it stopped. Without a terminal: print the questions with
    --questions, put the answers into a file, and pass it with --answers. Afterwards you are told why a missed
    answer is wrong; `course quiz history --all` explains every option.
    """
    console = current()
    _check_options(answers, seed, questions, "take")
    if answers is None and not questions:
        _need_terminal(console, "take")
    desk = screen.Desk.load()
    if answers is not None:
        return _take_file(console, desk, answers, seed)
    if questions:
        # They are the same until they are answered; an attempt with an answer stays open whatever is printed.
        if seed is None or desk.history.open is None or not desk.history.open.answers:
            seed = screen.open_or_new(console, desk, seed).seed
        posed = desk.bank.pose(seed)
        screen.show_mark(console, len(posed))
        return screen.hand_out(console, desk.here, posed, seed, "take")
    attempt = screen.open_or_new(console, desk, seed)
    desk.here.tell()  # before anything is answered that cannot be kept
    resumed = bool(attempt.answers)
    posed = desk.bank.pose(attempt.seed)
    screen.show_mark(console, len(posed))
    console.note(screen.KEYS)
    if resumed:
        console.line(f"Continuing the attempt you left: {len(attempt.answers)} of {len(posed)} answered.")
    if not _ask_all(console, desk, attempt, posed):
        console.line(desk.kept(attempt))
        desk.here.tell()
        return INTERRUPTED
    return _finish(console, desk, attempt, posed, resumed=resumed)


def _check_options(answers: Path | None, seed: int | None, questions: bool, command: str) -> None:
    if seed is not None:
        check_seed(seed)
    if answers is not None and questions:
        problem = "--questions prints the questions and --answers answers them; give one of the two."
        fix = f"First: course quiz {command} --questions. Then: course quiz {command} --answers FILE."
        raise UsageError(problem, help=fix)


def _need_terminal(console: Console, command: str) -> None:
    if console.interactive:
        return
    raise UsageError(
        f"`course quiz {command}` asks its questions on a terminal, and there is none here"
        f"{' with --json' if console.json else ''}: use --answers FILE.",
        help=f"`course quiz {command} --questions` prints the questions and a file to fill in; then "
        f"`course quiz {command} --answers FILE`.",
        code="no_terminal",
    )


def _ask_all(console: Console, desk: screen.Desk, attempt: Attempt, posed: Sequence[PosedQuestion]) -> bool:
    """Ask the unanswered questions; False if the student stops."""
    for number, question in enumerate(posed, start=1):
        if question.question in attempt.answers:
            continue
        chosen = screen.ask(console, question, number, len(posed))
        if chosen is None:
            return False
        desk.catch_up(attempt)
        if question.question in attempt.answers:
            console.line("This question was answered in another terminal; that answer counts.")
        else:
            answered(attempt, question.question, chosen.id, desk.here.record)
        desk.here.tell()
    return True


def _take_file(console: Console, desk: screen.Desk, path: Path, seed: int | None) -> int:
    file = read_answers(path)
    open_one = desk.history.open
    seed = _seed("take", file, seed, file.seed, open_one.seed if open_one is not None else None)
    posed = desk.bank.pose(seed)
    answers = file.choose(posed, desk.bank, seed)
    screen.show_mark(console, len(posed))
    attempt = open_one if open_one is not None and screen.agrees(desk.bank, open_one, seed, answers) else None
    resumed = attempt is not None and bool(attempt.answers)
    attempt = attempt or desk.begin(seed)
    for name, picked in answers.items():
        if name not in attempt.answers:
            answered(attempt, name, picked, desk.here.record)
    return _finish(console, desk, attempt, posed, resumed=resumed)


def _seed(command: str, file: AnswerFile, *seeds: int | None) -> int:
    """The first seed that is known of those that a file of answers may be for."""
    for seed in seeds:
        if seed is not None:
            return check_seed(seed)
    problem = f"{file.path} does not say which questions its answers are for."
    fix = f"Add the seed that `course quiz {command} --questions` prints, or give --seed N."
    raise UsageError(problem, help=fix, code="seed_missing")


def _finish(
    console: Console, desk: screen.Desk, attempt: Attempt, posed: Sequence[PosedQuestion], *, resumed: bool
) -> int:
    result = finished(attempt, posed, desk.here.record)
    due = desk.reviews()
    missed = (one.posed.read for one in result.marked if not one.right and one.posed.read)
    step = "course quiz review" if due else "course"
    if not result.passed:
        step = f"course lesson {read}" if (read := next(missed, "")) else "course quiz take"
    screen.show_result(console, result)
    if any(one.seed == attempt.seed and one.id != attempt.id for one in desk.history.finished):
        console.line("Questions of this seed were answered before: this attempt does not count.")
    if result.passed and due:  # else the lesson to read comes first
        many = f"{len(due)} questions are under review, the first" if len(due) > 1 else "1 is under review,"
        console.line(f"{many} {screen.when(due[0].on, today())}: course quiz review")
    console.next(step)
    return desk.here.answer(
        filled(
            screen.Quiz,
            result,
            exit_code=0 if result.passed else 1,
            course=desk.here.course,
            seed=attempt.seed,
            resumed=resumed,
            max_score=result.total,
            needed=needed(result.total),
            mark=mark_sentence(result.total),
            questions=tuple(screen.question_reply(marked) for marked in result.marked),
            review=screen.due_reply(due),
            next=NextStep(step),
            warnings=tuple(desk.here.warnings),
        )
    )


@app.command(epilog="Example: course quiz review")
def review(answers: AnswersOption = None, seed: SeedOption = None, questions: QuestionsOption = False) -> int:
    """Ask missed questions again, in new words and numbers.

    A missed question is due every two days until it was right three times in a row. Exit code 1 if a question
    was missed again; 0 if not, or if none is due. A review changes no score.
    """
    console = current()
    _check_options(answers, seed, questions, "review")
    desk = screen.Desk.load()
    ids = [entry.question for entry in desk.reviews() if entry.on <= today()]
    if not ids:
        return _end_review(console, desk, None, [])
    if answers is None and not questions:
        _need_terminal(console, "review")
    marked: list[MarkedQuestion] = []
    if answers is not None:
        file = read_answers(answers)
        seed = _seed("review", file, seed, file.seed)
        posed = desk.bank.pose(seed, only=ids)
        options = file.choose(posed, desk.bank, seed)
        marked = [reviewed(one, options[one.question], seed, desk.here.record) for one in posed]
        for number, given in enumerate(marked, start=1):
            screen.show_marked(console, given, number)
        return _end_review(console, desk, seed, marked)
    seed = desk.new_seed() if seed is None else seed
    posed = desk.bank.pose(seed, only=ids)
    if questions:
        return screen.hand_out(console, desk.here, posed, seed, "review")
    console.note(screen.KEYS)
    for number, question in enumerate(posed, start=1):
        one = screen.ask(console, question, number, len(posed))
        if one is None:
            console.line("The rest stays due: `course quiz review` continues with it.")
            return INTERRUPTED
        marked.append(reviewed(question, one.id, seed, desk.here.record))
        desk.here.tell()
        screen.show_marked(console, marked[-1], number)
    return _end_review(console, desk, seed, marked)


def _end_review(
    console: Console, desk: screen.Desk, seed: int | None, marked: Sequence[MarkedQuestion]
) -> int:
    due = desk.reviews()
    missed = [one for one in marked if not one.right]
    if marked:
        console.line((f"{len(marked) - len(missed)} of {len(marked)} right.", "bold"))
    elif not due:
        console.line(
            "Nothing is under review: questions that you miss in an attempt come here."
            if desk.history.finished
            else "Nothing is under review yet: take the quiz first."
        )
    else:
        console.line("Nothing is due today.")
    screen.show_due(console, due, today())
    best = desk.history.best
    step = "course" if best is not None and best.passed else "course quiz take"
    console.next(step)
    return desk.here.answer(
        screen.QuizReview(
            exit_code=1 if missed else 0,
            course=desk.here.course,
            seed=seed,
            questions=tuple(screen.question_reply(one) for one in marked),
            review=screen.due_reply(due),
            next_due=due[0].on.isoformat() if due else None,
            next=NextStep(step),
            warnings=tuple(desk.here.warnings),
        )
    )


@app.command(epilog="Example: course quiz history --json")
def history(
    whole: Annotated[
        bool, option("--all", "Explain every option of your last finished attempt, too.")
    ] = False,
) -> int:
    """Show every attempt, with dates and scores, and what is under review."""
    console, desk = current(), screen.Desk.load()
    last = desk.history.finished[-1] if whole and desk.history.finished else None
    if last is not None and fits(desk.bank, last):
        with console.paged():
            for number, one in enumerate(mark(desk.bank.pose(last.seed), last.answers).marked, start=1):
                screen.show_marked(console, one, number)
            console.blank()
    elif last is not None:
        console.line("The questions have changed since your last attempt, so it cannot be explained.")
    attempts = screen.attempt_replies(desk.history)
    due = desk.reviews()
    best = desk.history.best
    passed = best is not None and best.passed
    screen.show_mark(console, len(desk.bank.ids))
    screen.show_attempts(console, attempts, best)
    screen.show_due(console, due, today())
    ready = bool(due) and due[0].on <= today()
    step = "course quiz review" if ready else "course" if passed else "course quiz take"
    console.next(step)
    return desk.here.answer(
        screen.QuizHistoryReply(
            course=desk.here.course,
            mark=mark_sentence(len(desk.bank.ids)),
            attempts=attempts,
            best=best.score if best else None,
            passed=passed,
            review=screen.due_reply(due),
            next=NextStep(step),
        )
    )
