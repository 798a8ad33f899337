"""Files that a stranger may have made: read within a size, a depth and a time, whatever they are.

What is wrong is raised as the errors that readers of files know anyway (``OSError``, ``TOMLDecodeError``,
``sqlite3.DatabaseError``), so that each of them says it in its own words.
"""

from __future__ import annotations

import codecs
import contextlib
import errno
import io
import re
import stat
import tokenize
import tomllib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Collection
    from pathlib import Path

#: Bytes of a file that a person writes or a platform exports.
MOST = 20 << 20
#: The same of a TOML file, which takes Python a second for each of these.
_MOST_TOML = 1 << 20
#: Tables and lists within each other; the course's own files have five.
_DEEPEST = 50
_DOTTED = re.compile(
    r"""(?:^|[\[{,])[ \t]*(?:(?:[\w-]+|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*){50}""", re.MULTILINE
)
#: Names under which a shell hands over what another program writes.
_HANDED_OVER = ("/dev/fd/", "/dev/stdin", "/proc/self/fd/")
#: Instructions of SQLite between two looks at whether a file has an end.
_LOOK = 1_000_000


def read_bytes(path: Path, most: int = MOST) -> bytes:
    """The content of an ordinary file.

    Args:
        most: bytes that it may have.

    Raises:
        OSError: it cannot be read, is larger, or is a folder, a device or a pipe (which may never answer).
            ``strerror`` says which.
    """
    status = path.stat()
    size = status.st_size
    if stat.S_ISFIFO(status.st_mode) and str(path).startswith(_HANDED_OVER):
        with path.open("rb") as handle:
            data = handle.read(most + 1)
        size = len(data)
    elif stat.S_ISDIR(status.st_mode) or (stat.S_ISREG(status.st_mode) and size <= most):
        data = path.read_bytes()
    elif not stat.S_ISREG(status.st_mode):
        raise OSError(errno.EINVAL, "it is a device or a pipe, and no file", str(path))
    if size > most:
        raise OSError(errno.EFBIG, f"it is larger than {most >> 20} MB", str(path))
    return data


def marked_encoding(raw: bytes) -> str | None:
    """UTF-32 or UTF-16 where the first bytes are its mark."""
    if raw.startswith((codecs.BOM_UTF32_LE, codecs.BOM_UTF32_BE)):  # the first begins as UTF-16's mark does
        return "UTF-32"
    return "UTF-16" if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) else None


def decoded(raw: bytes) -> str:
    """Text as a program of Windows may save it: UTF-8, UTF-16 or -32 with its mark, or the western page.

    Raises:
        UnicodeError: it is not text.
    """
    if encoding := marked_encoding(raw):
        return raw.decode(encoding)
    with contextlib.suppress(UnicodeDecodeError):
        return raw.decode("utf-8-sig")
    if b"\0" in raw:
        raise UnicodeError
    return raw.decode("cp1252")


def in_utf8(source: bytes) -> bytes:
    """Python's source in UTF-8 where it is UTF-16 or Windows' western code page without saying so."""
    with contextlib.suppress(SyntaxError, UnicodeError, LookupError):
        source.decode(tokenize.detect_encoding(io.BytesIO(source).readline)[0])
        if b"\0" not in source:
            return source
    with contextlib.suppress(UnicodeError):
        return decoded(source).encode("utf-8")
    return source


def toml(text: str) -> dict[str, Any]:
    """A TOML text as tables and lists.

    Raises:
        TOMLDecodeError: it is none, is larger or deeper than any that a person writes, or has a whole number
            that TOML does not allow.
    """
    if len(text) > _MOST_TOML:
        raise tomllib.TOMLDecodeError("It is larger than 1 MB")
    if found := _DOTTED.search(text):  # which takes the square of its length in time and memory
        raise _at(text, found.start() + 1, "Nested too deeply")
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except RecursionError:
        raise tomllib.TOMLDecodeError("Nested too deeply") from None
    except ValueError:  # of int(), at thousands of digits
        raise tomllib.TOMLDecodeError("A whole number has more than 64 bits") from None
    level: list[Any] = [document]
    for _ in range(_DEEPEST):
        if any(type(item) is int and not -(1 << 63) <= item < 1 << 63 for item in level):
            raise tomllib.TOMLDecodeError("A whole number has more than 64 bits")
        level = [
            inner
            for item in level
            if isinstance(item, dict | list)
            for inner in (item.values() if isinstance(item, dict) else item)
        ]
    if level:
        raise tomllib.TOMLDecodeError("Nested too deeply")
    return document


def _at(text: str, position: int, problem: str) -> tomllib.TOMLDecodeError:
    return tomllib.TOMLDecodeError(f"{problem} (at line {text.count(chr(10), 0, position) + 1}, column 1)")


def no_programs(database: sqlite3.Connection, allowed: Collection[str] = (), *, millions: int) -> None:
    """Refuse a database that computes while it is read or written, and one that would be read for ever.

    Views, triggers, virtual tables, computed columns and computed indexes are programs, and a view may have
    no end. A damaged file may lead in circles.

    Args:
        allowed: the statements of those that the course itself makes.
        millions: of instructions that may follow; a row takes some ten, and a second has fifty millions.

    Raises:
        sqlite3.DatabaseError: it has one; from here on, also whatever takes more instructions.
    """
    import sqlite3

    looks = iter(range(millions))
    database.set_progress_handler(lambda: next(looks, -1) < 0, _LOOK)
    database.execute("PRAGMA trusted_schema = OFF")
    for kind, name, statement in database.execute("SELECT type, name, sql FROM sqlite_schema"):
        if statement is None or statement in allowed:
            continue
        plain = (
            kind == "table" and _PLAIN_TABLE.match(str(statement)) and not _COMPUTED.search(str(statement))
        )
        if not (plain or (kind == "index" and _PLAIN_INDEX.fullmatch(str(statement)))):
            raise sqlite3.DatabaseError(f"it has a {kind} that the course does not make: {str(name)[:60]!r}")


_PLAIN_TABLE = re.compile(r"\s*CREATE\s+TABLE\b", re.IGNORECASE)
_COMPUTED = re.compile(r"\b(AS|GENERATED|CHECK|DEFAULT)\b", re.IGNORECASE)
_PLAIN_INDEX = re.compile(r"\s*CREATE\s+(UNIQUE\s+)?INDEX\s[^()]*\([\w\s,]*\)\s*", re.IGNORECASE)
