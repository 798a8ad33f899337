"""What the graders of a course catch, as a page: every wrong solution beside the check that finds it.

The page repeats what ``mutants.toml`` declares; the audit proves it, by grading them all.
"""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from course.authoring.exercises.variants import accepted_files

if TYPE_CHECKING:
    from pathlib import Path

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["kill_table"]

_HEAD = """\
# What the graders catch

Written by `course author mutants --table docs/graders.md`; `course author check` proves every line of it:
each accepted solution gets full marks, and each wrong one loses points of its own task only, to the check
named, with the diagnosis named.
"""


def kill_table(catalog: Catalog) -> str:
    """The page, as Markdown.

    Raises:
        ContentError: a file of an exercise is wrong.
        MissingCapabilityError: this installation is a student's.
    """
    return "\n".join([_HEAD, *(_section(catalog, exercise) for exercise in catalog.exercises())])


def _section(catalog: Catalog, exercise: Exercise) -> str:
    mutants = catalog.mutants(exercise)
    accepted = accepted_files(catalog, exercise)
    lines = [
        f"## {exercise.title} (`{exercise.id}`)",
        "",
        f"{exercise.max_points:g} points in {len(exercise.task)} tasks, {exercise.hidden_points:g} of them "
        f"on {exercise.hidden_checks} hidden checks. {len(accepted)} unusual solutions are accepted, "
        f"{len(mutants)} wrong ones are caught.",
        "",
        "| What its author believes | Task | Caught by | Diagnosis | File |",
        "|---|---|---|---|---|",
    ]
    for mutant in mutants:
        cells = (
            _cell(mutant.misconception),
            f"`{mutant.task}`",
            f"`{mutant.check}`",
            f"`{mutant.diagnosis}`",
            f"`{mutant.file}`",
        )
        lines.append(f"| {' | '.join(cells)} |")
    lines += ["", "Accepted although unusual:", ""]
    lines += [f"- `{path.name}`: {_cell(_about(path))}" for path in accepted]
    return "\n".join([*lines, ""])


def _about(path: Path) -> str:
    """The first sentence of a variant's docstring or leading comment."""
    text = path.read_text(encoding="utf-8")
    about = ast.get_docstring(ast.parse(text)) or text.partition("\n")[0].lstrip("# ")
    return about.partition("\n\n")[0]


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")
