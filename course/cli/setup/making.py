"""``course init``: a workspace, and files that bring the checks to an editor or GitHub.

Nothing is overwritten."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from course.catalog.models import CourseRef
from course.cli.frame.here import cwd, load_catalog
from course.cli.frame.replies import NextStep, WrittenFile
from course.cli.frame.terminal.console import Console, current
from course.cli.setup.replies import Init
from course.cli.setup.surroundings import chosen_kinds, complete_kinds, usable, write_surroundings
from course.errors import CourseError, NotFoundError, UsageError
from course.progress.workspace import MARKER, Workspace

if TYPE_CHECKING:
    from course.catalog.load import Catalog

__all__ = ["init"]


def init(
    folder: Annotated[
        Path | None, typer.Argument(metavar="DIR", help="The folder; the current one if left out.")
    ] = None,
    surroundings: Annotated[
        str | None,
        typer.Option(
            "--with",
            metavar="WHAT",
            help="Also write github, devcontainer, vscode: a workflow, a container, tasks; join by commas.",
            autocompletion=complete_kinds,
        ),
    ] = None,
    requirement: Annotated[
        str | None,
        typer.Option(
            "--requirement",
            metavar="REQUIREMENT",
            help="For --with: where pip gets the course from; the wheel in wheels/ if left out.",
        ),
    ] = None,
) -> int:
    """Make a workspace.

    Creates the folder if necessary, and course.toml in it. Existing files are not changed; if --with replaces
    one, a copy is kept.
    """

    console, catalog = current(), load_catalog()
    kinds = chosen_kinds(surroundings) if surroundings is not None else ()
    requirement = usable(requirement)
    here = cwd()
    root = (here / (folder or Path()).expanduser()).resolve()
    created = not (root / MARKER).is_file()
    if created:
        _refuse_odd_places(root, catalog)
        workspace = Workspace.create(root, catalog.course_id, catalog.version)
        console.line(f"Made a workspace for {catalog.title} in {root}.")
    else:
        workspace = Workspace.read(root)
        console.line(f"{root} is a workspace already" + ("." if kinds else "; nothing was changed."))
    written = write_surroundings(root, kinds, requirement)
    _say_written(console, written)
    if "github" in kinds and not (root / ".git").exists():
        console.note("GitHub reads workflows in the top folder of a repository only.")
    step = "course go"
    if root != here:
        console.note(f"Go there: cd {_quoted(root, here)}")
    console.note(f"Then: {step}" if root != here else f"Next: {step}")
    console.emit(
        Init(
            workspace=str(workspace.root),
            created=created,
            course=CourseRef(id=workspace.course_id, version=workspace.version),
            next=NextStep(step),
            files=tuple(written),
        )
    )
    return 0


def _say_written(console: Console, written: list[WrittenFile]) -> None:
    for file in written:
        if file.backup:
            console.line(f"There was another {file.path}; it is kept at {file.backup.backup}.")
        console.line(f"Wrote {file.path}")


def _refuse_odd_places(root: Path, catalog: Catalog) -> None:
    """A workspace inside another one, or in the course's own folder, would mix up two people's files."""
    content = catalog.content
    if root in (content.root, content.exercises, content.lessons) or content.exercises in root.parents:
        raise UsageError(
            f"{root} is where the course itself lies.",
            help="Name a folder of your own: `course init my-course`.",
            code="inside_course",
        )
    if root.exists() and not root.is_dir():
        raise UsageError(f"{root} is a file.", help="Name a folder.", code="exists")
    outer = _enclosing(root)
    if outer is not None:
        raise UsageError(
            f"{root} lies inside the workspace {outer.root}.",
            help="Use that one, or make yours somewhere else.",
            code="nested_workspace",
        )


def _enclosing(root: Path) -> Workspace | None:
    try:
        return Workspace.find(root.parent)
    except NotFoundError:
        return None
    except CourseError as error:
        raise UsageError(error.message, help=error.help, code="nested_workspace") from error


def _quoted(root: Path, here: Path) -> str:
    """A path for a shell: relative where that is shorter, quoted where it must be."""
    try:
        text = str(root.relative_to(here))
    except ValueError:
        text = str(root)
    return f'"{text}"' if any(char.isspace() for char in text) else text
