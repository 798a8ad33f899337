"""The miniature course, its model solution, and warm sessions over it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from course.catalog.load import Catalog
from course.grading.running.snapshot import Snapshot, frozen
from course.scoring.judging.session import GradingSession
from course.scoring.judging.terms import Terms

if TYPE_CHECKING:
    from collections.abc import Iterator

    from course.catalog.models import Exercise

MINI = Path(__file__).resolve().parents[2] / "fixtures" / "mini_course"


@pytest.fixture(scope="module")
def catalog() -> Iterator[Catalog]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COURSE_CONTENT", str(MINI))
        yield Catalog()


@pytest.fixture(scope="module")
def unpacked(catalog: Catalog) -> Iterator[None]:
    """The graders as a run unpacks them, once for all runs of a file; edited ones are others."""
    with frozen(Snapshot.take(catalog.content)):
        yield


@pytest.fixture(scope="module")
def doubling(catalog: Catalog) -> Exercise:
    return catalog.exercise("doubling")


@pytest.fixture(scope="module")
def solution() -> bytes:
    return (MINI / "solutions" / "doubling" / "doubling.py").read_bytes()


@pytest.fixture(scope="module")
def session(catalog: Catalog, doubling: Exercise) -> Iterator[GradingSession]:
    # A right solution takes milliseconds; what never answers is waited for, by each check of its task.
    with GradingSession(doubling, catalog, scope="full", terms=Terms(timeout=0.3)) as opened:
        yield opened
