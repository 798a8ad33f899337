"""A class folder as data: every odd thing in it is refused with a reason and read as nothing else."""

import contextlib
import hashlib
import json
import os
import stat
import subprocess
import sys
import zipfile

import msgspec
import pytest

from course.errors import UngradableError
from course.grading.intake import archives, students
from course.grading.intake.archives import Reader, RefusedError
from course.grading.intake.downloads import Place, Student, class_list
from course.grading.intake.students import read_student
from course.grading.quiz import grade_quiz
from course.handed_in.limits import MAX_CELLS, MAX_DEEP, MAX_FILE, MAX_FILES, MAX_NOTEBOOK, MAX_PATH
from course.handed_in.notebook import MAX_NOTES, notebook_source
from course.quizzing.bank import Bank
from course.scoring.verdict import Problem, not_graded
from tests.benchmarks.fuzz.run import run
from tests.growth import LIMIT, growth
from tests.unit.grading.made import notebook, put, zipped

SOURCE = b"def double(x):\n    return 2 * x\n"


def entry(folder, exercise):
    (found,) = read_student(Student("ada", Place(folder)), [exercise], required=True)
    return found


def reason(folder, exercise):
    found = entry(folder, exercise)
    assert found.submission is None
    assert found.problem.message
    assert found.problem.help
    return found.problem.code


def archive(path, members, *, manifest=(), mode=0o100644):
    """As ``submit`` makes it; ``manifest``: what else its own file says, or all of it, or None for none."""
    sums = {name: hashlib.sha256(content).hexdigest() for name, content in members.items()}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as target:
        for name, content in members.items():
            info = zipfile.ZipInfo(name)
            info.external_attr = mode << 16
            target.writestr(info, content, zipfile.ZIP_DEFLATED)
        if manifest is not None:
            if not isinstance(manifest, str):
                manifest = json.dumps({"format_version": 1, "files": sums, **dict(manifest)})
            target.writestr("submission.json", manifest)
    return path


FOUND = "doubling/doubling.py"
LAID = {
    "a module": lambda folder: (folder / "doubling.py").write_bytes(SOURCE),
    "a module in its folder": lambda folder: put(folder / FOUND, SOURCE),
    "a zip made by submit": lambda folder: archive(folder / "mine.zip", {FOUND: SOURCE}),
    "a zip made by hand, with what systems add": lambda folder: archive(
        folder / "mine.zip",
        {FOUND: SOURCE, "__MACOSX/doubling/._doubling.py": b"x", ".DS_Store": b"y"},
        manifest=None,
    ),
    "a zip with another beside it": lambda folder: archive(
        folder / "mine.zip", {"work/earlier.zip": b"PK", "work/doubling/doubling.py": SOURCE}, manifest=None
    ),
    "a workspace handed in whole": lambda folder: [
        put(folder / "my-course" / name, content) for name, content in ((FOUND, SOURCE), ("course.toml", b""))
    ],
    "a notebook": lambda folder: put(folder / "doubling.ipynb", notebook("print(1)", SOURCE.decode())),
    "a notebook in a zip": lambda folder: archive(
        folder / "mine.zip", {"doubling/doubling.ipynb": notebook(SOURCE.decode())}
    ),
}


@pytest.mark.parametrize("what", LAID)
def test_a_module_is_found_wherever_it_may_be(tmp_path, doubling, what):
    LAID[what](tmp_path)
    found = entry(tmp_path, doubling)
    files = {name: text.strip() for name, text in found.submission.files.items()}
    assert files.pop("doubling.py") == SOURCE.strip()
    assert list(files) == ["notebook.json"] * ("notebook" in what)


def test_a_notebook_larger_than_a_module_may_be_is_read_past_its_outputs(tmp_path, doubling):
    large = json.loads(notebook(SOURCE.decode()))
    large["cells"][0]["outputs"] = [{"output_type": "stream", "name": "stdout", "text": "x" * (30 << 20)}]
    (tmp_path / "doubling.ipynb").write_text(json.dumps(large), "utf-8")
    assert entry(tmp_path, doubling).submission is not None
    (tmp_path / "doubling.ipynb").write_bytes(notebook(SOURCE.decode(), f"def double(): '{'x' * MAX_FILE}'"))
    assert reason(tmp_path, doubling) == "too_large"


@pytest.mark.parametrize(
    ("name", "content", "code"),
    [
        ("doubling.py", b"#" * (MAX_FILE + 1), "too_large"),
        ("doubling.py", b" \n\t", "empty_file"),
        ("doubling.py", None, "not_a_file"),
        ("doubling.ipynb", b"{}" + b" " * MAX_NOTEBOOK, "too_large"),
        ("doubling.ipynb", b"{}", "not_a_notebook"),
        ("doubling.ipynb", b" ", "empty_file"),
        ("doubling.ipynb", notebook("x = 1"), "no_declared_functions"),
    ],
    ids=lambda value: str(value)[:20],
)
def test_what_is_not_a_plain_file_of_reasonable_size_and_kind_is_refused(
    tmp_path, doubling, name, content, code
):
    if content is None:
        (tmp_path / name).mkdir()
    else:
        (tmp_path / name).write_bytes(content)
    assert reason(tmp_path, doubling) == code


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="links and pipes as POSIX has them")
def test_links_and_pipes_are_refused_and_never_followed_or_waited_for(tmp_path, doubling):
    secret = tmp_path / "secret.py"
    secret.write_bytes(SOURCE)
    target = tmp_path / "student" / "doubling.py"
    target.parent.mkdir()
    target.symlink_to(secret)
    assert reason(target.parent, doubling) == "symlink"
    target.unlink()
    os.mkfifo(target)
    assert reason(target.parent, doubling) == "not_a_file"
    target.unlink()
    (target.parent / "doubling").symlink_to(tmp_path, target_is_directory=True)
    (tmp_path / "doubling.py").write_bytes(SOURCE)
    assert reason(target.parent, doubling) == "symlink"
    linked = tmp_path / "linked"
    linked.symlink_to(target.parent, target_is_directory=True)
    assert reason(linked, doubling) == "symlink"


def _lying_size(path):
    archive(path, {FOUND: b"#" * (MAX_FILE + 1)}, manifest=None)
    size, lie = (number.to_bytes(4, "little") for number in (MAX_FILE + 1, 100))
    path.write_bytes(path.read_bytes().replace(size, lie))


HOSTILE = {
    "bomb": lambda path: archive(path, {FOUND: b"#" * (4 << 20)}),
    "many files": lambda path: archive(path, {f"file{number}.txt": b"" for number in range(MAX_FILES + 1)}),
    "lying size": _lying_size,
    "parent path": lambda path: archive(path, {"../doubling.py": SOURCE}),
    "absolute path": lambda path: archive(path, {"/etc/doubling.py": SOURCE}),
    "backslash": lambda path: archive(path, {"..\\doubling.py": SOURCE}),
    "drive": lambda path: archive(path, {"C:/doubling.py": SOURCE}),
    "deep path": lambda path: archive(path, {FOUND: SOURCE, "a/" * (MAX_DEEP + 1) + "x.md": b""}),
    "long path": lambda path: archive(path, {FOUND: SOURCE, "a" * (MAX_PATH + 1): b""}),
    "link": lambda path: archive(path, {FOUND: b"/etc/passwd"}, mode=stat.S_IFLNK | 0o777),
    "nested": lambda path: archive(path, {"inner.zip": b"PK"}, manifest=None),
    "damaged": lambda path: path.write_bytes(b"PK\x03\x04 and nothing that follows"),
    "empty": lambda path: path.write_bytes(b""),
    "a folder": lambda path: path.mkdir(),
}


@pytest.mark.parametrize("kind", HOSTILE)
def test_hostile_archives_are_refused(tmp_path, doubling, kind):
    HOSTILE[kind](tmp_path / "mine.zip")
    assert reason(tmp_path, doubling) == "refused_archive"


def test_the_versions_at_home_are_told_where_they_mattered_and_nowhere_else(tmp_path, doubling):
    written = {"python": "3.13.1", "numpy": "2.9.0"}
    archive(tmp_path / "mine.zip", {FOUND: SOURCE}, manifest={"written_with": written})
    found = entry(tmp_path, doubling)
    assert found.written == "Python 3.13.1 and NumPy 2.9.0"
    fine = not_graded("doubling", 10, "ungradable", Problem("x", "x", "x"))
    assert found.told(fine).warnings == ()
    note = "line 3: left out. Python 3.12 reads that, but it is checked with Python 3.11."
    told = found.told(msgspec.structs.replace(fine, warnings=(note,))).warnings
    assert told == (note, "It was written with Python 3.13.1 and NumPy 2.9.0.")
    for none in ("x", {"python": 3}, {"python": "3; \x1b[31m"}, {"python": "3" * 99}, None):
        archive(tmp_path / "mine.zip", {FOUND: SOURCE}, manifest={"written_with": none})
        assert entry(tmp_path, doubling).written == "", none
    made = json.loads(notebook(SOURCE.decode()))
    made["metadata"]["language_info"] = {"name": "python", "version": "3.13.1"}
    (tmp_path / "mine.zip").unlink()
    (tmp_path / "doubling.ipynb").write_text(json.dumps(made))
    assert entry(tmp_path, doubling).written == "Python 3.13.1"


@pytest.mark.parametrize(
    ("manifest", "code"),
    [
        ({"files": {FOUND: "0" * 64}}, "checksum_mismatch"),
        ('{"format_version": 2, "files": {}}', "newer_format"),
        ("[1, 2", "refused_archive"),
        ("[" * 100_000, "refused_archive"),
        ('{"format_version": 1, "files": [1]}', "refused_archive"),
        ("null", "refused_archive"),
    ],
    ids=lambda value: str(value)[:40],
)
def test_a_manifest_that_cannot_be_trusted_is_refused(tmp_path, doubling, manifest, code):
    archive(tmp_path / "mine.zip", {FOUND: SOURCE}, manifest=manifest)
    assert reason(tmp_path, doubling) == code


@pytest.mark.skipif(os.name == "nt", reason="file names are text there")
def test_names_that_are_no_text_stay_apart(tmp_path, doubling):
    for raw in (b"\xff", b"\\xff"):
        put(tmp_path / os.fsdecode(raw) / "doubling.py", SOURCE)
    names = [student.name for student in class_list(tmp_path).students]
    assert len(set(names)) == 2
    for name in names:
        name.encode("utf-8")


# -- hostile files: read elsewhere, under limits, and named --------------------------------------------------

_DOUBLE = "def double(x):\n    return 2 * x\n"


#: What once took minutes or hours, by size.
_LARGE = {
    "statements beside a magic word": lambda n: notebook(f"{_DOUBLE}# get_ipython\n" + "x\n" * (10 * n)),
    "escaped quotes": lambda n: notebook(f"%magic\n{_DOUBLE}'" + "\\'" * (20 * n)),
    "magics": lambda n: notebook(_DOUBLE, "%x\n" * (10 * n)),
    "brackets": lambda n: notebook(f"%magic\n{_DOUBLE}" + "(" * (20 * n)),
    "bindings": lambda n: notebook(_DOUBLE.replace("2", "y"), "y = 1\n" * (5 * n)),
    "strings in lines": lambda n: notebook(f"%magic\n{_DOUBLE}" + ("'" + "\\'" * 50 + "\n") * (n // 5)),
}


@pytest.mark.soak
@pytest.mark.parametrize("kind", _LARGE)
def test_reading_a_notebook_takes_as_long_as_it_is_long(kind, doubling):
    def reading(size):
        data = _LARGE[kind](size)
        return lambda: notebook_source(data, doubling)

    assert growth(reading, 1000) < LIMIT


def test_what_is_left_out_is_told_within_bounds(doubling):
    found = notebook_source(notebook(_DOUBLE, "%magic " + "x" * 500 + "\n" + "%y\n" * 5000), doubling)
    assert len(found.notes) <= MAX_NOTES + 2
    assert any("more lines left out" in note for note in found.notes)
    assert len(found.record()) < 8 << 10
    many = notebook_source(notebook(*[f"# {n}\n{_DOUBLE}" for n in range(MAX_CELLS)]), doubling)
    assert len(many.record()) < 64 << 10
    with pytest.raises(UngradableError) as caught:
        notebook_source(notebook(*[_DOUBLE] * (MAX_CELLS + 1)), doubling)
    assert caught.value.code == "too_large"


def test_an_escaped_line_end_in_a_string_moves_no_magic():
    from course.handed_in.notebook import typed_cell

    cell = typed_cell(1, "a = 'one \\\n two'\n%magic\nb = 1\n")
    assert cell.dropped == ((3, "%magic"),)
    assert cell.tree is not None


@pytest.fixture
def strict():
    """With little time and memory, so that a test need not use up what honest files may."""
    with contextlib.closing(Reader(cpu_s=1, wall_s=60, memory=512 << 20)) as found:
        yield found


_BOMBS = {
    "time": lambda: notebook(_DOUBLE, "y = 1\n" * 150_000).replace(b"2 * x", b"y"),
    "memory": lambda: (
        b'{"nbformat": 4, "cells": [{"cell_type": "code", "metadata": {"k": ['
        + b"{}," * 8_000_000
        + b"{}]}}]}"
    ),
}


@pytest.mark.parametrize("bomb", _BOMBS)
def test_a_bomb_costs_itself_and_is_named(bomb, strict, doubling):
    with pytest.raises(RefusedError) as caught:
        strict.notebook(_BOMBS[bomb](), doubling, "bomb.ipynb")
    assert caught.value.problem.code == "unreadable"
    assert "bomb.ipynb" in caught.value.problem.message
    assert strict.notebook(notebook(_DOUBLE), doubling, "honest.ipynb")[0].decode().startswith("def double")


def test_an_archive_is_read_once_for_all_questions_about_a_student(tmp_path, doubling):
    """It was read for each exercise, for the quiz, and for what is left."""
    path = tmp_path / "all.zip"
    manifest = {"format_version": 1, "files": {}, "quiz": [1]}
    path.write_bytes(zipped({"hw.py": _DOUBLE, "submission.json": json.dumps(manifest)}))
    with contextlib.closing(Reader()) as reader:
        reader.turn_to("ada")
        assert reader.module_in(path, doubling) is None
        path.write_bytes(b"PK")
        assert reader.module_in(path, doubling) is None
        assert [name for name, *_ in reader.outlines(path, (), ())] == ["hw.py"]
        assert reader.quiz_in(path)
        reader.turn_to("bob")
        with pytest.raises(RefusedError, match="cannot be read"):
            reader.quiz_in(path)


def test_what_ends_the_reader_is_not_read_again_and_all_of_a_student_has_one_time(
    tmp_path, strict, monkeypatch
):
    asked = []
    files = [tmp_path / f"{n}.zip" for n in range(3)]
    for path in files:
        path.write_bytes(zipped({"hw.py": _DOUBLE}))
    with monkeypatch.context() as patch:
        patch.setattr(archives, "STUDENT_S", 1.5)
        patch.setattr(strict._servant, "ask", lambda *given: asked.append(given))  # it ends after its second
        strict.turn_to("ada")
        for path, said in zip([files[0], *files], ["honest file"] * 3 + ["all the time"], strict=True):
            with pytest.raises(RefusedError, match=said):
                strict.outlines(path, (), ())
    assert len(asked) == 2
    strict.turn_to("bob")
    assert len(strict.outlines(files[0], (), ())) == 1


def test_the_wall_clock_ends_a_reader_that_uses_no_time(doubling):
    with contextlib.closing(Reader(cpu_s=60, wall_s=1.0)) as impatient:
        impatient.notebook(notebook(_DOUBLE), doubling, "a.ipynb")
        process = impatient._servant._process
        os.kill(process.pid, 19)  # SIGSTOP
        with pytest.raises(RefusedError) as caught:
            impatient.notebook(notebook(_DOUBLE), doubling, "b.ipynb")
        assert caught.value.problem.code == "unreadable"
        assert process.poll() is not None


def test_the_process_that_reads_loads_nothing_that_grades():
    """Each bomb ends one, and the next took three times as long to start."""
    code = "import course.grading.intake.archives, sys; print({'numpy', 'pytest'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_more_than_an_answer_may_be_is_not_taken(strict, doubling, monkeypatch):
    strict.notebook(notebook(_DOUBLE), doubling, "a.ipynb")
    monkeypatch.setattr(archives, "MAX_ANSWER", 10)
    with pytest.raises(RefusedError, match=r"b\.ipynb"):
        strict.notebook(notebook(_DOUBLE), doubling, "b.ipynb")


def test_what_unpacks_a_damaged_archive_raises_as_it_likes(tmp_path, doubling, strict):
    """LZMA has an error of its own; that ended the process, and the file had "taken too much time"."""
    path = tmp_path / "m.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_LZMA) as target:
        target.writestr("doubling.py", _DOUBLE * 50)
    packed = bytearray(path.read_bytes())
    properties = packed.index(b"\x5d\0\0")  # of the compression, and how large a dictionary it takes
    for at, damage in ((properties + 1, b"\xff" * 4), (properties + 9, b"\xff" * 30)):
        path.write_bytes(packed[:at] + damage + packed[at + len(damage) :])
        with pytest.raises(RefusedError) as caught:
            strict.module_in(path, doubling)
        assert caught.value.problem.code == "refused_archive"


def test_nesting_that_no_parser_follows_costs_one_file_of_an_archive(tmp_path, strict):
    path = tmp_path / "m.zip"
    path.write_bytes(zipped({"bomb.py": f"double = {'-' * 6000}1", "mine.py": _DOUBLE}))
    found = {name: functions for name, _, functions, *_ in strict.outlines(path, (), ("double",))}
    assert found == {"bomb.py": (), "mine.py": ("double",)}


def test_what_is_said_of_an_archive_is_one_line_whatever_it_is_called(tmp_path, doubling, strict):
    """A name that is no text ended the process; a line end in a folder's name was a line of a report."""
    path = tmp_path / "m\udce9.zip"
    path.write_bytes(zipped({"a\n\x1b[2Jb\u202e/doubling.py": _DOUBLE}))
    held = strict.module_in(path, doubling)
    (note,) = held.notes
    assert note.isprintable()
    assert r"m\udce9.zip" in note


@pytest.mark.parametrize("kind", ["notebooks", "zips", "frames", "scenes", "documents"])
def test_random_input_meets_words_and_no_fault(kind):
    """A glance: tests/benchmarks/fuzz/run.py runs for as long as it is told."""
    outcomes, faults = run(kind, seed=7, numbers=range(60))
    assert not faults
    assert len(outcomes) > 1, "inputs that get in, and inputs that do not"


@pytest.mark.parametrize(
    "quiz",
    ["[" * 970 + "1" + "]" * 970, '["\\ud800"]', "[1e999, NaN]", f"[{'9' * 4000}]", '{"a": 1}', "true"],
)
def test_no_record_of_a_quiz_hurts_whoever_asked(tmp_path, quiz):
    """One list a thousand deep ended the run: whoever asks stands deeper than the process that reads."""
    manifest = f'{{"format_version": 1, "files": {{}}, "quiz": {quiz}}}'
    (tmp_path / "ada.zip").write_bytes(zipped({"submission.json": manifest}))
    student = Student("ada", Place(tmp_path))

    def asked(deeper):
        return asked(deeper - 1) if deeper else students.read_quiz(student)[0]

    record = asked(200)
    assert isinstance(record, str)
    verdict = grade_quiz(Bank(()), record)
    assert (verdict.state, verdict.error.code) == ("ungradable", "quiz_record_inconsistent")


def attempts(*seeds):
    """A zip of `course submit` with an attempt for each seed."""
    quiz = [
        {"seed": seed, "version": "1", "finished_at": "", "questions": [], "answers": {}, "score": 0}
        for seed in seeds
    ]
    return zipped({"submission.json": json.dumps({"format_version": 1, "files": {}, "quiz": quiz})})


@pytest.mark.parametrize(
    ("first", "second"), [((5,), (5, 6)), ((5, 6), (5,)), ((5, 6), (5, 6)), ((), (5, 6)), ((5, 6), ())]
)
def test_of_two_quiz_records_the_one_counts_that_continues_the_other(tmp_path, first, second):
    put(tmp_path / "a.zip", attempts(*first))
    put(tmp_path / "b.zip", attempts(*second))
    record, path = students.read_quiz(Student("ada", Place(tmp_path)))
    assert [one["seed"] for one in record] == [5, 6]
    assert path.name == ("a.zip" if len(first) == 2 else "b.zip")


def test_quiz_records_of_which_none_has_all_attempts_are_named_and_not_called_malformed(tmp_path):
    put(tmp_path / "a.zip", attempts(5, 6))
    put(tmp_path / "b.zip", attempts(7))
    with pytest.raises(UngradableError) as caught:
        students.read_quiz(Student("ada", Place(tmp_path)))
    assert caught.value.message == "Several files hold different quiz attempts: 'a.zip', 'b.zip'."
    verdict = grade_quiz(Bank(()), caught.value.message.rstrip("."))
    assert verdict.error.message == (
        "The quiz cannot be scored. Several files hold different quiz attempts: 'a.zip', 'b.zip'."
    )
    assert "grade with --resume" in verdict.error.help
