"""Where content is found."""

from __future__ import annotations

from pathlib import Path

import pytest

from course.catalog import locate
from course.errors import InternalError, UsageError


def _package(root: Path) -> Path:
    (root / "course" / "lessons").mkdir(parents=True)
    return root / "course"


def test_an_unpacked_source_archive_is_a_students(tmp_path: Path) -> None:
    package = _package(tmp_path)
    (tmp_path / "pyproject.toml").touch()
    (tmp_path / "exercises").mkdir()
    found = locate._installed(package)
    assert not found.is_checkout
    assert found.solutions is None


def test_a_wheel_reads_the_content_inside_the_package(tmp_path: Path) -> None:
    package = _package(tmp_path)
    (package / "content" / "exercises").mkdir(parents=True)
    # What another package has put beside it is not ours.
    (tmp_path / "exercises").mkdir()
    (tmp_path / "solutions").mkdir()
    (tmp_path / "pyproject.toml").touch()
    found = locate._installed(package)
    assert found.exercises == package / "content" / "exercises"
    assert found.quiz == package / "content" / "quiz"
    assert found.solutions is None
    assert found.graders is None


def test_an_installation_without_content_says_so(tmp_path: Path) -> None:
    with pytest.raises(InternalError, match="exercises are missing"):
        locate._installed(_package(tmp_path))


@pytest.mark.parametrize("missing", ["exercises", "lessons"])
def test_a_selected_folder_that_is_no_course_is_refused(mini: Path, missing: str) -> None:
    (mini / missing).rename(mini / "gone")
    with pytest.raises(UsageError, match="holds no course") as caught:
        locate.content()
    assert caught.value.code == "no_such_content"
