"""A module's text statement by statement: what of it is Python, and what its functions need.

This runs beside a stranger's code and, for notebooks, where their cells are read. It imports the standard
library and nothing of this course.
"""

from __future__ import annotations

import ast
import itertools
import re
import symtable
import warnings
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Sequence

#: What Python raises for a text that it cannot read; the last two for nesting that its parser cannot follow.
UNREADABLE = (SyntaxError, ValueError, RecursionError, MemoryError)
#: A line on which a statement of a module begins: neither indented, nor a comment, nor the end of a bracket,
#: nor a further part of the statement before.
_BEGINS = re.compile(r"(?!(?:else|elif|except|finally)\b)[^\s#)\]}]")
#: Errors of a piece that may be whole together with what follows it.
_UNFINISHED = ("was never closed", "unterminated triple-quoted")
#: A line that Python names within the text that it was given.
_WITHIN = re.compile(r" \(detected at line \d+\)| on line \d+")
_DEFINES = re.compile(r"^(?:async[ \t]+)?def[ \t]+(\w+)|^class[ \t]+(\w+)|^(\w+)[ \t]*=(?!=)", re.MULTILINE)


def line_of_bytes(source: bytes, error: BaseException) -> int:
    """The line with the bytes that are no text; 0 where no line has any.

    Python names none where they stand before a declaration of the encoding could end.
    """
    at = getattr(error, "start", -1)
    if at < 0:
        try:
            at = source.decode("utf-8").encode().find(b"\0")
        except UnicodeDecodeError as bad:
            at = bad.start
    return len(source[: at + 1].splitlines())


#: What ``git merge`` leaves where both sides changed the same lines.
MERGE = ("<<<<<<<", "=======", ">>>>>>>")


class Piece(NamedTuple):
    """Some lines of a module that belong together.

    Attributes:
        line: of the module on which it begins, 1 first.
        body: its statements, with the module's lines; empty if it is no Python.
        error: why it is none.
        names: what a piece that is no Python would define, by its look.
    """

    line: int
    body: list[ast.stmt]
    error: BaseException | None = None
    names: tuple[str, ...] = ()


def parsed(text: str | bytes, line: int = 1) -> list[ast.stmt]:
    """The statements of a text that begins on a line.

    Raises:
        UNREADABLE: it is no Python; a SyntaxError's line is the module's.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about escapes in the student's strings
            tree = ast.parse(text)
    except SyntaxError as error:
        error.lineno = (error.lineno or 1) + line - 1
        error.msg = _WITHIN.sub("", str(error.msg))
        raise
    if line > 1:
        ast.increment_lineno(tree, line - 1)
    return tree.body


def pieces(source: str) -> list[Piece]:
    """A module that is no Python as a whole, in pieces of which each is, or is not.

    A piece ends where the next statement begins at the edge of the page. Where it ends in the middle of a
    bracket or a text of several lines, it goes on.
    """
    lines = source.split("\n")
    starts = [number for number, line in enumerate(lines) if _BEGINS.match(line)]
    decorated = {after for at, after in itertools.pairwise(starts) if lines[at].startswith("@")}
    starts = [at for at in starts if at not in decorated]
    ends = [*starts[1:], len(lines)]
    # Each line is tried once, and again only behind something that is not finished.
    left = 8 * len(source) + 100_000
    found: list[Piece] = []
    at = 0
    while at < len(starts):
        piece, upto = _piece(lines, starts[at], ends[at]), at + 1
        first = piece
        while piece.error is not None and upto < len(starts) and left > 0 and _goes_on(piece.error):
            left -= sum(map(len, lines[starts[at] : ends[upto]]))
            piece, upto = _piece(lines, starts[at], ends[upto]), upto + 1
        if piece.error is not None:
            piece, upto = first, at + 1
        found.append(piece)
        at = upto
    return found


def _goes_on(error: BaseException) -> bool:
    return isinstance(error, SyntaxError) and any(words in str(error.msg) for words in _UNFINISHED)


def _piece(lines: list[str], start: int, end: int) -> Piece:
    text = "\n".join(lines[start:end])
    try:
        return Piece(start + 1, parsed(text, start + 1))
    except UNREADABLE as error:
        return Piece(start + 1, [], error, tuple(defined_in(text)))


def defined_in(text: str) -> list[str]:
    """The names that a text would define at its top level if it were Python, by its look."""
    return [next(filter(None, names)) for names in _DEFINES.findall(text)]


# -- what functions need ----------------------------------------------------------------------------------


def needed(statements: Sequence[ast.stmt], names: Iterable[str], always: Collection[int] = ()) -> list[int]:
    """Indices of the statements that bind or change names, and of those that these need, in order.

    Args:
        always: indices of statements that count whether or not anything needs them.
    """
    binding: dict[str, list[int]] = {}
    for index, node in enumerate(statements):
        for name in bound(node):
            binding.setdefault(name, []).append(index)
    kept = {*binding.pop("*", ()), *always}  # a star import may bind anything
    wanted = [*names, *(name for index in kept for name in loaded(statements[index]))]
    while wanted:
        for index in binding.pop(wanted.pop(), ()):  # each name is looked up once
            if index not in kept:
                kept.add(index)
                wanted += loaded(statements[index])
    return sorted(kept)


def bound(node: ast.AST) -> Iterator[str]:
    """Names that a statement binds at its own level, or changes: x = 1, x[0] = 1, x.append(1), def x."""
    match node:
        case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
            yield node.name
        case ast.Import() | ast.ImportFrom():
            for alias in node.names:
                yield (alias.asname or alias.name).partition(".")[0]
        case ast.Name(ctx=ast.Store() | ast.Del()):
            yield node.id
        case ast.Attribute(ctx=ast.Store() | ast.Del()) | ast.Subscript(ctx=ast.Store() | ast.Del()):
            yield from _base(node)
        case ast.Expr(value=ast.Call(func=ast.Attribute() as method)):
            yield from _base(method)
        case ast.Lambda() | ast.ListComp() | ast.SetComp() | ast.DictComp() | ast.GeneratorExp():
            return
        case _:
            for child in ast.iter_child_nodes(node):
                yield from bound(child)


def _base(node: ast.expr) -> Iterator[str]:
    """The name at the root of a.b[c].d."""
    while isinstance(node, ast.Attribute | ast.Subscript):
        node = node.value
    if isinstance(node, ast.Name):
        yield node.id


def loaded(node: ast.AST) -> Iterator[str]:
    """Every name of the module that a piece of code reads; parameters and other local names are none."""
    yield from _augmented(node)
    try:
        table = symtable.symtable(ast.unparse(node), "statement", "exec")
    except SyntaxError:  # such as a return outside of a function: the names it reads are unknown
        yield from (child.id for child in ast.walk(node) if isinstance(child, ast.Name))
    else:
        yield from _global(table)


def _global(table: symtable.SymbolTable) -> Iterator[str]:
    """Names that a scope and those within it take from the module."""
    outermost = table.get_type() == "module"
    for symbol in table.get_symbols():
        if symbol.is_referenced() if outermost else symbol.is_global():
            yield symbol.get_name()
    for child in table.get_children():
        yield from _global(child)


def _augmented(node: ast.AST) -> Iterator[str]:
    """Names that are changed from what they were, at the level of the module: x += 1."""
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.Lambda):
        return
    if isinstance(node, ast.AugAssign):
        yield from _base(node.target)
    for child in ast.iter_child_nodes(node):
        yield from _augmented(child)


# -- what IPython adds ------------------------------------------------------------------------------------

#: Cell magics whose body is Python of this notebook; the cells of all others are something else.
PYTHON_MAGICS = frozenset({"time", "timeit", "capture", "prun", "memit", "mprun", "lprun"})
#: Of a line without space around it: a million spaces in a row would be tried in every way to part them.
_MAGIC = re.compile(r"[%!?]|[\w.,\s\[\]]+=\s*[%!]|[\w.*]+\?{1,2}$")


def without_magics(text: str) -> tuple[str, tuple[tuple[int, str], ...]]:
    """The text with ``pass`` for IPython's lines, (line, text) each; every other line keeps its number."""
    if tree(text) is not None:
        return text, ()  # Python as it stands, also where a line begins with a percent sign
    lines = text.split("\n")
    taken: list[tuple[int, str]] = []
    for index in _statement_lines(text):
        whole = lines[index]
        shown = whole.strip()
        if _MAGIC.match(shown) and tree(shown) is None:
            indent = whole[: len(whole) - len(whole.lstrip())]
            lines[index] = indent + "pass"
            taken.append((index + 1, shown))
    return "\n".join(lines), tuple(taken)


def without_shell(text: str) -> tuple[str, tuple[tuple[int, str], ...]]:
    """The text without statements that are magics written out: get_ipython().run_line_magic(...)."""
    whole = tree(text) if "get_ipython" in text else None
    if whole is None:
        return text, ()
    lines = text.split("\n")
    taken: list[tuple[int, str]] = []
    before = 0  # the last line of the statements so far
    for node, following in itertools.zip_longest(whole.body, whole.body[1:]):
        first, last = node.lineno - 1, node.end_lineno or node.lineno
        alone = before <= first and (following is None or following.lineno > last)
        before = last
        if alone and _asks_shell(node):
            code = _timed(node)
            if code is None:
                taken.append((node.lineno, lines[first].strip()))
            instead = "pass" if code is None else f"exec({code!r})"
            lines[first:last] = [instead, *[""] * (last - first - 1)]
    return "\n".join(lines), tuple(taken)


def _asks_shell(node: ast.stmt) -> bool:
    inner = node.value if isinstance(node, ast.Expr) else None
    while isinstance(inner, ast.Attribute | ast.Call):
        inner = inner.value if isinstance(inner, ast.Attribute) else inner.func
    return isinstance(inner, ast.Name) and inner.id == "get_ipython"


def _timed(node: ast.stmt) -> str | None:
    """The Python in get_ipython().run_cell_magic("time", "", ...), as an exported notebook has it."""
    match node:
        case ast.Expr(
            value=ast.Call(
                func=ast.Attribute(attr="run_cell_magic"),
                args=[ast.Constant(value=str() as name), _, ast.Constant(value=str() as code)],
            )
        ) if name in PYTHON_MAGICS:
            return code
    return None


_PIECE = re.compile(
    # A string that is not closed ends with its line: looking for its end at each quote takes for ever.
    r"""(?P<comment>\#[^\n]*)|(?P<triple>'{3}|\"{3})|(?P<string>'(?:\\.|[^'\\\n])*'?|"(?:\\.|[^"\\\n])*"?)"""
    r"""|(?P<open>[(\[{])|(?P<close>[)\]}])|(?P<joined>\\\n)|(?P<end>\n)|(?P<other>[^\#'\"()\[\]{}\\\n]+|.)""",
    re.DOTALL | re.VERBOSE,
)


def _statement_lines(text: str) -> Iterator[int]:
    """Indices of the lines on which a statement can begin: none inside a string or a bracket."""
    line = depth = position = 0
    yield 0
    while position < len(text):
        piece = _PIECE.match(text, position)
        if piece is None:
            return
        position = piece.end()
        kind, found = piece.lastgroup, piece.group()
        if kind == "triple":
            closed = text.find(found, position)
            stop = len(text) if closed < 0 else closed + 3
            line += text.count("\n", position, stop)
            position = stop
        elif kind == "string":
            line += found.count("\n")  # escaped ones
        elif kind == "open":
            depth += 1
        elif kind == "close":
            depth = max(0, depth - 1)
        elif kind == "joined":
            line += 1
        elif kind == "end":
            line += 1
            if depth == 0:
                yield line


def tree(text: str | bytes) -> ast.Module | None:
    """A text's syntax tree; None if it is no Python."""
    try:
        return ast.Module(parsed(text), [])
    except UNREADABLE:
        return None
