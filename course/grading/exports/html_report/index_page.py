"""The list of students: whose page is which number, and what everybody scored. For the instructor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.grading.exports.cells import number
from course.grading.exports.html_report.markup import Html, name_of, page, region_table, tag

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from course.grading.exports.html_report.markup import Heading
    from course.grading.gradebook.records import GradedExercise
    from course.grading.results.effective import Effective, Results

__all__ = ["index_page", "index_row"]


def index_row(
    results: Results,
    student: str,
    place: int,
    href: str,
    found: Mapping[str, Effective],
    exercises: Sequence[str],
) -> Html:
    """One student: number of the page, name, and a score per exercise.

    Args:
        found: exercise -> result.
        exercises: the columns.
    """
    person = results.person(student)
    cells = [tag("td", str(place), class_="n"), tag("th", tag("a", name_of(student), href=href), scope="row")]
    if results.roster is not None:
        cells.append(tag("td", name_of(person.name) if person else "not in the roster"))
        cells.append(tag("td", name_of(person.section) if person else ""))
    cells += [_score(found.get(exercise)) for exercise in exercises]
    return tag("tr", *cells)


def _score(effective: Effective | None) -> Html:
    """Points, and in words whatever is unusual about them."""
    if effective is None:
        return tag("td", "–", class_="n", data_value="")
    remarks = []
    if effective.override is not None:
        remarks.append("by hand")
    elif effective.score is None:
        remarks.append("fault of the grader")
    elif effective.verdict.state != "graded":
        remarks.append("not graded")
    elif not effective.passed:
        remarks.append("not passed")
    if effective.late is not None:
        remarks.append("late")
    shown = "none" if effective.score is None else number(effective.score)
    about = tag("small", ", ".join(remarks)) if remarks else Html("")
    return tag("td", shown, about, class_="n", data_value=number(effective.score))


def index_page(
    results: Results, rows: Sequence[Html], exercises: Sequence[GradedExercise], report: str
) -> Html:
    """The whole page.

    Args:
        rows: as ``index_row`` makes them, in order.
        exercises: the columns.
        report: address of the page about the class.
    """
    heads: list[Heading] = [("Page", "n"), "Student"]
    if results.roster is not None:
        heads += ["Name", "Section"]
    heads += [(f"{item.title}, of {number(item.max_points)}", "n") for item in exercises]
    table = region_table("Students and their scores", heads, rows, sortable=True, filtered="Show rows with")
    course = f"{results.course.id} {results.course.version}".strip()
    header = tag("h1", "Students")
    about = tag(
        "p",
        f"{len(rows)} students of {course}. The number is that of the page to hand out. This list is the "
        "instructor's: it has everybody's name and score.",
    )
    navigation = tag("nav", tag("ul", tag("li", tag("a", "Class report", href=report))), aria_label="Pages")
    footer = tag("p", "“–”: nothing was handed in.")
    return page(f"Students: {course}", header, navigation, Html(about + table), footer, scripted=True)
