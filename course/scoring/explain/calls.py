"""A submission read from its syntax tree: which functions call which others, and which may remember.

Its own helpers are followed.
"""

from __future__ import annotations

import ast

__all__ = ["calls_between", "may_remember", "reached_from"]

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
    return _reach(_defined(source), names)


def may_remember(source: bytes, tasks: frozenset[str]) -> frozenset[str]:
    """The tasks whose functions could keep something from one call to the next, directly or through helpers.

    The others have nowhere to keep it: no variable of the module but plain numbers and texts, no default
    argument that can change, no decorator, no attribute that is set, no class.
    """
    if len(source) > _LONGEST:
        return frozenset()
    defined = _defined(source)
    keeps = {node: _keeps(node) for node in dict.fromkeys(defined.values())}
    reach = _reach(defined, tasks)
    return frozenset(task for task in reach if any(keeps[defined[name]] for name in {task} | reach[task]))


def _keeps(node: ast.stmt) -> bool:
    """Whether something that a definition binds can change between two calls."""
    if isinstance(node, ast.Import | ast.ImportFrom):
        return False
    if isinstance(node, ast.Assign | ast.AnnAssign):
        return node.value is not None and not _is_fixed(node.value)
    if not isinstance(node, ast.FunctionDef) or node.decorator_list:
        return True
    defaults = [*node.args.defaults, *(default for default in node.args.kw_defaults if default)]
    return not all(map(_is_fixed, defaults)) or any(
        isinstance(child, ast.Global)
        or (isinstance(child, ast.Attribute) and isinstance(child.ctx, ast.Store))
        for child in ast.walk(node)
    )


def _is_fixed(value: ast.expr) -> bool:
    """Whether an expression is a number, a text, or a tuple of these: made of nothing that can change."""
    fixed = (
        ast.Constant,
        ast.UnaryOp,
        ast.BinOp,
        ast.Tuple,
        ast.Name,
        ast.Attribute,
        ast.operator,
        ast.unaryop,
    )
    return all(isinstance(child, (*fixed, ast.expr_context)) for child in ast.walk(value))


def _defined(source: bytes) -> dict[str, ast.stmt]:
    """The statement that binds each name of a module: a later one replaces an earlier one."""
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return {}
    defined: dict[str, ast.stmt] = {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            defined[node.name] = node
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            parts = (part for target in targets for part in ast.walk(target))
            defined |= {part.id: node for part in parts if isinstance(part, ast.Name)}
        elif isinstance(node, ast.Import | ast.ImportFrom):
            defined |= {(alias.asname or alias.name).partition(".")[0]: node for alias in node.names}
    return defined


def _reach(defined: dict[str, ast.stmt], names: frozenset[str] | None) -> dict[str, frozenset[str]]:
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
