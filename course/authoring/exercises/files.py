"""The audit of an exercise's files, without running any of them.

Blanks left by ``course author new``, hints, README, stub against solution, and the checks' own declarations.
``course.authoring.exercises.proofs`` has the rules that take a grading run.
"""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from course.authoring.exercises.checks import audit_checks
from course.authoring.exercises.points import audit_points
from course.authoring.exercises.slow import audit_slow
from course.authoring.exercises.source import CheckSource, foreign_imports, parse, signatures
from course.authoring.exercises.variants import instructors, solution_path, solutions_folder
from course.catalog.models import Exercise
from course.catalog.reading import read_document, read_text
from course.errors import ContentError
from course.reading.parts import read_script
from course.scoring.explain.words import FILE as WORDS
from course.scoring.explain.words import read_words

if TYPE_CHECKING:
    from pathlib import Path

    from course.authoring.report import Findings
    from course.catalog.load import Catalog

__all__ = ["BLANK", "audit_files", "exercise_folders", "find_blanks"]

#: The mark that ``course author new`` leaves where an author has to write.
BLANK = re.compile(r"<<FILL IN:\s*(?P<what>.*?)>>")

#: Mildest first; the last may nearly be the solution.
LEAST_HINTS = 3
LEAST_HINTS_OF_WARM_UP = 2

_TEXT_SUFFIXES = {".py", ".toml", ".md"}


def exercise_folders(catalog: Catalog, exercise_id: str) -> tuple[Path, Path, Path]:
    """The folders an exercise is spread over: the student's part, solutions, hidden graders."""
    solutions, graders = instructors(catalog)
    place = catalog.content.place_of(exercise_id)
    return catalog.content.exercises / place, solutions / place, graders / place


def find_blanks(catalog: Catalog, exercise_id: str, findings: Findings) -> bool:
    """Report each blank that is left; True if there is one."""
    found = False
    for folder in exercise_folders(catalog, exercise_id):
        for path in sorted(folder.rglob("*")):
            if path.suffix in _TEXT_SUFFIXES and path.is_file():
                found = blanks_in(path, findings) or found
    return found


def blanks_in(path: Path, findings: Findings) -> bool:
    """Report the blanks of one file; True if there is one."""
    found = False
    for number, line in enumerate(read_text(path).split("\n"), start=1):
        for match in BLANK.finditer(line):
            found = True
            what = match["what"].strip()
            findings.add(
                path, number, "blank", f"still to be filled in: {what}.", "Replace the whole marker."
            )
    return found


def audit_files(catalog: Catalog, exercise: Exercise, findings: Findings) -> tuple[CheckSource, ...]:
    """Everything that reading can show; returns the checks the exercise declares."""
    _audit_declaration(catalog, exercise, findings)
    _audit_hints(catalog, exercise, findings)
    catalog.rubric(exercise)
    _audit_code(catalog, exercise, findings)
    checks = audit_checks(catalog, exercise, findings)
    # Checks without a marker cannot be added up, and are reported.
    if not findings.of("check"):
        audit_points(exercise, checks, findings)
        audit_slow(exercise, checks, findings)
    return checks


def _audit_declaration(catalog: Catalog, exercise: Exercise, findings: Findings) -> None:
    """The lesson exists and names the exercise; no other exercise claims the same place.

    A warm-up names its lesson and the section it follows instead, so that a lesson need not list them.
    """
    path = exercise.readme_path.with_name("exercise.toml")
    lines = read_document(path, Exercise).lines
    if exercise.lesson not in catalog.lesson_ids():
        findings.add(
            path,
            lines.line(("lesson",)),
            "exercise",
            f"there is no lesson {exercise.lesson}.",
            f"Known: {', '.join(catalog.lesson_ids())}.",
        )
    elif exercise.is_warm_up:
        _audit_section(catalog, exercise, path, lines.line(("after",)), findings)
    elif exercise.id not in catalog.lesson(exercise.lesson).exercises:
        findings.add(
            path,
            lines.line(("lesson",)),
            "exercise",
            f"lesson {exercise.lesson} does not name this exercise.",
            f'Add "{exercise.id}" to `exercises` in the head of {exercise.lesson}.md.',
        )
    rivals = catalog.warm_up_ids() if exercise.is_warm_up else catalog.exercise_ids()
    for other in rivals:
        if other < exercise.id and _order_of(catalog, other) == _rank(exercise):
            findings.add(
                path,
                lines.line(("order",)),
                "exercise",
                f"{exercise.kind} {other} has the order {exercise.order} too.",
                "Give each exercise a place of its own.",
            )


def _audit_section(
    catalog: Catalog, exercise: Exercise, path: Path, line: int | None, findings: Findings
) -> None:
    """The section that a warm-up follows is one of its lesson."""
    if not exercise.after:
        return
    headings = read_script(catalog.lesson(exercise.lesson)).sections
    known = [section.slug for section in headings]
    if exercise.after not in known:
        findings.add(
            path,
            line,
            "exercise",
            f"lesson {exercise.lesson} has no section {exercise.after!r}.",
            f"Known: {', '.join(known)}.",
        )


def _rank(exercise: Exercise) -> tuple[str, int]:
    """Its place in lists: exercises are counted through, warm-ups by lesson."""
    return (exercise.lesson if exercise.is_warm_up else "", exercise.order)


def _order_of(catalog: Catalog, exercise_id: str) -> tuple[str, int] | None:
    try:
        return _rank(catalog.exercise(exercise_id))
    except ContentError:
        return None  # reported where that exercise is audited


def _audit_hints(catalog: Catalog, exercise: Exercise, findings: Findings) -> None:
    document = catalog.hints_document(exercise)
    least = LEAST_HINTS_OF_WARM_UP if exercise.is_warm_up else LEAST_HINTS
    for task in exercise.task:
        hints = document.value.of(task.id).hints
        if len(hints) < least:
            index = next((i for i, entry in enumerate(document.value.task) if entry.id == task.id), None)
            findings.add(
                exercise.hints_path,
                document.lines.line(("task", index, "hints")) if index is not None else None,
                "hints",
                f"task {task.id} has {len(hints)} hints, and needs {least}.",
                "Add hints, mildest first.",
            )
    words = exercise.readme_path.with_name(WORDS)
    if not words.is_file():
        return
    known = read_words(words).entries.keys()
    for index, entry in enumerate(document.value.task):
        for code in sorted({code for codes in entry.fits.values() for code in codes} - known):
            findings.add(
                exercise.hints_path,
                document.lines.line(("task", index, "fits")),
                "hints",
                f"{WORDS} has no diagnosis {code}.",
                "A hint can only follow a diagnosis that there is.",
            )


def _audit_code(catalog: Catalog, exercise: Exercise, findings: Findings) -> None:
    """Stub, solution and README have the same functions."""
    stub = parse(exercise.stub_path)
    model = parse(solution_path(catalog, exercise))
    theirs, ours = signatures(stub), signatures(model)
    readme = " ".join(read_text(exercise.readme_path).split())
    for task in exercise.task:
        if task.id not in theirs:
            findings.add(
                exercise.stub_path,
                None,
                "stub",
                f"the stub has no function {task.id}, and a task is called so.",
                "Add the function, or correct the id of the task.",
            )
    for node in stub.body:
        if isinstance(node, ast.FunctionDef) and not ast.get_docstring(node):
            findings.add(
                exercise.stub_path,
                node.lineno,
                "stub",
                f"{node.name} has no docstring.",
                "Say there what it gives, with shapes and units of arguments and result.",
            )
    for name, signature in theirs.items():
        if name not in ours:
            findings.add(
                solution_path(catalog, exercise),
                None,
                "signature",
                f"the model solution has no function {name}.",
                f"Define {signature.text}.",
            )
        elif ours[name].text != signature.text:
            findings.add(
                solution_path(catalog, exercise),
                ours[name].line,
                "signature",
                f"the stub has {signature.text}, the solution {ours[name].text}.",
                "Make the two the same.",
            )
        if signature.text not in readme and signature.annotated not in readme:
            findings.add(
                exercise.readme_path,
                None,
                "readme",
                f"the README does not show the signature {signature.text}.",
                "Write it there as it stands in the stub, with shapes and units.",
            )
    _audit_imports(exercise, exercise.stub_path, stub, findings)
    _audit_imports(exercise, solution_path(catalog, exercise), model, findings)
    for folder in ("accepted", "mutants"):
        for path in sorted((solutions_folder(catalog, exercise) / folder).glob("*.py")):
            _audit_imports(exercise, path, parse(path), findings)


def _audit_imports(exercise: Exercise, path: Path, tree: ast.Module, findings: Findings) -> None:
    for line, name in foreign_imports(tree, exercise.imports):
        findings.add(
            path,
            line,
            "imports",
            f"{name} may not be imported here.",
            "Use the standard library and what `imports` in exercise.toml lists.",
        )
