"""A hidden number does not reach its student, however it is sent."""

import pytest

from course.isolation.levels import Level
from tests.benchmarks.redaction import SENDERS, trial
from tests.contracts.boundary.levels import require_level
from tests.turns import soak_unless

#: A check passes, fails by one of its own sentences, or gives no value in one of five ways.
_WAYS = 7
#: Those that choose among the ways to end; all others end in one way and differ in what goes with it.
_CHOOSE = {"which of all ends", "time of a right answer"}


@pytest.mark.parametrize("level", soak_unless([Level.L3], Level))
def test_a_hidden_number_does_not_reach_its_student(level):
    require_level(level)
    for name, (arrived, noted) in trial(4, level).items():
        assert len(arrived) <= (_WAYS if name in _CHOOSE else 1), name
        assert len(noted) > 1, f"{name} sends nothing"
    assert SENDERS.keys() >= _CHOOSE
