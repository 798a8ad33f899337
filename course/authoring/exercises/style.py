"""The audit of exercises' Python as ruff sees it, by the rules of the course they belong to."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib.util import find_spec
from typing import TYPE_CHECKING

from course.authoring.exercises.variants import exercise_graders, solutions_folder

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.authoring.report import Findings
    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["audit_style"]


def audit_style(catalog: Catalog, exercises: Sequence[Exercise], findings: Findings) -> None:
    """Report what ruff finds; nothing where it is not installed, or the course has no rules for it."""
    root = catalog.content.root
    if not exercises or not (root / "pyproject.toml").is_file() or find_spec("ruff") is None:
        return
    folders = [
        folder
        for exercise in exercises
        for folder in (
            exercise.readme_path.parent,
            solutions_folder(catalog, exercise),
            exercise_graders(catalog, exercise),
        )
    ]

    def said(*arguments: str) -> str:
        there = (str(folder) for folder in folders if folder.is_dir())  # a warm-up has no hidden checks
        command = [sys.executable, "-m", "ruff", *arguments, *there]
        return subprocess.run(command, cwd=root, capture_output=True, text=True, check=False).stdout

    for one in json.loads(said("check", "--output-format", "json") or "[]"):
        message = f"{one['message']} ({one['code']})."
        fix = "Try `ruff check --fix`." if one["fix"] else "Change the line."
        findings.add(one["filename"], one["location"]["row"], "style", message, fix)
    for line in said("format", "--diff").splitlines():
        if line.startswith(start := "--- "):
            name = line.removeprefix(start)
            message, fix = "it is not laid out as ruff lays it out.", f"Run `ruff format {name}`."
            findings.add(root / name, None, "style", message, fix)
