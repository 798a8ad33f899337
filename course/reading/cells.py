"""Runs the cells of one lesson in a separate process, at the best protection this machine has.

A cell needs the names from the cells before it: those that have not run in their present form run first.
After a cell was interrupted, or its process died, the next run starts a new process and does the same there.
"""

import ast
import io
import sys
import threading
import zipfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from course.catalog.pack import zip_entry
from course.isolation.failures import IsolationError, StudentFailure
from course.isolation.inside import statements
from course.isolation.inside.wire import CUT
from course.isolation.levels import Deadline, Spawner
from course.isolation.probe import open_spawner
from course.isolation.session import Connection, LoadRefusedError
from course.printable import printable
from course.reading.parts import Cell

# ---
# The modules of the course that a lesson's cells import, as one archive for the process they run in.
#
# A protected process sees nothing of this installation. So it is handed what the cells name, with what that
# imports in turn, found by reading and never by importing; where something there opens files of the package,
# the data beside those modules too. Packages beyond a few light ones (matplotlib, which the figures draw
# with) are not part of it: their names import, and using them says that nothing is drawn there.


_ROOT = Path(__file__).resolve().parents[2]
_COURSE = "course"
#: Packages that a cell's process may have as they are, quick to load, each with what it needs itself.
_LIGHT = {"numpy": (), "msgspec": (), "pymunk": ("cffi",)}
_DATA = frozenset({".json", ".toml"})


@dataclass(frozen=True, slots=True)
class Textbook:
    """An archive of modules.

    Attributes:
        data: a zip file, to be put on the path.
        packages: installed packages that they need.
        absent: packages that they import and do without.
    """

    data: bytes
    packages: tuple[str, ...]
    absent: tuple[str, ...]


def textbook_for(sources: Iterable[str]) -> Textbook:
    """The course's modules that these pieces of code import. Code that does not parse imports none."""
    texts = list(sources)
    files: dict[str, bytes] = {}
    others: set[str] = set()
    pending = [name for text in texts for name in _imports(text)]
    while pending:
        name = pending.pop()
        top = name.partition(".")[0]
        if top != _COURSE:
            if top not in sys.stdlib_module_names:
                others.add(top)
            continue
        for path in _files_of(name):
            inside = path.relative_to(_ROOT).as_posix()
            if inside not in files:
                files[inside] = path.read_bytes()
                pending += _imports(files[inside].decode("utf-8"))
    if any("importlib.resources" in text for text in (*texts, *(file.decode() for file in files.values()))):
        for folder in {Path(name).parent for name in files}:
            for path in sorted((_ROOT / folder).iterdir()):
                if path.suffix in _DATA:
                    files[path.relative_to(_ROOT).as_posix()] = path.read_bytes()
    files.setdefault("course/__init__.py", b"")
    light = {"numpy", *others} & _LIGHT.keys()
    packages = sorted(light.union(*(_LIGHT[name] for name in light)))
    absent = sorted(others - _LIGHT.keys())
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name, data in sorted(files.items()):
            archive.writestr(zip_entry(name), data, zipfile.ZIP_DEFLATED)
    return Textbook(out.getvalue(), tuple(packages), tuple(absent))


def _files_of(name: str) -> Iterator[Path]:
    """The file of a module, and those of the packages it is in; nothing for a name inside a module."""
    parts = name.split(".")
    for length in range(1, len(parts) + 1):
        base = _ROOT.joinpath(*parts[:length])
        for path in (base / "__init__.py", base.with_suffix(".py")):
            if path.is_file():
                yield path
                break


def _imports(source: str) -> Iterator[str]:
    """Every module that code imports when it is loaded; ``from a import b`` may mean the module a.b."""
    tree = statements.tree(source)
    pending: list[ast.AST] = [tree] if tree else []
    while pending:
        node = pending.pop()
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
        elif not (isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test)):
            pending += ast.iter_child_nodes(node)


#: A lesson's own cell takes under two seconds; one that was changed may take this long before it is stopped.
DEADLINE_S = 60.0
_MAIN = "lesson.py"
#: The error of an interrupted cell.
STOPPED = "Stopped."

#: The program around the cells. It prints their output at once, so that a stopped cell shows how far it got,
#: and returns the traceback of the cell's own lines.
_BESIDE = '''\
import importlib.machinery, io, linecache, os, sys, traceback

ABSENT = {absent!r}
sys.path.insert(0, os.path.abspath("course.zip"))


class _Absent:
    """A package that is not here; its names import, using them says so."""

    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in ABSENT:
            return importlib.machinery.ModuleSpec(name, self, is_package=True)

    def create_module(self, spec):
        return None

    def exec_module(self, module):
        module.__getattr__ = lambda name: _missing(module.__name__, name)


def _missing(module, name):
    if name.startswith("__"):
        raise AttributeError(name)

    def use(*args, **kwargs):
        raise ImportError(f"{{module}}.{{name}} is not at hand where cells run: nothing is drawn there")

    return use


sys.meta_path.insert(1, _Absent())
namespace = {{"__name__": "lesson"}}


def run(source, name):
    lines = source.splitlines(keepends=True)
    linecache.cache[name] = (len(source), None, lines, name)
    sys.stdout = type(sys.stdout)(1)  # each cell may print as much as it is allowed
    error = ""
    try:
        exec(compile(source, name, "exec", dont_inherit=True), namespace)
    except BaseException as raised:
        told = traceback.TracebackException.from_exception(raised, limit=40)
        told.stack = traceback.StackSummary.from_list(
            [frame for frame in told.stack if not frame.filename.endswith({main!r})]
        )
        error = "".join(told.format()).rstrip()
    return error
'''


@dataclass(frozen=True, slots=True)
class CellOutput:
    """The result of running a cell.

    Attributes:
        printed: everything it printed, without the last line's end.
        error: the traceback, or why it was stopped; empty if it ended by itself.
        seconds: how long it took, earlier cells not counted.
        earlier: numbers of the shown cells that had to run first.
    """

    printed: str
    error: str
    seconds: float
    earlier: tuple[int, ...] = ()


class CellRunner:
    """Runs the cells of a lesson, one at a time. To be used from one thread; ``interrupt`` from any.

    Args:
        cells: all cells of the lesson, hidden ones included.
        source: gives a cell's present code.
    """

    def __init__(self, cells: Sequence[Cell], source: Callable[[Cell], str]) -> None:
        self._cells = cells
        self._source = source
        self._spawner: Spawner | None = None
        self._packages: tuple[str, ...] = ()
        self._imported: frozenset[str] = frozenset()
        self._connection: Connection | None = None
        self._ran: dict[str, str] = {}  # key of a cell: the code of it that ran in this process
        self._printed = 0
        self._interrupted = threading.Event()

    def prepare(self) -> None:
        """Start the process, so that the first run need not wait for it.

        Raises:
            IsolationError: it cannot be started.
        """
        # As long as these are the same, so is the textbook.
        wanted = frozenset(name for cell in self._cells for name in _imports(self._source(cell)))
        if self._connection is not None and self._connection.alive:
            if wanted == self._imported:
                return
            self.forget()  # a cell was changed to import more than this process was given
        self._imported = wanted
        self._ran.clear()
        self._printed = 0
        book = textbook_for(self._source(cell) for cell in self._cells)
        if self._spawner is not None and self._packages != book.packages:
            self._spawner.close()
            self._spawner = None
        if self._spawner is None:
            self._spawner, self._packages = open_spawner(book.packages), book.packages
        beside = _BESIDE.format(absent=book.absent, main=_MAIN).encode()
        files = {_MAIN: beside, "course.py": b"", "course.zip": book.data}
        files |= {f"{name}.py": b"" for name in book.absent}
        try:
            self._connection = Connection(self._spawner, files, _MAIN, Deadline(DEADLINE_S))
        except LoadRefusedError as refused:
            raise IsolationError(f"the cells' process did not load: {refused.failure}") from None

    def run(self, cell: Cell) -> CellOutput:
        """Run a cell, and before it what it needs.

        Raises:
            IsolationError: there is no process to run it in.
        """
        self._interrupted.clear()
        self.prepare()
        earlier: list[int] = []
        for before in self._needed(cell):
            gave = self._run_one(before)
            if not before.hidden:
                earlier.append(before.number)
            if gave.error:
                which = f"Cell {before.number}, which this one needs," if before.number else "A hidden cell"
                return CellOutput("", f"{which} did not run.\n{gave.error}", gave.seconds, tuple(earlier))
        gave = self._run_one(cell)
        if gave.printed.endswith(CUT.rstrip()):
            self.forget()  # so that the output of the next cell is kept again
        return CellOutput(gave.printed, gave.error, gave.seconds, tuple(earlier))

    def interrupt(self) -> None:
        """Stop the cell that is running; what it printed so far is kept."""
        self._interrupted.set()
        if (connection := self._connection) is not None:
            connection.deadline.end()

    def forget(self) -> None:
        """Restart the process at the next run, for example after changes to modules that a cell imports."""
        if self._connection is not None:
            self._connection.close()
            self._connection = None

    def close(self) -> None:
        self.forget()
        if self._spawner is not None:
            self._spawner.close()
            self._spawner = None

    def _needed(self, cell: Cell) -> list[Cell]:
        """The earlier cells to run first: shown ones that have not run as they are, and with them whatever
        hidden ones define names that are used."""
        needed: list[Cell] = []
        used = _names(self._source(cell))[0]
        for before in sorted(self._cells, key=lambda one: one.order, reverse=True):
            if before.order >= cell.order or self._ran.get(before.key) == self._source(before):
                continue
            uses, binds = _names(self._source(before))
            if before.hidden and not binds & used:
                continue
            needed.append(before)
            used |= uses
        return needed[::-1]

    def _run_one(self, cell: Cell) -> CellOutput:
        connection, source = self._connection, self._source(cell)
        if connection is None or not connection.alive:
            raise IsolationError("the cells' process has ended")
        name = f"cell {cell.number}" if cell.number else "a hidden cell"
        start = perf_counter()
        connection.deadline = Deadline(DEADLINE_S)
        if self._interrupted.is_set():
            connection.deadline.end()
        try:
            error = printable(str(connection.call("run", source, name)))
        except StudentFailure as failure:
            error = self._why(failure)
        seconds = perf_counter() - start
        whole = connection.output()
        printed, self._printed = whole[self._printed :], len(whole)
        self._ran.pop(cell.key, None)
        if not error:
            self._ran[cell.key] = source
        return CellOutput(printed.rstrip("\n"), error, seconds)

    def _why(self, failure: StudentFailure) -> str:
        if self._interrupted.is_set():
            return STOPPED
        if failure.kind == "timeout":
            return f"Stopped after {DEADLINE_S:.0f} s."
        how = printable(failure.message)
        if failure.kind == "crash":
            return f"The cell's {how.removeprefix('its ')}."
        return f"The cell's process ended: {how}."


def _names(source: str) -> tuple[set[str], set[str]]:
    """The names that code reads, and those it binds; empty for code that does not parse."""
    tree = statements.tree(source)
    uses: set[str] = set()
    binds: set[str] = set()
    for node in ast.walk(tree) if tree else ():
        if isinstance(node, ast.Name):
            (uses if isinstance(node.ctx, ast.Load) else binds).add(node.id)
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            binds.add(node.name)
        elif isinstance(node, ast.Import | ast.ImportFrom):
            binds |= {(alias.asname or alias.name).partition(".")[0] for alias in node.names}
    return uses, binds
