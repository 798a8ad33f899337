"""The audit of an exercise's diagnoses: the table is up to date, and codes and entries match."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from course.authoring.exercises.diagnosis.build import digest
from course.authoring.exercises.diagnosis.confusion import FILE as CONFUSION
from course.authoring.exercises.diagnosis.confusion import made_from, read_confusion
from course.authoring.exercises.source import parse
from course.authoring.exercises.variants import exercise_graders, solutions_folder
from course.catalog.reading import read_text
from course.scoring.explain.table import FILE, read_table
from course.scoring.explain.words import FILE as WORDS
from course.scoring.explain.words import read_words

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from course.authoring.report import Findings
    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["audit_diagnoses"]

_CODE = re.compile(r"[A-Z][A-Z0-9]*(_[A-Z0-9]+)*")


def audit_diagnoses(catalog: Catalog, exercise: Exercise, findings: Findings) -> None:
    """Report a stale table, codes without words, and entries whose code is never given."""
    words_path = exercise.readme_path.with_name(WORDS)
    table_path = exercise.readme_path.with_name(FILE)
    if not words_path.is_file():
        if (solutions_folder(catalog, exercise) / "hypotheses.py").is_file():
            findings.add(words_path, None, "words", "there are hypotheses and no words.", "Write it.")
        return
    table, words = read_table(table_path), read_words(words_path)
    if table.made_from != digest(catalog, exercise):
        findings.add(
            table_path,
            None,
            "stale",
            "it was made from other questions, hypotheses, mutants or solutions than there are now.",
            f"Run `course author build {exercise.id}`.",
        )
    kept = read_confusion(catalog, exercise)
    fresh = kept is not None and kept.made_from == made_from(catalog, exercise)
    # A warm-up's wrong programs are its mutants, each of which is graded.
    if not fresh and not exercise.is_warm_up:
        findings.add(
            solutions_folder(catalog, exercise) / CONFUSION,
            None,
            "stale",
            "the kept diagnoses of known wrong programs are out of date.",
            f"Run `course author build {exercise.id} --confusion`.",
        )
    known = {code for rows in table.rows.values() for row in rows for code in row.codes}
    given = set(_literals(catalog, exercise))
    for code in sorted(known - words.entries.keys()):
        findings.add(table_path, None, "words", f"{WORDS} has no words for {code}.", "Write them.")
    lines = read_text(words_path).split("\n")
    for code in sorted(words.entries.keys() - known - given):
        line = next((at for at, text in enumerate(lines, 1) if text == f"[diagnosis.{code}]"), None)
        findings.add(words_path, line, "words", f"nothing gives the diagnosis {code}.", "Take it out.")


def _literals(catalog: Catalog, exercise: Exercise) -> Iterator[str]:
    """Codes that stand as text in the checks of an exercise and their helpers."""
    folders: list[Path] = [exercise.readme_path.parent, exercise_graders(catalog, exercise)]
    for folder in folders:
        for path in sorted(folder.rglob("*.py")):
            for node in ast.walk(parse(path)):
                if (
                    isinstance(node, ast.Constant)
                    and isinstance(node.value, str)
                    and _CODE.fullmatch(node.value)
                ):
                    yield node.value
