"""`course grade assign|log|salvage`, and what `--dry-run` and `--resume` say before a score changes."""

import dataclasses
import html
import io
import json
import shutil
import tarfile
import unicodedata

import msgspec
import pytest

from course.grading.gradebook.book import Gradebook
from course.grading.running import batch
from course.grading.running.batch import Graded
from course.scoring.verdict import OURS, Problem, Status
from tests.unit.grading.conftest import MINI
from tests.unit.grading.made import check, read_csv, verdict, zipped
from tests.unit.grading.running.test_run import right

pytestmark = pytest.mark.usefixtures("unpacked")

SOURCE = "def double(x):\n    return 2 * x\n\ndef doublings(x, n):\n    return x\n"


def _long_tar(size):
    """So many MB that are no code, in some kB."""
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode="w:gz") as archive:
        info = tarfile.TarInfo("long.md")
        info.size = size << 20
        archive.addfile(info, io.BytesIO(bytes(info.size)))
    return buffer.getvalue()


@pytest.fixture
def here(course, tmp_path, monkeypatch):
    """A class of three, graded by stand-ins: one right name, one wrong name, one in nobody's sight."""
    monkeypatch.setattr(batch, "grade_all", lambda entries, terms, graders: right(entries, terms))
    shutil.copytree(MINI, tmp_path / "content")
    monkeypatch.setenv("COURSE_CONTENT", str(tmp_path / "content"))
    for student, name in (("ada", "doubling.py"), ("bob", "hw.py"), ("cy", ".notes")):
        (tmp_path / "class" / student).mkdir(parents=True)
        (tmp_path / "class" / student / name).write_text(SOURCE)
    assert course("grade", "run", "class", "--out", "out", "--exercise", "doubling", "--json").code == 6
    return tmp_path


def book(here):
    return (here / "out" / "gradebook.sqlite").read_bytes()


def test_what_is_unsettled_is_listed_previewed_and_settled(course, here):
    before = book(here)
    listed = course("grade", "assign", "out", "--json").json
    assert listed["schema"] == "course.grade-assign/1"
    assert listed["unsettled"] == [
        {
            "student": "bob", "exercise": "doubling", "reason": "no_file",
            "message": "There is no doubling.py for doubling. There is 'hw.py' (defines double, doublings).",
            "files": [{"file": "hw.py", "defines": ["double", "doublings"], "proposed": True, "kind": ""}],
        },
        {
            "student": "cy", "exercise": "doubling", "reason": "no_file",
            "message": "There is no doubling.py for doubling.", "files": [],
        },
    ]  # fmt: skip
    assert "hw.py: defines double, doublings; proposed" in course("grade", "assign", "out").out
    told = course("grade", "assign", "out", "--accept-names", "--dry-run").out
    assert "would be left to settle" in told
    tried = course("grade", "assign", "out", "--accept-names", "--dry-run", "--json").json
    assert [(one["student"], one["score_before"], one["score_after"]) for one in tried["assigned"]] == [
        ("bob", 0.0, 10.0)
    ]
    assert book(here) == before
    ran = course("grade", "assign", "out", "bob", "hw.py", "--reason", "by mail")
    assert ran.code == 0, ran.err
    assert "bob doubling: ungradable -> graded, 10 of 10; from 'hw.py'" in ran.out
    log = course("grade", "log", "out", "--json").json
    assert [run["kind"] for run in log["runs"]] == ["run", "assign"]
    (change,) = log["changes"]
    assert (change["kind"], change["student"], change["reason"]) == ("assign", "bob", "by mail")
    assert change["who"]
    logged = course("grade", "log", "out", "bob").out
    assert "by mail" in logged
    assert "0 of 10, no_file -> 10 of 10, 'hw.py'" in logged
    assert "by mail; before: 0 of 10, no_file" in course("grade", "explain", "out", "bob", "doubling").out
    for words, code in (
        (("bob",), "usage"), (("bob", "x.py", "--accept-names"), "usage"),
        (("bob", "class/bob/hw.py"), "no_reason"),
        (("nobody", "hw.py", "--reason", "x"), "student_not_found"),
        (("cy", "nowhere.py", "--reason", "x"), "file_not_found"),
    ):  # fmt: skip
        assert course("grade", "assign", "out", *words, "--json").json["error"]["code"] == code


def test_an_assigned_file_counts_until_another_file_with_the_right_name_arrives(course, here):
    """Ada's own file was there when the instructor chose another: reading it again is no arrival."""
    again = ("grade", "run", "class", "--out", "out", "--exercise", "doubling", "--resume")

    def resumed():
        return int(json.loads(course(*again, "--json").out.splitlines()[-1])["already_graded"])

    def counts():
        with Gradebook(here / "out" / "gradebook.sqlite") as book:
            (one,) = book.results("ada", "doubling")
        return one.key.submission_sha256

    own = counts()
    chosen = []
    for name in ("first.py", "second.py"):
        (here / name).write_text(f"{SOURCE}# {name}\n")
        words = ("ada", name, "--exercise", "doubling", "--reason", "by mail")
        assert course("grade", "assign", "out", *words).code == 0
        chosen.append(counts())
        assert resumed() == 3
        assert counts() == chosen[-1]
    assert course("grade", "assign", "out", "--accept-names").code == 0
    assert "hw.py has changed" not in course(*again).out
    (here / "class" / "bob" / "hw.py").write_text(SOURCE + "# changed\n")
    said = " ".join(course(*again).out.split())
    assert (
        "1 graded before, and kept as they were: bob doubling: hw.py has changed since it was assigned."
        in said
    )
    file = here / "class" / "ada" / "doubling.py"
    file.write_text(SOURCE + "# later\n")
    resumed()
    assert counts() not in {own, *chosen}
    file.write_text(SOURCE)
    resumed()
    assert counts() == own, "changed back, after another had counted"


def test_a_quiz_record_that_cannot_be_read_is_no_missing_quiz(course, here):
    """Beside an exercise that was asked for, too: the student was told that nothing was handed in."""
    shutil.copytree(MINI.parents[2] / "quiz", here / "content" / "quiz", dirs_exist_ok=True)
    (here / "class" / "ada" / "mine.zip").write_bytes(zipped({"submission.json": b"{"}))
    for words in (("--exercise", "quiz"), ("--exercise", "quiz", "--exercise", "doubling")):
        out = f"new{len(words)}"
        course("grade", "run", "class", "--out", out, *words)
        told = course("grade", "explain", out, "ada", "quiz").out
        assert "ungradable" in told, words


def test_who_is_called_as_two_are_is_asked_back_and_nobody_s_log_is_refused(course, here):
    (here / "roster.csv").write_text("student,name\nada,John Smith\nbob,John Smith\ncy,Cy\n")
    words = ("grade", "run", "class", "--out", "named", "--exercise", "doubling", "--roster", "roster.csv")
    course(*words)
    refused = course("grade", "explain", "named", "John Smith", "doubling", "--json")
    assert (refused.code, refused.json["error"]["message"]) == (5, "2 students are called 'John Smith'.")
    assert "ada, bob" in refused.json["error"]["help"]
    for about in (("nobody",), ("ada", "nothing")):
        assert course("grade", "log", "named", *about, "--json").code == 5, about


def test_a_file_with_functions_that_the_graded_one_lacks_is_listed_until_one_of_them_is_assigned(
    course, here, monkeypatch
):
    half = verdict(check("shown", Status.FAIL))
    monkeypatch.setattr(batch, "grade_all", lambda entries, *_, **__: [Graded(one, half) for one in entries])
    ada = here / "class" / "ada"
    (ada / "doubling.py").write_text("def double(x):\n    return 2 * x\n")
    (ada / "new").mkdir()
    (ada / "new" / "doubling.py").write_text(SOURCE)
    (here / "class" / "bob" / "doubling.py").write_text(SOURCE)
    named = "ada doubling: doublings in 'new/doubling.py'"
    ran = course("grade", "run", "class", "--out", "new", "--exercise", "doubling")
    assert f"1 graded without functions that another file has:\n  {named}\n" in ran.out
    assert "`course grade assign new STUDENT FILE --exercise ID --reason TEXT` grades that" in ran.out
    again = ("grade", "run", "class", "--out", "new", "--exercise", "doubling", "--resume", "--json")
    assert json.loads(course(*again).out.splitlines()[-1])["elsewhere"] == [named]
    assert course("grade", "rerun", "new", "--all").code == 0
    assert named in course("grade", "assign", "new").out
    assert course("grade", "assign", "new", "--json").json["elsewhere"] == [named]
    assert "Doubling (doublings in 'new/doubling.py')" in html.unescape(
        (here / "new/report.html").read_text()
    )
    settled = ("grade", "assign", "new", "ada", "doubling.py", "--exercise", "doubling", "--reason", "asked")
    assert course(*settled).code == 0
    assert course("grade", "assign", "new", "--json").json["elsewhere"] == []


def test_an_assignment_under_a_score_by_hand_says_whose_points_count(course, here):
    course("grade", "override", "out", "bob", "doubling", "--score", "3", "--reason", "oral")
    ran = course("grade", "assign", "out", "bob", "hw.py", "--exercise", "doubling", "--reason", "his")
    assert "graded, 3 of 10 by hand (the checks gave 10); from 'hw.py'" in " ".join(ran.out.split())


def test_a_regrading_names_the_exercise_that_its_graders_do_not_have(course, here):
    shutil.move(here / "content" / "exercises" / "doubling", here / "doubling")
    ran = course("grade", "rerun", "out", "--all")
    assert "These graders do not have the exercise doubling; unchanged: " in ran.out, ran.err
    assert "Without a submission" not in ran.out


def test_what_was_said_of_a_file_stays_when_it_is_graded_again(course, here):
    (here / "class" / "ada" / "more.py").write_text(SOURCE + "# another\n")
    course("grade", "run", "class", "--out", "new", "--exercise", "doubling")
    assert course("grade", "assign", "new", "--accept-names").code == 0
    told = [course("grade", "explain", "new", who, "doubling").out for who in ("ada", "bob")]
    assert "Also there, and not graded: 'more.py'" in told[0]
    assert "Graded from 'hw.py', assigned by the instructor" in told[1]
    assert course("grade", "rerun", "new", "--all").code == 0
    for who, before in zip(("ada", "bob"), told, strict=True):
        after = course("grade", "explain", "new", who, "doubling").out
        assert [line for line in before.splitlines() if "note" in line] == [
            line for line in after.splitlines() if "note" in line
        ]


def test_a_resumed_run_says_whose_score_became_lower(course, here, monkeypatch):
    worse = verdict(check("shown", Status.FAIL))
    monkeypatch.setattr(batch, "grade_all", lambda entries, *_, **__: [Graded(one, worse) for one in entries])
    (here / "class" / "ada" / "doubling.py").write_text(SOURCE + "# an older one\n")
    ran = course("grade", "run", "class", "--out", "out", "--exercise", "doubling", "--resume")
    said = " ".join(ran.out.split())
    assert (
        f"1 lower than before, by what was handed in now: ada doubling: 10 before, {worse.score:g} now"
        in said
    )


def test_every_zero_that_stops_an_export_is_listed_with_a_way_to_settle_it(course, here, monkeypatch):
    """A syntax error stopped the export, while `grade assign` said that there was nothing to settle."""
    broken = Problem("syntax_error", "doubling.py, line 1: Python cannot read this file.", "Look there.")

    def ada_cannot_be_read(entries, terms, graders):
        hers = (
            (dataclasses.replace(one, problem=broken) if one.student == "ada" else one) for one in entries
        )
        return right(hers, terms)

    monkeypatch.setattr(batch, "grade_all", ada_cannot_be_read)
    graded = course("grade", "run", "class", "--out", "my grades", "--exercise", "doubling", "--json")
    assert json.loads(graded.out.splitlines()[-1])["unsettled"] == 3
    listed = course("grade", "assign", "my grades", "--json").json["unsettled"]
    assert [(one["student"], one["reason"], one["files"] != []) for one in listed] == [
        ("ada", "syntax_error", False), ("bob", "no_file", True), ("cy", "no_file", False),
    ]  # fmt: skip
    shown = course("grade", "assign", "my grades").out
    assert "ada doubling: syntax_error: doubling.py, line 1" in shown
    assert "3 to settle; 1 with a match." in shown
    assert "`course grade assign 'my grades' --accept-names` accepts" in shown
    assert "`course grade override 'my grades' ada doubling --score 0 --reason TEXT` gives" in shown
    stopped = course("grade", "export", "my grades", "--format", "gradescope", "--json")
    error = stopped.json["error"]
    assert (stopped.code, error["code"]) == (4, "unseen_zeros")
    assert "3 could not be graded and would get 0: 'ada' doubling (syntax_error), 'bob'" in error["message"]
    assert error["help"].startswith("`course grade assign 'my grades'` lists them")
    for student in ("ada", "cy"):
        course("grade", "override", "my grades", student, "doubling", "--score", "0", "--reason", "seen")
    course("grade", "assign", "my grades", "--accept-names")
    assert course("grade", "assign", "my grades", "--json").json["unsettled"] == []
    assert course("grade", "export", "my grades", "--format", "gradescope").code == 0


def test_advice_names_the_folder_it_is_about(course, here):
    missing = course("grade", "assign", "out", "cy", "nowhere.py", "--reason", "x", "--dry-run", "--json")
    assert missing.json["error"]["help"] == "Name it as `course grade assign out` lists it, or by its path."
    lifted = course("grade", "override", "out", "ada", "doubling", "--lift", "--json")
    assert lifted.json["error"]["help"] == "`course grade explain out ada doubling` shows what counts."
    (here / "out" / "gradebook.sqlite").write_bytes(b"x" * 4096)
    damaged = course("grade", "log", "out", "--json").json["error"]["help"]
    assert damaged.startswith("`course grade salvage out --to out-salvaged` writes the intact rows")
    saved = course("grade", "salvage", "out", "--to", "saved")
    rest = "`course grade run SUBMISSIONS --exercise doubling --out saved --resume` grades what is missing"
    assert rest in " ".join(saved.out.split())


def test_a_file_in_an_archive_that_was_refused_is_named_as_it_lies_in_the_students_folder(course, here):
    manifest = json.dumps({"format_version": 1, "files": {"doubling.py": "0" * 64}})
    (here / "class" / "bob" / "hw.py").unlink()
    (here / "class" / "bob" / "w.zip").write_bytes(
        zipped({"doubling.py": SOURCE, "submission.json": manifest})
    )
    ran = course("grade", "run", "class", "--out", "new", "--exercise", "doubling")
    assert "bob doubling: checksum_mismatch" in ran.out
    ran = course(
        "grade", "assign", "new", "bob", "w.zip/doubling.py", "--exercise", "doubling", "--reason", "x"
    )
    assert "bob doubling: ungradable -> graded, 10 of 10; from 'w.zip/doubling.py'" in ran.out, ran.err


def test_a_student_is_found_by_the_name_that_every_list_shows(course, here):
    (here / "class" / "e\nve").mkdir()
    course("grade", "run", "class", "--out", "new", "--exercise", "doubling")
    assert r"e\nve doubling: no_file" in course("grade", "assign", "new").out
    given = course(
        "grade", "override", "new", r"e\nve", "doubling", "--score", "0", "--reason", "x", "--json"
    )
    assert (given.code, given.json["student"]) == (0, "e\nve")


def test_no_file_is_offered_for_a_quiz(course, here):
    shutil.copytree(MINI.parents[2] / "quiz", here / "content" / "quiz", dirs_exist_ok=True)
    (here / "class" / "ada" / "submission.json").write_text("[1")
    course("grade", "run", "class", "--out", "new", "--exercise", "quiz")
    told = " ".join(course("grade", "assign", "new").out.split())
    assert (
        "`course grade override new ada quiz --score 0 --reason TEXT` gives a score by hand; --resume" in told
    )
    refused = course("grade", "assign", "new", "ada", "x.py", "--exercise", "quiz", "--reason", "x", "--json")
    assert "A quiz is graded from its record" in refused.json["error"]["message"]


_META = "{0}:\n  :submitters:\n  - :name: Ada\n    :sid: '{1}'\n    :email: ada@u.x\n"


@pytest.mark.parametrize(
    ("first", "later"),
    [
        ("byronada_109_1_doubling.py", "lovelaceada_109_2_doubling-1.py"),
        ("Ada Byron_109_assignsubmission_file/doubling.py", "Ada L_109_assignsubmission_file/doubling.py"),
        ("Zo\u00eb/doubling.py", "Zoe\u0308/doubling.py"),
        ("submission_1/doubling.py", "submission_2/doubling.py"),
    ],
    ids=["canvas", "moodle", "folders", "gradescope"],
)
def test_a_student_whose_name_or_id_is_written_otherwise_later_stays_one(course, here, first, later):
    for number, path in enumerate((first, later)):
        file = here / f"week{number}" / path
        file.parent.mkdir(parents=True)
        file.write_text(SOURCE + "# more\n" * number)
        if path.startswith("submission"):
            pytest.importorskip("yaml")
            sid = "0012" if number else ""  # entered in Gradescope after the first download
            (file.parents[1] / "submission_metadata.yml").write_text(_META.format(file.parent.name, sid))
    run = ("grade", "run", "--out", "new", "--exercise", "doubling")
    assert course(*run, "week0").code == 0
    (student,) = [one["student"] for one in read_csv(here / "new" / "grades.csv")]
    course("grade", "override", "new", student, "doubling", "--score", "3", "--reason", "oral")
    assert course(*run, "week1", "--resume").code == 0
    rows = [(one["student"], one["score"], one["raw_score"]) for one in read_csv(here / "new" / "grades.csv")]
    assert rows == [(student, "3", "10")]


def test_of_two_submissions_of_one_student_an_instructor_has_to_choose(course, here):
    pytest.importorskip("yaml")
    for name in ("submission_1", "submission_2"):
        (here / "gs" / name).mkdir(parents=True)
        (here / "gs" / name / "doubling.py").write_text(f"{SOURCE}# {name}\n")
        (here / "gs" / name / "submission.json").write_text('{"format_version": 1')
    told = "".join(_META.format(name, "0012") for name in ("submission_1", "submission_2"))
    (here / "gs" / "submission_metadata.yml").write_text(told)
    (here / "roster.csv").write_text("student,canvas_id\n0012,1\n")
    ran = course("grade", "run", "gs", "--out", "new", "--exercise", "doubling", "--roster", "roster.csv")
    assert (ran.code, "handed in nothing" in ran.out) == (6, False)
    (one,) = course("grade", "assign", "new", "--json").json["unsettled"]
    assert (one["reason"], one["message"]) == (
        "ambiguous_files",
        "'0012' has several submissions: 'submission_1', 'submission_2'.",
    )
    assert [file["file"] for file in one["files"]] == ["submission_1/doubling.py", "submission_2/doubling.py"]
    export = (
        "grade",
        "export",
        "new",
        "--format",
        "canvas",
        "--assignment",
        "doubling=1",
        "--missing",
        "zero",
    )
    assert course(*export, "--json").json["error"]["code"] == "unseen_zeros"
    ran = course("grade", "assign", "new", "0012", "submission_2/doubling.py", "--reason", "the later one")
    assert "0012 doubling: ungradable -> graded, 10 of 10" in ran.out
    assert course(*export).code == 0


def test_a_file_without_an_owner_stops_an_export_until_it_is_someones(course, here):
    (here / "class" / "eve_doubling.py").write_text(SOURCE)
    (here / "roster.csv").write_text("student,canvas_id\nada,1\neve,2\n")
    for name in ("bob", "cy"):
        shutil.rmtree(here / "class" / name)
    run = ("grade", "run", "class", "--out", "new", "--exercise", "doubling", "--roster", "roster.csv")
    assert course(*run).code == 6
    said = "'eve_doubling.py': is in no student's folder"
    assert course("grade", "assign", "new", "--json").json["unrecognised"] == [said]
    assert f"1 of unknown owner:\n  {said}" in course("grade", "assign", "new").out
    assert "eve_doubling.py" in (here / "new" / "report.html").read_text("utf-8")
    export = ("grade", "export", "new", "--format", "canvas", "--assignment", "doubling=1")
    assert course(*export, "--json").json["error"]["code"] == "unknown_owner"
    assert course(*export, "--accept-zeros").code == 0
    file = ("class/eve_doubling.py", "--exercise", "doubling", "--reason", "by its name")
    course("grade", "assign", "new", "eve", *file)
    assert course(*export).code == 0
    course("grade", "assign", "new", "eve", "--lift")
    assert course(*export).code == 4
    (here / "class" / "eve_doubling.py").unlink()
    course(*run, "--resume")
    assert course(*export).code == 0


def test_a_file_assigned_to_the_wrong_student_is_taken_back(course, here):
    (here / "roster.csv").write_text("student\nada\nbob\ncy\neve\n")
    again = ("grade", "run", "class", "--out", "out", "--exercise", "doubling", "--resume")
    course(*again, "--roster", "roster.csv")

    def row(student):
        found = {one["student"]: one for one in read_csv(here / "out" / "grades.csv")}[student]
        return found["state"], found["reason"], found["score"]

    was = row("bob"), row("eve")
    assert (
        course("grade", "assign", "out", "eve", "--lift", "--json").json["error"]["code"] == "no_assignment"
    )
    for student, file in (("eve", "class/bob/hw.py"), ("bob", "hw.py")):
        course("grade", "assign", "out", student, file, "--exercise", "doubling", "--reason", "x")
        assert row(student) == ("graded", "", "10")
    before = book(here)
    told = course("grade", "assign", "out", "eve", "--lift", "--dry-run").out
    assert ("1 would be taken back." in told, book(here)) == (True, before)
    told = course("grade", "assign", "out", "eve", "--lift").out
    assert "eve doubling: graded -> missing, no score; without 'class/bob/hw.py'" in told
    (lifted,) = course("grade", "assign", "out", "bob", "--lift", "--reason", "his", "--json").json["lifted"]
    assert (lifted["file"], lifted["state_after"], lifted["score_after"]) == ("hw.py", "ungradable", 0.0)
    assert (
        (row("bob"), row("eve")) == was == (("ungradable", "no_file", "0"), ("missing", "not_submitted", ""))
    )
    course(*again)
    assert (row("bob"), row("eve")) == was
    assert "hw.py: defines double" in course("grade", "assign", "out").out
    assert "eve" not in course("grade", "similar", "out").out
    assert "10 of 10, 'class/bob/hw.py' -> no score" in course("grade", "log", "out", "eve").out
    assert course("grade", "salvage", "out", "--to", "new").code == 0
    assert '"eve","doubling",""' in (here / "new" / "grades.csv").read_text("utf-8")
    course(
        "grade", "assign", "out", "eve", "class/bob/hw.py", "--exercise", "doubling", "--reason", "after all"
    )
    assert row("eve") == ("graded", "", "10")
    for words in (("eve", "hw.py", "--lift"), ("--lift",), ("eve", "--lift", "--accept-names")):
        assert course("grade", "assign", "out", *words).code == 2


def test_a_run_says_how_the_class_did_in_each_exercise(course, here):
    run = ("grade", "run", "class", "--out", "out", "--exercise", "doubling", "--resume")
    assert "median" not in course(*run).out, "one grade has no middle"
    for student in ("dan", "eve"):
        shutil.copytree(here / "class" / "ada", here / "class" / student)
    course(*run)
    course("grade", "override", "out", "ada", "doubling", "--score", "4", "--reason", "oral")
    told = "exercise: doubling; grades: 3; median: 10; half of them: 7 to 10"
    assert told in course(*run).out
    assert "median" not in course(*run, "--quiet").out


def test_a_name_means_the_file_in_the_folder_that_was_graded_last(course, here):
    shutil.copytree(here / "class", here / "second")
    (here / "second" / "ada" / "better.py").write_text(SOURCE.replace("return x", "return [x]"))
    (here / "class" / "ada" / "old.py").write_text(SOURCE)
    course("grade", "run", "second", "--out", "out", "--exercise", "doubling", "--resume")
    words = ("grade", "assign", "out", "ada")
    more = ("--exercise", "doubling", "--reason", "x", "--json")
    (one,) = course(*words, "better.py", *more).json["assigned"]
    assert (one["file"], one["score_after"]) == ("better.py", 10.0)
    assert course(*words, "old.py", *more).json["error"]["code"] == "file_not_found"


@pytest.mark.parametrize("beside", ["build/hers.py", "x/build/hers.py"])
def test_what_lies_in_a_build_folder_beside_a_folder_around_everything_is_listed(course, here, beside):
    for name in ("x/hw.py", beside):
        (here / "class" / "eve" / name).parent.mkdir(parents=True, exist_ok=True)
        (here / "class" / "eve" / name).write_text(SOURCE + f"# {name}\n")
    course("grade", "run", "class", "--out", "out", "--exercise", "doubling", "--resume")
    shown = "build/hers.py" if beside.startswith("x") else "../build/hers.py"
    listed = course("grade", "assign", "out", "--json").json["unsettled"]
    (files,) = ([one["file"] for one in item["files"]] for item in listed if item["student"] == "eve")
    assert files == ["hw.py", shown]
    for _ in range(2):  # from the list, and then by its name alone
        words = ("grade", "assign", "out", "eve", shown, "--exercise", "doubling", "--reason", "x", "--json")
        assert course(*words).json["assigned"][0]["score_after"] == 10.0


def test_a_name_may_be_typed_with_other_accents_than_the_folder_has(course, here):
    mac, typed = (unicodedata.normalize(form, "Zoë") for form in ("NFD", "NFC"))
    shutil.copytree(here / "class" / "ada", here / "class" / mac)
    (here / "late.toml").write_text(
        'format_version = 1\npoints_per_day = 1\n[[deadline]]\nexercise = "*"\ndue = 2026-01-01T00:00:00Z\n'
        f'[[extension]]\nstudent = "{typed}"\ndays = 2\n'
    )
    (here / "times.csv").write_text(f"student,exercise,submitted_at\n{typed},doubling,2026-01-03T00:00:00Z\n")
    only = ("--exercise", "doubling", "--only", typed, "--resume", "--json")
    assert course("grade", "run", "class", "--out", "out", *only).code == 6, "it is bob's"
    assert course("grade", "explain", "out", typed, "doubling").code == 0
    late = ("late", "out", "--policy", "late.toml", "--times", "times.csv", "--json")
    told = course("grade", *late).json
    assert (told["late"], told["unknown_names"]) == ([], [])
    assert course("grade", "override", "out", typed, "doubling", "--score", "3", "--reason", "x").code == 0
    students = {row["student"] for row in read_csv(here / "out" / "grades.csv")}
    assert (mac in students, typed in students) == (True, False)


def test_a_score_by_hand_for_nothing_is_no_work_that_could_not_be_graded(course, here):
    (here / "roster.csv").write_text("student\nada\nbob\ncy\neve\n")
    course("grade", "run", "class", "--out", "out", "--resume", "--roster", "roster.csv")
    course("grade", "override", "out", "eve", "doubling", "--score", "3", "--reason", "oral")
    row = {one["student"]: one for one in read_csv(here / "out" / "grades.csv")}["eve"]
    assert (row["state"], row["score"], row["raw_score"]) == ("missing", "3", "")


def test_a_preview_of_a_score_or_a_policy_changes_nothing(course, here):
    before = book(here)
    ran = course("grade", "override", "out", "ada", "doubling", "--score", "3", "--reason", "x", "--dry-run")
    assert "3 of 10 would count" in ran.out
    (here / "late.toml").write_text(
        'format_version = 1\npoints_per_day = 1\ntrust = ["list"]\n'
        '[[deadline]]\nexercise = "*"\ndue = 2026-01-01T00:00:00Z\n'
    )
    (here / "times.csv").write_text("student,exercise,submitted_at\nada,doubling,2026-01-01T12:00:00Z\n")
    words = ("grade", "late", "out", "--policy", "late.toml", "--times", "times.csv")
    told = course(*words, "--dry-run", "--json").json
    scores = {"before": 10.0, "after": 9.0, "max_before": 10.0, "max_after": 10.0}
    assert told["moved"] == [{"student": "ada", "exercise": "doubling"} | scores]
    assert book(here) == before
    assert "1 score changed." in course(*words, "--reason", "the rules").out
    (change,) = course("grade", "log", "out", "--json").json["changes"]
    assert (change["kind"], change["reason"], change["before"]) == (
        "late", "the rules", '[["ada","doubling",10.0]]',
    )  # fmt: skip
    assert "ada doubling 10 -> ada doubling 9" in course("grade", "log", "out").out
    assert "ada doubling 10" in course("grade", "log", "out", "ada", "doubling").out
    assert "ada doubling" not in course("grade", "log", "out", "bob").out, (
        "a class's change was told of others"
    )


def test_a_time_in_a_list_is_not_that_of_other_work_which_comes_later(course, here):
    (here / "late.toml").write_text(
        'format_version = 1\npercent_per_day = 10\n[[deadline]]\nexercise = "*"\ndue = 2026-01-01T00:00:00Z\n'
    )
    (here / "times.csv").write_text("student,exercise,submitted_at\nada,doubling,2026-01-01T12:00:00Z\n")
    course("grade", "late", "out", "--policy", "late.toml", "--times", "times.csv")
    again = ("grade", "run", "class", "--out", "out", "--exercise", "doubling", "--resume")
    (here / "class" / "ada" / "doubling.py").write_text(SOURCE + "# more\n")
    told = json.loads(course(*again, "--json").out.splitlines()[-1])
    assert told["untimed"] == ["ada doubling"]
    assert "no trusted submission time" in course("grade", "late", "out").out
    rows = {row["student"]: row for row in read_csv(here / "out" / "grades.csv")}
    assert (rows["ada"]["submitted_at"], rows["ada"]["score"]) == ("", "10")
    (here / "class" / "ada" / "doubling.py").write_text(SOURCE)  # as it was, when it was
    course(*again)
    rows = {row["student"]: row for row in read_csv(here / "out" / "grades.csv")}
    assert (rows["ada"]["submitted_at"], rows["ada"]["score"]) == ("2026-01-01T12:00:00Z", "9")


def test_resuming_after_an_edit_says_who_would_change_and_changes_nobody(course, here, monkeypatch):
    checks = here / "content" / "graders" / "doubling" / "checks.py"
    checks.write_text(checks.read_text() + "# edited\n")
    words = ("grade", "run", "class", "--out", "out", "--exercise", "doubling", "--resume")
    told = json.loads(course(*words, "--json").out.splitlines()[-1])
    assert (told["edited"], told["already_graded"], told["would_change"]) == (["doubling"], 3, [])
    told = course(*words).out
    assert "No score was changed by that. With the present graders, 0 would change." in told
    assert "gives these scores" not in told
    runs = course("grade", "log", "out", "--json").json["runs"]
    assert [run["kind"] for run in runs] == ["run"]
    assert course("grade", "rerun", "out", "--against", "1", "--dry-run").code == 0
    refused = course("grade", "rerun", "out", "--against", "nothing", "--dry-run", "--json")
    assert (refused.code, refused.json["error"]["code"]) == (5, "snapshot_not_found")
    fault = Problem("check_file", "graders/doubling/checks.py:1: it cannot be imported (SyntaxError).")
    broken = verdict(state="grader_error", error=fault)
    monkeypatch.setattr(
        batch, "grade_all", lambda entries, *_, **__: [Graded(one, broken) for one in entries]
    )
    for ran in (course(*words), course("grade", "rerun", "out")):
        assert "1 hit a fault of the grader and keep what counted:" in ran.out
        assert fault.message in " ".join(ran.out.split())
    assert ran.code == 70
    assert course("grade", "explain", "out", "ada", "doubling", "--json").json["score"] == 10.0


def test_a_check_that_breaks_on_a_submission_is_told_by_each_command_that_grades(course, here, monkeypatch):
    """Only a run told it: after a regrading a student had lost points, and nothing said by whose fault."""
    odd = msgspec.structs.replace(
        check("shown", Status.FAIL), traceback=f"{OURS}KeyError: 3 (checks.py, line 9)"
    )
    monkeypatch.setattr(
        batch, "grade_all", lambda entries, *_, **__: [Graded(one, verdict(odd)) for one in entries]
    )
    where = "doubling shown, 1 of the results: In the check's own code: KeyError: 3 (checks.py, line 9)"
    for words in (
        ("grade", "assign", "out", "--accept-names", "--dry-run"),
        ("grade", "rerun", "out", "--all"),
        ("grade", "run", "class", "--out", "out", "--exercise", "doubling", "--resume"),
    ):
        told = " ".join(course(*words).out.split())
        assert f"(its result stands): {where}" in told, words
        assert json.loads(course(*words, "--json").out.splitlines()[-1])["unjudged"] == [where]


def test_a_damaged_gradebook_is_salvaged_into_a_new_folder(course, here):
    assert course("grade", "override", "out", "ada", "doubling", "--score", "3", "--reason", "x").code == 0
    damaged = bytes(4096) + book(here)[4096:]
    (here / "out" / "gradebook.sqlite").write_bytes(damaged)
    assert "course grade salvage" in course("grade", "explain", "out", "ada", "doubling").err
    tried = course("grade", "salvage", "out", "--to", "new", "--dry-run", "--json")
    assert (tried.code, tried.json["rows"]["overrides"], tried.json["lost"]) == (0, 1, [])
    assert not (here / "new").exists()
    listed = "student,exercise,submitted_at\nnobody,doubling,2026-01-01T12:00:00Z\n"
    (here / "times.csv").write_text(listed)
    shutil.copytree(here / "out", here / "whole")
    shutil.copyfile(here / "out" / "gradebook.backup-1.sqlite", here / "whole" / "gradebook.sqlite")
    assert course("grade", "late", "whole", "--times", "times.csv").code == 0
    told = course("grade", "salvage", "whole", "--to", "other", "--json")
    assert (told.code, told.json["lost"]) == (0, []), "a time in a list was told to be a lost result"
    assert course("grade", "salvage", "out", "--to", "new").code == 0
    assert book(here) == damaged
    found = course("grade", "explain", "new", "ada", "doubling", "--json").json
    assert (found["score"], found["raw_score"]) == (3.0, 10.0)
    assert course("grade", "salvage", "out", "--to", "new", "--json").json["error"]["code"] == "out_exists"
    assert course("grade", "salvage", "nowhere", "--to", "newer").code == 5
    assert not (here / "newer").exists()


def test_the_summary_says_what_passes_and_whose_files_there_are(course, here):
    ran = course("grade", "run", "class", "--out", "again", "--exercise", "doubling")
    assert "1 graded, 1 of them pass (pass mark: 7 of 10)." in ran.out
    listed = "lists the files of those that could not be graded"
    assert listed in " ".join(ran.out.split())
    ran = course("grade", "override", "again", "cy", "doubling", "--score", "0", "--reason", "x", "--dry-run")
    assert "0 of 10 would count; no check ran." in ran.out


@pytest.mark.parametrize(
    ("encoding", "named"),
    [("cp1252", "Windows' western code page"), ("utf-16", "UTF-16"), ("utf-32", "UTF-32")],
)
def test_work_in_an_undeclared_encoding_is_settled_by_its_own_name_and_named_and_proposed(
    course, here, monkeypatch, encoding, named
):
    graded = []

    def kept(entries, terms, graders):
        given = list(entries)
        graded.extend(source for entry in given for source in entry.submission.files.values())
        return right(given, terms)

    for student, name in (("ada", "doubling.py"), ("bob", "hw.py")):
        text = f"# ça va – très bien\n{SOURCE}"
        (here / "class" / student / name).write_bytes(text.encode(encoding))
    with monkeypatch.context() as patch:
        patch.setattr(batch, "grade_all", kept)
        ran = course("grade", "assign", "out", "bob", "hw.py", "--reason", "by mail")
    assert ran.code == 0, ran.err
    assert [source.decode() for source in graded[-1:]] == [text]
    ran = course("grade", "run", "class", "--out", "new", "--exercise", "doubling")
    assert f"ada doubling: syntax_error: 'doubling.py' is saved in {named}" in " ".join(ran.out.split())
    listed = course("grade", "assign", "new").out
    assert f"ada doubling: syntax_error: 'doubling.py' is saved in {named}" in " ".join(listed.split())
    assert "doubling.py: defines double, doublings; proposed" in listed
    ran = course("grade", "assign", "new", "--accept-names")
    assert "ada doubling: ungradable -> graded, 10 of 10; from 'doubling.py'" in ran.out


def test_what_was_decided_before_a_folder_came_stays_with_its_student(course, here):
    """Until then a student is called as Canvas' roster has it; the score by hand stayed with that name."""
    sheet = 'Student,ID,SIS User ID,SIS Login ID,Section\n"L, Ada",1,ada,al,A\n"N, Dan",4,dan,dn,A\n'
    (here / "canvas.csv").write_text(sheet, "utf-8")
    (here / "late.toml").write_text(
        'format_version = 1\npercent_per_day = 10\n[[deadline]]\nexercise = "*"\ndue = 2026-12-01T00:00:00Z\n'
    )
    again = ("grade", "run", "class", "--out", "new", "--exercise", "doubling", "--roster", "canvas.csv")
    course(*again)
    ran = course("grade", "override", "new", "dan", "doubling", "--score", "3", "--reason", "oral")
    called = ran.out.split(" doubling")[0]
    assert called != "dan"
    times = f"student,exercise,submitted_at\n{called},doubling,2026-12-03T00:00:00Z\n"
    (here / "times.csv").write_text(times, "utf-8")
    assert course("grade", "late", "new", "--policy", "late.toml", "--times", "times.csv").code == 0
    shutil.copytree(here / "class" / "ada", here / "class" / "dan")
    course(*again, "--resume")
    rows = [row for row in (here / "new" / "grades.csv").read_text("utf-8").splitlines() if "Dan" in row]
    assert [row.split(",")[:3] for row in rows] == [['"dan"', '"doubling"', '"3"']]
    assert "oral" in course("grade", "explain", "new", "dan", "doubling").out
    log = course("grade", "log", "new", "dan", "--json").json["changes"]
    assert [one["kind"] for one in log if one["student"]] == ["override", "resume"]
    course("grade", "override", "new", "dan", "doubling", "--lift")
    assert "score: 8 of 10, passed" in course("grade", "explain", "new", "dan", "doubling").out, (
        "two days late"
    )


def test_students_who_are_called_as_exercises_are_graded_and_it_is_said(course, here):
    for name in ("doubling", "halving"):
        shutil.copytree(MINI / "solutions" / name, here / "other" / name)
    ran = course("grade", "run", "other", "--out", "new", "--json")
    assert ran.code == 0, ran.err
    assert "taken for a student" in ran.err
    table = read_csv(here / "new" / "grades.csv")
    full = {row["student"]: row["score"] == row["max_score"] for row in table}
    assert full == {"doubling": True, "halving": True}


_METADATA = "".join(
    f"submission_{n}:\n  :submitters:\n  - :sid: {who}\n  :created_at: 2026-11-01 10:00:00 Z\n"
    for n, who in enumerate(("ada", "bob"))
)


@pytest.mark.parametrize("layout", ["auto", "gradescope", "folders", "moodle"])
@pytest.mark.parametrize("name", ["ada", "Ada_11_assignsubmission_file", "assignment_77_export"])
def test_what_one_student_hands_in_grades_nobody_else(course, here, name, layout):
    """The only entry of a folder was searched for Gradescope's list, and that was believed."""
    for n in range(2):
        (here / "second" / name / f"submission_{n}").mkdir(parents=True)
        (here / "second" / name / f"submission_{n}" / "doubling.py").write_text(SOURCE)
    (here / "second" / name / "submission_metadata.yml").write_text(_METADATA)
    with Gradebook(here / "out" / "gradebook.sqlite") as kept:
        before = kept.history("bob", "doubling")
    ran = course("grade", "run", "second", "--out", "out", "--resume", "--layout", layout, "--json")
    with Gradebook(here / "out" / "gradebook.sqlite") as kept:
        assert kept.history("bob", "doubling") == before
        assert not [one for one in kept.times() if one.source == "gradescope"]
    if ran.code == 2:  # it is a download, or one student's work: whoever grades says which
        assert f"second/{name}" in ran.json["error"]["help"]
        whole = course("grade", "run", f"second/{name}", "--out", "new", "--exercise", "doubling", "--json")
        assert whole.code == 0, whole.err
    assert (ran.code == 2) == (layout == "gradescope" or (layout == "auto" and "Ada" not in name))


@pytest.mark.parametrize(
    ("files", "said"),
    [
        ({"w.zip": zipped({"doubling.py": SOURCE, "a/" * 30_000 + "x.md": ""})}, ["w.zip", "100 folders"]),
        ({f"{n}.tar.gz": _long_tar(60) for n in range(2)}, ["a gzip archive without", "more than 100 MB"]),
        ({"w.tar.gz": _long_tar(101)}, ["w.tar.gz", "more than 100 MB"]),
    ],
)  # fmt: skip
def test_small_archives_that_would_take_minutes_cost_their_student_alone(course, here, files, said):
    (here / "class" / "bob" / "hw.py").unlink()
    for name, content in files.items():
        (here / "class" / "bob" / name).write_bytes(content)
    ran = course("grade", "run", "class", "--out", "new", "--exercise", "doubling", "--json")
    graded = {one["student"]: one for one in map(json.loads, ran.out.splitlines()) if one.get("student")}
    assert all(part in graded["bob"]["error"]["message"] for part in said), graded["bob"]
    assert graded["ada"]["state"] == "graded"
