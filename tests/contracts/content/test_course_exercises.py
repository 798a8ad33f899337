"""The exercises that are shipped are right, as ``course author check`` says of each; but for the longest."""

from __future__ import annotations

import pytest

from tests.contracts.content.audited import EXERCISES, LONGEST, wrong


@pytest.mark.parametrize("exercise", [exercise for exercise in EXERCISES if exercise != LONGEST])
def test_the_audit_finds_nothing_wrong(exercise: str) -> None:
    assert wrong(exercise) == []
