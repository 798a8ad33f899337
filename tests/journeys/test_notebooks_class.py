"""A class that hands in notebooks, damaged and hostile: one grading run takes them all."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from course.catalog.load import Catalog
from course.notebooks.build import exercise_cells
from course.notebooks.cells import document
from tests.unit.notebooks.edits import new_cell

ROOT = Path(__file__).resolve().parents[2]
EXERCISE = Catalog().exercise("integrators")
SOLUTION = (ROOT / "solutions" / "integrators" / "integrators.py").read_text("utf-8")

# All of them look at one class, which is graded once.
pytestmark = [pytest.mark.soak, pytest.mark.xdist_group("notebooks_class")]


def notebook_of(text: str) -> bytes:
    return document(exercise_cells(EXERCISE, text), kind="exercise", id="integrators", version="1")


def changed(change: Callable[[dict[str, Any]], object]) -> bytes:
    notebook = json.loads(notebook_of(SOLUTION))
    change(notebook)
    return json.dumps(notebook).encode()


def first_solution(notebook: dict[str, Any]) -> dict[str, Any]:
    roles = ((cell, cell["metadata"].get("course", {}).get("role")) for cell in notebook["cells"])
    return next(cell for cell, role in roles if role == "solution")


def with_cells(*texts: str) -> bytes:
    return changed(lambda notebook: notebook["cells"].extend(map(new_cell, texts)))


def with_output(size: int) -> bytes:
    output = {"output_type": "stream", "name": "stdout", "text": "x" * size}
    return changed(lambda notebook: first_solution(notebook).update(outputs=[output]))


def in_front(text: str) -> bytes:
    """The text before the first function, in its cell."""

    def put(notebook: dict[str, Any]) -> None:
        cell = first_solution(notebook)
        cell["source"] = text + "".join(cell["source"])

    return changed(put)


def in_text(old: bytes, new: bytes) -> bytes:
    data = notebook_of(SOLUTION)
    assert old in data
    return data.replace(old, new, 1)


def nested(depth: int) -> bytes:
    return in_text(b'"outputs": []', b'"outputs": ' + b"[" * depth + b"]" * depth)


def same_ids(notebook: dict[str, Any]) -> None:
    for cell in notebook["cells"]:
        cell["id"] = "same"


#: What is handed in, and what becomes of it: the score of the right .py (None), or why it is refused.
HOSTILE: dict[str, tuple[Callable[[], bytes], str | None]] = {
    "30 MB of output": (lambda: with_output(30 << 20), None),
    "50 MB of output": (lambda: with_output(50 << 20), "too_large"),
    "outputs 500 deep": (lambda: nested(500), None),
    "outputs 200000 deep": (lambda: nested(200_000), "not_a_notebook"),
    "no notebook": (lambda: b"def rk4_step(): pass", "not_a_notebook"),
    "a list": (lambda: b"[1, 2]", "not_a_notebook"),
    "nothing": (lambda: b"", "empty_file"),
    "cut off": (lambda: notebook_of(SOLUTION)[:5000], "not_a_notebook"),
    "R": (lambda: changed(lambda n: n.update(metadata={"language_info": {"name": "R"}})), "other_kernel"),
    "not UTF-8 in code": (lambda: in_text(b"q + h", b"q + \xff\xfe h"), "not_a_notebook"),
    "half a surrogate": (lambda: in_text(b"q + h", b"q + \\ud800 h"), "not_a_notebook"),
    "one id for all": (lambda: changed(same_ids), None),
    "10000 cells": (lambda: with_cells(*(f"y{k} = {k}" for k in range(10_000))), "too_large"),
    "1900 cells": (lambda: with_cells(*(f"y{k} = {k}" for k in range(1900))), None),
    "a chain of 1900": (lambda: with_cells(*(f"y{k} = y{k + 1}" for k in range(1900))), None),
    "a million spaces": (lambda: with_cells(" " * 1_000_000 + "§"), None),
    "12 MB of code": (lambda: with_cells("1\n" * 6_000_000), "too_large"),
    "bash": (lambda: with_cells("%%bash\nrm -rf /", "!rm -rf ~\nz = 1"), None),
    "shell in a function's cell": (lambda: in_front("!rm -rf ~\n%time 1\nhelp?\n"), None),
    "magic written out": (lambda: in_front("get_ipython().system('rm -rf ~')\n"), None),
    "get_ipython is needed": (lambda: in_front("shell = get_ipython()\n"), None),
    "ends the process": (lambda: in_front("import os\nos._exit(3)\n"), None),
    "ends the process, and is used": (lambda: in_front("import os\nnp.left = os._exit(3)\n"), "import_crash"),
    "no code": (lambda: changed(lambda n: n.update(cells=n["cells"][:2])), "no_declared_functions"),
    "cells are words": (lambda: changed(lambda n: n.update(cells="none")), "not_a_notebook"),
}


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, Any]]:
    """Everybody's line of results, by name."""
    folder = tmp_path_factory.mktemp("class")
    handed_in = {f"hostile {name}": make() for name, (make, _) in HOSTILE.items()}
    for name, data in handed_in.items():
        (folder / "in" / name).mkdir(parents=True)
        (folder / "in" / name / "integrators.ipynb").write_bytes(data)
    (folder / "in" / "right.py").mkdir()
    (folder / "in" / "right.py" / "integrators.py").write_text(SOLUTION, "utf-8")
    command = [sys.executable, "-m", "course", "grade", "run", "in", "--exercise", "integrators"]
    ran = subprocess.run(
        [*command, "--out", "out", "-j", "2"],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert ran.returncode == 6, ran.stdout[-2000:] + ran.stderr[-2000:]
    lines = (folder / "out" / "results.jsonl").read_text("utf-8").splitlines()
    return {line["student"]: line for line in map(json.loads, lines)}


@pytest.mark.parametrize("name", HOSTILE)
def test_what_is_hostile_is_graded_or_refused_with_a_reason(
    results: dict[str, dict[str, Any]], name: str
) -> None:
    line, reason, right = results[f"hostile {name}"], HOSTILE[name][1], results["right.py"]
    assert right["score"] == right["max_score"]
    if reason is None:
        assert (line["state"], line["score"]) == ("graded", right["score"])
    else:
        assert (line["state"], line["error"]["code"]) == ("ungradable", reason)
        assert line["error"]["message"]
        assert line["error"]["help"]


@pytest.mark.parametrize(
    "name", ["bash", "shell in a function's cell", "magic written out", "get_ipython is needed"]
)
def test_what_was_left_out_is_said_with_its_cell(results: dict[str, dict[str, Any]], name: str) -> None:
    assert any("left out" in note for note in results[f"hostile {name}"]["warnings"])
