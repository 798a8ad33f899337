"""Whose file it is: taken without a question, proposed, or settled by an instructor; nothing in silence."""

import gzip
import io
import json
import os
import re
import sys
import tarfile
from unittest.mock import DEFAULT, Mock

import pytest

from course.errors import NotFoundError, UngradableError
from course.grading.gradebook.records import ELSEWHERE
from course.grading.intake import students
from course.grading.intake.downloads import DEEP
from course.grading.intake.students import Candidate, found_for
from course.grading.results.effective import override
from course.grading.running.assign import assign, named, proposals, unsettled
from course.grading.running.folder import open_results
from course.grading.running.run import RunOptions
from course.handed_in.limits import MAX_FILE
from course.printable import quoted
from tests.unit.grading.made import graded_class, notebook, put, read_class, roster_of, zipped
from tests.unit.grading.running.test_run import right

pytestmark = pytest.mark.usefixtures("unpacked")

SOURCE = b"def double(x):\n    return 2 * x\n\ndef doublings(x, n):\n    return x\n"
OTHER = SOURCE + b"# the second try\n"
STUB = (
    b'def double(x):\n    """Twice x."""\n    raise NotImplementedError\n\ndef doublings(x, n):\n    pass\n'
)
HALF = SOURCE.replace(b"return x\n", b"raise NotImplementedError('later')\n")
NOTEBOOK = notebook(SOURCE.decode())


def lay(folder, student="ada", /, **files):
    for name, content in files.items():
        put(folder / student / name, content)


def read(folder, doubling, *, required=True):
    (entry,) = read_class(folder, [doubling], required=required)
    return entry


#: What is taken without a question -> what the result says of it.
TAKEN = {
    "its very name": ({"doubling.py": SOURCE}, ""),
    "letter case": ({"Doubling.PY": SOURCE}, "'Doubling.PY' was taken for doubling.py."),
    "a browser's number": ({"doubling (2).py": SOURCE}, "'doubling (2).py' was taken for doubling.py."),
    "without a space": ({"doubling(2).py": SOURCE}, "'doubling(2).py' was taken for doubling.py."),
    "with a dash": ({"doubling-1.py": SOURCE}, "'doubling-1.py' was taken for doubling.py."),
    "a space at its end": ({"doubling.py ": SOURCE}, "'doubling.py ' was taken for doubling.py."),
    "a notebook's": ({"Doubling (1).ipynb": NOTEBOOK}, "'Doubling (1).ipynb' was taken for doubling.py."),
    "two copies": (
        {"doubling.py": SOURCE, "doubling (1).py": SOURCE},
        "These are the same file: 'doubling.py', 'doubling (1).py'.",
    ),
    "a copy in the folder": (
        {"doubling.py": SOURCE, "doubling/doubling.py": SOURCE},
        "These are the same file: 'doubling.py', 'doubling/doubling.py'.",
    ),
    "a copy in a zip": (
        {"doubling.py": SOURCE, "all.zip": zipped({"doubling/doubling.py": SOURCE})},
        "These are the same file: 'doubling.py', 'all.zip'.",
    ),
    "one folder around all": (
        {"all.zip": zipped({"homework/doubling.py": SOURCE, "homework/notes.txt": b""})},
        "Everything in 'all.zip' lies in the folder 'homework', which was passed over.",
    ),
    "two folders around all": (
        {"all.zip": zipped({"a/b/doubling/doubling.py": SOURCE})},
        "Everything in 'all.zip' lies in the folder 'a/b', which was passed over.",
    ),
    "backslashes": (
        {"all.zip": zipped({"doubling\\doubling.py": SOURCE, "x\\notes.txt": b""})},
        "'all.zip' has backslashes in its paths; they were taken for folders.",
    ),
    "a second version elsewhere": (
        {"doubling.py": SOURCE, "old/doubling_v2.py": OTHER, "plots.py": b"import math\n"},
        "Also there, and not graded: 'old/doubling_v2.py' (defines double, doublings).",
    ),
    "another spelling in a zip": (
        {"all.zip": zipped({"Doubling (1).py": SOURCE})}, "'Doubling (1).py' was taken for doubling.py."
    ),
}  # fmt: skip


@pytest.mark.parametrize("how", TAKEN)
def test_what_is_meant_beyond_doubt_is_taken_and_said(tmp_path, doubling, how):
    files, said = TAKEN[how]
    lay(tmp_path, **files)
    entry = read(tmp_path, doubling)
    assert entry.submission is not None, entry.problem
    assert entry.submission.files["doubling.py"].strip() == SOURCE.strip()
    assert list(entry.notes) == ([said] if said else [])


def test_a_name_in_a_zip_that_ends_with_a_backslash_ends_no_process(tmp_path, doubling):
    """It was looked for among the files of code, was none of them, and the reader ended with a traceback."""
    lay(tmp_path, **{"all.zip": zipped({"doubling.py\\": SOURCE})})
    assert read(tmp_path, doubling).submission is not None
    many = zipped({f"f{number}.py\\": b"#" * 1_000_000 for number in range(6)})
    lay(tmp_path, **{"all.zip": many})
    problem = read(tmp_path, doubling).problem
    assert "more than 5 MB" in problem.message


@pytest.mark.parametrize(
    ("graded", "other", "told"),
    [
        (b"def double(x):\n    return 2 * x\n", SOURCE, "doublings"),
        (HALF, SOURCE, "doublings"),
        (SOURCE, HALF, ""),
        (b"def double(x):\n    return 2 * x\ndoublings = lambda x, n: x\n", SOURCE, ""),
        (b"x = 1\n", SOURCE, "double, doublings"),
    ],
)
def test_functions_that_only_another_file_has_are_named(tmp_path, doubling, graded, other, told):
    lay(tmp_path, **{"doubling.py": graded, "final.py": other})
    said = [note for note in read(tmp_path, doubling).notes if note.startswith(ELSEWHERE)]
    assert said == ([f"{ELSEWHERE}{told} in 'final.py'."] if told else [])


def test_a_file_in_a_folder_around_everything_is_assigned_by_the_name_that_is_listed(tmp_path, catalog):
    lay(tmp_path / "class", **{"hw/doubling.py": HALF, "hw/new/a.py": SOURCE, "hw/b.txt": b"x"})
    graded(tmp_path, catalog)
    with open_results(tmp_path / "out") as results:
        assert named(results, "ada", "new/a.py", "doubling").path.parts[-4:] == ("ada", "hw", "new", "a.py")


#: What is asked about -> the code, and the one match there is.
ASKED = {
    "another name": ({"homework.py": SOURCE}, "no_file", "homework.py"),
    "another folder": ({"week 3/doubling.py": SOURCE, "a.txt": b"x"}, "no_file", "week 3/doubling.py"),
    "in a zip, another name": (
        {"all.zip": zipped({"src/hw.py": SOURCE, "readme.txt": b""})}, "no_file", "all.zip/src/hw.py"
    ),
    "a notebook": ({"Homework 3.ipynb": NOTEBOOK}, "no_file", "Homework 3.ipynb"),
    "the better of two": ({"a.py": SOURCE, "b.py": b"def double(x): return x\n"}, "no_file", "a.py"),
    "copies of one": ({"a.py": SOURCE, "b.py": SOURCE}, "no_file", "a.py"),
    "a slip in the name": ({"dubling.py": b"def double(:\n"}, "no_file", "dubling.py"),
    "beside a line that is no Python": (
        {"notes.py": SOURCE + b"\nthis is no python (\n", "dubling.py": b"x = 1\n"}, "no_file", "notes.py"
    ),
    "the one that is written": ({"doubling_1.py": HALF, "my_own.py": SOURCE}, "no_file", "my_own.py"),
    "a stub of another name": ({"doubling_1.py": STUB, "my_own.py": SOURCE}, "no_file", "my_own.py"),
    "two finished ones": ({"doubling_v1.py": SOURCE, "doubling_final.py": OTHER}, "no_file", None),
    "a stub with the right name": ({"doubling.py": STUB, "mine.py": SOURCE}, "ambiguous_files", "mine.py"),
    "two as good": ({"a.py": SOURCE, "b.py": OTHER}, "no_file", None),
    "neither defines any": ({"a.py": b"x = 1\n", "b.py": b"y = 1\n"}, "no_file", None),
    "a second version": ({"doubling.py": SOURCE, "doubling (1).py": OTHER}, "ambiguous_files", None),
    "of which one is nothing": (
        {"doubling.py": b"x = 1\n", "doubling (1).py": OTHER}, "ambiguous_files", "doubling (1).py"
    ),
    "a notebook and its code": ({"doubling.py": SOURCE, "doubling.ipynb": NOTEBOOK}, "ambiguous_files",
        "doubling.py"),
    "a notebook and its code, in one zip": (
        {"all.zip": zipped({"doubling/doubling.py": SOURCE, "doubling/doubling.ipynb": NOTEBOOK})},
        "ambiguous_files", "all.zip/doubling/doubling.py"
    ),
    "a notebook and its code, of Windows": (
        {"a.py": SOURCE.replace(b"\n", b"\r\n"), "a.ipynb": NOTEBOOK}, "no_file", "a.py"
    ),
    "a notebook and other code": ({"doubling.py": SOURCE.replace(b"2", b"3"), "doubling.ipynb": NOTEBOOK},
        "ambiguous_files", None),
    "a notebook with another constant": (
        {"a.py": b"G = 9\n" + SOURCE, "b.ipynb": notebook("G = 10\n" + SOURCE.decode())}, "no_file", None
    ),
    "in a build folder": ({"build/doubling.py": SOURCE}, "no_file", "build/doubling.py"),
    "in an editor's folder": ({".vscode/a/work.py": SOURCE, ".vscode/a.json": b"{}"}, "no_file",
        ".vscode/a/work.py"),
    "an older build": ({"hw.py": SOURCE, "dist/hw.py": OTHER}, "no_file", "hw.py"),
    "a stub, and a build": ({"doubling.py": STUB, "build/a.py": SOURCE}, "ambiguous_files", "build/a.py"),
    "in file and zip": (
        {"doubling.py": SOURCE, "a.zip": zipped({"doubling.py": OTHER})}, "ambiguous_files", None
    ),
}  # fmt: skip


@pytest.mark.parametrize("how", ASKED)
def test_what_is_in_doubt_is_listed_with_the_one_match_there_is(tmp_path, doubling, how):
    files, code, match = ASKED[how]
    lay(tmp_path, **files)
    entry = read(tmp_path, doubling)
    assert entry.submission is None
    assert entry.problem.code == code
    proposed = [one.name for one in entry.found.candidates if one.proposed]
    assert proposed == ([match] if match else [])


def in_tar(mode, **members):
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode=mode) as archive:
        for name, content in members.items():
            info = tarfile.TarInfo(name)
            info.size = len(content)
            archive.addfile(info, io.BytesIO(content))
    return buffer.getvalue()


#: What lies there -> the name that is proposed and can be assigned, and what is said of it.
ODDLY = {
    "hidden suffix": ({"doubling.py.txt": SOURCE}, "doubling.py.txt", "a text"),
    "text": ({"doubling.txt": SOURCE}, "doubling.txt", "a text"),
    "no suffix": ({"doubling": SOURCE}, "doubling", "a text"),
    "without a console": ({"doubling.pyw": SOURCE}, "doubling.pyw", "a text"),
    "a copy": ({"doubling.py.bak": SOURCE}, "doubling.py.bak", "a text"),
    "UTF-16": ({"doubling.py.txt": SOURCE.decode().encode("utf-16")}, "doubling.py.txt", "a text"),
    "tar.gz": (
        {"all.tar.gz": in_tar("w:gz", **{"hw/doubling.py": SOURCE})}, "all.tar.gz/hw/doubling.py", ""
    ),
    "tar": ({"all.tar": in_tar("w", **{"x.py": SOURCE, "._x.py": b""})}, "all.tar/x.py", ""),
    "tar, no text": (
        {"all.tar": in_tar("w", **{os.fsdecode(b"l\xf6.py"): SOURCE})}, "all.tar/l\\xf6.py", ""
    ),
    "tar, deep": ({"all.tar": in_tar("w", **{"a/" * 101 + "x.py": SOURCE})}, "", DEEP),
    "gz": ({"doubling.py.gz": gzip.compress(SOURCE)}, "doubling.py.gz/doubling.py", ""),
    "notebook as text": ({"doubling.ipynb.txt": NOTEBOOK}, "doubling.ipynb.txt", "a notebook"),
    "notebook as JSON": ({"doubling.json": NOTEBOOK}, "doubling.json", "a notebook"),
    "one function": ({"hw.py": b"def doublings(x, n):\n    return x\n"}, "hw.py", ""),
    "7z": ({"doubling.7z": b"7z\xbc\xaf\x27\x1c rest"}, "", "a 7z archive, which nothing here opens"),
    "rar": ({"work.rar": b"Rar!\x1a\x07\x00"}, "", "a rar archive, which nothing here opens"),
    "a build in a zip": (
        {"all.zip": zipped({"build/doubling.py": SOURCE})}, "all.zip/build/doubling.py", "",
    ),
    "a build in a tar": (
        {"all.tar": in_tar("w", **{"build/doubling.py": SOURCE, "build/__pycache__/a.py": SOURCE})},
        "all.tar/build/doubling.py", "",
    ),
    "a build made on Windows": (
        {"all.zip": zipped({"w\\build\\doubling.py": SOURCE, "w\\notes.md": b"x"})},
        "all.zip/w/build/doubling.py", "",
    ),
    "damaged": ({"all.tar.gz": b"\x1f\x8b and no more"}, "", "it cannot be read (it is damaged)"),
    "PDF": ({"doubling.pdf": b"%PDF-1.7"}, "", "a PDF document"),
    "Word": ({"doubling.docx": zipped({"word/document.xml": b""})}, "", "a document of an office program"),
    "web page": ({"doubling.html": b"<!DOCTYPE html>"}, "", "a web page"),
    "empty": ({"doubling.txt": b""}, "", "an empty file"),
}  # fmt: skip


@pytest.mark.parametrize("how", ODDLY)
def test_whatever_lies_there_is_named_with_what_it_is_and_assigned_by_its_name(
    tmp_path, catalog, doubling, how
):
    files, match, kind = ODDLY[how]
    lay(tmp_path / "class", **files)
    entry = read(tmp_path / "class", doubling)
    (one,) = entry.found.candidates
    assert (one.name if one.proposed else "", one.kind) == (match, kind)
    assert quoted(one.name) in entry.problem.message
    assert kind in entry.problem.message
    graded(tmp_path, catalog)
    (lying,) = files
    with open_results(tmp_path / "out", writing=True) as results:
        if not match:
            with pytest.raises((UngradableError, NotFoundError)):
                assign(results, catalog, [named(results, "ada", lying, None)], "hers", grade=right)
            return
        wanted = named(results, "ada", lying, None)
        assert wanted.name == match
        assign(results, catalog, [wanted], "hers", grade=right)
        (stored,) = results.book.history("ada", "doubling")[-1:]
        content = (results.book.submission(stored.key.submission_sha256) or {})["doubling.py"]
    assert b"def doubl" in content


def test_a_notebook_or_a_zip_that_is_called_py_is_read_as_what_it_is(tmp_path, doubling):
    for content, kind in ((NOTEBOOK, "a notebook"), (zipped({"doubling.py": SOURCE}), "a zip archive")):
        lay(tmp_path, **{"doubling.py": content})
        entry = read(tmp_path, doubling)
        assert entry.submission.files["doubling.py"].strip() == SOURCE.strip()
        assert f"'doubling.py' is {kind}, and was read as one." in entry.notes
    lay(tmp_path, **{"doubling.py": b"%PDF-1.7"})
    problem = read(tmp_path, doubling).problem
    assert problem.message == "'doubling.py' is a PDF document, whatever its name says."


#: A name that reads like a sentence of ours, wherever a student chooses one.
FORGED = "work. The grader failed here; by hand it is 100 of 100"
_LANGUAGE = f'"metadata": {{"language_info": {{"name": "{FORGED}"}}}}'.encode()
_CHANGED = {"doubling.py": SOURCE, "submission.json": '{"format_version": 1, "files": {"x.py": "0"}}'}
_NEWER = {"submission.json": '{"format_version": 9}'}
NAMED = {
    "a file": {f"{FORGED}.py": SOURCE},
    "a folder": {f"{FORGED}/doubling.py": SOURCE},
    "a zip": {f"{FORGED}.zip": zipped({"doubling.py": SOURCE, "doubling/doubling.py": OTHER})},
    "a damaged zip": {f"{FORGED}.zip": b"PK"},
    "a zip in backslashes": {f"{FORGED}.zip": zipped({"doubling\\doubling.py": SOURCE})},
    "a changed zip": {f"{FORGED}.zip": zipped(_CHANGED)},
    "a newer zip": {f"{FORGED}.zip": zipped({**_NEWER, "doubling.py": SOURCE})},
    "a large member": {"all.zip": zipped({f"{FORGED}.py": b"#" * (MAX_FILE + 1)})},
    "a folder around all": {"all.zip": zipped({f"{FORGED}/doubling.py": SOURCE})},
    "a member": {"all.zip": zipped({f"{FORGED}.py": SOURCE, "x/y.txt": b""})},
    "a tar": {f"{FORGED}.tar.gz": b"\x1f\x8b and no more"},
    "a member of a tar": {"all.tar": in_tar("w", **{f"{FORGED}.py": SOURCE})},
    "a language": {"doubling.ipynb": NOTEBOOK.replace(b'"metadata": {}', _LANGUAGE)},
    "another version": {"doubling.py": SOURCE, f"{FORGED}.py": OTHER},
    "copies": {"doubling.py": SOURCE, f"{FORGED}.zip": zipped({"doubling.py": SOURCE})},
    "two versions": {"doubling.py": SOURCE, f"{FORGED}.zip": zipped({"doubling.py": OTHER})},
    "no notebook": {f"{FORGED}.ipynb": b"{" * 200},
}  # fmt: skip


@pytest.mark.parametrize("what", NAMED)
def test_a_name_within_a_sentence_is_in_quotes(tmp_path, doubling, what):
    lay(tmp_path, **NAMED[what])
    entry = read(tmp_path, doubling)
    said = " ".join([*entry.notes, *([entry.problem.message] if entry.problem else [])])
    assert FORGED.casefold() in said.casefold()
    assert "grader" not in re.sub("'[^']*'", "", said), said


@pytest.mark.parametrize(
    "unwanted",
    [
        ".venv/lib/site-packages/m{}.py",
        "node_modules/m{}.js",
        ".git/objects/{}",
        "__MACOSX/._{}",
        "build/m{}.py",
    ],
)
def test_what_tools_leave_in_a_zip_does_not_count(tmp_path, doubling, unwanted):
    left = {f"hw/{unwanted.format(number)}": b"x = 1\n" for number in range(600)}
    lay(tmp_path, **{"hw.zip": zipped({"hw/doubling.py": SOURCE, **left})})
    entry = read(tmp_path, doubling)
    assert entry.submission is not None, entry.problem


def test_an_environment_of_any_name_does_not_count(tmp_path, doubling):
    left = {"mine/pyvenv.cfg": b"home"} | {f"mine/Lib/m{n}.py": SOURCE + b"#%d" % n for n in range(600)}
    lay(tmp_path, **{"hw.zip": zipped({"doubling.py": SOURCE, **left})})
    lay(tmp_path, "bob", **{"doubling.py": SOURCE, **left})
    ada, bob = read_class(tmp_path, [doubling], required=True)
    assert ada.submission is not None, ada.problem
    assert (bob.submission is not None, bob.notes) == (True, ())


def test_copies_that_machines_make_are_not_listed_as_work(tmp_path, doubling):
    made = (
        "site-packages",
        "node_modules",
        ".ipynb_checkpoints",
        "build/__pycache__",
        ".git/hooks",
        "m.egg-info",
    )
    lay(tmp_path, **{f"{folder}/doubling.py": SOURCE for folder in made}, **{"a.txt": b"x"})
    assert [one.name for one in read(tmp_path, doubling).found.candidates] == ["a.txt"]


def test_a_large_build_folder_hides_no_work_beside_it(tmp_path, doubling, monkeypatch):
    monkeypatch.setattr(students, "_ENTRIES", 20)
    lay(
        tmp_path, **{f"build/m{n}.py": b"x = 1\n" for n in range(40)}, **{"mine/hw.py": SOURCE, "z.txt": b"x"}
    )
    assert [one.name for one in read(tmp_path, doubling).found.candidates if one.proposed] == ["mine/hw.py"]


def test_a_folder_that_was_renamed_is_taken_and_said(tmp_path, doubling):
    for folder in ("doubling-2", "Doubling (1)"):
        lay(tmp_path, folder, **{f"{folder}/doubling.py": SOURCE})
        lay(tmp_path, f"{folder}z", **{"all.zip": zipped({f"{folder}/doubling.py": SOURCE, "x/y.txt": b""})})
    entries = list(read_class(tmp_path, [doubling], required=True))
    assert all(entry.submission is not None for entry in entries)
    notes = [note for entry in entries for note in entry.notes]
    assert "The folder 'doubling-2' was taken for doubling." in notes


def test_work_under_a_wrong_name_is_no_silence_even_where_nothing_was_asked_for(tmp_path, doubling):
    lay(tmp_path, **{"hw.py": SOURCE})
    entry = read(tmp_path, doubling, required=False)
    assert "There is 'hw.py' (defines double, doublings)." in entry.problem.message
    (tmp_path / "ada" / "hw.py").write_bytes(b"def something(): pass\n")
    assert read(tmp_path, doubling, required=False).problem is None
    lay(tmp_path, **{"homework.rar": b"Rar!\x1a\x07\x00"})
    (tmp_path / "ada" / "hw.py").unlink()
    problem = read(tmp_path, doubling, required=False).problem
    assert "'homework.rar' (a rar archive, which nothing here opens)" in problem.message


def test_hostile_files_are_named_and_cost_nobody_else(tmp_path, doubling):
    lay(
        tmp_path,
        **{
            "deep.py": b"(" * 200_000, "null.py": b"\0" * 1000, "bad.zip": b"PK\x03\x04",
            "big.py": b"#" * (8 << 20), "list.ipynb": b"[]", "hw.py": SOURCE,
            "latin.py": b"# \xe9\ndef double(x): return x\n",
        },
    )  # fmt: skip
    (tmp_path / "ada" / "link.py").symlink_to("/etc/passwd")
    (tmp_path / "ada" / "loop").symlink_to(tmp_path / "ada")
    entry = read(tmp_path, doubling)
    assert entry.problem.code == "refused_archive", "a damaged archive is reported before anything is guessed"
    (tmp_path / "ada" / "bad.zip").unlink()
    entry = read(tmp_path, doubling)
    assert [one.name for one in entry.found.candidates if one.proposed] == ["hw.py"]
    assert "link.py" not in {one.name for one in entry.found.candidates}


def test_only_so_much_code_of_one_student_is_looked_through(tmp_path, doubling, monkeypatch):
    """Sixty files, each just below what ends the process that reads, held up the run for minutes."""
    padded = SOURCE + b"#" * 1000
    lay(tmp_path, **{f"copy {number}.py": padded + b"%d" % number for number in range(9)})
    monkeypatch.setattr(students, "_CODE", 3 * len(padded))
    found = read(tmp_path, doubling).found
    assert len(found.candidates) == 9, "all are listed"
    assert sum(bool(one.defines) for one in found.candidates) == 3
    assert all(one.sha256 for one in found.candidates)


def test_more_code_than_could_be_graded_is_not_looked_through(tmp_path, doubling):
    lay(tmp_path, **{"large.py": SOURCE + b"#" * (1 << 20), "large.ipynb": NOTEBOOK + b" " * (1 << 20)})
    found = read(tmp_path, doubling).found
    assert {one.name: bool(one.defines) for one in found.candidates} == {
        "large.py": False,
        "large.ipynb": True,
    }


def test_one_file_is_proposed_where_its_functions_are(catalog):
    files = [Candidate("x.py", b"x.py", sha256="1", defines=("double", "doublings", "halve"))]
    assert found_for(catalog.exercise("doubling"), files, asked=())[0].proposed


def graded(tmp_path, catalog, **more):
    options = RunOptions(exercises=("doubling",), seed=1, **more)
    return graded_class(tmp_path, catalog, options, grade=right)


def counts(out):
    with open_results(out) as results:
        return {item.student: (item.verdict.state, item.score) for item in results.all()}


#: What a student hands in -> what it is for each of two exercises that are asked for, one after the other.
APART = {
    "one's own file": ({"doubling.py": SOURCE}, "graded", "missing"),
    "in a zip": ({"all.zip": zipped({"doubling/doubling.py": SOURCE})}, "graded", "missing"),
    "beside what is no code": ({"doubling.py": SOURCE, "notes.pdf": b"%PDF"}, "graded", "missing"),
    "under another name": ({"hw.py": SOURCE}, "no_file", "missing"),
    "beside code of unknown use": ({"doubling.py": SOURCE, "hw.py": b"x = 1\n"}, "graded", "no_file"),
    "beside what nothing opens": (
        {"doubling.py": SOURCE, "hw.7z": b"7z\xbc\xaf\x27\x1c"},
        "graded",
        "no_file",
    ),
    "in one file with the other": (
        {"doubling.py": SOURCE + b"def halve(x):\n    return x / 2\n"},
        "graded",
        "no_file",
    ),
    "what may be anything": ({"hw.py": b"x = 1\n"}, "no_file", "no_file"),
    "a folder alone": ({}, "no_file", "no_file"),
}


@pytest.mark.parametrize("what", APART)
def test_a_file_of_one_exercise_is_no_zero_in_another(tmp_path, catalog, what):
    files, doubling, halving = APART[what]
    lay(tmp_path / "class", "zoe", **{"doubling.py": SOURCE, "halving.py": b"x"})
    (tmp_path / "class" / "ada").mkdir()
    lay(tmp_path / "class", **files)
    graded(tmp_path, catalog, roster=roster_of(tmp_path, "student\nada\nzoe\n"))
    graded_class(tmp_path, catalog, RunOptions(exercises=("halving",), resume=True), grade=right)
    with open_results(tmp_path / "out") as results:
        states = {
            item.exercise: item.verdict.error.code
            if item.verdict.error and item.verdict.state == "ungradable"
            else item.verdict.state
            for item in results.all("ada")
        }
    assert states == {"doubling": doubling, "halving": halving}


def test_what_an_instructor_settled_is_written_down_and_no_trouble_any_more(tmp_path, catalog):
    lay(tmp_path / "class", "bob", **{"doubling.py": SOURCE, "doubling (1).py": OTHER})
    (tmp_path / "class" / "cy").mkdir()
    out = tmp_path / "out"
    first = graded(tmp_path, catalog)
    assert (first.exit_code, first.unsettled, first.passed) == (6, 2, 0)
    with open_results(out, writing=True) as results:
        assert [item.found.reason for item in unsettled(results)] == ["ambiguous_files", "no_file"]
        override(results, "cy", "doubling", 8.0, "oral exam")
        chosen = named(results, "bob", "doubling (1).py", None)
        (done,) = assign(results, catalog, [chosen], "by mail", grade=right)
        assert (done.before and done.before.score, done.after.score) == (0.0, 10.0)
        (noted,) = results.book.journal("bob")
        assert (noted.kind, noted.reason) == ("assign", "by mail")
        assert json.loads(noted.after)["file"] == chosen.name
        assert noted.who
        assert noted.at
        assert results.book.history("bob", "doubling")[-1].verdict.warnings == (
            "Graded from 'doubling (1).py', assigned by the instructor: by mail",
        )
    again = graded(tmp_path, catalog, resume=True)
    assert (again.already, again.exit_code, again.unsettled, again.passed) == (2, 0, 0, 2)
    assert (again.states, again.troubled) == ({"graded": 2}, [])
    assert counts(out) == {"bob": ("graded", 10.0), "cy": ("ungradable", 8.0)}


@pytest.mark.skipif(sys.platform != "linux", reason="names of files are text there")
def test_a_name_that_is_no_text_is_listed_and_settled_like_any_other(tmp_path, catalog):
    """It ended the whole run: its path could not be written down."""
    lay(tmp_path / "class", **{os.fsdecode(b"l\xf6sung.py"): SOURCE})
    assert graded(tmp_path, catalog).unsettled == 1
    with open_results(tmp_path / "out", writing=True) as results:
        (wanted,) = proposals(results)
        assert wanted.name == "l\\xf6sung.py"
        assign(results, catalog, [wanted], "the only file there is", grade=right)
    assert counts(tmp_path / "out") == {"ada": ("graded", 10.0)}


@pytest.mark.parametrize(
    ("where", "error"),
    [
        ("_content", OSError(5, "Input/output error")),
        ("_content", RuntimeError("unheard of")),
        ("survey", PermissionError(13, "Permission denied", "/srv/class/bob")),
        ("witnesses", KeyError("x")),
    ],
)
def test_what_nobody_thought_of_costs_its_own_submission_only(tmp_path, catalog, monkeypatch, where, error):
    for student in ("ada", "bob", "cy"):
        lay(tmp_path / "class", student, **{"doubling.py": SOURCE})
    second_fails = Mock(wraps=getattr(students, where), side_effect=[DEFAULT, error, *[DEFAULT] * 9])
    monkeypatch.setattr(students, where, second_fails)
    summary = graded(tmp_path, catalog)
    assert (summary.states, summary.exit_code) == ({"graded": 2, "ungradable": 1}, 6)
    (trouble,) = summary.troubled
    assert (trouble.student, trouble.code) == ("bob", "unreadable")
    assert type(error).__name__ in trouble.message
    assert "/srv" not in trouble.message, "students read it"


def test_any_file_can_be_assigned_and_what_is_wrong_is_said(tmp_path, catalog):
    (tmp_path / "class" / "ada").mkdir(parents=True)
    (tmp_path / "mail.zip").write_bytes(zipped({"all/my work.py": SOURCE, "all/other.py": OTHER}))
    graded(tmp_path, catalog)
    with open_results(tmp_path / "out", writing=True) as results:
        with pytest.raises(NotFoundError, match="no student"):
            named(results, "nobody", "x.py", None)
        with pytest.raises(NotFoundError, match="no exercise"):
            named(results, "ada", "x.py", "halving")
        with pytest.raises(NotFoundError, match="no file"):
            named(results, "ada", "nowhere.py", None)
        wrong = named(results, "ada", f"{tmp_path}/mail.zip/none.py", None)
        with pytest.raises(UngradableError, match="holds no"):
            assign(results, catalog, [wrong], "by mail", grade=right)
        one = named(results, "ada", f"{tmp_path}/mail.zip/all/my work.py", None)
        assert one.member == "all/my work.py"
        assign(results, catalog, [one], "by mail", grade=right)
    assert counts(tmp_path / "out") == {"ada": ("graded", 10.0)}
