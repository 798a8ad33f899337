"""Random edits of a notebook that do not change what its code means, as students and Jupyter make them."""

from __future__ import annotations

import ast
import copy
import itertools
import json
import random
import re
from collections.abc import Callable
from typing import Any

RawCell = dict[str, Any]

EXPERIMENTS = (
    "print('hello')",
    "h = undefined_name  # a parameter's name",
    "q = np.linspace(0, 1)\nplt.plot(q)",
    "%matplotlib inline\nimport matplotlib.pyplot as plt",
    "!pip install something",
    "%%bash\nls",
    "%%javascript\nalert(1)",
    "raise SystemExit",
    "for for",
    "while True:\n    v = 1\n    break",
    "state?\n",
    "t = 1\nt += 1\nassert t == 3",
)
MAGICS = ("%time 1 + 1", "!ls", "files = !ls", "%matplotlib inline", "help?", "?help", "%load_ext autoreload")


def edited(data: bytes, seed: int) -> bytes:
    """A notebook after one to eight random edits.

    Args:
        data: a notebook whose code cells are right.
    """
    rng = random.Random(seed)
    notebook = json.loads(data)
    cells: list[RawCell] = notebook["cells"]
    for cell in cells:
        cell["source"] = "".join(cell["source"])
    for edit in rng.choices(EDITS, k=rng.randint(1, 8)):
        edit(cells, rng)
    # Whatever comes before the right version counts for nothing, so this goes last.
    if rng.random() < 0.4:
        draft(cells, rng)
    if rng.random() < 0.2:
        notebook["metadata"] = rng.choice(
            [{}, {"kernelspec": {"name": "venv", "display_name": "my venv", "language": "python"}}]
        )
    if rng.random() < 0.3:
        for cell in cells:
            cell["source"] = cell["source"].splitlines(keepends=True)
    indent = rng.choice([None, 1, 4])
    return json.dumps(notebook, indent=indent, ensure_ascii=rng.random() < 0.5).encode()


def new_cell(source: str, metadata: dict[str, Any] | None = None) -> RawCell:
    return {"cell_type": "code", "source": source, "metadata": metadata or {}, "outputs": []}


def solutions(cells: list[RawCell]) -> list[int]:
    """Where cells stand that hold Python which counts."""
    return [
        index
        for index, cell in enumerate(cells)
        if cell["cell_type"] == "code"
        and re.search(r"^(def|import numpy|import math)\b", cell["source"], re.M)
    ]


def split(cells: list[RawCell], rng: random.Random) -> None:
    """Between two statements; Jupyter gives both halves the marks of the whole."""
    index = rng.choice(solutions(cells))
    text = cells[index]["source"]
    try:
        body = ast.parse(text).body
    except SyntaxError:
        return
    if len(body) < 2:
        return
    node = rng.choice(body[1:])
    line = min([node.lineno, *(one.lineno for one in getattr(node, "decorator_list", []))]) - 1
    lines = text.split("\n")
    second = copy.deepcopy(cells[index]) | {"source": "\n".join(lines[line:]), "id": f"{rng.random()}"}
    cells[index]["source"] = "\n".join(lines[:line])
    cells.insert(index + 1, second)


def merge(cells: list[RawCell], rng: random.Random) -> None:
    """Two code cells become one with the marks of the first."""
    pairs = [
        index
        for index, (one, other) in enumerate(itertools.pairwise(cells))
        if one["cell_type"] == other["cell_type"] == "code"
        and not any(
            cell["source"].lstrip().startswith("%%") or "for for" in cell["source"] for cell in (one, other)
        )
        and "raise SystemExit" not in one["source"] + other["source"]
        and not any(name in one["source"] + other["source"] for name in ("undefined_name", "plt.", "assert"))
    ]
    if pairs:
        index = rng.choice(pairs)
        cells[index]["source"] += "\n" + rng.choice(["", "\n"]) + cells.pop(index + 1)["source"]


def duplicate(cells: list[RawCell], rng: random.Random) -> None:
    """Jupyter gives the copy another id and leaves its marks."""
    index = rng.choice(solutions(cells))
    cells.insert(rng.randint(0, len(cells)), copy.deepcopy(cells[index]) | {"id": f"{rng.random()}"})


def shuffle(cells: list[RawCell], rng: random.Random) -> None:
    rng.shuffle(cells)


def move(cells: list[RawCell], rng: random.Random) -> None:
    cells.insert(rng.randrange(len(cells)), cells.pop(rng.randrange(len(cells))))


def strip_one(cells: list[RawCell], rng: random.Random) -> None:
    rng.choice(cells)["metadata"] = {}


def strip_all(cells: list[RawCell], rng: random.Random) -> None:
    for cell in cells:
        cell["metadata"] = {}


def strip_ids(cells: list[RawCell], rng: random.Random) -> None:
    for cell in cells:
        cell.pop("id", None)


def remove(cells: list[RawCell], rng: random.Random) -> None:
    """Any cell but those that count."""
    counted = solutions(cells)
    others = [index for index in range(len(cells)) if index not in counted]
    if others:
        del cells[rng.choice(others)]


def run(cells: list[RawCell], rng: random.Random) -> None:
    """Outputs, some of them large, and other metadata that Jupyter writes."""
    for number, cell in enumerate(cells):
        if cell["cell_type"] == "code" and rng.random() < 0.5:
            text = "def rk4_step(): pass\n" * rng.choice([1, 3000])
            cell["outputs"] = [{"output_type": "stream", "name": "stdout", "text": text}]
            cell["execution_count"] = number
            cell["metadata"] = {**cell["metadata"], "collapsed": True, "scrolled": False, "tags": ["mine"]}


def add_magic(cells: list[RawCell], rng: random.Random) -> None:
    cell = cells[rng.choice(solutions(cells))]
    magic = rng.choice(MAGICS)
    cell["source"] = f"{magic}\n{cell['source']}" if rng.random() < 0.5 else f"{cell['source']}\n{magic}"


def time_it(cells: list[RawCell], rng: random.Random) -> None:
    cell = cells[rng.choice(solutions(cells))]
    if not cell["source"].startswith("%%"):
        cell["source"] = f"{rng.choice(['%%time', '%%capture out', '%%prun -q'])}\n{cell['source']}"


def experiment(cells: list[RawCell], rng: random.Random) -> None:
    cells.insert(rng.randint(0, len(cells)), new_cell(rng.choice(EXPERIMENTS)))


def line_ends(cells: list[RawCell], rng: random.Random) -> None:
    cell = rng.choice(cells)
    cell["source"] = cell["source"].replace("\r\n", "\n").replace("\n", "\r\n")


def draft(cells: list[RawCell], rng: random.Random) -> None:
    """An older, wrong version of a function in front of everything."""
    name = rng.choice(["rk4_step", "integrate", "explicit_euler_step"])
    marks = next((cell["metadata"] for cell in cells if f"def {name}" in "".join(cell["source"])), {})
    cells.insert(0, new_cell(f"def {name}(*anything):\n    raise NotImplementedError", copy.deepcopy(marks)))


EDITS: tuple[Callable[[list[RawCell], random.Random], None], ...] = (
    split, merge, duplicate, shuffle, move, strip_one, strip_all, strip_ids, remove, run, add_magic, time_it,
    experiment, line_ends,
)  # fmt: skip
