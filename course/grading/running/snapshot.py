"""The graders of a run, frozen: a copy made when the run began does the judging, whatever is edited since.

A snapshot holds everything that a grader process reads and imports: what ``course.scoring.graders`` lists. It
is one zip, known by a digest of its names and contents, and is kept in the gradebook, so that any result can
be reproduced later.

A grader process starts with the unpacked snapshot first on its path, so it and its successors run the frozen
code; with every verdict it sends the version that it computes of itself. A newer coordinator may run an old
snapshot, so the messages between the two (``grader``) may gain fields but never lose any.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import os
import py_compile
import shutil
import sys
import time
import zipfile
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from importlib.util import cache_from_source
from pathlib import Path

from course.catalog.load import Catalog
from course.catalog.locate import NAMES, PLACES, Content, cache_folder, chosen
from course.catalog.pack import NOT_A_ZIP
from course.errors import IntegrityError, UsageError
from course.grading.gradebook.book import Gradebook
from course.ids import WARM_UPS
from course.isolation.launch import private_folder
from course.printable import one_line
from course.scoring.graders import grader_files, grader_version

_PACKAGE = Path(__file__).resolve().parents[2]
_MAX_UNPACKED = 200 << 20
#: A compiled file is used only if it is so many seconds younger than its source: one that was compiled in the
#: second of an edit may be of the text before.
_SETTLED_S = 2.0
_FILES_NAMED = 5
#: What it means to grade with the code in a gradebook.
FOREIGN = "They are programs, and would run as you, outside any sandbox."


@dataclass(frozen=True)
class Snapshot:
    """Graders, frozen at one moment.

    Attributes:
        sha256: digest of the names and contents in it.
        packed: its content, as a zip.
        files: the same, unpacked.
        origins: where its files of the course's content were; empty for one that was stored.
    """

    sha256: str
    packed: bytes = field(repr=False)
    files: Mapping[str, bytes] = field(repr=False, compare=False)
    origins: Mapping[str, Path] = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def take(cls, content: Content, exercises: Collection[str] | None = None) -> Snapshot:
        """The graders as they are now.

        Args:
            exercises: ids, where no others and no quiz are to be graded; None for all.
        """
        buffer, paths = io.BytesIO(), dict(grader_files(content, exercises))
        files = {name: path.read_bytes() for name, path in paths.items()}
        files[f"content/{NAMES}"] = _names(content)
        files = dict(sorted(files.items()))
        with zipfile.ZipFile(buffer, "w") as archive:
            for name, body in files.items():
                archive.writestr(zipfile.ZipInfo(name), body, zipfile.ZIP_DEFLATED, compresslevel=3)
        return cls(_digest(files), buffer.getvalue(), files, paths)

    @classmethod
    def of(cls, packed: bytes, sha256: str) -> Snapshot:
        """A stored snapshot, opened.

        Raises:
            IntegrityError: it has changed since.
        """
        files = dict(_members(packed))
        if _digest(files) != sha256:
            raise _damaged(sha256)
        return cls(sha256, packed, files)


def _digest(files: Mapping[str, bytes]) -> str:
    digest = hashlib.sha256()
    for name, body in files.items():
        digest.update(f"{len(name)}:{name}:{len(body)}:".encode() + body)
    return digest.hexdigest()


class ForeignGradersError(UsageError):
    """A gradebook's graders are code that this checkout never had, and nobody has agreed to run it."""

    def __init__(self, book: Gradebook, sha256: str, differing: list[str]) -> None:
        run = next((run for run in book.runs() if run.options.get("snapshot") == sha256), None)
        who, at = (run.options.get("who", "?"), run.started_at) if run else ("?", "?")
        files = ", ".join(differing[:_FILES_NAMED]) + (", ..." if len(differing) > _FILES_NAMED else "")
        many = "one file differs" if len(differing) == 1 else f"{len(differing)} files differ"
        super().__init__(
            f"This gradebook's graders are not this checkout's: {many} ({one_line(files)}). It says that"
            f" {one_line(str(who))} began the run with them, at {one_line(str(at))}.",
            help=f"{FOREIGN} If you trust whoever made this gradebook, add --yes;"
            " `course grade rerun` without --against grades with this checkout's.",
            code="foreign_graders",
        )
        self.sha256 = sha256


def fresh(content: Content) -> Snapshot:
    """The graders as they are now, for a gradebook; this checkout knows them again when it has changed."""
    snapshot = Snapshot.take(content)
    with contextlib.suppress(OSError):
        known = _known(content, snapshot.sha256)
        known.parent.mkdir(parents=True, exist_ok=True)
        known.touch()
    return snapshot


def kept(book: Gradebook, sha256: str | None, content: Content, accepted: str = "") -> Snapshot | None:
    """The snapshot of that digest in a gradebook; None where it has none.

    It is code, which a grader runs as the user who grades. So it must be this checkout's own, or accepted.

    Args:
        content: what this checkout grades with.
        accepted: the digest of a snapshot that may run, whoever made it.

    Raises:
        IntegrityError: it is damaged.
        ForeignGradersError: it is neither, nor has this checkout begun a run with it.
    """
    packed = book.snapshot(sha256) if sha256 else None
    if not packed or not sha256:
        return None
    snapshot = Snapshot.of(packed, sha256)
    if accepted != sha256 and not _is_known(content, sha256):
        own = dict(grader_files(content))
        differing = [name for name, body in snapshot.files.items() if not _is_same(name, body, own.get(name))]
        if differing:
            raise ForeignGradersError(book, sha256, differing)
    return snapshot


def _is_same(name: str, body: bytes, path: Path | None) -> bool:
    """Whether a file of a snapshot is what lies here; how folders are called is no code."""
    return name == f"content/{NAMES}" or (path is not None and path.read_bytes() == body)


def _known(content: Content, sha256: str) -> Path:
    """An empty file that says: this checkout, with this content, has begun a run with these graders."""
    about = hashlib.sha256(f"{_PACKAGE}\0{content.root}\0{sha256}".encode("utf-8", "surrogateescape"))
    return cache_folder("graders") / about.hexdigest()


def _is_known(content: Content, sha256: str) -> bool:
    with contextlib.suppress(OSError):
        # A cache that many share says nothing that another could have written.
        return _known(content, sha256).stat().st_uid == (os.getuid() if hasattr(os, "getuid") else 0)
    return False


def among_graders(folder: Path, content: Content) -> bool:
    """Whether a folder goes into snapshots, or lies in one that does."""
    folders = [content.quiz, *(content.place(name) for name in PLACES)]
    return any(one and folder.resolve().is_relative_to(one.resolve()) for one in folders)


def _names(content: Content) -> bytes:
    """How the content's folders are called where they are, for messages about a file."""
    folders = {name: content.place(name) for name in PLACES}
    return json.dumps({name: content.shown(folder) for name, folder in folders.items() if folder}).encode()


def _members(packed: bytes) -> Iterator[tuple[str, bytes]]:
    """Names and contents; every name lies inside."""
    try:
        with zipfile.ZipFile(io.BytesIO(packed)) as archive:
            infos = archive.infolist()
            if sum(info.file_size for info in infos) > _MAX_UNPACKED:
                raise _damaged("")
            for info in infos:
                if info.filename.startswith("/") or ".." in info.filename.split("/") or "\\" in info.filename:
                    raise _damaged("")
                yield info.filename, archive.read(info)
    except (zipfile.LargeZipFile, *NOT_A_ZIP):
        raise _damaged("") from None


def _damaged(sha256: str) -> IntegrityError:
    return IntegrityError(
        " ".join(f"The snapshot {sha256[:12]} of the graders is damaged.".split()),
        help="`course grade salvage` looks for it in the backups; `course grade rerun` grades with the ones"
        " of now.",
    )


@dataclass(frozen=True)
class Unpacked:
    """A snapshot that is unpacked.

    Attributes:
        folder: holds ``course``, importable, and ``content``.
        catalog: the course in it.
    """

    snapshot: Snapshot
    folder: Path
    catalog: Catalog
    _versions: dict[str, str] = field(default_factory=dict, repr=False, compare=False)

    def version(self, exercise_id: str) -> str:
        """The version of an exercise's graders in it."""
        if exercise_id not in self._versions:
            exercise = self.catalog.exercise(exercise_id)
            self._versions[exercise_id] = grader_version(exercise, self.catalog, self.folder / "course")
        return self._versions[exercise_id]


#: The unpacked snapshots of this process, by digest: what ``Terms.graders`` names.
_in_use: dict[str, Unpacked] = {}


def in_use(sha256: str) -> Unpacked | None:
    """The snapshot of that digest, if it is unpacked here."""
    return _in_use.get(sha256)


@contextlib.contextmanager
def frozen(snapshot: Snapshot, exercises: Collection[str] | None = None) -> Iterator[Unpacked]:
    """Unpack a snapshot for as long as it is needed; graders find it by its digest in their terms.

    Args:
        exercises: ids, where no others are to be graded: of these there is only what declares them. None for
            all.
    """
    known = _in_use.get(snapshot.sha256)
    if known is not None:
        _unpack(snapshot, known.folder, exercises)
        yield known
        return
    folder = private_folder()
    try:
        _unpack(snapshot, folder, exercises)
        it = _in_use[snapshot.sha256] = Unpacked(snapshot, folder, Catalog(chosen(folder / "content")))
        yield it
    finally:
        _in_use.pop(snapshot.sha256, None)
        shutil.rmtree(folder, ignore_errors=True)


def _unpack(snapshot: Snapshot, folder: Path, exercises: Collection[str] | None) -> None:
    """Write what is not there yet, each program with its compiled file, so that graders need not compile."""
    kinds = {name.split("/")[1] for name in snapshot.files if name.startswith("content/")} - {NAMES}
    for kind in kinds | {"exercises", "lessons", "quiz"}:
        (folder / "content" / kind).mkdir(parents=True, exist_ok=True)
    for name, body in snapshot.files.items():
        path, exercise = folder / name, _exercise_of(name)
        if path.exists() or not (exercises is None or exercise in {"", *exercises}):
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(body)
        if path.suffix == ".py" and (exercises is not None or f"/{WARM_UPS}/" not in name):
            _take_compiled(snapshot.origins.get(name, _PACKAGE.parent / name), path, body)


def _exercise_of(name: str) -> str:
    """The exercise that a file is of; none for what all share, and for what declares one."""
    _, kind, *inside = name.split("/")
    if inside[:1] == [WARM_UPS]:
        del inside[0]
    return inside[0] if kind in PLACES and len(inside) > 1 and inside[-1] != "exercise.toml" else ""


def _take_compiled(original: Path, copy: Path, body: bytes) -> None:
    """Link a compiled file if it belongs to this source; it is made first where it is missing or too old."""
    with contextlib.suppress(OSError, NotImplementedError, py_compile.PyCompileError):
        status, compiled = original.stat(), Path(cache_from_source(str(original)))
        settled = status.st_mtime + _SETTLED_S
        if settled > time.time() or original.read_bytes() != body:
            return
        if not compiled.is_file() or compiled.stat().st_mtime < settled:
            if sys.dont_write_bytecode:
                return
            py_compile.compile(str(original), doraise=True)
        target = Path(cache_from_source(str(copy)))
        target.parent.mkdir(exist_ok=True)
        try:  # no new file: Python replaces compiled files as a whole, and changes none
            target.hardlink_to(compiled)
        except OSError:
            target.write_bytes(compiled.read_bytes())
        # A compiled file names the size and time of its source.
        os.utime(copy, ns=(status.st_mtime_ns, status.st_mtime_ns))
