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
import zipfile
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from importlib.util import cache_from_source
from pathlib import Path

from course.catalog.load import Catalog
from course.catalog.locate import NAMES, PLACES, Content, cache_folder, chosen
from course.catalog.pack import NOT_A_ZIP
from course.errors import IntegrityError, UsageError
from course.grading.gradebook.book import Gradebook
from course.isolation.launch import private_folder, remove_tree
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
    """

    sha256: str
    packed: bytes = field(repr=False)

    @classmethod
    def take(cls, content: Content, exercises: Collection[str] | None = None) -> Snapshot:
        """The graders as they are now.

        Args:
            exercises: ids, where no others and no quiz are to be graded; None for all.
        """
        digest, buffer = hashlib.sha256(), io.BytesIO()
        with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as archive:
            files = {name: path.read_bytes() for name, path in grader_files(content, exercises)}
            files[f"content/{NAMES}"] = _names(content)
            for name, body in sorted(files.items()):
                digest.update(f"{len(name)}:{name}:{len(body)}:".encode() + body)
                archive.writestr(zipfile.ZipInfo(name), body, zipfile.ZIP_DEFLATED)
        return cls(digest.hexdigest(), buffer.getvalue())

    @classmethod
    def of(cls, packed: bytes, sha256: str) -> Snapshot:
        """A stored snapshot, opened.

        Raises:
            IntegrityError: it has changed since.
        """
        digest = hashlib.sha256()
        for name, body in _members(packed):
            digest.update(f"{len(name)}:{name}:{len(body)}:".encode() + body)
        if digest.hexdigest() != sha256:
            raise _damaged(sha256)
        return cls(sha256, packed)


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
        differing = [name for name, body in _members(packed) if not _is_same(name, body, own.get(name))]
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
def frozen(snapshot: Snapshot) -> Iterator[Unpacked]:
    """Unpack a snapshot for as long as it is needed; graders find it by its digest in their terms."""
    known = _in_use.get(snapshot.sha256)
    if known is not None:
        yield known
        return
    folder = private_folder()
    try:
        _unpack(snapshot.packed, folder)
        it = _in_use[snapshot.sha256] = Unpacked(snapshot, folder, Catalog(chosen(folder / "content")))
        yield it
    finally:
        _in_use.pop(snapshot.sha256, None)
        remove_tree(folder)


def _unpack(packed: bytes, folder: Path) -> None:
    made: set[Path] = set()
    for name, body in _members(packed):
        path = folder / name
        if path.parent not in made:
            path.parent.mkdir(parents=True, exist_ok=True)
            made.add(path.parent)
        path.write_bytes(body)
        if name.startswith("course/") and name.endswith(".py"):
            _take_compiled(_PACKAGE / name.removeprefix("course/"), path, body)
    for name in ("exercises", "lessons", "quiz"):
        (folder / "content" / name).mkdir(parents=True, exist_ok=True)


def _take_compiled(original: Path, copy: Path, body: bytes) -> None:
    """Copy the package's compiled file if it belongs to this source, so that graders need not compile."""
    with contextlib.suppress(OSError, NotImplementedError):
        status, compiled = original.stat(), Path(cache_from_source(str(original)))
        if compiled.stat().st_mtime < status.st_mtime + _SETTLED_S or original.read_bytes() != body:
            return
        target = Path(cache_from_source(str(copy)))
        target.parent.mkdir(exist_ok=True)
        target.write_bytes(compiled.read_bytes())
        # A compiled file names the size and time of its source.
        os.utime(copy, ns=(status.st_mtime_ns, status.st_mtime_ns))
