"""Solution packs: the same bytes each time, and nothing believed that was not checked."""

import hashlib
import io
import json
import stat
import warnings
import zipfile
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from course.catalog import pack
from course.errors import CourseError, IntegrityError, MissingCapabilityError, NotFoundError, UsageError

FILE = "solutions/doubling/doubling.py"
SOLUTIONS = {"doubling": {"doubling.py": b"def double(x):\n    return 2 * x\n", "README.md": b"Why.\n"}}


def packed():
    return pack.pack_bytes("mini", "0.1.0", SOLUTIONS)


def write(folder, data):
    path = folder / "s.coursepack"
    path.write_bytes(data)
    return path


def forge(folder, *, entries=None, manifest=None, mode=stat.S_IFREG | 0o644, twice=False, **change):
    """A pack put together by somebody else: a manifest that is true of the entries unless changed."""
    entries = {FILE: b"x = 1\n"} if entries is None else entries
    listed = [
        {"path": name, "size": len(data), "sha256": hashlib.sha256(data).hexdigest()}
        for name, data in entries.items()
    ]
    head = {
        "format": "course-solutions",
        "format_version": 1,
        "course_id": "mini",
        "course_version": "1",
        "files": listed,
        **change,
    }
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        if manifest is not False:
            archive.writestr("manifest.json", manifest if manifest is not None else json.dumps(head))
        for name, data in [*entries.items(), *(list(entries.items()) if twice else [])]:
            info = zipfile.ZipInfo(name)
            info.create_system, info.external_attr = 3, mode << 16
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # zipfile warns of the second entry of a name
                archive.writestr(info, data, zipfile.ZIP_DEFLATED)
    return write(folder, buffer.getvalue())


def test_the_same_solutions_give_the_same_bytes():
    backwards = {name: dict(reversed(files.items())) for name, files in reversed(SOLUTIONS.items())}
    assert pack.pack_bytes("mini", "0.1.0", backwards) == packed()
    with zipfile.ZipFile(io.BytesIO(packed())) as archive:
        # Neither the clock nor the system nor a compressor's version goes into them.
        marks = {(info.date_time, info.create_system, info.compress_type) for info in archive.infolist()}
    assert marks == {((1980, 1, 1, 0, 0, 0), 3, zipfile.ZIP_STORED)}


def test_a_hand_made_pack_with_a_true_manifest_is_read(tmp_path):
    assert pack.read_pack(forge(tmp_path)).solutions == {"doubling": {"doubling.py": b"x = 1\n"}}


@pytest.mark.parametrize(
    "name",
    [
        "../doubling.py",
        "/etc/doubling.py",
        "solutions/doubling/../../x.py",
        "solutions/doubling/sub/x.py",
        "solutions/Doubling/x.py",
        "solutions/doubling/.hidden",
        "solutions\\doubling\\x.py",
        "solutions/doubling/x.py\n",
        "C:x.py",
    ],
)
def test_a_name_that_is_no_plain_file_of_an_exercise_is_refused(tmp_path, name):
    with pytest.raises(IntegrityError):
        pack.read_pack(forge(tmp_path, entries={name: b"x = 1\n"}))


@pytest.mark.parametrize(
    ("tricks", "why"),
    [
        ({"twice": True}, "one twice"),
        ({"mode": stat.S_IFLNK | 0o777}, "is a link"),
        ({"entries": {FILE: b"0" * 1_000_001}}, "too large"),
        ({"entries": {f"solutions/doubling/f{i}.py": b"" for i in range(201)}}, "too many entries"),
        ({"entries": {f"{FILE}{i}": b"0" * 900_000 for i in range(6)}}, "unpacks to too much"),
    ],
    ids=["twice", "link", "large", "many", "bomb"],
)
def test_an_archive_with_tricks_is_refused(tmp_path, tricks, why):
    with pytest.raises(IntegrityError, match=why):
        pack.read_pack(forge(tmp_path, **tricks))


def test_an_entry_that_the_manifest_does_not_list_is_refused(tmp_path):
    with pytest.raises(IntegrityError, match="not the ones its manifest lists"):
        pack.read_pack(forge(tmp_path, files=[]))


@pytest.mark.parametrize(
    "change",
    [
        {"manifest": False},
        {"manifest": "{"},
        {"manifest": b"\xff\xfe"},
        {"format": "course-workspace"},
        {"format_version": 0},
        {"course_id": 3},
        {"files": [{"path": FILE, "size": 6, "sha256": hashlib.sha256(b"x = 2\n").hexdigest()}]},
    ],
)
def test_a_manifest_that_does_not_fit_is_refused(tmp_path, change):
    with pytest.raises(IntegrityError, match="is not a pack of solutions, or is damaged"):
        pack.read_pack(forge(tmp_path, **change))


def test_a_pack_of_a_newer_format_asks_for_a_newer_course(tmp_path):
    path = forge(tmp_path, format_version=2, something_new=True)
    with pytest.raises(MissingCapabilityError, match="pack format 2"):
        pack.read_pack(path)


@pytest.mark.parametrize("data", [b"", b"PK", b"not a zip at all", packed()[:-30], packed()[:100]])
def test_a_file_that_is_no_whole_zip_is_refused(tmp_path, data):
    with pytest.raises(IntegrityError):
        pack.read_pack(write(tmp_path, data))


def test_a_file_too_large_to_be_a_pack_is_refused_unread(tmp_path, monkeypatch):
    path = tmp_path / "s.coursepack"
    with path.open("wb") as file:
        file.truncate(50_000_000)
    monkeypatch.setattr(Path, "read_bytes", lambda self: pytest.fail("it was read"))
    with pytest.raises(IntegrityError, match="larger than any pack"):
        pack.read_pack(path)


def test_a_pack_that_is_not_there_is_not_found(tmp_path):
    with pytest.raises(NotFoundError):
        pack.read_pack(tmp_path / "none.coursepack")
    with pytest.raises(NotFoundError):
        pack.read_pack(tmp_path)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.integers(0, len(packed()) - 1), st.integers(1, 255))
def test_a_damaged_byte_is_noticed_or_changes_nothing(tmp_path, position, flip):
    data = bytearray(packed())
    data[position] ^= flip
    try:
        read = pack.read_pack(write(tmp_path, bytes(data)))
    except CourseError as error:
        assert isinstance(error, IntegrityError)  # noqa: PT017 - any other outcome is checked below
    else:
        assert read.solutions == SOLUTIONS
        assert read.course_id == "mini"


@pytest.mark.parametrize(
    "solutions",
    [
        {},
        {"doubling": {"../x.py": b""}},
        {"Doubling": {"x.py": b""}},
        {"doubling": {"x.py": b"0" * 1_000_001}},
        {"doubling": {f"f{index}.py": b"" for index in range(201)}},
        {"doubling": {f"f{index}.py": b"0" * 900_000 for index in range(6)}},
    ],
)
def test_what_could_not_be_read_back_is_not_packed(solutions):
    with pytest.raises(UsageError):
        pack.pack_bytes("mini", "1", solutions)
