"""``course init --with``: files that bring the checks to where people work, on GitHub and in an editor.

The course comes from the wheel that an instructor hands out, or from a requirement that is named. It is on no
package index, so no file installs it by its name.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from course.cli.frame import files
from course.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from course.cli.frame.replies import WrittenFile

__all__ = ["KINDS", "chosen_kinds", "complete_kinds", "usable", "write_surroundings"]

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
    """A requirement that pip, a shell and GitHub all read in the same way.

    Raises:
        UsageError: one of them would read it differently.
    """
    if requirement is not None and (
        not requirement.isprintable() or requirement.startswith("-") or "${{" in requirement
    ):
        raise UsageError(
            f"--requirement {requirement[:80]!r}: this is nothing that pip could install.",
            help="Give what you would write after `pip install`: an address, a path or a name.",
            code="bad_requirement",
        )
    return requirement


def write_surroundings(root: Path, kinds: tuple[str, ...], requirement: str | None) -> list[WrittenFile]:
    """Write the files of some kinds into a workspace; a copy of each replaced file is kept.

    Args:
        requirement: where pip gets the course from; None for the wheel in ``wheels/``.

    Raises:
        UsageError: a file cannot be written.
    """
    written = []
    for kind in kinds:
        name, text = KINDS[kind]
        path = root / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UsageError(
                f"The folder {path.parent} cannot be made ({error.strerror or error}).", code="not_writable"
            ) from error
        written.append(files.write(path, text(requirement).encode("utf-8"), why="init"))
    return written


def chosen_kinds(text: str) -> tuple[str, ...]:
    """The kinds in a list such as "github,vscode".

    Raises:
        UsageError: there is no such kind.
    """
    kinds = tuple(dict.fromkeys(word.strip() for word in text.split(",") if word.strip()))
    unknown = [kind for kind in kinds if kind not in KINDS]
    if unknown or not kinds:
        raise UsageError(
            f"--with {text[:80]}: there is no {' or '.join(unknown) or 'such word'}.",
            help=f"There are {', '.join(KINDS)}; several are joined by commas.",
        )
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
