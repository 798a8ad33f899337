"""Checks, collected once by pytest and run again for every submission.

Only this module uses pytest's internals. ``pytest.main`` for each submission would cost about 30 ms, and more
with time; collecting once and running the items again costs about half a millisecond each. A check that takes
nothing but the fixtures of this module is a function to be called, and that costs nothing; one with fixtures,
parameters, marks or a class of its author's goes through pytest. A contract test covers the calls made here,
and the project's metadata caps pytest at the majors it was run with.

Checks are ordinary pytest functions. What pytest would print about them is of no use here, so the report
hook keeps the exception and builds no traceback text; the verdict is made from what the exception says.
"""

from __future__ import annotations

import ast
import contextlib
import functools
import importlib.util
import inspect
import os
import re
import sys
import zlib
from collections.abc import Generator, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from course.catalog.locate import content
from course.errors import ContentError
from course.scoring.explain.story import Words, read_table, table_path, words_in
from course.scoring.failures import opened_at, reason_of
from course.scoring.remote import RemoteSubmission
from course.scoring.verdict import Visibility

# ---
# Shared by the checks of an exercise, from the course in use: modules, known answers, words.


def companion(exercise_id: str, module: str) -> ModuleType:
    """A module that public and hidden checks of an exercise share: ``exercises/<id>/checking/<module>.py``.

    What the course itself asks for, ``questions`` and ``report``, lies beside the checks. It is loaded by
    path from the course in use, once per process.

    Raises:
        FileNotFoundError: the exercise has no such file.
    """
    return _load(companion_path(exercise_id, module), f"{exercise_id}_{module}")


def companion_path(exercise_id: str, module: str) -> Path:
    """The file of a companion, whether or not it is there."""
    folder = content().exercise_folder(exercise_id)
    inside = folder / "checking" / f"{module}.py"
    return inside if inside.is_file() else folder / inside.name


def reference(exercise_id: str, module: str) -> ModuleType | None:
    """A module that answers for the student, ``solutions/<id>/<module>.py``; None at home, which has none."""
    folder = content().solution_folder(exercise_id)
    if folder is None:
        return None
    return _load(folder / f"{module}.py", f"{exercise_id}_{module}_right")


def known_answers(exercise_id: str, check: str) -> list[Any]:
    """The answers that a public check with fixed inputs expects where there is no reference, in its order."""
    folder = content().exercise_folder(exercise_id)
    table = read_table(folder)
    if table is None:
        raise ContentError(table_path(folder), None, "it is missing.", help="`course author build`")
    return [_known(value) for value in table.answers[check]]


def _known(value: Any) -> Any:
    """A known answer as a reference gives it: arrays and tuples are marked as such, infinities are text."""
    if isinstance(value, dict):
        items = {key: _known(item) for key, item in value.items()}
        if items.keys() == {"array"}:
            return np.array(items["array"])
        return tuple(items["tuple"]) if items.keys() == {"tuple"} else items
    if isinstance(value, list):
        return [_known(item) for item in value]
    return float(value) if value in ("inf", "-inf") else value


def words(exercise_id: str) -> Words:
    """The diagnoses of an exercise by their codes."""
    return words_in(content().exercise_folder(exercise_id))


def questions_path(exercise_id: str) -> Path:
    """The file with the calls that tell wrong programs apart: ``questions.py``, of a warm-up its checks."""
    path = companion_path(exercise_id, "questions")
    return path if path.is_file() else companion_path(exercise_id, "checks")


def questions_of(exercise_id: str) -> ModuleType | None:
    """That file, imported; None if it asks for nothing."""
    from _pytest.mark.structures import MARK_GEN

    path = questions_path(exercise_id)
    around, MARK_GEN._config = MARK_GEN._config, None  # the marks of checks are not another pytest's
    try:
        found = companion(exercise_id, path.stem)
    finally:
        MARK_GEN._config = around
    return found if hasattr(found, "QUESTIONS") else None


def sibling(file: str, module: str) -> ModuleType:
    """A module beside a file of checks: ``sibling(__file__, "bundles")``.

    Raises:
        FileNotFoundError: there is no such file.
    """
    path = Path(file).resolve()
    return _load(path.with_name(f"{module}.py"), f"{path.parent.name}_{module}")


def not_importable(error: BaseException, file: Path) -> ContentError:
    """The fault of a course's file that raises while a check file is imported.

    Args:
        file: the one to name where the error itself names none of the course's.
    """
    while isinstance(error, pytest.Collector.CollectError) and error.__cause__ is not None:
        error = error.__cause__
    if isinstance(error, ContentError):
        return error
    problem = f"it cannot be imported ({reason_of(error)})."
    return ContentError(*opened_at(error, file), problem, help="Correct that line, or what it needs.")


@functools.cache
def _load(path: Path, label: str) -> ModuleType:
    if not path.is_file():
        raise FileNotFoundError(path)
    # Two courses may be in use in one process (tests do that), so the name tells them apart.
    name = f"course_companion_{label}_{abs(hash(path)):x}".replace("-", "_")
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise FileNotFoundError(path)
    loaded = importlib.util.module_from_spec(spec)
    sys.modules[name] = loaded  # dataclasses look their own module up
    spec.loader.exec_module(loaded)
    return loaded


# Plugins that write files, read the user's settings, or cost time on every check.
_BLOCKED = (
    "cacheprovider", "capture", "doctest", "faulthandler", "junitxml", "logging", "nose", "pastebin",
    "setuponly", "setupplan", "stepwise", "terminal", "threadexception", "unraisableexception", "warnings",
)  # fmt: skip
#: An author's note after a title. It is true at home only, so every page shows the points themselves.
_HOME_ONLY = re.compile(r" \(no points here[^)]*\)$")


@dataclass(frozen=True)
class Check:
    """One check, as its function declares it.

    Attributes:
        id: the function's name without ``test_``.
        title: first line of its docstring, without a note on points.
        requires: ids of the checks that must have passed before.
    """

    id: str
    title: str
    task: str
    points: float
    visibility: Visibility
    requires: tuple[str, ...]


class CollectedChecks:
    """The checks of one exercise.

    Args:
        files: check files with the visibility of what is in them, public first.
        draws: public checks draw their inputs too, as in a grading run.
    """

    def __init__(self, files: list[tuple[Path, Visibility]], *, draws: bool = False) -> None:
        self._plugin = CheckPlugin(draws=draws)
        self._session, items = _collect([path for path, _ in files], self._plugin)
        visibility = {path.resolve(): kind for path, kind in files}
        self._items: dict[str, pytest.Item] = {}
        self._plain: dict[str, tuple[str, ...]] = {}  # of checks that can be called: the fixtures they take
        self._checks: list[Check] = []
        for item in items:
            check = _check_of(item, visibility[item.path.resolve()])
            if check.id in self._items:
                raise _fault(item, f"two checks have the id {check.id!r}", "Rename one of the functions.")
            self._items[check.id] = item
            taken = _plainly_taken(item)
            if taken is not None:
                self._plain[check.id] = taken
            self._checks.append(check)
        for check in self._checks:
            for required in check.requires:
                if required not in self._items:
                    problem = f"it requires {required!r}, which is not a check"
                    raise _fault(self._items[check.id], problem, "Name an existing check.")

    @property
    def checks(self) -> tuple[Check, ...]:
        """In the order they are defined, public ones first."""
        return tuple(self._checks)

    def in_order(self) -> list[Check]:
        """The checks in the order of definition, except that each comes after those it requires."""
        ordered: list[Check] = []
        by_id = {check.id: check for check in self._checks}

        def place(check: Check, above: tuple[str, ...]) -> None:
            if check in ordered or check.id in above:
                return
            for required in check.requires:
                place(by_id[required], (*above, check.id))
            ordered.append(check)

        for check in self._checks:
            place(check, ())
        return ordered

    def run(self, check: Check, submission: RemoteSubmission) -> BaseException | None:
        """How the check ends for this submission: None if it passes, else what it raised."""
        item: Any = self._items[check.id]
        self._plugin.submission = submission
        try:
            with np.errstate(all="ignore"):  # a check may compute with whatever a submission returned
                if check.id in self._plain:
                    try:
                        if item.obj(**self._plugin.fixtures(item.name, self._plain[check.id])) is None:
                            return None
                    except (KeyboardInterrupt, pytest.exit.Exception):  # ends pytest's own protocol, too
                        raise
                    except BaseException as error:  # noqa: BLE001 - whatever a check raises is how it ends
                        return error
                # What returns something may be no test at all: pytest knows.
                return self._through_pytest(item)
        finally:
            self._plugin.submission = None

    def _through_pytest(self, item: pytest.Item) -> BaseException | None:
        self._plugin.outcome = None
        self._plugin.called = False
        _run_item(item)
        outcome, self._plugin.outcome = self._plugin.outcome, None
        if outcome is None and not self._plugin.called:
            return RuntimeError("pytest did not call it")  # no news is not a pass
        return outcome

    def close(self) -> None:
        """Undo the registrations made while collecting."""
        config = self._session.config
        with contextlib.suppress(Exception):
            config._ensure_unconfigure()


def _run_item(item: pytest.Item) -> None:
    """pytest's own protocol for one item: set up, call, tear down, with a fresh set of fixtures."""
    from _pytest.runner import runtestprotocol

    runtestprotocol(item, log=False, nextitem=None)


def _plainly_taken(item: Any) -> tuple[str, ...] | None:
    """The fixtures that a check takes if all that pytest would do is to call it with them, else None.

    Whatever an author can put around a check shows in one of these: fixtures of theirs, also those that are
    used without being named, as ``setup_module`` is; parameters; marks; classes; code in an ``__init__.py``.
    """
    if type(item) is not pytest.Function or item.cls is not None or hasattr(item, "callspec"):
        return None
    info = item._fixtureinfo
    known = {*OWN, "request"}  # ``rng`` asks for it
    if not known.issuperset(item.fixturenames) or not OWN.issuperset(info.argnames):
        return None
    if any(len(found) > 1 for found in info.name2fixturedefs.values()):
        return None
    if any(mark.name not in _MARKS for mark in item.iter_markers()) or inspect.iscoroutinefunction(item.obj):
        return None
    packages = (node.path / "__init__.py" for node in item.listchain() if isinstance(node, pytest.Package))
    return None if any(map(_does_something, packages)) else tuple(info.argnames)


def _does_something(path: Path) -> bool:
    """Whether a file has more in it than a docstring: ``setup_module`` of a package, perhaps."""
    return not all(
        isinstance(part, ast.Expr) and isinstance(part.value, ast.Constant)
        for part in ast.parse(path.read_bytes()).body
    )


def _collect(paths: list[Path], plugin: CheckPlugin) -> tuple[pytest.Session, list[pytest.Item]]:
    """Import the check files hermetically: no conftest, no ini, no plugin and no setting of the user's."""
    from _pytest.config import _prepareconfig
    from _pytest.mark.structures import MARK_GEN

    ini = Path(__file__).with_name("checks.ini")
    arguments = [
        "-c", str(ini), f"--rootdir={ini.parent}", "--noconftest", "--import-mode=importlib",
        "--assert=plain", "--strict-markers", *[f"-pno:{name}" for name in _BLOCKED], *map(str, paths),
    ]  # fmt: skip
    with _clean_environment():
        config = _prepareconfig(arguments, [plugin])
        # The session's own start-up hooks are left out: they print, and check the working folder.
        session = pytest.Session.from_config(config)
        config.hook.pytest_sessionstart(session=session)
        # Marks are checked against this plugin's list, even where another pytest runs around this one.
        plugin.pytest_configure(config)
        around, MARK_GEN._config = MARK_GEN._config, config
        try:
            items = session.perform_collect()
        except pytest.UsageError as error:
            raise ContentError(paths[0], None, str(error), help="Restore the file.") from None
        except (Exception, SystemExit) as error:  # noqa: BLE001 - whatever a file does that is imported
            plugin.refused = error
        finally:
            MARK_GEN._config = around
    if plugin.refused is not None:
        raise not_importable(plugin.refused, paths[0])
    if not items:
        raise ContentError(paths[0], None, "there is no check in it", help="Name its functions test_...")
    found = [item for item in items if isinstance(item, pytest.Item)]
    for item in found:
        # pytest would answer a later import of this path from sys.modules, even of a file that changed.
        module: Any = getattr(item, "module", None)
        sys.modules.pop(getattr(module, "__name__", ""), None)
    return session, found


@contextlib.contextmanager
def _clean_environment() -> Iterator[None]:
    """Without PYTEST_* and without writing bytecode beside the checks, for as long as collecting takes."""
    saved = dict(os.environ)
    bytecode = sys.dont_write_bytecode
    for name in list(os.environ):
        if name.startswith("PYTEST_"):
            del os.environ[name]
    os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
    sys.dont_write_bytecode = True
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(saved)
        sys.dont_write_bytecode = bytecode


def _check_of(item: pytest.Item, visibility: Visibility) -> Check:
    function: Any = getattr(item, "function", None)
    title = (getattr(function, "__doc__", None) or "").strip().splitlines()
    if not title:
        raise _fault(item, "it has no docstring", "Give it one: its first line is the check's title.")
    marks = {name: item.get_closest_marker(name) for name in ("task", "points", "requires")}
    if marks["task"] is None or marks["points"] is None:
        raise _fault(item, "it lacks a mark", "Mark it @pytest.mark.task(...) and @pytest.mark.points(...).")
    return Check(
        id=item.name.removeprefix("test_"),
        title=_HOME_ONLY.sub("", title[0].strip()),
        task=str(marks["task"].args[0]),
        points=float(marks["points"].args[0]),
        visibility=visibility,
        requires=tuple(marks["requires"].args) if marks["requires"] else (),
    )


def _fault(item: pytest.Item, problem: str, advice: str) -> ContentError:
    return ContentError(item.path, (item.location[1] or 0) + 1, f"check {item.name}: {problem}", help=advice)


MARKERS = (
    "points(n): what the check is worth",
    "task(name): the function whose points these are",
    "requires(*checks): skipped unless these checks passed",
)
_MARKS = frozenset(marker.partition("(")[0] for marker in MARKERS)
#: The fixtures that every check may take.
OWN = frozenset({"submission", "rng", "draw"})


class CheckPlugin:
    """Passes the current submission to the checks and records how each check ended."""

    def __init__(self, *, draws: bool = False) -> None:
        self.draws = draws
        self.submission: RemoteSubmission | None = None
        self.outcome: BaseException | None = None
        self.called = False
        self.refused: BaseException | None = None  # why a file could not be collected

    def pytest_configure(self, config: pytest.Config) -> None:
        for marker in MARKERS:
            config.addinivalue_line("markers", marker)

    @pytest.hookimpl(wrapper=True)
    def pytest_make_collect_report(self) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
        report = yield
        call: pytest.CallInfo[Any] | None = getattr(report, "call", None)
        if report.failed and call is not None and call.excinfo is not None and self.refused is None:
            self.refused = call.excinfo.value
        return report

    def fixtures(self, name: str, wanted: tuple[str, ...]) -> dict[str, Any]:
        """Fixtures of ``OWN`` for the check function of that name."""
        made: dict[str, Any] = {"submission": self.submission}
        if "rng" in wanted or (self.draws and "draw" in wanted):
            assert self.submission is not None
            made["rng"] = np.random.default_rng([self.submission.seed, zlib.crc32(name.encode())])
        made["draw"] = made.get("rng") if self.draws else None
        return {fixture: made[fixture] for fixture in wanted}

    @pytest.fixture(name="submission")
    def _submission(self) -> Any:
        return self.submission

    @pytest.fixture
    def rng(self, request: pytest.FixtureRequest) -> np.random.Generator:
        """Random numbers of this check in this grading run: the same again in a regrade."""
        numbers: np.random.Generator = self.fixtures(request.node.name, ("rng",))["rng"]
        return numbers

    @pytest.fixture
    def draw(self, rng: np.random.Generator) -> np.random.Generator | None:
        """``rng`` in a grading run, where public checks draw their inputs too; None at home."""
        return rng if self.draws else None

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_makereport(self, item: pytest.Item, call: pytest.CallInfo[None]) -> pytest.TestReport:
        if call.excinfo is not None and self.outcome is None:
            self.outcome = call.excinfo.value
        self.called = self.called or call.when == "call"
        return pytest.TestReport(
            item.nodeid,
            item.location,
            {},
            "passed" if call.excinfo is None else "failed",
            None,
            call.when if call.when != "collect" else "call",
            duration=call.duration,
        )
