"""Which functions of a submission call which others: read from its syntax tree, including its own helpers."""

from __future__ import annotations

import ast

__all__ = ["calls_between", "reached_from"]

#: Largest source that is parsed here, in bytes, because this process has no limits: it takes a third of a
#: second and 90 MB at most. The longest file of the course has 27,000.
_LONGEST = 100_000


def calls_between(source: bytes, tasks: frozenset[str]) -> dict[str, tuple[str, ...]]:
    """For each task's function, the other tasks' functions that it calls, directly or through helpers.

    Args:
        source: of the submission; a source that cannot be parsed, or is longer than any honest file, calls
            nothing.
        tasks: names of the functions to look at.
    """
    if len(source) > _LONGEST:
        return {}
    reach = reached_from(source, tasks)
    return {task: tuple(sorted(reach[task] & tasks - {task})) for task in reach}


def reached_from(source: bytes, names: frozenset[str] | None = None) -> dict[str, frozenset[str]]:
    """For each function, class and constant of a module, the others it uses, directly or through others.

    Args:
        source: a source that cannot be parsed has none.
        names: which ones to examine; None for all, which takes time proportional to the square of their
            number.
    """
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return {}
    # A later definition replaces an earlier one.
    defined: dict[str, ast.stmt] = {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            defined[node.name] = node
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            defined |= {target.id: node for target in targets if isinstance(target, ast.Name)}
        elif isinstance(node, ast.Import | ast.ImportFrom):
            defined |= {(alias.asname or alias.name).partition(".")[0]: node for alias in node.names}
    # By statement: one may bind thousands of names.
    uses = {node: _names(node) & defined.keys() for node in dict.fromkeys(defined.values())}
    wanted = defined if names is None else names & defined.keys()
    return {name: frozenset(_reached(name, defined, uses)) for name in wanted}


def _names(node: ast.AST) -> set[str]:
    return {child.id for child in ast.walk(node) if isinstance(child, ast.Name)}


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
