"""The benchmarks are run by hand, so what they rely on, and what relies on them, is tested here."""

import json
from pathlib import Path

import pytest

from course.authoring.exercises.grading import mistakes_of
from course.authoring.exercises.proofs import caught_by
from course.authoring.mistakes import Variant
from course.catalog.load import Catalog
from course.scoring.judging.submission import Submission, Terms
from tests.benchmarks.calibration import seeds

MINI = Path(__file__).parents[2] / "fixtures" / "mini_course"


@pytest.mark.parametrize("here", [True, False])
def test_a_submission_is_graded_with_the_seed_that_was_sown(here):
    catalog = Catalog()
    exercise = catalog.exercise("fall-time")
    submission = Submission({exercise.module: exercise.stub_path.read_bytes()})
    with seeds.Seeded(exercise, catalog, scope="full", terms=Terms()) as session:
        session.here = here
        for seed in (3, 1234):
            session.sow(seed)
            loaded = session._load(submission)
            assert loaded.seed == seed
            loaded.close()


def test_what_is_on_record_is_of_the_programs_and_checks_that_there_are(tmp_path, monkeypatch):
    """As a program, its entry, a check or a known mistake changes, its line no longer holds."""
    catalog = Catalog()
    exercise = catalog.exercise("collisions")
    options = seeds.asked([exercise.id])
    names = {program.source: program.name for program in seeds.programs(exercise, catalog, options)}
    proven = seeds.proven(exercise, catalog)
    kinds = [names[source].partition("/")[0] for source in proven]
    assert kinds.count("mutants") == len(mistakes_of(catalog, exercise).wrong)
    assert kinds.count("accepted") == len(names) - kinds.count("mutants") - 1  # but for the solution

    source = next(source for source in proven if names[source].startswith("mutants/"))
    lines = [json.loads(line) for line in seeds.LOG.read_text(encoding="utf-8").splitlines()]
    for line in lines:
        line[-1] += line[0] == exercise.id and line[2] == names[source]
    with monkeypatch.context() as patch:
        (tmp_path / "log.jsonl").write_text("\n".join(map(json.dumps, lines)), encoding="utf-8")
        patch.setattr(seeds, "LOG", tmp_path / "log.jsonl")
        assert seeds.proven(exercise, catalog) == proven - {source}
    caught = dict.fromkeys(caught_by(catalog, exercise), "another_check")
    for where, name, instead, kept in (
        (seeds, "compose", lambda _, path: path.read_bytes() + b"\n", "mutants"),
        (Variant, "composed", lambda *_: "other = None\n", "accepted"),
        (seeds, "caught_by", lambda *_: caught, "accepted"),
        (seeds, "made_from", lambda *_: "other known mistakes", "accepted"),
        (
            seeds,
            "code_of",
            lambda *_: b"other checks",
            "mutants",
        ),  # a mutant goes by `made_from`, which holds it
    ):
        with monkeypatch.context() as patch:
            patch.setattr(where, name, instead)
            still = seeds.proven(exercise, catalog)
        assert {names[source].partition("/")[0] for source in still} == {kept}, name


def test_an_exercise_that_was_never_graded_under_all_seeds_has_nothing_on_record(monkeypatch):
    """And need not have its diagnoses in a file, as those have."""
    monkeypatch.setenv("COURSE_CONTENT", str(MINI))
    catalog = Catalog()
    assert [seeds.proven(exercise, catalog) for exercise in catalog.exercises()] == [frozenset()] * 2
