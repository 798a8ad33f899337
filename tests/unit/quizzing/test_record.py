"""Attempts on their way: from the record of progress into a submission, and scored again there."""

from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.authoring.audit import audit_quiz
from course.authoring.report import Findings
from course.catalog.locate import Content
from course.catalog.questions import read_questions
from course.errors import UngradableError
from course.grading.quiz import grade_quiz, quiz_version, record_sha256, score_record
from course.progress import quiz as progress
from course.progress.store import Store
from course.quizzing.bank import MAX_SEED, Bank
from course.quizzing.desk import answered, begun, finished, reviewed
from course.scoring.verdict import Status


def attempt(bank, seed, wrong=0):
    """An honest record with so many wrong answers, as JSON gives it back."""
    answers = {}
    for number, posed in enumerate(bank.pose(seed)):
        choice = posed.key if number >= wrong else next(c for c in posed.choices if not c.right)
        answers[posed.question] = choice.id
    return {
        "seed": seed,
        "version": "1.0.0",
        "finished_at": "2026-03-02T12:00:00+00:00",
        "questions": list(bank.ids),
        "answers": answers,
        "score": len(bank.ids) - wrong,
    }


@pytest.fixture
def store(tmp_path):
    return Store(tmp_path / "p.sqlite")


def take(store, bank, seed, wrong=0, *, finish=True):
    """What ``course quiz take`` records."""
    taken = begun(bank, seed, "1.0.0", store.append)
    for question, option in attempt(bank, seed, wrong)["answers"].items():
        answered(taken, question, option, store.append)
    if finish:
        finished(taken, bank.pose(seed), store.append)
    return taken


def history(store):
    return progress.quiz_history(store.events())


# -- the record of progress ------------------------------------------------------------------------------


def test_the_first_answer_counts_and_nothing_after_the_end(store, bank):
    """Two terminals may go on with the same attempt."""
    one = take(store, bank, 5, finish=False)
    answered(one, "sums", "none", store.append)
    assert history(store).attempts[0].answers == attempt(bank, 5)["answers"]
    one.answers |= attempt(bank, 5)["answers"]
    finished(one, bank.pose(5), store.append)
    before = history(store)
    answered(one, "sums", "none", store.append)
    finished(one, bank.pose(5), store.append)
    store.append(progress.ANSWER, "sums", {"attempt": "nobody", "option": "none"})
    assert history(store) == before


def test_of_one_seed_the_first_attempt_counts_and_of_those_the_best(store, bank):
    first = take(store, bank, 5, wrong=1)
    take(store, bank, 5)
    assert [told.id for told in history(store).counting] == [first.id]
    take(store, bank, 6)
    take(store, bank, 7, wrong=2)
    best = history(store).best
    assert (best.seed, best.score, best.total) == (6, 2, 2)
    assert [record["seed"] for record in progress.records(history(store))] == [5, 6, 7]


def test_of_too_many_attempts_the_best_travel(bank, store, monkeypatch):
    monkeypatch.setattr(progress, "MAX_RECORDS", 8)
    for seed in range(progress.MAX_RECORDS + 2):
        take(store, bank, seed, wrong=0 if seed == 0 else 2 if seed in {1, 2} else 1)
    kept = progress.records(history(store))
    assert [record["seed"] for record in kept] == [0, *range(3, progress.MAX_RECORDS + 2)]
    assert score_record(bank, kept) is not None


def test_outcomes_are_joined_from_attempts_and_reviews(store, bank):
    take(store, bank, 5, wrong=1)
    (posed,) = bank.pose(9, only=["sums"])
    reviewed(posed, posed.key.id, 9, store.append)
    outcomes = history(store).outcomes()
    assert [right for _, right in outcomes["sums"]] == [False, True]
    assert [right for _, right in outcomes["colours"]] == [True]
    assert history(store).last_seeds() == {"sums": 9, "colours": 5}


# -- scored again ----------------------------------------------------------------------------------------


def test_no_attempt_is_no_result(bank):
    assert score_record(bank, []) is None
    assert grade_quiz(bank, []) is None


def test_a_verdict_has_a_check_for_each_question(bank):
    verdict = grade_quiz(bank, [attempt(bank, 5, wrong=1)])
    assert (verdict.exercise, verdict.state, verdict.score, verdict.max_score) == ("quiz", "graded", 1.0, 2.0)
    assert (verdict.passed, verdict.isolation, verdict.warnings) == (False, "", ())
    wrong, right = verdict.checks
    assert (wrong.id, wrong.status, wrong.points) == ("sums", Status.FAIL, 0.0)
    assert wrong.diagnosis in {"COUNTS_ON", "TAKES_AWAY"}
    assert (right.id, right.status, right.points, right.diagnosis) == ("colours", Status.PASS, 1.0, None)


def test_the_best_attempt_counts_and_a_seed_counts_once(bank):
    verdict = grade_quiz(bank, [attempt(bank, 5, wrong=2), attempt(bank, 5), attempt(bank, 6, wrong=1)])
    assert verdict.score == 1.0
    assert verdict.warnings == ("Best of 3 attempts, 1 of them with questions already seen.",)


def change(record, **changes):
    return [{**record, **changes}]


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda r: change(r, score=2), "claims 2 of 2, and its answers score 1"),
        (lambda r: change(r, score=0), "claims 0 of 2, and its answers score 1"),
        (lambda r: change(r, questions=["colours"]), "not about the questions of this quiz: sums"),
        (lambda r: change(r, questions=["colours", "colours"]), "not about the questions"),
        (lambda r: change(r, questions=["colours", "sums", "sums"]), "not about the questions of this quiz."),
        (
            lambda r: change(r, questions=["colours", "shapes"]),
            "not about the questions of this quiz: shapes, sums",
        ),
        (lambda r: change(r, answers={"sums": r["answers"]["sums"]}), "no answer to colours"),
        (
            lambda r: change(r, answers={**r["answers"], "shapes": "round"}),
            "answers shapes, which was not asked",
        ),
        (lambda r: change(r, answers={**r["answers"], "sums": "b"}), "with 'b', which seed 5 does not offer"),
        (lambda r: change(r, answers={**r["answers"], "colours": "purple"}), "which seed 5 does not offer"),
        (lambda r: change(r, seed=-1), "malformed"),
        (lambda r: change(r, seed=MAX_SEED + 1), "malformed"),
        (lambda r: change(r, seed=True), "malformed"),
        (lambda r: change(r, seed=5.0), "malformed"),
        (lambda r: change(r, seed="5"), "malformed"),
        (lambda r: change(r, score=10**30), "malformed"),
        (lambda r: change(r, extra=1), "malformed"),
        (lambda r: change(r, version="1" * 1000), "malformed"),
        (lambda r: change(r, answers=[]), "malformed"),
        (lambda r: change(r, answers={"sums": None, "colours": "a"}), "malformed"),
        (lambda r: change(r, answers={"../../x": "a"}), "malformed"),
        (lambda r: change(r, questions=["sums\ud800", "colours"]), "malformed"),
        (lambda r: change(r, questions=["a"] * 101), "malformed"),
        (lambda r: [{key: value for key, value in r.items() if key != "seed"}], "malformed"),
        (lambda r: [r] * (progress.MAX_RECORDS + 1), "malformed"),
        (lambda r: r, "malformed"),
        (lambda r: [r, None], "malformed"),
        (lambda r: None, "malformed"),
        (lambda r: "x", "cannot be scored. x."),
        (lambda r: 3, "malformed"),
        (lambda r: [[[]]], "malformed"),
        (lambda r: {"a": r}, "malformed"),
    ],
)
def test_a_record_that_does_not_hold_together_is_ungradable(bank, spoil, said):
    record = spoil(attempt(bank, 5, wrong=1))
    with pytest.raises(UngradableError) as caught:
        score_record(bank, record)
    assert said in caught.value.message
    verdict = grade_quiz(bank, record)
    assert verdict.error.code == "quiz_record_inconsistent"
    assert (verdict.state, verdict.score, verdict.max_score, verdict.checks) == ("ungradable", 0.0, 2.0, ())
    assert not verdict.passed
    # What ends up in reports is text that every format can hold.
    assert (verdict.error.message + verdict.error.help).isprintable()
    assert verdict.error.message.isascii()


def test_one_bad_attempt_among_good_ones_spoils_the_record(bank):
    good, bad = attempt(bank, 5), {**attempt(bank, 6, wrong=1), "score": 2}
    with pytest.raises(UngradableError, match="Attempt 2 of the quiz claims 2"):
        score_record(bank, [good, bad])


def test_the_help_names_the_version_of_the_attempt(bank):
    with pytest.raises(UngradableError) as caught:
        score_record(bank, change(attempt(bank, 5), score=1, version="0.9\x1b[31m"))
    assert "version '0.9\\x1b[31m' of the course" in caught.value.help


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=20,
)


@given(data=st.data())
def test_whatever_a_record_is_it_is_scored_or_refused(data):
    record = data.draw(JSON)
    assert len(record_sha256(record)) == 64
    if record == []:
        return
    with pytest.raises(UngradableError):
        score_record(Bank(()), record)


@given(data=st.data())
def test_an_honest_record_with_anything_in_one_place_is_scored_or_refused(bank, data):
    record = attempt(bank, data.draw(st.integers(0, MAX_SEED)), data.draw(st.integers(0, 2)))
    key = data.draw(st.sampled_from(sorted(record)))
    record[key] = data.draw(JSON)
    verdict = grade_quiz(bank, [record])
    if verdict.error is None:
        assert verdict.score == record["score"]
    else:
        assert verdict.error.code == "quiz_record_inconsistent"


def test_a_digest_depends_on_the_answers_and_not_on_their_order(bank):
    record = attempt(bank, 5)
    turned = dict(reversed(list(record.items())))
    assert record_sha256([record]) == record_sha256([turned])
    assert record_sha256([record]) != record_sha256(change(record, score=1))


def test_another_question_file_is_another_grader(quiz, bank):
    path = quiz / "sums.toml"
    assert quiz_version(Bank(read_questions(quiz))) == quiz_version(bank)
    path.write_text(path.read_text() + "\n# changed\n")
    assert quiz_version(Bank(read_questions(quiz))) != quiz_version(bank)


def test_a_fault_of_the_questions_is_no_fault_of_the_student(quiz):
    path = quiz / "sums.toml"
    path.write_text(path.read_text().replace('formula = "a + 1"', 'formula = "a + b"'))
    bank = Bank(read_questions(quiz))
    seed = next(seed for seed in range(99) if bank.variant("sums", seed) == "numbers")
    record = {
        "seed": seed,
        "version": "1",
        "finished_at": "",
        "questions": ["sums", "colours"],
        "answers": {"sums": "total", "colours": "white"},
        "score": 2,
    }
    verdict = grade_quiz(bank, [record])
    assert verdict.state == "grader_error"


# -- the audit -------------------------------------------------------------------------------------------


def audited(quiz):
    """As much of a course is there as the audit of the quiz looks at."""
    root = quiz.parent
    content = Content(root=root, exercises=root / "exercises", lessons=root, quiz=quiz)
    findings = Findings(root)
    audit_quiz(SimpleNamespace(content=content, lesson_ids=lambda: ("adding",)), findings)
    return [f"{problem.where} {problem.message}" for problem in findings.sorted()]


def test_the_audit_wants_four_variants(quiz):
    assert audited(quiz) == [
        "quiz/colours.toml:1 question colours has 2 variants, and needs 4.",
        "quiz/sums.toml:1 question sums has 2 variants, and needs 4.",
    ]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('title = "Sums"', 'title = "Sums"\nlesson = "subtracting"', "the id does not exist"),
        (
            'takes-away = "A',
            'takes-two = "B"\ntakes-away = "A',
            "no option is tied to the misconception takes-two",
        ),
        ('source = "Somebody 2001"', 'source = "Somebody"', "the source of variant apples has no date"),
        ('formula = "a + 1"', 'formula = "a + b"', "too close to tell apart"),
        ('title = "Sums"', 'title = "<<FILL IN: a title>>"', "still to be filled in: a title"),
        ('title = "Sums"', "", "lacks the key `title`"),
    ],
)
def test_the_audit_finds(quiz, old, new, said):
    path = quiz / "sums.toml"
    path.write_text(path.read_text().replace(old, new))
    assert any(said in problem and problem.startswith("quiz/sums.toml") for problem in audited(quiz))


def test_the_audit_keeps_the_name_of_the_quiz_free(quiz):
    (quiz.parent / "exercises" / "quiz").mkdir(parents=True)
    assert any("an exercise is called quiz" in problem for problem in audited(quiz))
