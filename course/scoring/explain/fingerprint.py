"""A function's answers to a list of questions, reduced to a few numbers that can be distributed and compared.

Answers are flattened to numbers: None, True, each text, nan, infinities, lengths and exceptions each have a
number of their own, and dicts contribute their values in the order of the keys. Then a few weighted sums are
taken over all of them. Programs with the same answers have the same sums; programs with any difference have
different sums, except by a chance of one in millions. The answers cannot be recovered from the sums.
"""

from __future__ import annotations

import array
import ast
import functools
import math
import zlib
from collections.abc import Callable
from typing import Any

import numpy as np

from course.isolation.inside import statements

Answers = list[Any]
#: Weighted sums of a fingerprint.
SUMS = 2

_NONE, _TRUE, _FALSE, _TEXT, _NAN, _INFINITE, _RAISED, _OTHER = 0.7071, 1.1, -1.1, 2.3, 31.4, 27.2, 51.7, 43.1
_MOST = 20_000
_LARGEST = 1e300  # JSON has no infinity


def fingerprint(answers: Answers) -> tuple[float, ...]:
    """``SUMS`` numbers for the answers to the questions of a task.

    Args:
        answers: plain values, one for each question; an exception's class name as ``{"raised": name}``.
    """
    numbers = numbers_of(answers)[:_MOST]
    weights = np.random.default_rng(20260).uniform(-1.0, 1.0, (SUMS, _MOST))[:, : len(numbers)]
    # Large values count by their logarithm, so that a path that diverges is still compared digit by digit.
    return tuple(round(float(total), 7) for total in weights @ np.arcsinh(numbers))


def numbers_of(answers: Answers) -> np.ndarray[Any, Any]:
    """All the numbers of plain values, in order: equal values have the same ones."""
    numbers = array.array("d")
    for answer in answers:
        _put(numbers, answer)
    return np.array(numbers)


def read(answer: Any, reader: Callable[[Any], Any] | None) -> Any:
    """The part of an answer that counts: the result of the exercise's reader.

    Args:
        reader: ``READ`` of the exercise's questions; an answer that it cannot read counts like an exception.
    """
    if reader is None or (isinstance(answer, dict) and answer.keys() == {"raised"}):
        return answer
    try:
        return reader(answer)
    except Exception as error:  # noqa: BLE001 - a student's answer may be anything
        return {"raised": type(error).__name__}


def in_range(value: float) -> float:
    """A number that JSON can hold: infinity becomes the largest, nan becomes -1, which no answer is."""
    try:
        number = float(value)
    except OverflowError:
        return _LARGEST
    return -1.0 if math.isnan(number) else max(-_LARGEST, min(number, _LARGEST))


def _put(numbers: array.array[float], value: Any, depth: int = 8) -> None:
    if isinstance(value, dict) and value.keys() == {"raised"}:
        numbers.append(_RAISED)
    elif isinstance(value, np.ndarray) and value.ndim:
        _put_floats(numbers, _with_lengths(_as_numbers(value)))
    elif isinstance(value, list | tuple) and depth:
        numbers.append(float(len(value)))
        if set(map(type, value)) == {float}:
            _put_floats(numbers, np.array(value))
        else:
            for item in value:
                _put(numbers, item, depth - 1)
    elif isinstance(value, dict) and depth:
        numbers.append(float(len(value)))
        for key in sorted(value, key=str):  # the order of insertion does not matter
            _put(numbers, value[key], depth - 1)
    else:
        numbers.append(_number(value.item() if isinstance(value, np.ndarray) else value))


def _as_numbers(value: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """An array's elements as ``_number`` has them, at the cost of an array and not of its elements."""
    if value.dtype.kind == "b":
        return np.where(value, _TRUE, _FALSE)
    return value.astype(float) if value.dtype.kind in "fiu" else np.full(value.shape, _OTHER)


def _with_lengths(value: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """An array as a vector, the length of each row before the row."""
    rows, width = value[..., np.newaxis], 1
    for axis in reversed(range(value.ndim)):
        outer, length = value.shape[:axis], value.shape[axis]
        lengths = np.full((*outer, 1), float(length))
        rows = np.concatenate([lengths, rows.reshape(*outer, length * width)], axis=-1)
        width = rows.shape[-1]
    return rows


def _put_floats(numbers: array.array[float], value: np.ndarray[Any, Any]) -> None:
    numbers.frombytes(np.nan_to_num(value, nan=_NAN, posinf=_INFINITE, neginf=-_INFINITE).tobytes())


def _number(value: Any) -> float:
    if isinstance(value, bool | np.bool_):
        return _TRUE if value else _FALSE
    if isinstance(value, int | float | np.integer | np.floating):
        try:
            number = float(value)
        except OverflowError:
            return _INFINITE
        if math.isnan(number):
            return _NAN
        return math.copysign(_INFINITE, number) if math.isinf(number) else number
    if isinstance(value, str):  # a different number for every text, except by a chance of one in thousands
        return _TEXT + zlib.crc32(value.encode("utf-8", "replace")) / 2**32
    return _NONE if value is None else _OTHER


# ---
# A submission read from its syntax tree: which functions call which others, and which may remember.
#
# Its own helpers are followed.


#: Largest source that is parsed here, in bytes, because this process has no limits: it takes a third of a
#: second and 90 MB at most. The longest file of the course has 27,000.
_LONGEST = 100_000
#: Built-in functions and methods that change nothing of what they are given.
_READERS = {"abs", "all", "any", "dict", "enumerate", "float", "int", "isinstance", "len", "list", "max"}
_READERS |= {"min", "range", "reversed", "round", "set", "sorted", "str", "sum", "tuple", "zip"}
_VIEWS = {"copy", "get", "items", "keys", "values"}
_LIBRARIES = {"math", "np", "numpy"}


def calls_between(source: bytes, tasks: frozenset[str]) -> dict[str, tuple[str, ...]]:
    """For each task's function, the other tasks' functions that it calls, directly or through helpers."""
    reach = reached_from(source, tasks)
    return {task: tuple(sorted(reach[task] & tasks - {task})) for task in reach}


def reached_from(source: bytes, names: frozenset[str]) -> dict[str, frozenset[str]]:
    """For some functions, classes and constants of a module, the others they use, directly or through others.

    Args:
        source: one that cannot be parsed, or is longer than any honest file, has none.
        names: which ones to examine; all would take time proportional to the square of their number.
    """
    defined, parts = _read(source)
    # By statement: one may bind thousands of names.
    uses = {
        node: {child.id for child in inside if isinstance(child, ast.Name)} & defined.keys()
        for node, inside in parts.items()
    }
    return {name: frozenset(_reached(name, defined, uses)) for name in names & defined.keys()}


def functions_of(source: bytes, task: str) -> list[ast.FunctionDef]:
    """The function of a task, then the functions of the file that it uses, directly or through others."""
    defined, _ = _read(source)
    reached = sorted(reached_from(source, frozenset({task})).get(task, frozenset()) - {task})
    found = (defined[name] for name in (task, *reached) if name in defined)
    return [node for node in found if isinstance(node, ast.FunctionDef)]


def may_remember(source: bytes, tasks: frozenset[str]) -> frozenset[str]:
    """The tasks whose functions could keep something from one call to the next, directly or through helpers.

    The others have nowhere to keep it: no variable of the module but numbers, texts and tables that are only
    read, no default argument that can change, no decorator, no attribute that is set, no class.
    """
    defined, parts = _read(source)
    handed_on = set().union(*map(_handed_on, parts.values()))
    keeps = {node: _keeps(node, inside, handed_on) for node, inside in parts.items()}
    reach = reached_from(source, tasks)
    return frozenset(task for task in reach if any(keeps[defined[name]] for name in {task} | reach[task]))


def _keeps(node: ast.stmt, inside: list[ast.AST], handed_on: set[str]) -> bool:
    """Whether something that a definition binds can change between two calls."""
    if isinstance(node, ast.Import | ast.ImportFrom):
        return False
    if isinstance(node, ast.Assign | ast.AnnAssign):
        return node.value is not None and not _is_fixed(node.value) and bool(_assigned(node) & handed_on)
    if not isinstance(node, ast.FunctionDef) or node.decorator_list:
        return True
    defaults = [*node.args.defaults, *(default for default in node.args.kw_defaults if default)]
    return not all(map(_is_fixed, defaults)) or any(
        isinstance(child, ast.Global)
        or (isinstance(child, ast.Attribute) and isinstance(child.ctx, ast.Store))
        for child in inside
    )


def _handed_on(inside: list[ast.AST]) -> set[str]:
    """Names whose values a statement may change, or hand to what may: all that it does not merely read."""
    read = {id(part) for child in inside if isinstance(child, _READING) for part in _merely_read(child)}
    names = (child for child in inside if isinstance(child, ast.Name) and isinstance(child.ctx, ast.Load))
    return {name.id for name in names if id(name) not in read}


_READING = (ast.Subscript, ast.Call, ast.For, ast.comprehension, ast.Compare, ast.BinOp)


def _merely_read(node: ast.AST) -> list[ast.expr]:
    read: list[ast.expr] = []
    match node:
        case ast.Subscript(value=table, ctx=ast.Load()):
            read = [table]
        case ast.Call(func=ast.Name(id=name) as called):
            read = [called, *(node.args if name in _READERS else [])]
        case ast.Call(func=ast.Attribute(value=ast.Name(id=owner) as holder, attr=method)):
            # numpy changes an array only where it is told to write into it.
            read = node.args if owner in _LIBRARIES and not node.keywords else []
            read = [*read, holder] if method in _VIEWS else read
        case ast.For(iter=table) | ast.comprehension(iter=table):
            read = [table]
        case ast.Compare():
            read = [node.left, *node.comparators]
        case ast.BinOp():
            read = [node.left, node.right]
    return read


def _is_fixed(value: ast.expr) -> bool:
    """Whether an expression is a number, a text, or a tuple of these: made of nothing that can change."""
    fixed = ast.Constant | ast.UnaryOp | ast.BinOp | ast.Tuple | ast.Name | ast.Attribute
    return all(
        isinstance(child, fixed | ast.operator | ast.unaryop | ast.expr_context) for child in ast.walk(value)
    )


@functools.lru_cache(maxsize=1)  # of the submission at hand: it is read when loaded, and where a check fails
def _read(source: bytes) -> tuple[dict[str, ast.stmt], dict[ast.stmt, list[ast.AST]]]:
    """The statement that binds each name of a module, a later one in place of an earlier; their nodes."""
    tree = statements.tree(source if len(source) <= _LONGEST else b"")
    if tree is None:
        return {}, {}
    defined: dict[str, ast.stmt] = {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            defined[node.name] = node
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            defined |= dict.fromkeys(_assigned(node), node)
        elif isinstance(node, ast.Import | ast.ImportFrom):
            defined |= {(alias.asname or alias.name).partition(".")[0]: node for alias in node.names}
    return defined, {node: list(ast.walk(node)) for node in dict.fromkeys(defined.values())}


def _assigned(node: ast.Assign | ast.AnnAssign) -> set[str]:
    """The names in what a statement assigns to."""
    targets = node.targets if isinstance(node, ast.Assign) else [node.target]
    return {part.id for target in targets for part in ast.walk(target) if isinstance(part, ast.Name)}


def _reached(name: str, defined: dict[str, ast.stmt], uses: dict[ast.stmt, set[str]]) -> set[str]:
    seen: set[str] = set()
    left, done = [name], set()
    while left:
        node = defined[left.pop()]
        if node not in done:
            done.add(node)
            new = uses[node] - seen
            seen |= new
            left += new
    return seen
