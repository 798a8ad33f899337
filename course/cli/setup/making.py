"""``course init``: a workspace, and files that bring the checks to an editor or GitHub.

Nothing is overwritten.
"""

import json
import os
import shlex
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

from course.catalog.load import Catalog
from course.catalog.models import CourseRef
from course.cli.frame.console import current
from course.cli.frame.here import catalog_of, cwd, load_catalog, named, write_told
from course.cli.frame.options import argument, option
from course.cli.frame.replies import Envelope, NextStep, WrittenFile
from course.errors import CourseError, NotFoundError, UsageError
from course.progress.workspace import MARKER, Workspace


class Init(Envelope, tag="course.init/1", frozen=True, kw_only=True):
    """``created`` is False where the folder was a workspace already; nothing was changed then."""

    workspace: str
    created: bool
    course: CourseRef
    next: NextStep
    files: tuple[WrittenFile, ...] = ()


# ---
# ``course init --with``: files that bring the checks to where people work, on GitHub and in an editor.
#
# The course comes from the wheel that an instructor hands out, or from a requirement that is named. It is on
# no package index, so no file installs it by its name.


#: Where an instructor's wheel is looked for, from the workspace.
WHEELS = "wheels/*.whl"
_PYTHON = "3.12"

_WORKFLOW = """\
# The public checks on every push; what fails is marked beside its line.
name: course
on: [push, pull_request]
permissions:
  contents: read
jobs:
  check:
    runs-on: ubuntu-latest
    steps:
      - uses: actions/checkout@v4
      - uses: actions/setup-python@v5
        with:
          python-version: "{python}"
      - name: Install the course
        run: python -m pip install {what}
{env}      - name: Check
        run: course check --all --format github
"""
_ENV = """\
        env:
          COURSE: {requirement}
"""


def usable(requirement: str | None) -> str | None:
    """A requirement that pip, a shell and GitHub all read in the same way."""
    if requirement is not None and (
        not requirement.isprintable() or requirement.startswith("-") or "${{" in requirement
    ):
        problem = f"--requirement {requirement[:80]!r}: this is nothing that pip could install."
        fix = "Give what you would write after `pip install`: an address, a path or a name."
        raise UsageError(problem, help=fix, code="bad_requirement")
    return requirement


def chosen_kinds(text: str) -> tuple[str, ...]:
    """The kinds in a list such as "github,vscode"."""
    kinds = tuple(dict.fromkeys(word.strip() for word in text.split(",") if word.strip()))
    unknown = [kind for kind in kinds if kind not in KINDS]
    if unknown or not kinds:
        problem = f"--with {text[:80]}: there is no {' or '.join(unknown) or 'such word'}."
        raise UsageError(problem, help=f"Known: {', '.join(KINDS)}; several are joined by commas.")
    return kinds


def complete_kinds(incomplete: str) -> list[str]:
    """The last word of a list, with those before it."""
    before, comma, last = incomplete.rpartition(",")
    taken = before.split(",")
    return [before + comma + kind for kind in KINDS if kind.startswith(last) and kind not in taken]


def _workflow(requirement: str | None) -> str:
    if requirement is None:
        return _WORKFLOW.format(python=_PYTHON, what=WHEELS, env="")
    # A JSON string is a YAML string; the shell sees a variable and nothing to expand.
    env = _ENV.format(requirement=json.dumps(requirement))
    return _WORKFLOW.format(python=_PYTHON, what='"$COURSE"', env=env)


def _container(requirement: str | None) -> str:
    install = ["python", "-m", "pip", "install"]
    # One string is run by a shell, which finds the wheel; a list is not.
    command = " ".join([*install, WHEELS]) if requirement is None else [*install, requirement]
    return _json(
        {
            "name": "course",
            "image": f"mcr.microsoft.com/devcontainers/python:{_PYTHON}",
            "postCreateCommand": command,
            "customizations": {"vscode": {"extensions": ["ms-python.python"]}},
        }
    )


def _tasks(requirement: str | None) -> str:  # noqa: ARG001 - an editor runs what is installed
    matcher = {
        "owner": "course",
        "source": "course",
        "fileLocation": ["relative", "${workspaceFolder}"],
        "pattern": {
            "regexp": r"^(.+?):(\d+): (error|warning): (.*)$",
            "file": 1,
            "line": 2,
            "severity": 3,
            "message": 4,
        },
    }
    task = {
        "label": "course: check",
        "type": "shell",
        "command": "course",
        "args": ["check", "--all", "--format", "lines"],
        "options": {"cwd": "${workspaceFolder}"},
        "group": {"kind": "test", "isDefault": True},
        "problemMatcher": matcher,
    }
    return _json({"version": "2.0.0", "tasks": [task]})


def _json(value: object) -> str:
    return json.dumps(value, indent=2, ensure_ascii=False) + "\n"


#: The kinds: each one's file, and a function that gives its content for a requirement.
KINDS: dict[str, tuple[str, Callable[[str | None], str]]] = {
    "github": (".github/workflows/course.yml", _workflow),
    "devcontainer": (".devcontainer/devcontainer.json", _container),
    "vscode": (".vscode/tasks.json", _tasks),
}


def init(
    folder: Annotated[Path | None, argument("DIR", "The folder; the current one if left out.")] = None,
    surroundings: Annotated[
        str | None,
        option(
            "--with WHAT",
            "Also write github, devcontainer, vscode: a workflow, a container, tasks; join by commas.",
            complete_kinds,
        ),
    ] = None,
    requirement: Annotated[
        str | None,
        option(
            "--requirement REQUIREMENT",
            "For --with: where pip gets the course from; the wheel in wheels/ if left out.",
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
    root = named(folder or Path()).resolve()
    created = not (root / MARKER).is_file()
    if created:
        _refuse_odd_places(root, catalog)
        workspace = Workspace.create(root, catalog.course_id, catalog.version)
        console.line(f"Made a workspace for {catalog.title} in {root}.")
    else:
        workspace = Workspace.read(root)
        catalog_of(workspace)
        console.line(f"{root} is a workspace already" + ("." if kinds else "; nothing was changed."))
    written = []
    for name, text in (KINDS[kind] for kind in kinds):
        try:
            (root / name).parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            problem = f"The folder {(root / name).parent} cannot be made ({error.strerror or error})."
            raise UsageError(problem, code="not_writable") from error
        written.append(write_told(root / name, text(requirement).encode("utf-8"), why="init"))
    if requirement is None and {"github", "devcontainer"} & set(kinds) and not any(root.glob(WHEELS)):
        console.note(
            "It installs the course from a wheel in wheels/, and none is there yet: put the one that your "
            "instructor handed out there, and commit it."
        )
    if "github" in kinds and not (root / ".git").exists():
        console.note("GitHub reads workflows in the top folder of a repository only.")
    step = "course go"
    if root != here:
        console.note(f"Go there: cd {_quoted(root, here)}")
    console.note(f"Then: {step}" if root != here else f"Next: {step}")
    return console.answer(
        Init(
            workspace=str(workspace.root),
            created=created,
            course=CourseRef(id=workspace.course_id, version=workspace.version),
            next=NextStep(step),
            files=tuple(written),
        )
    )


def _refuse_odd_places(root: Path, catalog: Catalog) -> None:
    """A workspace inside another one, or in the course's own folder, would mix up two people's files."""
    content = catalog.content
    if root in (content.root, content.exercises, content.lessons) or content.exercises in root.parents:
        problem = f"{root} is where the course itself lies."
        fix = "Name a folder of your own: `course init my-course`."
        raise UsageError(problem, help=fix, code="inside_course")
    if root.exists() and not root.is_dir():
        raise UsageError(f"{root} is a file.", help="Name a folder.", code="exists")
    try:
        outer = Workspace.find(root.parent)
    except NotFoundError:
        return
    except CourseError as error:
        raise UsageError(error.message, help=error.help, code="nested_workspace") from error
    problem = f"{root} lies inside the workspace {outer.root}."
    raise UsageError(problem, help="Use that one, or make yours somewhere else.", code="nested_workspace")


def _quoted(root: Path, here: Path) -> str:
    """A path for a shell: relative where that is shorter, quoted where it must be."""
    text = str(root.relative_to(here) if root.is_relative_to(here) else root)
    text = f"./{text}" if text.startswith("-") else text
    if os.name == "nt":  # whose shells know no other quotes, and no such character in a name
        return f'"{text}"' if any(char.isspace() for char in text) else text
    return shlex.quote(text)
