"""Which functions of a submission call which: read from its syntax tree, helpers of its own included."""

from __future__ import annotations

import ast

__all__ = ["calls_between"]


def calls_between(source: bytes, tasks: frozenset[str]) -> dict[str, tuple[str, ...]]:
    """For each task's function the other tasks' functions it calls, itself or through helpers.

    Args:
        source: of the submission; what cannot be parsed calls nothing.
        tasks: names of the functions to look at.
    """
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return {}
    # A later definition replaces an earlier one.
    functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    named = {name: _names(node) & functions.keys() for name, node in functions.items()}
    return {task: tuple(sorted(_reached(task, named) & tasks - {task})) for task in tasks & functions.keys()}


def _names(node: ast.AST) -> set[str]:
    return {child.id for child in ast.walk(node) if isinstance(child, ast.Name)}


def _reached(name: str, named: dict[str, set[str]]) -> set[str]:
    seen: set[str] = set()
    left = [name]
    while left:
        for other in named.get(left.pop(), set()) - seen:
            seen.add(other)
            left.append(other)
    return seen
