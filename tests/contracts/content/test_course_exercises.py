"""The exercises that are shipped are right, as ``course author check`` says of each."""

from __future__ import annotations

import math

import pytest

from tests.benchmarks.calibration import seeds
from tests.contracts.content.audited import CATALOG, EACH, EXERCISES, IN_PART, changed, programs, wrong


@pytest.mark.parametrize("exercise", EXERCISES)
def test_the_audit_finds_nothing_wrong(exercise: str) -> None:
    report = changed(exercise)
    assert wrong(report) == []
    assert report.exercises == (exercise,)
    on_record = len(seeds.proven(CATALOG.exercise(exercise), CATALOG))
    assert report.graded == programs(exercise) - on_record + math.ceil(on_record / EACH)


@pytest.mark.soak
@pytest.mark.parametrize("exercise", EXERCISES)
def test_the_audit_finds_nothing_wrong_with_any_program(exercise: str) -> None:
    report = IN_PART(exercise)
    assert wrong(report) == []
    assert report.exercises == (exercise,)
    assert report.graded == programs(exercise)
