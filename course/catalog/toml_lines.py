"""On which line of a TOML text a value stands.

``tomllib`` throws positions away and msgspec names a value by its path (``$.task[2].points``). ``LineMap``
joins the two: asked for the first time, it walks the text and remembers where each table, key and array item
begins. A text without faults is not asked about. It expects one that ``tomllib`` accepted, so it needs to
tell tokens apart and nothing more.
"""

from __future__ import annotations

import re
import tomllib
from functools import cached_property
from typing import TypeAlias

__all__ = ["LineMap", "parse_path", "syntax_error_line"]

Path: TypeAlias = "tuple[str | int, ...]"

_STEP = re.compile(r"\.(?P<name>[^.\[]+)|\[(?P<index>\d+)\]|\[\.\.\.\]")
_KEY = re.compile(r"""[ \t]*(?P<key>"(?:\\.|[^"\\\n])*"|'[^'\n]*'|[A-Za-z0-9_-]+)[ \t]*""")
_STRING = re.compile(
    r'"""(?:\\.|[^\\])*?"{3,5}|' + r"'''.*?'{3,5}|" + r'"(?:\\.|[^"\\\n])*"|' + r"'[^'\n]*'", re.DOTALL
)
_BLANK = re.compile(r"(?:[ \t\r\n,]+|#[^\n]*)*")
_SCALAR = re.compile(r"[^,\]}\n#]+")
_SYNTAX_LINE = re.compile(r"\(at line (\d+), column \d+\)")


def parse_path(path: str) -> Path:
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
        self._text = text.replace("\r\n", "\n")
        self._first = first_line
        self._found: dict[Path, int] = {}
        self._arrays: dict[Path, int] = {}

    @cached_property
    def _lines(self) -> dict[Path, int]:
        self._read_document()
        return self._found

    def line(self, path: Path | str) -> int:
        """The line on which the value at ``path`` begins, else that of the nearest thing around it."""
        steps = parse_path(path) if isinstance(path, str) else path
        while steps:
            if steps in self._lines:
                return self._lines[steps]
            steps = steps[:-1]
        return self._first

    def key_line(self, path: Path | str, key: str) -> int:
        """The line of ``key`` inside the table at ``path``; the table's own where it has no such key."""
        steps = parse_path(path) if isinstance(path, str) else path
        return self.line((*steps, key))

    def _note(self, path: Path, position: int) -> None:
        self._found.setdefault(path, self._first + self._text.count("\n", 0, position))

    def _read_document(self) -> None:
        table: Path = ()
        position = _skip(self._text, 0)
        while position < len(self._text):
            if self._text[position] == "[":
                table, position = self._read_header(position)
            else:
                position = self._read_pair(table, position)
            position = _skip(self._text, position)

    def _read_header(self, position: int) -> tuple[Path, int]:
        """``[a.b]`` or ``[[a.b]]``: the table that the following pairs belong to."""
        doubled = self._text.startswith("[[", position)
        keys, end = self._read_keys(position + (2 if doubled else 1))
        path = self._resolve(keys[:-1])
        if doubled:
            array = (*path, keys[-1])
            index = self._arrays.get(array, 0)
            self._arrays[array] = index + 1
            self._note(array, position)
            path = (*array, index)
        else:
            path = self._resolve(keys)
        self._note(path, position)
        return path, end + (2 if doubled else 1)

    def _resolve(self, keys: tuple[str, ...]) -> Path:
        """A header's keys as a path: through an array of tables it means the array's latest table."""
        path: Path = ()
        for key in keys:
            path = (*path, key)
            if path in self._arrays:
                path = (*path, self._arrays[path] - 1)
        return path

    def _read_keys(self, position: int) -> tuple[tuple[str, ...], int]:
        """A key, dotted or not, and the position behind it."""
        keys: list[str] = []
        while True:
            match = _KEY.match(self._text, position)
            if match is None:
                return tuple(keys) or ("",), position + 1
            raw = match["key"]
            keys.append(next(iter(tomllib.loads(f"{raw} = 0"))) if raw[0] in "\"'" else raw)
            position = match.end()
            if not self._text.startswith(".", position):
                return tuple(keys), position
            position += 1

    def _read_pair(self, table: Path, position: int) -> int:
        keys, end = self._read_keys(position)
        for depth in range(1, len(keys) + 1):
            self._note((*table, *keys[:depth]), position)
        if self._text.startswith("=", end):
            end += 1
        while end < len(self._text) and self._text[end] in " \t":
            end += 1
        return self._read_value((*table, *keys), end)

    def _read_value(self, path: Path, position: int) -> int:
        """Notes what is inside a value; returns the position behind it, which is always further on."""
        opener = self._text[position : position + 1]
        if opener == "[":
            return self._read_array(path, position + 1)
        if opener == "{":
            return self._read_inline_table(path, position + 1)
        match = _STRING.match(self._text, position) or _SCALAR.match(self._text, position)
        return match.end() if match else position + 1

    def _read_array(self, path: Path, position: int) -> int:
        index = 0
        while (position := _skip(self._text, position)) < len(self._text):
            if self._text[position] == "]":
                return position + 1
            self._note((*path, index), position)
            position = self._read_value((*path, index), position)
            index += 1
        return position

    def _read_inline_table(self, path: Path, position: int) -> int:
        while (position := _skip(self._text, position)) < len(self._text):
            if self._text[position] == "}":
                return position + 1
            position = self._read_pair(path, position)
        return position


def _skip(text: str, position: int) -> int:
    """The position of the next thing that is neither space, comma nor comment."""
    match = _BLANK.match(text, position)
    return match.end() if match else position
