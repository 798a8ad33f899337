"""Solution packs, which an instructor hands out after the deadline and ``course solution`` opens.

A pack is a zip, ``NAME.coursepack``::

    manifest.json                     format, course, and the SHA-256 of every other entry
    solutions/<exercise-id>/<file>    the model solution, and README.md with its prose if there is one

The same content gives the same bytes: entries are stored, sorted and dated alike. A pack comes from outside,
so nothing in it is believed before sizes, names and sums are checked, and nothing is ever unpacked to disk.
"""

import errno
import hashlib
import io
import re
import stat
import struct
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import msgspec

from course.errors import IntegrityError, MissingCapabilityError, NotFoundError, UsageError
from course.ids import ExerciseId
from course.strangers import read_bytes

FORMAT = "course-solutions"
FORMAT_VERSION = 1
MANIFEST = "manifest.json"
MAX_FILES = 200
MAX_FILE_BYTES = 1_000_000
MAX_TOTAL_BYTES = 5_000_000

_ENTRY = re.compile(r"solutions/(?P<exercise>[^/]+)/(?P<name>[A-Za-z0-9_][A-Za-z0-9_.-]{0,99})")
#: The exceptions of zipfile for bytes that are not a zip, or are a damaged one.
NOT_A_ZIP = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    KeyError,
    ValueError,
    RuntimeError,
    OSError,
)
_ASK_AGAIN = "Ask for a new copy where you got it."


class PackedFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One entry, as the manifest describes it; ``size`` in bytes."""

    path: str
    size: int
    sha256: str


class _Version(msgspec.Struct, frozen=True):
    """As much of a manifest as every format has."""

    format: str
    format_version: int


class Manifest(_Version, frozen=True, forbid_unknown_fields=True):
    """``manifest.json``."""

    course_id: str
    course_version: str
    files: tuple[PackedFile, ...]


@dataclass(frozen=True, slots=True)
class Pack:
    """Solutions of some exercises of one course.

    Attributes:
        solutions: file contents by exercise id and file name.
    """

    course_id: str
    course_version: str
    solutions: dict[str, dict[str, bytes]]


def pack_bytes(course_id: str, course_version: str, solutions: Mapping[str, Mapping[str, bytes]]) -> bytes:
    """A pack of these solutions; the same arguments always give the same bytes.

    Raises:
        UsageError: an id or file name cannot be packed, or there is too much of it.
    """
    entries = {
        f"solutions/{exercise}/{name}": content
        for exercise, files in solutions.items()
        for name, content in files.items()
    }
    for path, content in entries.items():
        _check_entry(path, content)
    if not entries or len(entries) > MAX_FILES or sum(map(len, entries.values())) > MAX_TOTAL_BYTES:
        problem = f"A pack holds 1 to {MAX_FILES} files and at most {MAX_TOTAL_BYTES} bytes."
        raise UsageError(problem, help="Name at least one exercise, or make several packs.")
    files = tuple(
        PackedFile(path, len(entries[path]), hashlib.sha256(entries[path]).hexdigest())
        for path in sorted(entries)
    )
    manifest = Manifest(FORMAT, FORMAT_VERSION, course_id, course_version, files)
    head = msgspec.json.format(msgspec.json.encode(manifest), indent=1) + b"\n"
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as archive:
        archive.writestr(zip_entry(MANIFEST), head)
        for path in sorted(entries):
            archive.writestr(zip_entry(path), entries[path])
    return buffer.getvalue()


def read_pack(path: Path) -> Pack:
    """The pack at ``path``, checked.

    Raises:
        NotFoundError: there is no such file.
        IntegrityError: it is not a pack, or it is damaged.
        MissingCapabilityError: it has a format newer than this program.
    """
    try:
        data = read_bytes(path, MAX_TOTAL_BYTES + MAX_FILES * 1000)
    except (FileNotFoundError, NotADirectoryError):
        raise NotFoundError(f"There is no file {path}.", help="Check the name of the pack.") from None
    except OSError as error:
        if error.errno == errno.EFBIG:
            raise _damaged(path, "it is larger than any pack") from None
        problem = f"{path} cannot be read: {error.strerror}."
        raise NotFoundError(problem, help="Name a file made by `course author pack`.") from None
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return _read_archive(path, archive)
    except NOT_A_ZIP as error:
        raise _damaged(path, f"it is not a readable zip ({type(error).__name__})") from None


def _read_archive(path: Path, archive: zipfile.ZipFile) -> Pack:
    infos = archive.infolist()
    names = [info.filename for info in infos]
    if len(infos) > MAX_FILES + 1 or len(set(names)) != len(names):
        raise _damaged(path, "it has too many entries, or one twice")
    for info in infos:
        if info.file_size > MAX_FILE_BYTES or stat.S_ISLNK(info.external_attr >> 16):
            raise _damaged(path, f"entry {info.filename[:80]!r} is too large or is a link")
    if sum(info.file_size for info in infos) > MAX_TOTAL_BYTES:
        raise _damaged(path, "it unpacks to too much")
    if MANIFEST not in names:
        raise _damaged(path, "it has no manifest")
    manifest = _read_manifest(path, archive.read(MANIFEST))
    if sorted([MANIFEST, *(entry.path for entry in manifest.files)]) != sorted(names):
        raise _damaged(path, "its entries are not the ones its manifest lists")
    solutions: dict[str, dict[str, bytes]] = {}
    for entry in manifest.files:
        content = archive.read(entry.path)
        if len(content) != entry.size or hashlib.sha256(content).hexdigest() != entry.sha256:
            raise _damaged(path, f"the checksum of {entry.path[:80]!r} does not match")
        try:
            exercise, name = _check_entry(entry.path, content)
        except UsageError as error:
            raise _damaged(path, error.message) from None
        solutions.setdefault(exercise, {})[name] = content
    return Pack(manifest.course_id, manifest.course_version, solutions)


def _read_manifest(path: Path, data: bytes) -> Manifest:
    try:
        version = msgspec.json.decode(data, type=_Version)
        if version.format == FORMAT and version.format_version > FORMAT_VERSION:
            raise MissingCapabilityError(
                f"{path.name} has pack format {version.format_version}; this program reads {FORMAT_VERSION}.",
                help="Install a newer version of the course.",
                code="newer_format",
            )
        manifest = msgspec.json.decode(data, type=Manifest)
    except (msgspec.DecodeError, UnicodeDecodeError):
        raise _damaged(path, "its manifest cannot be read") from None
    if manifest.format != FORMAT or manifest.format_version < 1:
        raise _damaged(path, "it is a zip, and not one of solutions")
    return manifest


def _check_entry(path: str, content: bytes) -> tuple[str, str]:
    """The exercise and file name of an entry whose name is safe anywhere."""
    match = _ENTRY.fullmatch(path)
    if match is None or len(content) > MAX_FILE_BYTES:
        raise UsageError(
            f"{path[:80]!r} is not an entry that a pack may have, or is larger than {MAX_FILE_BYTES} bytes."
        )
    return ExerciseId(match["exercise"]), match["name"]


def zip_entry(name: str, mode: int = 0o644) -> zipfile.ZipInfo:
    """A file in a zip whose bytes depend on neither the hour nor the machine that packs it."""
    info = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))  # the earliest date a zip can hold
    info.create_system = 3  # Unix everywhere
    info.external_attr = (stat.S_IFREG | mode) << 16
    return info


def _damaged(path: Path, why: str) -> IntegrityError:
    return IntegrityError(
        f"{path} is not a pack of solutions, or is damaged: {why}.", help=_ASK_AGAIN, code="damaged_pack"
    )
