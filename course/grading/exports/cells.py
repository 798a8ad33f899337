"""Text for cells, XML and files: a student's text, or a name, is shown and never interpreted."""

from __future__ import annotations

import contextlib
import csv
import io
import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from course.errors import MissingCapabilityError, UsageError
from course.printable import one_line

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from typing import IO

__all__ = ["STDOUT", "csv_bytes", "for_moodle", "is_safe", "number", "replacing", "safe_cell", "write_bytes"]

#: A spreadsheet takes a cell that begins with one of these for a formula; with a full-width one in some
#: languages. The apostrophe that disarms them is itself doubled, so that no two texts become one.
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n", "'", "\uff1d", "\uff0b", "\uff0d", "\uff20")

#: ``-o -``: to standard output.
STDOUT = Path("-")

#: How every SQLite file begins.
_DATABASE = b"SQLite format 3\0"


def safe_cell(text: str) -> str:
    """A cell that a spreadsheet shows as it is: formulas are disarmed, control characters are escaped."""
    shown = one_line(text)
    return "'" + shown if text.lstrip().startswith(_FORMULA) or text.startswith(_FORMULA) else shown


def is_safe(text: str) -> bool:
    """Whether ``safe_cell`` leaves it unchanged, so that another program finds this exact key in the cell."""
    return safe_cell(text) == text


def for_moodle(text: str) -> str:
    """A cell that Moodle reads as it is: to PHP, a quote behind a backslash does not end a cell."""
    return re.sub(r'\\(?="|\Z)', r"\\ ", text)


def number(value: float | None) -> str:
    """Points, to a ten-thousandth and without zeros at the end; empty for None."""
    if value is None:
        return ""
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def csv_bytes(headings: Sequence[str], rows: Iterable[Sequence[str]], *, mark: bool = True) -> bytes:
    """A table with every cell quoted and safe.

    Args:
        mark: put a byte order mark in front, which makes Excel read UTF-8; not every program knows it.
    """
    text = io.StringIO(newline="")
    writer = csv.writer(text, quoting=csv.QUOTE_ALL, lineterminator="\r\n")
    writer.writerow([safe_cell(cell) for cell in headings])
    writer.writerows([safe_cell(cell) for cell in row] for row in rows)
    return b"\xef\xbb\xbf" * mark + text.getvalue().encode("utf-8")


def write_bytes(path: Path, content: bytes) -> None:
    """Write a whole file or none.

    Raises:
        MissingCapabilityError: there is no room, or it cannot be written there.
    """
    with replacing(path) as handle:
        handle.write(content)


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[IO[bytes]]:
    """A file that takes its name when it is complete; until then the old one stays.

    Raises:
        UsageError: a database has that name: a gradebook, most likely.
        MissingCapabilityError: there is no room, or it cannot be written there.
    """
    if path == STDOUT or (path.exists() and not path.is_file()):
        # A pipe or a device has nothing to keep and no second name; its reader may leave when it has enough.
        whole = io.BytesIO()
        yield whole
        with contextlib.suppress(BrokenPipeError):
            sys.stdout.flush()
            target = os.dup(1) if path == STDOUT else os.open(path, os.O_WRONLY)
            with os.fdopen(target, "wb") as handle:
                handle.write(whole.getvalue())
        return
    with contextlib.suppress(OSError), path.open("rb") as handle:
        if handle.read(len(_DATABASE)) == _DATABASE:
            raise UsageError(
                f"{path} is a database, most likely a gradebook; it was not changed.",
                help="Name another file with -o.",
                code="is_a_database",
            )
    draft = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with draft.open("wb") as handle:
            yield handle
        draft.replace(path)
    except OSError as error:
        raise MissingCapabilityError(
            f"{path} cannot be written: {error.strerror or error}.",
            help="Make room, or name another place with -o; the gradebook is complete.",
            code="cannot_write",
        ) from None
    finally:
        with contextlib.suppress(OSError):
            draft.unlink(missing_ok=True)
