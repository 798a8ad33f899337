"""The formats by name, and JUnit."""

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path
from xml.etree import ElementTree as ET

from course.errors import UsageError
from course.grading.exports.grades import number, replacing, write_csv, write_jsonl
from course.grading.exports.platforms import write_canvas, write_gradescope, write_moodle, write_worksheet
from course.grading.exports.selection import (
    ExportOptions,
    Written,
    checks_for_student,
    is_part,
    problem_for_student,
    select,
)
from course.grading.results.effective import Effective, Results
from course.printable import one_line
from course.scoring.verdict import CheckResult, Status

Writer = Callable[[Path, Results, ExportOptions], Written]

#: Needs no gradebook, and so is not one of the formats below.
AUTOGRADER = "gradescope-autograder"


def _plain(path: Path, results: Results, options: ExportOptions, *, lines: bool) -> Written:
    """Our own table, or the lines of JSON."""
    selection = select(results, options)
    if lines:
        write_jsonl(path, selection.each(), results.course)
    else:
        write_csv(path, results, selection.each())
    selection.written.paths.append(path)
    return selection.written


# ---
# JUnit XML as Jenkins' xUnit plugin reads it (its schema junit-10): one suite per student and exercise.
#
# The schema allows properties under a suite and none under a case, so a suite carries score and reasons. The
# file contains only what students may read, because build servers show such files to many people.

#: What XML 1.0 cannot hold in any spelling.
_IMPOSSIBLE = re.compile(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def write_junit(path: Path, results: Results, options: ExportOptions) -> Written:
    from xml.sax.saxutils import quoteattr

    selection = select(results, options)
    with replacing(path) as handle:
        handle.write(b'<?xml version="1.0" encoding="utf-8"?>\n')
        handle.write(f"<testsuites name={quoteattr(_text(results.course.id))}>\n".encode())
        for effective in (item for item in selection.each() if not (item.missing or item.waiting)):
            handle.write(ET.tostring(suite(effective), encoding="utf-8", xml_declaration=False) + b"\n")
        handle.write(b"</testsuites>\n")
    selection.written.paths.append(path)
    return selection.written


def suite(effective: Effective) -> ET.Element:
    verdict = effective.verdict
    checks = checks_for_student(verdict)
    cases = [_case(effective, check) for check in checks]
    problem = problem_for_student(verdict)
    if problem is not None:
        case = ET.Element("testcase", {"name": "submission", "classname": _text(effective.exercise)})
        attributes = {"message": _text(problem.message), "type": _text(problem.code)}
        ET.SubElement(case, "error", attributes).text = _text(problem.help)
        cases.append(case)
    kinds = [child.tag for case in cases for child in case]
    element = ET.Element(
        "testsuite",
        {
            "name": _text(f"{effective.student} / {effective.exercise}"),
            "tests": str(len(cases)),
            "failures": str(kinds.count("failure")),
            "errors": str(kinds.count("error")),
            "skipped": str(kinds.count("skipped")),
            "time": f"{sum(check.duration_ms for check in checks) / 1e3:.3f}",
            "timestamp": effective.result.graded_at.removesuffix("Z"),
        },
    )
    properties = ET.SubElement(element, "properties")
    for name, value in _facts(effective).items():
        ET.SubElement(properties, "property", {"name": name, "value": _text(value)})
    element.extend(cases)
    return element


def _facts(effective: Effective) -> dict[str, str]:
    override = effective.override
    facts = {
        "student": effective.student,
        "exercise": effective.exercise,
        "score": number(effective.score),
        "max_score": number(effective.max_score),
        "raw_score": number(effective.raw_score),
        "late_penalty": number(effective.penalty),
        "late_s": "" if effective.late is None else f"{effective.late:.0f}",
        "override": override.reason if override else "",
        "isolation": effective.verdict.isolation,
    }
    return {name: value for name, value in facts.items() if value}


def _case(effective: Effective, check: CheckResult) -> ET.Element:
    names = {"name": _text(check.id), "classname": _text(f"{effective.exercise}.{check.task}")}
    element = ET.Element("testcase", {**names, "time": f"{check.duration_ms / 1e3:.3f}"})
    if check.status is Status.PASS:
        return element
    words = "\n".join(part for part in (check.title, check.message, check.help, check.diagnosis) if part)
    kind = {Status.FAIL: "failure", Status.SKIP: "skipped"}.get(check.status, "error")
    attributes = {"message": _text(check.message), "type": _text(check.diagnosis or check.status.value)}
    ET.SubElement(element, kind, attributes).text = _text(words)
    if check.stdout:
        ET.SubElement(element, "system-out").text = _text(check.stdout)
    return element


def _text(text: str) -> str:
    """Text that XML can hold; other characters, and control characters, are spelled out."""
    lines = _IMPOSSIBLE.sub(lambda match: one_line(match[0]), text).split("\n")
    return "\n".join(one_line(line) for line in lines)


def _html(target: Path, results: Results, options: ExportOptions) -> Written:
    # Its templates load with it, and most commands of a class write none.
    from course.grading.exports.html_report.pages import write_html

    return write_html(target, results, options)


# ---

#: name -> the name of its file in OUT, and the function that writes it.
FORMATS: dict[str, tuple[str, Writer]] = {
    "csv": ("grades.csv", partial(_plain, lines=False)),
    "jsonl": ("results.jsonl", partial(_plain, lines=True)),
    "junit": ("junit.xml", write_junit),
    "gradescope": ("gradescope", write_gradescope),
    "canvas": ("canvas.csv", write_canvas),
    "moodle": ("moodle.csv", write_moodle),
    "moodle-worksheet": ("moodle-worksheet.csv", write_worksheet),
    "html": ("report.html", _html),
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
        UsageError: there is no such format, it needs something that was not given, or the file is another
            format's.
        MissingCapabilityError: students are missing in the roster, or it cannot be written.
    """
    if name not in FORMATS:
        message = f"--format is {name!r}."
        raise UsageError(message, help=f"It takes {', '.join([*FORMATS, AUTOGRADER])}.", code="usage")
    usual, write = FORMATS[name]
    if target is None:
        # The run's own file there is about the whole class, and stays so.
        part = name in _OF_A_RUN and is_part(results, options)
        target = out / "part" / usual if part else out / usual
    for file, other in (*((FORMATS[one][0], one) for one in sorted(_OF_A_RUN)), ("students.csv", "html")):
        if other != name and target.resolve() == (out / file).resolve():
            message = f"{target} is the run's own file (--format {other}). Nothing was written."
            raise UsageError(message, help="Name another file with -o PATH.", code="out_exists")
    return write(target, results, options)
