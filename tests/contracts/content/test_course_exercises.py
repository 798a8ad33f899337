"""The exercises that are shipped are right, as ``course author check`` says of each."""

from __future__ import annotations

import math

import pytest

from tests.contracts.content.audited import EACH, EXERCISES, IN_PART, changed, on_record, programs, wrong


@pytest.mark.parametrize("exercise", EXERCISES)
def test_the_audit_finds_nothing_wrong(exercise: str) -> None:
    report = changed(exercise)
    assert wrong(report) == []
    assert report.exercises == (exercise,)
    kept = len(on_record(exercise))
    assert report.graded == programs(exercise) - kept + math.ceil(kept / EACH)


@pytest.mark.soak
@pytest.mark.parametrize("exercise", EXERCISES)
def test_the_audit_finds_nothing_wrong_with_any_program(exercise: str) -> None:
    report = IN_PART(exercise)
    assert wrong(report) == []
    assert report.exercises == (exercise,)
    assert report.graded == programs(exercise)
