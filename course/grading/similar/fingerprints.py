"""Fingerprints of Python code that do not depend on names, comments or layout.

The syntax tree is flattened, in order, into a sequence of kinds of nodes; every run of a few of them is
hashed, and in each window the smallest hash is kept (winnowing: Schleimer, Wilkerson, Aiken, "Winnowing:
local algorithms for document fingerprinting", SIGMOD 2003, section 3). Any passage of at least ``RUN + WINDOW
- 1`` nodes that two sources share leaves a fingerprint that they share.

Parsing a stranger's source can exhaust the parser, so this module runs as a process of its own:
``python -m course.grading.similar.fingerprints`` reads sources as frames and answers with fingerprints. It
never runs them.
"""

from __future__ import annotations

import ast
import contextlib
import hashlib
import os
import subprocess
import sys
import threading
import warnings
from collections import deque
from pathlib import Path
from typing import TYPE_CHECKING, Self

import msgspec

from course.grading.pipes import limit_cpu, limit_memory, read_frame, write_frame

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["LONGEST", "RUN", "WINDOW", "Parser", "Prints", "fingerprints"]

#: Nodes in a hashed run: about two statements. Shorter ones are common to all Python.
RUN = 20
#: A function of fewer nodes than this is too short to show who wrote it.
_SHORTEST = 12
#: Hashes in a window; passages shorter than RUN + WINDOW - 1 nodes may go unnoticed.
WINDOW = 8
#: For one source. The largest takes under 2 s of CPU; a busy machine six times as long by the wall clock.
_CPU_S, _WALL_S = 10, 60.0
#: Bytes of a source that is compared. The longest file of this course has 27,000; a megabyte that is
#: legal Python becomes 700 MB of syntax tree, and a page of two hundred pairs shows it two hundred times.
LONGEST = 200_000
_MEMORY = 1 << 30

#: Reading or writing a name, or the name of an import, does not make another program.
_SKIPPED = (ast.expr_context, ast.alias)


class Prints(msgspec.Struct, frozen=True):
    """Fingerprints of one source.

    Attributes:
        marks: hash -> the lines it was seen on, as (first, last) pairs, 1 first.
        whole: digest of the whole sequence of nodes; equal for sources that differ in names and layout only.
        nodes: its length.
    """

    marks: dict[int, tuple[tuple[int, int], ...]]
    whole: str
    nodes: int


def fingerprints(source: bytes) -> Prints | None:
    """The fingerprints of a source; None if it is not Python."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    marks: dict[int, set[tuple[int, int]]] = {}
    whole = hashlib.sha256()
    nodes = 0
    for part in _parts(tree):
        walked = list(_walk(part))
        kinds = [kind for kind, _ in walked]
        whole.update("\0".join(kinds).encode() + b"\n")
        nodes += len(kinds)
        run = min(RUN, len(kinds))
        if run < _SHORTEST:
            continue
        for number, start in _winnowed([_hash(kinds[i : i + run]) for i in range(len(kinds) - run + 1)]):
            lines = [line for _, line in walked[start : start + run]]
            marks.setdefault(number, set()).add((min(lines), max(lines)))
    found = {number: tuple(sorted(places)) for number, places in marks.items()}
    return Prints(found, whole.hexdigest(), nodes)


def _parts(tree: ast.Module) -> Iterator[ast.AST]:
    """Functions and classes of a module, each by itself: their order means nothing. The rest comes last."""
    definitions = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
    rest = ast.Module([], [])
    for statement in tree.body:
        if isinstance(statement, definitions):
            yield statement
        else:
            rest.body.append(statement)
    yield rest


def _walk(tree: ast.AST) -> Iterator[tuple[str, int]]:
    """Kinds of nodes in the order of the source, with their lines; no recursion, as trees may be deep."""
    waiting: deque[tuple[ast.AST, int]] = deque([(tree, 1)])
    while waiting:
        node, line = waiting.pop()
        if isinstance(node, _SKIPPED):
            continue
        line = getattr(node, "lineno", line)
        if not isinstance(node, ast.Module):
            yield _kind(node), line
        children = list(ast.iter_child_nodes(node))
        if _has_docstring(node):
            del children[_docstring_at(node, children)]
        waiting.extend((child, line) for child in reversed(children))


def _kind(node: ast.AST) -> str:
    """A node's kind, without names and values: a copier changes these first."""
    if isinstance(node, ast.Constant):
        return f"Constant {type(node.value).__name__}"
    if isinstance(node, ast.Attribute):
        return f"Attribute {node.attr}"  # mostly a library's name, which says what is done
    return type(node).__name__


def _has_docstring(node: ast.AST) -> bool:
    body = getattr(node, "body", None)
    if not isinstance(node, ast.Module | ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef) or not body:
        return False
    first = body[0]
    return (
        isinstance(first, ast.Expr)
        and isinstance(first.value, ast.Constant)
        and isinstance(first.value.value, str)
    )


def _docstring_at(node: ast.AST, children: list[ast.AST]) -> int:
    return children.index(node.body[0])  # type: ignore[attr-defined] # it was seen to have a docstring


def _hash(kinds: list[str]) -> int:
    """A hash that is the same in every process."""
    return int.from_bytes(hashlib.blake2b("\0".join(kinds).encode(), digest_size=6).digest(), "little")


def _winnowed(hashes: list[int]) -> Iterator[tuple[int, int]]:
    """The smallest hash of every window, of equal ones the rightmost; each once."""
    last = -1
    for start in range(max(1, len(hashes) - WINDOW + 1) if hashes else 0):
        window = hashes[start : start + WINDOW]
        smallest = min(window)
        at = start + max(i for i, number in enumerate(window) if number == smallest)
        if at != last:
            last = at
            yield smallest, at


class _Reply(msgspec.Struct, frozen=True):
    prints: Prints | None


class Parser:
    """A process that fingerprints sources; started again if one of them kills it."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._end()

    def __call__(self, source: bytes) -> Prints | None:
        """The fingerprints of a source; None if it is not Python, takes too long or is too long."""
        if len(source) > LONGEST:
            return None
        process = self._process = self._process or _start()
        assert process.stdin is not None
        assert process.stdout is not None
        deadline = threading.Timer(_WALL_S, process.kill)
        deadline.start()
        try:
            write_frame(process.stdin, source)
            frame = read_frame(process.stdout)
        except OSError:
            frame = None
        finally:
            deadline.cancel()
        if frame is None:
            self._end()
            return None
        return msgspec.msgpack.decode(frame, type=_Reply).prints

    def _end(self) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        process.kill()
        process.wait()
        for stream in (process.stdin, process.stdout):
            if stream is not None:
                with contextlib.suppress(OSError):
                    stream.close()


def _start() -> subprocess.Popen[bytes]:
    package = str(Path(__file__).resolve().parents[3])
    environment = {**os.environ}
    environment["PYTHONPATH"] = os.pathsep.join(filter(None, (package, environment.get("PYTHONPATH"))))
    command = [sys.executable, "-P", "-m", "course.grading.similar.fingerprints"]
    # Its output is of no use: a source that cannot be parsed is reported by name.
    return subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment
    )


def main() -> None:
    """Serve until standard input ends."""
    limit_memory(_MEMORY)
    source, sink = sys.stdin.buffer, sys.stdout.buffer
    while (frame := read_frame(source)) is not None:
        limit_cpu(_CPU_S)
        write_frame(sink, _Reply(fingerprints(msgspec.msgpack.decode(frame, type=bytes))))


if __name__ == "__main__":
    main()
