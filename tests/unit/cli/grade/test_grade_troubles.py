"""A gradebook that is newer, damaged, changed by hand or in use: every command says so and loses nothing."""

import contextlib
import json
import shutil
import sqlite3

import pytest

from course.errors import MissingCapabilityError
from course.grading.exports.formats import FORMATS
from course.grading.exports.html_report import pages
from course.grading.gradebook.book import Gradebook
from course.grading.running import batch
from course.grading.running.folder import export_all, open_results
from tests.unit.cli.conftest import files_in
from tests.unit.cli.grade.conftest import RUN, write
from tests.unit.grading.made import HALF, RIGHT, make_book
from tests.unit.grading.running.test_interrupted import interrupted_after

SHEET = "Identifier,Full name,Grade,Last modified (grade)\nParticipant 1,ada,,-\n"
OVERRIDE = "grade override out ada doubling --score 1 --reason 'oral exam'"
EXPLAIN = "grade explain out ada doubling"
WRITING = [f"{RUN} --resume", "grade rerun out", OVERRIDE, "grade late out --clear"]
READING = [
    "grade rerun out --dry-run",
    "grade late out",
    "grade export out --format html -o elsewhere",
    "grade export out --format canvas -o canvas.csv",
    EXPLAIN,
    "grade similar out",
]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A class and its gradebook with what is made from it, written once for all tests."""
    folder = tmp_path_factory.mktemp("made")
    verdicts = {f"student {number:02}": HALF for number in range(30)} | {"ada": RIGHT}
    make_book(folder / "out", verdicts).close()
    with open_results(folder / "out") as results:
        export_all(folder / "out", results)
    write(folder, "class/ada/doubling.py")
    return folder


def newer(path):
    with contextlib.closing(sqlite3.connect(path)) as db:
        db.execute("PRAGMA user_version = 99")


def overwritten(path):
    size = path.stat().st_size
    with path.open("r+b") as file:
        file.seek(4096)
        file.write(b"X" * (size - 8192))


def cut(path):
    with path.open("r+b") as file:
        file.truncate(path.stat().st_size // 2)


def other(path):
    path.write_bytes(b"something else altogether, and long enough for a page of it " * 100)


@pytest.mark.parametrize("line", WRITING + READING)
@pytest.mark.parametrize("spoil", [newer, overwritten, cut, other])
def test_a_gradebook_that_cannot_be_read_is_said_to_be_so_and_left_as_it_is(course, out, line, spoil):
    spoil(out / "gradebook.sqlite")
    before = files_in(out.parent)
    ran = course(line, "--json")
    assert ran.error == ((4, "newer_format") if spoil is newer else (7, "integrity"))
    assert ("newer version" if spoil is newer else "is damaged") in ran.json["error"]["message"]
    assert ran.json["error"]["help"]
    assert files_in(out.parent) == before


@pytest.mark.parametrize("line", [WRITING[0], OVERRIDE, EXPLAIN])
def test_where_only_backups_are_left_every_command_names_salvage(course, out, line):
    path = out / "gradebook.sqlite"
    shutil.copyfile(path, out / "gradebook.backup-1.sqlite")
    for lose in (lambda: path.write_bytes(b""), path.unlink):
        lose()
        ran = course(line)
        assert "`course grade salvage out --to out-salvaged`" in ran.err.replace("\n", " ")
        assert ran.code in {2, 5, 7}


@pytest.fixture
def impatient(monkeypatch):
    """A command that waits for a locked gradebook gives up soon."""
    connect = sqlite3.connect
    monkeypatch.setattr(
        sqlite3, "connect", lambda *given, **more: connect(*given, **more | {"timeout": 0.05})
    )


@pytest.mark.usefixtures("impatient")
@pytest.mark.parametrize("line", WRITING + READING)
def test_while_a_run_writes_every_other_command_is_told_and_the_run_goes_on(course, out, line):
    with Gradebook(out / "gradebook.sqlite", writing=True) as book:
        book.set_meta(seed="7")
        before = files_in(out / "students")
        assert course(line, "--json").error == (2, "gradebook_locked")
        assert files_in(out / "students") == before
        book.set_meta(note="still writing")
    assert not (out.parent / "elsewhere").exists()
    with Gradebook(out / "gradebook.sqlite") as book:
        assert book.meta()["note"] == "still writing"
        assert len(list(book.results())) == 31


@pytest.mark.usefixtures("impatient")
def test_the_gradebook_is_held_until_the_last_page_is_written(course, out, monkeypatch):
    refused = []

    def write_pages(*arguments):
        refused.append(course("grade late out --clear --json").json["error"]["code"])
        return whole(*arguments)

    whole = pages.write_pages
    monkeypatch.setattr(pages, "write_pages", write_pages)
    assert (course(OVERRIDE).code, refused) == (0, ["gradebook_locked"])
    assert "oral exam" in (out / "report.html").read_text("utf-8")


def test_pages_that_cannot_be_written_cost_nothing_but_themselves(course, out, monkeypatch):
    def write_pages(path, *_):
        raise MissingCapabilityError(f"{path} cannot be written.", help="-o", code="cannot_write")

    before = files_in(out / "students")
    with monkeypatch.context() as patch:
        patch.setattr(pages, "write_pages", write_pages)
        ran = course(OVERRIDE, "--json")
    assert ran.error == (4, "cannot_write")
    assert "The gradebook is complete" in ran.json["error"]["help"]
    assert files_in(out / "students") == before
    assert course(EXPLAIN, "--json").json["score"] == 1
    course("grade late out --clear").ends(0)
    assert "oral exam" in (out / "report.html").read_text("utf-8")


@pytest.mark.parametrize("count", [0, 1])
def test_an_interrupted_run_ends_its_lines_with_the_reason(course, out, monkeypatch, count):
    shutil.copytree(out.parent / "class" / "ada", out.parent / "class" / "bob")
    stopped = interrupted_after(count)
    monkeypatch.setattr(batch, "grade_all", lambda entries, terms, graders=1: stopped(entries, terms))
    ran = course("grade run class --out new --exercise doubling --json")
    *lines, last = map(json.loads, ran.out.splitlines())
    assert (ran.code, last["exit_code"], last["error"]["code"]) == (130, 130, "interrupted")
    assert [line["student"] for line in lines] == ["ada"] * count
    if count:
        with open_results(out.parent / "new") as results:
            (stored,) = (one.result.graded_at for one in results.all() if not one.waiting)
        assert lines[0]["graded_at"] == stored


def test_a_class_with_nothing_to_grade_is_told_of_warm_ups_and_of_resuming(course, tmp_path):
    write(tmp_path, "class/ada/two-walls/two_walls.py", "x = 1\n")
    ran = course("grade run class --out out").says("1 handed in nothing to grade")
    assert "A warm-up is graded where --exercise names it." in ran.out + ran.err
    course("grade explain out ada doubling").refuses(5, "--exercise names it), or the run was interrupted")


#: What is said of a text that is not UTF-8, of a name that may be any bytes, and of one that nobody has.
REFUSED, TAKEN, UNKNOWN = 2, 0, 5
NO_TEXT = "x\udcff"


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("override", "out", "ada", "doubling", "--score", "1", "--reason", NO_TEXT), REFUSED),
        (("override", "out", NO_TEXT, "doubling", "--lift"), REFUSED),
        (("explain", "out", NO_TEXT, "doubling"), REFUSED),
        (("explain", "out", "ada", NO_TEXT), REFUSED),
        (("log", "out", NO_TEXT), REFUSED),
        (("log", NO_TEXT), UNKNOWN),
        (("rerun", "out", "--reason", NO_TEXT), REFUSED),
        (("assign", "out", "ada", NO_TEXT), REFUSED),
        (("similar", "out", "--exercise", NO_TEXT), REFUSED),
        (("late", "out", "--clear", "--reason", NO_TEXT), REFUSED),
        (("late", "out", "--roster", f"{NO_TEXT}.csv"), TAKEN),
        (("run", NO_TEXT, "--out", "new", "--exercise", "doubling"), TAKEN),
        (("run", "class", "--out", NO_TEXT, "--exercise", "doubling"), TAKEN),
        (("salvage", "out", "--to", NO_TEXT), TAKEN),
        (("similar", "out", "-o", f"{NO_TEXT}.html"), TAKEN),
        *((("export", "out", "--format", name, "-o", NO_TEXT), TAKEN) for name in ("csv", "html")),
        (("export", "out", "--format", "html", "-o", f"{NO_TEXT}.html"), TAKEN),
        *((("export", "out", "-o", name), 4) for name in ("y" * 300, "class/ada/doubling.py/x")),
        (("salvage", "out", "--to", "class/ada/doubling.py/x"), 4),
    ],
)
def test_words_that_are_no_text_are_named_and_paths_may_be_any_bytes(course, out, words, code):
    write(out.parent, f"{NO_TEXT}.csv", "student\nada\n")
    if words[:2] == ("run", NO_TEXT):
        shutil.copytree(out.parent / "class", out.parent / NO_TEXT)
    ran = course("grade", *words, "--json").ends(code)
    for line in ran.out.splitlines():
        json.dumps(json.loads(line), ensure_ascii=False).encode("utf-8")
    if code == REFUSED:
        assert r"'x\udcff' is not UTF-8." in ran.err


@pytest.mark.parametrize("name", [*FORMATS, "gradescope-autograder", "similar"])
def test_a_folder_is_no_place_for_a_file(course, out, name):
    (out.parent / "folder.html").mkdir()
    write(out.parent, "sheet.csv", SHEET)
    write(out.parent, "keys.csv", "student,canvas_id,moodle_key\nada,1,ada\n")
    more = {
        "canvas": "--exercise doubling --partial --roster keys.csv --assignment doubling=1",
        "moodle": "--exercise doubling --partial --roster keys.csv",
        "moodle-worksheet": "--exercise doubling --partial --roster sheet.csv",
    }
    line = "similar out" if name == "similar" else f"export out --format {name} {more.get(name, '')}"
    ran = course(f"grade {line} -o folder.html --json")
    if name in {"gradescope", "html"}:
        assert (ran.code, len(files_in(out.parent / "folder.html")) > 1) == (0, True), ran.err
    else:
        assert ran.error == (2, "bad_file_name")
        assert ran.json["error"]["message"] == "folder.html is a folder."
