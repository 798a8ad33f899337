"""Every export, read back by somebody else's reader, with the names nobody should have."""

import csv
import dataclasses
import io
import json
import re
from pathlib import Path
from xml.etree import ElementTree as ET

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.errors import MissingCapabilityError, NotFoundError, UsageError
from course.grading.exports.formats import FORMATS, export
from course.grading.exports.grades import is_safe, number, replacing, safe_cell, utc
from course.grading.exports.selection import ExportOptions
from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.records import Override, SubmittedAt
from course.grading.results.effective import Results
from course.grading.results.roster import Column, Person, Roster
from tests.unit.grading.made import (
    BROKEN,
    HALF,
    HOSTILE,
    REFUSED,
    RIGHT,
    SECRET,
    digest,
    make_book,
    read_by_php,
    read_csv,
)
from tests.unit.grading.test_results import DAY, DUE, POLICY

JUNIT = Path(__file__).resolve().parents[3] / "fixtures" / "junit.xsd"
OPTIONS = ExportOptions(("doubling",), {"doubling": "4711"}, zeros=True)
#: Values of hidden checks, in every spelling a file may have them.
SECRETS = [str(SECRET), str(SECRET * 2), str(SECRET)[:6]]


def everybody(folder, names=HOSTILE, **more):
    """The gradebook of a class with every name, every state, an override and somebody late; it is open."""
    verdicts = {name: (RIGHT, HALF, REFUSED)[at % 3] for at, name in enumerate(names)}
    book = make_book(folder, verdicts | {"late": RIGHT, "set": HALF, "broken": BROKEN} | more)
    book.add_override(Override("set", "doubling", 8.25, 'said "=1+1", <b>then</b> left\nearly'))
    at = DUE.timestamp() + 2 * DAY
    book.add_times([SubmittedAt("late", "doubling", digest("late"), "gradescope", at)])
    book.set_meta(late_policy=POLICY)
    return book


@pytest.fixture(scope="module")
def class_of_everybody(tmp_path_factory):
    out = tmp_path_factory.mktemp("exports")
    everybody(out).close()
    return out


@pytest.fixture
def results(class_of_everybody):
    results = Results(Gradebook(class_of_everybody / "gradebook.sqlite"))
    results.roster = Roster(
        tuple(
            Person(name, name, f"{at}@x.org", str(100 + at), f"sis-{at}", "A", f"key{at}")
            for at, name in enumerate([*HOSTILE, "late", "set", "broken"])
        )
    )
    yield results
    results.book.close()


def write(results, name, tmp_path, options=OPTIONS):
    written = export(results, name, tmp_path, None, options)
    assert written.rows == len(HOSTILE) + 3
    assert written.without_grade == ["broken doubling"]
    usual = FORMATS[name][0]
    part = tmp_path / "part" / usual
    return part if part.exists() else tmp_path / usual


def is_formula(cell):
    return cell.startswith(("=", "+", "-", "@", "\uff1d")) and not re.fullmatch(r"-[0-9]+([.,][0-9]+)?", cell)


def test_the_table_has_a_row_for_everybody_and_no_formula(results, tmp_path):
    path = write(results, "csv", tmp_path)
    rows = read_csv(path)
    assert len(rows) == len({row["student"] for row in rows}) == len(HOSTILE) + 3
    everywhere = [cell for row in rows for cell in row.values()]
    assert not [cell for cell in everywhere if is_formula(cell)]
    assert all(cell.isprintable() for cell in everywhere)
    by_name = {row["student"]: row for row in rows}
    assert by_name["late"] | {"graded_at": ""} == by_name["late"] | {
        "graded_at": "", "score": "8", "raw_score": "10", "late_penalty": "2", "late_s": "172800",
        "passed": "yes", "submitted_at": "2026-12-03T23:59:00Z",
    }  # fmt: skip
    assert (by_name["set"]["score"], by_name["set"]["raw_score"]) == ("8.25", "5")
    assert by_name["set"]["override_reason"] == 'said "=1+1", <b>then</b> left\\nearly'
    assert (by_name["broken"]["score"], by_name["broken"]["state"]) == ("", "grader_error")
    refused = by_name[safe_cell(HOSTILE[2])]
    assert [refused[name] for name in ("state", "reason", "score", "passed")] == [
        "ungradable", "no_file", "0", "no",
    ]  # fmt: skip
    assert by_name["é漢字"]["name"] == "é漢字"
    assert by_name["é漢字"]["email"].endswith("@x.org")


def test_the_lines_of_json_have_the_very_ids(results, tmp_path):
    lines = [json.loads(line) for line in write(results, "jsonl", tmp_path).read_bytes().splitlines()]
    by_name = {line["student"]: line for line in lines}
    assert by_name.keys() == {*HOSTILE, "late", "set", "broken"}
    assert (by_name["late"]["late"], by_name["late"]["late_penalty"]) == (172_800, 2)
    assert by_name["set"]["override"]["score"] == 8.25
    assert (by_name["broken"]["score"], by_name["broken"]["exit_code"]) == (None, 70)
    assert by_name["+1"]["checks"][1]["expected"] == SECRET * 2, "the instructor's file has everything"
    contract = {
        "schema", "ok", "exit_code", "course", "exercise", "scope", "score", "max_score", "passed", "checks",
        "warnings", "student", "submission_sha256", "grader_version", "isolation", "state", "late",
    }  # fmt: skip
    assert all(contract <= line.keys() for line in lines)
    assert {line["schema"] for line in lines} == {"course.grade/1"}
    refused = by_name[HOSTILE[2]]
    assert (by_name["late"]["exit_code"], by_name["late"]["ok"]) == (0, True)
    assert [refused[name] for name in ("state", "exit_code", "ok")] == ["ungradable", 3, False]
    assert refused["course"] == {"id": "mini", "version": "1"}
    assert refused["error"] == {"code": "no_file", "message": "There is none.", "help": "Hand one in."}
    check = by_name["late"]["checks"][0]
    assert set(msgspec.structs.asdict(RIGHT.checks[0])) <= check.keys() | {"stdout"}


@pytest.mark.parametrize("name", ["csv", "jsonl", "html"])
def test_a_part_never_takes_the_place_of_what_is_about_all(results, tmp_path, name):
    usual = FORMATS[name][0]
    everything = ExportOptions(zeros=True)
    assert export(results, name, tmp_path, None, everything).paths[0] == tmp_path / usual
    before = {path: path.read_bytes() for path in tmp_path.rglob("*.*")}
    roster = results.roster
    parts = ((roster.people, OPTIONS), (roster.people[1:], ExportOptions(partial=True, zeros=True)))
    for people, options in parts:
        results.roster = Roster(people)
        written = export(results, name, tmp_path, None, options)
        assert written.paths[0] == tmp_path / "part" / usual
        assert {path: path.read_bytes() for path in before} == before
    results.roster = roster
    whole = ExportOptions(partial=True, zeros=True)  # which leaves nobody out
    assert export(results, name, tmp_path, None, whole).paths[0] == tmp_path / usual
    assert export(results, name, tmp_path, tmp_path / usual, OPTIONS).paths[0] == tmp_path / usual


@pytest.mark.parametrize(
    ("name", "file"), [("csv", "results.jsonl"), ("junit", "grades.csv"), ("csv", "students.csv")]
)
def test_no_export_takes_the_place_of_what_the_run_wrote_in_another_format(results, tmp_path, name, file):
    (tmp_path / file).write_text("the run's own")
    with pytest.raises(UsageError, match="Nothing was written") as caught:
        export(results, name, tmp_path, tmp_path / "x" / ".." / file, ExportOptions(zeros=True))
    assert caught.value.code == "out_exists"
    assert (tmp_path / file).read_text() == "the run's own"


@pytest.fixture(scope="module")
def violations():
    """A validating reader: what the schema has against a file."""
    xmlschema = pytest.importorskip("xmlschema", reason="needs the extra `dev`: xmlschema is not installed")
    schema = xmlschema.XMLSchema(JUNIT)

    def found(content):
        errors = schema.iter_errors(io.BytesIO(content))
        return [f"{error.path}: {error.reason}" for error in errors]

    return found


def test_junit_fits_the_schema_whatever_the_names(results, tmp_path, violations):
    content = write(results, "junit", tmp_path).read_bytes()
    assert violations(content) == []
    # Breaking one thing is noticed: the reader reads.
    assert violations(content.replace(b'failures="', b'failures="-', 1))


def test_junit_counts_right_and_says_whose_it_is(results, tmp_path):
    content = write(results, "junit", tmp_path).read_bytes()
    suites = ET.fromstring(content).findall("testsuite")
    assert len(suites) == len(HOSTILE) + 3
    for suite in suites:
        cases = suite.findall("testcase")
        assert int(suite.get("tests", "")) == len(cases)
        assert int(suite.get("failures", "")) == len(suite.findall("testcase/failure"))
        assert int(suite.get("errors", "")) == len(suite.findall("testcase/error"))
    facts = [{item.get("name"): item.get("value") for item in suite.iter("property")} for suite in suites]
    by_name = {fact["student"]: fact for fact in facts}
    assert (by_name["late"]["score"], by_name["late"]["late_s"]) == ("8", "172800")
    assert by_name["set"]["override"].startswith('said "=1+1"')
    assert "score" not in by_name["broken"]


#: Source: Gradescope, "Autograder Specifications", "Output format" and below.
_TOP = {
    "score", "execution_time", "output", "output_format", "visibility", "stdout_visibility", "extra_data",
    "tests",
}  # fmt: skip
_TEST = {
    "score", "max_score", "status", "name", "number", "output", "output_format", "tags", "visibility",
    "extra_data",
}  # fmt: skip
_VISIBILITY = {"hidden", "after_due_date", "after_published", "visible"}
_FORMATS = {"text", "simple_format", "html", "md", "ansi"}


def test_gradescope_files_have_only_its_fields_and_say_whose_they_are(results, tmp_path):
    """A score at the top is the total; a test is passed or failed, and shown to students or not.

    Source: Gradescope, "Autograder Specifications", "Controlling Test Case Visibility", "Test case status".
    """
    folder = write(results, "gradescope", tmp_path)
    index = read_csv(folder / "index.csv")
    assert len(index) == len(HOSTILE) + 3
    assert {path.name for path in folder.iterdir()} == {"index.csv", *(row["file"] for row in index)}
    for row in index:
        body = json.loads((folder / row["file"]).read_bytes())
        assert body.keys() <= _TOP
        assert body["visibility"] in _VISIBILITY
        assert body["stdout_visibility"] in _VISIBILITY
        assert body["output_format"] in _FORMATS
        assert isinstance(body["score"], int | float)
        assert isinstance(body["execution_time"], int | float)
        for test in body["tests"]:
            assert test.keys() <= _TEST
            assert test["visibility"] in _VISIBILITY
            assert test["output_format"] in _FORMATS
            assert test["status"] in {"passed", "failed"}
            assert isinstance(test.get("number", ""), str)
            assert 0 <= test["score"] <= test["max_score"]
            assert all(isinstance(tag, str) for tag in test["tags"])
    by_name = {row["student"]: json.loads((folder / row["file"]).read_bytes()) for row in index}
    assert by_name["late"]["score"] == 8
    assert "Lateness cost 2 points." in by_name["late"]["output"]
    assert "oral" not in by_name["set"]["output"]
    assert "Score set by the instructor" in by_name["set"]["output"]
    assert [test["visibility"] for test in by_name["late"]["tests"]] == ["visible", "after_due_date"]


def taken_by_canvas(content):
    """Points of the assignments by id, and the grades of each student by ID and SIS User ID.

    Source: canvas-lms/lib/gradebook_importer.rb: ``row_has_student_headers?``, ``update_column_count``,
    ``strip_non_assignment_columns``, ``parse_assignments``, ``check_for_non_student_row``,
    ``process_student``, ``identify_delimiter``. It reads with Ruby's CSV, to which a quote after anything but
    a comma is a fault.
    """
    text = content.decode("utf-8")
    assert text.startswith(('"Student"', "Student"))
    head, *rows = csv.reader(io.StringIO(text, newline=""), strict=True)
    for line in text.split("\r\n")[:3]:  # by which it tells commas from semicolons
        assert [len(row) for row in csv.reader([line], strict=True)] == [len(head)]
    assert "Student" in head[0]
    assert "ID" in head[1]
    assert head[2:5] == ["SIS User ID", "SIS Login ID", "Section"]
    calculated = re.compile("(Current|Final) (Score|Points|Grade)|Override (Score|Grade|Status)")
    columns = {at: name for at, name in enumerate(head) if at >= 5 and not calculated.search(name)}
    ids = {at: found[1] for at, name in columns.items() if (found := re.search(r"\(([0-9]+)\)$", name))}
    assert ids.keys() == columns.keys(), "a title without an id becomes a new assignment"
    (possible,) = (row for row in rows if "Points Possible" in row[0])
    students = {}
    for row in rows:
        if row is not possible:
            assert row[1] or row[2], "found by its ID, then by its SIS ids; a name alone may be another's"
            students[row[1], row[2]] = {ids[at]: row[at].strip() for at in ids}
    assert all(re.fullmatch(r"[0-9.]*", grade) for grades in students.values() for grade in grades.values())
    return {ids[at]: possible[at] for at in ids}, students


def test_canvas_finds_its_students_and_its_assignment(results, tmp_path):
    """Name, ids and section come first, in this order; then a column for each assignment.

    Source: Canvas instructor guide, "How do I import grades in the Gradebook?"; canvas-lms/lib/
    gradebook_exporter.rb, ``csv_data``.
    """
    content = write(results, "canvas", tmp_path).read_bytes()
    points, students = taken_by_canvas(content)
    assert points == {"4711": "10"}
    assert len(students) == len(HOSTILE) + 3
    at = len(HOSTILE)
    grades = [students[str(100 + at + more), f"sis-{at + more}"]["4711"] for more in range(3)]
    assert grades == ["8", "8.25", ""], "a fault of ours is no zero"
    names = {row[1]: row[0] for row in csv.reader(io.StringIO(content.decode(), newline=""))}
    assert names["100"] == safe_cell(HOSTILE[0])


def test_a_score_that_canvas_has_is_no_zero_where_nothing_could_be_graded(results, tmp_path):
    refused = next(one for one in results.all() if one.unsettled)
    theirs = {results.person(refused.student).canvas_id: "8.5"}
    options = dataclasses.replace(OPTIONS, columns={"4711": Column("Doubling (4711)", 10.0, theirs)})
    (id_,) = theirs
    for overwrite, score in ((False, "8.5"), (True, "0")):
        written = export(
            results, "canvas", tmp_path, tmp_path / "c.csv", dataclasses.replace(options, overwrite=overwrite)
        )
        assert len(written.kept) == (not overwrite)
        (row,) = (one for one in csv.reader(io.StringIO((tmp_path / "c.csv").read_text())) if one[1] == id_)
        assert row[-1] == score


def test_moodle_finds_its_students_by_their_key(results, tmp_path):
    """One row a student, found by whatever field the teacher maps; an empty cell is no grade.

    Source: MoodleDocs, "Grade import"; moodle/grade/import/csv/classes/load_data.php, ``update_grade_item``
    and ``check_user_exists``; moodle/lib/csvlib.class.php, to which a row of another length spoils the file.
    """
    head, *rows = read_by_php(write(results, "moodle", tmp_path).read_bytes().decode("utf-8-sig"))
    assert head == ["moodle_key", "name", "email", "Doubling"]
    assert [row for row in rows if len(row) != len(head)] == []
    grades = {key: grade for key, _, _, grade in rows}
    assert [mail for _, _, mail, _ in rows if mail.endswith("@x.org")]
    assert len(grades) == len(HOSTILE) + 3
    assert grades[f"key{len(HOSTILE)}"] == "8"
    assert grades[f"key{len(HOSTILE) + 2}"] == ""
    assert all(re.fullmatch(r"[0-9.]*", grade) for grade in grades.values())


def test_moodles_grade_import_is_told_the_scale_of_its_points(results, tmp_path):
    notes = export(results, "moodle", tmp_path, tmp_path / "moodle.csv", OPTIONS).notes
    assert [note for note in notes if "points of the exercise (doubling 10)" in note], notes


def test_an_exercise_that_nobody_handed_in_has_no_column(results, tmp_path):
    everything = dataclasses.replace(OPTIONS, exercises=())
    for name in ("moodle", "canvas"):
        export(results, name, tmp_path, tmp_path / "all.csv", everything)
        assert (tmp_path / "all.csv").read_bytes() == write(results, name, tmp_path).read_bytes()


@pytest.mark.parametrize("missing", ["blank", "zero"])
@pytest.mark.parametrize("name", ["canvas", "moodle", "gradescope"])
def test_a_roster_of_another_class_writes_no_file(results, tmp_path, name, missing):
    results.roster = Roster((Person("nobody", moodle_key="7", canvas_id="7"),))
    options = dataclasses.replace(OPTIONS, partial=True, missing=missing)
    with pytest.raises(MissingCapabilityError, match="No student in the roster has a score") as caught:
        export(results, name, tmp_path, None, options)
    assert (caught.value.code, caught.value.exit_code) == ("unmatched_students", 4)
    assert "'late'" in caught.value.help or "more" in caught.value.help
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["junit", "gradescope"])
def test_what_students_may_read_has_nothing_hidden(results, tmp_path, name):
    path = write(results, name, tmp_path)
    files = [path] if path.is_file() else list(path.iterdir())
    text = "\n".join(file.read_text("utf-8-sig") for file in files)
    assert "It is not twice the number." in text
    assert not [secret for secret in SECRETS if secret in text]


@pytest.mark.parametrize("name", ["csv", "jsonl", "junit", "gradescope", "canvas", "moodle"])
def test_students_the_roster_has_not_stop_every_export_unless_partial(results, tmp_path, name):
    results.roster = Roster(tuple(person for person in results.roster.people if person.student != "late"))
    with pytest.raises(MissingCapabilityError) as caught:
        export(results, name, tmp_path, None, OPTIONS)
    assert (caught.value.code, caught.value.exit_code) == ("unmatched_students", 4)
    assert "'late'" in caught.value.message
    assert list(tmp_path.iterdir()) == []
    written = export(results, name, tmp_path, None, dataclasses.replace(OPTIONS, partial=True))
    assert written.unmatched == ["late"]
    assert written.rows == len(HOSTILE) + 2


@pytest.mark.parametrize(
    ("name", "person"),
    [
        ("canvas", Person("late")),
        ("canvas", Person("late", sis_user_id="=1+1")),
        ("moodle", Person("late")),
        ("moodle", Person("late", moodle_key="@sum")),
        ("moodle", Person("late", moodle_key="key\\")),
    ],
)
def test_a_key_that_is_missing_or_would_have_to_be_changed_is_no_key(results, tmp_path, name, person):
    others = tuple(other for other in results.roster.people if other.student != "late")
    results.roster = Roster((*others, person))
    with pytest.raises(MissingCapabilityError, match="'late'"):
        export(results, name, tmp_path, None, OPTIONS)


def test_what_a_platform_needs_is_asked_for(results, tmp_path):
    for options, code in (
        (ExportOptions(("doubling",)), "needs_assignment"),
        (ExportOptions(("doubling",), {"doubling": "4a"}), "needs_assignment"),
        (ExportOptions(("doubling", "halving"), {"doubling": "47", "halving": "47"}), "needs_assignment"),
        (ExportOptions(("nothing",)), "exercise_not_found"),
        (ExportOptions((), {"nothing": "1"}), "exercise_not_found"),
    ):
        with pytest.raises((UsageError, NotFoundError)) as caught:
            export(results, "canvas", tmp_path, None, options)
        assert caught.value.code == code
    results.roster = None
    for name in ("canvas", "moodle"):
        with pytest.raises(UsageError) as caught:
            export(results, name, tmp_path, None, OPTIONS)
        assert caught.value.code == "needs_roster"
    assert list(tmp_path.iterdir()) == []


def test_points_are_written_without_noise():
    values = [0.0, -0.0, 8.0, 33.3333333, 0.1 + 0.2, 100.0, 1234567.0, None]
    assert [number(value) for value in values] == ["0", "0", "8", "33.3333", "0.3", "100", "1234567", ""]
    assert utc(0.0) == "1970-01-01T00:00:00Z"


@given(st.text(alphabet=st.characters(exclude_categories=["Cs"])))
def test_no_text_becomes_a_formula_or_moves_the_cursor(text):
    cell = safe_cell(text)
    assert not is_formula(cell)
    assert cell.isprintable()


def test_no_two_ids_become_one_cell():
    cells = [safe_cell(name) for name in ("=1", "'=1", "''=1", "1", "-1", "'-1")]
    assert len(set(cells)) == len(cells)
    assert [is_safe(text) for text in ("x", "=x", "a\nb")] == [True, False, False]
    assert [is_safe(text) for text in ("-1.5", "-2,5", "+1", "-1+1", "-1\n")] == [
        True,
        True,
        False,
        False,
        False,
    ]


def test_a_file_that_cannot_be_finished_leaves_the_old_one(tmp_path):
    path = tmp_path / "grades.csv"
    path.write_text("old")

    def fill():
        with replacing(path) as handle:
            handle.write(b"half of the new")
            raise OSError(28, "No space left on device")

    with pytest.raises(MissingCapabilityError, match="No space left") as caught:
        fill()
    assert caught.value.exit_code == 4
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]
