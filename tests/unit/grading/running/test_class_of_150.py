"""A class of 150 as each platform hands it out: nobody refused, everybody enrolled in one row, all settled.

Of the 150, 9 handed in nothing, 12 handed in under another name or in another folder (of which 5 are taken
without a question), 2 typed text in place of a file, and 2 are anonymous. In the ordinary run graders are
stood in for; the soak run grades with real ones.
"""

import csv
from collections import Counter
from functools import partial

import pytest

from course.grading.exports.formats import export
from course.grading.exports.html_report import pages
from course.grading.exports.selection import ExportOptions
from course.grading.results.roster import read_roster
from course.grading.running.assign import assign, proposals, unsettled
from course.grading.running.batch import grade_all
from course.grading.running.folder import open_results
from course.grading.running.run import RunOptions, grade_class
from course.scoring.judging.submission import Terms
from tests.unit.grading.made import notebook, put, zipped
from tests.unit.grading.running.test_run import right
from tests.unit.grading.test_roster import rows

pytestmark = pytest.mark.usefixtures("unpacked")

#: ``double`` is right, which is 4 of 10 points, and ``doublings`` wrong; every third student has both wrong.
SOURCE = b"def double(x):\n    return 2 * x\n\ndef doublings(x, n):\n    return x\n"
WRONG = b"\ndef double(x):\n    return x\n"
EVERYBODY = range(1, 151)
NOTHING, TEXT, ANONYMOUS = range(1, 10), (20, 21), (30, 31)
NAMES = ("Ada Lovelace", "Bob O'Neil", "Zoë Müller", "Grace Hopper", "李 明")


#: Student -> what is handed in instead of ``doubling.py``; the last five are taken without a question.
ODD = {
    40: ("homework3.py", SOURCE),
    41: ("my solution.py", SOURCE),
    42: ("dubling.py", SOURCE),
    43: ("work.zip", zipped({"src/hw.py": SOURCE, "docs/notes.txt": b""})),
    44: ("work.zip", zipped({"week3/doubling.py": SOURCE, "week2/notes.txt": b""})),
    45: ("final.PY", SOURCE),
    46: ("solution.ipynb", notebook(SOURCE.decode())),
    47: ("doubling (2).py", SOURCE),
    48: ("doubling(1).py", SOURCE),
    49: ("Doubling.py", SOURCE),
    50: ("work.zip", zipped({"homework/doubling.py": SOURCE, "homework/notes.txt": b""})),
    51: ("work.zip", zipped({"mine\\doubling\\doubling.py": SOURCE, "mine\\notes.txt": b""})),
}  # fmt: skip
TO_SETTLE = 7


def name(number):
    return f"{NAMES[number % len(NAMES)]} {number}"


def canvas_name(number):
    return "".join(letter for letter in name(number).casefold() if letter.isalnum())


def handed_in(number):
    mistake = b"" if number % 3 else WRONG
    return ODD.get(number, ("doubling.py", SOURCE + mistake + b"# %d\n" % number))


def points(number):
    """What a student is due, as ``grades.csv`` writes it."""
    if number in NOTHING:
        return ""
    if number in TEXT:
        return "0"
    return "4" if number in ODD or number % 3 else "0"


def lay(folder, place, typed):
    """What everybody hands in, where a platform puts it: a file, or what two typed in its place."""
    for number in EVERYBODY:
        if number in TEXT:
            put(folder / typed(number), b"I would double it")
        elif number not in NOTHING:
            file, content = handed_in(number)
            put(folder / place(number, file), content)


def lay_folders(folder):
    lay(folder, lambda n, file: f"s{n}/{file}", lambda n: f"s{n}/answer.txt")
    return [["student", "name"], *([f"s{n}", name(n)] for n in EVERYBODY)]


def lay_moodle(folder, *, flat=False):
    def assigned(n):
        return f"{'Participant' if n in ANONYMOUS else name(n)}_{n}_assignsubmission"

    end = "_" if flat else "/"
    typed = "onlinetext/onlinetext.html"
    lay(folder, lambda n, file: f"{assigned(n)}_file{end}{file}", lambda n: f"{assigned(n)}_{typed}")
    headings = ["Identifier", "Full name", "Email address", "Grade", "Last modified (grade)"]
    return [headings, *([f"Participant {n}", name(n), f"{n}@x.org", "", "-"] for n in EVERYBODY)]


def lay_canvas(folder):
    def who(n):
        return f"anon_Ab3d{n % 10}" if n in ANONYMOUS else f"{canvas_name(n)}_{n}"

    kinds = dict(zip(TEXT, ("text", "link"), strict=True))
    lay(folder, lambda n, file: f"{who(n)}_9{n}_{file}", lambda n: f"{who(n)}_{kinds[n]}.html")
    headings = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section"]
    return [headings, *([name(n), str(n), f"S{n}", f"l{n}", "A"] for n in EVERYBODY)]


def lay_gradescope(folder):
    lay(folder, lambda n, file: f"submission_{n}/{file}", lambda n: f"submission_{n}/answer.txt")
    told = []
    for n in (n for n in EVERYBODY if n not in NOTHING):
        known = "" if n in ANONYMOUS else f"    :name: {name(n)}\n    :sid: S{n}\n"
        told.append(f"submission_{n}:\n  :submitters:\n  - :email: {n}@x.org\n{known}")
    put(folder / "submission_metadata.yml", "".join(told).encode())
    headings = ["Name", "SID", "Email", "Role"]
    return [headings, *([name(n), f"S{n}", f"{n}@x.org", "Student"] for n in EVERYBODY)]


LAYOUTS = {
    "folders": lay_folders,
    "moodle": lay_moodle,
    "moodle, files in one folder": lambda folder: lay_moodle(folder, flat=True),
    "canvas": lay_canvas,
    "gradescope": lay_gradescope,
}
#: Canvas says of anonymous work not whose it is: those two are rows of their own, and their owners missing.
UNKNOWN = {"canvas": len(ANONYMOUS)}


def graded_and_settled(tmp_path, catalog, layout, grade):
    """Grade a class of that layout, settle the rest, export it; rows of ``grades.csv`` by student."""
    if layout == "gradescope":
        pytest.importorskip("yaml")
    table = LAYOUTS[layout](tmp_path / "class")
    with (tmp_path / "roster.csv").open("w", encoding="utf-8", newline="") as handle:
        csv.writer(handle).writerows(table)
    files = sorted(tmp_path.glob("class/**/*"))
    roster = read_roster(tmp_path / "roster.csv")
    assert len(roster.people) == 150
    out, unknown = tmp_path / "out", UNKNOWN.get(layout, 0)
    options = RunOptions(exercises=("doubling",), terms=Terms(), seed=1, roster=roster)
    summary = grade_class(tmp_path / "class", out, catalog, options, lambda *_: None, grade=grade)
    assert summary.unrecognised == []
    assert (len(summary.missing), len(summary.strangers)) == (len(NOTHING) + unknown, unknown)
    assert summary.states == {"graded": 150 - 9 - TO_SETTLE - 2, "ungradable": TO_SETTLE + 2}
    assert Counter(row.code for row in summary.troubled) == {"no_file": TO_SETTLE + 2}
    with open_results(out, writing=True) as results:
        assert len(unsettled(results)) == TO_SETTLE + 2
        assign(results, catalog, proposals(results), "the only file there is", grade=grade)
        listed = [file for one in unsettled(results) for file in one.found.candidates]
        assert {(file.name, file.kind) for file in listed} <= {("answer.txt", "a text")}, "typed, or no code"
    found = rows(out / "grades.csv")
    assert len(found) == 150 + unknown
    assert len({row["name"] for row in found.values() if row["name"]}) == 150
    assert Counter(row["state"] for row in found.values()) == {
        "graded": 150 - 9 - 2, "missing": 9 + unknown, "ungradable": 2,
    }  # fmt: skip
    assert sorted(tmp_path.glob("class/**/*")) == files, "nothing was renamed"
    platform = {"canvas": "canvas", "gradescope": "gradescope"}.get(layout, "moodle-worksheet")
    if layout != "folders":
        sheet = tmp_path / "roster.csv" if platform == "moodle-worksheet" else None
        how = ExportOptions((), {"doubling": "4711"}, True, "blank", True, sheet)
        with open_results(out) as results:
            written = export(results, platform, out, tmp_path / "export", how)
        assert written.rows == {"canvas": 150, "gradescope": 150, "moodle-worksheet": 141}[platform]
        assert written.unmatched == sorted(summary.strangers)
    return found


@pytest.mark.parametrize("layout", LAYOUTS)
def test_every_enrolled_student_has_one_row_and_triage_settles_the_rest(
    tmp_path, catalog, layout, monkeypatch
):
    monkeypatch.setattr(pages, "write_pages", lambda *_: None)  # 1,500 pages, which other tests look at
    graded_and_settled(tmp_path, catalog, layout, right)


@pytest.mark.soak
@pytest.mark.parametrize("layout", LAYOUTS)
def test_real_graders_give_everybody_the_points_of_their_own_file(tmp_path, catalog, layout):
    found = graded_and_settled(tmp_path, catalog, layout, partial(grade_all, graders=2))
    due = {name(number): points(number) for number in EVERYBODY}
    if layout == "canvas":  # whose the anonymous files are it does not say
        due |= {name(number): "" for number in ANONYMOUS}
    assert {row["name"]: row["score"] for row in found.values() if row["name"]} == due
    nameless = {row["score"] for row in found.values() if not row["name"]}
    assert nameless == ({points(number) for number in ANONYMOUS} if layout == "canvas" else set())
