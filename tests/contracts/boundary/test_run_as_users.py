"""What once broke a run, in one class, graded by root and by an ordinary user: nobody else loses by it."""

import html
import json
import platform
import sys

import pytest

from tests.contracts.boundary.levels import require_level
from tests.contracts.boundary.users import IN_WORKERS, LEVELS_AND_USERS, ROOT, run_as
from tests.unit.grading.made import notebook, put

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="users and levels of Linux")

MINI = ROOT / "tests" / "fixtures" / "mini_course"
MODEL = (MINI / "solutions" / "doubling" / "doubling.py").read_text("utf-8")
#: A hundred times the hidden input of the miniature course.
HIDDEN = "1725"
_WRONG = "\n\ndef double(x):\n    {}\n\n\ndef doublings(x, n):\n    {}\n"
#: Read from its file by every process that grades, hence set here and not by a test's own process.
_RUN = """
import os, sys
content, level, folder, out = sys.argv[1:]
os.environ["COURSE_CONTENT"] = content
from course.catalog.load import Catalog
from course.errors import CourseError
from course.grading.running.run import RunOptions, grade_class
from course.scoring.judging.submission import Terms
from pathlib import Path

def graded_at(level):
    options = RunOptions(exercises=("doubling",), terms=Terms(at_least=level, level=level), seed=5)
    grade_class(Path(folder), Path(out), Catalog(), options, lambda *_: None)

# Refused first, with a level that there cannot be: what was asked wrongly leaves the name free.
found, os.environ["PATH"] = os.environ["PATH"], "/nowhere"
try:
    graded_at("L3")
except CourseError as error:
    print(error.code, Path(out).exists())
os.environ["PATH"] = found
graded_at(level)
"""
#: Sends what it is given by the name of an exception, its text, and a line that the file does not have.
_TELLS = (
    """
def double(x):
    if x == 3.0:
        return 6.0
    number = int(abs(x) * 100)
    def fail():
        raise type(f"E{number}E", (Exception,), {})(f"T{number}T")
    fail.__code__ = fail.__code__.replace(co_firstlineno=number)
    print(f"P{number}P")
    fail()

def doublings(x, n):
    return double(x)
"""
    + "\n" * 2000
)


#: student -> file, content; all but the model's are hostile or broken
CLASS = {
    "a statement bomb": (
        "doubling.ipynb",
        notebook(f"# get_ipython\n{_WRONG.format('pass', 'pass')}" + "x = 1\n" * 30_000),
    ),
    "brackets": ("doubling.ipynb", notebook("%magic\ndef double(x):\n    return None\n" + "(" * 100_000)),
    "ragged": ("doubling.py", _WRONG.format("return [[1], [2, 3]]", "return [[x], [x, x]]").encode()),
    "beyond 64 bits": ("doubling.py", _WRONG.format("return 10**30", "return [10**30] * (n + 1)").encode()),
    "infinite": ("doubling.py", _WRONG.format("return float('inf')", "return [float('nan')] * 7").encode()),
    "a line of its own": (
        "doubling.py",
        _WRONG.format(*[r"raise ValueError('no\n  model: 10 of 10 \u202e')"] * 2).encode(),
    ),
    "two\nlines": ("doubling.py", b""),
    "tells": ("doubling.py", _TELLS.encode()),
    "zz model": ("doubling.py", MODEL.encode()),
}


@pytest.mark.parametrize(("level", "user"), LEVELS_AND_USERS)
def test_a_class_of_what_once_broke_is_graded_to_the_end(level, user, tmp_path):
    require_level(level)
    # The bomb takes seconds to be read, whatever level comes after: the strongest stands for all.
    handed_in = {name: file for name, file in CLASS.items() if level == "L3" or name != "a statement bomb"}
    for student, (name, content) in handed_in.items():
        put(tmp_path / "class" / student / name, content)
    out = tmp_path / "out"
    told = run_as(user, _RUN, str(MINI), level, str(tmp_path / "class"), str(out))
    assert told == "protection_level False\n"
    lines = [json.loads(line) for line in (out / "results.jsonl").read_text("utf-8").splitlines()]
    found = {line["student"]: line for line in lines}
    assert found.keys() == handed_in.keys()
    assert not [name for name, line in found.items() if line["state"] == "grader_error"]
    assert (found["zz model"]["score"], found["zz model"]["isolation"]) == (10, level)
    assert (found["tells"]["score"], HIDDEN in str(found["tells"])) == (2, True)
    pages = [html.unescape(page.read_text("utf-8")) for page in (out / "students").iterdir()]
    (page,) = [page for page in pages if "tells" in page]
    assert "Twice three is six" in page
    assert not [
        sent for sent in (f"E{HIDDEN}E", f"T{HIDDEN}T", f"P{HIDDEN}P", f"line {HIDDEN}") if sent in page
    ]
    scored = {name for name, line in found.items() if line["score"]}
    assert scored == {"zz model", "tells"}


_TWICE = """
for _ in range(2):
    connection = connect(5)
    try:
        print(connection.call("scale", [1.0], 2.0))
    except StudentFailure as failure:
        print(failure.type)
    connection.close()
    print(connection.output())
found.close()
"""


@pytest.mark.parametrize(("level", "user"), [case for case in LEVELS_AND_USERS if case.values[0] != "L1"])
@pytest.mark.parametrize(
    ("attack", "ends"), [("neighbour_calls", "[1.0]"), ("zygote_memory", "exit code 77")]
)
def test_nothing_tells_of_a_neighbour(attack, ends, level, user):
    require_level(level)
    if attack == "neighbour_calls" and platform.machine() != "x86_64":
        pytest.skip("its numbers of system calls are those of x86-64")
    source = (ROOT / "tests" / "attacks" / f"{attack}.py").read_text("utf-8")
    assert run_as(user, IN_WORKERS + _TWICE, level, source).split("\n") == [ends, "", ends, "", ""]
