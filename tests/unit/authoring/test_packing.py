"""Packs made from a course."""

from __future__ import annotations

from pathlib import Path

import pytest

from course.authoring.exercises.grading import write_pack
from course.catalog.load import Catalog
from course.errors import ContentError, NotFoundError, UsageError


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
    assert not output.exists()
