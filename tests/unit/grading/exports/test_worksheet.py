"""Moodle's grading worksheet, read, filled in, and read back by Moodle's rules."""

import csv
import io
import shutil

import pytest

from course.errors import UsageError
from course.grading.exports.formats import export
from course.grading.exports.selection import ExportOptions
from course.grading.results.effective import override
from course.grading.results.roster import read_roster
from course.grading.running.folder import open_results
from course.grading.running.run import RunOptions
from tests.unit.grading.made import graded_class, put, read_by_php
from tests.unit.grading.running.test_run import right

HEADINGS = [
    "Identifier", "Full name", "Email address", "Status", "Grade", "Maximum Grade", "Grade can be changed",
    "Last modified (submission)", "Last modified (grade)", "Feedback comments",
]  # fmt: skip
SHEET = [
    ["Participant 101", "Ada Lovelace", "ada@x.org", "Submitted", "", "100.00", "Yes", "-", "-", ""],
    ["Participant 102", "=Bob", "bob@x.org", "No submission", "", "100.00", "Yes", "-", "-", "See me, Bob"],
    ["Participant 103", "Grace Hopper", "g@x.org", "Submitted", "7", "100.00", "No", "-", "-", "Done"],
    ["Participant 104", "Cy É", "cy@x.org", "Submitted", "", "100.00", "Yes", "-", "Sunday, 1 March", ""],
]


def write(path, rows, headings=HEADINGS):
    text = io.StringIO(newline="")
    csv.writer(text).writerows([headings, *rows])
    path.write_bytes(text.getvalue().encode())
    return path


def cells_of(path):
    return list(csv.reader(io.StringIO(path.read_bytes().decode(), newline="")))


def taken_by_moodle(path, most):
    """Grades and feedback that Moodle takes out of a worksheet, after its own reader.

    The three columns must be there and all rows be as long as the first; a row is found by what follows the
    word "Participant"; a grade that is empty, out of range or locked is left; feedback is taken as it is.

    Source: moodle/mod/assign/feedback/offline: importgradeslib.php, ``init`` and ``next``; locallib.php,
    ``process_import_grades``; moodle/lib/csvlib.class.php, ``load_csv_content``.
    """
    head, *rows = read_by_php(path.read_bytes().decode("utf-8"))
    assert {"Identifier", "Grade", "Last modified (grade)"} <= set(head)
    assert {len(row) for row in rows} == {len(head)}
    found = {}
    for row in (dict(zip(head, cells, strict=True)) for cells in rows):
        assert row["Identifier"].startswith("Participant ")
        number = row["Identifier"][len("Participant ") :]
        text = row["Grade"].strip().replace(",", ".")
        grade = float(text) if text else None
        valid = grade is not None and 0 <= grade <= most
        locked = row.get("Grade can be changed") == "No"
        found[number] = (grade if valid and not locked else None, row.get("Feedback comments", ""))
    return found


@pytest.fixture(scope="module")
def out(tmp_path_factory, catalog):
    folder = tmp_path_factory.mktemp("moodle")
    for name in ("Ada Lovelace_101", "Grace Hopper_103", "Cy É_104"):
        module = "doubling.py" if name != "Cy É_104" else "hw.py"
        place = folder / "class" / f"{name}_assignsubmission_file"
        put(place / module, b"def double(x):\n    return 2 * x\n")
    roster = read_roster(write(folder / "sheet.csv", SHEET))
    options = RunOptions(exercises=("doubling",), seed=1, roster=roster)
    summary = graded_class(folder, catalog, options, grade=right)
    assert summary.missing == ["=Bob_102"]
    return folder / "out"


def filled(out, sheet, to, **more):
    with open_results(out) as results:
        options = ExportOptions(worksheet=sheet, zeros=True, **more)
        return export(results, "moodle-worksheet", out, to, options)


def test_it_is_filled_in_and_everything_else_is_as_it_came(tmp_path, out):
    """Columns, their order and every cell but two are Moodle's, and who has no grade of ours keeps both.

    Source: moodle/mod/assign/gradingtable.php, the columns of a download; MoodleDocs, "Using Assignment",
    "Offline grading worksheet".
    """
    sheet = write(tmp_path / "sheet.csv", SHEET)
    written = filled(out, sheet, tmp_path / "back.csv")
    assert (written.rows, written.paths) == (2, [tmp_path / "back.csv"])
    assert any("cannot be changed" in note for note in written.notes)
    rows = cells_of(tmp_path / "back.csv")
    assert rows[0] == HEADINGS
    for before, after in zip(SHEET, rows[1:], strict=True):
        kept = [at for at in range(len(HEADINGS)) if HEADINGS[at] not in {"Grade", "Feedback comments"}]
        assert [after[at] for at in kept] == [before[at] for at in kept]
    assert rows[2] == SHEET[1], "who is missing keeps the teacher's feedback"
    assert rows[3] == SHEET[2]
    taken = taken_by_moodle(tmp_path / "back.csv", 100.0)
    assert {number: grade for number, (grade, _) in taken.items()} == {
        "101": 100.0, "102": None, "103": None, "104": 0.0,
    }  # fmt: skip
    assert taken["101"][1].startswith("10 of 10 points.")
    assert "There is no doubling.py" in taken["104"][1]
    # Read back as a roster: the same people.
    assert read_roster(tmp_path / "back.csv").people == read_roster(sheet).people


def test_a_worksheet_that_a_spreadsheet_saved_with_semicolons_goes_back_with_commas(tmp_path, out):
    """Moodle's form for it asks for no separator, and its reader takes commas."""
    text = io.StringIO(newline="")
    csv.writer(text, delimiter=";").writerows([HEADINGS, *SHEET])
    (tmp_path / "sheet.csv").write_text(text.getvalue(), "utf-8-sig")
    filled(out, tmp_path / "sheet.csv", tmp_path / "back.csv")
    assert taken_by_moodle(tmp_path / "back.csv", 100.0)["101"][0] == 100.0


@pytest.mark.parametrize("reason", ['said "x\\"', "a path, C:\\"])
def test_feedback_with_backslashes_is_one_cell_to_moodle(tmp_path, out, reason):
    """A cell that ended in a backslash took the next one with it, and Moodle refused the whole file."""
    shutil.copytree(out, tmp_path / "out")
    with open_results(tmp_path / "out", writing=True) as results:
        override(results, "Ada Lovelace_101", "doubling", 7.0, reason)
    filled(tmp_path / "out", write(tmp_path / "sheet.csv", SHEET), tmp_path / "back.csv")
    grade, feedback = taken_by_moodle(tmp_path / "back.csv", 100.0)["101"]
    assert grade == 70.0
    assert feedback.replace("\\ ", "\\").endswith(reason)


def test_missing_work_is_a_zero_only_as_told(tmp_path, out):
    sheet = write(tmp_path / "sheet.csv", SHEET)
    filled(out, sheet, tmp_path / "kept.csv", missing="zero")
    assert taken_by_moodle(tmp_path / "kept.csv", 100.0)["102"] == (None, "See me, Bob")
    filled(out, sheet, tmp_path / "zero.csv", missing="zero", overwrite=True)
    assert taken_by_moodle(tmp_path / "zero.csv", 100.0)["102"][0] == 0.0


def with_cells(grade, feedback):
    """The sheet as a teacher may have left it, with something in Ada's row."""
    return [[*SHEET[0][:4], grade, *SHEET[0][5:9], feedback], *SHEET[1:]]


@pytest.mark.parametrize(
    ("grade", "feedback"),
    [("55.00", "Seen in the oral: fine"), ("55,0", ""), ("", "See me"), ("100", "See me")],
)
def test_a_teachers_grade_and_feedback_stay_and_are_listed(tmp_path, out, grade, feedback):
    sheet = write(tmp_path / "sheet.csv", with_cells(grade, feedback))
    written = filled(out, sheet, tmp_path / "back.csv")
    rows = cells_of(tmp_path / "back.csv")
    assert rows[1] == with_cells(grade, feedback)[0]
    assert len(written.kept) == 1
    assert written.kept[0].startswith("Ada Lovelace_101 (")
    (said,) = [note for note in written.notes if "already" in note]
    assert all(cell in said for cell in ("--overwrite", grade, feedback))
    replaced = filled(out, sheet, tmp_path / "new.csv", overwrite=True)
    assert replaced.kept == []
    assert taken_by_moodle(tmp_path / "new.csv", 100.0)["101"][0] == 100.0


def test_a_sheet_that_has_our_own_grades_is_filled_in_again(tmp_path, out):
    """Moodle gives back what was uploaded, with two digits after the point."""
    filled(out, write(tmp_path / "sheet.csv", SHEET), tmp_path / "back.csv")
    head, *rows = cells_of(tmp_path / "back.csv")
    rows = [[*row[:4], row[4] and f"{float(row[4]):.2f}", *row[5:]] for row in rows]
    written = filled(out, write(tmp_path / "again.csv", rows, head), tmp_path / "twice.csv")
    assert (written.rows, written.kept) == (2, [])


@pytest.mark.parametrize(
    ("heading", "most", "grade"),
    [
        ("Maximum Grade", "12,50", "12,5"),
        ("Maximum grade", "12.50", "12.5"),
        ("maximum grade", "12.50", "12.5"),
        pytest.param(" MAXIMUM GRADE ", "12.50", "12.5", id="capitals and spaces"),
    ],
)
def test_the_grade_is_on_moodles_scale_with_its_comma_whatever_the_letter_case_of_the_heading(
    tmp_path, out, heading, most, grade
):
    """Source: moodle/mod/assign/lang/en/assign.php, ``maxgrade``."""
    at = HEADINGS.index("Maximum Grade")
    rows = [[*row[:at], most, *row[at + 1 :]] for row in SHEET]
    sheet = write(tmp_path / "s.csv", rows, [*HEADINGS[:at], heading, *HEADINGS[at + 1 :]])
    written = filled(out, sheet, tmp_path / "back.csv")
    head, ada, *_ = cells_of(tmp_path / "back.csv")
    assert head[at] == heading, "as it came"
    assert ada[4] == grade
    assert taken_by_moodle(tmp_path / "back.csv", 12.5)["101"][0] == 12.5
    assert not [note for note in written.notes if "no maximum" in note]


def test_scores_that_no_maximum_scales_are_named(tmp_path, out):
    at = HEADINGS.index("Maximum Grade")
    empty = [[*row[:at], "" if row is SHEET[0] else row[at], *row[at + 1 :]] for row in SHEET]
    written = filled(out, write(tmp_path / "s.csv", empty), tmp_path / "back.csv")
    assert [note for note in written.notes if "no maximum grade for 1 row: the scores of doubling" in note]
    without = [[*row[:at], *row[at + 1 :]] for row in SHEET]
    sheet = write(tmp_path / "s.csv", without, [*HEADINGS[:at], *HEADINGS[at + 1 :]])
    written = filled(out, sheet, tmp_path / "back.csv")
    assert [note for note in written.notes if "no maximum grade for 2 rows" in note], written.notes


def test_an_anonymous_worksheet_calls_its_rows_as_the_download_calls_its_folders(tmp_path):
    rows = [[row[0], *row[3:]] for row in SHEET]
    people = read_roster(write(tmp_path / "s.csv", rows, [HEADINGS[0], *HEADINGS[3:]])).people
    assert [person.student for person in people] == [f"Participant_{number}" for number in range(101, 105)]


@pytest.mark.parametrize(
    ("headings", "rows", "words"),
    [
        ([*HEADINGS[:8], "Changed", "Feedback comments"], SHEET, "no column 'Last modified (grade)'"),
        (HEADINGS, [[*SHEET[0][:5], "Scale", *SHEET[0][6:]]], "maximum grade is 'Scale'"),
        (HEADINGS, [SHEET[0][:-1]], "another number of cells"),
    ],
)
def test_what_moodle_would_not_take_back_is_refused(tmp_path, out, headings, rows, words):
    sheet = write(tmp_path / "s.csv", rows, headings)
    with pytest.raises(UsageError, match=words.replace("(", r"\(").replace(")", r"\)")):
        filled(out, sheet, tmp_path / "back.csv", partial=True)
    assert not (tmp_path / "back.csv").exists()
