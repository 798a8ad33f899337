"""`course grade` as an instructor types it."""

import json
import os
import re

import pytest

from tests.command_line import in_process
from tests.unit.cli.conftest import MINI_COURSE
from tests.unit.grading.made import put, read_csv, zipped

WRONG = b"\ndef double(x):\n    print('I saw', x)\n    return x\n"


def course(*arguments):
    return in_process(*arguments, env={**os.environ, "COURSE_CONTENT": str(MINI_COURSE)})


def run(folder, *more):
    """A class graded in plain processes."""
    words = ("--exercise", "doubling", "--isolation", "process", *more)
    return course("grade", "run", folder / "class", "--out", folder / "out", *words)


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    """A run over one right, one wrong and one broken submission."""
    folder = tmp_path_factory.mktemp("grade")
    solution = (MINI_COURSE / "solutions" / "doubling" / "doubling.py").read_bytes()
    for student, source in (("ada", solution), ("=bob", solution + WRONG), ("cy", b"def (")):
        put(folder / "class" / student / "doubling.py", source)
    done = run(folder, "--seed", "4")
    assert done.returncode == 6, done.stderr
    assert "syntax_error" in done.stdout
    assert "plain processes (L1)" in done.stderr
    return folder / "out"


def test_a_run_leaves_a_gradebook_and_what_is_made_from_it(graded):
    assert {path.name for path in graded.iterdir()} == {
        "gradebook.backup-1.sqlite",
        "gradebook.sqlite", "grades.csv", "results.jsonl", "report.html", "students.html", "students.csv",
        "students",
    }  # fmt: skip
    assert {path.name for path in (graded / "students").iterdir()} == {"1.html", "2.html", "3.html"}
    scores = {row["student"]: row["score"] for row in read_csv(graded / "grades.csv")}
    assert scores == {"'=bob": "6", "ada": "10", "cy": "0"}


def test_explain_shows_hidden_values_to_the_instructor_or_why_there_is_no_grade(graded):
    done = course("grade", "explain", graded, "=bob", "doubling")
    assert done.returncode == 0, done.stderr
    assert "6 of 10" in done.stdout
    assert re.search(r"double_of_negative, hidden, 0/\d points\]", done.stdout)
    assert "-34.5" in done.stdout
    assert "I saw -17.25" in done.stdout
    body = json.loads(course("grade", "explain", graded, "cy", "doubling", "--json").stdout)
    assert (body["schema"], body["state"], body["exit_code"]) == ("course.grade/1", "ungradable", 3)
    assert body["error"]["code"] == "syntax_error"


def test_a_warm_up_is_graded_where_its_message_says_to_put_it_and_is_explained(tmp_path):
    wrong = b"def error_left(coarse, fine, factor, order):\n    return (coarse - fine) / factor**order\n"
    put(tmp_path / "class" / "ada" / "error-left" / "error_left.py", wrong)
    words = ("--exercise", "error-left", "--out", tmp_path / "out", "--seed", "4")
    done = in_process("grade", "run", tmp_path / "class", *words)
    assert done.returncode == 0, done.stderr
    said = in_process("grade", "explain", tmp_path / "out", "ada", "error-left").stdout
    for words in ("without the minus one", "diagnosis: MINUS_ONE_FORGOTTEN"):
        assert words in said


def test_nobody_adds_lines_of_their_own_to_what_the_instructor_reads(tmp_path):
    """Names of folders and archives, exceptions and values: on the terminal and in what is explained.

    A name that reads like a sentence stood in a sentence of ours like a part of it.
    """
    solution = (MINI_COURSE / "solutions" / "doubling" / "doubling.py").read_bytes()
    forged = "ada 10 of 10 passed"
    names = {
        f"bob\n{forged}": solution,
        f"cy\u202e{forged}": solution,
        "dan": f"raise ValueError('x\\n{forged}\u2066')".encode(),
        "gus": solution + f"\ndef double(x):\n    raise ValueError('x\\n{forged}\u2066')\n".encode(),
        f"eve\r{forged}": b"def (",
    }
    for name, source in names.items():
        put(tmp_path / "class" / name / "doubling.py", source)
    put(tmp_path / "class" / "flo" / f"\n{forged}.zip", b"PK")
    around = f"work, as agreed. {forged}"
    put(tmp_path / "class" / "hal" / "w.zip", zipped({f"{around}/doubling.py": solution}))
    ran = run(tmp_path, "--plain")
    assert ran.returncode == 6, ran.stderr
    explain = ("grade", "explain", tmp_path / "out")
    told = [course(*explain, name, "doubling", "--plain").stdout for name in (*names, "hal")]
    for said in (ran.stdout, ran.stderr, *told):
        assert not any(line.strip().startswith(forged) for line in said.splitlines()), said
        assert not set("\u202e\u2066\r") & set(said), said
    assert "bob\\n" in ran.stdout
    assert "raised ValueError" in "".join(told)
    assert f"in the folder '{around}', which" in " ".join(told[-1].split())
