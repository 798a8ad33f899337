"""`course grade export|override|late|rerun|similar|explain`: what an instructor types after a run."""

import json
import shutil
import zipfile
from pathlib import Path

import pytest

from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.records import PlatformIdentity, Result, SubmittedAt
from course.grading.results.roster import Person, Roster
from course.grading.running import batch
from course.grading.running.batch import Graded
from course.grading.similar import Similar
from tests.unit.cli.conftest import as_anybody, files_in, needs_setpriv
from tests.unit.grading.made import BROKEN, HALF, REFUSED, RIGHT, WRONG, digest, key, make_book, read_csv
from tests.unit.grading.test_results import DAY, DUE, POLICY

ROSTER = """student,name,email,canvas_id,moodle_key,extension_days
ada,Ada L,a@x.org,11,m1,
bob,Bob,b@x.org,12,m2,2
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The gradebook that each test begins with."""
    folder = tmp_path_factory.mktemp("made")
    with make_book(folder / "out", {"ada": RIGHT, "bob": HALF, "cy": REFUSED, "dan": BROKEN}) as book:
        for student in ("ada", "bob"):
            at = DUE.timestamp() + 2 * DAY
            book.add_times([SubmittedAt(student, "doubling", digest(student), "gradescope", at)])
    (folder / "class" / "ada").mkdir(parents=True)
    (folder / "roster.csv").write_text(ROSTER, "utf-8")
    (folder / "late.toml").write_text(POLICY.replace("bob", "nobody"), "utf-8")
    return folder


@pytest.fixture
def out(made, tmp_path):
    shutil.copytree(made, tmp_path, dirs_exist_ok=True)
    return tmp_path / "out"


def grades(path):
    return {row["student"]: row for row in read_csv(path)}


def test_no_name_or_reason_adds_a_line(course, tmp_path):
    forged = "  100%: ada and bob, doubling"
    code = (
        "def double(x):\n    s = 0\n    for part in (x, x):\n        s += part * 1 + 0 * part\n    return s\n"
    )
    names = [f"{letter}\n{forged}" for letter in "xy"]
    with make_book(tmp_path / "out", {}) as book:
        for name in names:
            book.add(Result(key(name), RIGHT), {"doubling.py": code.encode()})
        book.begin_run("rerun", {"reason": f"r\n{forged}", "who": f"w\n{forged}"})
        book.set_meta(late_policy=POLICY.replace("bob", f"z\\n{forged}"))
        book.set_meta(roster=Roster((Person("else"),)).dump())
    override = ("override", "out", names[0], "doubling", "--score", "1", "--reason", f"r\n{forged}")
    for words in (("similar", "out"), override, ("log", "out"), ("explain", "out", names[0], "doubling"),
                  ("late", "out"), ("export", "out", "--partial"), ("assign", "out")):  # fmt: skip
        ran = course("grade", *words)
        assert ran.code == 0, ran.err
        assert forged not in (ran.out + ran.err).splitlines()
    assert "100%: x\\n" in course("grade", "similar", "out").out


def test_an_override_is_in_every_file_at_once_and_can_be_lifted(course, out):
    ran = course("grade", "override", "out", "bob", "doubling", "--score", "9", "--reason", "oral exam")
    assert (ran.code, ran.err) == (0, "")
    told = "The student can read the reason: it is on their page and in exports for students.\n"
    assert ran.out == f"bob doubling: 9 of 10 counts; the checks gave 5.\n{told}"
    words = ("grade", "override", "out", "cy", "doubling", "--score", "9", "--reason", "x", "--dry-run")
    assert course(*words).out.startswith("cy doubling: 9 of 10 would count; no check ran.\n")
    assert grades(out / "grades.csv")["bob"]["override_reason"] == "oral exam"
    assert '"reason":"oral exam"' in (out / "results.jsonl").read_text()
    assert "oral exam" in course("grade", "explain", "out", "bob", "doubling").out
    assert course("grade", "explain", "out", "bob", "doubling", "--json").json["override"]["score"] == 9
    ran = course("grade", "override", "out", "bob", "doubling", "--lift", "--json")
    assert (ran.code, ran.json["score"], ran.json["override"]) == (0, 5.0, None)
    assert "9, by hand: oral exam -> the graders' score" in course("grade", "log", "out").out


def test_what_is_missing_is_said_in_full_and_nothing_is_said_where_there_is_nothing(course, out):
    for words in (("explain", "out", "ada"), ("override", "out", "ada", "--score", "1")):
        assert "Known: doubling, halving." in course("grade", *words).err
    with (out.parent / "more.csv").open("w", encoding="utf-8") as file:
        file.write(ROSTER + "eve,Eve,,13,,\n")
    assert course("grade", "late", "out", "--roster", "more.csv").code == 0
    told = course("grade", "explain", "out", "eve", "doubling").out
    assert "reason: not_submitted: Nothing was handed in." in told
    assert "advice" not in told


@pytest.mark.parametrize(
    ("words", "code", "error"),
    [
        (("override", "out", "bob", "doubling", "--score", "9"), 2, "no_reason"),
        (("override", "out", "bob", "doubling"), 2, "usage"),
        (("override", "out", "bob", "doubling", "--score", "9", "--lift"), 2, "usage"),
        (("override", "out", "bob", "doubling", "--score", "11", "--reason", "x"), 2, "impossible_score"),
        (("override", "out", "eve", "doubling", "--score", "1", "--reason", "x"), 5, "student_not_found"),
        (("override", "out", "bob", "doubling", "--lift"), 5, "no_override"),
        (("export", "out", "--format", "canvas"), 2, "needs_roster"),
        (("export", "out", "--format", "canvas", "--roster", "roster.csv"), 4, "unmatched_students"),
        (("export", "out", "--format", "xlsx"), 2, "usage"),
        (("export", "--format", "csv"), 2, "usage"),
        (("export", "out", "--assignment", "doubling"), 2, "usage"),
        (("export", "out", "--exercise", "none"), 5, "exercise_not_found"),
        (("similar", "out", "--exercise", "none"), 5, "exercise_not_found"),
        (("similar", "out", "-o", "out/gradebook.sqlite"), 2, "is_a_database"),
        (("export", "nowhere"), 5, "gradebook_not_found"),
        (("late", "out", "--policy", "roster.csv"), 2, "invalid_policy"),
        (("late", "out", "--policy", "late.toml", "--clear"), 2, "usage"),
        (("late", "out", "--times", "roster.csv"), 2, "invalid_times"),
        (("explain", "out", "nobody", "doubling"), 5, "result_not_found"),
        (("explain", "nowhere", "ada", "doubling"), 5, "gradebook_not_found"),
        (("run", "class", "--out", "out"), 2, "out_exists"),
        (("run", "class", "--out", "new", "--exercise", "no-such"), 5, "exercise_not_found"),
        (("run", "class", "--out", "new", "--only", "nobody"), 2, "student_not_found"),
        (("run", "class", "--out", "new", "--isolation", "none"), 2, "usage"),
        (("run", "nowhere", "--out", "new"), 5, "submissions_not_found"),
        (("run", "class", "--out", "out", "--resume", "--seed", "5"), 2, "other_seed"),
        (("rerun", "nowhere"), 5, "gradebook_not_found"),
        (("similar", "nowhere"), 5, "gradebook_not_found"),
    ],
)
def test_what_cannot_be_done_is_said_and_changes_nothing(course, out, words, code, error):
    before = files_in(out)
    ran = course("grade", *words, "--json")
    assert (ran.code, ran.json["error"]["code"]) == (code, error)
    assert ran.json["error"]["help"]
    assert files_in(out) == before


def test_a_late_policy_is_put_in_force_shown_and_taken_out(course, out):
    assert "No late policy" in course("grade", "late", "out").out
    ran = course("grade", "late", "out", "--policy", "late.toml")
    assert ran.code == 0
    assert "ada doubling: 2 d late, 2 points (2026-12-03T23:59:00Z, by gradescope)" in ran.out
    assert "2 are late." in ran.out
    assert "2 have no trusted submission time" in ran.out
    assert "no student nobody" in ran.err
    assert grades(out / "grades.csv")["ada"]["score"] == "8"
    (out.parent / "all.csv").write_text(ROSTER + "eve,Eve,,13,,\n", "utf-8")
    (out.parent / "eve.csv").write_text("student,exercise,submitted_at\neve,doubling,2026-12-09T00:00:00Z\n")
    told = course("grade", "late", "out", "--roster", "all.csv", "--times", "eve.csv", "--dry-run").out
    assert "2 have no trusted submission time" in told, "eve handed in nothing"
    assert "1 is late." in told, "so neither is she late, as on the page"
    assert "1 is late." in course("grade", "late", "out", "--roster", "roster.csv", "--dry-run").out
    ran = course("grade", "late", "out", "--roster", "roster.csv", "--json")
    assert [(one["student"], one["late"]) for one in ran.json["late"]] == [("ada", 2 * DAY)]
    times = out.parent / "times.csv"
    times.write_text(
        "student,exercise,submitted_at\nada,doubling,2026-12-01T10:00:00Z\neve,doubling,2026-12-01T10:00:00Z\n"
    )
    ran = course("grade", "late", "out", "--times", "times.csv", "--json")
    assert (ran.json["late"], "student eve" in ran.json["unknown_names"]) == ([], True)
    times.write_text("student,exercise,submitted_at\nada,dubling,2026-12-01T10:00:00Z\n")
    ran = course("grade", "late", "out", "--times", "times.csv")
    assert "The gradebook has no exercise dubling." in ran.err
    assert course("grade", "late", "out", "--clear").code == 0
    assert grades(out / "grades.csv")["ada"]["score"] == "10"


def test_an_export_says_what_it_wrote_and_who_was_left_out(course, out):
    words = "grade export out --format canvas --roster roster.csv --exercise doubling"
    course(*words.split(), "--assignment", "doubling=77", "--partial", "-o", "c.csv").ends(
        0, "Wrote c.csv.", "2 left out, without a row or an id in the roster:\n  cy\n  dan\n"
    )
    assert (out.parent / "c.csv").read_text("utf-8-sig").splitlines()[2] == '"Ada L","11","","","","10"'
    # The roster is remembered: the next export needs no other.
    ran = course("grade", "export", "out", "--format", "moodle", "--partial", "--json")
    assert (ran.code, ran.json["unmatched"], ran.json["rows"]) == (0, ["cy", "dan"], 2)
    assert Path(ran.json["paths"][0]).name == "moodle.csv"


def test_an_extension_that_comes_with_an_export_counts_in_every_file(course, out):
    assert course("grade", "late", "out", "--policy", "late.toml").code == 0
    assert grades(out / "grades.csv")["bob"]["score"] == "3"
    words = ("grade", "export", "out", "--roster", "roster.csv", "--partial", "-o", "c.csv")
    assert course(*words).code == 0
    assert grades(out.parent / "c.csv")["bob"]["score"] == "5"
    assert grades(out / "grades.csv")["bob"]["score"] == "5"
    assert '"late_penalty":2' not in (out / "results.jsonl").read_text("utf-8").splitlines()[1]


def test_lines_of_json_are_printed_where_json_is_asked_for(course, out):
    (out / "results.jsonl").unlink(missing_ok=True)
    ran = course("grade", "export", "out", "--format", "jsonl", "--json")
    lines = [json.loads(line) for line in ran.out.splitlines()]
    assert [(line["schema"], line["student"]) for line in lines] == [
        ("course.grade/1", name) for name in ("ada", "bob", "cy", "dan")
    ]
    assert not (out / "results.jsonl").exists()
    assert course("grade", "export", "out", "--format", "jsonl").code == 0
    assert [json.loads(line) for line in (out / "results.jsonl").read_bytes().splitlines()] == lines


def test_a_student_from_a_download_is_found_by_the_platforms_number(course, out):
    with Gradebook(out / "gradebook.sqlite", writing=True) as book:
        book.set_students({"dan": PlatformIdentity("canvas", "12", "d")})
    roster = out.parent / "roster.csv"
    roster.write_text("student,canvas_id\nada,11\nb2,12\n", "utf-8")
    ran = course("grade", "export", "out", "--roster", "roster.csv", "--partial", "--json")
    assert (ran.json["unmatched"], ran.json["without_grade"]) == (["bob", "cy"], ["dan doubling"])


def test_gradescopes_download_says_names_where_there_is_no_roster(course, out):
    with Gradebook(out / "gradebook.sqlite", writing=True) as book:
        book.set_students({"ada": PlatformIdentity("gradescope", "1", "Ada L", "a@x.org", "ada")})
    assert course("grade", "explain", "out", "Ada L", "doubling").out.startswith(
        "ada (Ada L), doubling: graded"
    )
    ran = course("grade", "export", "out", "--format", "gradescope", "--accept-zeros")
    assert "/autograder/results/results.json" in ran.out
    index = (out / "gradescope" / "index.csv").read_text("utf-8-sig")
    assert '"ada","Ada L","a@x.org","doubling"' in index
    assert '"bob","","","doubling"' in index


def test_an_autograder_needs_no_gradebook(course, tmp_path):
    ran = course(
        "grade", "export", "--format", "gradescope-autograder", "--exercise", "doubling", "--seed", "3"
    )
    assert ran.code == 0, ran.err
    with zipfile.ZipFile(tmp_path / "gradescope-autograder.zip") as packed:
        assert '"seed": 3' in packed.read("config.json").decode()
        assert not [name for name in packed.namelist() if "halving" in name]


def test_a_regrading_is_told_change_by_change(course, out, monkeypatch):
    now = {"ada": RIGHT, "bob": RIGHT, "cy": REFUSED, "dan": WRONG}
    monkeypatch.setattr(
        batch,
        "grade_all",
        lambda entries, _, graders: (Graded(entry, now[entry.student]) for entry in entries),
    )
    before = (out / "gradebook.sqlite").read_bytes()
    ran = course("grade", "rerun", "out", "--dry-run")
    assert ran.code == 0, ran.err
    assert "bob doubling: 5 of 10 -> 10 of 10\n    kept_back: fail -> pass, +5 points\n" in ran.out
    assert "dan doubling: no score -> 0 of 10, grader_error -> graded" in ran.out
    assert "Nothing was changed." in ran.out
    assert (out / "gradebook.sqlite").read_bytes() == before
    ran = course("grade", "rerun", "out", "--json")
    assert [change["student"] for change in ran.json["changes"]] == ["bob", "dan"]
    assert grades(out / "grades.csv")["bob"]["score"] == "10"
    assert "before: " in course("grade", "explain", "out", "bob", "doubling").out
    assert "3 were graded by these very graders" not in course("grade", "rerun", "out", "--dry-run").err


def test_likeness_is_shown_and_written_as_a_page(course, out):
    course("grade", "similar", "out").ends(0, "pairs among 4 submissions")
    assert (out / "similar.html").read_text().startswith("<!DOCTYPE html>")
    assert course("grade", "similar", "out", "--json").json["schema"] == "course.grade-similar/1"


def test_a_share_is_a_part_of_one_or_a_percentage_and_else_refused_with_both_forms(course, out, monkeypatch):
    asked = []

    def compare(*_, at_least):
        asked.append(at_least)
        return Similar()

    monkeypatch.setattr("course.cli.grade.commands.compare", compare)
    for text in ("0.25", "25%", " 25 % "):
        assert course("grade", "similar", "out", "--share", text).code == 0
    assert course("grade", "similar", "out").code == 0
    for text in ("60", "101%", "-1", "nan", "0.6%%", "", "much"):
        error = course("grade", "similar", "out", f"--share={text}", "--json").json["error"]
        assert (error["code"], "0.6 or 60%" in error["help"]) == ("usage", True), text
    assert asked == [0.25, 0.25, 0.25, 0.6]


def test_a_students_installation_is_told_so(course, students_content, tmp_path):
    (tmp_path / "class").mkdir()
    assert course("grade", "run", "class", "--out", "out", "--json").error == (4, "needs_checkout")


@needs_setpriv
def test_a_folder_that_cannot_be_written_is_said_and_can_still_be_read(course, out):
    (out / "gradebook.sqlite").chmod(0o444)
    out.chmod(0o555)
    lines = ("explain out ada doubling", "override out ada doubling --score 1 --reason x", "export out")
    try:
        read, written, exported = (as_anybody("grade", *line.split(), cwd=out.parent) for line in lines)
    finally:
        out.chmod(0o755)
    assert (read.returncode, written.returncode, exported.returncode) == (0, 4, 4), read.stderr
    assert "gradebook.sqlite cannot be written" in written.stderr
    assert "grades.csv cannot be written" in exported.stderr
