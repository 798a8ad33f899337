"""Which protection levels the machine that runs the tests can provide.

A test calls ``require_level("L3")``. Where the machine lacks that level the test is skipped; but where
``COURSE_REQUIRE_LEVEL`` promises it, or a stronger one, lacking it is a failure: otherwise a build machine
that lost its protection would go on passing.
"""

import functools
import os

import pytest

from course.isolation.failures import IsolationError
from course.isolation.levels import Level
from course.isolation.probe import open_spawner


def require_level(name: str) -> Level:
    """The level, proven here; skips or fails the calling test where it is not to be had."""
    level = Level(name)
    missing = _missing(level)
    if missing:
        promised = os.environ.get("COURSE_REQUIRE_LEVEL", "")
        if promised and Level(promised) >= level:
            pytest.fail(f"COURSE_REQUIRE_LEVEL={promised} promises {level} here, but: {missing}")
        pytest.skip(f"{level} is not available here: {missing}")
    return level


@functools.cache
def _missing(level: Level) -> str:
    try:
        open_spawner(("numpy",), at_least=level, at_most=level).close()
    except IsolationError as error:
        return str(error)
    return ""
