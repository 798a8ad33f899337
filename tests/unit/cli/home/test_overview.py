"""What there is to read, what was done, and what this machine can do."""

from __future__ import annotations

import pytest

from course.cli.setup import doctor
from course.progress.store import Store
from tests.unit.cli.conftest import record


def test_lesson_without_an_id_goes_on_to_the_next_unread_one(course, workspace):
    assert course("lesson", "--json").json["id"] == "twice-as-much"
    record(workspace).append("lesson", "twice-as-much")
    assert course("lesson", "--json").json["id"] == "half-as-much"
    lessons = course("lessons", "--json").json["lessons"]
    assert [lesson["read_at"] is not None for lesson in lessons] == [True, False]


def test_a_print_is_no_reading_and_needs_no_workspace(course, workspace, monkeypatch):
    for shape in ("--json", "--plain", "--page"):
        assert course("lesson", "twice-as-much", shape).code == 0
    assert not any(lesson["read_at"] for lesson in course("lessons", "--json").json["lessons"])
    monkeypatch.chdir(workspace.parent)
    assert "the number added to itself" in course("lesson", "twice-as-much", "--plain").out


def test_progress_has_dates_and_scores(course, workspace, write):
    course("lesson")
    write("wrong", "RIGHT")
    course("check")
    course("hint")
    write("RIGHT", "RIGHT")
    course("check")
    course("submit")
    body = course("progress", "--json").json
    doubling = body["exercises"][0]
    told = [doubling[key] for key in ("state", "score", "checks_run", "hints_shown")]
    assert told == ["complete", 4.0, 2, 1]
    assert doubling["passed_at"]
    assert len(body["submissions"]) == 1
    assert "score 4/4" in course("progress").out


@pytest.fixture
def unprobed(monkeypatch):
    """A machine whose protection is known: to try it takes longer than the rest."""
    monkeypatch.setattr(doctor, "protection", lambda: ("L3", (), ()))


@pytest.mark.usefixtures("unprobed")
def test_doctor_repairs_a_damaged_record_and_keeps_it(course, workspace):
    record = workspace / ".course" / "progress.sqlite"
    record.write_bytes(b"not a database, not at all, no" * 10)
    damaged = course("doctor")
    assert damaged.code == 4
    assert "progress.sqlite" in damaged.out
    ran = course("doctor", "--repair")
    assert ran.code == 0
    assert (workspace / ".course" / "progress.damaged.sqlite").read_bytes().startswith(b"not a database")
    assert Store(record).events() == ()


def test_doctor_never_advises_switching_a_protection_off(course):
    words = course("doctor").out.lower()
    assert "protection" in words
    for phrase in ("disable", "switch off", "turn off", "sysctl", "setenforce 0", "--privileged"):
        assert phrase not in words


@pytest.mark.usefixtures("unprobed")
def test_doctor_names_the_command_for_what_is_missing(course, monkeypatch):
    import importlib.metadata

    real = importlib.metadata.version

    def version(name):
        if name == "pymunk":
            raise importlib.metadata.PackageNotFoundError(name)
        return "0.1" if name == "rich" else real(name)

    monkeypatch.setattr(importlib.metadata, "version", version)
    monkeypatch.setattr("course.extras._lines", lambda: ["pymunk>=7.0", "rich>=14", "numpy"])
    ran = course("doctor", "--json")
    assert ran.code == 4
    assert ran.json["fixes"][0]["command"] == "pip install 'pymunk>=7.0' 'rich>=14'"


@pytest.mark.usefixtures("unprobed")
def test_a_missing_extra_is_offered_and_is_no_failure_nor_is_one_that_cannot_be_had(course, monkeypatch):
    wanted = [
        "numpy", "no-such-engine>=4; extra == 'engines'", "no-such-linter; extra == 'dev'",
        "pybullet>=3.2.7; python_version < '3.0' and extra == 'bullet'",
    ]  # fmt: skip
    monkeypatch.setattr("course.extras._lines", lambda: wanted)
    ran = course("doctor", "--json")
    assert ran.code == 0
    assert [fix["command"] for fix in ran.json["fixes"]] == ["pip install 'no-such-engine>=4'"]
    assert {package["group"] for package in ran.json["packages"]} == {"", "engines"}
    (sentence,) = ran.json["unserved"]
    assert sentence.startswith("Optional (bullet): pybullet has no wheel for Python 3.")
    assert sentence in ran.err
