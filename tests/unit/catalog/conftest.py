"""A copy of the miniature course to break."""

import shutil
from pathlib import Path

import pytest

from course.catalog.load import Catalog
from course.catalog.locate import content

MINI = Path(__file__).parents[2] / "fixtures" / "mini_course"


@pytest.fixture
def mini(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a private copy of the miniature course, in use as the course."""
    folder = tmp_path / "mini"
    shutil.copytree(MINI, folder)
    monkeypatch.setenv("COURSE_CONTENT", str(folder))
    return folder


@pytest.fixture
def catalog(mini: Path) -> Catalog:
    return Catalog(content())
