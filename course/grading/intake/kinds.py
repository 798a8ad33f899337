"""What a file is, by its content; what no student wrote; and files in archives that are no zip.

Nothing here is unpacked to disk. The reading process (``archives``) calls it, within that one's limits.
"""

from __future__ import annotations

import bz2
import gzip
import lzma
import re
import tarfile
import zlib
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path, PurePosixPath
from typing import Any

#: What operating systems, tools and Python itself put into folders.
_CLUTTER = re.compile(
    r"__MACOSX|__pycache__|node_modules|site-packages|build|dist|venv|virtualenv|Thumbs\.db|desktop\.ini"
    r"|\.(?!\.?$|py$|ipynb$).+|~\$.*|.*\.egg-info|.*\.pyc",
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


def clutter(names: Iterable[str]) -> Callable[[str], bool]:
    """Whether one of these paths lies in something that is no student's work, such as an environment."""
    environments = {name.rpartition("/")[0] for name in names if name.rpartition("/")[2] == _ENVIRONMENT}
    environments.discard("")

    def inside(name: str) -> bool:
        path = PurePosixPath(name)
        return any(map(is_clutter, path.parts)) or any(str(above) in environments for above in path.parents)

    return inside


def is_notebook(content: bytes) -> bool:
    """Whether a file is a notebook, whatever it is called."""
    return content.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] == b"{" and b'"nbformat"' in content


def may_be_code(name: str) -> bool:
    """Whether a text of this name may be code."""
    return PurePosixPath(name).suffix.casefold() in _CODE


def kind_of(name: str, content: bytes) -> str:
    """What a file is, as a noun with its article; "" where it is what its name says: code or a notebook."""
    suffix = PurePosixPath(name).suffix.casefold()
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


_OPENERS: dict[str, Callable[..., Any]] = {
    "a gzip archive": gzip.open,
    "a bzip2 archive": bz2.open,
    "an xz archive": lzma.open,
}


def compressed(path: Path, kind: str, most: int, total: int) -> Iterator[tuple[str, bytes]]:
    """Names and contents of what may be code in a tar archive, or of the one file that was compressed.

    Args:
        most, total: bytes of a file, and of all of them; larger ones are passed over.

    Raises:
        OSError: it is damaged.
    """
    try:
        with tarfile.open(path, "r|*") as archive:
            yield from _in_tar(archive, most, total)
        return
    except tarfile.ReadError:
        opener = _OPENERS.get(kind)
    except (EOFError, zlib.error, lzma.LZMAError):
        opener = None
    if opener is None:
        raise OSError("it is damaged")
    try:
        with opener(path, "rb") as handle:
            content: bytes = handle.read(most + 1)
    except (OSError, EOFError, zlib.error, lzma.LZMAError):
        raise OSError("it is damaged") from None
    if len(content) <= most:
        yield path.stem, content


def _in_tar(archive: tarfile.TarFile, most: int, total: int) -> Iterator[tuple[str, bytes]]:
    for member in archive:
        name = member.name.removeprefix("./")
        if not (member.isreg() and may_be_code(name)) or any(map(is_clutter, PurePosixPath(name).parts)):
            continue
        total -= member.size
        if total < 0:
            return
        handle = archive.extractfile(member)
        if handle is not None and member.size <= most:
            yield name, handle.read(most)
