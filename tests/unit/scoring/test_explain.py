"""From a wrong value to a named mistake: fingerprints, what a table says, and one story for a task."""

import math
from dataclasses import replace
from time import process_time
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest

from course.errors import ContentError
from course.isolation.failures import StudentFailure
from course.isolation.levels import SEARCH_S
from course.scoring.explain.fingerprint import calls_between, fingerprint, may_remember, read
from course.scoring.explain.story import (
    SAME,
    Diagnosis,
    Entry,
    Failure,
    Row,
    Story,
    Table,
    Words,
    common,
    is_right,
    matching,
    read_table,
    story_of,
    table_path,
)
from course.scoring.judging.explaining import Again, _retold, answer_numbers, tasks_asked
from course.scoring.kit import CheckFailed
from course.scoring.remote import Heard
from course.scoring.verdict import CheckResult, Divergence, Finding

WORDS = Words(
    {
        "SIGN_FLIPPED": Entry("The sign is wrong.", "Turn it."),
        "MASS_SWAPPED": Entry("The masses are swapped.", "Swap them."),
        "ENERGY_GROWS": Entry("Energy grows.", "Look for its cause.", kind="consequence"),
        "CHANGED_IN_PLACE": Entry("The caller's array is changed.", "Copy it.", kind="fact"),
        "ZERO_LENGTH": Entry("It divides by a length of zero.", "Test it.", kind="nan"),
    }
)


def guess(code):
    return WORDS(code) if code in WORDS.entries else Diagnosis(code, "", "")


def failures(*codes, finite=True):
    return [Failure(f"check_{i}", code and guess(code), finite) for i, code in enumerate(codes)]


def told(*codes, fits=(), finite=True):
    found = story_of(failures(*codes, finite=finite), fits, WORDS).diagnosis
    return found and found.code


# -- fingerprints -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(20))
def test_the_same_answers_in_another_form_order_and_rounding_have_the_same_fingerprint(seed):
    rng = np.random.default_rng(seed)
    path, flag = rng.normal(size=(40, 3)) * 10.0 ** rng.integers(-3, 6), bool(rng.integers(2))
    one = fingerprint([(path, flag, None), 2, np.float64(1.5), {"kp": 2.0, "kd": 1.0}])
    other = [[(path * (1 + 1e-12)).tolist(), np.bool_(flag), None], 2.0, 1.5, {"kd": 1.0, "kp": 2.0}]
    assert max(abs(a - b) for a, b in zip(one, fingerprint(other), strict=True)) <= SAME


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ([1.0], [1.001]),
        ([None], [0.0]),
        ([True], [1.0]),
        ([True], [False]),
        ([math.nan], [math.inf]),
        ([math.inf], [-math.inf]),
        ([[1.0, 2.0]], [[2.0, 1.0]]),
        ([[1.0]], [1.0]),
        ([{"raised": "ValueError"}], [None]),
        (["text"], [None]),
        (["bias"], ["lag"]),
        ([{"a": 1.0, "b": 2.0}], [{"a": 2.0, "b": 1.0}]),
        ([1e200], [1e201]),
        ([10**400], [1.0]),
    ],
)
def test_other_answers_have_another_fingerprint(one, other):
    pairs = zip(fingerprint(one), fingerprint(other), strict=True)
    assert any(abs(a - b) > 10 * SAME for a, b in pairs)


def test_an_exercise_may_ask_by_itself_and_give_numbers_for_each_part_of_a_task():
    module = SimpleNamespace(
        QUESTIONS={"half": [(4.0,), (6.0,)], "quarter": []},
        READ={"half": lambda value: value + 1},
        ASK={"report": lambda answer, names: {name: answer([(8.0,)]) for name in sorted(names)}},
    )

    def answer(calls):
        return [x / 2 for (x,) in calls]

    assert tasks_asked(module) == {"half", "quarter", "report"}
    assert answer_numbers(module, "half", answer) == {"half": fingerprint([3.0, 4.0])}
    assert answer_numbers(module, "half", answer, within=0.1) == {"half": (3.0, 4.0)}
    assert answer_numbers(module, "quarter", answer) == {}
    names = frozenset({"report.a", "report.b"})
    assert answer_numbers(module, "report", answer, names=names) == {"report.a": (4.0,), "report.b": (4.0,)}


# -- the table --------------------------------------------------------------------------------------------


def test_of_an_answer_counts_what_its_reader_gives_and_what_it_cannot_read_is_an_exception():
    assert read({"t": 1.0, "memory": [3]}, lambda twin: twin["t"]) == 1.0
    assert read(None, lambda twin: twin["t"]) == {"raised": "TypeError"}
    assert read({"raised": "ValueError"}, lambda twin: twin["t"]) == {"raised": "ValueError"}
    assert read([3], None) == [3]


def test_of_the_programs_that_fit_those_with_fewest_mistakes_count(tmp_path):
    rows = {"f": (Row(("A_B",), (1.0, 2.0)), Row(("A_B", "C_D"), (1.0, 2.0)), Row(("C_D",), (3.0, 2.0)))}
    table = Table(rows=rows, right={"f": ((0.0, 0.0),)}, made_from="x")
    table_path(tmp_path).write_bytes(msgspec.json.encode(table))
    assert read_table(tmp_path) == table
    assert [row.codes for row in matching(table, "f", (1.0, 2.0000005))] == [("A_B",)]
    assert matching(table, "f", (1.0, 2.00001)) == ()
    assert matching(table, "f", (1.0, 2.1)) == ()
    assert is_right(table, "f", (0.0, 0.0))
    assert not is_right(table, "f", (1.0, 2.0))


def test_answers_within_a_tolerance_are_compared_as_they_are(tmp_path):
    table = Table(rows={"f": (Row(("A_B",), (2.0, 1e300)),)}, within={"f": 0.02})
    assert matching(table, "f", (2.03, 1e300))
    assert not matching(table, "f", (2.1, 1e300))
    assert not matching(table, "f", (2.0, 5.0))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{", "diagnoses.json"),
        ('{"words": {"A_B": {"looks_like": "x", "advice": "y", "kind": "guess"}}}', "'guess'"),
    ],
    ids=["damaged", "words of no known kind"],
)
def test_what_is_no_table_is_refused_with_the_command_that_makes_it_anew(tmp_path, text, said):
    table_path(tmp_path).write_text(text, "utf-8")
    with pytest.raises(ContentError) as error:
        read_table(tmp_path)
    assert said in str(error.value)
    assert "course author build" in str(error.value.help)


# -- the story --------------------------------------------------------------------------------------------


def test_a_program_that_fits_decides_whatever_the_probes_say():
    assert told("MASS_SWAPPED", "ENERGY_GROWS", fits=(Row(("SIGN_FLIPPED",), (0.0,)),)) == "SIGN_FLIPPED"


def test_programs_that_answer_alike_are_one_and_a_probe_chooses_the_name():
    fits = Row(("SIGN_FLIPPED",), (0.0,)), Row(("MASS_SWAPPED",), (0.0,))
    assert told(None, fits=fits) == "SIGN_FLIPPED"
    assert told("MASS_SWAPPED", fits=fits) == "MASS_SWAPPED"


def test_of_programs_with_two_mistakes_what_they_share_is_named():
    fits = Row(("SIGN_FLIPPED", "MASS_SWAPPED"), (0.0,)), Row(("ENERGY_GROWS", "MASS_SWAPPED"), (0.0,))
    assert common(fits) == ("MASS_SWAPPED",)
    shared = story_of(failures(None), fits, WORDS).diagnosis
    assert shared.code == "MASS_SWAPPED"
    assert "There seem to be two mistakes" in shared.looks_like
    both = story_of(failures(None), fits[:1], WORDS).diagnosis
    assert "There seem to be two mistakes" in both.looks_like
    assert WORDS.entries["MASS_SWAPPED"].looks_like in both.looks_like


def test_a_consequence_is_said_only_where_no_cause_is():
    assert told("ENERGY_GROWS", "SIGN_FLIPPED", "ENERGY_GROWS") == "SIGN_FLIPPED"
    assert told("ENERGY_GROWS", None) == "ENERGY_GROWS"


def test_a_consequence_is_said_of_the_checks_that_saw_it_and_a_cause_of_none_that_saw_another():
    def bare(*codes):
        return story_of(failures(*codes), (), WORDS).bare

    assert bare("ENERGY_GROWS", None) == {"check_1"}
    assert bare("SIGN_FLIPPED", None, "ENERGY_GROWS") == frozenset()
    assert bare("SIGN_FLIPPED", "SIGN_FLIPPED", "MASS_SWAPPED") == {"check_2"}


def test_a_cause_is_not_said_of_a_check_whose_own_probe_did_not_find_it():
    (saw, plain), (looked,) = failures("SIGN_FLIPPED", None), [Failure("check_2", None, looked=True)]
    story = story_of([saw, plain, looked], (), WORDS)
    assert story.diagnosis.code == "SIGN_FLIPPED"
    assert story.bare == {"check_2"}
    # A program that fits is known to give these very answers.
    assert story_of([saw, looked], (Row(("SIGN_FLIPPED",), (0.0,)),), WORDS).bare == frozenset()


def test_of_several_causes_the_one_that_most_checks_name_is_told_and_of_as_many_none():
    assert told("SIGN_FLIPPED", "MASS_SWAPPED", "SIGN_FLIPPED") == "SIGN_FLIPPED"
    assert told("SIGN_FLIPPED", "MASS_SWAPPED") is None


def test_where_a_value_is_nan_only_what_makes_it_nan_is_told():
    assert told("SIGN_FLIPPED", "NOT_A_NUMBER", finite=False) == "NOT_A_NUMBER"
    assert told("ZERO_LENGTH", "ZERO_LENGTH", finite=False) == "ZERO_LENGTH"
    assert told("ZERO_LENGTH", "NOT_A_NUMBER", finite=False) == "NOT_A_NUMBER"
    assert told("SIGN_FLIPPED", finite=False) is None


def test_a_nan_is_told_where_it_was_met_and_other_checks_keep_what_they_saw():
    met, finite = failures("NOT_A_NUMBER", finite=False), failures(None, "ZERO_LENGTH", "ENERGY_GROWS")[1:]
    story = story_of([*met, *finite], (), WORDS)
    assert story.diagnosis.code == "NOT_A_NUMBER"
    assert story.bare == {"check_1", "check_2"}
    assert "check_2" in story.own
    # A wall's nan, seen by a probe beside finite numbers that are wrong.
    story = story_of(failures("ZERO_LENGTH", "ENERGY_GROWS", None), (), WORDS)
    assert story.diagnosis.code == "ZERO_LENGTH"
    assert story.bare == {"check_1", "check_2"}
    assert "check_1" in story.own


def test_a_check_that_saw_a_fact_keeps_it():
    story = story_of(failures("CHANGED_IN_PLACE", "SIGN_FLIPPED"), (), WORDS)
    assert story.own == {"check_0"}
    assert story.diagnosis.code == "SIGN_FLIPPED"


# -- which function calls which ---------------------------------------------------------------------------


def test_where_a_path_first_differs_is_said_only_by_the_check_that_saw_it():
    check = CheckResult(
        id="order", title="Order", task="rk4_step", status="fail", visibility="public", points=0, max_points=1
    )
    seen = replace(guess("SIGN_FLIPPED"), divergence=Divergence(t=2.5, step=240, quantity="q[0]"))
    failure = CheckFailed(
        Finding("The order is 1.", "Smaller steps."), None, ("The order is 1.", "Smaller steps.")
    )
    told = _retold(check, failure, Story(seen, own=frozenset()), "rk4_step", [])
    assert (told.diagnosis, told.first_divergence) == ("SIGN_FLIPPED", None)


def test_calls_are_found_through_helpers_and_later_definitions_win():
    source = b"""
def helper(x):
    return impulse(x)
def simulate(x):
    return helper(x)
def impulse(x):
    return simulate
def impulse(x):
    return x
"""
    tasks = frozenset({"simulate", "impulse", "absent"})
    assert calls_between(source, tasks) == {"simulate": ("impulse",), "impulse": ()}
    assert calls_between(b"def (", tasks) == {}
    # A file longer than any honest one: a megabyte of this becomes 700 MB of syntax tree, in the process that
    # holds what is expected.
    assert calls_between(source + b"1\n" * 50_000, tasks) == {}


# -- words ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("more", "could"),
    [
        ("", False),
        ("LIMIT, WAYS = -1e-8, (1, 'up')", False),
        ("import numpy as np\nfar = np.inf", False),
        ("known = {}", True),
        ("table = {1: 2}\ndef known(x):\n    return table[x], len(table), np.sum(table)", False),
        ("table = [1]\ndef known(x):\n    return [2 * y for y in table if y > x]", False),
        ("table = {}\ndef known(x):\n    table[x] = 1", True),
        ("table = []\ndef known(x):\n    table.append(x)", True),
        ("table = np.zeros(2)\ndef known(x):\n    np.copyto(dst=table, src=x)", True),
        ("table = np.zeros(2)\ndef known(x):\n    return table", True),
        ("(known, other) = [], 0", True),
        ("draws = np.random.default_rng(1)", True),
        ("class known:\n    last = 0", True),
        ("def known(x, seen=[]):\n    return x", True),
        ("def known(x):\n    known.last = x", True),
        ("def known(x):\n    global last\n    last = x", True),
        ("@cache\ndef known(x):\n    return x", True),
    ],
)
def test_only_what_can_change_between_two_calls_may_be_remembered(more, could):
    source = (
        f"def g(x):\n    return 2 * x\n{more}\ndef f(x):\n    return g(x), LIMIT, WAYS, far, known, draws\n"
    )
    found = may_remember(source.encode(), frozenset({"f", "g"}))
    assert found == (frozenset({"f"}) if could else frozenset())


def test_what_is_kept_between_calls_comes_first_and_a_code_of_the_exercise_names_it():
    kept = story_of(
        failures("SIGN_FLIPPED", "CHANGED_IN_PLACE"), (Row(("MASS_SWAPPED",), (1.0,)),), WORDS, kept=True
    )
    assert kept.diagnosis.code == "STATE_KEPT"
    assert kept.own == {"check_1"}
    own = Words({**WORDS.entries, "STALE_CACHE": Entry("It is stale.", "Ask again.")})
    some = [Failure("check_0", own("STALE_CACHE")), Failure("check_1", own("SIGN_FLIPPED"))]
    for seen in (True, False):
        assert story_of(some, (), own, kept=seen).diagnosis == own("STALE_CACHE")


def test_warm_ups_share_a_table_and_an_exercise_may_have_none(tmp_path):
    one, other = tmp_path / "warm-ups" / "one", tmp_path / "warm-ups" / "other"
    assert read_table(one) is None
    (tmp_path / "warm-ups").mkdir()
    table = Table(words={"A_B": Entry("It is.", "Mend it.")})
    table_path(one).write_bytes(msgspec.json.encode({"one": table}))
    assert (read_table(one), read_table(other), read_table(tmp_path / "third")) == (table, None, None)


@pytest.mark.soak
@pytest.mark.parametrize(
    "source",
    [
        "def task():\n    f0\n" + "".join(f"def f{n}(): f{n + 1}\n" for n in range(5_000)),
        "def task():\n    f0\n" + "=".join(f"f{n}" for n in range(14_000)) + "=0\n",
    ],
)
def test_a_chain_of_functions_is_followed_in_time_that_grows_with_it(source):
    """What each of thousands reaches would be the square of their number, in time and in memory."""
    start = process_time()
    assert calls_between(source.encode(), frozenset({"task"})) == {"task": ()}
    # Takes 0.3 s; 7 s and 600 MB, and over a minute, where each is followed.
    assert process_time() - start < 5.0


def test_asking_again_ends_when_its_time_is_used_up_however_often_a_worker_is_loaded():
    loaded = []

    class Remote:
        used = 0.4 * SEARCH_S  # of CPU time, to be loaded

        def __init__(self):
            loaded.append(self)

        def begin_check(self, task, patience):
            assert patience == pytest.approx(max(SEARCH_S - len(loaded) * Remote.used, 0.0))
            self.used = 0.0

        def call(self, *args):
            raise StudentFailure("error", type="ValueError")

        def close(self):
            pass

    heard = [Heard("call", ("f", 1.0), 2.0)]
    with Again(Remote) as again:
        for task in "fghijk":
            assert not again.depends_on_the_past(heard, task, 100.0)
    assert len(loaded) == 3
