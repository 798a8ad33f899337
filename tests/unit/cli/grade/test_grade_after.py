"""`course grade export|override|late|rerun|similar|explain` after a run, one's own or somebody else's."""

import json
import shutil
import zipfile
from pathlib import Path

import pytest

from course.cli.frame.console import Console
from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.records import PlatformIdentity, Result, SubmittedAt
from course.grading.results.roster import Person, Roster
from course.grading.running import batch
from course.grading.running.batch import Graded
from course.grading.similar import Similar
from tests.unit.cli.conftest import as_anybody, files_in, needs_setpriv
from tests.unit.cli.grade.conftest import RUN, grades, write, write_times
from tests.unit.grading.made import BROKEN, HALF, REFUSED, RIGHT, WRONG, digest, key, make_book
from tests.unit.grading.running.test_run import right
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
    write(folder, "roster.csv", ROSTER)
    write(folder, "late.toml", POLICY.replace("bob", "nobody"))
    return folder


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
    lines = ("log out", "late out", "export out --partial", "assign out", "similar out")
    for words in (*map(str.split, lines), override, ("explain", "out", names[0], "doubling")):
        ran = course("grade", *words).ends(0)
        assert forged not in (ran.out + ran.err).splitlines()
    course("grade similar out").says("100%: x\\n")


def test_an_override_is_in_every_file_at_once_and_can_be_lifted(course, out):
    ran = course("grade override out bob doubling --score 9 --reason 'oral exam'")
    assert (ran.code, ran.err) == (0, "")
    told = "The student can read the reason: it is on their page and in exports for students.\n"
    assert ran.out == f"bob doubling: 9 of 10 counts; the checks gave 5.\n{told}"
    tried = course("grade override out cy doubling --score 9 --reason x --dry-run")
    assert tried.out.startswith("cy doubling: 9 of 10 would count; no check ran.\n")
    assert grades(out / "grades.csv")["bob"]["override_reason"] == "oral exam"
    assert '"reason":"oral exam"' in (out / "results.jsonl").read_text()
    assert "oral exam" in course("grade explain out bob doubling").out
    assert course("grade explain out bob doubling --json").json["override"]["score"] == 9
    ran = course("grade override out bob doubling --lift --json")
    assert (ran.code, ran.json["score"], ran.json["override"]) == (0, 5.0, None)
    assert "9, by hand: oral exam -> the graders' score" in course("grade log out").out


def test_what_is_missing_is_said_in_full_and_nothing_is_said_where_there_is_nothing(course, out):
    for line in ("explain out ada", "override out ada --score 1"):
        course(f"grade {line}").warns("Known: doubling, halving.")
    write(out.parent, "more.csv", ROSTER + "eve,Eve,,13,,\n")
    course("grade late out --roster more.csv").ends(0)
    told = course("grade explain out eve doubling").says("reason: not_submitted: Nothing was handed in.")
    assert "advice" not in told.out


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
    assert ran.error == (code, error)
    assert ran.json["error"]["help"]
    assert files_in(out) == before


def test_a_late_policy_is_put_in_force_shown_and_taken_out(course, out):
    course("grade late out").says("No late policy")
    course("grade late out --policy late.toml").ends(
        0,
        "ada doubling: 2 d late, 2 points (2026-12-03T23:59:00Z, by gradescope)",
        "2 are late.",
        "2 have no trusted submission time",
    ).warns("no student nobody")
    assert grades(out / "grades.csv")["ada"]["score"] == "8"
    write(out.parent, "all.csv", ROSTER + "eve,Eve,,13,,\n")
    write_times(out.parent, ("eve", "2026-12-09T00:00:00Z"))
    told = course("grade late out --roster all.csv --times times.csv --dry-run").out
    assert "2 have no trusted submission time" in told, "eve handed in nothing"
    assert "1 is late." in told, "so neither is she late, as on the page"
    course("grade late out --roster roster.csv --dry-run").says("1 is late.")
    ran = course("grade late out --roster roster.csv --json")
    assert [(one["student"], one["late"]) for one in ran.json["late"]] == [("ada", 2 * DAY)]
    write_times(out.parent, ("ada", "2026-12-01T10:00:00Z"), ("eve", "2026-12-01T10:00:00Z"))
    told = course("grade late out --times times.csv --json").json
    assert (told["late"], "student eve" in told["unknown_names"]) == ([], True)
    write_times(out.parent, ("ada", "2026-12-01T10:00:00Z"), exercise="dubling")
    course("grade late out --times times.csv").warns("The gradebook has no exercise dubling.")
    course("grade late out --clear").ends(0)
    assert grades(out / "grades.csv")["ada"]["score"] == "10"


def test_an_export_says_what_it_wrote_and_who_was_left_out(course, out):
    words = "--roster roster.csv --exercise doubling --assignment doubling=77 --partial"
    course(f"grade export out --format canvas -o c.csv {words}").ends(
        0, "Wrote c.csv.", "2 left out, without a row or an id in the roster:\n  cy\n  dan\n"
    )
    assert (out.parent / "c.csv").read_text("utf-8-sig").splitlines()[2] == '"Ada L","11","","","","10"'
    # The roster is remembered: the next export needs no other.
    ran = course("grade export out --format moodle --partial --json")
    assert (ran.code, ran.json["unmatched"], ran.json["rows"]) == (0, ["cy", "dan"], 2)
    assert Path(ran.json["paths"][0]).name == "moodle.csv"


def test_an_extension_that_comes_with_an_export_counts_in_every_file(course, out):
    course("grade late out --policy late.toml").ends(0)
    assert grades(out / "grades.csv")["bob"]["score"] == "3"
    course("grade export out --roster roster.csv --partial -o c.csv").ends(0)
    for path in (out.parent / "c.csv", out / "grades.csv"):
        assert grades(path)["bob"]["score"] == "5"
    assert '"late_penalty":2' not in (out / "results.jsonl").read_text("utf-8").splitlines()[1]


def test_lines_of_json_are_printed_where_json_is_asked_for(course, out):
    (out / "results.jsonl").unlink(missing_ok=True)
    ran = course("grade export out --format jsonl --json")
    lines = [json.loads(line) for line in ran.out.splitlines()]
    assert [(line["schema"], line["student"]) for line in lines] == [
        ("course.grade/1", name) for name in ("ada", "bob", "cy", "dan")
    ]
    assert not (out / "results.jsonl").exists()
    assert course("grade export out --format jsonl").code == 0
    assert [json.loads(line) for line in (out / "results.jsonl").read_bytes().splitlines()] == lines


def test_a_student_from_a_download_is_found_by_the_platforms_number(course, out):
    with Gradebook(out / "gradebook.sqlite", writing=True) as book:
        book.set_students({"dan": PlatformIdentity("canvas", "12", "d")})
    write(out.parent, "roster.csv", "student,canvas_id\nada,11\nb2,12\n")
    ran = course("grade export out --roster roster.csv --partial --json")
    assert (ran.json["unmatched"], ran.json["without_grade"]) == (["bob", "cy"], ["dan doubling"])


def test_gradescopes_download_says_names_where_there_is_no_roster(course, out):
    with Gradebook(out / "gradebook.sqlite", writing=True) as book:
        book.set_students({"ada": PlatformIdentity("gradescope", "1", "Ada L", "a@x.org", "ada")})
    assert course("grade explain out 'Ada L' doubling").out.startswith("ada (Ada L), doubling: graded")
    ran = course("grade export out --format gradescope --accept-zeros")
    ran.says("/autograder/results/results.json")
    index = (out / "gradescope" / "index.csv").read_text("utf-8-sig")
    assert '"ada","Ada L","a@x.org","doubling"' in index
    assert '"bob","","","doubling"' in index


def test_an_autograder_needs_no_gradebook(course, tmp_path):
    course("grade export --format gradescope-autograder --exercise doubling --seed 3").ends(0)
    with zipfile.ZipFile(tmp_path / "gradescope-autograder.zip") as packed:
        assert '"seed": 3' in packed.read("config.json").decode()
        assert not [name for name in packed.namelist() if "halving" in name]


def test_a_regrading_is_told_change_by_change(course, out, monkeypatch):
    now = {"ada": RIGHT, "bob": RIGHT, "cy": REFUSED, "dan": WRONG}

    def graded(entries, _, graders):
        return (Graded(entry, now[entry.student]) for entry in entries)

    monkeypatch.setattr(batch, "grade_all", graded)
    before = (out / "gradebook.sqlite").read_bytes()
    course("grade rerun out --dry-run").ends(
        0,
        "bob doubling: 5 of 10 -> 10 of 10\n    kept_back: fail -> pass, +5 points\n",
        "dan doubling: no score -> 0 of 10, grader_error -> graded",
        "Nothing was changed.",
    )
    assert (out / "gradebook.sqlite").read_bytes() == before
    ran = course("grade rerun out --json")
    assert [change["student"] for change in ran.json["changes"]] == ["bob", "dan"]
    assert grades(out / "grades.csv")["bob"]["score"] == "10"
    assert "before: " in course("grade explain out bob doubling").out
    assert "3 were graded by these very graders" not in course("grade rerun out --dry-run").err


def test_likeness_is_shown_and_written_as_a_page(course, out):
    course("grade similar out").ends(0, "pairs among 4 submissions")
    assert (out / "similar.html").read_text().startswith("<!DOCTYPE html>")
    assert course("grade similar out --json").json["schema"] == "course.grade-similar/1"


def test_a_share_is_a_part_of_one_or_a_percentage_and_else_refused_with_both_forms(course, out, monkeypatch):
    asked = []

    def compare(*_, at_least):
        asked.append(at_least)
        return Similar()

    monkeypatch.setattr("course.cli.grade.commands.compare", compare)
    for text in ("0.25", "25%", " 25 % "):
        assert course("grade similar out --share", text).code == 0
    assert course("grade similar out").code == 0
    for text in ("60", "101%", "-1", "nan", "0.6%%", "", "much"):
        error = course("grade similar out", f"--share={text}", "--json").json["error"]
        assert (error["code"], "0.6 or 60%" in error["help"]) == ("usage", True), text
    assert asked == [0.25, 0.25, 0.25, 0.6]


def test_a_students_installation_is_told_so(course, students_content, tmp_path):
    (tmp_path / "class").mkdir()
    assert course("grade run class --out out --json").error == (4, "needs_checkout")


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


RERUN = "grade rerun out --against 1 --all --dry-run"
WAYS = pytest.mark.parametrize(
    "line", [f"{RUN} --resume", RERUN, "grade assign out bob hw.py --reason 'it is his' --dry-run"]
)
THEIRS = "# theirs were others\n"


@pytest.fixture
def ran(course, content, tmp_path, monkeypatch):
    """A gradebook from elsewhere: its graders were others, and nothing here knows them. What they grade."""
    graded = []

    def noting(entries, terms, graders):
        for done in right(entries, terms):
            graded.append(done.entry.student)
            yield done

    monkeypatch.setattr(batch, "grade_all", noting)
    for name in ("ada/doubling.py", "bob/hw.py"):
        write(tmp_path / "class", name)
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path / "elsewhere"))
    monkeypatch.setenv("LOGNAME", "eve")
    course(RUN).ends(6)
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path / "here"))
    checks = content / "graders" / "doubling" / "checks.py"
    checks.write_text(checks.read_text() + THEIRS)
    write(tmp_path, "class/cy/doubling.py")
    graded.clear()
    return graded


@WAYS
def test_somebody_elses_graders_run_where_nobody_can_be_asked_only_with_yes(course, ran, line):
    refused = course(line, "--json")
    assert (refused.error, ran) == ((2, "foreign_graders"), [])
    refused.warns("eve began the run", "content/graders/doubling/checks.py", "--yes")
    assert [run["kind"] for run in course("grade log out --json").json["runs"]] == ["run"]
    done = course(line, "--yes").warns("eve began the run")
    assert done.code in {0, 6}
    assert ran


@WAYS
def test_a_person_at_a_terminal_is_asked(course, person, ran, line, monkeypatch):
    asked = []
    monkeypatch.setattr(Console, "confirm", lambda _, question: asked.append(question) or len(asked) > 1)
    for times, agreed in ((1, False), (2, True)):
        done = course(line)
        assert len(asked) == times
        assert "eve began the run" in done.out
        assert (done.code in {0, 6}, bool(ran)) == (agreed, agreed)
        assert agreed or "Nothing was run" in done.err


@WAYS
def test_nobody_is_asked_about_graders_that_are_here_too_or_began_a_run_here(
    course, ran, line, content, tmp_path, monkeypatch
):
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path / "elsewhere"))
    assert course(line).code in {0, 6}  # edited since, but this checkout began the run
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path / "empty"))
    checks = content / "graders" / "doubling" / "checks.py"
    checks.write_text(checks.read_text().removesuffix(THEIRS))
    assert course(line).code in {0, 6}  # nothing is known of it, but it is this checkout's to the letter


def test_a_file_more_in_the_gradebooks_graders_makes_them_somebody_elses(course, ran, content):
    checks = content / "graders" / "doubling" / "checks.py"
    checks.write_text(checks.read_text().removesuffix(THEIRS))
    (content / "graders" / "doubling" / "late.py").write_text("")
    assert course(RERUN).code == 0  # what is here and not there does not run
    shutil.rmtree(content / "solutions")
    assert course(RERUN).code == 2
