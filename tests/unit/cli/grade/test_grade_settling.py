"""`course grade assign|log|salvage`, and what `--dry-run` and `--resume` say before a score changes."""

import html
import io
import json
import shutil
import tarfile
import unicodedata
from dataclasses import replace

import msgspec
import pytest

from course.grading.gradebook.book import Gradebook
from course.grading.running import batch
from course.scoring.verdict import OURS, Problem, Status
from tests.unit.cli.grade.conftest import NEW, RUN, SOURCE, grades, write, write_policy, write_times
from tests.unit.grading.conftest import MINI
from tests.unit.grading.made import check, verdict, zipped
from tests.unit.grading.running.test_run import right

pytestmark = pytest.mark.usefixtures("unpacked")


def _long_tar(size):
    """So many MB that are no code, in some kB."""
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode="w:gz") as archive:
        info = tarfile.TarInfo("long.md")
        info.size = size << 20
        archive.addfile(info, io.BytesIO(bytes(info.size)))
    return buffer.getvalue()


@pytest.fixture
def here(course, ungraded, content, tmp_path):
    """A class of three, graded by stand-ins: one right name, one wrong name, one in nobody's sight."""
    for name in ("ada/doubling.py", "bob/hw.py", "cy/.notes"):
        write(tmp_path / "class", name)
    course(RUN, "--json").ends(6)
    return tmp_path


def book(here):
    return (here / "out" / "gradebook.sqlite").read_bytes()


def test_what_is_unsettled_is_listed_previewed_and_settled(course, here):
    before = book(here)
    listed = course("grade assign out --json").json
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
    assert "hw.py: defines double, doublings; proposed" in course("grade assign out").out
    course("grade assign out --accept-names --dry-run").says("would be left to settle")
    tried = course("grade assign out --accept-names --dry-run --json").json
    assert [(one["student"], one["score_before"], one["score_after"]) for one in tried["assigned"]] == [
        ("bob", 0.0, 10.0)
    ]
    assert book(here) == before
    ran = course("grade assign out bob hw.py --reason 'by mail'")
    ran.ends(0, "bob doubling: ungradable -> graded, 10 of 10; from 'hw.py'")
    log = course("grade log out --json").json
    assert [run["kind"] for run in log["runs"]] == ["run", "assign"]
    (change,) = log["changes"]
    assert (change["kind"], change["student"], change["reason"]) == ("assign", "bob", "by mail")
    assert change["who"]
    course("grade log out bob").says("by mail", "0 of 10, no_file -> 10 of 10, 'hw.py'")
    course("grade explain out bob doubling").says("by mail; before: 0 of 10, no_file")
    for line, code in (
        ("bob", "usage"), ("bob x.py --accept-names", "usage"), ("bob class/bob/hw.py", "no_reason"),
        ("nobody hw.py --reason x", "student_not_found"), ("cy nowhere.py --reason x", "file_not_found"),
    ):  # fmt: skip
        assert course(f"grade assign out {line} --json").json["error"]["code"] == code


def test_an_assigned_file_counts_until_another_file_with_the_right_name_arrives(course, here):
    """Ada's own file was there when the instructor chose another: reading it again is no arrival."""

    def resumed():
        return course(f"{RUN} --resume --json").last["already_graded"]

    def counts():
        with Gradebook(here / "out" / "gradebook.sqlite") as book:
            (one,) = book.results("ada", "doubling")
        return one.key.submission_sha256

    own = counts()
    chosen = []
    for name in ("first.py", "second.py"):
        write(here, name, f"{SOURCE}# {name}\n")
        course(f"grade assign out ada {name} --exercise doubling --reason 'by mail'").ends(0)
        chosen.append(counts())
        assert resumed() == 3
        assert counts() == chosen[-1]
    course("grade assign out --accept-names").ends(0)
    assert "hw.py has changed" not in course(f"{RUN} --resume").out
    write(here, "class/bob/hw.py", SOURCE + "# changed\n")
    changed = "bob doubling: hw.py has changed since it was assigned."
    assert f"1 graded before, and kept as they were: {changed}" in course(f"{RUN} --resume").words
    write(here, "class/ada/doubling.py", SOURCE + "# later\n")
    resumed()
    assert counts() not in {own, *chosen}
    write(here, "class/ada/doubling.py")
    resumed()
    assert counts() == own, "changed back, after another had counted"


@pytest.fixture
def with_quiz(content):
    """And a quiz is part of their course."""
    shutil.copytree(MINI.parents[2] / "quiz", content / "quiz", dirs_exist_ok=True)


@pytest.mark.usefixtures("with_quiz")
def test_a_quiz_record_that_cannot_be_read_is_no_missing_quiz(course, here):
    """Beside an exercise that was asked for, too: the student was told that nothing was handed in."""
    (here / "class" / "ada" / "mine.zip").write_bytes(zipped({"submission.json": b"{"}))
    for out, more in (("alone", ""), ("both", "--exercise doubling")):
        course(f"grade run class --out {out} --exercise quiz {more}")
        course(f"grade explain {out} ada quiz").says("ungradable")


def test_who_is_called_as_two_are_is_asked_back_and_nobody_s_log_is_refused(course, here):
    write(here, "roster.csv", "student,name\nada,John Smith\nbob,John Smith\ncy,Cy\n")
    course(f"{NEW} --roster roster.csv")
    course("grade explain new 'John Smith' doubling").refuses(
        5, "2 students are called 'John Smith'.", "ada, bob"
    )
    for about in ("nobody", "ada nothing"):
        course(f"grade log new {about} --json").ends(5)


def test_a_file_with_functions_that_the_graded_one_lacks_is_listed_until_one_of_them_is_assigned(
    course, here, graded_as
):
    graded_as(verdict(check("shown", Status.FAIL)))
    write(here, "class/ada/doubling.py", "def double(x):\n    return 2 * x\n")
    for name in ("ada/new/doubling.py", "bob/doubling.py"):
        write(here / "class", name)
    named = "ada doubling: doublings in 'new/doubling.py'"
    course(NEW).says(
        f"1 graded without functions that another file has:\n  {named}\n",
        "`course grade assign new STUDENT FILE --exercise ID --reason TEXT` grades that",
    )
    assert course(f"{NEW} --resume --json").last["elsewhere"] == [named]
    course("grade rerun new --all").ends(0)
    course("grade assign new").says(named)
    assert course("grade assign new --json").json["elsewhere"] == [named]
    page = html.unescape((here / "new/report.html").read_text())
    assert "Doubling (doublings in 'new/doubling.py')" in page
    course("grade assign new ada doubling.py --exercise doubling --reason asked").ends(0)
    assert course("grade assign new --json").json["elsewhere"] == []


def test_an_assignment_under_a_score_by_hand_says_whose_points_count(course, here):
    course("grade override out bob doubling --score 3 --reason oral")
    said = course("grade assign out bob hw.py --exercise doubling --reason his").words
    assert "graded, 3 of 10 by hand (the checks gave 10); from 'hw.py'" in said


def test_a_regrading_names_the_exercise_that_its_graders_do_not_have(course, here, content):
    shutil.move(content / "exercises" / "doubling", here / "doubling")
    ran = course("grade rerun out --all").lacks("Without a submission")
    ran.says("These graders do not have the exercise doubling; unchanged: ")


def test_what_was_said_of_a_file_stays_when_it_is_graded_again(course, here):
    write(here, "class/ada/more.py", SOURCE + "# another\n")
    course(NEW)
    course("grade assign new --accept-names").ends(0)

    def notes():
        told = [course(f"grade explain new {who} doubling").out for who in ("ada", "bob")]
        return [[line for line in one.splitlines() if "note" in line] for one in told]

    ada, bob = before = notes()
    assert "Also there, and not graded: 'more.py'" in "".join(ada)
    assert "Graded from 'hw.py', assigned by the instructor" in "".join(bob)
    course("grade rerun new --all").ends(0)
    assert notes() == before


def test_a_resumed_run_says_whose_score_became_lower(course, here, graded_as):
    graded_as(verdict(check("shown", Status.FAIL)))
    write(here, "class/ada/doubling.py", SOURCE + "# an older one\n")
    said = "1 lower than before, by what was handed in now: ada doubling: 10 before, 0 now"
    assert said in course(f"{RUN} --resume").words


def test_every_zero_that_stops_an_export_is_listed_with_a_way_to_settle_it(course, here, monkeypatch):
    """A syntax error stopped the export, while `grade assign` said that there was nothing to settle."""
    broken = Problem("syntax_error", "doubling.py, line 1: Python cannot read this file.", "Look there.")

    def ada_cannot_be_read(entries, terms, graders):
        return right(
            (replace(one, problem=broken) if one.student == "ada" else one for one in entries), terms
        )

    monkeypatch.setattr(batch, "grade_all", ada_cannot_be_read)
    graded = course("grade run class --out 'my grades' --exercise doubling --json")
    assert graded.last["unsettled"] == 3
    listed = course("grade assign 'my grades' --json").json["unsettled"]
    assert [(one["student"], one["reason"], one["files"] != []) for one in listed] == [
        ("ada", "syntax_error", False), ("bob", "no_file", True), ("cy", "no_file", False),
    ]  # fmt: skip
    course("grade assign 'my grades'").says(
        "ada doubling: syntax_error: doubling.py, line 1",
        "3 to settle; 1 with a match.",
        "`course grade assign 'my grades' --accept-names` accepts",
        "`course grade override 'my grades' ada doubling --score 0 --reason TEXT` gives",
    )
    stopped = course("grade export 'my grades' --format gradescope --json")
    assert stopped.error == (4, "unseen_zeros")
    stopped.warns(
        "3 could not be graded and would get 0: 'ada' doubling (syntax_error), 'bob'",
        "\n`course grade assign 'my grades'` lists them",
    )
    for student in ("ada", "cy"):
        course(f"grade override 'my grades' {student} doubling --score 0 --reason seen")
    course("grade assign 'my grades' --accept-names")
    assert course("grade assign 'my grades' --json").json["unsettled"] == []
    course("grade export 'my grades' --format gradescope").ends(0)


def test_advice_names_the_folder_it_is_about(course, here):
    missing = course("grade assign out cy nowhere.py --reason x --dry-run --json")
    assert missing.json["error"]["help"] == "Name it as `course grade assign out` lists it, or by its path."
    lifted = course("grade override out ada doubling --lift --json")
    assert lifted.json["error"]["help"] == "`course grade explain out ada doubling` shows what counts."
    (here / "out" / "gradebook.sqlite").write_bytes(b"x" * 4096)
    damaged = course("grade log out --json").json["error"]["help"]
    assert damaged.startswith("`course grade salvage out --to out-salvaged` writes the intact rows")
    rest = "`course grade run SUBMISSIONS --exercise doubling --out saved --resume` grades what is missing"
    assert rest in course("grade salvage out --to saved").words


def test_a_file_in_an_archive_that_was_refused_is_named_as_it_lies_in_the_students_folder(course, here):
    manifest = json.dumps({"format_version": 1, "files": {"doubling.py": "0" * 64}})
    (here / "class" / "bob" / "hw.py").unlink()
    archive = zipped({"doubling.py": SOURCE, "submission.json": manifest})
    (here / "class" / "bob" / "w.zip").write_bytes(archive)
    course(NEW).says("bob doubling: checksum_mismatch")
    ran = course("grade assign new bob w.zip/doubling.py --exercise doubling --reason x")
    ran.says("bob doubling: ungradable -> graded, 10 of 10; from 'w.zip/doubling.py'")


def test_a_student_is_found_by_the_name_that_every_list_shows(course, here):
    (here / "class" / "e\nve").mkdir()
    course(NEW)
    assert r"e\nve doubling: no_file" in course("grade assign new").out
    given = course("grade override new 'e\\nve' doubling --score 0 --reason x --json")
    assert (given.code, given.json["student"]) == (0, "e\nve")


@pytest.mark.usefixtures("with_quiz")
def test_no_file_is_offered_for_a_quiz(course, here):
    write(here, "class/ada/submission.json", "[1")
    course("grade run class --out new --exercise quiz")
    way = "`course grade override new ada quiz --score 0 --reason TEXT` gives a score by hand; --resume"
    assert way in course("grade assign new").words
    refused = course("grade assign new ada x.py --exercise quiz --reason x")
    refused.warns("A quiz is graded from its record")


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
        file = write(here / f"week{number}", path, SOURCE + "# more\n" * number)
        if path.startswith("submission"):
            pytest.importorskip("yaml")
            sid = "0012" if number else ""  # entered in Gradescope after the first download
            (file.parents[1] / "submission_metadata.yml").write_text(_META.format(file.parent.name, sid))
    course("grade run week0 --out new --exercise doubling").ends(0)
    (student,) = grades(here / "new" / "grades.csv")
    course(f"grade override new '{student}' doubling --score 3 --reason oral")
    course("grade run week1 --out new --exercise doubling --resume").ends(0)
    ((again, row),) = grades(here / "new" / "grades.csv").items()
    assert (again, row["score"], row["raw_score"]) == (student, "3", "10")


def test_of_two_submissions_of_one_student_an_instructor_has_to_choose(course, here):
    pytest.importorskip("yaml")
    for name in ("submission_1", "submission_2"):
        write(here / "gs" / name, "doubling.py", f"{SOURCE}# {name}\n")
        write(here / "gs" / name, "submission.json", '{"format_version": 1')
    told = "".join(_META.format(name, "0012") for name in ("submission_1", "submission_2"))
    write(here, "gs/submission_metadata.yml", told)
    write(here, "roster.csv", "student,canvas_id\n0012,1\n")
    ran = course("grade run gs --out new --exercise doubling --roster roster.csv")
    assert (ran.code, "handed in nothing" in ran.out) == (6, False)
    (one,) = course("grade assign new --json").json["unsettled"]
    assert one["reason"] == "ambiguous_files"
    assert one["message"] == "'0012' has several submissions: 'submission_1', 'submission_2'."
    assert [file["file"] for file in one["files"]] == ["submission_1/doubling.py", "submission_2/doubling.py"]
    export = "grade export new --format canvas --assignment doubling=1 --missing zero"
    assert course(export, "--json").json["error"]["code"] == "unseen_zeros"
    ran = course("grade assign new 0012 submission_2/doubling.py --reason 'the later one'")
    ran.says("0012 doubling: ungradable -> graded, 10 of 10")
    course(export).ends(0)


def test_a_file_without_an_owner_stops_an_export_until_it_is_someones(course, here):
    file = write(here, "class/eve_doubling.py")
    write(here, "roster.csv", "student,canvas_id\nada,1\neve,2\n")
    for name in ("bob", "cy"):
        shutil.rmtree(here / "class" / name)
    course(f"{NEW} --roster roster.csv").ends(6)
    said = "'eve_doubling.py': is in no student's folder"
    assert course("grade assign new --json").json["unrecognised"] == [said]
    course("grade assign new").says(f"1 of unknown owner:\n  {said}")
    assert "eve_doubling.py" in (here / "new" / "report.html").read_text("utf-8")
    export = "grade export new --format canvas --assignment doubling=1"
    assert course(export, "--json").json["error"]["code"] == "unknown_owner"
    course(export, "--accept-zeros").ends(0)
    course("grade assign new eve class/eve_doubling.py --exercise doubling --reason 'by its name'")
    course(export).ends(0)
    course("grade assign new eve --lift")
    course(export).ends(4)
    file.unlink()
    course(f"{NEW} --roster roster.csv --resume")
    course(export).ends(0)


def test_a_file_assigned_to_the_wrong_student_is_taken_back(course, here):
    write(here, "roster.csv", "student\nada\nbob\ncy\neve\n")
    course(f"{RUN} --resume --roster roster.csv")

    def row(student):
        found = grades(here / "out" / "grades.csv")[student]
        return found["state"], found["reason"], found["score"]

    was = row("bob"), row("eve")
    assert was == (("ungradable", "no_file", "0"), ("missing", "not_submitted", ""))
    assert course("grade assign out eve --lift --json").json["error"]["code"] == "no_assignment"
    for student, file in (("eve", "class/bob/hw.py"), ("bob", "hw.py")):
        course(f"grade assign out {student} {file} --exercise doubling --reason x")
        assert row(student) == ("graded", "", "10")
    before = book(here)
    course("grade assign out eve --lift --dry-run").says("1 would be taken back.")
    assert book(here) == before
    told = course("grade assign out eve --lift")
    told.says("eve doubling: graded -> missing, no score; without 'class/bob/hw.py'")
    (lifted,) = course("grade assign out bob --lift --reason his --json").json["lifted"]
    assert (lifted["file"], lifted["state_after"], lifted["score_after"]) == ("hw.py", "ungradable", 0.0)
    assert (row("bob"), row("eve")) == was
    course(f"{RUN} --resume")
    assert (row("bob"), row("eve")) == was
    course("grade assign out").says("hw.py: defines double")
    assert "eve" not in course("grade similar out").out
    course("grade log out eve").says("10 of 10, 'class/bob/hw.py' -> no score")
    course("grade salvage out --to new").ends(0)
    assert '"eve","doubling",""' in (here / "new" / "grades.csv").read_text("utf-8")
    course("grade assign out eve class/bob/hw.py --exercise doubling --reason 'after all'")
    assert row("eve") == ("graded", "", "10")
    for line in ("eve hw.py --lift", "--lift", "eve --lift --accept-names"):
        course(f"grade assign out {line}").ends(2)


def test_a_run_says_how_the_class_did_in_each_exercise(course, here):
    run = f"{RUN} --resume"
    assert "median" not in course(run).out, "one grade has no middle"
    for student in ("dan", "eve"):
        shutil.copytree(here / "class" / "ada", here / "class" / student)
    course(run)
    course("grade override out ada doubling --score 4 --reason oral")
    course(run).says("exercise: doubling; grades: 3; median: 10; half of them: 7 to 10")
    assert "median" not in course(run, "--quiet").out


def test_a_name_means_the_file_in_the_folder_that_was_graded_last(course, here):
    shutil.copytree(here / "class", here / "second")
    write(here, "second/ada/better.py", SOURCE.replace("return x", "return [x]"))
    write(here, "class/ada/old.py")
    course("grade run second --out out --exercise doubling --resume")
    found, lost = (
        course(f"grade assign out ada {name} --exercise doubling --reason x --json").json
        for name in ("better.py", "old.py")
    )
    (one,) = found["assigned"]
    assert (one["file"], one["score_after"]) == ("better.py", 10.0)
    assert lost["error"]["code"] == "file_not_found"


@pytest.mark.parametrize("beside", ["build/hers.py", "x/build/hers.py"])
def test_what_lies_in_a_build_folder_beside_a_folder_around_everything_is_listed(course, here, beside):
    for name in ("x/hw.py", beside):
        write(here / "class" / "eve", name, SOURCE + f"# {name}\n")
    course(f"{RUN} --resume")
    shown = "build/hers.py" if beside.startswith("x") else "../build/hers.py"
    listed = course("grade assign out --json").json["unsettled"]
    (files,) = ([one["file"] for one in item["files"]] for item in listed if item["student"] == "eve")
    assert files == ["hw.py", shown]
    for _ in range(2):  # from the list, and then by its name alone
        ran = course(f"grade assign out eve {shown} --exercise doubling --reason x --json")
        assert ran.json["assigned"][0]["score_after"] == 10.0


def test_a_name_may_be_typed_with_other_accents_than_the_folder_has(course, here):
    mac, typed = (unicodedata.normalize(form, "Zoë") for form in ("NFD", "NFC"))
    shutil.copytree(here / "class" / "ada", here / "class" / mac)
    write_policy(here, **{typed: 2})
    write_times(here, (typed, "2026-01-03T00:00:00Z"))
    course(f"{RUN} --only {typed} --resume --json").ends(6)  # it is bob's
    course(f"grade explain out {typed} doubling").ends(0)
    told = course("grade late out --policy late.toml --times times.csv --json").json
    assert (told["late"], told["unknown_names"]) == ([], [])
    course(f"grade override out {typed} doubling --score 3 --reason x").ends(0)
    students = grades(here / "out" / "grades.csv")
    assert (mac in students, typed in students) == (True, False)


def test_a_score_by_hand_for_nothing_is_no_work_that_could_not_be_graded(course, here):
    write(here, "roster.csv", "student\nada\nbob\ncy\neve\n")
    course("grade run class --out out --resume --roster roster.csv")
    course("grade override out eve doubling --score 3 --reason oral")
    row = grades(here / "out" / "grades.csv")["eve"]
    assert (row["state"], row["score"], row["raw_score"]) == ("missing", "3", "")


def test_a_preview_of_a_score_or_a_policy_changes_nothing(course, here):
    before = book(here)
    course("grade override out ada doubling --score 3 --reason x --dry-run").says("3 of 10 would count")
    write_policy(here, terms='points_per_day = 1\ntrust = ["list"]')
    write_times(here, ("ada", "2026-01-01T12:00:00Z"))
    words = "grade late out --policy late.toml --times times.csv"
    told = course(words, "--dry-run", "--json").json
    scores = {"before": 10.0, "after": 9.0, "max_before": 10.0, "max_after": 10.0}
    assert told["moved"] == [{"student": "ada", "exercise": "doubling"} | scores]
    assert book(here) == before
    course(words, "--reason", "the rules").says("1 score changed.")
    (change,) = course("grade log out --json").json["changes"]
    assert (change["kind"], change["reason"], change["before"]) == (
        "late", "the rules", '[["ada","doubling",10.0]]',
    )  # fmt: skip
    course("grade log out").says("ada doubling 10 -> ada doubling 9")
    course("grade log out ada doubling").says("ada doubling 10")
    assert "ada doubling" not in course("grade log out bob").out, "a class's change was told of others"


def test_a_time_in_a_list_is_not_that_of_other_work_which_comes_later(course, here):
    write_policy(here)
    write_times(here, ("ada", "2026-01-01T12:00:00Z"))
    course("grade late out --policy late.toml --times times.csv")
    write(here, "class/ada/doubling.py", SOURCE + "# more\n")
    assert course(f"{RUN} --resume --json").last["untimed"] == ["ada doubling"]
    course("grade late out").says("no trusted submission time")
    ada = grades(here / "out" / "grades.csv")["ada"]
    assert (ada["submitted_at"], ada["score"]) == ("", "10")
    write(here, "class/ada/doubling.py")  # as it was, when it was
    course(f"{RUN} --resume")
    ada = grades(here / "out" / "grades.csv")["ada"]
    assert (ada["submitted_at"], ada["score"]) == ("2026-01-01T12:00:00Z", "9")


def test_resuming_after_an_edit_says_who_would_change_and_changes_nobody(course, here, content, graded_as):
    checks = content / "graders" / "doubling" / "checks.py"
    checks.write_text(checks.read_text() + "# edited\n")
    told = course(f"{RUN} --resume --json").last
    assert (told["edited"], told["already_graded"], told["would_change"]) == (["doubling"], 3, [])
    told = course(f"{RUN} --resume")
    told.says("No score was changed by that. With the present graders, 0 would change.")
    assert "gives these scores" not in told.out
    assert [run["kind"] for run in course("grade log out --json").json["runs"]] == ["run"]
    course("grade rerun out --against 1 --dry-run").ends(0)
    refused = course("grade rerun out --against nothing --dry-run --json")
    assert refused.error == (5, "snapshot_not_found")
    fault = Problem("check_file", "graders/doubling/checks.py:1: it cannot be imported (SyntaxError).")
    graded_as(verdict(state="grader_error", error=fault))
    for line in (f"{RUN} --resume", "grade rerun out"):
        ran = course(line).says("1 hit a fault of the grader and keep what counted:")
        assert fault.message in ran.words
    assert ran.code == 70
    assert course("grade explain out ada doubling --json").json["score"] == 10.0


def test_a_check_that_breaks_on_a_submission_is_told_by_each_command_that_grades(course, here, graded_as):
    """Only a run told it: after a regrading a student had lost points, and nothing said by whose fault."""
    odd = f"{OURS}KeyError: 3 (checks.py, line 9)"
    graded_as(verdict(msgspec.structs.replace(check("shown", Status.FAIL), traceback=odd)))
    where = "doubling shown, 1 of the results: In the check's own code: KeyError: 3 (checks.py, line 9)"
    for line in ("grade assign out --accept-names --dry-run", "grade rerun out --all", f"{RUN} --resume"):
        assert f"(its result stands): {where}" in course(line).words, line
        assert course(line, "--json").last["unjudged"] == [where]


def test_a_damaged_gradebook_is_salvaged_into_a_new_folder(course, here):
    course("grade override out ada doubling --score 3 --reason x").ends(0)
    damaged = bytes(4096) + book(here)[4096:]
    (here / "out" / "gradebook.sqlite").write_bytes(damaged)
    course("grade explain out ada doubling").warns("course grade salvage")
    tried = course("grade salvage out --to new --dry-run --json")
    assert (tried.code, tried.json["rows"]["overrides"], tried.json["lost"]) == (0, 1, [])
    assert not (here / "new").exists()
    write_times(here, ("nobody", "2026-01-01T12:00:00Z"))
    shutil.copytree(here / "out", here / "whole")
    shutil.copyfile(here / "out" / "gradebook.backup-1.sqlite", here / "whole" / "gradebook.sqlite")
    assert course("grade late whole --times times.csv").code == 0
    told = course("grade salvage whole --to other --json")
    assert (told.code, told.json["lost"]) == (0, []), "a time in a list was told to be a lost result"
    assert course("grade salvage out --to new").code == 0
    assert book(here) == damaged
    found = course("grade explain new ada doubling --json").json
    assert (found["score"], found["raw_score"]) == (3.0, 10.0)
    assert course("grade salvage out --to new --json").json["error"]["code"] == "out_exists"
    assert course("grade salvage nowhere --to newer").code == 5
    assert not (here / "newer").exists()


def test_the_summary_says_what_passes_and_whose_files_there_are(course, here):
    ran = course(NEW).says("1 graded, 1 of them pass (pass mark: 7 of 10).")
    assert "lists the files of those that could not be graded" in ran.words
    tried = course("grade override new cy doubling --score 0 --reason x --dry-run")
    tried.says("0 of 10 would count; no check ran.")


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
        course("grade assign out bob hw.py --reason 'by mail'").ends(0)
    assert [source.decode() for source in graded[-1:]] == [text]
    for line in (NEW, "grade assign new"):
        ran = course(line)
        assert f"ada doubling: syntax_error: 'doubling.py' is saved in {named}" in ran.words
    ran.says("doubling.py: defines double, doublings; proposed")
    accepted = course("grade assign new --accept-names")
    accepted.says("ada doubling: ungradable -> graded, 10 of 10; from 'doubling.py'")


def test_what_was_decided_before_a_folder_came_stays_with_its_student(course, here):
    """Until then a student is called as Canvas' roster has it; the score by hand stayed with that name."""
    sheet = 'Student,ID,SIS User ID,SIS Login ID,Section\n"L, Ada",1,ada,al,A\n"N, Dan",4,dan,dn,A\n'
    write(here, "canvas.csv", sheet)
    write_policy(here, "2026-12-01T00:00:00Z")
    course(f"{NEW} --roster canvas.csv")
    ran = course("grade override new dan doubling --score 3 --reason oral")
    called = ran.out.split(" doubling")[0]
    assert called != "dan"
    write_times(here, (called, "2026-12-03T00:00:00Z"))
    course("grade late new --policy late.toml --times times.csv").ends(0)
    shutil.copytree(here / "class" / "ada", here / "class" / "dan")
    course(f"{NEW} --roster canvas.csv --resume")
    rows = [row for row in (here / "new" / "grades.csv").read_text("utf-8").splitlines() if "Dan" in row]
    assert [row.split(",")[:3] for row in rows] == [['"dan"', '"doubling"', '"3"']]
    course("grade explain new dan doubling").says("oral")
    log = course("grade log new dan --json").json["changes"]
    assert [one["kind"] for one in log if one["student"]] == ["override", "resume"]
    course("grade override new dan doubling --lift")
    assert "score: 8 of 10, passed" in course("grade explain new dan doubling").out, "two days late"


def test_students_who_are_called_as_exercises_are_graded_and_it_is_said(course, here):
    for name in ("doubling", "halving"):
        shutil.copytree(MINI / "solutions" / name, here / "other" / name)
    course("grade run other --out new --json").refuses(0, "taken for a student")
    table = grades(here / "new" / "grades.csv")
    full = {student: row["score"] == row["max_score"] for student, row in table.items()}
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
        write(here / "second" / name, f"submission_{n}/doubling.py")
    write(here / "second" / name, "submission_metadata.yml", _METADATA)
    with Gradebook(here / "out" / "gradebook.sqlite") as kept:
        before = kept.history("bob", "doubling")
    ran = course(f"grade run second --out out --resume --layout {layout} --json")
    with Gradebook(here / "out" / "gradebook.sqlite") as kept:
        assert kept.history("bob", "doubling") == before
        assert not [one for one in kept.times() if one.source == "gradescope"]
    if ran.code == 2:  # it is a download, or one student's work: whoever grades says which
        assert f"second/{name}" in ran.json["error"]["help"]
        course(f"grade run second/{name} --out new --exercise doubling --json").ends(0)
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
    ran = course(f"{NEW} --json")
    graded = {one["student"]: one for one in map(json.loads, ran.out.splitlines()) if one.get("student")}
    assert all(part in graded["bob"]["error"]["message"] for part in said), graded["bob"]
    assert graded["ada"]["state"] == "graded"
