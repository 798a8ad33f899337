"""A submission read from its syntax tree: which functions call which others, and which may remember.

Its own helpers are followed.
"""

from __future__ import annotations

import ast
import functools

__all__ = ["calls_between", "may_remember", "reached_from"]

#: Largest source that is parsed here, in bytes, because this process has no limits: it takes a third of a
#: second and 90 MB at most. The longest file of the course has 27,000.
_LONGEST = 100_000
#: Built-in functions and methods that change nothing of what they are given.
_READERS = {
    "abs",
    "all",
    "any",
    "dict",
    "enumerate",
    "float",
    "int",
    "isinstance",
    "len",
    "list",
    "max",
    "min",
}
_READERS |= {"range", "reversed", "round", "set", "sorted", "str", "sum", "tuple", "zip"}
_VIEWS = {"copy", "get", "items", "keys", "values"}
_LIBRARIES = {"math", "np", "numpy"}


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
    return _reach(*_read(source), names)


def may_remember(source: bytes, tasks: frozenset[str]) -> frozenset[str]:
    """The tasks whose functions could keep something from one call to the next, directly or through helpers.

    The others have nowhere to keep it: no variable of the module but numbers, texts and tables that are only
    read, no default argument that can change, no decorator, no attribute that is set, no class.
    """
    if len(source) > _LONGEST:
        return frozenset()
    defined, parts = _read(source)
    handed_on = set().union(*map(_handed_on, parts.values()))
    keeps = {node: _keeps(node, inside, handed_on) for node, inside in parts.items()}
    reach = _reach(defined, parts, tasks)
    return frozenset(task for task in reach if any(keeps[defined[name]] for name in {task} | reach[task]))


def _keeps(node: ast.stmt, inside: list[ast.AST], handed_on: set[str]) -> bool:
    """Whether something that a definition binds can change between two calls."""
    if isinstance(node, ast.Import | ast.ImportFrom):
        return False
    if isinstance(node, ast.Assign | ast.AnnAssign):
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        bound = {part.id for target in targets for part in ast.walk(target) if isinstance(part, ast.Name)}
        return node.value is not None and not _is_fixed(node.value) and bool(bound & handed_on)
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
    read = {id(part) for child in inside for part in _merely_read(child)}
    names = (child for child in inside if isinstance(child, ast.Name) and isinstance(child.ctx, ast.Load))
    return {name.id for name in names if id(name) not in read}


def _merely_read(node: ast.AST) -> list[ast.expr]:
    """The parts of an expression that it only reads."""
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


@functools.lru_cache(maxsize=1)  # of the submission at hand: it is read when loaded, and where a check fails
def _read(source: bytes) -> tuple[dict[str, ast.stmt], dict[ast.stmt, list[ast.AST]]]:
    """What each name of a module is bound by, and all nodes of each of these statements."""
    defined = _defined(source)
    return defined, {node: list(ast.walk(node)) for node in dict.fromkeys(defined.values())}


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


def _reach(
    defined: dict[str, ast.stmt], parts: dict[ast.stmt, list[ast.AST]], names: frozenset[str] | None
) -> dict[str, frozenset[str]]:
    # By statement: one may bind thousands of names.
    uses = {
        node: {child.id for child in inside if isinstance(child, ast.Name)} & defined.keys()
        for node, inside in parts.items()
    }
    wanted = defined if names is None else names & defined.keys()
    return {name: frozenset(_reached(name, defined, uses)) for name in wanted}


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
