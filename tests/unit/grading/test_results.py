"""The one reader of a gradebook: newest grading, override, lateness, faults of ours."""

import datetime as dt
import re

import msgspec
import pytest

from course.errors import MissingCapabilityError, NotFoundError, UsageError
from course.grading.gradebook.records import Result, SubmittedAt
from course.grading.results.effective import Results, lift, override
from course.grading.results.late import lateness, parse_policy, read_policy, read_times, unknown_names
from tests.unit.grading.made import BROKEN, HALF, REFUSED, RIGHT, WRONG, digest, key, make_book, roster_of

DUE = dt.datetime(2026, 12, 1, 23, 59, tzinfo=dt.UTC)
HOUR, DAY = 3600.0, 86_400.0
POLICY = """
format_version = 1
grace_minutes = 15
percent_per_day = 10
at_most_percent = 50
closed_after_days = 7
[[deadline]]
exercise = "doubling"
due = 2026-12-01T23:59:00Z
[[extension]]
student = "bob"
days = 2
"""


def policy(**changes):
    return msgspec.structs.replace(parse_policy(POLICY), **changes)


def hand_in(book, student, late, source="gradescope"):
    book.add_times([SubmittedAt(student, "doubling", digest(student), source, DUE.timestamp() + late)])


def test_the_newest_grading_counts_and_its_state_is_kept_apart(tmp_path):
    with make_book(tmp_path, {"ada": WRONG, "cy": REFUSED, "dan": BROKEN}) as book:
        book.add(Result(key("ada", version="v2"), RIGHT))
        found = {item.student: item for item in Results(book).all()}
    assert (found["ada"].score, found["ada"].passed) == (10.0, True)
    assert (found["cy"].score, found["cy"].passed, found["cy"].max_score) == (0.0, False, 10.0)
    assert (found["dan"].score, found["dan"].raw_score, found["dan"].passed) == (None, None, False)


def test_an_override_counts_in_place_of_what_is_graded_before_and_after(tmp_path):
    with make_book(tmp_path, {"ada": WRONG, "dan": BROKEN}) as book:
        now = override(Results(book), "ada", "doubling", 8.5, "  oral exam ")
        assert (now.score, now.raw_score, now.passed) == (8.5, 0.0, True)
        book.begin_run("rerun", {})
        book.add(Result(key("ada", version="v2"), HALF))
        (found,) = Results(book).all("ada")
        assert (found.score, found.raw_score, found.passed) == (8.5, 5.0, True)
        assert (found.override.reason, bool(found.override.at)) == ("oral exam", True)
        for score in (-0.0, 3):
            assert str(override(Results(book), "dan", "doubling", score, "our fault").score) == str(
                abs(float(score))
            )
        lifted = lift(Results(book), "ada", "doubling", "")
        assert (lifted.score, lifted.override) == (5.0, None)


def test_a_score_can_be_set_where_nothing_was_handed_in(tmp_path):
    with make_book(tmp_path, {"ada": RIGHT}) as book:
        now = override(Results(book), "ada", "halving", 2, "on paper")
        assert (now.score, now.max_score, now.passed) == (2.0, 2.0, True)
        assert now.verdict.error.code == "not_submitted"
        assert [item.exercise for item in Results(book).all("ada")] == ["doubling", "halving"]
        assert lift(Results(book), "ada", "halving", "") is None
        assert [item.exercise for item in Results(book).all("ada")] == ["doubling"]


def test_an_impossible_override_changes_nothing(tmp_path):
    with make_book(tmp_path, {"ada": RIGHT}) as book:
        for score in (10.5, -1.0, float("nan")):
            with pytest.raises(UsageError) as caught:
                override(Results(book), "ada", "doubling", score, "x")
            assert caught.value.code == "impossible_score"
        with pytest.raises(NotFoundError) as missing:
            override(Results(book), "ada", "nothing", 1.0, "x")
        assert missing.value.code == "exercise_not_found"
        assert book.overrides() == []
        with pytest.raises(NotFoundError, match="no override"):
            lift(Results(book), "ada", "doubling", "")


@pytest.mark.parametrize(
    ("late", "score"),
    [
        (-HOUR, 10.0),
        (0.5, 10.0),
        (15 * 60.0, 10.0),
        (15 * 60.0 + 1, 9.0),
        (DAY, 9.0),
        (DAY + 1, 8.0),
        (4.5 * DAY, 5.0),
        (6.5 * DAY, 5.0),
        (7 * DAY + 1, 0.0),
    ],
)
def test_lateness_costs_what_the_policy_says_and_never_touches_the_checks(tmp_path, late, score):
    with make_book(tmp_path, {"ada": RIGHT}) as book:
        hand_in(book, "ada", late)
        (before,) = Results(book).all()
        book.set_meta(late_policy=POLICY)
        (found,) = Results(book).all()
        override(Results(book), "ada", "doubling", 9.5, "ill")
        (by_hand,) = Results(book).all()
    assert (before.score, before.late, before.penalty) == (10.0, None, 0.0)
    assert (found.score, found.raw_score, found.penalty) == (score, 10.0, 10.0 - score)
    assert found.late == (late if late >= 1 else None)
    assert found.passed == (score >= 7)
    assert (by_hand.score, by_hand.penalty, by_hand.late) == (9.5, 0.0, found.late), "it is final"


def test_extensions_of_policy_and_roster_give_more_time(tmp_path):
    roster = roster_of(tmp_path, "student,extension_days\nada,\nbob,1\ncy,3.5\n")
    with make_book(tmp_path / "out", {"ada": RIGHT, "bob": RIGHT, "cy": RIGHT}) as book:
        for student in ("ada", "bob", "cy"):
            hand_in(book, student, 3 * DAY)
        book.set_meta(late_policy=POLICY)
        late = {item.student: item.late for item in Results(book, roster).all()}
        assert late == {"ada": 3 * DAY, "bob": DAY, "cy": None}
        book.set_meta(roster=roster.dump())
        assert {item.student: item.late for item in Results(book).all()} == late


def test_only_trusted_witnesses_make_anybody_late(tmp_path):
    with make_book(tmp_path, {"ada": RIGHT}) as book:
        hand_in(book, "ada", 3 * DAY, "mtime")
        book.set_meta(late_policy=POLICY)
        (found,) = Results(book).all()
        assert (found.late, found.submitted_at) == (None, None)
        book.set_meta(late_policy='trust = ["list", "mtime"]\n' + POLICY)
        (found,) = Results(book).all()
        assert (found.late, found.witness) == (3 * DAY, "mtime")
        book.add_times([SubmittedAt("ada", "doubling", "", "list", DUE.timestamp())])
        (found,) = Results(book).all()
        assert (found.late, found.witness) == (None, "list")


def test_the_time_of_another_version_is_not_this_ones(tmp_path):
    with make_book(tmp_path, {"ada": RIGHT}) as book:
        book.add_times([SubmittedAt("ada", "doubling", "f" * 64, "gradescope", DUE.timestamp() + DAY)])
        book.add_times([SubmittedAt("ada", "doubling", digest("ada"), "canvas-late", None)])
        book.set_meta(late_policy=POLICY)
        (found,) = Results(book).all()
    assert (found.late, found.flagged_late) == (None, True)


def test_points_a_day_and_percent_of_the_score_are_other_ways_to_count():
    points = policy(percent_per_day=0.0, points_per_day=1.5, at_most_percent=100.0)
    assert points.penalty(2 * DAY, 8.0, 10.0) == 3.0
    assert points.penalty(6 * DAY, 8.0, 10.0) == 8.0
    assert policy(of="score").penalty(2 * DAY, 5.0, 10.0) == 1.0
    assert policy().penalty(2 * DAY, 5.0, 10.0) == 2.0
    assert policy().penalty(None, 5.0, 10.0) == 0.0
    assert lateness(10.0, 10.0) is None


@pytest.mark.parametrize(
    "text",
    [
        "format_version = 1",
        "format_version = 1\n[[deadline]]\nexercise = 'x'\ndue = 2026-12-01T23:59:00",
        "format_version = 1\npercent_per_day = -1\n[[deadline]]\nexercise='x'\ndue = 2026-12-01T23:59:00Z",
        "format_version = 1\npercent_a_day = 1\n[[deadline]]\nexercise='x'\ndue = 2026-12-01T23:59:00Z",
        "format_version = 1\ntrust = ['student']\n[[deadline]]\nexercise='x'\ndue = 2026-12-01T23:59:00Z",
        POLICY + "[[deadline]]\nexercise = 'doubling'\ndue = 2027-12-01T23:59:00Z",
        POLICY.replace("grace", "points_per_day = 1\ngrace"),
        "= no toml",
    ],
)
def test_what_is_no_policy_is_refused_with_the_reason(tmp_path, text):
    with pytest.raises(UsageError) as caught:
        parse_policy(text, "late.toml")
    assert caught.value.code == "invalid_policy"
    assert re.match(r"late\.toml(:[0-9]+)?: ", caught.value.message)
    assert "`$" not in caught.value.message, "in the words of what reads it, and no line"
    assert "deadline" in text or "Add a table `[[deadline]]`." in caught.value.help or text == "= no toml"
    with pytest.raises(UsageError, match="cannot be read"):
        read_policy(tmp_path / "none.toml")
    with pytest.raises(MissingCapabilityError, match="newer format"):
        parse_policy("format_version = 2")


def test_names_a_policy_has_and_the_gradebook_has_not_are_listed():
    assert unknown_names(parse_policy(POLICY), {"halving": 1}, {"ada"}) == [
        "exercise doubling",
        "student bob",
    ]
    assert unknown_names(parse_policy(POLICY), {"doubling": 1}, {"bob"}) == []


def test_a_list_of_times_is_read_to_the_second(tmp_path):
    path = tmp_path / "times.csv"
    text = "student,exercise,submitted_at\nada,doubling,2026-12-02T01:00:00+01:00\n"
    for sep in ",;":
        path.write_text(text.replace(",", sep), "utf-8")
        assert [(time.student, time.at) for time in read_times(path)] == [("ada", DUE.timestamp() + 60)]
    bad = [text.replace("2026-12-02T01:00:00+01:00", at) for at in ("2026-12-02T01:00:00", "yesterday", "")]
    again = "ada,doubling,2026-12-03T01:00:00+01:00\n"
    sheet = "Identifier,Last modified (submission)\nParticipant 1,x\nParticipant 2,-\nTeilnehmer/in1,y\n"
    for wrong, line in (*((one, "line 2") for one in bad), (text + '"bob', "line 3"),
                       (text + again, "on lines 2 and 3"), (sheet, "on lines 2 and 4")):  # fmt: skip
        path.write_text(wrong, "utf-8")
        with pytest.raises(UsageError, match=line):
            read_times(path)
