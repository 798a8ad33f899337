"""Runs a submission's module, and what of it can be had where all of it cannot.

A file is worth what its functions are worth, whatever stands beside them: what is no Python, and a statement
that raises while the file is loaded, are left out and reported, and the rest is loaded. This runs in the
student's process: what it reports is only a claim.
"""

from __future__ import annotations
import __future__

import ast
import builtins
import importlib.machinery
import itertools
import math
import opcode
import sys
import types
from typing import TYPE_CHECKING, Any

from . import statements

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

# ---
# Imports are limited to the standard library, the submission's own files and packages its exercise declares.
#
# That is no protection by itself: at L3 and L2 the files of other packages cannot be read at all. It gives a
# clear message instead of a bare ModuleNotFoundError, and lets the rest of a file work.

_BINARY = ("add", "sub", "mul", "matmul", "truediv", "floordiv", "mod", "divmod", "pow", "and", "or", "xor")
_UNPACK = opcode.opmap["UNPACK_SEQUENCE"]


class ImportNotDeclaredError(ImportError):
    """A submission imports a package that its exercise does not declare."""


class StandIn(types.ModuleType):
    """A stand-in for a package that a submission may not import, if it imports it at its top level.

    It stands for whatever is imported from there too. While the submission loads, it silently accepts any
    use, so that a plot at the end of a file costs nothing. After that every use raises: only the tasks that
    need the package fail.
    """

    loading = True

    def __init__(self, name: str, allowed: str) -> None:
        super().__init__(name)
        self._allowed = allowed

    def __getattr__(self, name: str) -> StandIn:
        if name.startswith("__"):
            raise AttributeError(name)
        self._use()
        return self

    def __call__(self, *_args: Any, **_kwargs: Any) -> StandIn:
        self._use()
        return self

    __getitem__ = __enter__ = __call__

    def __setitem__(self, _key: Any, _value: Any) -> None:
        self._use()

    def __exit__(self, *_error: object) -> None:
        self._use()

    def __iter__(self) -> Iterator[StandIn]:
        """As many as ``figure, axes = plt.subplots()`` wants; in a loop none."""
        self._use()
        caller = sys._getframe(1)
        operation, argument = caller.f_code.co_code[caller.f_lasti : caller.f_lasti + 2]
        return itertools.repeat(self, argument if operation == _UNPACK else 0)

    def __float__(self) -> float:
        self._use()
        return math.nan

    def __index__(self) -> int:
        self._use()
        return 0

    def _use(self) -> None:
        if not StandIn.loading:
            raise _not_declared(self.__name__.partition(".")[0], self._allowed)


# Operators are looked up on the class, so __getattr__ does not see them: a constant is used by them alone.
for _operator in (
    *(f"__{side}{name}__" for name in _BINARY for side in ("", "r", "i")),
    *("__neg__", "__pos__", "__abs__", "__invert__", "__lt__", "__le__", "__gt__", "__ge__", "__round__"),
    # numpy asks for these two, in its ufuncs and in its functions.
    *("__array_ufunc__", "__array_function__"),
):
    setattr(StandIn, _operator, StandIn.__call__)


def _not_declared(package: str, allowed: str) -> ImportNotDeclaredError:
    return ImportNotDeclaredError(
        f"this exercise does not allow importing {package!r} (allowed: the standard library, {allowed})",
        name=package,
    )


class Imports:
    """Refuses top-level packages that are neither the standard library's nor declared.

    Args:
        allowed: packages, and files of the submission, that may be imported.
        declared: the packages, for the sentence.
    """

    def __init__(self, allowed: frozenset[str], declared: frozenset[str]) -> None:
        self._allowed = allowed
        self._declared = ", ".join(sorted(declared)) or "none"
        self._replaced: set[str] = set()

    def stand_in(self, node: ast.stmt) -> bool:
        """Let a file load although this statement of it imports other packages; whether it may.

        Only an import at the top level: one inside a ``try`` has an alternative, and one in a function
        concerns only that function. Nothing can stand for whatever a star import would bring.
        """
        match node:
            case ast.Import(names=names):
                tops = {alias.name.partition(".")[0] for alias in names}
            case ast.ImportFrom(module=str() as module, names=[ast.alias(name=name), *_], level=0):
                tops = {module.partition(".")[0]} if name != "*" else set()
            case _:
                tops = set()
        new = tops - self._replaced
        self._replaced |= new
        return bool(new)

    def find_spec(self, name: str, _path: Any = None, _target: Any = None) -> Any:
        top = name.partition(".")[0]
        if top in self._allowed or top in sys.stdlib_module_names:
            return None
        if top in self._replaced:
            loader: Any = self
            return importlib.machinery.ModuleSpec(name, loader, is_package=True)
        raise _not_declared(top, self._declared)

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> StandIn:
        return StandIn(spec.name, self._declared)

    def exec_module(self, module: types.ModuleType) -> None:
        """A stand-in has nothing to run."""


_MOST_FAULTS = 20


class Fault:
    """What of a module was left out.

    Attributes:
        stage: "syntax", "import", or "magic" for a line of IPython's; "absent" for an import that something
            stands for.
        error: why.
        line: of the module, on which it begins.
        names: what it would have defined.
    """

    def __init__(self, stage: str, error: BaseException, line: int, names: Collection[str]) -> None:
        self.stage = stage
        self.error = error
        self.line = line
        self.names = list(names)[:100]


class Loading:
    """One module on its way.

    Args:
        source: its text.
        main: its file's name.
        imports: decides what it may import.
        needed: functions; where there are any, only what they need is run. Empty runs all.

    Attributes:
        module: as far as it is loaded.
        faults: what was left out of it, in the order in which that was found.
    """

    def __init__(self, source: str, main: str, imports: Imports, needed: Collection[str] = ()) -> None:
        self._source, self._main, self._imports, self._needed = source, main, imports, needed
        self.faults: list[Fault] = []
        self._refused: list[Fault] = []  # imports for which something stands
        self.module = types.ModuleType(main.removesuffix(".py"))
        self.module.__file__ = main
        self.module.__spec__ = importlib.machinery.ModuleSpec(self.module.__name__, None, origin=main)
        sys.modules[self.module.__name__] = self.module
        # Every notebook has it, and so has code that was tried in one.
        builtins.display = _display  # type: ignore[attr-defined]

    def run(self) -> bool:
        """Run it; whether there is anything in it that could be called.

        Otherwise the first of ``faults`` says why.
        """
        # IPython's lines are taken out, as of a notebook's cell; they are in files exported from one.
        self._source, magics = statements.without_magics(self._source)
        self._source, more = statements.without_shell(self._source)
        out = [Fault("magic", SyntaxError(text[:200]), line, ()) for line, text in (*magics, *more)]
        loads = self._run()
        self.faults += [*out, *self._refused] if loads else []
        return loads

    def _run(self) -> bool:
        try:
            whole = compile(self._source, self._main, "exec", dont_inherit=True)
        except statements.UNREADABLE as error:
            self._go_on(self._readable(error))
        else:
            if self._needed:
                self._go_on(self._chosen(statements.parsed(self._source)))
            else:
                try:
                    exec(whole, self.module.__dict__)
                except BaseException as error:  # noqa: BLE001 - SystemExit is one of many ways to end a file
                    self._go_on(self._after(error))
        if self.faults and not self._has_functions():
            self.faults[:0] = self._refused[:1]
            return False
        return True

    def _has_functions(self) -> bool:
        here = self.module.__name__
        return any(
            isinstance(value, types.FunctionType | type) and getattr(value, "__module__", here) == here
            for value in list(vars(self.module).values())
        )

    def _chosen(self, body: list[ast.stmt]) -> list[ast.stmt]:
        """The statements to run: all, or those that the functions need."""
        if not self._needed:
            return body
        return [body[index] for index in statements.needed(body, self._needed)]

    def _readable(self, error: BaseException) -> list[ast.stmt]:
        """The statements of a module that is no Python as a whole; what is none is a fault."""
        faults: list[Fault] = []
        try:
            body = statements.parsed(self._source)  # and the compiler will say it of one of them
        except SyntaxError:
            found = statements.pieces(self._source)
            lines = self._source.split("\n")
            for piece in found:
                if piece.error is not None:
                    # Python may stumble only behind the mark of a merge, and the mark is what has to go.
                    marked = lines[piece.line - 1].startswith(statements.MERGE)
                    line = piece.line if marked else _said_on(piece.error, piece.line)
                    faults.append(Fault("syntax", piece.error, line, piece.names))
            body = [node for piece in found for node in piece.body]
        except statements.UNREADABLE:
            body = []
        if not any(isinstance(node, ast.FunctionDef | ast.ClassDef) for node in body):
            body, faults = [], [Fault("syntax", error, 0, ())]  # as Python says it of the whole file
        self.faults += faults[:_MOST_FAULTS]
        return self._chosen(body)

    def _after(self, error: BaseException) -> list[ast.stmt]:
        """The statements from the one on that raised; all if that cannot be told."""
        line = _line_in(error, self._main)
        body = statements.parsed(self._source)
        for index, node in enumerate(body):
            if line is not None and _first_line(node) <= line <= (node.end_lineno or node.lineno):
                if self._is_allowed_now(node, error):
                    return body[index:]
                self._fault("import", error, line, statements.bound(node))
                return body[index + 1 :]
        self._fault("import", error, line or 0, ())
        return []

    def _go_on(self, body: list[ast.stmt]) -> None:
        """Run statements one by one; one that raises is a fault and takes no other with it."""
        flags = _future(body)
        for node in body:
            try:
                code = compile(ast.Module([node], []), self._main, "exec", flags, dont_inherit=True)
            except statements.UNREADABLE as error:
                self._fault("syntax", error, _said_on(error, _first_line(node)), statements.bound(node))
                continue
            for _ in range(2):
                try:
                    exec(code, self.module.__dict__)
                except BaseException as error:  # noqa: BLE001 - whatever it raises
                    if self._is_allowed_now(node, error):
                        continue
                    line = _line_in(error, self._main) or _first_line(node)
                    self._fault("import", error, line, statements.bound(node))
                break

    def _is_allowed_now(self, node: ast.stmt, error: BaseException) -> bool:
        """Whether an import that was refused gets something that stands for the package."""
        if not isinstance(error, ImportNotDeclaredError) or not self._imports.stand_in(node):
            return False
        self._refused.append(Fault("absent", error, _first_line(node), list(statements.bound(node))))
        return True

    def _fault(self, stage: str, error: BaseException, line: int, names: Any) -> None:
        if len(self.faults) < _MOST_FAULTS:
            self.faults.append(Fault(stage, error, line, names))


def _said_on(error: BaseException, first: int) -> int:
    """The line on which Python stopped reading a statement that begins on another; it names none for some."""
    line = error.lineno if isinstance(error, SyntaxError) else None
    return max(line or 0, first)


def _first_line(node: ast.stmt) -> int:
    decorators: list[ast.expr] = getattr(node, "decorator_list", [])
    return min([node.lineno, *(one.lineno for one in decorators)])


def _line_in(error: BaseException, main: str) -> int | None:
    """The line of the module's own level at which an exception came out."""
    trace = error.__traceback__
    while trace is not None:
        code = trace.tb_frame.f_code
        if code.co_filename == main and code.co_name == "<module>":
            return trace.tb_lineno
        trace = trace.tb_next
    return None


def _future(body: list[ast.stmt]) -> int:
    """The compiler's flags that a module asks for with ``from __future__``."""
    flags = 0
    for node in body:
        for alias in node.names if isinstance(node, ast.ImportFrom) and node.module == "__future__" else ():
            flags |= int(getattr(getattr(__future__, alias.name, None), "compiler_flag", 0))
    return flags


def _display(*values: object, **_: object) -> None:
    print(*values)  # noqa: T201 - what a student shows is part of what they print
