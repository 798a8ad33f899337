"""A name in double backquotes exists: ``course.ids``, ``History`` or ``loops.fold`` leads somewhere."""

import ast
import builtins
import importlib
import re
import sys
from collections import defaultdict
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LESSONS = ROOT / "course" / "lessons"
PATHS = sorted(path for path in (ROOT / "course").rglob("*.py") if LESSONS not in path.parents)
PAGES = sorted([*(ROOT / "docs").rglob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"])
#: The names of files look like dotted names.
FILES = ("py", "js", "md", "toml", "json", "jsonl", "csv", "sqlite", "coursepack")
#: What a scene's file calls a body of its own.
OF_SCENES = "body"
#: ``a.b``, with or without brackets after it, and ``LikeThis``.
NAME = re.compile(rf"``(?!\S+\.(?:{'|'.join(FILES)})``)(_?[A-Z][a-z]\w*|\w+(?:\.\w+)+)(?:\(\))?``")


def _module(path):
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def _bound(tree):
    """What a module or a class binds, wherever in it; an attribute that a method sets is one, too."""
    found = {}
    for node in ast.walk(tree):
        match node:
            case ast.ClassDef(name=name) | ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name):
                found[name] = node
            case ast.Name(id=name, ctx=ast.Store()) | ast.Attribute(attr=name, ctx=ast.Store()):
                found.setdefault(name, node)
            case ast.alias(name=name, asname=other):
                found.setdefault(other or name.rpartition(".")[2], node)
    return found


@cache
def _modules():
    return {_module(path): _bound(ast.parse(path.read_text(encoding="utf-8"))) for path in PATHS}


@cache
def _classes():
    found = defaultdict(list)
    for names in _modules().values():
        for name, node in names.items():
            if not isinstance(node, ast.alias | ast.Attribute):
                found[name].append(node)
    return found


def _has(module, rest):
    """Whether a module of the course has a name, a class's attribute, or a module below it."""
    while rest and f"{module}.{rest[0]}" in _modules():
        module, *rest = f"{module}.{rest[0]}", *rest[1:]
    if not rest:
        return module in _modules()
    node = _modules().get(module, {}).get(rest[0])
    return node is not None and all(name in _bound(node) for name in rest[1:])


def _exists(name):
    first, *rest = name.split(".")
    if first == "course":
        return _has("course", rest)
    if first in _classes() and first[:1].isupper():
        return not rest or any(rest[0] in _bound(node) for node in _classes()[first])
    named = [module for module in _modules() if module.endswith(f".{first}")]
    if named and first != OF_SCENES:
        return any(_has(module, rest) for module in named)
    if first in sys.stdlib_module_names or first == "pytest":
        return hasattr(importlib.import_module(first), rest[0])
    # ``system.params()`` is an expression on some value; ``merged.Class`` was a name of the program.
    return hasattr(builtins, first) or (first[:1].islower() and not rest[-1][:1].isupper())


def _lost(path, name):
    lines = enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
    return [
        f"line {n}: {found[1]}" for n, line in lines for found in name.finditer(line) if not _exists(found[1])
    ]


@pytest.mark.parametrize("path", PATHS, ids=_module)
def test_every_name_in_double_backquotes_exists(path):
    assert not _lost(path, NAME)


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_every_name_of_the_program_on_a_page_exists(path):
    assert not _lost(path, re.compile(r"`(course(?:\.\w+)+)(?:\(.*?\))?`"))


@pytest.mark.parametrize(
    "name",
    ["course.nowhere", "Nowhere", "History.nowhere", "loops.nowhere", "math.nowhere", "merged.Nowhere"],
)
def test_a_name_that_does_not_exist_is_found(name):
    assert not _exists(name)
