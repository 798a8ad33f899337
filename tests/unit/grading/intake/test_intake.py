"""A class folder as data: every odd thing in it is refused with a reason and read as nothing else."""

from __future__ import annotations

import hashlib
import json
import os
import stat
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import pytest

from course.catalog.models import Exercise
from course.errors import NotFoundError
from course.grading.intake.downloads import Place, Student, class_list
from course.grading.intake.students import Entry, read_student
from course.handed_in.limits import MAX_DEEP, MAX_FILE, MAX_FILES, MAX_PATH
from course.scoring.verdict import Problem, not_graded
from tests.unit.grading.made import notebook, put

SOURCE = b"def double(x):\n    return 2 * x\n"


def entry(folder: Path, exercise: Exercise, *, required: bool = True) -> Entry:
    (found,) = read_student(Student("ada", Place(folder)), [exercise], required=required)
    return found


def reason(folder: Path, exercise: Exercise) -> str:
    found = entry(folder, exercise)
    assert found.submission is None
    assert found.problem is not None
    assert found.problem.message
    assert found.problem.help
    return found.problem.code


def archive(path: Path, members: dict[str, bytes], *, manifest: Any = (), mode: int = 0o100644) -> Path:
    """As ``submit`` makes it; ``manifest``: what else its own file says, or all of it, or None for none."""
    sums = {name: hashlib.sha256(content).hexdigest() for name, content in members.items()}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as target:
        for name, content in members.items():
            info = zipfile.ZipInfo(name)
            info.external_attr = mode << 16
            target.writestr(info, content, zipfile.ZIP_DEFLATED)
        if manifest is not None:
            if not isinstance(manifest, str):
                manifest = json.dumps({"format_version": 1, "files": sums, **dict(manifest)})
            target.writestr("submission.json", manifest)
    return path


FOUND = "doubling/doubling.py"
LAID: dict[str, Callable[[Path], object]] = {
    "a module": lambda folder: (folder / "doubling.py").write_bytes(SOURCE),
    "a module in its folder": lambda folder: put(folder / FOUND, SOURCE),
    "a zip made by submit": lambda folder: archive(folder / "mine.zip", {FOUND: SOURCE}),
    "a zip made by hand, with what systems add": lambda folder: archive(
        folder / "mine.zip",
        {FOUND: SOURCE, "__MACOSX/doubling/._doubling.py": b"x", ".DS_Store": b"y"},
        manifest=None,
    ),
    "a notebook": lambda folder: put(folder / "doubling.ipynb", notebook("print(1)", SOURCE.decode())),
    "a notebook in a zip": lambda folder: archive(
        folder / "mine.zip", {"doubling/doubling.ipynb": notebook(SOURCE.decode())}
    ),
}


@pytest.mark.parametrize("what", LAID)
def test_a_module_is_found_wherever_it_may_be(tmp_path: Path, doubling: Exercise, what: str) -> None:
    LAID[what](tmp_path)
    found = entry(tmp_path, doubling)
    assert found.submission is not None
    files = {name: text.strip() for name, text in found.submission.files.items()}
    assert files.pop("doubling.py") == SOURCE.strip()
    assert list(files) == ["notebook.json"] * ("notebook" in what)


def test_without_a_file_it_is_ungradable_if_asked_for_and_else_not_submitted(
    tmp_path: Path, doubling: Exercise
) -> None:
    assert reason(tmp_path, doubling) == "no_file"
    quiet = entry(tmp_path, doubling, required=False)
    assert quiet.submission is None
    assert quiet.problem is None


def test_a_notebook_larger_than_a_module_may_be_is_read_past_its_outputs(
    tmp_path: Path, doubling: Exercise
) -> None:
    large = json.loads(notebook(SOURCE.decode()))
    large["cells"][0]["outputs"] = [{"output_type": "stream", "name": "stdout", "text": "x" * 2 * MAX_FILE}]
    (tmp_path / "doubling.ipynb").write_text(json.dumps(large), "utf-8")
    assert entry(tmp_path, doubling).submission is not None
    (tmp_path / "doubling.ipynb").write_bytes(notebook(SOURCE.decode(), f"def double(): '{'x' * MAX_FILE}'"))
    assert reason(tmp_path, doubling) == "too_large"


def test_a_module_and_a_notebook_are_never_guessed_between(tmp_path: Path, doubling: Exercise) -> None:
    (tmp_path / "doubling.ipynb").write_bytes(notebook(SOURCE.decode()))
    (tmp_path / "doubling.py").write_bytes(SOURCE)
    assert reason(tmp_path, doubling) == "ambiguous_files"
    packed = tmp_path / "packed"
    packed.mkdir()
    both = {"doubling/doubling.py": SOURCE, "doubling/doubling.ipynb": notebook(SOURCE.decode())}
    archive(packed / "mine.zip", both)
    assert reason(packed, doubling) == "ambiguous_files"


@pytest.mark.parametrize(
    ("name", "content", "code"),
    [
        ("doubling.py", b"#" * (MAX_FILE + 1), "too_large"),
        ("doubling.py", b" \n\t", "empty_file"),
        ("doubling.py", None, "not_a_file"),
        ("doubling.ipynb", b"{}", "not_a_notebook"),
        ("doubling.ipynb", b" ", "empty_file"),
        ("doubling.ipynb", notebook("x = 1"), "no_declared_functions"),
    ],
    ids=lambda value: str(value)[:20],
)
def test_what_is_not_a_plain_file_of_reasonable_size_and_kind_is_refused(
    tmp_path: Path, doubling: Exercise, name: str, content: bytes | None, code: str
) -> None:
    if content is None:
        (tmp_path / name).mkdir()
    else:
        (tmp_path / name).write_bytes(content)
    assert reason(tmp_path, doubling) == code


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="links and pipes as POSIX has them")
def test_links_and_pipes_are_refused_and_never_followed_or_waited_for(
    tmp_path: Path, doubling: Exercise
) -> None:
    secret = tmp_path / "secret.py"
    secret.write_bytes(SOURCE)
    target = tmp_path / "student" / "doubling.py"
    target.parent.mkdir()
    target.symlink_to(secret)
    assert reason(target.parent, doubling) == "symlink"
    target.unlink()
    os.mkfifo(target)
    assert reason(target.parent, doubling) == "not_a_file"
    target.unlink()
    (target.parent / "doubling").symlink_to(tmp_path, target_is_directory=True)
    (tmp_path / "doubling.py").write_bytes(SOURCE)
    assert reason(target.parent, doubling) == "symlink"
    linked = tmp_path / "linked"
    linked.symlink_to(target.parent, target_is_directory=True)
    assert reason(linked, doubling) == "symlink"


def _bomb(path: Path) -> None:
    archive(path, {"doubling/doubling.py": b"#" * (4 << 20)})


def _many(path: Path) -> None:
    archive(path, {f"file{number}.txt": b"" for number in range(MAX_FILES + 1)})


def _lying_size(path: Path) -> None:
    archive(path, {"doubling/doubling.py": b"#" * (MAX_FILE + 1)}, manifest=None)
    raw = bytearray(path.read_bytes())
    size = (MAX_FILE + 1).to_bytes(4, "little")
    while (at := raw.find(size)) >= 0:
        raw[at : at + 4] = (100).to_bytes(4, "little")
    path.write_bytes(raw)


@pytest.mark.parametrize(
    "make",
    [
        _bomb,
        _many,
        _lying_size,
        lambda path: archive(path, {"../doubling.py": SOURCE}),
        lambda path: archive(path, {"/etc/doubling.py": SOURCE}),
        lambda path: archive(path, {"..\\doubling.py": SOURCE}),
        lambda path: archive(path, {"C:/doubling.py": SOURCE}),
        lambda path: archive(path, {FOUND: SOURCE, "a/" * (MAX_DEEP + 1) + "x.md": b""}),
        lambda path: archive(path, {FOUND: SOURCE, "a" * (MAX_PATH + 1): b""}),
        lambda path: archive(path, {"doubling/doubling.py": b"/etc/passwd"}, mode=stat.S_IFLNK | 0o777),
        lambda path: archive(path, {"inner.zip": b"PK", "doubling/doubling.py": SOURCE}),
        lambda path: path.write_bytes(b"PK\x03\x04 and nothing that follows"),
        lambda path: path.write_bytes(b""),
        lambda path: path.mkdir(),
    ],
    ids=[
        "bomb", "many files", "lying size", "parent path", "absolute path", "backslash", "drive", "deep path",
        "long path", "link", "nested", "damaged", "empty", "a folder",
    ],
)  # fmt: skip
def test_hostile_archives_are_refused(
    tmp_path: Path, doubling: Exercise, make: Callable[[Path], object]
) -> None:
    make(tmp_path / "mine.zip")
    assert reason(tmp_path, doubling) == "refused_archive"


def test_the_versions_at_home_are_told_where_they_mattered_and_nowhere_else(
    tmp_path: Path, doubling: Exercise
) -> None:
    written = {"python": "3.13.1", "numpy": "2.9.0"}
    archive(tmp_path / "mine.zip", {FOUND: SOURCE}, manifest={"written_with": written})
    found = entry(tmp_path, doubling)
    assert found.written == "Python 3.13.1 and NumPy 2.9.0"
    fine = not_graded("doubling", 10, "ungradable", Problem("x", "x", "x"))
    assert found.told(fine).warnings == ()
    note = "line 3: left out. Python 3.12 reads that, but it is checked with Python 3.11."
    told = found.told(msgspec.structs.replace(fine, warnings=(note,))).warnings
    assert told == (note, "It was written with Python 3.13.1 and NumPy 2.9.0.")
    for none in ("x", {"python": 3}, {"python": "3; \x1b[31m"}, {"python": "3" * 99}, None):
        archive(tmp_path / "mine.zip", {FOUND: SOURCE}, manifest={"written_with": none})
        assert entry(tmp_path, doubling).written == "", none
    made = json.loads(notebook(SOURCE.decode()))
    made["metadata"]["language_info"] = {"name": "python", "version": "3.13.1"}
    (tmp_path / "mine.zip").unlink()
    (tmp_path / "doubling.ipynb").write_text(json.dumps(made))
    assert entry(tmp_path, doubling).written == "Python 3.13.1"


@pytest.mark.parametrize(
    ("manifest", "code"),
    [
        ({"files": {FOUND: "0" * 64}}, "checksum_mismatch"),
        ('{"format_version": 2, "files": {}}', "newer_format"),
        ("[1, 2", "refused_archive"),
        ("[" * 100_000, "refused_archive"),
        ('{"format_version": 1, "files": [1]}', "refused_archive"),
        ("null", "refused_archive"),
    ],
    ids=lambda value: str(value)[:40],
)
def test_a_manifest_that_cannot_be_trusted_is_refused(
    tmp_path: Path, doubling: Exercise, manifest: Any, code: str
) -> None:
    archive(tmp_path / "mine.zip", {FOUND: SOURCE}, manifest=manifest)
    assert reason(tmp_path, doubling) == code


@pytest.mark.skipif(os.name == "nt", reason="file names are text there")
def test_names_that_are_no_text_stay_apart(tmp_path: Path, doubling: Exercise) -> None:
    for raw in (b"\xff", b"\\xff"):
        folder = tmp_path / os.fsdecode(raw)
        folder.mkdir()
        (folder / "doubling.py").write_bytes(SOURCE)
    names = [student.name for student in class_list(tmp_path).students]
    assert len(set(names)) == 2
    for name in names:
        name.encode("utf-8")


def test_no_such_class_is_said_plainly(tmp_path: Path) -> None:
    with pytest.raises(NotFoundError, match="not a folder of submissions"):
        class_list(tmp_path / "nowhere")
