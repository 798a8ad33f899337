"""``course doctor``: what works on this machine, what is missing and the command that installs it."""

from __future__ import annotations

import importlib.metadata
import os
import platform
import sys
from typing import TYPE_CHECKING, Annotated

import typer

from course.cli.frame.here import find_workspace, load_catalog
from course.cli.frame.terminal.console import Console, current
from course.cli.setup.replies import Doctor, Fix, Package
from course.errors import CourseError, MissingCapabilityError
from course.extras import requirements

if TYPE_CHECKING:
    from collections.abc import Iterable

    from course.catalog.load import Catalog

__all__ = ["doctor", "packages", "protection", "terminal"]

#: Parts that no student needs.
_NOT_FOR_USERS = {"dev", "all"}
_LEVELS = {
    "L3": "your code runs in a locked sandbox of its own: no files, no network, no processes",
    "L2": "your code runs locked down: no files beyond Python's own, no network, no processes",
    "L1": "your code runs in a process of its own with deadlines; files and network are not protected",
}


def doctor(
    repair: Annotated[
        bool, typer.Option("--repair", help="Set a damaged progress record aside and start a new one.")
    ] = False,
) -> int:
    """Say what works on this machine.

    It also says what is missing, with the command that installs it. Exit code 4 if the course cannot work
    without a missing part.
    """

    console = current()
    catalog = load_catalog()
    found = tuple(packages())
    fixes = _missing(found)
    workspace, repaired, trouble = _workspace(repair=repair)
    level, causes, advice = protection()
    kind = "checkout (instructor's)" if catalog.content.is_checkout else "wheel (student's)"
    shape = terminal(console)
    complete = not any(item.group == "" and not item.ok for item in found) and not trouble
    _show_basics(console, catalog, kind)
    _show_packages(console, found)
    _show_protection(console, level, causes, advice)
    console.item(
        "Terminal", "; ".join(f"{name} {value}" for name, value in shape.items()), indent=0, width=_WIDTH
    )
    console.item("Workspace", workspace or "none here", indent=0, width=_WIDTH)
    for line in (repaired, trouble):
        if line:
            console.line(line)
    unserved = tuple(
        f"Optional ({one.group}): {one.unserved}."
        for one in requirements()
        if one.unserved and one.group not in _NOT_FOR_USERS
    )
    for sentence in unserved:
        console.line(sentence)
    for fix in fixes:
        console.line(f"{fix.problem} Install it with: {fix.command}")
    console.line(("Everything the course needs is here." if complete else "Something is missing.", "bold"))
    code = 0 if complete else MissingCapabilityError.exit_code
    console.emit(
        Doctor(
            ok=complete,
            exit_code=code,
            course=catalog.ref,
            python=platform.python_version(),
            platform=platform.platform(),
            installation=kind,
            packages=found,
            protection=level,
            protection_causes=causes,
            protection_advice=advice,
            terminal=shape,
            workspace=workspace,
            repaired=repaired,
            fixes=fixes,
            unserved=unserved,
        )
    )
    return code


_WIDTH = 12


def packages() -> Iterable[Package]:
    """Every requirement of the course that this machine could have, and what is installed for it."""
    for one in requirements():
        if one.group in _NOT_FOR_USERS or not one.applies:
            continue
        try:
            installed = importlib.metadata.version(one.name)
        except importlib.metadata.PackageNotFoundError:
            installed = None
        yield Package(
            name=one.name,
            requirement=one.text,
            installed=installed,
            ok=installed is not None and _satisfies(installed, one.versions),
            group=one.group,
        )


def _satisfies(installed: str, wanted: str) -> bool:
    """Whether the version is in the range; a text that is not a version counts as in it."""
    from packaging.specifiers import SpecifierSet
    from packaging.version import InvalidVersion

    try:
        return SpecifierSet(wanted).contains(installed, prereleases=True)
    except InvalidVersion:
        return True


def _missing(found: Iterable[Package]) -> tuple[Fix, ...]:
    """The commands that install missing parts: one for the base and one for each extra."""
    groups: dict[str, list[Package]] = {}
    for item in found:
        if not item.ok:
            groups.setdefault(item.group, []).append(item)
    fixes = []
    for group, items in groups.items():
        names = ", ".join(item.name for item in items)
        verb = "are" if len(items) > 1 else "is"
        what = (
            f"{names} {verb} missing or too old."
            if not group
            else f"Optional ({group}): {names} {verb} missing."
        )
        command = "pip install " + " ".join(f"'{item.requirement}'" for item in items)
        fixes.append(Fix(problem=what, command=command))
    return tuple(fixes)


def protection() -> tuple[str, tuple[str, ...], tuple[str, ...]]:
    """The level this machine reaches, why it is not higher, and what would raise it."""
    try:
        from course.isolation.probe import probe

        protection = probe()
    except ImportError as error:
        return "unknown", (f"It could not be tried: {error.name} is missing.",), ()
    except CourseError as error:
        return "none", (error.message,), (error.help,) if error.help else ()
    return str(protection.level), tuple(protection.causes), tuple(protection.advice)


def _workspace(*, repair: bool) -> tuple[str | None, str | None, str | None]:
    """The workspace, the repairs in it, and its faults."""
    try:
        here = find_workspace()
    except CourseError as error:
        return None, None, f"{error.message} {error.help}"
    if here is None:
        return None, None, None
    root, store = str(here.workspace.root), here.workspace.store
    repaired = None
    try:
        if repair:
            result = store.repair()
            repaired = (
                "The record of progress is sound; nothing was repaired."
                if result is None
                else f"The damaged record is kept at {here.workspace.shown(result.kept)}; "
                f"{result.carried} events were carried over into a new one."
            )
        store.events()
    except CourseError as error:
        return root, repaired, f"{error.message} {error.help}"
    if not os.access(here.workspace.root, os.W_OK):
        return root, repaired, f"{root} cannot be written; checks run, and nothing is recorded."
    return root, repaired, None


def terminal(console: Console) -> dict[str, str]:
    encoding = getattr(sys.stdout, "encoding", None) or "unknown"
    return {
        "output": "to a terminal" if sys.stdout.isatty() else "to a file or a pipe",
        "columns": str(console.terminal_width),
        "colour": "on" if console.fancy and not os.environ.get("NO_COLOR") else "off",
        "encoding": encoding,
    }


def _show_basics(console: Console, catalog: Catalog, kind: str) -> None:
    course = f"{catalog.title} {catalog.version}, installed as a {kind}"
    console.item("Course", course, indent=0, width=_WIDTH)
    python = f"{platform.python_version()} at {sys.executable}, {platform.platform()}"
    console.item("Python", python, indent=0, width=_WIDTH)


def _show_packages(console: Console, found: Iterable[Package]) -> None:
    names = []
    for item in found:
        if item.group and not item.ok:
            continue
        wanted = "" if item.ok else f" (needs {item.requirement})"
        names.append(f"{item.name} {item.installed or 'MISSING'}{wanted}")
    console.item("Packages", ", ".join(names), indent=0, width=_WIDTH)


def _show_protection(console: Console, level: str, causes: tuple[str, ...], advice: tuple[str, ...]) -> None:
    meaning = _LEVELS.get(level, "")
    console.item("Protection", f"{level}{': ' if meaning else ''}{meaning}", indent=0, width=_WIDTH)
    for sentence in (*causes, *advice):
        console.line(sentence, indent=2)
