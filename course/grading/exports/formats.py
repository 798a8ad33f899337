"""The formats by name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from course.errors import UsageError
from course.grading.exports.grades import write_csv, write_jsonl
from course.grading.exports.html_report.write import write_html
from course.grading.exports.junit import write_junit
from course.grading.exports.platforms import write_canvas, write_gradescope, write_moodle, write_worksheet
from course.grading.exports.selection import ExportOptions, Written, is_part, select
from course.grading.results.effective import Results

if TYPE_CHECKING:
    Writer = Callable[[Path, Results, ExportOptions], Written]

#: Needs no gradebook, and so is not one of the formats below.
AUTOGRADER = "gradescope-autograder"


def _csv(path: Path, results: Results, options: ExportOptions) -> Written:
    selection = select(results, options)
    write_csv(path, results, selection.each())
    selection.written.paths.append(path)
    return selection.written


def _jsonl(path: Path, results: Results, options: ExportOptions) -> Written:
    selection = select(results, options)
    write_jsonl(path, selection.each(), results.course)
    selection.written.paths.append(path)
    return selection.written


#: name -> the name of its file in OUT, and the function that writes it.
FORMATS: dict[str, tuple[str, Writer]] = {
    "csv": ("grades.csv", _csv),
    "jsonl": ("results.jsonl", _jsonl),
    "junit": ("junit.xml", write_junit),
    "gradescope": ("gradescope", write_gradescope),
    "canvas": ("canvas.csv", write_canvas),
    "moodle": ("moodle.csv", write_moodle),
    "moodle-worksheet": ("moodle-worksheet.csv", write_worksheet),
    "html": ("report.html", write_html),
}

#: The formats that a run writes by itself.
_OF_A_RUN = {"csv", "jsonl", "html"}


def export(results: Results, name: str, out: Path, target: Path | None, options: ExportOptions) -> Written:
    """Write one format.

    Args:
        out: folder of the grading run.
        target: where to; in ``out`` under the format's own name if None, or in ``out/part`` if some exercises
            or students are left out and a run keeps that file about all.

    Raises:
        UsageError: there is no such format, or it needs something that was not given.
        MissingCapabilityError: students are missing in the roster, or it cannot be written.
    """
    if name not in FORMATS:
        raise UsageError(
            f"--format is {name!r}.", help=f"It takes {', '.join([*FORMATS, AUTOGRADER])}.", code="usage"
        )
    usual, write = FORMATS[name]
    if target is None:
        # The run's own file there is about the whole class, and stays so.
        part = name in _OF_A_RUN and is_part(results, options)
        target = out / "part" / usual if part else out / usual
    return write(target, results, options)
