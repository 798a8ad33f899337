"""Graders frozen per run: what judges is what was there when the run began, whatever is edited meanwhile."""

import json
import os
import shutil
import signal
import sys
import time
from functools import partial
from importlib.util import cache_from_source
from pathlib import Path

import grimp
import pytest

from course.catalog.load import Catalog
from course.errors import IntegrityError, InternalError, NotFoundError
from course.grading.gradebook.book import Gradebook
from course.grading.running.batch import grade_all, start_grader
from course.grading.running.folder import open_results
from course.grading.running.grader import Config
from course.grading.running.rerun import RerunOptions, rerun
from course.grading.running.run import RunOptions, grade_class
from course.grading.running.snapshot import Snapshot, frozen, in_use
from course.scoring.explain.story import forget_tables
from course.scoring.graders import grader_files, grader_version
from course.scoring.judging.submission import Terms
from tests.journeys.processes import below
from tests.unit.grading.running.test_run import make_class, right, scores

ROOT = Path(__file__).resolve().parents[4]
#: In a hidden check of ``double``: so edited, nobody passes it.
DUE, EDITED = "-34.5,", "-35.5,"


@pytest.fixture
def course(copied):
    return Catalog()


def edit(course):
    checks = course.content.graders / "doubling" / "checks.py"
    text = checks.read_text("utf-8")
    assert DUE in text
    checks.write_text(text.replace(DUE, EDITED), "utf-8")


def options(level="L1", **more):
    return RunOptions(exercises=("doubling",), terms=Terms(level=level), seed=3, **more)


def outcomes(out):
    with Gradebook(out / "gradebook.sqlite") as book:
        return {
            result.key.student: (
                result.key.grader_version,
                result.verdict.score,
                [(check.id, check.status, check.points) for check in result.verdict.checks],
            )
            for result in book.results()
        }


def judged_by_the_snapshot(out, course, version, snapshot, level=None):
    """Of a run during which ``course`` was edited: who judged, what that would change, the way back."""
    now = grader_version(course.exercise("doubling"), course)
    assert now != version
    first = outcomes(out)
    assert {judged_by for judged_by, _, _ in first.values()} == {version}
    assert {score for _, score, _ in first.values()} == {10.0, 6.0}
    # Changed by the edit, and made again from the snapshot of the first run: the same to the point.
    with open_results(out, writing=True) as results:
        changes = rerun(results, course, RerunOptions(level=level)).changes
    assert sorted((change.student, change.raw_before, change.raw_after) for change in changes) == sorted(
        (student, score, score - 2.0) for student, (_, score, _) in first.items() if score == 10.0
    )
    assert {judged_by for judged_by, _, _ in outcomes(out).values()} == {now}
    with open_results(out, writing=True) as results:
        again = rerun(results, course, RerunOptions(level=level, against="1"))
    assert again.graders == snapshot
    assert outcomes(out) == first
    with Gradebook(out / "gradebook.sqlite") as book:
        kept = [(run.kind, run.options["snapshot"] == snapshot) for run in book.runs()]
    assert kept == [("run", True), ("rerun", False), ("rerun", True)]


#: What the machine has best in an ordinary run, and plain processes, one for each student, beside it.
LEVELS = [pytest.param(None, id="best"), pytest.param("L1", marks=pytest.mark.soak)]


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="finds graders in /proc")
@pytest.mark.parametrize("level", LEVELS)
def test_an_edit_and_a_killed_grader_change_nothing_in_a_run(tmp_path, course, solution, level):
    """When the first result is in: all are judged as before, by what their graders say.

    There are two of them, and one makes everything again.
    """
    students = 40 if level else 6
    make_class(tmp_path / "class", solution, students)
    version = grader_version(course.exercise("doubling"), course)
    killed = []

    def report(*_):
        if not killed:
            edit(course)
            killed.extend(pid for pid, (_, line) in below(os.getpid()).items() if "running.grader" in line)
            for pid in killed:
                os.kill(pid, signal.SIGKILL)

    out = tmp_path / "out"
    two = partial(grade_all, graders=2)
    summary = grade_class(tmp_path / "class", out, course, options(level), report, grade=two)
    assert scores(out) == {f"student-{number:03}": 10.0 if number % 3 else 6.0 for number in range(students)}
    assert killed
    judged_by_the_snapshot(out, course, version, summary.graders, level)


def test_resuming_after_an_edit_grades_the_rest_as_the_run_began_and_says_what_was_edited(
    tmp_path, course, solution
):
    make_class(tmp_path / "class", solution, 3)
    out = tmp_path / "out"
    first = grade_class(tmp_path / "class", out, course, options(), lambda *_: None, grade=right)
    before = outcomes(out)
    edit(course)
    make_class(tmp_path / "more", solution, 5)
    reported = []
    again = grade_class(
        tmp_path / "more", out, course, options(resume=True),
        lambda item, *_: reported.append(item.student), grade=right,
    )  # fmt: skip
    assert reported == ["student-003", "student-004"]
    assert again.graders == first.graders
    assert again.edited == ["doubling"]
    after = outcomes(out)
    assert {name: after[name] for name in before} == before
    assert len({version for version, _, _ in after.values()}) == 1
    with open_results(out) as results, pytest.raises(NotFoundError, match="no graders"):
        rerun(results, course, RerunOptions(dry_run=True, against="9"))


def test_a_snapshot_is_known_by_what_is_in_it(tmp_path, course):
    one = Snapshot.take(course.content)
    assert Snapshot.take(course.content).sha256 == one.sha256
    assert Snapshot.of(one.packed, one.sha256) == one
    with frozen(one) as graders_then:
        version = graders_then.version("doubling")
        assert version == grader_version(course.exercise("doubling"), course)
        assert in_use(one.sha256) is graders_then
        edit(course)
        assert graders_then.version("doubling") == version
    assert in_use(one.sha256) is None
    assert not graders_then.folder.exists()
    other = Snapshot.take(course.content)
    assert other.sha256 != one.sha256
    for packed in (other.packed, b"", one.packed[:-50], b"PK" + one.packed[2:100]):
        with pytest.raises(IntegrityError):
            Snapshot.of(packed, one.sha256)
    with pytest.raises(InternalError, match="not unpacked"):
        start_grader(Config(Terms(graders=one.sha256), 0))


def test_a_snapshot_of_the_whole_course_has_about_a_megabyte(monkeypatch):
    """docs/instructor.md says so: it is in every gradebook."""
    monkeypatch.delenv("COURSE_CONTENT", raising=False)
    assert 0.8e6 < len(Snapshot.take(Catalog().content).packed) < 1.5e6


def test_an_old_pyc_is_never_taken_for_an_edited_file(tmp_path, course):
    """A compiled file comes along only where its source has long been as it is."""
    with frozen(Snapshot.take(course.content)) as graders_then:
        for path in (graders_then.folder / "course").rglob("*.py"):
            compiled = path.parent / "__pycache__"
            if compiled.is_dir() and list(compiled.glob(f"{path.stem}.cpython*.pyc")):
                original = ROOT / path.relative_to(graders_then.folder)
                assert path.read_bytes() == original.read_bytes()
                assert int(path.stat().st_mtime) == int(original.stat().st_mtime)


def test_what_is_not_graded_is_only_declared_in_an_unpacked_snapshot(course):
    """Until it is graded, too: a run within another asks for more."""
    snapshot = Snapshot.take(course.content)
    with frozen(snapshot, ["doubling"]) as graders_then:
        content = graders_then.catalog.content
        assert graders_then.catalog.exercise_ids() == course.exercise_ids()
        assert graders_then.version("doubling") == grader_version(course.exercise("doubling"), course)
        assert [path.name for path in (content.exercises / "halving").iterdir()] == ["exercise.toml"]
        with frozen(snapshot) as again:
            assert again is graders_then
        assert grader_version(course.exercise("halving"), graders_then.catalog) == grader_version(
            course.exercise("halving"), course
        )


def test_checks_come_compiled_and_are_compiled_where_they_lie(course, monkeypatch):
    checks = course.content.exercises / "doubling" / "checks.py"
    shutil.rmtree(checks.parent / "__pycache__", ignore_errors=True)  # of the course that this is a copy of
    for dont, age in ((True, 60.0), (False, 0.0), (False, 60.0)):
        monkeypatch.setattr(sys, "dont_write_bytecode", dont)
        os.utime(checks, (time.time() - age,) * 2)
        with frozen(Snapshot.take(course.content)) as graders_then:
            copy = graders_then.folder / "content" / "exercises" / "doubling" / "checks.py"
            compiled = [Path(cache_from_source(str(path))).exists() for path in (checks, copy)]
            assert compiled == [not dont and age > 0] * 2


def test_what_grades_imports_nothing_that_is_not_in_the_snapshot(course):
    """Not at the top and not in a function: a module that is missing would be found out by some student."""
    with frozen(Snapshot.take(course.content)) as graders_then:
        paths = [path.relative_to(graders_then.folder) for path in graders_then.folder.glob("course/**/*.py")]
    there = {".".join(path.with_suffix("").parts).removesuffix(".__init__") for path in paths}
    graph = grimp.build_graph("course", exclude_type_checking_imports=True, cache_dir=None)
    missing = {name: graph.find_modules_directly_imported_by(name) - there for name in there}
    assert not {name: absent for name, absent in missing.items() if absent}


def test_a_warm_up_alone_takes_its_words_along_and_knows_when_they_change(tmp_path, course):
    """They stand in one file for all warm-ups, beside their folders."""
    root = course.content.graders.parent
    for place in ("exercises", "solutions"):
        shutil.copytree(ROOT / place / "warm-ups" / "error-left", root / place / "warm-ups" / "error-left")
    for name in ("lesson", "after"):  # of the course that it was taken from
        path = root / "exercises" / "warm-ups" / "error-left" / "exercise.toml"
        lines = path.read_text("utf-8").splitlines(keepends=True)
        kept = [line for line in lines if not line.startswith(f"{name} =")]
        path.write_text("".join(kept), "utf-8")
    path.write_text(path.read_text("utf-8").replace("order =", 'lesson = "twice-as-much"\norder ='), "utf-8")
    table = path.parent.with_name("diagnoses.json")
    table.write_text(json.dumps({"error-left": {"words": {}}, "other": {}}), "utf-8")
    files = {name for name, _ in grader_files(course.content, ["error-left"])}
    assert "content/exercises/warm-ups/diagnoses.json" in files
    warm_up = course.exercise("error-left")
    before = grader_version(warm_up, course)
    table.write_text(json.dumps({"error-left": {"words": {}}, "other": {"made_from": "x"}}), "utf-8")
    forget_tables()
    assert grader_version(warm_up, course) == before
    table.write_text(json.dumps({"error-left": {"made_from": "x"}}), "utf-8")
    forget_tables()
    assert grader_version(warm_up, course) != before
