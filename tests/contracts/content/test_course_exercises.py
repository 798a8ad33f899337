"""The exercises that are shipped are right, as ``course author check`` says of each; but for the longest."""

from __future__ import annotations

import pytest

from tests.contracts.content.audited import EXERCISES, IN_FULL, LONGEST, wrong


@pytest.mark.parametrize("exercise", [exercise for exercise in EXERCISES if exercise != LONGEST])
def test_the_audit_finds_nothing_wrong(exercise: str) -> None:
    assert wrong(exercise) == []


@pytest.mark.soak
@pytest.mark.parametrize("exercise", EXERCISES)
def test_the_audit_finds_nothing_wrong_whatever_check_a_mutant_fails(exercise: str) -> None:
    assert wrong(exercise, grade=IN_FULL) == []
