"""Grading one submission: what each way of ending becomes in the verdict."""

import os
import sys
from dataclasses import replace

import msgspec
import numpy as np
import pytest

from course.catalog.load import Catalog
from course.errors import MissingCapabilityError
from course.isolation.levels import Deadline
from course.scoring import kit
from course.scoring.failures import CheckFailed
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission, Terms
from course.scoring.remote import RemoteSubmission
from course.scoring.values import plain
from course.scoring.verdict import Status, finite, for_student
from tests.contracts.boundary.levels import require_level

HANGS = b"\ndef double(x):\n    while True:\n        pass\n"


def busy_for(seconds):
    """A ``double`` that takes so much of the processor."""
    return f"""
import time
def double(x):
    end = time.process_time() + {seconds}
    while time.process_time() < end:
        pass
""".encode()


def grade(session, source):
    raw = source.encode() if isinstance(source, str) else source
    return session.grade(Submission({"doubling.py": raw}))


def test_a_function_that_never_answers_leaves_the_other_tasks_their_time(session, solution, monkeypatch):
    checks = sum(check.task == "double" for check in session.checks)
    monkeypatch.setattr("course.scoring.remote.BUDGET_S", 0.3 * checks)  # each waits for so long
    verdict = grade(session, solution + HANGS)
    assert {str(check.status) for check in results(verdict, "double")} <= {"timeout", "skipped"}
    assert {str(check.status) for check in results(verdict, "doublings")} == {"pass"}


def test_a_search_for_the_cause_takes_no_time_from_later_checks_up_to_its_own(session, solution, monkeypatch):
    allowed = []

    def noted(seconds, wall=None):
        allowed.append(seconds)
        return Deadline(seconds, wall)

    monkeypatch.setattr("course.scoring.remote.Deadline", noted)
    monkeypatch.setattr("course.scoring.remote.BUDGET_S", 0.56)  # half of it is for one task
    monkeypatch.setattr("course.scoring.remote.SEARCH_S", 0.15)

    def three_checks(remote):
        for _ in range(3):
            remote.begin_check("double")
            remote.call("double", 1.0)
            remote.not_charged(remote.used)
        return allowed[-3:]

    busy = Submission({"doubling.py": solution + busy_for(0.1)})
    first, second, third = session.using(busy, three_checks)
    assert first - second < 0.02  # it came back whole
    assert 0.02 < first - third < 0.1  # and of the next one half


def test_what_a_search_asks_of_a_function_is_measured(session, solution, monkeypatch):
    given_back = []
    both = []
    monkeypatch.setattr(RemoteSubmission, "not_charged", lambda _, seconds: given_back.append(seconds))

    def check(_, one, submission):
        """The first check of double: it asks once for itself, and once to find a cause."""
        submission.call("double", 1.0)
        try:
            kit.fail("It is wrong.", diagnose=lambda: str(submission.call("double", 1.0)))
        except CheckFailed as failed:
            both.append(submission.used)
            return failed

    monkeypatch.setattr("course.scoring.judging.session.CollectedChecks.run", check)
    busy = Submission({"doubling.py": solution + busy_for(0.05)})
    session.grade(busy, only=[session.checks[0].id])
    assert len(given_back) == 1
    # Each call takes 0.05 s at least, on a busy machine more: it is that of the second alone.
    assert 0.04 < given_back[0] < both[0] - 0.04


def test_an_exercise_has_the_time_it_asks_for_and_a_quarter_once_a_function_ran_out_of_it(
    catalog, doubling, session, solution
):
    twice = msgspec.structs.replace(doubling, time=2.0)
    with GradingSession(twice, catalog, scope="full", terms=Terms(timeout=0.3)) as slower:
        verdict = grade(slower, solution + HANGS)
        late = [slower.took[check.id] for check in results(verdict, "double") if check.status == "timeout"]
    assert len(late) >= 2
    assert late[0] >= 0.55
    assert max(late[1:]) < 0.3
    assert verdict.warnings == (
        "`double` ran out of time in one check; each further check of it had a quarter of that.",
    )
    assert grade(session, solution).warnings == ()


@pytest.mark.skipif(not hasattr(os, "sched_getaffinity"), reason="processes are not kept on processors here")
def test_only_while_it_grades_does_a_session_stay_on_one_processor(catalog, doubling, solution):
    free = os.sched_getaffinity(0)
    first, second = (GradingSession(doubling, catalog, processor=number) for number in range(2))
    assert os.sched_getaffinity(0) == free
    seen = [first.using(Submission({"doubling.py": solution}), lambda _: os.sched_getaffinity(0))]
    first.close()  # not in the order in which they were opened
    seen.append(second.using(Submission({"doubling.py": solution}), lambda _: os.sched_getaffinity(0)))
    second.close()
    assert os.sched_getaffinity(0) == free
    assert [len(processors) for processors in seen] == [1, 1]
    assert len(set.union(*seen)) == min(2, len(free))


def results(verdict, task):
    return [check for check in verdict.checks if check.task == task]


def test_an_exception_names_the_students_own_line(session, solution):
    source = solution + b"\ndef double(x):\n    return 1 / 0\n"
    check = results(grade(session, source), "double")[0]
    assert check.status is Status.ERROR
    assert "ZeroDivisionError" in check.message
    line = source.decode().splitlines().index("    return 1 / 0") + 1
    assert f"doubling.py:{line} in double" in (check.traceback or "")


@pytest.mark.parametrize(
    ("body", "status"),
    [
        ("while True: pass", Status.TIMEOUT),
        ("import os; os._exit(3)", Status.CRASH),
        ("import os; os.abort()", Status.CRASH),
        ("import ctypes; ctypes.string_at(0)", Status.CRASH),
        ("return bytearray(10**11)", Status.MEMORY),
        ("return {1, 2}", Status.ERROR),
        ("return object()", Status.ERROR),
        ("return None", Status.FAIL),
        ("return float('nan')", Status.FAIL),
        ("raise SystemExit", Status.ERROR),
        ("raise KeyboardInterrupt", Status.ERROR),
    ],
)
def test_each_way_of_ending_has_its_status_and_spares_the_other_task(session, solution, body, status):
    verdict = grade(session, solution + f"\ndef double(x):\n    {body}\n".encode())
    assert {check.status for check in results(verdict, "double")} == {status}
    assert all(check.status is Status.PASS for check in results(verdict, "doublings"))
    assert all(check.message and check.help for check in results(verdict, "double"))


def test_what_a_file_lacks_when_it_is_loaded_again_is_no_outcome_of_its_own(session, solution, monkeypatch):
    """By then its code may know a hidden number, and would tell it by the function that is gone."""
    load, loaded = RemoteSubmission._loaded, []

    def fewer(remote):
        loaded.append(connection := load(remote))
        if len(loaded) > 1:
            connection.functions -= {"doublings"}
        return connection

    monkeypatch.setattr(RemoteSubmission, "_loaded", fewer)
    verdict = grade(session, solution + b"\ndef double(x):\n    import os\n    os._exit(3)\n")
    assert {check.status for check in results(verdict, "doublings")} - {Status.SKIP} == {Status.CRASH}
    assert not any("no function" in check.message for check in verdict.checks)


def test_of_one_file_only_so_many_bytes_of_results_are_kept():
    remote = RemoteSubmission.__new__(RemoteSubmission)
    remote.heard, remote._room = [], 2000
    for value in ([np.zeros(100), {"a": "text"}], np.zeros(200), 1.0):
        assert remote._hear("call", "double", (1.0,), value) is value
    assert [type(heard.value) for heard in remote.heard] == [list, float]


@pytest.mark.parametrize(
    ("source", "code", "said", "advice"),
    [
        (b"raise ValueError('no')", "import_error", "", ""),
        (b"import sys; sys.exit(0)", "import_error", "", ""),
        (b"import os; os._exit(0)", "import_crash", "", ""),
        (b"while True: pass", "import_timeout", "", ""),
        (b"def other(): pass", "no_declared_functions", "", ""),
        (b"import course.physics.integrators as theirs", "no_declared_functions", "", ""),
        (b"import course\nfound = ''.startswith(course.answer)", "import_error", "", ""),
        (b"from pytest import absent; ''.startswith(absent)", "import_error", "", ""),
        (b"open('data.csv')", "import_error", "", "A check runs apart from your files"),
        (b"input()", "import_error", "", "Nobody types while a check runs."),
        (b"raise KeyboardInterrupt", "import_error", "", "Make that line work when the file is loaded"),
        (b"\x00\x01\xff\xfe\x80 random", "syntax_error", "is not Python source: ", "course reset"),
        (b"PK\x03\x04\x00\x00", "syntax_error", "is not Python source: ", "course reset"),
        (b"# \xe9\nx = 1\n", "syntax_error", "line 1: this is not Python source: it is", "Save it as UTF-8"),
        (
            b"x = 1\n\ny = 2  # \xe9\n",
            "syntax_error",
            "line 3: this is not Python source: it is saved in another",
            "Save it as UTF-8",
        ),
        ("x = 1\n".encode("utf-16"), "syntax_error", "another encoding than UTF-8", "Save it as UTF-8"),
        (b"x = " + b"-" * 400_000 + b"1\n", "syntax_error", "nested more deeply", ""),
        (b'def f():\n    """Twice.\n    return 1\n\n"""Later."""\n', "syntax_error", "", "further up"),
    ],
    ids=lambda value: str(value[:30]),
)
def test_what_cannot_be_loaded_is_ungradable_with_a_reason_and_what_to_do(
    session, source, code, said, advice
):
    verdict = grade(session, source)
    assert verdict.state == "ungradable"
    assert (verdict.score, verdict.max_score, verdict.checks) == (0, 10, ())
    error = verdict.error
    assert (error.code, said in error.message, ": ." in error.message) == (code, True, False)
    assert advice in error.help
    assert error.help
    assert "not Python source" not in said or "that line" not in error.help


#: What is above the functions of a file that is right -> what its student is told of it.
LEFT_OUT = {
    "exit()": "line 1: left out. It would end the program, and a check goes on.",
    "import sys; sys.exit(0)": "line 1: left out. It would end the program, and a check goes on.",
    "import unittest; unittest.main()": "line 1: left out. It would end the program, and a check goes on.",
    "import tkinter; tkinter.Tk()": "There is no screen where a check runs",
    "import threading; threading.Thread(target=print).start()": "one process with one thread",
    "from multiprocessing import Pool; Pool(2)": "no other process can start",
    "import subprocess; subprocess.run(['ls'])": "No other program",
    "import asyncio; asyncio.run(asyncio.sleep(0))": "There is no network",
    "import getpass; getpass.getpass()": "Nobody types while a check runs.",
    "import getpass; getpass.getuser()": "Nobody is logged in where a check runs.",
    "import locale; locale.setlocale(locale.LC_ALL, 'de_DE.UTF-8')": "The languages of your computer",
    "from __main__ import double": "`__main__` is your file only when you run it yourself",
    "import winsound": "Only Python on Windows has that module.",
    "import absent; len(absent.table)": "It uses a package that is not there.",
    "root = 1 / 0\nroot.title('x')": "line 2: left out, since it needs what was left out on line 1",
    "import numpy as np; np.trapz([1.0, 2.0])": "has no `np.trapz`. Use `np.trapezoid`.",
    "import math; math.nothing": "which this is checked with, has no `math.nothing`.",
    "!pip install numpy": "line 1: left out, since it is not Python: !pip install numpy",
    "%matplotlib inline": "line 1: left out, since it is not Python: %matplotlib inline",
    "%%writefile doubling.py": "line 1: left out, since it is not Python: %%writefile doubling.py",
    "files = !ls": "line 1: left out, since it is not Python: files = !ls",
    "get_ipython().run_line_magic('matplotlib', 'inline')": "line 1: left out, since it is not Python: get",
    "from helpers import *": "If helpers.py is a file of yours: it is not handed in and not graded.",
    "import helpers": "If helpers.py is a file of yours: it is not handed in and not graded.",
    "import nump as np": "Is `nump` a slip for `numpy`? If nump.py is a file of yours: it is not handed in",
    "from .helpers import half": "If helpers.py is a file of yours: it is not handed in and not graded.",
}


@pytest.mark.parametrize("line", LEFT_OUT)
def test_a_line_that_works_at_home_alone_costs_nothing_and_is_told_with_its_reason(session, solution, line):
    require_level("L3")
    verdict = grade(session, line.encode() + b"\n" + solution)
    assert verdict.score == verdict.max_score
    assert any(LEFT_OUT[line] in note for note in verdict.warnings), verdict.warnings


def test_what_a_check_says_of_a_function_that_is_no_python_is_no_note(session):
    verdict = grade(
        session, b"def double(x):\n    return (x\n\n\ndef doublings(x, n):\n    return [x] * n\n\n\na = 2h\n"
    )
    said = [check.message for check in verdict.checks if check.task == "double"]
    assert {one.rstrip(" .") for one in said if one} == {
        "Python cannot read `double` on line 2 of your file: '(' was never closed"
    }
    (note,) = verdict.warnings
    assert note.startswith(
        "doubling.py, line 9: left out, since Python cannot read it: invalid decimal literal"
    )


@pytest.mark.parametrize(
    "rewrite",
    [
        lambda text: text + "\nimport matplotlib.pyplot as plt\nplt.plot([1]); plt.show()\n",
        lambda text: f"get_ipython().run_cell_magic('time', '', {text!r})\n",
        lambda text: "from __future__ import annotations\n" + text.replace("from __future__", "# "),
    ],
    ids=["a plot and its package", "a timed cell of an exported notebook", "a future import"],
)
def test_what_belongs_to_work_at_home_is_worth_no_word(session, solution, rewrite):
    verdict = grade(session, rewrite(solution.decode()))
    assert (verdict.score, verdict.warnings) == (verdict.max_score, ())


@pytest.mark.parametrize(
    ("package", "name", "advice"),
    [
        ("helpers", "half", "If helpers.py is a file of yours: it is not handed in and not graded."),
        ("pylab", "asarray", "`asarray` is NumPy's: write `from numpy import asarray`."),
        ("pylab", "plotting", "Import each name from the module that has it."),
    ],
)
def test_a_name_that_a_star_import_would_bring_leads_to_its_line(session, package, name, advice):
    verdict = grade(session, f"from {package} import *\ndef double(x):\n    return {name}(x)\n")
    found = next(check for check in verdict.checks if check.diagnosis == "RAISED")
    assert (
        found.help
        == f"The name may come from the import on line 1 of your file, which was left out. {advice}"
        + (" Copy what you use of it into the file of the exercise." if package == "helpers" else "")
    )


@pytest.mark.parametrize(
    ("line", "version"),
    [
        ("type V = float", "3.12"),
        ("def first[T](x: T) -> T: return x", "3.12"),
        ("print(f'{d['a']}')", "3.12"),
        ("def g():\n    try: pass\n    except ValueError, TypeError: pass", "3.14"),
    ],
)
def test_what_a_newer_python_reads_is_told_with_both_versions(session, solution, line, version):
    if sys.version_info >= tuple(map(int, version.split("."))):
        pytest.skip("this Python reads it")
    verdict = grade(session, solution + b"\n" + line.encode() + b"\n")
    here = f"{sys.version_info.major}.{sys.version_info.minor}"
    assert verdict.score == verdict.max_score
    told = f"Python {version} reads that, but it is checked with Python {here}"
    assert any(told in note for note in verdict.warnings), verdict.warnings


def test_an_import_that_is_not_allowed_costs_only_the_tasks_that_need_it(session, solution):
    plots = (
        b"import matplotlib.pyplot as plt\n" + solution + b"\nfigure, axes = plt.subplots()\naxes.plot([1])\n"
    )
    assert grade(session, plots).score == 10
    verdict = grade(session, plots + b"\ndef double(x):\n    plt.plot(x)\n    return 2 * x\n")
    assert verdict.state == "graded"
    missed = [check for check in verdict.checks if check.status == "error"]
    assert {check.task for check in missed} == {"double"}
    assert all(check.diagnosis == "IMPORT_NOT_ALLOWED" and " on line " in check.message for check in missed)
    assert 0 < verdict.score < 10


def test_a_check_that_requires_a_failed_one_is_skipped_and_names_it(session, solution):
    verdict = grade(session, solution + b"\ndef doublings(x, n):\n    return [x]\n")
    by_id = {check.id: check for check in verdict.checks}
    assert by_id["doublings_values"].status is Status.SKIP
    assert by_id["doublings_values"].blocked_by == "doublings_length"


def test_hidden_findings_lose_their_values_for_the_student(session, solution):
    wrong = solution + b"\ndef double(x):\n    print('SEEN', x)\n    return x\n"
    hidden = [
        check for check in grade(session, wrong).checks if check.visibility == "hidden" and not check.points
    ]
    assert hidden
    assert any(check.actual is not None and check.stdout for check in hidden)
    for check in map(for_student, hidden):
        values = (check.input, check.expected, check.actual, check.tolerance, check.first_divergence)
        assert values == (None,) * 5
        assert check.traceback is None
        assert check.stdout is None
        assert check.message
        assert check.help


def test_a_fault_of_a_check_is_never_the_students_zero(session, solution, monkeypatch):
    monkeypatch.setattr(session._checks, "run", lambda *_: RuntimeError("a bug of ours"))
    verdict = grade(session, solution)
    assert verdict.state == "grader_error"
    assert {check.status for check in verdict.checks} <= {Status.GRADER_ERROR, Status.SKIP}
    assert "a bug of ours" in verdict.error.message


@pytest.mark.parametrize(
    ("lacks", "said"),
    [({"graders": None, "solutions": None}, "hidden graders"), ({"solutions": None}, "model solutions")],
)
def test_hidden_checks_need_a_checkout_with_the_solutions_that_they_compare_with(
    catalog, doubling, lacks, said
):
    """Without these each of them would fail on honest work, for a fault that is ours."""
    bare = Catalog(replace(catalog.content, **lacks))
    with pytest.raises(MissingCapabilityError, match=said):
        GradingSession(doubling, bare, scope="full")


def breaks_on_wrong_results(check, remote):
    """A check whose own code cannot stand what a wrong submission returns."""
    value = remote.call("double", 3.0)
    return None if value == 6.0 else ZeroDivisionError("in the check")


def test_a_check_that_breaks_on_a_students_value_only_is_failed_and_told_to_its_author(
    session, solution, monkeypatch
):
    monkeypatch.setattr(session._checks, "run", breaks_on_wrong_results)
    session._sound.clear()
    verdict = grade(session, solution + b"\ndef double(x):\n    return float('nan')\n")
    session._sound.clear()
    assert verdict.state == "graded"
    first = verdict.checks[0]
    assert (first.status, first.points, first.diagnosis) == (Status.FAIL, 0.0, "NOT_JUDGED")
    assert "`double`" in first.message
    assert "nan" in first.message
    assert first.traceback == "In the check's own code: ZeroDivisionError: in the check"
    assert grade(session, solution).all_pass


def test_at_home_a_check_that_breaks_says_that_nothing_tells_whose_fault_it_is(
    catalog, doubling, solution, monkeypatch
):
    monkeypatch.setattr(catalog, "content", replace(catalog.content, solutions=None, graders=None))
    with GradingSession(doubling, catalog, terms=Terms(timeout=1.0)) as home:
        monkeypatch.setattr(home._checks, "run", breaks_on_wrong_results)
        verdict = grade(home, solution + b"\ndef double(x):\n    return [x, None]\n")
    assert (verdict.state, verdict.max_score) == ("graded", 5)
    assert {check.visibility for check in verdict.checks} == {"public"}
    assert "no model solution here" in verdict.checks[0].message
    assert "a list or a tuple with None in it" in verdict.checks[0].message


def test_a_session_has_the_seed_and_the_checks_that_were_asked_for(catalog, doubling, session, solution):
    verdict = session.grade(Submission({"doubling.py": solution}), only=["doublings_values"])
    assert {check.id for check in verdict.checks} == {"doublings_length", "doublings_values"}
    drawn = []
    wrong = solution + b"\ndef doublings(x, n):\n    return [x + k for k in range(n+1)]\n"
    with GradingSession(doubling, catalog, scope="full", terms=Terms(seed=2)) as other:
        for one in (session, session, other):
            found = grade(one, wrong).checks
            drawn.append(next(check.input for check in found if check.id == "doublings_values"))
    assert drawn[0] == drawn[1] != drawn[2]


def test_a_search_for_the_mistake_that_breaks_leaves_the_checks_own_finding(session, solution, monkeypatch):
    monkeypatch.setattr(kit.companion("doubling", "diagnosis"), "of_double", lambda _: 1 / 0)
    verdict = grade(session, solution + b"\ndef double(x):\n    return x\n")
    check = next(check for check in verdict.checks if check.id == "double_of_three")
    assert (verdict.state, check.status, check.diagnosis) == ("graded", Status.FAIL, None)
    assert check.message == "The result is not twice the number. Here your result is half the right one."
    assert str(check.traceback).startswith("In the check's own code: ZeroDivisionError")


@pytest.mark.parametrize(
    "returned", ["10**400", "2**63", "-2**64", "1e300", "np.uint64(2**64 - 1)", "{2: 10**5000}", "[2**70]"]
)
def test_no_number_is_too_large_for_a_verdict(session, solution, returned):
    verdict = grade(
        session, solution + f"\nimport numpy as np\ndef double(x):\n    return {returned}\n".encode()
    )
    assert verdict.state == "graded"
    msgspec.msgpack.encode(verdict)
    msgspec.json.encode(finite(msgspec.to_builtins(verdict)))


def test_a_finding_holds_whole_numbers_of_any_size():
    class Odd(int):
        pass

    unsigned = np.array([2**64 - 1], dtype=np.uint64)
    for value in (10**30, -(10**30), [2**64], {10**5000: 2**80}, unsigned, Odd(2**70)):
        msgspec.msgpack.encode(plain(value))
    assert plain(2**63 - 1) == 2**63 - 1
    assert plain(np.longdouble(2.5)) == 2.5


def test_a_hostile_value_does_not_swell_a_finding(session, solution):
    bushy = b"""
def double(x):
    tree = [0.5] * 20
    for _ in range(2):
        tree = [tree] * 20
    return tree
"""
    verdict = grade(session, solution + bushy)
    assert all(len(str(check.actual)) < 50_000 for check in results(verdict, "double"))
    assert results(verdict, "double")[0].status is Status.FAIL
