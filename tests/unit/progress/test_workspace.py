"""The workspace: found from anywhere inside it, and nothing in it is ever lost."""

import os

import pytest

from course.errors import ContentError, MissingCapabilityError, UsageError
from course.progress.workspace import Workspace, same_text, write_atomically


@pytest.fixture
def workspace(tmp_path):
    return Workspace.create(tmp_path / "my course é", "physics-sim", "1.0.0")


def test_create_keeps_what_is_there(tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    Workspace.create(tmp_path, "physics-sim", "1.0.0")
    with pytest.raises(UsageError):
        Workspace.create(tmp_path, "other", "2.0.0")
    assert (tmp_path / "notes.txt").read_text() == "mine"
    assert Workspace.read(tmp_path).course_id == "physics-sim"


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (b"format_version = 1\n[course\n", 2),
        (b"format_version = 1\n", None),
        (b"", None),
        (b'format_version = 1\n[course]\nid = 3\nversion = "1"\n', None),
        (b'format_version = "1"\n[course]\nid = "a"\nversion = "1"\n', None),
        (b"\xff\xfe\x00", None),
    ],
)
def test_a_damaged_course_toml_is_named_with_its_line(tmp_path, text, line):
    (tmp_path / "course.toml").write_bytes(text)
    with pytest.raises(ContentError) as caught:
        Workspace.find(tmp_path)
    assert str(tmp_path / "course.toml") in caught.value.message
    assert caught.value.line == line
    assert (tmp_path / "course.toml").read_bytes() == text


def test_a_workspace_of_a_newer_course_is_refused(tmp_path):
    (tmp_path / "course.toml").write_text('format_version = 2\nanything = "else"\n')
    with pytest.raises(MissingCapabilityError, match="newer version"):
        Workspace.find(tmp_path)


def test_give_never_overwrites(workspace):
    assert workspace.give("doubling", "doubling.py", b"stub\n")
    workspace.path("doubling", "doubling.py").write_bytes(b"mine\n")
    assert not workspace.give("doubling", "doubling.py", b"stub 2\n")
    assert workspace.path("doubling", "doubling.py").read_bytes() == b"mine\n"
    assert workspace.given("doubling", "doubling.py") == b"stub\n"


def test_give_does_not_write_through_a_dangling_link(workspace, tmp_path):
    folder = workspace.root / "doubling"
    folder.mkdir()
    (folder / "doubling.py").symlink_to(tmp_path / "elsewhere.py")
    assert not workspace.give("doubling", "doubling.py", b"stub\n")
    assert not (tmp_path / "elsewhere.py").exists()


def test_a_file_with_other_line_endings_is_the_same_text():
    assert same_text(b"a\nb\n", b"\xef\xbb\xbfa\r\nb\r\n")
    assert not same_text(b"a\nb\n", b"a\nc\n")


def test_two_backups_within_a_second_do_not_meet(workspace):
    workspace.give("doubling", "doubling.py", b"one")
    path = workspace.path("doubling", "doubling.py")
    first = workspace.backup(path, "reset")
    path.write_bytes(b"two")
    second = workspace.backup(path, "reset")
    assert first.read_bytes() == b"one"
    assert second.read_bytes() == b"two"
    assert second.name == "doubling.py"


def test_a_backup_of_a_file_from_elsewhere_lies_in_the_workspace(workspace, tmp_path):
    outside = tmp_path / "mine.zip"
    outside.write_bytes(b"zip")
    copy = workspace.backup(outside, "submit")
    assert copy.is_relative_to(workspace.state / "backups")
    assert copy.read_bytes() == b"zip"


def test_replacing_a_file_behind_a_link_keeps_the_link(tmp_path):
    real = tmp_path / "real.py"
    real.write_bytes(b"old")
    link = tmp_path / "link.py"
    link.symlink_to(real)
    write_atomically(link, b"new")
    assert link.is_symlink()
    assert real.read_bytes() == b"new"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link.py", "real.py"]


def test_the_version_is_changed_and_comments_stay(workspace):
    marker = workspace.root / "course.toml"
    marker.write_text(marker.read_text() + "# my own note\n")
    workspace.note_version("1.1.0")
    assert Workspace.read(workspace.root).version == "1.1.0"
    assert "# my own note" in marker.read_text()


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_that_cannot_be_written_is_said_so(workspace):
    workspace.root.chmod(0o555)
    try:
        with pytest.raises(MissingCapabilityError, match="cannot be written"):
            workspace.give("doubling", "doubling.py", b"stub")
    finally:
        workspace.root.chmod(0o755)


def test_nothing_is_put_where_a_workspace_was_before_it_was_moved(workspace, tmp_path):
    workspace.root.rename(tmp_path / "moved")
    for act in (
        lambda: workspace.give("doubling", "doubling.py", b"x = 1\n"),
        lambda: workspace.backup(tmp_path / "moved" / "course.toml", "reset"),
    ):
        with pytest.raises(MissingCapabilityError) as raised:
            act()
        assert raised.value.code == "workspace_gone"
    assert not workspace.root.exists()
