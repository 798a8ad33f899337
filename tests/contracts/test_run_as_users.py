"""What once broke a run, in one class, graded by root and by an ordinary user: nobody else loses by it."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING

import pytest

from tests.contracts.levels import require_level
from tests.contracts.users import ROOT, USERS, run_as

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="users and levels of Linux")

MINI = ROOT / "tests" / "fixtures" / "mini_course"
MODEL = (MINI / "solutions" / "doubling" / "doubling.py").read_text("utf-8")
_WRONG = "\n\ndef double(x):\n    {}\n\n\ndef doublings(x, n):\n    {}\n"
#: Read from its file by every process that grades, hence set here and not by a test's own process.
_RUN = """
import os, sys
content, level, folder, out = sys.argv[1:]
os.environ["COURSE_CONTENT"] = content
from course.catalog.load import Catalog
from course.grading.running.run import RunOptions, grade_class
from course.scoring.terms import Terms
from pathlib import Path
options = RunOptions(exercises=("doubling",), terms=Terms(at_least=level, level=level), seed=5)
grade_class(Path(folder), Path(out), Catalog(), options, lambda *_: None)
"""


def _notebook(cell: str) -> bytes:
    made = {"cell_type": "code", "source": cell, "metadata": {}, "outputs": []}
    return json.dumps({"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": [made]}).encode()


#: student -> file, content; all but the model's are hostile or broken
CLASS: dict[str, tuple[str, bytes]] = {
    "a statement bomb": (
        "doubling.ipynb",
        _notebook(f"# get_ipython\n{_WRONG.format('pass', 'pass')}" + "x = 1\n" * 200_000),
    ),
    "brackets": ("doubling.ipynb", _notebook("%magic\ndef double(x):\n    return None\n" + "(" * 300_000)),
    "ragged": ("doubling.py", _WRONG.format("return [[1], [2, 3]]", "return [[x], [x, x]]").encode()),
    "beyond 64 bits": ("doubling.py", _WRONG.format("return 10**30", "return [10**30] * (n + 1)").encode()),
    "infinite": ("doubling.py", _WRONG.format("return float('inf')", "return [float('nan')] * 7").encode()),
    "a line of its own": (
        "doubling.py",
        _WRONG.format(*[r"raise ValueError('no\n  model: 10 of 10 \u202e')"] * 2).encode(),
    ),
    "two\nlines": ("doubling.py", b""),
    "zz model": ("doubling.py", MODEL.encode()),
}


@pytest.mark.parametrize("user", USERS)
@pytest.mark.parametrize("level", ["L1", "L2", "L3"])
def test_a_class_of_what_once_broke_is_graded_to_the_end(level: str, user: str, tmp_path: Path) -> None:
    require_level(level)
    for student, (name, content) in CLASS.items():
        (tmp_path / "class" / student).mkdir(parents=True)
        (tmp_path / "class" / student / name).write_bytes(content)
    out = tmp_path / "out"
    run_as(user, _RUN, str(MINI), level, str(tmp_path / "class"), str(out))
    lines = [json.loads(line) for line in (out / "results.jsonl").read_text("utf-8").splitlines()]
    found = {line["student"]: line for line in lines}
    assert found.keys() == CLASS.keys()
    assert not [name for name, line in found.items() if line["state"] == "grader_error"]
    assert (found["zz model"]["score"], found["zz model"]["isolation"]) == (10, level)
    assert not [name for name, line in found.items() if line["score"] and name != "zz model"]
