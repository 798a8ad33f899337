"""The modules of the course that a lesson's cells import, as one archive for the process they run in.

A protected process sees nothing of this installation. So it is handed what the cells name, with what that
imports in turn, found by reading and never by importing; where something there opens files of the package,
the data beside those modules too. Packages beyond a few light ones (matplotlib, which the figures draw with)
are not part of it: their names import, and using them says that nothing is drawn there.
"""

from __future__ import annotations

import ast
import io
import sys
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

__all__ = ["Textbook", "imported", "textbook_for"]

_ROOT = Path(__file__).resolve().parents[2]
_COURSE = "course"
#: Packages that a cell's process may have as they are, quick to load, each with what it needs itself.
_LIGHT = {"numpy": (), "msgspec": (), "pymunk": ("cffi",)}
_DATA = frozenset({".json", ".toml"})
#: Archives are stamped alike, so that the same modules give the same bytes.
_STAMP = (1980, 1, 1, 0, 0, 0)


@dataclass(frozen=True, slots=True)
class Textbook:
    """An archive of modules.

    Attributes:
        data: a zip file, to be put on the path.
        packages: installed packages that they need.
        absent: packages that they import and do without.
    """

    data: bytes
    packages: tuple[str, ...]
    absent: tuple[str, ...]


def textbook_for(sources: Iterable[str]) -> Textbook:
    """The course's modules that these pieces of code import. Code that does not parse imports none."""
    texts = list(sources)
    files: dict[str, bytes] = {}
    others: set[str] = set()
    pending = [name for text in texts for name in _imports(text)]
    while pending:
        name = pending.pop()
        top = name.partition(".")[0]
        if top != _COURSE:
            if top not in sys.stdlib_module_names:
                others.add(top)
            continue
        for path in _files_of(name):
            inside = path.relative_to(_ROOT).as_posix()
            if inside not in files:
                files[inside] = path.read_bytes()
                pending += _imports(files[inside].decode("utf-8"))
    if any("importlib.resources" in text for text in (*texts, *(file.decode() for file in files.values()))):
        for folder in {Path(name).parent for name in files}:
            for path in sorted((_ROOT / folder).iterdir()):
                if path.suffix in _DATA:
                    files[path.relative_to(_ROOT).as_posix()] = path.read_bytes()
    files.setdefault("course/__init__.py", b"")
    light = {"numpy", *others} & _LIGHT.keys()
    packages = sorted(light.union(*(_LIGHT[name] for name in light)))
    absent = sorted(others - _LIGHT.keys())
    return Textbook(_zipped(files), tuple(packages), tuple(absent))


def imported(sources: Iterable[str]) -> frozenset[str]:
    """The modules that these pieces of code name: as long as they are the same, so is the textbook."""
    return frozenset(name for text in sources for name in _imports(text))


def _files_of(name: str) -> Iterator[Path]:
    """The file of a module, and those of the packages it is in; nothing for a name inside a module."""
    parts = name.split(".")
    for length in range(1, len(parts) + 1):
        base = _ROOT.joinpath(*parts[:length])
        for path in (base / "__init__.py", base.with_suffix(".py")):
            if path.is_file():
                yield path
                break


def _imports(source: str) -> Iterator[str]:
    """Every module that code imports when it is loaded; ``from a import b`` may mean the module a.b."""
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError):
        return
    pending: list[ast.AST] = [tree]
    while pending:
        node = pending.pop()
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
        elif not (isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test)):
            pending += ast.iter_child_nodes(node)


def _zipped(files: dict[str, bytes]) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in sorted(files.items()):
            archive.writestr(zipfile.ZipInfo(name, _STAMP), data, zipfile.ZIP_DEFLATED)
    return out.getvalue()
