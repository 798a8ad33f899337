"""The page of what a course's graders catch: every wrong solution with the check that finds it.

The page repeats what ``mutants.toml`` declares; the audit proves it, by grading them all.
"""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from course.authoring.exercises.diagnosis.confusion import fate_of, read_confusion, tally
from course.authoring.exercises.variants import accepted_files
from course.progress.workspace import write_atomically

if TYPE_CHECKING:
    from pathlib import Path

    from course.authoring.report import Findings
    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["audit_page", "kill_table", "write_page"]

_PAGE = "docs/graders.md"

_HEAD = """\
# What the graders catch

Written by `course author build`; `course author check` proves every line of it:
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


def audit_page(catalog: Catalog, findings: Findings) -> None:
    """Report a page that is out of date."""
    page = _page(catalog)
    if page.is_file() and page.read_text(encoding="utf-8") != kill_table(catalog):
        findings.add(
            page,
            None,
            "stale",
            "it is not of the exercises, variants and mutants there are now.",
            "Run `course author build`.",
        )


def write_page(catalog: Catalog) -> Path | None:
    """Write the page, where the course has one; None if it is up to date."""
    page = _page(catalog)
    text = kill_table(catalog)
    if not page.is_file() or page.read_text(encoding="utf-8") == text:
        return None
    write_atomically(page, text.encode())
    return page


def _page(catalog: Catalog) -> Path:
    return catalog.content.root / _PAGE


def _section(catalog: Catalog, exercise: Exercise) -> str:
    mutants = catalog.mutants(exercise)
    accepted = accepted_files(catalog, exercise)
    tasks = f"{len(exercise.task)} task{'s' * (len(exercise.task) > 1)}"
    lines = [
        f"## {exercise.title} (`{exercise.id}`)",
        "",
        f"{exercise.max_points:g} points in {tasks}, {exercise.hidden_points:g} of them "
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
    lines += _confusion(catalog, exercise)
    return "\n".join([*lines, ""])


def _confusion(catalog: Catalog, exercise: Exercise) -> list[str]:
    """The diagnoses of known wrong programs, by task, and each wrong diagnosis."""
    table = read_confusion(catalog, exercise)
    if table is None:
        return []
    lines = [
        "",
        "The diagnoses of known wrong programs, by `course author build --confusion`: of those above and",
        "those in `hypotheses.py`, all that have one mistake, and as many with two as make 200 a task.",
        "*Named*: a mistake that the program has.",
        "*General*: what is broken, but not why. *Otherwise*: a mistake that it does not have.",
        "",
        "| Task | Mistakes | Where | Named | General | Otherwise | No check fails |",
        "|---|---|---|---|---|---|---|",
    ]
    fate = fate_of(exercise)
    wheres = {"public": "at home", "full": "in a run"}
    for task in exercise.task:
        for number in (1, 2):
            for scope, where in wheres.items():
                rows = tuple(r for r in table.rows[scope] if r.task == task.id and len(r.codes) == number)
                if rows:
                    t = tally(fate, rows)
                    cells = (f"`{task.id}`", number, where, t.named, t.general, t.otherwise, t.survived)
                    lines.append(f"| {' | '.join(map(str, cells))} |")
    off = [
        f"- `{row.task}`: {', '.join(f'`{code}`' for code in row.codes)} gets `{row.said}` ({where})"
        for scope, where in wheres.items()
        for row in table.rows[scope]
        if fate(row) == "otherwise"
    ]
    return [*lines, "", *(["Diagnosed otherwise:", "", *off] if off else [])]


def _about(path: Path) -> str:
    """The first sentence of a variant's docstring or leading comment."""
    text = path.read_text(encoding="utf-8")
    about = ast.get_docstring(ast.parse(text)) or text.partition("\n")[0].lstrip("# ")
    return about.partition("\n\n")[0]


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")
