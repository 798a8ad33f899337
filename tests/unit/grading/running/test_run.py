"""A whole grading run: many submissions, several graders, and what happens when it is killed."""

import hashlib
import json
import os
import shutil
from dataclasses import replace

import msgspec
import pytest

from course.catalog.load import Catalog
from course.catalog.locate import chosen
from course.errors import InternalError, MissingCapabilityError, UsageError
from course.grading import pipes
from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.records import Result
from course.grading.intake import archives
from course.grading.running import batch
from course.grading.running.batch import MAX_TRIES, Graded, grade_all
from course.grading.running.folder import open_results
from course.grading.running.grader import Answer
from course.grading.running.rerun import RerunOptions, rerun
from course.grading.running.run import RunOptions, grade_class
from course.quizzing.bank import Bank
from course.scoring.judging.submission import Terms
from course.scoring.verdict import Verdict
from tests.command_line import in_process
from tests.unit.grading.conftest import MINI
from tests.unit.grading.made import graded_class, put, read_class, roster_of, stillborn, zipped

pytestmark = pytest.mark.usefixtures("unpacked")

WRONG = b"\ndef double(x):\n    return x\n"


def make_class(folder, solution, students):
    """Every third student is wrong about one function."""
    for number in range(students):
        mistake = WRONG if number % 3 == 0 else b""
        put(folder / f"student-{number:03}" / "doubling.py", solution + mistake + b"# %d\n" % number)


def quiz_record(catalog, **more):
    """A manifest with the attempt of one who knew all the answers."""
    answers = {one.question: one.key.id for one in Bank.of(catalog).pose(5)}
    attempt = {
        "seed": 5, "version": "1", "finished_at": "2026", "questions": list(answers), "answers": answers,
        "score": len(answers),
    }  # fmt: skip
    return {"format_version": 1, "files": {}, "quiz": [attempt | more]}


def scores(out):
    with Gradebook(out / "gradebook.sqlite") as book:
        return {result.key.student: result.verdict.score for result in book.results()}


def test_results_go_neither_into_a_folder_that_is_there_nor_among_the_submissions_or_the_courses_own(
    tmp_path, catalog, solution
):
    """A large file of a student's was among the graders: the run was refused, with its graders "damaged"."""
    content = tmp_path / "content"
    shutil.copytree(catalog.content.root, content)
    put(tmp_path / "mine" / "notes.txt", b"keep")
    for folder, out, said in (
        (tmp_path / "class", tmp_path / "mine", "nothing was touched"),
        (tmp_path / "class", tmp_path / "class" / "out", "among the submissions"),
        (content / "exercises" / "doubling" / "class", tmp_path / "out", "among the course's own"),
        (content / "graders" / "class", tmp_path / "out", "among the course's own"),
    ):
        if not folder.exists():
            make_class(folder, solution, 1)
        with pytest.raises(UsageError, match=said):
            grade_class(folder, out, Catalog(chosen(content)), RunOptions(), lambda *_: None)
    assert [path.name for path in (tmp_path / "mine").iterdir()] == ["notes.txt"]
    assert not (tmp_path / "out").exists()


def test_resume_grades_only_what_is_new_and_with_the_same_seed(tmp_path, catalog, solution):
    """And a file that is again what it was gets its earlier score."""
    make_class(tmp_path / "class", solution, 4)
    first = RunOptions(exercises=("doubling",), terms=Terms(), seed=5)
    graded_class(tmp_path, catalog, first, grade=as_written)
    file = tmp_path / "class" / "student-001" / "doubling.py"
    before = file.read_bytes()
    file.write_bytes(solution + WRONG)
    again = RunOptions(exercises=("doubling",), terms=Terms(), resume=True)
    graded = []

    def report(result, *_):
        graded.append(result.student)

    summary = graded_class(tmp_path, catalog, again, report, grade=as_written)
    assert (summary.already, summary.seed) == (3, 5)
    assert scores(tmp_path / "out")["student-001"] == 6
    file.write_bytes(before)
    # As after a salvage: the results are there, and what they are of is not.
    with Gradebook(tmp_path / "out" / "gradebook.sqlite", writing=True) as book, book._transaction():
        book._db.execute("DELETE FROM submissions")
    graded_class(tmp_path, catalog, again, report, grade=as_written)
    assert graded == ["student-001"]
    with open_results(tmp_path / "out") as results:
        assert (
            rerun(results, catalog, RerunOptions(dry_run=True, everything=True), grade=as_written).kept == 0
        )
    with open_results(tmp_path / "out") as results:
        noted = results.book.journal()
    assert [(it.kind, it.student) for it in noted] == [("resume", "student-001")] * 2
    told = [[json.loads(text)["score"] for text in (it.before, it.after)] for it in noted]
    assert told == [[10, 6], [6, 10]]


@pytest.mark.parametrize("now", [{"halving.py": b"x"}, {"halving.py": b"x", "mine.py": b"y"}, {}])
def test_a_file_that_is_not_there_any_more_takes_no_score_away(tmp_path, catalog, solution, now):
    make_class(tmp_path / "class", solution, 1)
    graded_class(tmp_path, catalog, RunOptions(exercises=("doubling",), seed=5), grade=right)
    shutil.rmtree(tmp_path / "class" / "student-000")
    (tmp_path / "class" / "student-000").mkdir()
    for name, content in now.items():
        (tmp_path / "class" / "student-000" / name).write_bytes(content)
    both = RunOptions(exercises=("doubling", "halving"), resume=True)
    summary = graded_class(tmp_path, catalog, both, grade=right)
    with open_results(tmp_path / "out") as results:
        found = {item.exercise: item.score for item in results.all()}
        assert results.book.journal() == []
    assert found["doubling"] == 10.0
    assert [line.startswith("student-000 doubling: ") for line in summary.stay] == [True]
    assert ["mine.py" in line for line in summary.stay] == ["mine.py" in now]


@pytest.mark.parametrize("deaths", [MAX_TRIES - 1, MAX_TRIES])
def test_a_grader_that_dies_while_it_starts_is_replaced_unless_none_can_start(
    tmp_path, monkeypatch, unpacked, doubling, solution,
    deaths
):  # fmt: skip
    make_class(tmp_path / "class", solution, 2)
    monkeypatch.setattr(batch, "start_grader", stillborn(batch.start_grader, deaths))
    entries = read_class(tmp_path / "class", [doubling], required=True)
    graded = grade_all(entries, Terms(at_least="L1", graders=unpacked))
    if deaths < MAX_TRIES:
        assert sorted((one.entry.student, one.verdict.state) for one in graded) == [
            ("student-000", "graded"), ("student-001", "graded"),
        ]  # fmt: skip
    else:
        with pytest.raises(InternalError, match="cannot start"):
            list(graded)


def test_a_verdict_is_taken_from_who_was_asked_for_it(tmp_path, monkeypatch, unpacked, doubling, solution):
    """Whoever writes to the pipe of a grader, a frame too many must not move the next verdicts by one."""
    make_class(tmp_path / "class", solution, 3)
    read, forged = pipes.read_frame, {}
    forgeries = [
        lambda perfect: msgspec.structs.replace(perfect, number=perfect.number + 1),
        lambda _: 7,
        lambda perfect: msgspec.structs.replace(perfect, sha256="f" * 64),
    ]

    def first_a_forgery(*source):
        """Of the answers about each student."""
        frame = read(*source)
        answer = msgspec.msgpack.decode(frame, type=Answer) if frame else None
        if answer is None or answer.verdict is None or answer.sha256 in forged:
            return frame
        verdict = msgspec.structs.replace(answer.verdict, score=99.0)
        forged[answer.sha256] = forgeries[len(forged)](msgspec.structs.replace(answer, verdict=verdict))
        return msgspec.msgpack.encode(forged[answer.sha256])

    monkeypatch.setattr(pipes, "read_frame", first_a_forgery)
    entries = read_class(tmp_path / "class", [doubling], required=True)
    found = list(grade_all(entries, Terms(at_least="L1", graders=unpacked)))
    assert len(forged) == len(forgeries)
    scored = {one.entry.student: (one.verdict.state, one.verdict.score) for one in found}
    assert scored == {
        "student-000": ("graded", 6.0), "student-001": ("graded", 10.0), "student-002": ("graded", 10.0)
    }  # fmt: skip


def test_a_submission_that_stops_its_grader_holds_nobody_up(
    tmp_path, monkeypatch, unpacked, doubling, solution
):
    monkeypatch.setattr(pipes, "_TICK_S", 0.05)
    monkeypatch.setattr(batch, "MAX_TRIES", 1)  # each takes a second
    make_class(tmp_path / "class", solution, 3)
    stop = b"\nimport os, signal\nos.kill(os.getppid(), signal.SIGSTOP)\n"
    (tmp_path / "class" / "student-001" / "doubling.py").write_bytes(solution + stop)
    entries = read_class(tmp_path / "class", [doubling], required=True)
    found = {
        one.entry.student: one.verdict.state
        for one in grade_all(entries, Terms(level="L1", graders=unpacked))
    }
    assert found == {"student-000": "graded", "student-001": "grader_error", "student-002": "graded"}


def test_a_run_that_is_refused_leaves_its_name_free(tmp_path, catalog, solution):
    """Also after it noted what could not be read: the corrected command will note that again."""
    make_class(tmp_path / "class", solution, 2)
    put(tmp_path / "class" / "aaa" / "doubling.py", b"")
    out, options = tmp_path / "out", RunOptions(exercises=("doubling",), terms=Terms(at_least="L1"))

    def refused(entries, _):
        for entry in entries:
            if entry.problem is not None:
                yield Graded(entry, batch.without_grading(entry, "ungradable", entry.problem))
        raise MissingCapabilityError("No protection here.", help="Get some.", code="protection_level")

    with pytest.raises(MissingCapabilityError):
        graded_class(tmp_path, catalog, options, grade=refused)
    assert not out.exists()
    summary = graded_class(tmp_path, catalog, options, grade=right)
    assert summary.states["graded"] == 2

    # What was there before, or has a result in it, stays.
    with pytest.raises(UsageError):
        graded_class(tmp_path, catalog, options, grade=refused)
    assert (out / "gradebook.sqlite").exists()

    def broken_off(entries, terms):
        yield next(right((entry for entry in entries if entry.submission is not None), terms))
        raise MissingCapabilityError("The scheduler is gone.", help="Start it.", code="no_scheduler")

    with pytest.raises(MissingCapabilityError):
        grade_class(
            tmp_path / "class", tmp_path / "part", catalog, options, lambda *_: None, grade=broken_off
        )
    assert (tmp_path / "part" / "gradebook.sqlite").exists()


def test_the_command_reports_json_lines_and_exit_codes(tmp_path, solution, monkeypatch):
    monkeypatch.setattr(batch, "grade_all", lambda entries, terms, graders: right(entries, terms))
    make_class(tmp_path / "class", solution, 2)
    (tmp_path / "class" / "nobody").mkdir()
    line = ("grade", "run", tmp_path / "class", "--out", tmp_path / "out", "--exercise", "doubling", "--json")
    done = in_process(*line)
    assert done.returncode == 6, done.stderr
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    assert [line["schema"] for line in lines] == ["course.grade/1"] * 3 + ["course.grade-summary/1"]
    summary = lines[-1]
    assert (summary["graded"], summary["ungradable"], summary["exit_code"]) == (2, 1, 6)
    assert summary["troubled"][0]["code"] == "no_file"
    assert summary["isolation"] == {"L1": 2}


def test_quiz_attempts_that_travel_in_a_submission_are_scored_again_and_again_by_a_regrading(
    tmp_path, monkeypatch
):
    """On the real course: its quiz is real, and no worker is needed."""
    monkeypatch.delenv("COURSE_CONTENT", raising=False)
    catalog = Catalog()
    for student, claimed in (("ada", 5), ("eve", 4)):
        manifest = json.dumps(quiz_record(catalog, score=claimed))
        put(tmp_path / "class" / student / "mine.zip", zipped({"submission.json": manifest}))
    (tmp_path / "class" / "none").mkdir()
    summary = graded_class(tmp_path, catalog, RunOptions(exercises=("quiz",)))
    assert (summary.exit_code, summary.states["graded"], summary.passed) == (6, 1, 1)
    (trouble,) = summary.troubled
    assert (trouble.student, trouble.exercise, trouble.code) == ("eve", "quiz", "quiz_record_inconsistent")
    with open_results(tmp_path / "out", writing=True) as results:
        (first,) = results.all("ada")
        wrong = msgspec.structs.replace(first.verdict, score=0.0, passed=False)
        older = replace(first.result.key, grader_version="older")
        results.book.add(Result(older, wrong))
        assert rerun(results, catalog, RerunOptions()).regraded == 1
        (found,) = results.all("ada")
    assert (found.score, found.passed) == (5, True)


#: What a student hands in who took the quiz -> what becomes of the quiz, and of two exercises.
QUIZZED = {
    "the record in a zip": ({"a.zip": {"submission.json": "{quiz}"}}, "graded", "missing"),
    "the zip": ({"a.zip": {"submission.json": "{both}", "halving.py": "x"}}, "graded", "graded"),
    "the zip, unpacked": ({"submission.json": "{both}", "halving.py": "x"}, "graded", "graded"),
    "both": (
        {"a.zip": {"submission.json": "{both}", "halving.py": "x"}, "submission.json": "{both}"},
        "graded", "graded",
    ),
    "a damaged record": ({"a.zip": {"submission.json": "[1"}}, "scored. 'a.zip': its", "missing"),
    "a damaged one, unpacked": ({"submission.json": "[1"}, "scored. 'submission.json':", "missing"),
    "a newer one": (
        {"a.zip": {"submission.json": '{"format_version": 9}'}}, "scored. 'a.zip' was", "missing"
    ),
    "two": (
        {"a.zip": {"submission.json": "{quiz}"}, "submission.json": "[1"}, "graded", "missing"
    ),
    "two, one of another program": (
        {"a.zip": {"submission.json": "{quiz}"}, "submission.json": '{"task": 3}'}, "graded", "missing"
    ),
}  # fmt: skip


@pytest.mark.parametrize("how", QUIZZED)
def test_a_quiz_counts_wherever_its_record_lies_and_is_no_exercise_of_anybodys(tmp_path, copied, how):
    """A zip with a quiz alone gave 0 in every exercise, in which then everybody was missing."""
    files, quiz, halving = QUIZZED[how]
    shutil.copytree(MINI.parents[2] / "quiz", copied / "quiz", dirs_exist_ok=True)
    catalog = Catalog()
    record = quiz_record(catalog)
    both = {**record, "files": {"halving.py": hashlib.sha256(b"x").hexdigest()}}

    def filled(text):
        return text.replace("{quiz}", json.dumps(record)).replace("{both}", json.dumps(both)).encode()

    for name, held in files.items():
        inside = {member: filled(text) for member, text in held.items()} if isinstance(held, dict) else {}
        put(tmp_path / "class" / "bob" / name, zipped(inside) if inside else filled(held))
    put(tmp_path / "class" / "cy" / "halving.py", b"y")
    options = RunOptions(roster=roster_of(tmp_path, "student\nbob\ncy\n"))
    summary = graded_class(tmp_path, catalog, options, grade=right)
    with open_results(tmp_path / "out") as results:
        found = {(item.student, item.exercise): item.verdict for item in results.all()}
    assert set(found) == {(name, about) for name in ("bob", "cy") for about in ("halving", "quiz")}
    assert found["bob", "halving"].state == halving
    verdict = found["bob", "quiz"]
    assert quiz in (verdict.error.message if verdict.error else verdict.state)
    assert [row.exercise for row in summary.troubled] == ["quiz"] * (quiz != "graded")


@pytest.mark.parametrize(
    ("file", "unfinished", "said"),
    [
        ("quiz/unfinished.toml", '[[variant]]\nid = "one"\nprompt = "{name}"\n', "unfinished.toml"),
        ("exercises/doubling/exercise.toml", "# <<FILL IN: more>>\n", "{at}: still to be filled in: more."),
        ("graders/doubling/checks.py", "# <<FILL IN: more>>\n", "{at}: still to be filled in: more."),
    ],
)
def test_what_is_not_finished_is_refused_before_anything_is_graded(
    tmp_path, copied, solution, file, unfinished, said
):
    """It is the author's to finish: no fault of the grader's own (70); a question stops only its quiz."""
    path = copied / file
    path.parent.mkdir(exist_ok=True)
    with path.open("a", encoding="utf-8") as there:
        there.write(unfinished)
    at = f"{file}:{path.read_text('utf-8').count(chr(10))}"
    make_class(tmp_path / "class", solution, 1)
    only = RunOptions(exercises=("doubling",))
    for options in (RunOptions(), *([only] if "quiz" not in file else ())):
        with pytest.raises(UsageError) as caught:
            graded_class(tmp_path, Catalog(), options)
        assert said.format(at=at) in caught.value.message
    assert not (tmp_path / "out").exists()
    if "quiz" in file:
        graded_class(tmp_path, Catalog(), only, grade=right)
        assert len(scores(tmp_path / "out")) == 1


def test_a_student_counts_as_done_when_graded_and_not_when_read(tmp_path, catalog, solution):
    make_class(tmp_path / "class", solution, 4)
    options = RunOptions(exercises=("doubling",), terms=Terms())
    seen = []

    def all_at_once(entries, more):
        yield from right(list(entries), more)

    graded_class(tmp_path, catalog, options, lambda _, done, __: seen.append(done), grade=all_at_once)
    assert seen == [1, 2, 3, 4]


def test_a_run_killed_before_it_had_a_gradebook_is_begun_again(tmp_path, catalog, solution):
    make_class(tmp_path / "class", solution, 1)
    put(tmp_path / "out" / "gradebook.new-1-0", b"half")
    options = RunOptions(exercises=("doubling",), resume=True)
    graded_class(tmp_path, catalog, options, grade=right)
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names == {
        "gradebook.backup-1.sqlite", "gradebook.sqlite", "grades.csv", "results.jsonl", "report.html",
        "students.html", "students.csv", "students",
    }  # fmt: skip


def right(entries, _):
    """Stands in for grader processes: everything that can be read is right, the rest is said."""
    for entry in entries:
        if entry.problem is not None:
            yield Graded(entry, batch.without_grading(entry, "ungradable", entry.problem))
        else:
            most = entry.exercise.max_points
            verdict = Verdict(
                exercise=entry.exercise.id, scope="full", state="graded", score=most, max_score=most,
                passed=True, checks=(), isolation="L1",
            )  # fmt: skip
            yield Graded(entry, verdict)


def as_written(entries, terms):
    """And what holds the mistake of every third student gets 6 points."""
    for one in right(entries, terms):
        wrong = one.entry.submission is not None and WRONG in one.entry.submission.files["doubling.py"]
        yield replace(one, verdict=msgspec.structs.replace(one.verdict, score=6.0)) if wrong else one


def test_a_download_with_several_exercises_is_graded_and_its_times_are_kept(tmp_path, catalog, solution):
    folder = tmp_path / "class"
    for name in ("ada_1_10_doubling.py", "ada_1_11_halving.py", "bob_LATE_2_12_doubling.py", "cy_3_13_x.txt"):
        put(folder / name, name.encode())
        os.utime(folder / name, (1_000_000, 1_000_000))
    put(folder / "cy_3_14_mine.zip", b"PK")
    put(folder / "eve_4_15_doubling.py", b"x")
    put(folder / "adam_4_16_doubling.py", b"x")
    summary = graded_class(tmp_path, catalog, RunOptions(), grade=right)
    assert (summary.exit_code, summary.states["graded"], summary.states["ungradable"]) == (6, 3, 3)
    assert summary.unrecognised == []
    with open_results(tmp_path / "out") as results:
        found = {(item.student, item.exercise): item for item in results.all()}
        assert found["ada_1", "halving"].score == 2.0
        assert found["bob_2", "doubling"].flagged_late
        assert not found["ada_1", "doubling"].flagged_late
        assert results.downloads["bob_2"].key == "2"
        mtimes = {time.at for time in results.book.times() if time.source == "mtime"}
        assert mtimes == {1_000_000.0}
        assert [item.title for item in results.exercises()] == ["Doubling", "Halving"]
        sha256 = found["ada_1", "halving"].result.key.submission_sha256
        assert results.book.submission(sha256) == {"halving.py": b"ada_1_11_halving.py"}


@pytest.mark.parametrize(("seconds", "state"), [(60.0, "graded"), (0.0, "ungradable")])
def test_a_quiz_is_read_before_what_takes_all_the_time_and_listed_if_it_was_not(
    tmp_path, monkeypatch, seconds, state
):
    """Once the time for a student's files was used up, the quiz was nowhere, and nobody was told."""
    monkeypatch.delenv("COURSE_CONTENT", raising=False)
    monkeypatch.setattr(archives, "STUDENT_S", seconds)
    module_in = archives.Reader.module_in

    def slow(reader, path, exercise):
        reader._left_s = 0.0
        return module_in(reader, path, exercise)

    monkeypatch.setattr(archives.Reader, "module_in", slow)
    catalog = Catalog()
    manifest = json.dumps(quiz_record(catalog))
    put(tmp_path / "class" / "ada" / "a.zip", zipped({"submission.json": manifest}))
    summary = graded_class(tmp_path, catalog, RunOptions(exercises=("quiz", "integrators")), grade=right)
    with open_results(tmp_path / "out") as results:
        found = {item.exercise: item.verdict for item in results.all()}
    assert (found["quiz"].state, found["integrators"].state) == (state, "ungradable")
    told = [row.message for row in summary.troubled if row.exercise == "quiz"]
    assert all("took all the time for reading" in one for one in told)
    assert len(told) == (state != "graded")


def test_a_zip_that_cannot_be_read_is_told_where_the_quiz_alone_is_graded(tmp_path, monkeypatch):
    """The exercises in it say so; where none is asked for, its student had handed in nothing."""
    monkeypatch.delenv("COURSE_CONTENT", raising=False)
    put(tmp_path / "class" / "ada" / "a.zip", b"PK\3\4 and no more")
    summary = graded_class(tmp_path, Catalog(), RunOptions(exercises=("quiz",)))
    (trouble,) = summary.troubled
    assert (trouble.student, trouble.exercise) == ("ada", "quiz")
    assert "'a.zip': it cannot be read" in trouble.message
