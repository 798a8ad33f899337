"""Hostile files cost themselves: they are read elsewhere, under limits, and named."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from course.catalog.models import Exercise
from course.errors import UngradableError
from course.grading.intake import archives, students
from course.grading.intake.archives import Reader, RefusedError
from course.grading.intake.downloads import Place, Student
from course.grading.quiz import grade_quiz
from course.handed_in.limits import MAX_CELLS
from course.handed_in.notebook import MAX_NOTES, notebook_source
from course.quizzing.bank import Bank
from tests.benchmarks.fuzz.run import run
from tests.growth import LIMIT, growth
from tests.unit.grading.made import notebook, zipped

_DOUBLE = "def double(x):\n    return 2 * x\n"


#: What once took minutes or hours, by size.
_LARGE: dict[str, Any] = {
    "statements beside a magic word": lambda n: notebook(f"{_DOUBLE}# get_ipython\n" + "x\n" * (10 * n)),
    "escaped quotes": lambda n: notebook(f"%magic\n{_DOUBLE}'" + "\\'" * (20 * n)),
    "magics": lambda n: notebook(_DOUBLE, "%x\n" * (10 * n)),
    "brackets": lambda n: notebook(f"%magic\n{_DOUBLE}" + "(" * (20 * n)),
    "bindings": lambda n: notebook(_DOUBLE.replace("2", "y"), "y = 1\n" * (5 * n)),
    "strings in lines": lambda n: notebook(f"%magic\n{_DOUBLE}" + ("'" + "\\'" * 50 + "\n") * (n // 5)),
}


@pytest.mark.soak
@pytest.mark.parametrize("kind", _LARGE)
def test_reading_a_notebook_takes_as_long_as_it_is_long(kind: str, doubling: Exercise) -> None:
    def reading(size: int) -> Callable[[], object]:
        data = _LARGE[kind](size)
        return lambda: notebook_source(data, doubling)

    assert growth(reading, 1000) < LIMIT


def test_what_is_left_out_is_told_within_bounds(doubling: Exercise) -> None:
    found = notebook_source(notebook(_DOUBLE, "%magic " + "x" * 500 + "\n" + "%y\n" * 5000), doubling)
    assert len(found.notes) <= MAX_NOTES + 2
    assert any("more lines left out" in note for note in found.notes)
    assert len(found.record()) < 8 << 10
    many = notebook_source(notebook(*[f"# {n}\n{_DOUBLE}" for n in range(MAX_CELLS)]), doubling)
    assert len(many.record()) < 64 << 10
    with pytest.raises(UngradableError) as caught:
        notebook_source(notebook(*[_DOUBLE] * (MAX_CELLS + 1)), doubling)
    assert caught.value.code == "too_large"


def test_an_escaped_line_end_in_a_string_moves_no_magic() -> None:
    from course.handed_in.cells import typed_cell

    cell = typed_cell(1, "a = 'one \\\n two'\n%magic\nb = 1\n")
    assert cell.dropped == ((3, "%magic"),)
    assert cell.tree is not None


@pytest.fixture
def strict() -> Iterator[Reader]:
    """With little time and memory, so that a test need not use up what honest files may."""
    found = Reader(archives._Limits(cpu_s=1, wall_s=60, memory=512 << 20))
    yield found
    found.close()


_BOMBS = {
    "time": lambda: notebook(_DOUBLE, "y = 1\n" * 150_000).replace(b"2 * x", b"y"),
    "memory": lambda: (
        b'{"nbformat": 4, "cells": [{"cell_type": "code", "metadata": {"k": ['
        + b"{}," * 8_000_000
        + b"{}]}}]}"
    ),
}


@pytest.mark.parametrize("bomb", _BOMBS)
def test_a_bomb_costs_itself_and_is_named(bomb: str, strict: Reader, doubling: Exercise) -> None:
    with pytest.raises(RefusedError) as caught:
        strict.notebook(_BOMBS[bomb](), doubling, "bomb.ipynb")
    assert caught.value.problem.code == "unreadable"
    assert "bomb.ipynb" in caught.value.problem.message
    assert strict.notebook(notebook(_DOUBLE), doubling, "honest.ipynb")[0].decode().startswith("def double")


def test_an_archive_is_read_once_for_all_questions_about_a_student(
    tmp_path: Path, doubling: Exercise
) -> None:
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
    tmp_path: Path, strict: Reader, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[object] = []
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


def test_the_wall_clock_ends_a_reader_that_uses_no_time(doubling: Exercise) -> None:
    with contextlib.closing(Reader(archives._Limits(cpu_s=60, wall_s=1.0))) as impatient:
        impatient.notebook(notebook(_DOUBLE), doubling, "a.ipynb")
        process = impatient._servant._process
        assert process is not None
        os.kill(process.pid, 19)  # SIGSTOP
        with pytest.raises(RefusedError) as caught:
            impatient.notebook(notebook(_DOUBLE), doubling, "b.ipynb")
        assert caught.value.problem.code == "unreadable"
        assert process.poll() is not None


def test_the_process_that_reads_loads_nothing_that_grades() -> None:
    """Each bomb ends one, and the next took three times as long to start."""
    code = "import course.grading.intake.archives, sys; print({'numpy', 'pytest'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_more_than_an_answer_may_be_is_not_taken(
    strict: Reader, doubling: Exercise, monkeypatch: pytest.MonkeyPatch
) -> None:
    strict.notebook(notebook(_DOUBLE), doubling, "a.ipynb")
    monkeypatch.setattr(archives, "MAX_ANSWER", 10)
    with pytest.raises(RefusedError, match=r"b\.ipynb"):
        strict.notebook(notebook(_DOUBLE), doubling, "b.ipynb")


def test_what_unpacks_a_damaged_archive_raises_as_it_likes(
    tmp_path: Path, doubling: Exercise, strict: Reader
) -> None:
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


def test_nesting_that_no_parser_follows_costs_one_file_of_an_archive(tmp_path: Path, strict: Reader) -> None:
    path = tmp_path / "m.zip"
    path.write_bytes(zipped({"bomb.py": f"double = {'-' * 6000}1", "mine.py": _DOUBLE}))
    found = {name: functions for name, _, functions, *_ in strict.outlines(path, (), ("double",))}
    assert found == {"bomb.py": (), "mine.py": ("double",)}


def test_what_is_said_of_an_archive_is_one_line_whatever_it_is_called(
    tmp_path: Path, doubling: Exercise, strict: Reader
) -> None:
    """A name that is no text ended the process; a line end in a folder's name was a line of a report."""
    path = tmp_path / "m\udce9.zip"
    path.write_bytes(zipped({"a\n\x1b[2Jb\u202e/doubling.py": _DOUBLE}))
    held = strict.module_in(path, doubling)
    assert held is not None
    (note,) = held.notes
    assert note.isprintable()
    assert r"m\udce9.zip" in note


@pytest.mark.parametrize("kind", ["notebooks", "zips", "frames", "scenes", "documents"])
def test_random_input_meets_words_and_no_fault(kind: str) -> None:
    """A glance: tests/benchmarks/fuzz/run.py runs for as long as it is told."""
    outcomes, faults = run(kind, seed=7, numbers=range(60))
    assert not faults
    assert len(outcomes) > 1, "inputs that get in, and inputs that do not"


@pytest.mark.parametrize(
    "quiz",
    ["[" * 970 + "1" + "]" * 970, '["\\ud800"]', "[1e999, NaN]", f"[{'9' * 4000}]", '{"a": 1}', "true"],
)
def test_no_record_of_a_quiz_hurts_whoever_asked(tmp_path: Path, quiz: str) -> None:
    """One list a thousand deep ended the run: whoever asks stands deeper than the process that reads."""
    manifest = f'{{"format_version": 1, "files": {{}}, "quiz": {quiz}}}'
    (tmp_path / "ada.zip").write_bytes(zipped({"submission.json": manifest}))
    student = Student("ada", Place(tmp_path))

    def asked(deeper: int) -> Any:
        return asked(deeper - 1) if deeper else students.read_quiz(student)[0]

    record = asked(200)
    assert isinstance(record, str)
    verdict = grade_quiz(Bank(()), record)
    assert verdict is not None
    assert (verdict.state, verdict.error.code) == ("ungradable", "quiz_record_inconsistent")  # type: ignore[union-attr]
