"""Reads Python files of an exercise without running them: signatures, imports, and the checks' markers."""

import ast
import copy
import itertools
import json
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from course.authoring.report import Findings
from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.catalog.reading import read_text
from course.errors import ContentError

Function = ast.FunctionDef | ast.AsyncFunctionDef

#: A number with a decimal point or an exponent, which a hidden check's words must not contain.
DECIMAL = re.compile(r"(?<![\w.])\d+(?:\.\d+(?:[eE][-+]?\d+)?|[eE][-+]?\d+)(?![\w.]*\w)")

_INDIRECT = object()


@dataclass(frozen=True, slots=True)
class Signature:
    """A function's head: ``text`` without annotations, ``annotated`` as it is written."""

    line: int
    text: str
    annotated: str


@dataclass(frozen=True, slots=True)
class CheckSource:
    """A check as its source declares it.

    Attributes:
        id: the function's name without ``test_``.
        title: first line of its docstring; empty if there is none.
        task, points: what its markers say; None where a marker is missing or is not written as a plain value.
        requires: ids of the checks it depends on.
        indirect: names of markers whose values are known only when the file runs.
    """

    id: str
    path: Path
    line: int
    title: str
    task: str | None
    points: float | None
    requires: tuple[str, ...]
    hidden: bool
    indirect: tuple[str, ...] = ()


def parse(path: Path) -> ast.Module:
    text = read_text(path)
    try:
        return ast.parse(text, filename=str(path))
    except (SyntaxError, ValueError) as error:
        line = getattr(error, "lineno", None)
        problem = f"this is not valid Python: {getattr(error, 'msg', None) or error}."
        raise ContentError(path, line, problem, help="Correct the line.") from None


def signatures(tree: ast.Module) -> dict[str, Signature]:
    """The functions a module defines at its top level, by name; the last definition wins."""
    found = {}
    for node in tree.body:
        if isinstance(node, Function):
            plain, annotated = ast.unparse(_without_annotations(node.args)), ast.unparse(node.args)
            found[node.name] = Signature(node.lineno, f"{node.name}({plain})", f"{node.name}({annotated})")
    return found


def foreign_imports(tree: ast.Module, allowed: tuple[str, ...]) -> Iterator[tuple[int, str]]:
    """Line and name of each top-level package that is neither allowed nor of the standard library."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = ["." * node.level + (node.module or "")]
        else:
            continue
        for name in names:
            top = name.split(".")[0]
            if top not in allowed and top not in sys.stdlib_module_names:
                yield node.lineno, name


def checks_in(path: Path, tree: ast.Module, *, hidden: bool) -> tuple[CheckSource, ...]:
    return tuple(
        _check(node, path, hidden=hidden)
        for node in tree.body
        if isinstance(node, Function) and node.name.startswith("test_")
    )


def _check(node: Function, path: Path, *, hidden: bool) -> CheckSource:
    marks = {name: _marked(node, name) for name in ("task", "points", "requires")}
    task = next((value for value in marks["task"] if isinstance(value, str)), None)
    points = next((value for value in marks["points"] if type(value) in {int, float}), None)
    return CheckSource(
        id=node.name.removeprefix("test_"),
        path=path,
        line=node.lineno,
        title=(ast.get_docstring(node) or "").split("\n", maxsplit=1)[0].strip(),
        task=task,
        points=None if points is None else float(points),
        requires=tuple(value for value in marks["requires"] if isinstance(value, str)),
        hidden=hidden,
        indirect=tuple(name for name, values in marks.items() if _INDIRECT in values),
    )


def quoted_numbers(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Decimal numbers in a check's words for the student, hidden or not: line and number.

    Those words are ``message=`` and ``help=`` anywhere, the texts of a ``Diagnosis``, and texts given by
    position to ``fail`` and ``expect_true``.
    """
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        texts: list[ast.expr] = [k.value for k in node.keywords if k.arg in {"message", "help"}]
        if name == "Diagnosis":
            texts += [*node.args, *(k.value for k in node.keywords if k.arg in {"looks_like", "advice"})]
        elif name in {"fail", "expect_true"}:
            texts += node.args
        for part in itertools.chain.from_iterable(map(ast.walk, texts)):
            if isinstance(part, ast.Constant) and isinstance(part.value, str):
                for match in DECIMAL.finditer(part.value):
                    yield part.lineno, match[0]


def _without_annotations(arguments: ast.arguments) -> ast.arguments:
    bare = copy.deepcopy(arguments)
    for node in ast.walk(bare):
        if isinstance(node, ast.arg):
            node.annotation = None
    return bare


def _marked(node: Function, name: str) -> list[Any]:
    """The arguments of the decorators ``@pytest.mark.<name>(...)``; _INDIRECT for what is no plain value."""
    return [
        _literal(argument)
        for decorator in node.decorator_list
        if isinstance(decorator, ast.Call) and ast.unparse(decorator.func) == f"pytest.mark.{name}"
        for argument in decorator.args
    ]


def _literal(expression: ast.expr) -> Any:
    try:
        return ast.literal_eval(expression)
    except ValueError:
        return _INDIRECT


# ---
# The audit of exercises' Python as ruff sees it, by the rules of the course they belong to.


def audit_style(catalog: Catalog, exercises: Sequence[Exercise], findings: Findings) -> None:
    """Report what ruff finds; nothing where it is not installed, or the course has no rules for it."""
    root = catalog.content.root
    if not exercises or not (root / "pyproject.toml").is_file() or find_spec("ruff") is None:
        return
    above = (catalog.content.exercises, *catalog.content.instructors())
    folders = [folder / exercise.place for exercise in exercises for folder in above]

    def said(*arguments: str) -> str:
        there = (str(folder) for folder in folders if folder.is_dir())  # a warm-up has no hidden checks
        command = [sys.executable, "-m", "ruff", *arguments, *there]
        return subprocess.run(command, cwd=root, capture_output=True, text=True, check=False).stdout

    for one in json.loads(said("check", "--output-format", "json") or "[]"):
        message = f"{one['message']} ({one['code']})."
        fix = "Try `ruff check --fix`." if one["fix"] else "Change the line."
        findings.add(one["filename"], one["location"]["row"], "style", message, fix)
    for line in said("format", "--diff").splitlines():
        if line.startswith(start := "--- "):
            name = line.removeprefix(start)
            message, fix = "it is not laid out as ruff lays it out.", f"Run `ruff format {name}`."
            findings.add(root / name, None, "style", message, fix)


#: Of numpy's own generator, what draws nothing.
_NO_DRAWS = frozenset({"default_rng", "seed"})


def unseeded(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Calls that draw from no seed, with their lines: numpy's own, those of Python, one made of nothing."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            head, _, name = ast.unparse(node.func).rpartition(".")
            given = [ast.unparse(one) for one in node.args] + [one.arg for one in node.keywords]
            fresh = name in {"default_rng", "RandomState", "Random"} and given in ([], ["None"])
            shared = (
                head in {"np.random", "numpy.random", "random"} and name.islower() and name not in _NO_DRAWS
            )
            if fresh or shared:
                yield node.lineno, f"{ast.unparse(node.func)}()"
