"""What a student sees at home alone: the line that hangs, soon, and what the file prints."""

import contextlib
import signal
from pathlib import Path

import pytest

from course.authoring.exercises.files import due
from course.catalog import models
from course.catalog.load import Catalog
from course.isolation.failures import StudentFailure
from course.isolation.levels import Deadline, Level
from course.isolation.session import Connection
from course.isolation.spawn import spawner
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission, Terms
from tests.contracts.boundary.levels import require_level

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGUSR1"), reason="a worker cannot be asked here")

MINI = Path(__file__).resolve().parents[2] / "fixtures" / "mini_course"
SOLUTION = (MINI / "solutions" / "doubling" / "doubling.py").read_text("utf-8")
HANGS = "\ndef double(x):\n    total = 0\n    while total >= 0:\n        total += helper(x)\n"
HELPER = "\ndef helper(x):\n    for i in range(9):\n        x = i\n    return x\n"


#: In place of ``models.QUICK``, in s: each program that hangs here is waited for.
QUICK = 0.02


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    assert models.QUICK > QUICK
    monkeypatch.setattr(models, "QUICK", QUICK)


@pytest.fixture(scope="module")
def home():
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COURSE_CONTENT", str(MINI))
        catalog = Catalog()
        session = GradingSession(catalog.exercise("doubling"), catalog, terms=Terms(home=True, timeout=3.0))
    with session:
        yield session


@pytest.fixture
def deadlines(monkeypatch):
    """How long each load and each check may take, in s of CPU time."""
    made = []

    def noted(seconds, wall=None):
        made.append(seconds)
        return Deadline(seconds, wall)

    monkeypatch.setattr("course.scoring.remote.Deadline", noted)
    return made


def line_of(source, text):
    return source.splitlines().index(text) + 1


def hung(session, source):
    verdict = session.grade(Submission({"doubling.py": source.encode()}))
    return [check for check in verdict.checks if check.status == "timeout"]


def test_the_finding_names_the_loop_and_not_what_the_loop_calls(home, deadlines):
    source = SOLUTION + HELPER + HANGS
    first = hung(home, source)[0]
    assert deadlines[0] == 20 * QUICK, "at home a file may load for as long as a quick check may run"
    assert f"in the loop that begins on line {line_of(source, '    while total >= 0:')}" in first.message
    assert (first.traceback or "").startswith("doubling.py:")
    assert (first.diagnosis, first.actual) == ("TIMEOUT", None)


def test_what_sleeps_is_named_by_its_line(home):
    source = SOLUTION + "\ndef double(x):\n    import time\n    time.sleep(1000)\n"
    assert f"on line {line_of(source, '    time.sleep(1000)')} of your file" in hung(home, source)[0].message


def test_patience_follows_from_measured_times_and_shrinks_after_the_first(deadlines):
    catalog = Catalog()
    exercise = catalog.exercise("integrators")
    source = b"def explicit_euler_step(accel, t, q, v, h):\n    while True:\n        pass\n"
    with GradingSession(exercise, catalog, terms=Terms(home=True)) as session:
        verdict = session.grade(Submission({exercise.module: source}))
        _, *each = deadlines  # the first is for loading
        allowed = dict(zip(session.took, each, strict=True))
    spent = [allowed[check.id] for check in verdict.checks if check.status == "timeout"]
    assert spent == [20 * QUICK, 5 * QUICK]


def test_a_check_that_takes_its_time_of_a_right_solution_is_waited_for():
    exercise = Catalog().exercise("sim-to-real")
    slow = exercise.slow["tune_other_fleets"]
    assert slow > 2 * QUICK
    assert exercise.patience("tune_other_fleets", False) == pytest.approx(20 * slow)


def test_a_grading_run_waits_its_time_and_asks_nothing(deadlines, monkeypatch):
    monkeypatch.setenv("COURSE_CONTENT", str(MINI))
    catalog = Catalog()
    terms = Terms(timeout=0.2)
    with GradingSession(catalog.exercise("doubling"), catalog, scope="full", terms=terms) as session:
        found = hung(session, SOLUTION + HELPER + HANGS)
    assert deadlines[0] == 0.2
    assert found
    assert {(check.message, check.traceback) for check in found} == {
        ("Your code had not answered when the time was up.", None)
    }


def test_a_module_that_hangs_while_it_loads_is_named_by_its_line(home):
    error = home.grade(Submission({"doubling.py": b"x = 1\nwhile x:\n    x += 1\n"})).error
    assert error.code == "import_timeout"
    assert error.message.startswith("doubling.py, line 2: ")
    assert "The loop that begins on that line was still running." in error.message


@pytest.mark.parametrize("level", list(Level))
def test_every_level_can_be_asked(level):
    require_level(level)
    source = b"def f():\n    while True:\n        pass\n"
    with contextlib.closing(spawner(level, ("numpy",))) as made:
        worker = Connection(made, {"a.py": source}, "a.py", Deadline(10), asks=True)
        worker.deadline = Deadline(0.2)
        with pytest.raises(StudentFailure) as failure:
            worker.call("f")
    assert (failure.value.kind, failure.value.type, failure.value.line) == ("timeout", "loop", 2)


@pytest.mark.parametrize(
    "code",
    [
        "import signal; signal.signal(signal.SIGUSR1, signal.SIG_IGN)",
        "import os; os.write(3, b'x' * 100)",
        "import os; os.write(3, b'\\x06\\x00\\x00\\x00\\x15' + b'\\xff' * 5)",
    ],
)
def test_a_worker_that_tells_nothing_true_is_a_timeout_all_the_same(home, code):
    source = SOLUTION + f"\ndef double(x):\n    {code}\n    while True:\n        pass\n"
    verdict = home.grade(Submission({"doubling.py": source.encode()}))
    assert {check.status for check in verdict.checks if check.task == "double"} <= {"timeout", "crash"}
    assert all("line 9" not in check.message for check in verdict.checks)


def test_times_are_written_in_tenths_and_stay_while_they_are_about_right():
    assert due({}, {"quick": 0.02, "slow": 0.31}) == {"slow": 0.4}
    assert due({"slow": 0.4}, {"slow": 0.17}) == {"slow": 0.4}
    assert due({"slow": 0.4}, {"slow": 0.41}) == {"slow": 0.5}
    assert due({"slow": 0.4, "gone": 0.2}, {"slow": 0.01}) == {}


def test_prints_while_loading_and_in_checks_that_pass_are_kept(home):
    prints = "\n_old = double\ndef double(x):\n    print(x)\n    return _old(x)\nprint('loaded')\n"
    verdict = home.grade(Submission({"doubling.py": (SOLUTION + prints).encode()}))
    assert (verdict.all_pass, home.printed) == (True, "loaded\n")
    assert [check.stdout for check in verdict.checks] == ["3.0\n", None]
    home.grade(Submission({"doubling.py": (SOLUTION + prints + "1 / 0\n").encode()}))
    assert home.printed == "loaded\n"
    home.grade(Submission({"doubling.py": SOLUTION.encode()}))
    assert home.printed == ""


def test_a_worker_that_starts_again_prints_what_loading_prints_once(home):
    source = SOLUTION + "\ndef double(x):\n    import os\n    os._exit(1)\nprint('loaded')\n"
    verdict = home.grade(Submission({"doubling.py": source.encode()}))
    assert home.printed == "loaded\n"
    assert [(check.status.value, check.stdout) for check in verdict.checks] == [
        ("crash", None),
        ("pass", None),
    ]


def test_what_is_said_of_a_file_is_of_its_first_loading(home):
    """By the second its code has received inputs, and might put them into the words."""
    clock = (
        "import os, time\n\ndef made():\n    raise ValueError(time.monotonic_ns())\n\n"
        "other = made()\n\ndef double(x):\n    os._exit(3)\n"
    )

    def words(remote):
        said = []
        for name in ("other", "double", "other"):
            with pytest.raises(StudentFailure) as caught:
                remote.call(name, 1.0)
            said.append(caught.value.why.message if caught.value.why else caught.value.kind)
        return said

    first, crashed, second = home.using(Submission({"doubling.py": clock.encode()}), words)
    assert (crashed, second) == ("crash", first)
    assert first.isdigit()
