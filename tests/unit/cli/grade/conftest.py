"""A class of the miniature course, what an instructor puts beside it, and graders that take no time."""

import shutil

import pytest

from course.grading.running import batch
from course.grading.running.batch import Graded
from tests.unit.grading.made import read_csv
from tests.unit.grading.running.test_run import right
from tests.unit.grading.test_results import POLICY

SOURCE = "def double(x):\n    return 2 * x\n\ndef doublings(x, n):\n    return x\n"
RUN = "grade run class --out out --exercise doubling"
NEW = "grade run class --out new --exercise doubling"
#: One that gives nobody more days.
STRICT = POLICY[: POLICY.index("[[extension]]")]


def write(folder, name, text=SOURCE):
    """A file, and the folders above it."""
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, "utf-8")
    return path


def write_policy(folder, due="2026-01-01T00:00:00Z", terms="percent_per_day = 10", **extensions):
    """``late.toml``: one deadline for every exercise, and for some students more days."""
    text = f'format_version = 1\n{terms}\n[[deadline]]\nexercise = "*"\ndue = {due}\n'
    for student, days in extensions.items():
        text += f'[[extension]]\nstudent = "{student}"\ndays = {days}\n'
    write(folder, "late.toml", text)


def write_times(folder, *rows, exercise="doubling"):
    """``times.csv``: who handed in and when."""
    text = "".join(f"{student},{exercise},{at}\n" for student, at in rows)
    write(folder, "times.csv", f"student,exercise,submitted_at\n{text}")


def grades(path):
    """The rows of a table, by student."""
    return {row["student"]: row for row in read_csv(path)}


@pytest.fixture
def out(made, tmp_path):
    """A gradebook's folder, in a copy of what a file of tests has made."""
    shutil.copytree(made, tmp_path, dirs_exist_ok=True)
    return tmp_path / "out"


@pytest.fixture
def ungraded(monkeypatch):
    """No processes: what can be read is right."""
    monkeypatch.setattr(batch, "grade_all", lambda entries, terms, graders=1: right(entries, terms))


@pytest.fixture
def graded_as(monkeypatch):
    """Give this verdict to everything that is graded from now on."""

    def gives(verdict):
        monkeypatch.setattr(
            batch, "grade_all", lambda entries, *_, **__: [Graded(one, verdict) for one in entries]
        )

    return gives
