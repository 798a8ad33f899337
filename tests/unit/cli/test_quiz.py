"""The quiz on the command line: asked, resumed, answered from a file, reviewed, handed in."""

import io
import json
import sys
import zipfile
from datetime import UTC, datetime, timedelta

import pytest

from course.catalog.load import Catalog
from course.catalog.questions import read_questions
from course.cli.frame.console import Console
from course.cli.quiz import commands, screen
from course.errors import IntegrityError, MissingCapabilityError
from course.grading.quiz import grade_quiz
from course.progress import store
from course.progress.store import Store
from course.quizzing.bank import Bank, mark
from tests.unit.cli.conftest import Terminal

SEED = 7
TAKE = f"take --seed {SEED}"
MARK = "You need 4 right answers out of 5 to pass."
#: Those that are asked here, however many more the course has.
ASKED = ("why-simulate", "which-engine", "sim-to-real-gap", "digital-twin", "numerical-integration")
CTRL_C = "\x03"
TOTAL = len(read_questions(Catalog().content.quiz))


@pytest.fixture(scope="module")
def questions():
    """Those that are asked here, read once."""
    return tuple(one for one in read_questions(Catalog().content.quiz) if one.value.id in ASKED)


@pytest.fixture
def quiz(course, real, monkeypatch, questions):
    """Run ``course quiz`` in a workspace of the real course."""
    monkeypatch.setattr("course.quizzing.bank.read_questions", lambda _: questions)
    return lambda line, *more: course(f"quiz {line}", *more)


@pytest.fixture
def bank(quiz):
    return Bank.of(Catalog())


class Typist(Terminal):
    def readline(self):
        line = super().readline()
        if line == f"{CTRL_C}\n":
            raise KeyboardInterrupt
        return line


@pytest.fixture
def types(monkeypatch):
    """Somebody at a terminal who types these lines and then leaves."""

    def typing(*lines):
        monkeypatch.setattr(sys, "stdin", Typist("".join(f"{line}\n" for line in lines)))

    return typing


@pytest.fixture
def travel(monkeypatch):
    """Move the clock by whole days."""

    def to(days):
        now = datetime.now(UTC) + timedelta(days=days)
        monkeypatch.setattr(commands, "today", lambda: now.astimezone().date())
        monkeypatch.setattr(store, "_now", lambda: now.isoformat(timespec="milliseconds"))

    return to


def key(bank, wrong=(), seed=SEED, only=None):
    """The right letter of each question, another one for the ``wrong``."""
    letters = {}
    for posed in bank.pose(seed, only):
        bad = next(choice for choice in posed.choices if not choice.right)
        letters[posed.question] = bad.letter if posed.question in wrong else posed.key.letter
    return letters


def save(path, letters, seed=SEED):
    lines = [f"seed = {seed}", "[answers]", *(f'{name} = "{letter}"' for name, letter in letters.items())]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return str(path)


@pytest.fixture
def answered(quiz, bank, tmp_path):
    """The quiz taken from a file, in which all answers are right but the ``wrong``."""
    return lambda *wrong, more="": quiz(f"take {more} --answers", save(tmp_path / "a.toml", key(bank, wrong)))


def test_a_perfect_attempt_passes_and_numbers_answer_while_other_keys_are_asked_again(quiz, bank, types):
    first, *rest = [str("abcd".index(letter) + 1) for letter in key(bank).values()]
    types("", "e", "5", first, *rest)
    ran = quiz(TAKE).ends(0, "5 of 5 right, 4 needed: passed")
    assert ran.out.startswith(MARK)
    assert ran.out.count("Your answer: ") == 5 + 3
    assert ran.out.count("Type a to d or 1 to 4") == 1 + 3
    for posed in bank.pose(SEED):
        assert all(choice.text in ran.out for choice in posed.choices)


def test_below_the_mark_every_option_of_what_was_missed_is_explained_on_request(quiz, bank, types):
    wrong = ("why-simulate", "digital-twin")
    letters = key(bank, wrong)
    types(*letters.values())
    ran = quiz(TAKE).ends(1, f"Next: course lesson {bank.pose(SEED, wrong)[0].read}\n")
    assert ran.out.count("3 of 5 right, 4 needed: not passed") == 1
    whole = quiz("history --all").out
    assert whole.count("Read again: course lesson ") == 2
    assert "why-simulate, digital-twin: due" in whole
    for posed in bank.pose(SEED):
        for choice in posed.choices:
            missed = posed.question in wrong
            taken = missed and choice.letter == letters[posed.question]
            assert (choice.explanation in ran.out) == taken
            shown = choice.right or missed
            assert (choice.explanation in whole) == shown
            assert (f'"{choice.belief}"' in whole) == (shown and not choice.right)


def test_the_result_of_a_quiz_takes_forty_lines_of_eighty_columns_at_most(bank):
    """Forty rows: what a usual window shows without scrolling twice. The longest result has all missed."""
    for seed in range(60):
        posed, worst = bank.pose(seed), {}
        for one in posed:
            wrong = [choice for choice in one.choices if not choice.right]
            worst[one.question] = max(wrong, key=lambda choice: len(choice.explanation)).letter
        shown = io.StringIO()
        screen.show_result(Console(stdout=shown, environ={"FORCE_COLOR": "1"}), mark(posed, worst))
        assert len(shown.getvalue().splitlines()) + 1 <= 40, "the last one names the next step"


@pytest.mark.parametrize("stop", ["q", "QUIT", CTRL_C, None])
def test_an_attempt_that_was_stopped_goes_on_where_it_was(quiz, bank, types, stop):
    letters = list(key(bank).values())
    types(*letters[:2], *([stop] if stop else []))
    stopped = quiz(TAKE).ends(130, "Your attempt is kept: `course quiz take` continues it.")
    assert stopped.err.strip().endswith("Interrupted.")
    types(*letters[2:])
    quiz("take").ends(0, "2 of 5 answered", "Question 3 of 5", "5 of 5 right").lacks("Question 2 of 5")


def test_what_cannot_be_recorded_is_said_before_the_first_question_and_once(quiz, bank, types, tmp_path):
    state = tmp_path / ".course"
    state.rmdir()
    state.write_text("no folder", encoding="utf-8")
    types(*list(key(bank).values())[:2], "q")
    ran = quiz(TAKE).ends(130, "Your attempt is not kept.")
    assert ran.err.count("This was not recorded: ") == 1
    assert "is kept" not in ran.out


def test_an_attempt_that_is_left_says_which_answers_were_not_recorded(quiz, bank, types, monkeypatch):
    append = Store.append

    def once_full(store, kind, *rest):
        if kind == "quiz-answer" and store.events(kind):
            raise MissingCapabilityError("The disk is full.", help="Free some space.", code="not_writable")
        append(store, kind, *rest)

    monkeypatch.setattr(Store, "append", once_full)
    types(*list(key(bank).values())[:3], "q")
    ran = quiz(TAKE)
    ran.ends(130, "continues it, and asks again what could not be recorded (2 answers).")
    assert ran.err.count("This was not recorded: The disk is full.") == 1


@pytest.mark.parametrize("there", [1, 5])
def test_the_first_answer_of_two_terminals_counts_and_so_does_the_first_end(
    quiz, bank, types, monkeypatch, there
):
    quiz(f"{TAKE} --questions")
    types("")
    letters, elsewhere = key(bank), key(bank, wrong=ASKED)
    asked, ask = [], screen.ask

    def meanwhile(*words):
        if not asked:  # as the other terminal does it
            asked.append("another")
            types(*[*elsewhere.values()][:there], "q")
            quiz("take")
            types(*letters.values())
        return ask(*words)

    monkeypatch.setattr(screen, "ask", meanwhile)
    ran = quiz("take")
    shown = quiz("history --json").json["attempts"]
    if there == 5:
        ran.refuses(2, "finished in another terminal: 0 of 5 right")
    else:
        ran.ends(0, "answered in another terminal", "4 of 5 right")
    assert [one["score"] for one in shown] == [0 if there == 5 else 4]


def test_an_attempt_that_waits_is_not_given_up_without_a_word(quiz, bank, types):
    letters = list(key(bank).values())
    types(*letters[:2], "q")
    quiz(TAKE).ends(130)
    assert quiz("take --questions --seed 11 --json").json["seed"] == 11
    assert quiz("take --questions --json").json["seed"] == SEED, "printing changed nothing"
    types("q")
    quiz("take --seed 12").says(f"the one you left (seed {SEED}, 2 of 5 answered) ends here")
    assert quiz("take --questions --json").json["seed"] == 12
    types(*key(bank, seed=12).values())
    assert quiz("take").code == 0
    states = [entry["state"] for entry in quiz("history --json").json["attempts"]]
    assert states == ["left", "finished"]


def test_a_crash_between_the_last_answer_and_the_score_loses_nothing(quiz, bank, types, monkeypatch):
    def fall(*_, **__):
        raise KeyboardInterrupt

    types(*key(bank).values())
    with monkeypatch.context() as patch:
        patch.setattr(commands, "_finish", fall)
        assert quiz(TAKE).code == 130
    types()
    assert "Your answer: " not in quiz("take").ends(0, "5 of 5 right").out


def test_without_a_terminal_nothing_is_asked(quiz):
    for line in ("take", "take --seed 3"):
        assert quiz(line).refuses(2, "use --answers FILE").out == ""
    refused = quiz("take --json").warns("use --answers FILE")
    assert (refused.error, refused.json["schema"]) == ((2, "no_terminal"), "course.quiz/1")
    assert quiz("history --json").json["attempts"] == []


def test_questions_can_be_printed_and_answered_from_a_file(quiz, bank, tmp_path):
    asked = quiz("take --questions --json").json
    assert (asked["schema"], asked["ok"], asked["mark"] + ".") == ("course.quiz-questions/1", True, MARK)
    assert "right" not in json.dumps(asked["questions"][0]["options"])
    assert "explanation" not in json.dumps(asked)
    assert quiz("take --questions --json").json["seed"] == asked["seed"]
    text, path = asked["template"], tmp_path / "answers.toml"
    path.write_text(text, encoding="utf-8")
    quiz("take --answers", path).refuses(2, f"{path}:4: 5 answers are missing: why-simulate")
    for name, letter in key(bank, seed=asked["seed"]).items():
        text = text.replace(f'{name} = ""', f'{name} = "{letter}"')
    path.write_text(text, encoding="utf-8")
    taken = quiz("take --answers", path, "--json").ends(0).json
    assert (taken["seed"], taken["passed"]) == (asked["seed"], True)
    assert [entry["state"] for entry in quiz("history --json").json["attempts"]] == ["finished"]


def test_the_answer_of_a_script_has_everything(answered):
    body = answered("which-engine", more="--json").ends(0).json
    assert body["schema"] == "course.quiz/1"
    assert (body["score"], body["max_score"], body["needed"], body["resumed"]) == (4, 5, 4, False)
    (missed,) = [question for question in body["questions"] if not question["right"]]
    assert missed["id"] == "which-engine"
    assert [option["right"] for option in missed["options"]].count(True) == 1
    (chosen,) = [option for option in missed["options"] if option["chosen"]]
    assert missed["answer"] == chosen["id"]
    assert chosen["belief"]
    assert [entry["question"] for entry in body["review"]] == ["which-engine"]


def test_the_seed_may_be_given_beside_the_file_but_no_other_than_the_files_own(quiz, bank, tmp_path):
    path = save(tmp_path / "a.toml", key(bank))
    quiz("take --answers", path, "--seed", "8").refuses(2, f"{path}:1: these answers are for seed 7")
    path = tmp_path / "a.json"
    path.write_text(json.dumps({"answers": key(bank)}), encoding="utf-8")
    quiz("take --answers", path).refuses(2, "does not say which questions")
    assert quiz("history --json").json["attempts"] == []
    quiz(f"{TAKE} --answers", path).ends(0)


@pytest.mark.parametrize(
    "line",
    [
        *(f"take --seed {seed}" for seed in ("-1", "2147483648", "x")), "review --seed -1",
        "take --answers none.toml", "take --answers none.toml --questions",
    ],
)  # fmt: skip
def test_what_cannot_be_used_is_a_sentence(quiz, line):
    ran = quiz(line).ends(2)
    assert ran.err.strip()
    assert "Traceback" not in ran.err


def test_outside_of_a_workspace_or_without_a_quiz_that_is_said(course, workspace, monkeypatch):
    assert course("quiz history --json").error == (5, "quiz_not_found")
    monkeypatch.delenv("COURSE_CONTENT")
    monkeypatch.chdir(workspace.parent)
    assert course("quiz take --json").code in {2, 5}
    assert course("quiz history").code == 5


def test_a_file_may_finish_an_attempt_that_was_begun_and_the_same_seed_counts_once(
    quiz, bank, types, answered
):
    wrong = ("why-simulate", "digital-twin")
    types(key(bank, wrong)["why-simulate"])
    quiz(TAKE).ends(130)
    assert answered(*wrong, more="--json").json["resumed"] is True
    assert len(quiz("history --json").json["attempts"]) == 1
    answered().ends(0)
    body = quiz("history --json").json
    assert [(entry["score"], entry["counts"]) for entry in body["attempts"]] == [(3, True), (5, False)]
    assert (body["best"], body["passed"]) == (3, False)
    quiz("history").says("does not count")


# -- review ----------------------------------------------------------------------------------------------


def test_nothing_is_there_before_an_attempt_nor_reviewed_before_something_was_missed(quiz, answered):
    quiz("history").ends(0, "No attempt yet.", "Next: course quiz take")
    quiz("review").says("take the quiz first")
    answered()
    ran = quiz("review --json")
    assert (ran.code, ran.json["next_due"], ran.json["questions"]) == (0, None, [])


def test_what_was_missed_comes_back_every_two_days_until_it_is_known(quiz, bank, answered, types, travel):
    answered("digital-twin")
    start = datetime.now().astimezone().date()
    early = quiz("review --json").json
    assert (early["ok"], early["next_due"]) == (True, str(start + timedelta(days=2)))
    for day, rounds in ((2, 1), (4, 2), (6, None)):
        travel(day)
        asked = quiz("review --questions --json").json
        assert [question["id"] for question in asked["questions"]] == ["digital-twin"]
        assert asked["mark"] == ""
        letters = key(bank, seed=asked["seed"], only=["digital-twin"])
        types(*letters.values())
        quiz("review --seed", asked["seed"]).ends(0, "1 of 1 right.")
        due = quiz("review --json").json["review"]
        assert [entry["rounds"] for entry in due] == ([] if rounds is None else [rounds])
    quiz("review").says("Nothing is under review")


def test_a_review_explains_at_once_and_asks_another_variant(quiz, bank, answered, types, travel):
    answered("digital-twin", "which-engine")
    travel(2)
    asked = quiz("review --questions --json").json
    seed = asked["seed"]
    assert all(bank.variant(q["id"], seed) != bank.variant(q["id"], SEED) for q in asked["questions"])
    letters = key(bank, ("which-engine",), seed=seed, only=["digital-twin", "which-engine"])
    types(*letters.values())
    ran = quiz("review --seed", seed).ends(1, "1 of 2 right.", "due")
    first, second = bank.pose(seed, only=["digital-twin", "which-engine"])
    assert ran.out.index(first.choices[0].explanation) < ran.out.index(second.prompt)


def test_a_review_that_was_stopped_keeps_its_answers(quiz, bank, answered, types, travel):
    answered("digital-twin", "which-engine")
    travel(2)
    types(*key(bank, seed=1, only=["which-engine"]).values(), "q")
    assert quiz("review --seed 1").code == 130
    left = quiz("review --questions --json").json
    assert [question["id"] for question in left["questions"]] == ["digital-twin"]


def test_a_review_works_without_a_terminal(quiz, bank, answered, tmp_path, travel):
    answered("digital-twin")
    travel(3)
    quiz("review").refuses(2, "use --answers FILE")
    letters = key(bank, seed=5, only=["digital-twin"])
    path = save(tmp_path / "r.toml", letters, seed=5)
    body = quiz("review --answers", path, "--json").json
    assert (body["schema"], body["ok"], body["seed"]) == ("course.quiz-review/1", True, 5)
    assert [entry["rounds"] for entry in body["review"]] == [1]
    assert body["next_due"] == str(datetime.now().astimezone().date() + timedelta(days=5))


# -- handed in -------------------------------------------------------------------------------------------


def test_attempts_travel_in_a_submission_and_are_scored_again(quiz, bank, course, answered, tmp_path):
    answered("which-engine")
    quiz("take --questions")
    course("submit -o", tmp_path / "mine.zip").ends(0, "The quiz: 1 attempt, best 4 of 5")
    with zipfile.ZipFile(tmp_path / "mine.zip") as archive:
        record = json.loads(archive.read("submission.json"))["quiz"]
    verdict = grade_quiz(bank, record)
    assert (verdict.state, verdict.score, verdict.passed) == ("graded", 4.0, True)
    assert course("submit -o", tmp_path / "mine.zip", "--json").json["quiz_attempts"] == 1


def test_plain_output_has_no_frames_and_one_fact_a_line(answered):
    ran = answered("which-engine", more="--plain").ends(
        0, "2. Which engine is for what, and how to choose: missed\n", "1 is under review, due "
    )
    assert not {*"─\x1b"} & {*ran.out}
    assert ran.out.count("4 of 5 right") == 1


@pytest.mark.usefixtures("colourless")
@pytest.mark.parametrize("width", ["60", "120"])
def test_nothing_is_wider_than_the_terminal(quiz, bank, answered, monkeypatch, width):
    monkeypatch.setenv("COLUMNS", width)
    for ran in (answered(*bank.ids), quiz("history"), quiz("review"), quiz("take --questions")):
        assert max(map(len, ran.rows)) <= int(width)
        assert "\x1b[3" not in ran.out


def test_the_quiz_is_part_of_progress_and_of_the_dashboard(quiz, bank, answered, types, course):
    none = {"attempts": 0, "best": None, "total": TOTAL, "passed": False}
    assert course("progress --json").json["quiz"] == none
    course("--plain").says("quiz: not taken yet")
    answered("why-simulate", "digital-twin")
    course("progress --plain").says("Quiz: not passed yet, best 3 of 5, 1 attempt")
    answered()
    assert course("--json").json["quiz"]["passed"] is False, "the same questions again do not count"
    types(*key(bank, seed=8).values())
    quiz("take --seed 8")
    assert course("--json").json["quiz"] == {"attempts": 2, "best": 5, "total": TOTAL, "passed": True}


def test_a_record_that_cannot_be_read_is_warned_about_once(quiz, monkeypatch):
    """Before each answer what another terminal did is looked up, and each time the warning was added."""
    desk = screen.Desk.load()
    attempt = desk.begin(SEED)

    def damaged(*_, **__):
        raise IntegrityError("The record is damaged.", help="Restore it.")

    monkeypatch.setattr(type(desk.here.workspace.store), "events", damaged)
    desk.catch_up(attempt)
    desk.catch_up(attempt)
    assert desk.here.warnings == ["The record is damaged. Restore it."]
