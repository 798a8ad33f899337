"""The miniature course, its model solution, and warm sessions over it."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from course.catalog.load import Catalog
from course.catalog.locate import chosen
from course.catalog.models import Exercise
from course.grading.running.snapshot import Snapshot, frozen
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Terms

MINI = Path(__file__).resolve().parents[2] / "fixtures" / "mini_course"


@pytest.fixture(autouse=True)
def _chosen(monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory) -> None:
    """What looks for the course of this process finds the miniature one, for as long as a test lasts."""
    monkeypatch.setenv("COURSE_CONTENT", str(MINI))
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path_factory.getbasetemp() / "cache"))


@pytest.fixture
def copied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of it that may be edited; what looks for the course finds that."""
    monkeypatch.setenv("COURSE_CONTENT", str(tmp_path / "course"))
    return shutil.copytree(MINI, tmp_path / "course")


@pytest.fixture(scope="module")
def catalog() -> Catalog:
    return Catalog(chosen(MINI))


@pytest.fixture(scope="module")
def unpacked(catalog: Catalog) -> Iterator[str]:
    """Digest of the graders, unpacked as a run does it, once for a file of tests; edited ones are others."""
    with frozen(Snapshot.take(catalog.content)) as graders:
        yield graders.snapshot.sha256


@pytest.fixture(scope="module")
def doubling(catalog: Catalog) -> Exercise:
    return catalog.exercise("doubling")


@pytest.fixture(scope="module")
def solution() -> bytes:
    return (MINI / "solutions" / "doubling" / "doubling.py").read_bytes()


@pytest.fixture(scope="module")
def session(catalog: Catalog, doubling: Exercise) -> Iterator[GradingSession]:
    # A right solution takes milliseconds; what never answers is waited for, by each check of its task.
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COURSE_CONTENT", str(MINI))
        opened = GradingSession(doubling, catalog, scope="full", terms=Terms(timeout=0.3))
    with opened:
        yield opened
