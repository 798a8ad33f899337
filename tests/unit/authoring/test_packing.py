"""Packs made from a course."""

from __future__ import annotations

from pathlib import Path

import pytest

from course.authoring.exercises.grading import write_pack
from course.catalog.load import Catalog
from course.catalog.pack import read_pack
from course.errors import ContentError, MissingCapabilityError, NotFoundError, UsageError


def test_a_pack_holds_the_solution_and_its_prose(mini: Path, tmp_path: Path) -> None:
    output = tmp_path / "out.coursepack"
    names = write_pack(Catalog(), ["doubling", "halving", "doubling"], output)
    assert names == {"doubling": ("README.md", "doubling.py"), "halving": ("halving.py",)}
    read = read_pack(output)
    assert (read.course_id, read.course_version) == ("mini", "0.1.0")
    source = (mini / "solutions" / "doubling" / "doubling.py").read_bytes()
    assert read.solutions["doubling"]["doubling.py"] == source
    assert set(read.solutions["doubling"]) == {"doubling.py", "README.md"}
    assert [path.name for path in tmp_path.iterdir() if path.is_file()] == ["out.coursepack"]


def test_the_same_course_packs_to_the_same_bytes(mini: Path, tmp_path: Path) -> None:
    write_pack(Catalog(), ["doubling", "halving"], tmp_path / "a.coursepack")
    write_pack(Catalog(), ["halving", "doubling"], tmp_path / "b.coursepack")
    assert (tmp_path / "a.coursepack").read_bytes() == (tmp_path / "b.coursepack").read_bytes()


def test_an_existing_file_is_kept(mini: Path, tmp_path: Path) -> None:
    output = tmp_path / "out.coursepack"
    output.write_bytes(b"mine")
    with pytest.raises(UsageError, match="nothing is overwritten"):
        write_pack(Catalog(), ["doubling"], output)
    assert output.read_bytes() == b"mine"


def test_what_cannot_be_packed_is_said(mini: Path, tmp_path: Path) -> None:
    output = tmp_path / "out.coursepack"
    with pytest.raises(NotFoundError, match="no exercise called 'thirds'"):
        write_pack(Catalog(), ["thirds"], output)
    with pytest.raises(UsageError):
        write_pack(Catalog(), [], output)
    with pytest.raises(UsageError, match="cannot be written"):
        write_pack(Catalog(), ["doubling"], tmp_path / "none" / "out.coursepack")
    (mini / "solutions" / "doubling" / "doubling.py").unlink()
    with pytest.raises(ContentError, match="model solution is missing"):
        write_pack(Catalog(), ["doubling"], output)
    (mini / "solutions").rename(mini / "gone")
    with pytest.raises(MissingCapabilityError):
        write_pack(Catalog(), ["doubling"], output)
    assert not output.exists()
