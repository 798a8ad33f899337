"""``course bug``: a file for a developer who looks for a fault, without personal data."""

from __future__ import annotations

import contextlib
import getpass
import json
import os
import platform
import re
import sys
import sysconfig
import tempfile
import unicodedata
from pathlib import Path
from typing import TYPE_CHECKING, Annotated
from urllib.parse import quote

import typer

from course import __version__
from course.cli.frame import files
from course.cli.frame.here import cwd
from course.cli.frame.terminal.console import current
from course.cli.setup.doctor import packages, protection, terminal
from course.cli.setup.replies import Bug

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["bug", "redacted"]

#: The last line of a crash report before its traceback: the command line, which may name a student.
_TYPED = re.compile(r"^command: .*$", re.MULTILINE)


def bug(
    out: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", metavar="FILE", help="File to write; course-bug.txt here if left out."
        ),
    ] = None,
) -> int:
    """Write what a fault report needs into a file.

    The file has versions, the protection levels of this machine, and the last traceback of the course itself.
    Names of the user and the machine and paths to the home folder are removed. Nothing is sent anywhere.
    """
    console = current()
    target = files.target(out or Path("course-bug.txt"), "-o", ("txt", "md"))
    crash = _last_crash()
    text = redacted("\n".join(_report(crash)))
    written = files.write(target, text.encode("utf-8", "backslashreplace"), why="bug")
    if written.backup:
        console.line(f"There was another {written.path}; it is kept at {written.backup.backup}.")
    console.line(f"Wrote {written.path}")
    console.line(
        "It contains a traceback." if crash else "No crash of the course was found: it has no traceback."
    )
    console.note("Read it before you pass it on: error messages can quote your own files.")
    console.emit(Bug(file=written, traceback=crash is not None))
    return 0


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
    forms = {unicodedata.normalize(form, text) for form in ("NFC", "NFD")}
    return {
        way
        for form in forms
        for way in (
            form,
            form.encode("unicode_escape").decode("ascii"),
            json.dumps(form)[1:-1],
            quote(form, errors="surrogateescape"),
        )
    }


def _places() -> list[tuple[str, str]]:
    """Folders and their replacements, the innermost first."""
    installed = sysconfig.get_paths()
    package = Path(__file__).resolve().parents[3]
    found = {
        str(Path.home()): "~",
        tempfile.gettempdir(): "<temporary>",
        sys.base_prefix: "<python>",
        sys.prefix: "<python>",
        installed["purelib"]: "<packages>",
        str(cwd()): "<here>",
        str(package): "<course>",
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
    """The newest crash report of this user's, without what was typed; None if there is none."""
    found = []
    for path in Path(tempfile.gettempdir()).glob("course-crash-*.txt"):
        try:
            facts = path.lstat()
        except OSError:
            continue
        mine = not hasattr(os, "getuid") or facts.st_uid == os.getuid()
        if mine and path.is_file() and not path.is_symlink():
            found.append((facts.st_mtime, path))
    if not found:
        return None
    try:
        text = max(found)[1].read_text(encoding="utf-8", errors="backslashreplace")
    except OSError:
        return None
    return _TYPED.sub("command: left out", text)
