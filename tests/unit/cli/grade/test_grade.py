"""`course grade` as an instructor types it."""

import json
import os
import re

import pytest

from tests.command_line import in_process
from tests.unit.cli.conftest import MINI_COURSE
from tests.unit.grading.made import read_csv, zipped

WRONG = b"\ndef double(x):\n    print('I saw', x)\n    return x\n"


def course(*arguments):
    return in_process(*arguments, env={**os.environ, "COURSE_CONTENT": str(MINI_COURSE)})


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    """A run over one right, one wrong and one broken submission."""
    folder = tmp_path_factory.mktemp("grade")
    solution = (MINI_COURSE / "solutions" / "doubling" / "doubling.py").read_bytes()
    for student, source in (("ada", solution), ("=bob", solution + WRONG), ("cy", b"def (")):
        place = folder / "class" / student
        place.mkdir(parents=True)
        (place / "doubling.py").write_bytes(source)
    done = course(
        "grade", "run", folder / "class", "--exercise", "doubling", "--out", folder / "out",
        "--isolation", "process", "--seed", "4",
    )  # fmt: skip
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
    assert {row["student"]: row["score"] for row in read_csv(graded / "grades.csv")} == {
        "'=bob": "6",
        "ada": "10",
        "cy": "0",
    }


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
    place = tmp_path / "class" / "ada" / "error-left"
    place.mkdir(parents=True)
    wrong = "def error_left(coarse, fine, factor, order):\n    return (coarse - fine) / factor**order\n"
    (place / "error_left.py").write_text(wrong)
    run = ("grade", "run", tmp_path / "class", "--exercise", "error-left", "--out", tmp_path / "out")
    done = in_process(*run, "--seed", "4", env=dict(os.environ))
    assert done.returncode == 0, done.stderr
    explain = ("grade", "explain", tmp_path / "out", "ada", "error-left")
    said = in_process(*explain, env=dict(os.environ)).stdout
    assert "without the minus one" in said
    assert "diagnosis: MINUS_ONE_FORGOTTEN" in said


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
        (tmp_path / "class" / name).mkdir(parents=True)
        (tmp_path / "class" / name / "doubling.py").write_bytes(source)
    (tmp_path / "class" / "flo").mkdir()
    (tmp_path / "class" / "flo" / f"\n{forged}.zip").write_bytes(b"PK")
    (tmp_path / "class" / "hal").mkdir()
    around = f"work, as agreed. {forged}"
    (tmp_path / "class" / "hal" / "w.zip").write_bytes(zipped({f"{around}/doubling.py": solution}))
    ran = course(
        "grade", "run", tmp_path / "class", "--exercise", "doubling", "--out", tmp_path / "out",
        "--isolation", "process", "--plain",
    )  # fmt: skip
    assert ran.returncode == 6, ran.stderr
    told = [
        course("grade", "explain", tmp_path / "out", name, "doubling", "--plain") for name in (*names, "hal")
    ]
    for said in (ran.stdout, ran.stderr, *(done.stdout for done in told)):
        assert not any(line.strip().startswith(forged) for line in said.splitlines()), said
        assert not set("\u202e\u2066\r") & set(said), said
    assert "bob\\n" in ran.stdout
    assert any("raised ValueError" in done.stdout for done in told)
    assert f"in the folder '{around}', which" in " ".join(told[-1].stdout.split())
