"""Course files into typed values, with errors that say which line is wrong and how to mend it.

Every file of the course is UTF-8 and declares a ``format_version``. The type that a file is read into defines
the rest; msgspec's errors are put into plain words here.
"""

from __future__ import annotations

import difflib
import re
import tomllib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, NoReturn, TypeVar

import msgspec

from course.catalog.models import FORMAT_VERSION
from course.catalog.toml_lines import LineMap, parse_path, syntax_error_line
from course.errors import ContentError

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

__all__ = ["Document", "read_document", "read_text", "read_toml"]

T = TypeVar("T")

_AT = re.compile(r" - at (?:key in )?`(?P<path>\$[^`]*)`$")
_EXPECTED = re.compile(r"Expected `(?P<wanted>[^`]+)`, got `(?P<given>[^`]+)`")
_MISSING = re.compile(r"Object missing required field `(?P<key>[^`]+)`")
_UNKNOWN = re.compile(r"Object contains unknown field `(?P<key>[^`]+)`")

_WORDS = {
    "str": "text in quotes",
    "int": "a whole number",
    "float": "a number",
    "bool": "true or false",
    "array": "a list",
    "object": "a table",
    "datetime": "a date and time",
    "date": "a date",
    "time": "a time of day",
}


@dataclass(frozen=True, slots=True)
class Document(Generic[T]):
    """A file that was read, and the lines its values stand on."""

    path: Path
    value: T
    lines: LineMap

    def fail(self, where: str | tuple[str | int, ...], problem: str, *, fix: str) -> NoReturn:
        """Raise the ContentError that points at ``where``."""
        raise ContentError(self.path, self.lines.line(where), problem, help=fix)


def read_text(path: Path) -> str:
    """A UTF-8 text with Unix line ends.

    Raises:
        ContentError: the file is missing, unreadable, not UTF-8, or starts with a byte order mark.
    """
    try:
        data = path.read_bytes()
    except (FileNotFoundError, NotADirectoryError):
        raise ContentError(path, None, "the file is missing.", help="Restore it or write it.") from None
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise ContentError(
            path, None, f"the file cannot be read: {reason}.", help="Check that it is a readable file."
        ) from None
    if data.startswith(b"\xef\xbb\xbf"):
        raise ContentError(
            path, 1, "the file starts with a byte order mark.", help="Save it as UTF-8 without a mark."
        )
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise ContentError(
            path, line, "the file is not UTF-8 text.", help="Save it with the encoding UTF-8."
        ) from None
    return text.replace("\r\n", "\n")


def read_toml(path: Path, kind: type[T]) -> T:
    """The TOML file at ``path`` as a value of the type ``kind``.

    Raises:
        ContentError: it is missing, not TOML, of a newer format, or does not fit the type.
    """
    return read_document(path, kind).value


def read_document(
    path: Path,
    kind: type[T],
    *,
    text: str | None = None,
    first_line: int = 1,
    reserved: Iterable[str] = (),
) -> Document[T]:
    """Like ``read_toml``, with the lines kept for the caller's own checks.

    Args:
        text, first_line: the TOML and the line it starts on, where it is only a part of the file.
        reserved: fields of ``kind`` that are not the file's to set.
    """
    source = read_text(path) if text is None else text
    try:
        data = tomllib.loads(source)
    except tomllib.TOMLDecodeError as error:
        raise ContentError(
            path,
            first_line - 1 + syntax_error_line(error, source),
            f"this is not valid TOML: {_first_words(error)}.",
            help="Check quotes, brackets and commas here and on the line above.",
        ) from None
    lines = LineMap(source, first_line)
    _check_version(path, data, lines)
    for key in reserved:
        if key in data:
            _unknown_key(path, lines, (), key, kind, hide=tuple(reserved))
    try:
        return Document(path, msgspec.convert(data, kind), lines)
    except msgspec.ValidationError as error:
        _raise_in_words(path, lines, str(error), kind, tuple(reserved))


def _check_version(path: Path, data: dict[str, Any], lines: LineMap) -> None:
    version = data.get("format_version")
    if version is None:
        raise ContentError(
            path,
            lines.line(()),
            "the file declares no format_version.",
            help=f"Add `format_version = {FORMAT_VERSION}` at the top.",
        )
    if type(version) is not int or version < 1:
        raise ContentError(
            path,
            lines.line(("format_version",)),
            "format_version must be a whole number, 1 or more.",
            help=f"Write `format_version = {FORMAT_VERSION}`.",
        )
    if version > FORMAT_VERSION:
        raise ContentError(
            path,
            lines.line(("format_version",)),
            f"the file has format {version}, and this program knows formats up to {FORMAT_VERSION}.",
            help="Install a newer version of the course.",
        )


def _raise_in_words(path: Path, lines: LineMap, text: str, kind: type, reserved: tuple[str, ...]) -> NoReturn:
    """An error of msgspec's as a ContentError that a person can act on."""
    at = _AT.search(text)
    where = at["path"] if at else "$"
    steps = parse_path(where)
    words = text[: at.start()] if at else text
    if match := _UNKNOWN.search(words):
        _unknown_key(path, lines, steps, match["key"], kind, hide=reserved)
    if match := _MISSING.search(words):
        key = match["key"]
        place = f"{_named(steps)} lacks" if steps else "the file lacks"
        table = ".".join((*map(str, steps), key))
        fix = (
            f"Add a table `[{table}.NAME]`."
            if _holds_tables(kind, steps, key)
            else f"Add a line `{key} = ...`."
        )
        raise ContentError(path, lines.line(steps), f"{place} the key `{key}`.", help=fix)
    if match := _EXPECTED.search(words):
        wanted, given = (_in_words(match[side]) for side in ("wanted", "given"))
        raise ContentError(
            path,
            lines.line(steps),
            f"{_named(steps)} must be {wanted}, and is {given}.",
            help=f"Write {wanted}.",
        )
    raise ContentError(
        path, lines.line(steps), f"{_named(steps)}: {words}.", help="Compare it with a file of the same kind."
    )


def _unknown_key(
    path: Path, lines: LineMap, steps: tuple[str | int, ...], key: str, kind: type, *, hide: tuple[str, ...]
) -> NoReturn:
    known = [name for name in _keys_at(kind, steps) if steps or name not in hide]
    close = difflib.get_close_matches(key, known, n=1)
    fix = f"Did you mean `{close[0]}`?" if close else f"Known keys: {', '.join(known)}."
    raise ContentError(path, lines.key_line(steps, key), f"unknown key `{key}`.", help=fix)


def _keys_at(kind: type, steps: tuple[str | int, ...]) -> list[str]:
    """The keys that a table at this place may have."""
    info = _type_at(kind, steps)
    return (
        [field.encode_name for field in info.fields] if isinstance(info, msgspec.inspect.StructType) else []
    )


def _holds_tables(kind: type, steps: tuple[str | int, ...], key: str) -> bool:
    """Whether the value of a key is tables by name."""
    info = _type_at(kind, (*steps, key))
    return isinstance(info, msgspec.inspect.DictType) and isinstance(
        info.value_type, msgspec.inspect.StructType
    )


def _type_at(kind: type, steps: tuple[str | int, ...]) -> Any:
    info: Any = msgspec.inspect.type_info(kind)
    for step in steps:
        if isinstance(info, msgspec.inspect.StructType):
            info = next((field.type for field in info.fields if field.encode_name == step), None)
        elif isinstance(step, int):
            info = getattr(info, "item_type", None)
    return info


def _named(steps: tuple[str | int, ...]) -> str:
    """A place as the file's author would call it: ``task[2].points`` is points of the third task."""
    if not steps:
        return "the file"
    text = ""
    for step in steps:
        text += f"[{step + 1}]" if isinstance(step, int) else f".{step}" if text else step
    return f"`{text}`"


def _in_words(kinds: str) -> str:
    return " or ".join(_WORDS.get(kind, kind) for kind in kinds.split(" | "))


def _first_words(error: tomllib.TOMLDecodeError) -> str:
    """The parser's complaint without its position, which the ContentError gives."""
    return str(error).rsplit(" (at ", 1)[0]
