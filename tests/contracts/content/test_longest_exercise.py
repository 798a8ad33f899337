"""The same as ``test_course_exercises`` of the exercise that takes longest, for a worker of its own."""

from __future__ import annotations

from tests.contracts.content.audited import LONGEST, wrong


def test_the_audit_finds_nothing_wrong() -> None:
    assert wrong(LONGEST) == []
