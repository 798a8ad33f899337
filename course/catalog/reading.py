"""Course files into typed values, with a ContentError that says which line is wrong and how to mend it.

Every file of the course is UTF-8 and declares a ``format_version``. The type that a file is read into defines
the rest; msgspec's errors are put into plain words here.
"""

import contextlib
import re
import tomllib
from bisect import bisect_left
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Generic, NamedTuple, NoReturn, TypeAlias, TypeVar

import msgspec

from course.catalog.models import FORMAT_VERSION
from course.errors import ContentError, UsageError
from course.printable import meant
from course.strangers import read_bytes, toml

# ---
# On which line of a TOML text a value stands.
#
# ``tomllib`` throws positions away and msgspec names a value by its path (``$.task[2].points``). ``LineMap``
# joins the two: asked for the first time, it reads one statement after the other and remembers where each
# begins. A value inside one begins on the first line up to which the statement, ended there as TOML would
# have it, has that value. A text without faults is not asked about. It expects one that ``tomllib`` accepted.


Keys: TypeAlias = "tuple[str | int, ...]"

_STEP = re.compile(r"\.(?P<name>[^.\[]+)|\[(?P<index>\d+)\]|\[\.\.\.\]")
_TOKEN = re.compile(
    r'"""(?:\\.|[^\\])*?"{3,5}|' + r"'''.*?'{3,5}|" + r'"(?:\\.|[^"\\\n])*"|'
    r"'[^'\n]*'|#[^\n]*|[\[\]{}\n]",
    re.DOTALL,
)
_SYNTAX_LINE = re.compile(r"\(at line (\d+), column \d+\)")


def parse_path(path: str) -> Keys:
    """The steps of a path as msgspec writes it: ``$.task[2].points`` gives ``("task", 2, "points")``.

    A step that names no single value (``[...]``, an item of a mapping) ends the result: what comes before
    it is the nearest place that can be pointed at.
    """
    steps: list[str | int] = []
    for match in _STEP.finditer(path):
        if match["name"] is not None:
            steps.append(match["name"])
        elif match["index"] is not None:
            steps.append(int(match["index"]))
        else:
            break
    return tuple(steps)


def syntax_error_line(error: tomllib.TOMLDecodeError, text: str) -> int:
    """The line ``tomllib`` complains about; the last one with text in it for "at end of document"."""
    match = _SYNTAX_LINE.search(str(error))
    return int(match[1]) if match else max(text.rstrip().count("\n") + 1, 1)


class LineMap:
    """Lines of everything in one TOML text.

    Args:
        text: TOML that parses.
        first_line: the line of its file on which the text starts (front matter starts below a fence).
    """

    def __init__(self, text: str, first_line: int = 1) -> None:
        self._lines = text.replace("\r\n", "\n").split("\n")
        self._first = first_line

    def line(self, path: Keys) -> int:
        """The line on which the value at ``path`` begins, else that of the nearest thing around it."""
        depth = next((n for n in range(len(path), 0, -1) if path[:n] in self._statements), 0)
        if not depth:
            return self._first
        table, begin, end = self._statements[path[:depth]]
        inner = path[table:]
        while len(inner) > depth - table and not self._has(inner, begin, end):
            inner = inner[:-1]
        begins = bisect_left(range(end), True, begin, key=lambda at: self._has(inner, begin, at))
        return self._first + begins

    @cached_property
    def _ends(self) -> list[str]:
        """What would end the statement at the end of each line; nothing where it ends there."""
        ends, inside = [], ""
        for match in _TOKEN.finditer("\n".join((*self._lines, ""))):
            token = match[0]
            if token == "\n":
                ends.append(inside)
            elif token in ("[", "{"):
                inside = f"{']' if token == '[' else '}'}{inside}"
            elif token in ("]", "}"):
                inside = inside[1:]
            else:
                ends += [token[:3] + inside] * token.count("\n")
        return ends

    @cached_property
    def _statements(self) -> dict[Keys, tuple[int, int, int]]:
        """By path, the first statement with it: the length of its table's path, its first and last line."""
        found: dict[Keys, tuple[int, int, int]] = {}
        latest: dict[Keys, int] = {}  # of arrays of tables, which a header means by the array's name
        table: Keys = ()
        begin = 0
        for at, end in enumerate(self._ends):
            if end:
                continue
            data: Any = self._read(begin, at)
            is_header = self._lines[begin].lstrip().startswith("[")
            path = () if is_header else table
            place = len(path), begin, at
            while isinstance(data, dict) and len(data) == 1:
                ((key, data),) = data.items()
                path = (*path, key)
                if is_header and isinstance(data, list):
                    latest[path] = latest.get(path, -1) + 1
                if isinstance(data, list) or not is_header:
                    found.setdefault(path, place)
                if is_header and path in latest:
                    path = (*path, latest[path])
            if is_header:
                found.setdefault(path, place)
                table = path
            begin = at + 1
        return found

    def _read(self, begin: int, at: int) -> dict[str, Any]:
        """The statement that begins on a line, as far as it goes up to the end of another."""
        return tomllib.loads("\n".join((*self._lines[begin : at + 1], self._ends[at])))

    def _has(self, path: Keys, begin: int, at: int) -> bool:
        value: Any = self._read(begin, at)
        try:
            for step in path:
                value = value[step]
        except (KeyError, IndexError, TypeError):
            return False
        return True


T = TypeVar("T")

_AT = re.compile(r" - at (?:key in )?`(?P<path>\$[^`]*)`$")
_EXPECTED = re.compile(
    r"Expected `(?P<wanted>[^`]+)`(?:, got `(?P<given>[^`]+)`|(?P<more> .+?)(?:, got (?P<count>\d+))?$)"
)
_MISSING = re.compile(r"Object missing required field `(?P<key>[^`]+)`")
_ENUM = re.compile(r"Invalid enum value (?P<given>.+)")
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

    def fail(self, where: Keys, problem: str, *, fix: str) -> NoReturn:
        """Raise the ContentError that points at ``where``."""
        raise ContentError(self.path, self.lines.line(where), problem, help=fix)

    def check_words(self, where: Keys, text: str) -> None:
        """A text that people read says something."""
        if not text.strip():
            name = next(str(step) for step in reversed(where) if isinstance(step, str))
            self.fail(where, f"`{name}` is empty.", fix="Fill it in.")

    def check_id(self, where: Keys, text: str, kind: Callable[[str], object]) -> None:
        """An id is well formed, as its type in ``course.ids`` says."""
        try:
            kind(text)
        except UsageError as error:
            self.fail(where, error.message, fix=error.help)

    def check_own_id(self, text: str, kind: Callable[[str], object]) -> None:
        """The file's own id is well formed, and the file is called so."""
        self.check_id(("id",), text, kind)
        if text != self.path.stem:
            fix = f'Write `id = "{self.path.stem}"`, or rename the file {text}{self.path.suffix}.'
            self.fail(("id",), f"`id` is {text}, and the file is called {self.path.name}.", fix=fix)


def read_text(path: Path) -> str:
    """A UTF-8 text with Unix line ends."""
    try:
        data = read_bytes(path)
    except (FileNotFoundError, NotADirectoryError):
        raise ContentError(path, None, "the file is missing.", help="Restore it or write it.") from None
    except OSError as error:
        reason = error.strerror or type(error).__name__
        problem = f"the file cannot be read: {reason}."
        raise ContentError(path, None, problem, help="Check that it is a readable file.") from None
    if data.startswith(b"\xef\xbb\xbf"):
        problem = "the file starts with a byte order mark."
        raise ContentError(path, 1, problem, help="Save it as UTF-8 without a mark.")
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        problem = "the file is not UTF-8 text."
        raise ContentError(path, line, problem, help="Save it with the encoding UTF-8.") from None
    return text.replace("\r\n", "\n")


def read_document(
    path: Path, kind: type[T], *, text: str | None = None, first_line: int = 1, reserved: Iterable[str] = ()
) -> Document[T]:
    """The TOML file at ``path`` as a value of the type ``kind``, with the lines that its values stand on.

    Args:
        text, first_line: the TOML and the line it starts on, where it is only a part of the file.
        reserved: fields of ``kind`` that are not the file's to set.
    """
    source = read_text(path) if text is None else text
    try:
        data = toml(source)
    except tomllib.TOMLDecodeError as error:
        why = str(error).rsplit(" (at ", 1)[0]  # the error gives the place
        said = f"this is not valid TOML: {why}."
        advice = "Check quotes, brackets and commas here and on the line above."
        if why.startswith(("Cannot overwrite", "Cannot declare")):
            said, advice = "this key or table stands in the file twice.", "Keep one of the two."
        line = first_line - 1 + syntax_error_line(error, source)
        raise ContentError(path, line, said, help=advice) from None
    raw = Document(path, data, LineMap(source, first_line))
    _check_version(raw)
    for key in reserved:
        if key in data:
            _unknown_key(raw, (), key, kind, hide=tuple(reserved))
    try:
        return Document(path, msgspec.convert(data, kind), raw.lines)
    except msgspec.ValidationError as error:
        _raise_in_words(raw, str(error), kind, tuple(reserved))


def _check_version(raw: Document[dict[str, Any]]) -> None:
    version = raw.value.get("format_version")
    if version is None:
        problem = "the file declares no format_version."
        raw.fail((), problem, fix=f"Add `format_version = {FORMAT_VERSION}` at the top.")
    if type(version) is not int or version < 1:
        problem = "format_version must be a whole number, 1 or more."
        raw.fail(("format_version",), problem, fix=f"Write `format_version = {FORMAT_VERSION}`.")
    if version > FORMAT_VERSION:
        problem = f"the file has format {version}, and this program knows formats up to {FORMAT_VERSION}."
        raw.fail(("format_version",), problem, fix="Install a newer version of the course.")


_MOST_PLACES = 5  # that lack keys, told at once


def _raise_in_words(raw: Document[Any], text: str, kind: type, reserved: tuple[str, ...]) -> NoReturn:
    """An error of msgspec's as a ContentError that a person can act on."""
    at = _AT.search(text)
    where = at["path"] if at else "$"
    steps = parse_path(where)
    words = text[: at.start()] if at else text
    if match := _UNKNOWN.search(words):
        _unknown_key(raw, steps, match["key"], kind, hide=reserved)
    if match := _MISSING.search(words):
        lacks = list(_lacking(msgspec.inspect.type_info(kind), raw.value)) or [(steps, [match["key"]])]
        problem, fix = _told(lacks[:_MOST_PLACES], kind)
        raw.fail(lacks[0][0], problem, fix=fix)
    if match := _ENUM.search(words):
        info = _type_at(kind, steps)
        choices = ", ".join(f'"{word}"' for word in getattr(info, "values", ()))
        fix = f"Write one of {choices}."
        raw.fail(steps, f"{_named(steps)} cannot be {match['given']}.", fix=fix)
    if match := _EXPECTED.search(words):
        _as_toml_writes_it(raw, steps, _type_at(kind, steps))
        wanted = _in_words(match["wanted"].removesuffix(" | null")) + (match["more"] or "")  # TOML has none
        if "regex" in wanted:
            says = getattr(_type_at(kind, steps), "extra_json_schema", None) or {}
            wanted = str(says.get("description", "")) or wanted
        given = f", and is {_in_words(match['given'])}" if match["given"] else ""
        given = f", and has {match['count']}" if match["count"] else given
        fix = "Write values in brackets: [1, 2]." if wanted == "a list" else f"Write {wanted}."
        raw.fail(steps, f"{_named(steps)} must be {wanted}{given}.", fix=fix)
    raw.fail(steps, f"{_named(steps)}: {words}.", fix="Compare it with a file of the same kind.")


def _as_toml_writes_it(raw: Document[Any], steps: Keys, info: Any) -> None:
    """Refuse what is TOML, and another thing than it looks like: one bracket for two, a key with points."""
    value: Any = raw.value
    with contextlib.suppress(LookupError, TypeError):
        for step in steps:
            value = value[step]
    if not isinstance(value, dict):
        return
    items = getattr(info, "item_type", None)
    if isinstance(items, msgspec.inspect.StructType):
        name = ".".join(str(step) for step in steps if isinstance(step, str))
        fix = f"Write [[{name}]], with two brackets, at the head of each."
        raw.fail(steps, f"{_named(steps)} is one table, and there may be several.", fix=fix)
    if isinstance(info, msgspec.inspect.DictType):
        for first in value:
            path, inner = [first], value[first]
            while isinstance(inner, dict) and inner:
                path.append(next(iter(inner)))
                inner = inner[path[-1]]
            if len(path) > 1 and not isinstance(info.value_type, msgspec.inspect.StructType):
                key = ".".join(path)
                fix = f'Write "{key}" = ..., with quotes around the key.'
                problem = f"{_named((*steps, first))} is a table: the points in {key} divide it."
                raw.fail((*steps, *path), problem, fix=fix)


def _unknown_key(raw: Document[Any], steps: Keys, key: str, kind: type, *, hide: tuple[str, ...]) -> NoReturn:
    names = [field.encode_name for field in getattr(_type_at(kind, steps), "fields", ())]
    known = [name for name in names if steps or name not in hide]
    fix = meant(key, known, f"Known keys: {', '.join(known)}.")
    raw.fail((*steps, key), f"unknown key `{key}`.", fix=fix)


def _lacking(info: Any, value: Any, steps: Keys = ()) -> Iterator[tuple[Keys, list[str]]]:
    """Every table that lacks keys, and which."""
    info = _without_none(info)
    if isinstance(info, msgspec.inspect.StructType) and isinstance(value, dict):
        types = {field.encode_name: field.type for field in info.fields}
        if keys := [f.encode_name for f in info.fields if f.required and f.encode_name not in value]:
            yield steps, keys
        for key in filter(types.get, value):
            yield from _lacking(types[key], value[key], (*steps, key))
    elif isinstance(value, list):
        for at, one in enumerate(value):
            yield from _lacking(getattr(info, "item_type", None), one, (*steps, at))


def _told(lacks: list[tuple[Keys, list[str]]], kind: type) -> tuple[str, str]:
    """What is missing, and what to add."""
    problems, fixes = [], []
    for steps, keys in lacks:
        listed = ", ".join(f"`{key}`" for key in keys)
        problems.append(f"{_named(steps)} lacks the key{'s' * (len(keys) > 1)} {listed}")
        fixes += [_added(kind, (*steps, key)) for key in keys]
    return f"{'; '.join(problems)}.", " ".join(dict.fromkeys(fixes))


def _added(kind: type, steps: Keys) -> str:
    """What to add for a key that is missing: a line, or the head of a table of its kind."""
    info, table = _type_at(kind, steps), ".".join(str(step) for step in steps if isinstance(step, str))
    if isinstance(getattr(info, "value_type", None), msgspec.inspect.StructType):
        return f"Add a table `[{table}.NAME]`."
    if isinstance(getattr(info, "item_type", None), msgspec.inspect.StructType):
        return f"Add a table `[[{table}]]`."
    return f"Add a line `{steps[-1]} = ...`."


def _type_at(kind: type, steps: Keys) -> Any:
    info: Any = msgspec.inspect.type_info(kind)
    for step in steps:
        if isinstance(info, msgspec.inspect.StructType):
            info = next((field.type for field in info.fields if field.encode_name == step), None)
        elif isinstance(step, int):
            info = getattr(info, "item_type", None)
        info = _without_none(info)
    return info


def _without_none(info: Any) -> Any:
    """The type of a value that may be left out."""
    types = info.types if isinstance(info, msgspec.inspect.UnionType) else ()
    given = [one for one in types if not isinstance(one, msgspec.inspect.NoneType)]
    return given[0] if len(given) == 1 else info


def _named(steps: Keys) -> str:
    """A place as the file's author would call it: ``task[2].points`` is points of the third task."""
    if not steps:
        return "the file"
    text = ""
    for step in steps:
        text += f"[{step + 1}]" if isinstance(step, int) else f".{step}" if text else step
    return f"`{text}`"


def _in_words(kinds: str) -> str:
    return " or ".join(_WORDS.get(kind, kind) for kind in kinds.split(" | "))


#: The mark that ``course author new`` leaves where an author has to write.
BLANK = re.compile(r"<<FILL IN:?\s*(?P<what>.*?)>>")


def blanks(path: Path) -> Iterator[tuple[int, str]]:
    """The line of each blank that is left in a file, and what to say of it."""
    for number, line in enumerate(read_text(path).split("\n"), start=1):
        for match in BLANK.finditer(line):
            yield number, f"still to be filled in: {match['what'].strip() or 'this'}."


def refuse_blanks(path: Path) -> None:
    """Refuse a file that its author has not finished."""
    for number, problem in blanks(path):
        raise ContentError(path, number, problem, help="`course author check` lists what is left.")


# ---
# The head of a lesson file: TOML between two ``+++`` lines, the Markdown below it.


_FENCE = "+++"


class FrontMatter(NamedTuple):
    """A lesson file in its two parts.

    Attributes:
        body: the Markdown below it.
        body_line: the line of the file that the body starts on, counted from 1.
    """

    toml: str
    body: str
    body_line: int


def split_front_matter(text: str, file: Path) -> FrontMatter:
    """Part a lesson's TOML head from its Markdown body."""
    lines = text.splitlines()
    help_ = f"Start the file with {_FENCE}, the TOML keys of a lesson, and {_FENCE} on a line of its own."
    if not lines or lines[0].rstrip() != _FENCE:
        problem = f"the front matter is missing: the first line is not {_FENCE}"
        raise ContentError(file, 1, problem, help=help_)
    end = next((i for i, line in enumerate(lines[1:], start=1) if line.rstrip() == _FENCE), None)
    if end is None:
        raise ContentError(file, 1, f"the front matter has no closing {_FENCE}", help=help_)
    return FrontMatter("\n".join(lines[1:end]), "\n".join(lines[end + 1 :]) + "\n", end + 2)
