"""Writes the pages of a class: one pass over the results, one student in memory at a time."""

from __future__ import annotations

import contextlib
import itertools
import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from urllib.parse import quote

from course.grading.exports.grades import csv_bytes, number, write_bytes
from course.grading.exports.html_report.pages import MARKER, class_page, index_page, index_row, student_page
from course.grading.exports.html_report.tally import Tally
from course.grading.exports.selection import ExportOptions, Written, select
from course.grading.results.effective import Effective, Results

_PAGE = re.compile(r"[1-9][0-9]*\.html")


def write_html(target: Path, results: Results, options: ExportOptions) -> Written:
    """The page about the class, the list of students, and the students' pages beside it.

    Args:
        target: the page (``.html``), or the folder it goes into.

    Raises:
        UsageError: no such exercise.
        MissingCapabilityError: students are missing in the roster, or a file cannot be written.
    """
    selection = select(results, options)
    path = target if target.suffix.lower() in {".html", ".htm"} else target / "report.html"
    paths = write_pages(path, results, selection.each(), selection.exercises)
    selection.written.paths += paths
    selection.written.notes.append(
        "Pages in the folder students can be handed out, each to its student; the list of students is yours."
    )
    return selection.written


def write_pages(
    path: Path, results: Results, found: Iterable[Effective], exercises: Sequence[str]
) -> list[Path]:
    """Write everything.

    Args:
        path: of the page about the class; the rest lies beside it.
        found: results ordered by student; those that have only an override may come at the end.
        exercises: ids, in the order they are shown.

    Returns:
        The written paths: the class page, the list of students as a page and as a table, the folder of pages.

    Raises:
        MissingCapabilityError: a file cannot be written.
    """
    noted = {item.id: item for item in results.exercises()}
    order = {name: at for at, name in enumerate(exercises)}
    numbers = {student: at for at, student in enumerate(results.students(), 1)}
    links = {student: f"students/{at}.html" for student, at in numbers.items()}
    folder = path.parent / "students"
    tally = Tally(noted[name] for name in exercises)
    rows = {}
    scores: dict[str, list[str]] = {}
    for student, group in _by_student(results, found):
        mine = sorted(group, key=lambda effective: order[effective.exercise])
        tally.take(mine)
        place = numbers[student]
        write_bytes(folder / f"{place}.html", _encoded(student_page(results, student, mine)))
        by_exercise = {effective.exercise: effective for effective in mine}
        scores[student] = [
            number(by_exercise[name].score) if name in by_exercise else "" for name in exercises
        ]
        rows[student] = index_row(results, student, place, links[student], by_exercise, exercises)
    written = sorted(rows, key=numbers.__getitem__)
    listed, table = path.with_name("students.html"), path.with_name("students.csv")
    chosen = [noted[name] for name in exercises]
    shown = [rows[student] for student in written]
    write_bytes(listed, _encoded(index_page(results, shown, chosen, quote(path.name))))
    headings = ("page", "student", "name", "email", *exercises)
    rows_of = _table(results, written, links)
    write_bytes(table, csv_bytes(headings, ([*row, *scores[row[1]]] for row in rows_of)))
    write_bytes(path, _encoded(class_page(results, tally, links, quote(listed.name))))
    _remove_others(folder, {f"{numbers[student]}.html" for student in written})
    return [path, listed, table, folder]


def _by_student(results: Results, found: Iterable[Effective]) -> Iterator[tuple[str, list[Effective]]]:
    """All results of one student together.

    A student with an override for work that was not handed in has that result at the end, so the others wait
    for it.
    """
    held: dict[str, list[Effective]] = {override.student: [] for override in results.book.overrides()}
    for student, group in itertools.groupby(found, key=lambda effective: effective.student):
        if student in held:
            held[student] += group
        else:
            yield student, list(group)
    yield from ((student, group) for student, group in held.items() if group)


def _table(results: Results, students: Iterable[str], links: dict[str, str]) -> Iterator[list[str]]:
    for student in students:
        person = results.person(student)
        yield [links[student], student, *((person.name, person.email) if person else ("", ""))]


def _remove_others(folder: Path, written: set[str]) -> None:
    """Delete the pages of an earlier class: their numbers may belong to other students now."""
    if not folder.is_dir():
        return
    for path in folder.iterdir():
        if _PAGE.fullmatch(path.name) and path.name not in written:
            with contextlib.suppress(OSError), path.open("rb") as handle:
                ours = handle.read(len(MARKER)) == MARKER.encode()
                if ours:
                    path.unlink()


def _encoded(page: str) -> bytes:
    return page.encode("utf-8")
