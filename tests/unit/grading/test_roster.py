"""The roster is the spine: every enrolled student has a row, whoever's file says who is enrolled."""

import csv
import unicodedata

import pytest

from course.errors import MissingCapabilityError, UsageError
from course.grading.exports.formats import export
from course.grading.exports.selection import ExportOptions
from course.grading.gradebook.records import PlatformIdentity
from course.grading.results.effective import lift, override
from course.grading.results.roster import Person, read_roster
from course.grading.running.folder import open_results
from course.grading.running.run import RunOptions
from tests.unit.grading.made import graded_class, put, read_csv, roster_of
from tests.unit.grading.pages import faults, read_page
from tests.unit.grading.running.test_run import right

pytestmark = pytest.mark.usefixtures("unpacked")

CANVAS = """\
Student,ID,SIS User ID,SIS Login ID,Section,Doubling (4711),Current Score
,,,,,Manual Posting,
    Points Possible,,,,,10,(read only)
"Lovelace, Ada",101,S1,ada,A,,
"O'Neil, Bob",102,S2,bob,B,,
"Hopper, Grace",103,S3,grace,A,,
"Student, Test",999,,x,A,,
"""
MOODLE = """\
Identifier,Full name,Email address,Status,Grade,Maximum Grade,Grade can be changed,Feedback comments
Participant 101,Ada Lovelace,ada@x.org,Submitted for grading,,100.00,Yes,
Participant 102,Bob O'Neil,bob@x.org,No submission,,100.00,Yes,
Participant 103,Grace Hopper,grace@x.org,Submitted for grading,,100.00,Yes,
"""
GRADESCOPE = """\
First Name,Last Name,SID,Email,Role,Sections
Ada,Lovelace,S1,ada@x.org,Student,A
Bob,O'Neil,S2,bob@x.org,Student,B
Grace,Hopper,S3,grace@x.org,Student,A
Alan,Turing,,alan@x.org,Instructor,
"""
OURS = "student,name,email\nada,Ada Lovelace,ada@x.org\nbob,Bob O'Neil,\ngrace,Grace Hopper,\n"


def made(folder):
    """A class of three in which the second handed in nothing, and its roster."""
    for name in ("ada", "grace"):
        put(folder / "class" / name / "doubling.py", b"def double(x):\n    return 2 * x\n")
    path = folder / "roster.csv"
    path.write_text(OURS, "utf-8-sig")
    return folder / "class", path


def graded(folder, catalog):
    _, roster = made(folder)
    options = RunOptions(exercises=("doubling",), seed=1, roster=read_roster(roster))
    return folder / "out", graded_class(folder, catalog, options, grade=right)


def rows(path):
    return {row["student"]: row for row in read_csv(path)}


def test_who_is_missing_has_a_row_and_a_page_too(tmp_path, catalog):
    out, summary = graded(tmp_path, catalog)
    assert (summary.missing, summary.strangers, summary.exit_code) == (["bob"], [], 0)
    found = rows(out / "grades.csv")
    assert {name: (row["state"], row["score"], row["reason"]) for name, row in found.items()} == {
        "ada": ("graded", "10", ""), "bob": ("missing", "", "not_submitted"), "grace": ("graded", "10", ""),
    }  # fmt: skip
    listed = read_page(out / "students.html").tables["Students and their scores"]
    assert next(row for row in listed if row[1] == "bob")[-1] == "none missing"
    report = read_page(out / "report.html")
    assert "2 of 2; 1 missing" in str(report.tables["Results and scores"])
    for page in (report, *map(read_page, (out / "students").iterdir())):
        assert faults(page, scripted=page is report) == []


def test_an_override_settles_what_is_missing(tmp_path, catalog):
    out, _ = graded(tmp_path, catalog)
    with open_results(out, writing=True) as results:
        assert override(results, "bob", "doubling", 7.0, "oral exam").score == 7.0
    found = rows(out / "grades.csv")
    assert (found["bob"]["score"], found["bob"]["override_reason"]) == ("7", "oral exam")
    with open_results(out) as results:
        assert len(list(results.all())) == 3
        assert not any(item.missing for item in results.all())
        assert [item.student for item in results.all("bob")] == ["bob"]
    with open_results(out, writing=True) as results:
        lift(results, "bob", "doubling", "")
    assert rows(out / "grades.csv")["bob"]["state"] == "missing"


def test_two_spellings_of_an_accent_are_one_student(tmp_path, catalog):
    name = "zoé"
    put(tmp_path / "class" / unicodedata.normalize("NFD", name) / "doubling.py", b"double = abs\n")
    roster = roster_of(tmp_path, f"student\n{unicodedata.normalize('NFC', name)}\n")
    options = RunOptions(exercises=("doubling",), seed=1, roster=roster)
    summary = graded_class(tmp_path, catalog, options, grade=right)
    assert (summary.missing, summary.strangers) == ([], [])


#: Headings, "Points Possible", a student and the student for tests, as Canvas' options change them.
CANVAS_FORMS = {
    "names apart": [
        ["LastName", "FirstName", "ID", "SIS Login ID", "Section", "Notes", "Doubling (4711)", "Final Grade"],
        ["    Points Possible", "", "", "", "", "(read only)", "10.00", "(read only)"],
        ["Lovelace", "Ada", "101", "ada", "A", "", "", "F"],
        ["Student", "Test", "999", "x", "A", "", "", ""],
    ],
    "all ids": [
        ["Student", "ID", "SIS User ID", "SIS Login ID", "Integration ID", "Root Account", "Section", "A"],
        ["", "", "", "", "", "", "", "Manual Posting (scores hidden from instructors)"],
        ["    Points Possible", "", "", "", "", "", "", "10.00"],
        ["Lovelace, Ada", "101", "", "ada", "i7", "x.org", "A", ""],
    ],
}  # fmt: skip


#: Roster -> what a plain folder may be called for the first student of it.
FOLDERS = {
    "canvas": (CANVAS, ["101", "S1", "ada", "Lovelace, Ada", "ada  LOVELACE"]),
    "moodle": (
        MOODLE.replace("Email address", "Username,ID number,Email address").replace("ada@", "AL,M1,ada@")
        .replace("bob@", ",,bob@").replace("grace@", ",,grace@"),
        ["101", "al", "M1", "Ada@x.org", "Ada Lovelace"],
    ),
    "gradescope": (GRADESCOPE, ["S1", "ada@x.org", "Ada Lovelace"]),
    "ours": (OURS, ["ada", "ADA@x.org", "Ada Lovelace"]),
}  # fmt: skip


@pytest.mark.parametrize("kind", FOLDERS)
def test_a_plain_folder_is_found_by_whatever_is_in_one_row_alone(tmp_path, kind):
    text, names = FOLDERS[kind]
    found = roster_of(tmp_path, text)
    assert {name: found.find(name) for name in names} == dict.fromkeys(names, found.people[0])
    assert [found.find(name) for name in ("Lovel", "lovelace", "x.org", "")] == [None] * 4


def test_a_plain_folder_that_two_rows_could_mean_is_nobody(tmp_path):
    text = "student,name,login\n1,Ada Lovelace,al\n2,Ada Lovelace,ada\n3,ada,x\n4,al,5\n"
    found = roster_of(tmp_path, text)
    assert [found.find(name) for name in ("Ada Lovelace", "ada", "al")] == [None] * 3
    assert found.find("5") == found.people[3]
    matched, why = found.match(["3", "x", "ada", "eve"], {})
    assert (matched, why) == (
        {}, {"3": "In one row with 'x'", "ada": "In 2 rows", "eve": "In no row", "x": "In one row with '3'"},
    )  # fmt: skip


def test_who_is_in_no_row_is_told_which_columns_were_tried(tmp_path, catalog):
    submissions, roster = made(tmp_path)
    roster.write_text(CANVAS, "utf-8")
    options = RunOptions(exercises=("doubling",), seed=1, roster=read_roster(roster))
    (submissions / "grace").rename(submissions / "hopper")
    summary = graded_class(tmp_path, catalog, options, grade=right)
    tried = (
        "roster.csv has the columns Student, ID, SIS User ID, SIS Login ID, Section, Doubling (4711), "
        "Current Score. The name of a folder was looked for in ID, SIS User ID, SIS Login ID, Student; it "
        "has to be in exactly one row."
    )
    assert (summary.strangers, summary.compared) == (["hopper"], tried)
    assert summary.missing == ["oneilbob_102", "hoppergrace_103"]
    assert rows(tmp_path / "out" / "grades.csv")["hopper"]["state"] == "graded"
    asked = ExportOptions(assignments={"doubling": "4711"})
    with open_results(tmp_path / "out") as results:
        results.roster = read_roster(roster)
        with pytest.raises(MissingCapabilityError) as stopped:
            export(results, "canvas", tmp_path, None, asked)
    assert stopped.value.message == (
        f"roster.csv has no usable row for 1 student. In no row: 'hopper'. {tried} Nothing was written."
    )
    assert "the columns student (the name in the gradebook) and canvas_id" in stopped.value.help


def test_a_download_is_told_which_of_its_keys_was_looked_for(tmp_path):
    found = roster_of(tmp_path, MOODLE)
    downloads = {"Eve_7": PlatformIdentity("moodle", "7", "Eve"), "101": PlatformIdentity("canvas", "101")}
    assert found.compared(["Eve_7"], downloads).endswith(
        "The Moodle id of a submission was looked for in Identifier, Full name; it has to be in exactly one "
        "row."
    )
    assert "The Canvas id of a submission is in none of these." in found.compared(["101"], downloads)


@pytest.mark.parametrize("delimiter", [",", ";"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
@pytest.mark.parametrize("form", CANVAS_FORMS)
def test_every_form_of_canvas_gradebook_is_read(tmp_path, form, encoding, delimiter):
    """Names in one column or two, ids as far as they are shown, cells parted as the user's language does it.

    Source: canvas-lms/lib/gradebook_exporter.rb, ``csv_data``; canvas-lms/lib/csv_with_i18n.rb,
    ``determine_column_separator`` and ``include_bom?``.
    """
    path = tmp_path / "roster.csv"
    with path.open("w", encoding=encoding, newline="") as handle:
        csv.writer(handle, delimiter=delimiter).writerows(CANVAS_FORMS[form])
    assert read_roster(path).people == (
        Person("lovelaceada_101", "Lovelace, Ada", canvas_id="101", section="A", login="ada"),
    )


def test_what_platforms_hand_out_is_read_unchanged(tmp_path):
    """Gradescope's needs a name, in one column or two, and an e-mail; ids, sections and roles are optional.

    Source: Gradescope help, "Adding Students and Staff"; canvas-lms/lib/gradebook_exporter.rb;
    moodle/mod/assign/gradingtable.php.
    """
    canvas = roster_of(tmp_path, f"\ufeff{CANVAS}")
    assert [person.sis_user_id for person in canvas.people] == ["S1", "S2", "S3"]
    found = roster_of(tmp_path, MOODLE)
    assert found.people[0] == Person("Ada Lovelace_101", "Ada Lovelace", "ada@x.org", moodle_key="101")
    assert found.find("whatever", PlatformIdentity("moodle", "103", "?")) == found.people[2]
    assert [person.student for person in roster_of(tmp_path, GRADESCOPE).people] == ["S1", "S2", "S3"]
    (ada,) = roster_of(tmp_path, "Name,Email\nAda Lovelace,ada@x.org\n").people
    assert ada == Person("ada@x.org", "Ada Lovelace", "ada@x.org")


def test_an_empty_folder_is_missing_without_a_roster_too(tmp_path, catalog):
    submissions, _ = made(tmp_path)
    (submissions / "eva").mkdir()
    options = RunOptions(seed=1)
    summary = graded_class(tmp_path, catalog, options, grade=right)
    assert (summary.missing, summary.exit_code) == (["eva"], 0)
    found = rows(tmp_path / "out" / "grades.csv")
    assert {name: row["state"] for name, row in found.items()} == {
        "ada": "graded", "eva": "missing", "grace": "graded",
    }  # fmt: skip
    (submissions / "eva" / "doubling.py").write_text("double = abs\n")
    again = RunOptions(resume=True)
    summary = graded_class(tmp_path, catalog, again, grade=right)
    assert (summary.missing, rows(tmp_path / "out" / "grades.csv")["eva"]["state"]) == ([], "graded")
    with open_results(tmp_path / "out") as results:
        (noted,) = results.book.journal()
    assert (noted.student, noted.kind, "missing" in noted.before) == ("eva", "resume", True)


# -- a file of an instructor's own ------------------------------------------------------------------------


def test_a_roster_is_read_with_quotes_marks_and_any_alphabet(tmp_path):
    text = '\ufeffname,student,canvas_id\r\n"漢字, é ""x""\nline two",=ada,42\r\n'
    (person,) = roster_of(tmp_path, text).people
    assert (person.student, person.name, person.canvas_id) == ("=ada", '漢字, é "x"\nline two', "42")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("name\nada\n", "no heading 'student'"),
        ("student,grade\nada,1\n", "'grade'"),
        ("student,student\nada,1\n", "two columns"),
        ("student,name\nada\n", "line 2"),
        ("student,name\nada,x,y\n", "line 2"),
        ("student,name\n,x\n", "line 2: it names no student"),
        ("student,canvas_id\nada,4a\n", "canvas_id '4a'"),
        ("student,extension_days\nada,two\n", "extension_days"),
        ("student,extension_days\nada,nan\n", "extension_days"),
        ("student\nada\nada\n", "student 'ada' is in two rows, on lines 2 and 3"),
        ("student,canvas_id\nada,1\nbob,1\n", "canvas_id '1' is in two rows"),
        ('student\nbob\n"ada\n', "line 3: "),
        ("", "first row is empty"),
        ("Student,ID\nAda,abc\n", "line 2: ID 'abc' is not a number"),
        ("Identifier,Full name\nsomebody,Ada\n", "line 2: Identifier 'somebody' ends in no number"),
        ("Full name,Grade\nAda,1\n", "no heading 'student'"),
        ("Student,ID\nAda,1,2\n", "another number of cells"),
        ("Student,ID\nAda,7\nBob,7\n", "canvas_id '7' is in two rows"),
    ],
)
def test_what_is_no_roster_is_refused_with_the_row(tmp_path, text, reason):
    with pytest.raises(UsageError) as caught:
        roster_of(tmp_path, text)
    assert caught.value.code == "invalid_roster"
    assert reason in caught.value.message


def test_a_space_at_the_end_of_an_id_is_nobody_s_name_unless_a_folder_has_it(tmp_path):
    roster = roster_of(tmp_path, "student,name\n ada ,Ada\nbob,Bob\nbob ,Robert\n")
    names = {
        name: [row.name for row in roster.rows(name)] for name in ("ada", " ada ", "bob", "bob ", " bob")
    }
    assert names == {
        "ada": ["Ada"], " ada ": ["Ada"], "bob": ["Bob"], "bob ": ["Robert"], " bob": ["Bob", "Robert"],
    }  # fmt: skip


def test_students_are_found_by_id_and_never_guessed(tmp_path):
    roster = roster_of(
        tmp_path,
        "student,name,email,canvas_id,sis_user_id,moodle_key\n"
        "a1,Ada  LOVELACE,ada@x.org,11,s1,m1\nb1,Bob,b@x.org,12,s2,m2\nb2,Bob,c@x.org,13,s3,m3\n",
    )
    downloads = {
        "lovelace_11": PlatformIdentity("canvas", "11", "lovelace"),
        "Ada Lovelace_900": PlatformIdentity("moodle", "900", "Ada Lovelace"),
        "Bob_901": PlatformIdentity("moodle", "901", "Bob"),
        "s2": PlatformIdentity("gradescope", "s2", "Bob", "", "s2"),
        "Bob": PlatformIdentity("gradescope", "c@x.org", "Bob", "C@x.org", ""),
    }
    assert roster.find("a1").student == "a1"
    names = {name: roster.find(name, who) for name, who in downloads.items()}
    assert {name: found and found.student for name, found in names.items()} == {
        "lovelace_11": "a1", "Ada Lovelace_900": "a1", "Bob_901": None, "s2": "b1", "Bob": "b2",
    }  # fmt: skip
