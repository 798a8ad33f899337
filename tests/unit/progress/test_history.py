"""What the events add up to: when a hint is due, its numbers, the mistakes made, and where a student is."""

from datetime import UTC, datetime, timedelta

import pytest

from course.catalog.load import Catalog
from course.cli.frame import app
from course.errors import IntegrityError
from course.handed_in.attempts import Attempt, numbers_of
from course.progress.history import Standing, fingerprint, history_of, mistakes_of
from course.progress.store import Event, Store
from course.progress.workspace import Workspace
from course.scoring.verdict import CheckResult, Status, Verdict, Visibility

STUB = fingerprint(b"def double(x):\n    raise NotImplementedError\n")
FIRST = fingerprint(b"def double(x):\n    return x\n")
SECOND = fingerprint(b"def double(x):\n    return 3 * x\n")


def _history(*events):
    now = datetime(2025, 1, 1, tzinfo=UTC)
    return history_of(
        Event(id=number, at=now, kind=kind, subject="doubling", data=data)
        for number, (kind, data) in enumerate(events, start=1)
    )


def _check(code, status="fail", **fields):
    score = 2.0 if status == "pass" else 0.0
    checks = [{"id": "double_of_three", "task": "double", "status": status}]
    data = {"state": "graded", "score": score, "max_score": 2.0, "passed": status == "pass"}
    return ("check", {**data, "fingerprint": code, "checks": checks, **fields})


#: A hint that was given for FIRST.
_HINT = ("hint", {"task": "double", "index": 0, "fingerprint": FIRST})

#: What happened -> the events, and whether the next hint is due.
HINTS = {
    "nothing": ([], False),
    "a check of the untouched stub": ([_check(STUB)], False),
    "a failed check of changed code": ([_check(FIRST)], True),
    "a hint, and the same code again": ([_check(FIRST), _HINT, _check(FIRST)], False),
    "a hint, and code changed since": ([_check(FIRST), _HINT, _check(SECOND)], True),
    "other code, but before the last hint": ([_check(SECOND), _check(FIRST), _HINT], False),
    "a check that passed": ([_check(FIRST, status="pass")], False),
    "a check that passed, and the stub again": ([_check(FIRST, status="pass"), _check(STUB)], False),
    "a file that could not run": ([_check(FIRST, state="ungradable", checks=[])], False),
}


@pytest.mark.parametrize("what", HINTS)
def test_a_hint_is_due_after_a_failed_check_of_code_changed_since_the_last_one(what):
    events, due = HINTS[what]
    history = _history(*events)
    assert history.hint_is_due(STUB) is due
    assert history.hints_for("double") == tuple(data["index"] for kind, data in events if kind == "hint")


@pytest.mark.parametrize("odd", ["abc", None, [1], float("nan"), {}])
def test_a_number_that_somebody_overwrote_stops_nobody(odd):
    (run,) = _history(_check(FIRST, score=odd, max_score=odd, seconds=odd)).runs
    assert (run.score, run.max_score, run.seconds) == (0.0, 0.0, 0.0)


def test_a_check_run_alone_corrects_the_last_whole_run_and_leaves_its_score():
    history = _history(_check(FIRST), _check(SECOND, status="pass", only="double_of_three"))
    assert history.failing_tasks() == frozenset()
    assert history.last_graded.score == 0.0
    assert history.first_pass is None


@pytest.mark.parametrize(
    "other",
    [
        b"def double(x):\n    return x  # now with a comment\n",
        b"def double(x):\r\n\r\n    return  x\r\n",
        b"\xef\xbb\xbfdef double(x):\n    return x\n",
        b'"""What this is about."""\n\npass\ndef double(x):\n    return x\n',
    ],
)
def test_comments_and_layout_are_no_attempt(other):
    assert fingerprint(other) == FIRST


def test_the_order_of_functions_is_no_attempt_but_any_change_of_one_is():
    other = b"def halve(x):\n    return x / 2\n"
    both = b"def double(x):\n    return x\n"
    assert fingerprint(both + other) == fingerprint(other + both)
    assert fingerprint(both + other) != fingerprint(both)
    assert fingerprint(both + other) != fingerprint(both + other.replace(b"2", b"3"))
    # Of two definitions the last counts, and of two assignments, too.
    assert fingerprint(both + both.replace(b"x\n", b"1\n")) != fingerprint(
        both.replace(b"x\n", b"1\n") + both
    )
    assert fingerprint(b"x = 1\nx = 2\n") != fingerprint(b"x = 2\nx = 1\n")


@pytest.mark.parametrize("source", [b"def double(x:\n", b"\x00", b"\xff\xfe", b"(" * 100_000, b'"\\d"\n'])
def test_a_file_that_does_not_parse_has_a_fingerprint_too(source):
    assert fingerprint(source) != fingerprint(source + b"1\n")


def test_records_with_missing_fields_are_understood():
    history = _history(("check", {}), ("hint", {}), ("start", {}))
    assert history.last.score == 0.0
    assert history.failing_tasks() == frozenset()


NOW = datetime(2025, 1, 1, tzinfo=UTC)


def failed(expected=None, actual=None, **fields):
    usual = {
        "id": "reach", "title": "", "task": "throw", "status": Status.FAIL, "visibility": Visibility.PUBLIC,
        "points": 0.0, "max_points": 1.0, "expected": expected, "actual": actual,
    }  # fmt: skip
    return CheckResult(**(usual | fields))


def recorded(*checks):
    """What ``course check`` writes down."""
    verdict = Verdict(
        exercise="throwing", scope="public", state="graded", score=0.0, max_score=1.0, passed=False,
        checks=checks, isolation="L1",
    )  # fmt: skip
    return Attempt(None, b"", verdict, 0.1).data("1")


@pytest.mark.parametrize(
    ("expected", "got", "fields"),
    [
        (4.5, 3.75, {"expected": "4.5", "got": "3.75", "off": "-0.75", "ratio": "0.8333"}),
        (2.0, 2.00000001, {"expected": "2", "got": "2.00000001", "off": "+1e-08"}),
        (30, 29, {"expected": "30", "got": "29", "off": "-1", "ratio": "0.9667"}),
        (0.0, 1.0, {"expected": "0", "got": "1", "off": "+1"}),
        (2.0, -0.0, {"expected": "2", "got": "0", "off": "-2"}),
        (1.0, float("inf"), {"expected": "1", "got": "inf"}),
        (True, False, {"expected": "True", "got": "False"}),
        ([1.0, 2], [1.0, 3], {"expected": "[1, 2]", "got": "[1, 3]"}),
        (
            {"q[2]": 0.5},
            {"q[2]": 1.0},
            {"expected": "0.5", "got": "1", "off": "+0.5", "ratio": "2", "at": "q[2]"},
        ),
        ({"at most": 0.03}, 2.0, {"expected": "at most 0.03", "got": "2"}),
        (None, 3.0, {"got": "3"}),
        (3.0, None, {"expected": "3"}),
        (list(range(9)), 1, {"got": "1"}),
        ("a result", "ValueError: " + 40 * "x", {"expected": "a result"}),
        (1, 10**400, {"expected": "1"}),
        (None, None, {}),
    ],
)
def test_values_are_written_for_a_sentence_or_left_out(expected, got, fields):
    assert numbers_of(failed(expected, got)) == fields


def test_inputs_are_fields_by_their_names():
    given = {"h": 1 / 30, "q0": [1e7, 1e7 + 0.3], "path": list(range(50))}
    found = numbers_of(failed(2.0, 1.0, input=given))
    assert found == {
        "h": "0.03333",
        "q0": "[10000000, 10000000.3]",
        "expected": "2",
        "got": "1",
        "off": "-1",
        "ratio": "0.5",
    }


@pytest.mark.parametrize("other", [{"visibility": Visibility.HIDDEN}, {"status": Status.PASS}])
def test_nothing_is_told_of_a_hidden_check_or_of_one_that_passed(other):
    check = failed(2.0, 1.0, input={"h": 0.05}, **other)
    assert numbers_of(check) == {}
    assert "numbers" not in recorded(check)["checks"][0]


@pytest.mark.parametrize("odd", ["abc", 3, None, [1]])
def test_a_record_that_somebody_changed_has_no_numbers(odd):
    data = recorded(failed(2.0, 1.0))
    data["checks"][0]["numbers"] = odd
    history = history_of([Event(id=1, at=NOW, kind="check", subject="throwing", data=data)])
    assert history.diagnosed("throw") == (("", {}),)


START = datetime(2026, 11, 22, 10, tzinfo=UTC)


def run(minute, *checks, subject="integrators"):
    """(id, status, diagnosis) of each check of one function."""
    results = [
        failed(id=name, task="step", status=status, diagnosis=diagnosis) for name, status, diagnosis in checks
    ]
    return Event(minute, START + timedelta(minutes=minute), "check", subject, recorded(*results))


def test_a_mistake_has_its_first_and_last_run_and_the_one_that_mended_it():
    (one,) = mistakes_of(
        [
            run(1, ("order", "fail", "SWAPPED"), ("energy", "fail", "SWAPPED")),
            run(2, ("order", "fail", "SWAPPED"), ("energy", "pass", None)),
            run(3, ("order", "pass", None), ("energy", "pass", None)),
            run(4, ("order", "pass", None), ("energy", "pass", None)),
        ]
    )
    assert (one.exercise, one.task, one.diagnosis, one.runs) == ("integrators", "step", "SWAPPED", 2)
    minutes = [(at - START).seconds // 60 for at in (one.first, one.last, one.mended)]
    assert minutes == [1, 2, 3]


@pytest.mark.parametrize(
    ("later", "found"),
    [
        ([run(2, ("order", "fail", "SIGN"))], [("SWAPPED", 1), ("SIGN", 1)]),
        ([run(2, ("order", "pass", None)), run(3, ("order", "fail", "SWAPPED"))], [("SWAPPED", 2)]),
        ([run(2, ("order", "pass", None), subject="other")], [("SWAPPED", 1)]),
        ([run(2, ("order", "skip", None))], [("SWAPPED", 1)]),
    ],
    ids=["another failure of its check", "made again", "a check of that name elsewhere", "skipped"],
)
def test_what_mends_no_mistake(later, found):
    mistakes = mistakes_of([run(1, ("order", "fail", "SWAPPED")), *later])
    assert [(one.diagnosis, one.runs) for one in mistakes] == found
    assert {one.mended for one in mistakes} == {None}


@pytest.mark.parametrize(
    ("later", "named"),
    [
        ([("order", "fail", None), ("energy", "fail", "SIGN")], False),
        ([("order", "fail", "SWAPPED"), ("energy", "pass", None)], True),
        ([("order", "fail", None)], True),
        ([("order", "skip", None), ("energy", "skip", None)], True),
    ],
    ids=["all fail otherwise", "one shows it again", "one was not run", "none could run"],
)
def test_a_mistake_is_named_while_the_newest_run_of_a_check_of_it_shows_it(later, named):
    first = run(1, ("order", "fail", "SWAPPED"), ("energy", "fail", "SWAPPED"))
    one, *_ = mistakes_of([first, run(2, *later)])
    assert one.named == named
    assert one.mended is None


def test_work_to_do_and_what_follows_from_a_mistake_are_none():
    codes = ("NOT_IMPLEMENTED", "MISSING_FUNCTION", "CALLS_A_WRONG_FUNCTION")
    assert mistakes_of([run(1, *((code, "fail", code) for code in codes))]) == ()


@pytest.fixture
def workspace(tmp_path, monkeypatch):
    """A workspace of the course itself with a lesson read and an exercise begun; the current folder."""
    catalog = Catalog()
    made = Workspace.create(tmp_path / "w", catalog.course_id, catalog.version)
    monkeypatch.chdir(made.root)
    first, *_ = catalog.exercises()
    made.store.append("lesson", first.lesson)
    made.store.append("start", first.id)
    made.give(first.place, first.module, first.stub_path.read_bytes())
    return made


def test_the_record_is_read_once(workspace, monkeypatch):
    reads, connection = [], Store._connection
    monkeypatch.setattr(
        Store, "_connection", lambda self, *, create: reads.append(create) or connection(self, create=create)
    )
    for command in ((), ("progress",), ("exercises",), ("lessons",), ("next",), ("go", "--json")):
        reads.clear()
        assert (app.run(command), reads) == (0, [False]), command


def test_an_event_that_somebody_spoilt_costs_those_alone_who_need_it(workspace, monkeypatch):
    monkeypatch.setattr("course.progress.store._now", lambda: "some time")
    workspace.store.append("check", "elsewhere")
    standing = Standing(workspace)
    (name,) = standing.started
    assert standing.is_begun(name)
    assert len(standing.read) == 1
    with pytest.raises(IntegrityError, match="event 3 cannot be read"):
        standing.history("elsewhere")
    with pytest.raises(IntegrityError, match="event 3 cannot be read"):
        assert standing.quiz.best is None


@pytest.mark.parametrize(("data", "read"), [({"version": "1.2.0"}, {"a", "b"}), ({"blocks": 40}, {"a"})])
def test_who_read_a_lesson_before_it_was_parted_has_read_both(workspace, data, read):
    workspace.store.append("lesson", "a", data)
    standing = Standing(workspace, {"b": "a"})
    assert standing.read.keys() & {"a", "b"} == read
    assert {standing.read[name] for name in read} == {standing.read["a"]}
