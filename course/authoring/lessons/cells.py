"""Runs the code of a lesson, and compares its text with the results.

The cells of a lesson run in order in one namespace. What they print is compared with what the lesson
records, and each number in the prose, ``[0.0890](=error)``, with the value of its expression, to the digits
the author wrote.
"""

import contextlib
import io
import re
import traceback
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from course.catalog import blocks as b
from course.catalog.markdown import read_blocks
from course.errors import ContentError
from course.progress.workspace import write_atomically

_NUMBER = re.compile(r"(?P<sign>[-+−]?)(?P<digits>\d[\d,]*(?:\.(?P<decimals>\d+))?)(?P<exponent>e[-+]?\d+)?")


@dataclass(frozen=True, slots=True)
class CellRun:
    """One code cell and what it printed this time.

    Attributes:
        printed: standard output, without the final newline; None when it printed nothing.
    """

    cell: b.CodeCell
    printed: str | None

    @property
    def agrees(self) -> bool:
        """Whether the lesson records what the cell prints; a hidden cell has no output to record."""
        return self.printed is None if self.cell.hidden else self.printed == self.cell.output


@dataclass(frozen=True, slots=True)
class ValueRun:
    """One quoted number, and the value of its expression in the same form."""

    value: b.Value
    computed: str

    @property
    def agrees(self) -> bool:
        number = _NUMBER.match(self.value.text)
        return self.computed in (self.value.text, number.group() if number else None)


@dataclass(frozen=True, slots=True)
class LessonRun:
    """The results of running a lesson."""

    cells: tuple[CellRun, ...]
    values: tuple[ValueRun, ...]


def run_lesson(path: Path) -> LessonRun:
    """Run the code cells of the lesson in a file, then evaluate every number it quotes."""
    blocks = read_blocks(path)
    namespace: dict[str, Any] = {"__name__": "lesson"}
    cells = tuple(
        CellRun(cell, _printed(cell, namespace, path))
        for cell in b.walk_blocks(blocks)
        if isinstance(cell, b.CodeCell)
    )
    values = tuple(
        ValueRun(value, _computed(value, namespace, path))
        for _, value in b.walk_inlines(blocks)
        if isinstance(value, b.Value)
    )
    return LessonRun(cells, values)


def update_outputs(path: Path) -> int:
    """Write the cells' present output into the lesson; numbers in the prose are left to the author.

    Returns:
        How many recorded outputs changed.
    """
    lines = path.read_text(encoding="utf-8").splitlines()
    changed = 0
    for run in reversed(run_lesson(path).cells):
        if run.agrees or run.cell.hidden:
            continue
        changed += 1
        if run.cell.output_line is not None:
            start = run.cell.output_line - 1
            end = _fence_end(lines, start) + 1
        else:
            start = end = _fence_end(lines, run.cell.line - 1) + 1
        fresh = [] if run.printed is None else ["```output", *run.printed.split("\n"), "```"]
        lines[start:end] = fresh
    if changed:
        write_atomically(path, ("\n".join(lines) + "\n").encode())
    return changed


def as_written(value: object, text: str) -> str:
    """A value in the form of the number that a text begins with: same decimals, same exponent form.

    Args:
        value: a number, or a string that is taken as it is.
        text: "0.0890", "-0.0981 m", "1,024" or "5.3e-2"; a true minus sign is kept where it is used.

    Raises:
        ValueError: the value is a number and the text does not begin with one.
    """
    if isinstance(value, str):
        return value
    form = _NUMBER.match(text)
    if form is None:
        raise ValueError(f"{text!r} does not begin with a number")
    decimals = len(form["decimals"] or "")
    number = float(value)  # type: ignore[arg-type]
    if form["exponent"]:
        mantissa, exponent = f"{number:.{decimals}e}".split("e")
        shown = f"{mantissa}e{int(exponent)}"
    else:
        shown = f"{number:{',' if ',' in form['digits'] else ''}.{decimals}f}"
    if form["sign"] == "+" and number >= 0:
        shown = f"+{shown}"
    return shown.replace("-", "−") if form["sign"] == "−" else shown


def _printed(cell: b.CodeCell, namespace: dict[str, Any], path: Path) -> str | None:
    out = io.StringIO()
    # The line numbers of a traceback are then those of the lesson.
    source = "\n" * cell.line + cell.source
    try:
        with contextlib.redirect_stdout(out):
            exec(compile(source, str(path), "exec"), namespace)
    except Exception as error:
        frames = [f.lineno for f in traceback.extract_tb(error.__traceback__) if f.filename == str(path)]
        where = frames[-1] if frames else getattr(error, "lineno", None)
        said = error.msg if isinstance(error, SyntaxError) else error  # which names file and line once more
        problem = f"the code cell raises {type(error).__name__}: {said}"
        raise ContentError(
            path, where or cell.line, problem, help="Correct the cell; the lesson runs it."
        ) from error
    text = out.getvalue().rstrip("\n")
    return text or None


def _computed(value: b.Value, namespace: dict[str, Any], path: Path) -> str:
    try:
        result = eval(value.expression, namespace)
        return as_written(result, value.text)
    except Exception as error:
        problem = f"[{value.text}](={value.expression}) raises {type(error).__name__}: {error}"
        help_ = "An expression uses the names of the lesson's code cells."
        raise ContentError(path, value.line, problem, help=help_) from error


def _fence_end(lines: list[str], start: int) -> int:
    return next(i for i in range(start + 1, len(lines)) if lines[i].rstrip() == "```")
