"""The exercises that are shipped are right, as ``course author check`` says of each."""

import math

import pytest

from course.authoring.exercises.diagnosis import rows_of
from course.authoring.exercises.proofs import read_record
from course.scoring.explain.story import read_table
from tests.contracts.content.audited import (
    CATALOG,
    EACH,
    EXERCISES,
    IN_PART,
    changed,
    on_record,
    programs,
    wrong,
)


@pytest.mark.parametrize("exercise", EXERCISES)
def test_the_audit_finds_nothing_wrong(exercise):
    report = changed(exercise)
    assert wrong(report) == []
    assert report.exercises == (exercise,)
    kept = len(on_record(exercise))
    assert report.graded == programs(exercise) - kept + math.ceil(kept / EACH)


@pytest.mark.soak
@pytest.mark.parametrize("exercise", EXERCISES)
def test_the_audit_finds_nothing_wrong_with_any_program(exercise):
    report = IN_PART(exercise)
    assert wrong(report) == []
    assert report.exercises == (exercise,)
    assert report.graded == programs(exercise)


#: Where no wrong program is known by its answers, checks are alone in every run.
KNOWN = [
    name
    for name in EXERCISES
    if (table := read_table(CATALOG.exercise(name).readme_path.parent)) and any(table.rows.values())
]


@pytest.mark.soak
@pytest.mark.parametrize("exercise", KNOWN)
def test_what_checks_say_where_no_wrong_program_is_known_is_on_record(exercise):
    it = CATALOG.exercise(exercise)
    kept = read_record(CATALOG, it)
    told = rows_of(CATALOG, it, scopes=("alone",))["alone"]
    assert [row for row in told if row not in kept.rows["alone"]] == []
    assert len(told) == len(kept.rows["alone"])
