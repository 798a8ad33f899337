"""Archives from students, read as data: nothing is unpacked to disk, and nothing in them is trusted.

Links, devices, bombs and paths that lead elsewhere are refused with a reason that reaches the report. A
folder around everything, and the backslashes of Windows, are accepted and noted.
"""

import ast
import atexit
import contextlib
import functools
import hashlib
import json
import math
import os
import posixpath
import re
import stat
import struct
import sys
import time
import zipfile
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import IO, Any, TypeVar

import msgspec

from course.catalog.models import Exercise
from course.errors import UngradableError
from course.grading.intake import downloads
from course.grading.intake.downloads import IS_CODE, is_folder_meant, is_meant
from course.grading.pipes import Servant, limit_cpu, limit_memory, served, write_frame
from course.grading.quiz import checked_record
from course.handed_in import limits
from course.handed_in.limits import MANIFEST, MAX_FILE, MAX_NOTEBOOK, MAX_STREAMED, MAX_UNPACKED
from course.handed_in.notebook import notebook_source
from course.isolation.inside import statements
from course.printable import one_line, quoted, some
from course.scoring.verdict import Problem
from course.strangers import in_utf8

T = TypeVar("T")
Members = dict[str, zipfile.ZipInfo]

#: Bytes of a zip's list: some ten thousand names. An environment of Python has them, and is passed over.
MAX_LISTED = 1 << 20

_ARCHIVES = (".zip", ".tar", ".gz", ".tgz", ".bz2", ".xz", ".7z", ".rar", ".whl", ".jar")


class RefusedError(UngradableError):
    """One candidate cannot be read: it must not be opened, is damaged, or is not there. All here raise it."""

    def __init__(self, code: str, message: str, advice: str) -> None:
        super().__init__(one_line(message), help=advice, code=code)
        self.problem = Problem(code, one_line(message), advice)


def quiz_of(path: Path, loose: bytes) -> object:
    """The quiz attempts in what ``course submit`` wrote: an archive, or its metadata alone once unpacked.

    Words if they have another form, or if the metadata cannot be read and no file beside it will say so.

    Args:
        loose: the metadata, unpacked; empty if it is in an archive.
    """
    alone = bool(loose)
    try:
        if loose:
            return checked_record(_read_manifest(path, loose).get("quiz")) if _is_ours(loose) else []
        held = _given(_held(path))
        alone = len(held.names) <= 1
        return checked_record(_given(held.manifest).get("quiz"))
    except RefusedError as refused:
        if not alone:
            raise
        return refused.problem.message.rstrip(".")


def _is_ours(manifest: bytes) -> bool:
    """False for JSON of another program under that name; what is damaged may be ours."""
    with contextlib.suppress(ValueError, RecursionError):
        told = json.loads(manifest)
        return isinstance(told, dict) and "format_version" in told
    return True


class ArchiveContent(msgspec.Struct, frozen=True):
    """An archive's file for an exercise.

    Attributes:
        name: in the archive.
        notes: assumptions that were made, one sentence each.
        copies: the members that are the same file, this one included.
        written: the Python and NumPy that it was written with, by its own account; empty if it has none.
    """

    name: str
    content: bytes
    notes: tuple[str, ...] = ()
    copies: tuple[str, ...] = ()
    written: str = ""


def module_in(path: Path, exercise: Exercise) -> ArchiveContent | None:
    """A zip's module or notebook for an exercise; None if there is neither.

    Raises:
        RefusedError: also where it holds several.
    """

    held = _given(_held(path))
    wanted = _wanted_members(held.names, exercise)
    if not wanted:
        return None
    manifest = _given(held.manifest)
    contents = {name: _given(held.files[name]) for name in wanted}
    if len(set(contents.values())) > 1:
        names = " and ".join(map(quoted, wanted))
        message = f"{quoted(path.name)} holds several files for {exercise.id}: {names}."
        raise RefusedError("ambiguous_files", message, "Keep the one that counts.")
    name, content = next(iter(contents.items()))
    raw = held.names[name]
    listed = manifest.get("files", {})
    expected = listed.get(name, listed.get(raw))
    if manifest and expected != hashlib.sha256(content).hexdigest():
        message = f"{quoted(name)} in {quoted(path.name)} is not the file that `course submit` put there."
        advice = "Make the archive again with `course submit` and upload it unchanged."
        raise RefusedError("checksum_mismatch", message, advice)
    notes = tuple(_notes(path, name, raw, wanted, exercise))
    copies = tuple(held.names[other] for other in wanted)
    return ArchiveContent(raw, content, notes, copies, _written(manifest.get("written_with")))


_VERSION = re.compile(r"[\w.+-]{1,40}")
_TOOLS = (("python", "Python"), ("numpy", "NumPy"))


def _written(told: Any) -> str:
    """The versions that a manifest claims, as part of a sentence."""
    said = [(name, told.get(key)) for key, name in _TOOLS] if isinstance(told, dict) else []
    return " and ".join(f"{name} {v}" for name, v in said if isinstance(v, str) and _VERSION.fullmatch(v))


def _notes(path: Path, name: str, raw: str, wanted: list[str], exercise: Exercise) -> Iterator[str]:
    """The assumptions made about a member."""
    plain = raw.replace("\\", "/").rstrip("/")
    around = plain.removesuffix(name).strip("/").removesuffix(exercise.place).strip("/")
    zipped = quoted(path.name)
    if around:
        yield f"Everything in {zipped} lies in the folder {quoted(around)}, which was passed over."
    if "\\" in raw:
        yield f"{zipped} has backslashes in its paths; they were taken for folders."
    above, _, base = name.rpartition("/")
    if base not in {exercise.module, PurePosixPath(exercise.module).with_suffix(".ipynb").name}:
        yield f"{quoted(base)} was taken for {exercise.module}."
    if above not in {"", exercise.place, exercise.id}:
        yield f"The folder {quoted(above)} was taken for {exercise.place}."
    if len(wanted) > 1:
        yield f"The same file is in {zipped} {len(wanted)} times: {some([*map(quoted, wanted)], _SHOWN)}."


_SHOWN = 4


def _wanted_members(members: Iterable[str], exercise: Exercise) -> list[str]:
    """The members for an exercise, those with exactly its name first."""
    names = (exercise.module, PurePosixPath(exercise.module).with_suffix(".ipynb").name)
    found = [
        name
        for name in members
        if is_folder_meant(name.rpartition("/")[0] or ".", exercise.place)
        and any(is_meant(name.rpartition("/")[2], wanted) for wanted in names)
    ]
    return sorted(found, key=lambda name: (PurePosixPath(name).name not in names, "/" not in name, name))


def member_of(path: Path, name: str, meter: downloads.Meter) -> bytes:
    """The content of one member, by the name the archive has for it, or that name with plain slashes."""

    def is_it(plain: str, raw: str) -> bool:
        return name in {raw, raw.replace("\\", "/"), plain}

    with path.open("rb") as handle:
        kind = downloads.kind_of(path.name, handle.read(512))
    if kind in downloads.OPENERS:
        found = dict(_compressed(path, kind, meter))
        if name in found:
            return found[name]
    else:
        for content in _given(_tried(path, lambda: _read(path, is_it))).files.values():
            return _given(content)
    message = f"{quoted(path.name)} holds no {quoted(name)}."
    raise RefusedError("no_file", message, "Name a file that is in it.")


def _compressed(path: Path, kind: str, meter: downloads.Meter) -> list[tuple[str, bytes]]:
    """What may be code in an archive that is no zip, by name."""
    try:
        return list(downloads.compressed(path, kind, MAX_FILE, MAX_UNPACKED, meter))
    except downloads.TooMuchError as error:
        raise _refused(path, str(error)) from None
    except OSError as error:
        raise _refused(path, f"it cannot be read ({error})") from None


@dataclass(frozen=True)
class _Held:
    """A zip whose members are all harmless: their names there, by those without the folders around all of
    them; by these, what may be code, and by its name there what lies in folders that count nowhere; and the
    manifest of ``course submit``, if it has one. What cannot be read is why."""

    names: dict[str, str]
    files: dict[str, bytes | RefusedError]
    manifest: dict[str, Any] | RefusedError


#: Characters of what the library says of damage; it quotes names.
_SAID = 200


def _given(found: T | RefusedError) -> T:
    if isinstance(found, RefusedError):
        raise found
    return found


def _tried(path: Path, read: Callable[[], T]) -> T | RefusedError:
    """What reading an archive, or something in it, gives, or why it cannot be read."""
    try:
        return read()
    except RefusedError as refused:
        return refused
    except OSError as error:
        return _refused(path, f"it cannot be read ({error.strerror or error})")
    except Exception as error:  # noqa: BLE001 - zipfile and what unpacks for it raise all kinds at damage
        return _refused(path, f"it cannot be read ({str(error)[:_SAID] or type(error).__name__})")


@functools.lru_cache(maxsize=16)
def _held(path: Path) -> _Held | RefusedError:
    """An archive, read once for all questions about it (``_serve`` forgets it with the next student)."""

    def is_work(plain: str, _raw: str) -> bool:
        return downloads.may_be_code(plain) and not plain.endswith(MANIFEST)

    return _tried(path, lambda: _read(path, is_work))


def _read(path: Path, wanted: Callable[[str, str], bool]) -> _Held:
    if not stat.S_ISREG(path.lstat().st_mode):
        raise _refused(path, "it is not a regular file")
    if path.stat().st_size > limits.MAX_ARCHIVE:
        raise _refused(path, f"it is larger than {limits.MAX_ARCHIVE >> 20} MB")
    if _listed(path) > MAX_LISTED:
        raise _refused(path, "it holds tens of thousands of files")
    with zipfile.ZipFile(path) as archive:
        listed = [(_slashed(info), info) for info in archive.infolist() if not info.is_dir()]
        if any(downloads.too_deep(name) for name, _ in listed):
            raise _refused(path, downloads.DEEP)
        foreign = downloads.in_environment([name for name, _ in listed])
        own = [(name, info) for name, info in listed if not foreign(name)]
        members = _checked_members(path, [info for name, info in own if not downloads.in_clutter(name)])
        around = posixpath.commonpath([name.rpartition("/")[0] for name in members] or [""])
        members = {name.removeprefix(f"{around}/"): info for name, info in members.items()}
        names = {name: info.filename for name, info in members.items()}
        beside = [info for name, info in own if downloads.lies_aside(name)]
        aside = _tried(path, lambda: _checked_members(path, beside))
        files = {
            name: _tried(path, functools.partial(_unpacked, path, archive, info))
            for name, info in (members | (aside if isinstance(aside, dict) else {})).items()
            if wanted(name, info.filename)
        }
        info = members.get(MANIFEST)
        found = _tried(path, lambda: _read_manifest(path, _unpacked(path, archive, info))) if info else {}
        return _Held(names, files, found)


def _listed(path: Path) -> int:
    """Bytes of an archive's list of members, as it says itself: looked at before thousands are read."""
    with path.open("rb") as handle:
        handle.seek(max(path.stat().st_size - 22 - 0xFFFF, 0))
        _, found, end = handle.read().rpartition(b"PK\5\6")
    return struct.unpack_from("<I", end, 8)[0] if found and len(end) >= 12 else 0


def _refused(path: Path, why: str) -> RefusedError:
    advice = "Hand in the zip that `course submit` writes."
    return RefusedError("refused_archive", f"{quoted(path.name)}: {why}.", advice)


def _slashed(info: zipfile.ZipInfo) -> str:
    """A member's name with plain slashes."""
    return info.filename.replace("\\", "/")


def _checked_members(path: Path, files: list[zipfile.ZipInfo]) -> Members:
    """These members by name; every one is harmless."""
    if len(files) > limits.MAX_FILES:
        raise _refused(path, f"it holds more than {limits.MAX_FILES} files")
    code = (info for info in files if downloads.may_be_code(_slashed(info)))
    if sum(info.file_size for info in code) > MAX_UNPACKED:
        raise _refused(path, f"its files unpack to more than {MAX_UNPACKED >> 20} MB")
    members: Members = {}
    for info in files:
        name = PurePosixPath(_slashed(info))
        kind = stat.S_IFMT(info.external_attr >> 16)
        if name.is_absolute() or ".." in name.parts or ":" in info.filename:
            raise _refused(path, "a file in it has a path that leads outside")
        if kind not in (0, stat.S_IFREG):
            raise _refused(path, "it holds a link or a device")
        if info.flag_bits & 1:
            raise _refused(path, "it is encrypted")
        if name.suffix.lower() in _ARCHIVES:
            continue
        if name.as_posix() in members:
            raise _refused(path, "it holds two files of one name")
        members[name.as_posix()] = info
    if files and not members:  # beside files of its own, an archive in it is left alone
        raise _refused(path, "it holds nothing but another archive")
    return members


def _unpacked(path: Path, archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> bytes:
    """A member's content; the size in its header is not trusted."""
    with archive.open(info) as handle:
        content = handle.read(min(info.file_size, MAX_FILE) + 1)
    if len(content) > MAX_FILE:
        raise _refused(path, f"{quoted(info.filename)} unpacks to more than {MAX_FILE >> 20} MB")
    return content


def _read_manifest(path: Path, content: bytes) -> dict[str, Any]:
    """The metadata that ``course submit`` wrote."""
    manifest: Any = None
    with contextlib.suppress(ValueError, RecursionError):
        manifest = json.loads(content)
    match manifest:
        case {"format_version": int(version)} if version > limits.FORMAT_VERSION:
            message = f"{quoted(path.name)} was written by a newer version of this course."
            advice = "Update the course on the machine that grades."
            raise RefusedError("newer_format", message, advice)
        case {"format_version": int(), "files": dict(files)} if files or manifest.get("quiz"):
            return dict(manifest)
    raise _refused(path, f"its {MANIFEST} is damaged" if path.name != MANIFEST else "it is damaged")


# ---
# Submissions, read in a separate process that can be ended.
#
# Notebooks and archives are parsed there, with limits on CPU time, memory, wall time and the size of the
# answer; nothing in them is ever run. A file that exceeds a limit is named and cannot be graded; other files
# are not affected. ``python -m course.grading.intake.archives`` is the process; it answers frames of msgpack.


#: For one file. The largest notebook that may be handed in takes about 3 s of CPU, ten thousand lines of code
#: less than one; a busy machine may take six times as long by the wall clock.
CPU_S, WALL_S = 10, 60.0
#: CPU seconds for all files of one student. A dozen of the largest notebooks take some 40.
STUDENT_S = 60.0
MEMORY = 1 << 30
#: The largest answer, in bytes: a module and the notes on it.
MAX_ANSWER = 4 << 20


class _Request(msgspec.Struct, frozen=True):
    """One file to read, and what to look for in it.

    Attributes:
        kind: "notebook", "archive", "quiz", "outline" or "member".
        path: of an archive, or of a file to outline.
        content: of a notebook, or of a quiz record that is in no archive.
        name: what to call it in messages.
        student: whose it is, as a number; 0 if there is no telling, and then no archive is remembered.
        streamed: bytes of tar archives that may be decompressed.
    """

    kind: str
    name: str
    path: bytes = b""
    content: bytes = b""
    exercise: Exercise | None = None
    functions: tuple[str, ...] = ()
    skip: tuple[str, ...] = ()
    student: int = 0
    streamed: int = MAX_STREAMED


#: A file by its name in its archive, the digest of its content, the names of the functions in it and of those
#: that are written, the digest of its code, how much code was parsed to find them, and what it is if that is
#: not what its name says.
Outline = tuple[str, str, tuple[str, ...], tuple[str, ...], str, int, str]


class _Reply(msgspec.Struct, frozen=True):
    """What was asked for, or why there is none."""

    problem: Problem | None = None
    found: ArchiveContent | None = None
    content: bytes = b""
    record: bytes = b""
    outlines: tuple[Outline, ...] = ()
    cpu_s: float = 0.0
    streamed: int = 0


class Reader:
    """What the process reads; all that a file makes it refuse is a RefusedError."""

    def __init__(self, cpu_s: int = CPU_S, wall_s: float = WALL_S, memory: int = MEMORY) -> None:
        self._servant = Servant(__name__, str(cpu_s), str(memory), wall_s=wall_s)
        self.close = self._servant.close
        self._cpu_s = cpu_s
        self._whose: object = None
        self._student, self._left_s, self._streamed = 0, math.inf, MAX_STREAMED
        self._fatal: set[bytes] = set()

    def turn_to(self, student: object) -> None:
        """Begin with a student's files: each archive is read once, and for all there is so much time."""
        if student is not self._whose:
            self._whose, self._student = student, self._student + 1
            self._left_s, self._streamed = STUDENT_S, MAX_STREAMED
            self._fatal.clear()

    @property
    def spent(self) -> bool:
        """Whether a student's files have used up the time there is for them."""
        return self._left_s <= 0

    def notebook(self, content: bytes, exercise: Exercise, name: str) -> tuple[bytes, bytes]:
        """The module that a notebook makes up, and the record of its cells."""
        told = self._ask(_Request("notebook", quoted(name), content=content, exercise=exercise))
        return told.content, told.record

    def module_in(self, path: Path, exercise: Exercise) -> ArchiveContent | None:
        """An archive's file for an exercise; None if it has none.

        Raises:
            RefusedError: it must not be opened, or is damaged.
        """
        return self._ask(_about("archive", path, exercise=exercise)).found

    def outlines(self, path: Path, skip: tuple[str, ...], functions: tuple[str, ...]) -> tuple[Outline, ...]:
        """What a file is, and the functions that it defines, or each file in an archive.

        Args:
            skip: members of the archive to ignore.
            functions: the names to look for.
        """
        return self._ask(_about("outline", path, functions=functions, skip=skip)).outlines

    def member(self, path: Path, name: str) -> bytes:
        """The content of one file of an archive."""
        return self._ask(_about("member", path, skip=(name,))).content

    def quiz_in(self, path: Path, loose: bytes = b"") -> Any:
        """The quiz attempts in an archive; words if they have another form, None if it has none.

        Args:
            loose: what ``path`` holds, where that is no archive.
        """
        return json.loads(self._ask(_about("quiz", path, content=loose)).content)

    def _ask(self, ask: _Request) -> _Reply:
        if self.spent:
            message = f"{ask.name} was not read: what was handed in with it took all the time for reading."
            raise RefusedError("unreadable", message, "Hand in the .py files alone.")
        # Where the course lies, which need not be text, is nothing to read a file by.
        exercise = ask.exercise and msgspec.structs.replace(ask.exercise, folder="")
        ask = msgspec.structs.replace(ask, exercise=exercise, student=self._student, streamed=self._streamed)
        frame = None if ask.path in self._fatal else self._servant.ask(ask, MAX_ANSWER)
        if frame is None:
            if self._student and ask.path not in self._fatal:
                self._left_s -= self._cpu_s
                self._fatal |= {ask.path} - {b""}
            message = f"{ask.name} takes more time or memory to read than any honest file."
            advice = "Hand in the .py file, or a notebook of ordinary size."
            raise RefusedError("unreadable", message, advice)
        told = msgspec.msgpack.decode(frame, type=_Reply)
        if self._student:
            self._left_s -= told.cpu_s
            self._streamed -= told.streamed
        if told.problem is not None:
            raise RefusedError(*msgspec.structs.astuple(told.problem))
        return told


def _about(kind: str, path: Path, **more: Any) -> _Request:
    return _Request(kind, quoted(path.name), path=os.fsencode(path.absolute()), **more)


#: The one of this process: a run reads one file after the other.
reader = Reader()
atexit.register(reader.close)


# -- the process ------------------------------------------------------------------------------------------


def main() -> None:
    """Serve until standard input ends."""
    cpu_s, memory = int(sys.argv[1]), int(sys.argv[2])
    source, sink = sys.stdin.buffer, sys.stdout.buffer
    limit_memory(memory)
    with contextlib.suppress(BrokenPipeError, KeyboardInterrupt):  # whoever asked is gone
        write_frame(sink, None)
        _serve(source, sink, cpu_s)


def _serve(source: IO[bytes], sink: IO[bytes], cpu_s: int) -> None:
    student = 0
    for frame in served(source):
        limit_cpu(cpu_s)
        started = time.process_time()
        ask = msgspec.msgpack.decode(frame, type=_Request)
        if not ask.student or ask.student != student:
            _held.cache_clear()
        student, meter = ask.student, downloads.Meter(ask.streamed)
        try:
            told = _answer(ask, meter)
        except RefusedError as refused:
            told = _Reply(problem=refused.problem)
        except UngradableError as error:
            told = _Reply(problem=Problem(error.code, error.message, error.help))
        except OSError as error:
            told = _Reply(problem=Problem("unreadable", f"{ask.name} cannot be read: {error.strerror}.", ""))
        except MemoryError:
            os._exit(1)  # the parent process reports it
        took = time.process_time() - started
        write_frame(sink, msgspec.structs.replace(told, cpu_s=took, streamed=meter.used))


def _answer(ask: _Request, meter: downloads.Meter) -> _Reply:
    path = Path(os.fsdecode(ask.path))
    if ask.kind == "outline":
        return _Reply(outlines=tuple(_outlines(path, ask.skip, ask.functions, meter)))
    if ask.kind == "member":
        return _Reply(content=member_of(path, ask.skip[0], meter))
    if ask.kind == "quiz":
        return _Reply(content=json.dumps(quiz_of(path, ask.content)).encode())
    assert ask.exercise is not None
    if ask.kind == "archive":
        return _Reply(found=module_in(path, ask.exercise))
    module = notebook_source(ask.content, ask.exercise, ask.name)
    return _Reply(content=module.source, record=module.record())


def _outlines(
    path: Path, skip: tuple[str, ...], functions: tuple[str, ...], meter: downloads.Meter
) -> Iterator[Outline]:
    with path.open("rb") as handle:
        content = handle.read(MAX_NOTEBOOK + 1)
    kind = downloads.kind_of(path.name, content)
    if kind == "a zip archive" or path.suffix.casefold() == ".zip":
        held = _given(_held(path))
        named = ((held.names.get(name, name), content) for name, content in held.files.items())
        files = [(name, _given(content)) for name, content in named if name not in skip]
    elif kind in downloads.OPENERS:
        files = _compressed(path, kind, meter)
    else:
        digest = hashlib.sha256(content).hexdigest()
        if len(content) > MAX_NOTEBOOK:
            yield "", digest, (), (), "", 0, "larger than 32 MB"
        elif kind in IS_CODE:
            yield "", digest, *_defined(path.name, content, functions), kind
        else:
            yield "", digest, (), (), "", 0, kind
        return
    if not files and not _is_record(path):
        yield "", hashlib.sha256(content).hexdigest(), (), (), "", 0, f"{kind} without a file of code"
    for name, found in files:
        what = downloads.kind_of(name, found)
        digest = hashlib.sha256(found).hexdigest()
        yield name, digest, *(_defined(name, found, functions) if what in IS_CODE else ((), (), "", 0)), what


def _is_record(path: Path) -> bool:
    """Whether an archive has nothing but what ``course submit`` writes beside the files."""
    held = _held(path)
    return isinstance(held, _Held) and list(held.names) == [MANIFEST]


def _defined(
    name: str, content: bytes, functions: tuple[str, ...]
) -> tuple[tuple[str, ...], tuple[str, ...], str, int]:
    """The functions among these that a file's top level defines, those of them that are written, the digest
    of all that it defines and assigns, and how much code was parsed for that."""
    content = in_utf8(content)  # as ``assign`` reads it
    if not any(function.encode() in content for function in functions):
        return (), (), "", 0  # parsing takes a hundred times as long as looking
    pieces: list[str | bytes] = [content]
    try:
        if name.casefold().endswith(".ipynb") or downloads.is_notebook(content):
            cells = json.loads(content).get("cells", ())
            pieces = ["".join(cell.get("source", ())) for cell in cells if cell.get("cell_type") == "code"]
    except (ValueError, AttributeError, TypeError, RecursionError):
        return (), (), "", 0
    size = sum(map(len, pieces))
    if size > limits.MAX_CODE:
        return (), (), "", 0  # nor could it be graded
    written: dict[str, bool] = {}  # the last one of a name counts
    code = hashlib.sha256()
    for piece in pieces:
        found = readable(piece)
        raw = piece if isinstance(piece, bytes) else piece.encode("utf-8", "surrogatepass")
        lines = raw.replace(b"\r\n", b"\n").replace(b"\r", b"\n").split(b"\n")
        done = 0  # a line may hold thousands of statements
        for node in found.body if found else ():
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                written[node.name] = not _as_in_a_stub(node.body)
            if isinstance(node, _DEFINES):
                code.update(
                    b"".join(line + b"\n" for line in lines[max(node.lineno - 1, done) : node.end_lineno])
                )
                done = node.end_lineno or done
    defined = tuple(function for function in functions if function in written)
    return defined, tuple(function for function in defined if written[function]), code.hexdigest(), size


def readable(source: str | bytes) -> ast.Module | None:
    """The syntax tree of those statements that are Python, as graders read a module; None if none is."""
    if (whole := statements.tree(source)) is not None:
        return whole
    text = source if isinstance(source, str) else source.decode("utf-8", "replace")
    body = [node for piece in statements.pieces(text) for node in piece.body]
    return ast.Module(body, []) if body else None


#: Statements that make up a file's code; imports and tries may differ between a notebook and its module.
_DEFINES = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Assign, ast.AnnAssign)


def _as_in_a_stub(body: list[ast.stmt]) -> bool:
    """Whether nothing is written yet in a function: beside its docstring it raises NotImplementedError."""
    if ast.get_docstring(ast.Module(body, []), clean=False) is not None:
        body = body[1:]
    if not body or (len(body) == 1 and isinstance(body[0], ast.Pass)):
        return True
    raised = body[0].exc if len(body) == 1 and isinstance(body[0], ast.Raise) else None
    raised = raised.func if isinstance(raised, ast.Call) else raised
    return isinstance(raised, ast.Name) and raised.id == "NotImplementedError"


if __name__ == "__main__":
    main()
