"""The audit of an exercise's diagnoses: the table is up to date, and codes and entries match."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from course.authoring.exercises.diagnosis.build import digest
from course.authoring.exercises.diagnosis.confusion import FILE as CONFUSION
from course.authoring.exercises.diagnosis.confusion import fate_of, made_from, read_confusion
from course.authoring.exercises.source import parse
from course.authoring.exercises.variants import exercise_graders, solutions_folder
from course.catalog.reading import read_text
from course.scoring.checks.companions import companion_path
from course.scoring.explain.table import FILE, read_table
from course.scoring.explain.words import FILE as WORDS
from course.scoring.explain.words import read_words

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from course.authoring.report import Findings
    from course.catalog.load import Catalog
    from course.catalog.models import Exercise
    from course.scoring.explain.table import Table

__all__ = ["audit_diagnoses"]

_CODE = re.compile(r"[A-Z][A-Z0-9]*(_[A-Z0-9]+)*")


def audit_diagnoses(catalog: Catalog, exercise: Exercise, findings: Findings) -> None:
    """Report missing files, stale tables, codes without words, and words that are given where untrue."""
    words_path = exercise.readme_path.with_name(WORDS)
    table_path = exercise.readme_path.with_name(FILE)
    if not words_path.is_file():
        if (solutions_folder(catalog, exercise) / "hypotheses.py").is_file():
            findings.add(words_path, None, "words", "there are hypotheses and no words.", "Write it.")
        return
    words = read_words(words_path)
    for code, entry in words.entries.items():
        if entry.kind == "cause" and entry.looks_like.startswith("Here "):
            message = f"{code} is about one run, but as a cause it is said by every check of its task."
            findings.add(words_path, None, "words", message, 'Give it `kind = "consequence"`.')
    questions = companion_path(exercise.id, "questions")
    if not questions.is_file():
        message = f"it is missing, and {WORDS} is there: what would tell wrong programs apart?"
        findings.add(questions, None, "words", message, "Write it.")
        return
    # A warm-up's wrong programs are its mutants, each of which is graded.
    again = f"Run `course author build {exercise.id}{'' if exercise.is_warm_up else ' --confusion'}`."
    if not table_path.is_file():
        findings.add(table_path, None, "words", "it is missing.", again)
        return
    table = read_table(table_path)
    if table.made_from != digest(catalog, exercise):
        findings.add(
            table_path,
            None,
            "stale",
            "it was made from other questions, hypotheses, mutants or solutions than there are now.",
            again,
        )
    elif not exercise.is_warm_up:
        _audit_confusion(catalog, exercise, findings, again)
    _audit_codes(catalog, exercise, table, findings)


def _audit_confusion(catalog: Catalog, exercise: Exercise, findings: Findings, again: str) -> None:
    path = solutions_folder(catalog, exercise) / CONFUSION
    kept = read_confusion(catalog, exercise)
    if kept is None:
        findings.add(path, None, "stale", "it is missing.", again)
        return
    if kept.made_from != made_from(catalog, exercise):
        message = "the kept diagnoses of known wrong programs are out of date."
        findings.add(path, None, "stale", message, again)
        return
    fate = fate_of(exercise)
    for row in (row for rows in kept.rows.values() for row in rows if fate(row) == "otherwise"):
        message = f"{row.task}: programs with {', '.join(row.codes)} are told {row.said}, which is untrue."
        findings.add(path, None, "words", message, "Narrow the probe that says it.")
    for row in kept.rows["full"]:
        if len(row.codes) == 1 and row.said == "survives":
            message = f"{row.task}: no check fails for a program that is said to have {row.codes[0]}."
            findings.add(path, None, "words", message, "Add a check, or correct `hypotheses.py`.")


def _audit_codes(catalog: Catalog, exercise: Exercise, table: Table, findings: Findings) -> None:
    words_path = exercise.readme_path.with_name(WORDS)
    entries = read_words(words_path).entries
    known = {code for rows in table.rows.values() for row in rows for code in row.codes}
    given = set(_literals(catalog, exercise))
    for code in sorted(known - entries.keys()):
        path = exercise.readme_path.with_name(FILE)
        findings.add(path, None, "words", f"{WORDS} has no words for {code}.", "Write them.")
    lines = read_text(words_path).split("\n")
    for code in sorted(entries.keys() - known - given):
        line = next((at for at, text in enumerate(lines, 1) if text == f"[diagnosis.{code}]"), None)
        named = any(code in (mutant.diagnosis, *mutant.also) for mutant in catalog.mutants(exercise))
        fix = "Add a question that its mutant answers in its own way." if named else "Take it out."
        findings.add(words_path, line, "words", f"nothing gives the diagnosis {code}.", fix)


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
