"""A class folder of any origin: one folder per student, or a learning platform's download.

    folders      SUBMISSIONS/<student>/...
    moodle       SUBMISSIONS/<Full Name>_<number>_assignsubmission_file/...   or files that begin so
    canvas       SUBMISSIONS/<name>[_LATE]_<user>_<attachment>_<file name>, and what was typed into it:
                 <name>[_LATE]_<user>_text.html or _link.html; <name> is anon where it grades anonymously
    gradescope   SUBMISSIONS/submission_<number>/... with submission_metadata.yml

The kind follows from all the names together, and from nothing that lies in a student's folder: that is the
student's. A folder in which only some names are a platform's is refused, and the others are listed; a file
without a known owner is reported, never guessed.
"""

import bz2
import contextlib
import datetime as dt
import gzip
import lzma
import os
import re
import tarfile
import unicodedata
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath
from typing import Any

from course import extras
from course.errors import NotFoundError, UsageError
from course.grading.gradebook.records import PlatformIdentity
from course.handed_in.limits import HANDED_IN, MAX_DEEP, MAX_PATH, MAX_STREAMED
from course.printable import quoted, some
from course.strangers import read_bytes

# ---
# File names, and the spellings of them that are accepted without asking.
#
# Letter case does not matter, nor does the number that a browser, Canvas or Windows adds to a second
# download. Every such spelling is named in the result. Any other name is for triage.


_NUMBERED = re.compile(r"(?:\s*\([0-9]{1,3}\)|-[0-9]{1,3})+$")
#: Characters at the end of a name in which numbers are looked for, which takes quadratic time.
_END = 40


def _unnumbered(name: str) -> str:
    return name[:-_END] + _NUMBERED.sub("", name[-_END:])


def plain(name: str) -> str:
    """A file's name without letter case, and without the number of a copy: ``Name (2).py`` is ``name.py``."""
    stem, dot, suffix = unicodedata.normalize("NFC", name).rpartition(".")
    return (_unnumbered(stem) + dot + suffix.rstrip()).casefold()


def is_meant(name: str, wanted: str) -> bool:
    """Whether a file of this name is the wanted one."""
    return name == wanted or plain(name) == wanted.casefold()


def is_folder_meant(name: str, wanted: str) -> bool:
    """Whether a folder of this name is the wanted one, or the top, which is ".".

    A warm-up's is ``warm-ups/<id>`` in a workspace, and ``<id>`` alone where a student made it.
    """
    names = {wanted.casefold(), wanted.rpartition("/")[2].casefold()}
    return name == "." or _unnumbered(name).casefold() in names or name.casefold() in names


LAYOUTS = ("auto", "folders", "canvas", "moodle", "gradescope")

#: Files that operating systems and tools put into folders by themselves.
IGNORED = frozenset(
    {
        "__MACOSX", "__pycache__", ".DS_Store", ".course", ".git", ".idea", ".ipynb_checkpoints", ".svn",
        ".vscode", "Thumbs.db", "desktop.ini",
    }
)  # fmt: skip

# Moodle takes '_' out of names, so that no name a student gives a file can pass for another student's.
_MOODLE = re.compile(
    r"(?P<name>[^_]*)_(?P<key>[0-9]+)_assignsubmission_(?P<plugin>[a-z]+)(?:_(?P<file>.*))?", re.S
)
# Canvas takes '_<digits>_' out of names, so the first two numbers are its own. Graded anonymously, a student
# is a few letters and digits, and no name.
_CANVAS = re.compile(
    r"(?:(?P<name>.*?)(?P<late>_LATE)?_(?P<key>[0-9]+)"
    r"|(?P<anon>anon)(?P<anon_late>_LATE)?_(?P<anon_key>[A-Za-z0-9]{4,8}))"
    r"_(?:(?P<attachment>[0-9]+)_(?P<file>.+)|(?P<typed>text|link)\.html)",
    re.S,
)
_GRADESCOPE = re.compile(r"submission_[0-9]+")
_METADATA = "submission_metadata.yml"
_MAX_METADATA = 200 << 20
_SHOWN = 5


@dataclass(frozen=True)
class Place:
    """Where a student's files are: a folder of their own, or some of the files in a shared one.

    Attributes:
        files: name the student gave -> path, where the folder is shared; None for a folder of one's own.
        top: the folder that was handed in, where folders around everything were passed over.
    """

    root: Path
    files: tuple[tuple[str, Path], ...] | None = None
    top: Path | None = None

    def find(self, wanted: str, inside: str) -> list[Path]:
        """Files that a name may mean, at the top or in a subfolder, those with exactly that name first; none
        is opened."""
        if self.files is None:
            found = _entries(self.root)
            for name, path in [*found, *([(inside, self.root / inside)] if "/" in inside else [])]:
                found += _entries(path) if name != "." and is_folder_meant(name, inside) else []
        else:
            found = [(name, path) for name, path in self.files if "/" not in name]
        mine = [(name != wanted, path) for name, path in found if is_meant(name, wanted)]
        return [path for _, path in sorted(mine, key=lambda item: item[0])]

    def unwrapped(self, known: Collection[str]) -> "Place":
        """The folder that has everything in it, as a workspace that was handed in whole; else this place.

        Args:
            known: folders that belong there.
        """
        root = self.root
        for _ in range(_WRAPPED if self.files is None else 0):
            inside = [one for one in _entries(root) if not is_clutter(one[0])]
            if len(inside) != 1 or inside[0][1].is_symlink() or not inside[0][1].is_dir():
                break
            if "." in inside[0][0] or any(is_folder_meant(inside[0][0], one) for one in known):
                break
            root = inside[0][1]
        return self if root is self.root else Place(root, top=self.root)

    def archives(self) -> list[Path]:
        """The zip files, by name."""
        found = self.root.iterdir() if self.files is None else (path for _, path in self.files)
        return sorted(path for path in found if path.suffix.lower() == ".zip")

    def given(self, path: Path) -> str:
        """The name that the student gave a file."""
        return next((name for name, mine in self.files or () if mine == path), path.name)

    def shown(self, path: Path) -> str:
        """A path relative to the folder, as a sentence names it."""
        return quoted(str(path.relative_to(self.root)))


#: Folders around everything that are passed over.
_WRAPPED = 3


def _entries(folder: Path) -> list[tuple[str, Path]]:
    """Names in a folder, with their paths; none if there is no such folder."""
    with contextlib.suppress(OSError):
        return [(name, folder / name) for name in sorted(os.listdir(folder))]  # noqa: PTH208 - names alone
    return []


@dataclass(frozen=True)
class Student:
    """One student of a class folder.

    Attributes:
        name: id in the gradebook, as text that any file format can hold.
        identity: the student's identity on the platform; None for plain folders.
        submitted_at: seconds since 1970, UTC, where the platform says so.
        flagged_late: the platform says that it was late, but not by how much.
        typed: files with text that was typed into the platform.
        several: where it is not clear which of several places counts: each of them, with its name.
        unclear: why that is, as a sentence.
    """

    name: str
    place: Place
    identity: PlatformIdentity | None = None
    submitted_at: float | None = None
    flagged_late: bool = False
    typed: tuple[str, ...] = ()
    several: tuple[tuple[str, Place], ...] = ()
    unclear: str = ""

    @property
    def places(self) -> list[Place]:
        return [place for _, place in self.several] or [self.place]


@dataclass
class ClassList:
    """A class.

    Attributes:
        students: ordered by name.
        unrecognised: files with an unknown owner, one sentence each.
    """

    layout: str
    students: list[Student] = field(default_factory=list)
    unrecognised: list[str] = field(default_factory=list)


def class_list(folder: Path, layout: str = "auto") -> ClassList:
    """The class in a folder.

    Raises:
        NotFoundError: there is no such folder, or it has no students.
        UsageError: some names are a platform's and some are not; the message lists them.
        MissingCapabilityError: reading this download needs something that is not installed.
    """
    if layout not in LAYOUTS:
        raise UsageError(f"--layout is {layout!r}.", help=f"It takes {', '.join(LAYOUTS)}.")
    names = _names(folder)
    if layout == "auto":
        layout = _recognised(folder, names)
    elif layout == "gradescope" and _METADATA not in names and (refused := _one_too_high(folder, names)):
        raise refused
    readers = {"folders": _folders, "moodle": _moodle, "canvas": _canvas, "gradescope": _gradescope}
    found = readers[layout](folder, names)
    found.students.sort(key=lambda student: student.name)
    if not found.students and not found.unrecognised:
        advice = "Name the folder that holds one folder per student, or an unpacked download."
        raise NotFoundError(f"{folder} holds no submissions.", help=advice, code="no_submissions")
    return found


def _names(folder: Path) -> list[str]:
    try:
        found = sorted(os.listdir(os.fsencode(folder)))  # noqa: PTH208 - bytes: a name need not be text
    except OSError as error:
        message = f"{folder} is not a folder of submissions: {error.strerror}."
        first = "Unpack it, and name" if folder.is_file() else "Name"
        advice = f"{first} the folder that holds one folder per student."
        raise NotFoundError(message, help=advice, code="submissions_not_found") from None
    return [name for raw in found if (name := os.fsdecode(raw)) not in IGNORED]


def _one_too_high(folder: Path, names: list[str]) -> UsageError | None:
    """Gradescope's zip holds one folder. A student's may look the same, so no list in it is believed."""
    inner = [folder / name for name in names if (folder / name).is_dir()]
    if len(inner) != 1 or not os.path.isfile(inner[0] / _METADATA):  # noqa: PTH113 - False where it is closed
        return None
    message = (
        f"The one folder in {folder} has a {_METADATA}: a download from Gradescope, or a student's work."
    )
    advice = f"If Gradescope made it, name {str(inner[0])!r}; if a student did, choose --layout folders."
    return UsageError(message, help=advice, code="mixed_layout")


def _recognised(folder: Path, names: list[str]) -> str:
    folders = [name for name in names if (folder / name).is_dir() or (folder / name).is_symlink()]
    moodle = [name for name in names if _MOODLE.fullmatch(name)]
    canvas = [name for name in names if name not in folders and _CANVAS.fullmatch(name)]
    if moodle:
        layout, odd = "moodle", [name for name in folders if name not in moodle]
    elif _METADATA in names:
        layout, odd = "gradescope", [name for name in folders if not _GRADESCOPE.fullmatch(name)]
    elif canvas and (not folders or any(name.lower().endswith(HANDED_IN) for name in canvas)):
        layout, odd = "canvas", [name for name in names if name not in canvas]
    elif refused := _one_too_high(folder, names):
        raise refused
    else:
        return "folders"
    if odd:
        listed = some([*map(quoted, odd)], _SHOWN)
        message = f"{folder} looks like a download from {layout.capitalize()}, but not all of it: {listed}."
        advice = f"Move these elsewhere, or choose the kind: --layout folders or --layout {layout}."
        raise UsageError(message, help=advice, code="mixed_layout")
    return layout


def _text(name: str) -> str:
    return os.fsencode(name).decode("utf-8", "backslashreplace")


def _folders(folder: Path, names: list[str]) -> ClassList:
    """One folder per student; names are made unique where the file system's are not text."""
    found = ClassList("folders")
    owned: dict[str, Path] = {}
    for raw in names:
        path = folder / raw
        if not (path.is_dir() or path.is_symlink()):
            if raw.lower().endswith(HANDED_IN):
                found.unrecognised.append(f"{quoted(raw)}: is in no student's folder")
            continue  # such as a class list or notes: not a submission
        name = _text(raw)
        while name in owned:
            name += "'"
        owned[name] = path
    found.students = [Student(name, Place(path)) for name, path in owned.items()]
    return found


def _moodle(folder: Path, names: list[str]) -> ClassList:
    found = ClassList("moodle")
    owned: dict[str, Path] = {}
    shared: dict[str, list[tuple[str, Path]]] = {}
    people: dict[str, PlatformIdentity] = {}
    typed: dict[str, list[str]] = {}
    for raw in names:
        match = _MOODLE.fullmatch(raw)
        if match is None:
            found.unrecognised.append(f"{quoted(raw)}: not a name in Moodle's form")
            continue
        student = _text(f"{match['name']}_{match['key']}")
        people[student] = PlatformIdentity("moodle", match["key"], _text(match["name"]))
        if match["plugin"] != "file":
            typed.setdefault(student, []).append(_text(raw))
            continue  # text typed into the platform, comments: not files of the student
        if (folder / raw).is_dir() or not match["file"]:
            owned[student] = folder / raw
        else:
            shared.setdefault(student, []).append((match["file"], folder / raw))
    for student, identity in people.items():
        places = [(_text(owned[student].name), Place(owned[student]))] if student in owned else []
        if student in shared or not places:
            places.append(("files", Place(folder, tuple(shared.get(student, ())))))
        several = tuple(places) if len(places) > 1 else ()
        told = f"{quoted(student)} has both a folder and files of their own" if several else ""
        words = tuple(typed.get(student, ()))
        one = Student(student, places[0][1], identity, typed=words, several=several, unclear=told)
        found.students.append(one)
    return found


def _canvas(folder: Path, names: list[str]) -> ClassList:
    found = ClassList("canvas")
    files: dict[str, dict[str, list[tuple[str, Path]]]] = {}
    typed: dict[str, list[str]] = {}
    late: set[str] = set()
    for raw in names:
        match = _CANVAS.fullmatch(raw)
        if match is None or (folder / raw).is_dir():
            found.unrecognised.append(f"{quoted(raw)}: not a name in Canvas' form")
            continue
        key = match["key"] or match["anon_key"]
        name = _text(match["name"] or match["anon"] or "")
        mine = files.setdefault(key, {}).setdefault(name, [])
        if match["typed"]:  # text or an address typed into Canvas is no file of the student's
            typed.setdefault(key, []).append(_text(raw))
        else:
            mine.append((match["file"], folder / raw))
        if match["late"] or match["anon_late"]:
            late.add(key)
    for key, by_name in files.items():
        several = tuple((name, Place(folder, tuple(by_name[name]))) for name in sorted(by_name))
        (name, place), *more = several
        both = " and ".join(quoted(name) for name, _ in several)
        told = f"User {key} of Canvas is called {both}: which files count is unclear"
        student = Student(
            f"{name}_{key}", place, PlatformIdentity("canvas", key, name), flagged_late=key in late,
            typed=tuple(typed.get(key, ())), several=several if more else (), unclear=told if more else "",
        )  # fmt: skip
        found.students.append(student)
    return found


def _gradescope(folder: Path, names: list[str]) -> ClassList:
    found = ClassList("gradescope")
    metadata = _metadata(folder / _METADATA)
    claims: dict[str, list[tuple[str, Student]]] = {}
    for name in names:
        if (folder / name).is_dir() and name not in metadata:
            found.unrecognised.append(f"{quoted(name)}: {_METADATA} does not name its owner")
    for name, about in metadata.items():
        # A folder's name comes out of a file: it must be one that was listed, never a path.
        if name not in names or not (folder / name).is_dir():
            found.unrecognised.append(f"{quoted(name)}: listed in {_METADATA}, but there is no such folder")
            continue
        submitters = _submitters(about)
        if not submitters:
            found.unrecognised.append(f"{quoted(name)}: {_METADATA} names no student for it")
        for who in submitters:
            student = who.sid or who.email or who.name
            entry = Student(student, Place(folder / name), who, _created_at(about))
            claims.setdefault(student, []).append((name, entry))
    for student, entries in claims.items():
        entry = entries[0][1]
        if len(entries) > 1:
            listed = some([quoted(name) for name, _ in entries], _SHOWN)
            several = tuple((name, one.place) for name, one in entries)
            told = f"{quoted(student)} has several submissions: {listed}"
            entry = replace(entry, submitted_at=None, several=several, unclear=told)
        found.students.append(entry)
    return found


def _metadata(path: Path) -> dict[str, Any]:
    yaml = extras.load("gradescope")
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        content = yaml.load(read_bytes(path, _MAX_METADATA), loader)
    except (OSError, yaml.YAMLError, ValueError, RecursionError) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        message, advice = f"{path} cannot be read: {reason}.", "Download the submissions again."
        raise UsageError(message, help=advice, code="bad_metadata") from None
    if not isinstance(content, dict) or not all(isinstance(name, str) for name in content):
        message = f"{path} is not what Gradescope writes."
        raise UsageError(message, help="Download it again.", code="bad_metadata")
    return content


def _submitters(about: Any) -> list[PlatformIdentity]:
    listed = about.get(":submitters") if isinstance(about, dict) else None
    found = []
    for item in listed if isinstance(listed, list) else ():
        facts = item if isinstance(item, dict) else {}
        # Text or a number: aliases can make a list whose text would have no end.
        told = (facts.get(f":{field}") for field in ("name", "sid", "email"))
        name, sid, email = (str(fact).strip() if isinstance(fact, str | int) else "" for fact in told)
        if name or sid or email:
            found.append(PlatformIdentity("gradescope", sid or email, name, email, sid))
    return found


def _created_at(about: Any) -> float | None:
    """The time Gradescope received it, as YAML gave it: a date, or text if the YAML had it quoted."""
    value = about.get(":created_at") if isinstance(about, dict) else None
    if isinstance(value, str):
        with contextlib.suppress(ValueError):
            value = dt.datetime.fromisoformat(value.strip())
    if not isinstance(value, dt.datetime):
        return None
    return (value if value.tzinfo else value.replace(tzinfo=dt.UTC)).timestamp()


# ---
# What a file is, by its content, and files in archives that are no zip. Nothing is unpacked to disk; the
# process that reads (``archives``) calls it, within that one's limits.


#: What operating systems, tools and Python itself put into folders.
_CLUTTER = re.compile(
    r"__MACOSX|__pycache__|node_modules|site-packages|build|dist|venv|virtualenv|Thumbs\.db|desktop\.ini"
    r"|\.(?!\.?$|py$|ipynb$).+|~\$.*|.*\.egg-info|.*\.pyc",
    re.IGNORECASE,
)
#: Of these, what holds nothing that a person wrote, or only copies.
_MACHINES = re.compile(
    r"__MACOSX|__pycache__|node_modules|site-packages|\.git|\.svn|\.course|\.ipynb_checkpoints|.*\.egg-info",
    re.IGNORECASE,
)
#: A file with this name lies at the top of every virtual environment, whatever that is called.
_ENVIRONMENT = "pyvenv.cfg"

#: First bytes -> what begins so.
_BEGINS: tuple[tuple[bytes, str], ...] = (
    (b"PK\x03\x04", "a zip archive"),
    (b"PK\x05\x06", "a zip archive"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"BZh", "a bzip2 archive"),
    (b"\xfd7zXZ\x00", "an xz archive"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive, which nothing here opens"),
    (b"Rar!", "a rar archive, which nothing here opens"),
    (b"%PDF", "a PDF document"),
    (b"{\\rtf", "a text with formatting (RTF)"),
    (b"\xd0\xcf\x11\xe0", "a document of Microsoft Office"),
    (b"\x89PNG", "a picture"),
    (b"\xff\xd8\xff", "a picture"),
    (b"GIF8", "a picture"),
    (b"SQLite format 3", "a database"),
    (b"\x7fELF", "a program"),
    (b"MZ", "a program"),
)
_OFFICE = (".docx", ".xlsx", ".pptx", ".odt", ".ods", ".odp")
#: Names of text that may be code; "" is a name without a dot.
_CODE = ("", ".py", ".pyw", ".txt", ".ipynb", ".json", ".bak", ".old", ".orig", ".save", ".text", ".py3")


def is_clutter(name: str) -> bool:
    """Whether a file or folder of this name is no student's work."""
    return _CLUTTER.fullmatch(name) is not None


def in_clutter(name: str) -> bool:
    """Whether a path leads to, or through, what is no student's work."""
    return any(map(is_clutter, name.split("/")))


def lies_aside(name: str) -> bool:
    """Whether a path leads to what a student may have written and put where nothing is graded, such as
    ``build`` or ``.vscode``."""
    *folders, file = name.split("/")
    return (
        file.casefold().endswith(HANDED_IN)
        and not is_clutter(file)
        and in_clutter(name)
        and not any(map(_MACHINES.fullmatch, folders))
    )


def in_environment(names: Iterable[str]) -> Callable[[str], bool]:
    """Whether one of these paths lies in a virtual environment."""
    environments = {name.rpartition("/")[0] for name in names if name.rpartition("/")[2] == _ENVIRONMENT}
    environments.discard("")

    def inside(name: str) -> bool:
        above = (name[: at.start()] for at in re.finditer("/", name)) if environments else ()
        return not environments.isdisjoint(above)

    return inside


#: Why an archive with such a path in it is refused.
DEEP = f"a file in it lies in more than {MAX_DEEP} folders, or its path has more than {MAX_PATH} characters"


def too_deep(name: str) -> bool:
    """Whether no program makes such a path; what looks at all folders above a file would never end."""
    return len(name) > MAX_PATH or name.count("/") > MAX_DEEP


def is_notebook(content: bytes) -> bool:
    """Whether a file is a notebook, whatever it is called."""
    return content.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] == b"{" and b'"nbformat"' in content


def may_be_code(name: str) -> bool:
    return PurePosixPath(name).suffix.rstrip().casefold() in _CODE


def kind_of(name: str, content: bytes) -> str:
    """What a file is, as a noun with its article; "" where it is what its name says: code or a notebook."""
    suffix = PurePosixPath(name).suffix.rstrip().casefold()
    head = content[:512]
    found = next((kind for begins, kind in _BEGINS if head.startswith(begins)), "")
    if found == "a zip archive" and suffix in _OFFICE:
        found = "a document of an office program"
    elif content[257:262] == b"ustar":
        found = "a tar archive"
    return found or _kind_of_text(suffix, content, head)


def _kind_of_text(suffix: str, content: bytes, head: bytes) -> str:
    if not head:
        return "an empty file"
    if is_notebook(content):
        return "" if suffix == ".ipynb" else "a notebook"
    if b"\0" in head and head[:2] not in {b"\xff\xfe", b"\xfe\xff"}:
        return "no text"
    if head.lstrip()[:9].lower().startswith((b"<!doctype", b"<html")):
        return "a web page"
    return "" if suffix in {".py", ".ipynb"} else "a text"


#: Kinds of files that are read as code; "" is what its name says.
IS_CODE = frozenset({"", "a text", "a notebook"})
#: What is decompressed, and by what; in each may be a tar archive.
OPENERS: dict[str, Callable[..., Any]] = {
    "a tar archive": open,
    "a gzip archive": gzip.open,
    "a bzip2 archive": bz2.open,
    "an xz archive": lzma.open,
}


class TooMuchError(Exception):
    """A tar archive has more in it than may be, which the message says."""


@dataclass
class Meter:
    """What was decompressed of one student's archives, and may be, in bytes."""

    most: int
    used: int = 0
    source: Any = None

    def read(self, size: int) -> bytes:
        """The next bytes of the source."""
        found: bytes = self.source.read(size)
        self.used += len(found)
        if self.used > self.most:
            raise TooMuchError(f"the tar archives here unpack to more than {MAX_STREAMED >> 20} MB")
        return found


def compressed(path: Path, kind: str, most: int, total: int, meter: Meter) -> Iterator[tuple[str, bytes]]:
    """Names and contents of what may be code in a tar archive, or of the one file that was compressed.

    Args:
        most, total: bytes of a file, and of all of them; larger ones are passed over.

    Raises:
        TooMuchError: to find them takes more than the meter allows, or a path is too long.
        OSError: it is damaged.
    """
    try:
        with OPENERS[kind](path, "rb") as meter.source:
            try:
                with tarfile.open(fileobj=meter, mode="r|") as archive:  # type: ignore[call-overload]
                    yield from _in_tar(archive, most, total)
                return
            except tarfile.ReadError:
                if kind == "a tar archive":
                    raise
        with OPENERS[kind](path, "rb") as handle:
            content: bytes = handle.read(most + 1)
    except TooMuchError:
        raise
    except Exception:  # noqa: BLE001 - tarfile and what decompresses for it raise all kinds at damage
        raise OSError("it is damaged") from None
    if len(content) <= most:
        yield path.stem, content


def _in_tar(archive: tarfile.TarFile, most: int, total: int) -> Iterator[tuple[str, bytes]]:
    for member in archive:
        name = _text(member.name.removeprefix("./"))
        if too_deep(name):
            raise TooMuchError(DEEP)
        if not (member.isreg() and may_be_code(name)) or (in_clutter(name) and not lies_aside(name)):
            continue
        total -= member.size
        if total < 0:
            return
        handle = archive.extractfile(member)
        if handle is not None and member.size <= most:
            yield name, handle.read(most)
