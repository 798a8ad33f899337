"""``course doctor``: what works on this machine, what is missing and the command that installs it."""

import contextlib
import getpass
import importlib.metadata
import json
import os
import platform
import re
import sys
import sysconfig
import tempfile
import time
import unicodedata
from collections.abc import Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import Annotated
from urllib.parse import quote

import msgspec

from course import __version__
from course.catalog.models import CourseRef
from course.cli.frame import here
from course.cli.frame.app import INSTALLATION
from course.cli.frame.console import Console, current
from course.cli.frame.here import cwd, find_workspace, load_catalog
from course.cli.frame.options import option
from course.cli.frame.replies import Envelope, WrittenFile, filled
from course.errors import CourseError, MissingCapabilityError
from course.extras import requirements
from course.printable import counted


class Bug(Envelope, tag="course.bug/1", frozen=True, kw_only=True):
    """A report for a developer who looks for a fault; ``traceback`` is False where no crash was found."""

    file: WrittenFile
    traceback: bool


class Package(msgspec.Struct, frozen=True):
    """A requirement and what is installed for it; ``group`` is "" or the name of the extra."""

    name: str
    requirement: str
    installed: str | None
    ok: bool
    group: str = ""


class Fix(msgspec.Struct, frozen=True):
    """A missing part and the command that installs it."""

    problem: str
    command: str


class Doctor(Envelope, tag="course.doctor/1", frozen=True, kw_only=True):
    course: CourseRef
    python: str
    platform: str
    installation: str
    packages: tuple[Package, ...]
    protection: str
    protection_causes: tuple[str, ...]
    protection_advice: tuple[str, ...]
    terminal: dict[str, str]
    workspace: str | None
    repaired: str | None
    fixes: tuple[Fix, ...]
    unserved: tuple[str, ...] = ()


#: Parts that no student needs.
_NOT_FOR_USERS = {"dev", "all"}
_LEVELS = {
    "L3": "your code runs in a locked sandbox of its own: no files, no network, no processes",
    "L2": "your code runs locked down: no files beyond Python's own, no network, no processes",
    "L1": "your code runs in a process of its own with deadlines; files and network are not protected",
}


def doctor(
    repair: Annotated[
        bool, option("--repair", "Set a damaged progress record aside and start a new one.")
    ] = False,
) -> int:
    """Say what works on this machine.

    It also says what is missing, with the command that installs it. Exit code 4 if the course cannot work
    without a missing part.
    """
    console, catalog = current(), load_catalog()
    found = tuple(packages())
    fixes = _missing(found)
    workspace, repaired, trouble = _workspace(repair=repair)
    level, causes, advice = protection()
    kind = "checkout (instructor's)" if catalog.content.is_checkout else "wheel (student's)"
    shape = terminal(console)
    fact = partial(console.item, indent=0, width=12)
    complete = not any(item.group == "" and not item.ok for item in found) and not trouble
    fact("Course", f"{catalog.title} {catalog.version}, installed as a {kind}")
    fact("Python", f"{platform.python_version()} at {sys.executable}, {platform.platform()}")
    there = [one for one in found if one.ok or not one.group]  # with what is missing of the base
    needs = ["" if one.ok else f" (needs {one.requirement})" for one in there]
    named = (f"{one.name} {one.installed or 'MISSING'}{more}" for one, more in zip(there, needs, strict=True))
    fact("Packages", ", ".join(named))
    fact("Protection", f"{level}: {_LEVELS[level]}" if level in _LEVELS else level)
    for sentence in (*causes, *advice):
        console.line(sentence, indent=2)
    fact("Terminal", "; ".join(f"{name} {value}" for name, value in shape.items()))
    fact("Workspace", workspace or "none here")
    others = [one for one in requirements() if one.unserved and one.group not in _NOT_FOR_USERS]
    unserved = tuple(f"Optional ({one.group}): {one.unserved}." for one in others)
    install = (f"{fix.problem} Install it with: {fix.command}" for fix in fixes)
    for line in filter(None, (repaired, trouble, *unserved, *install)):
        console.line(line)
    console.line(("Everything the course needs is here." if complete else "Something is missing.", "bold"))
    return console.answer(
        Doctor(
            exit_code=0 if complete else MissingCapabilityError.exit_code,
            course=catalog.ref,
            python=platform.python_version(),
            platform=platform.platform(),
            installation=kind,
            packages=found,
            protection=level,
            protection_causes=causes,
            protection_advice=advice,
            terminal=shape,
            workspace=workspace,
            repaired=repaired,
            fixes=fixes,
            unserved=unserved,
        )
    )


def packages() -> Iterable[Package]:
    """Every requirement of the course that this machine could have, and what is installed for it."""
    from packaging.specifiers import SpecifierSet
    from packaging.version import InvalidVersion

    for one in requirements():
        if one.group in _NOT_FOR_USERS or not one.applies:
            continue
        try:
            installed = importlib.metadata.version(one.name)
        except importlib.metadata.PackageNotFoundError:
            installed = None
        ok = installed is not None
        with contextlib.suppress(InvalidVersion):  # a text that is not a version counts as in the range
            ok = ok and SpecifierSet(one.versions).contains(str(installed), prereleases=True)
        yield filled(Package, one, requirement=one.text, installed=installed, ok=ok)


def _missing(found: Iterable[Package]) -> tuple[Fix, ...]:
    """The commands that install missing parts: one for the base and one for each extra."""
    groups: dict[str, list[Package]] = {}
    for item in found:
        if not item.ok:
            groups.setdefault(item.group, []).append(item)
    fixes = []
    for group, items in groups.items():
        names = ", ".join(item.name for item in items)
        missing = f"{names} {'are' if len(items) > 1 else 'is'} missing"
        what = f"Optional ({group}): {missing}." if group else f"{missing} or too old."
        fixes.append(Fix(what, "pip install " + " ".join(f"'{item.requirement}'" for item in items)))
    return tuple(fixes)


def protection() -> tuple[str, tuple[str, ...], tuple[str, ...]]:
    """The level this machine reaches, why it is not higher, and what would raise it."""
    try:
        from course.isolation.probe import probe

        protection = probe()
    except ImportError as error:
        return "unknown", (f"It could not be tried: {error.name} is missing.",), ()
    except CourseError as error:
        return "none", (error.message,), (error.help,) if error.help else ()
    return str(protection.level), tuple(protection.causes), tuple(protection.advice)


def _workspace(*, repair: bool) -> tuple[str | None, str | None, str | None]:
    """The workspace, the repairs in it, and its faults."""
    root = repaired = None
    try:
        here = find_workspace()
        if here is None:
            return None, None, None
        root, store = str(here.workspace.root), here.workspace.store
        if repair:
            result = store.repair()
            repaired = "The record of progress is sound; nothing was repaired."
            if result is not None:
                carried = f"{counted(result.carried, 'event')} moved to a new one"
                repaired = f"The damaged record is kept at {here.workspace.shown(result.kept)}; {carried}."
        store.events()
        with tempfile.TemporaryFile(dir=root, buffering=0) as trial:
            trial.write(bytes(1 << 16))
    except CourseError as error:
        return root, repaired, f"{error.message} {error.help}"
    except OSError as error:
        trouble = f"{root} cannot be written ({error.strerror}); checks run, and nothing is recorded."
        return root, repaired, trouble
    return root, repaired, None


def terminal(console: Console) -> dict[str, str]:
    return {
        "output": "to a terminal" if sys.stdout.isatty() else "to a file or a pipe",
        "columns": str(console.terminal_width),
        "colour": "on" if console.fancy and not os.environ.get("NO_COLOR") else "off",
        "encoding": getattr(sys.stdout, "encoding", None) or "unknown",
    }


# ---
# ``course bug``: a file for a developer who looks for a fault, without personal data.


#: The last line of a crash report before its traceback: the command line, which may name a student.
_TYPED = re.compile(r"^command: .*$", re.MULTILINE)


def bug(
    out: Annotated[
        Path | None, option("--output -o FILE", "File to write; course-bug.txt here if left out.")
    ] = None,
) -> int:
    """Write what a fault report needs into a file.

    The file has versions, the protection levels of this machine, and the last traceback of the course itself.
    Names of the user and the machine and paths to the home folder are removed. Nothing is sent anywhere.
    """
    console = current()
    target = here.target(out or Path("course-bug.txt"), "-o", ("txt", "md"))
    crash = _last_crash()
    text = redacted("\n".join(_report(crash)))
    written = here.write_told(target, text.encode("utf-8", "backslashreplace"), why="bug")
    none = "No crash of the course was found: it has no traceback."
    console.line("It contains a traceback." if crash else none)
    console.note("Read it before you pass it on: error messages can quote your own files.")
    return console.answer(Bug(file=written, traceback=crash is not None))


def redacted(text: str) -> str:
    """A text without the names of the user and the machine, or folders with these names."""
    for place, name in _places():
        for way in _spellings(place) | _spellings(place.replace("\\", "/")):
            text = re.sub(re.escape(way) + r"(?![\w-])", name, text, flags=re.IGNORECASE)
    for word, name in _names():
        for way in _spellings(word):
            # An underscore separates words: a folder may be called ada_thesis.
            text = re.sub(rf"(?<![^\W_]){re.escape(way)}(?![^\W_])", name, text, flags=re.IGNORECASE)
    return text


def _spellings(text: str) -> set[str]:
    """A name's spellings: unchanged; with decomposed accents, as on macOS; and in Python, JSON and a URL."""
    found = {unicodedata.normalize("NFC", text), unicodedata.normalize("NFD", text)}
    for form in tuple(found):
        found |= {form.encode("unicode_escape").decode("ascii"), json.dumps(form)[1:-1]}
        found.add(quote(form, errors="surrogateescape"))
    return found


def _places() -> list[tuple[str, str]]:
    """Folders and their replacements, the innermost first."""
    installed = sysconfig.get_paths()
    found = {
        str(Path.home()): "~",
        tempfile.gettempdir(): "<temporary>",
        sys.base_prefix: "<python>",
        sys.prefix: "<python>",
        installed["purelib"]: "<packages>",
        str(cwd()): "<here>",
        str(Path(__file__).resolve().parents[3]): "<course>",
    }
    found |= {os.path.realpath(place): name for place, name in found.items()}
    kept = [(place, name) for place, name in found.items() if len(Path(place).parts) > 1]
    return sorted(kept, key=lambda pair: len(pair[0]), reverse=True)


def _names() -> Iterator[tuple[str, str]]:
    """Words that identify the user; on a system without a list of users, those of the environment."""
    words = {os.environ.get(name, "") for name in ("USER", "LOGNAME", "USERNAME")} | {Path.home().name}
    try:
        words.add(getpass.getuser())
    except (ImportError, KeyError, OSError):
        words.discard("")
    with contextlib.suppress(ImportError, KeyError, AttributeError):
        import pwd

        words.add(pwd.getpwuid(os.getuid()).pw_gecos.partition(",")[0])  # in full
    yield from ((word, "<user>") for word in sorted(words - {"", "/"}, key=len, reverse=True))
    host = platform.node()
    machines = {host, host.partition(".")[0], os.environ.get("COMPUTERNAME", "")} - {"", "localhost"}
    yield from ((word, "<machine>") for word in sorted(machines, key=len, reverse=True))


def _report(crash: str | None) -> Iterator[str]:
    yield f"course {__version__}, Python {platform.python_version()} ({platform.python_implementation()})"
    yield f"system: {platform.platform()}"
    level, causes, _ = protection()
    yield f"protection: {level}"
    yield from (f"  {cause}" for cause in causes)
    yield "terminal: " + "; ".join(f"{name} {value}" for name, value in terminal(current()).items())
    yield "packages: " + ", ".join(f"{one.name} {one.installed}" for one in packages() if one.installed)
    yield ""
    yield crash or "No crash of the course was found."
    yield ""


def _last_crash() -> str | None:
    """The newest crash report of this installation, without what was typed; None if there is none.

    Its age stands above it: it may have nothing to do with what is reported now.
    """
    mark = f"{INSTALLATION}{Path(__file__).resolve().parents[2]}\n"
    found = []
    for path in Path(tempfile.gettempdir()).glob("course-crash-*.txt"):
        with contextlib.suppress(OSError):
            facts = path.lstat()
            mine = not hasattr(os, "getuid") or facts.st_uid == os.getuid()
            if mine and path.is_file() and not path.is_symlink():
                found.append((facts.st_mtime, path))
    for when, path in sorted(found, reverse=True):
        with contextlib.suppress(OSError):
            text = path.read_text(encoding="utf-8", errors="backslashreplace")
            if mark in text:
                minutes = max(0, round((time.time() - when) / 60))
                ago = counted(minutes, "minute") if minutes < 120 else counted(minutes // 60, "hour")
                text = _TYPED.sub("command: left out", text.replace(mark, ""))
                return f"The last crash, {ago} ago:\n{text}"
    return None
