"""Whatever students and Jupyter do to the cells of a notebook: the same code gets the same score."""

import ast
import copy
import itertools
import json
import random
import re
import warnings

import numpy as np
import pytest

from course.handed_in.notebook import RECORD, notebook_source, opened
from course.physics import systems
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission

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


def edited(data, seed):
    """A notebook after one to eight random edits.

    Args:
        data: a notebook whose code cells are right.
    """
    rng = random.Random(seed)
    notebook = json.loads(data)
    cells = notebook["cells"]
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


def new_cell(source, metadata=None):
    return {"cell_type": "code", "source": source, "metadata": metadata or {}, "outputs": []}


def solutions(cells):
    """Where cells stand that hold Python which counts."""
    return [
        index
        for index, cell in enumerate(cells)
        if cell["cell_type"] == "code"
        and re.search(r"^(def|import numpy|import math)\b", cell["source"], re.M)
    ]


def split(cells, rng):
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


def merge(cells, rng):
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


def duplicate(cells, rng):
    """Jupyter gives the copy another id and leaves its marks."""
    index = rng.choice(solutions(cells))
    cells.insert(rng.randint(0, len(cells)), copy.deepcopy(cells[index]) | {"id": f"{rng.random()}"})


def shuffle(cells, rng):
    rng.shuffle(cells)


def move(cells, rng):
    cells.insert(rng.randrange(len(cells)), cells.pop(rng.randrange(len(cells))))


def strip_one(cells, rng):
    rng.choice(cells)["metadata"] = {}


def strip_all(cells, rng):
    for cell in cells:
        cell["metadata"] = {}


def strip_ids(cells, rng):
    for cell in cells:
        cell.pop("id", None)


def remove(cells, rng):
    """Any cell but those that count."""
    counted = solutions(cells)
    others = [index for index in range(len(cells)) if index not in counted]
    if others:
        del cells[rng.choice(others)]


def run(cells, rng):
    """Outputs, some of them large, and other metadata that Jupyter writes."""
    for number, cell in enumerate(cells):
        if cell["cell_type"] == "code" and rng.random() < 0.5:
            text = "def rk4_step(): pass\n" * rng.choice([1, 3000])
            cell["outputs"] = [{"output_type": "stream", "name": "stdout", "text": text}]
            cell["execution_count"] = number
            cell["metadata"] = {**cell["metadata"], "collapsed": True, "scrolled": False, "tags": ["mine"]}


def add_magic(cells, rng):
    cell = cells[rng.choice(solutions(cells))]
    magic = rng.choice(MAGICS)
    cell["source"] = f"{magic}\n{cell['source']}" if rng.random() < 0.5 else f"{cell['source']}\n{magic}"


def time_it(cells, rng):
    cell = cells[rng.choice(solutions(cells))]
    if not cell["source"].startswith("%%"):
        cell["source"] = f"{rng.choice(['%%time', '%%capture out', '%%prun -q'])}\n{cell['source']}"


def experiment(cells, rng):
    cells.insert(rng.randint(0, len(cells)), new_cell(rng.choice(EXPERIMENTS)))


def line_ends(cells, rng):
    cell = rng.choice(cells)
    cell["source"] = cell["source"].replace("\r\n", "\n").replace("\n", "\r\n")


def draft(cells, rng):
    """An older, wrong version of a function in front of everything."""
    name = rng.choice(["rk4_step", "integrate", "explicit_euler_step"])
    marks = next((cell["metadata"] for cell in cells if f"def {name}" in "".join(cell["source"])), {})
    cells.insert(0, new_cell(f"def {name}(*anything):\n    raise NotImplementedError", copy.deepcopy(marks)))


EDITS = (
    split, merge, duplicate, shuffle, move, strip_one, strip_all, strip_ids, remove, run, add_magic, time_it,
    experiment, line_ends,
)  # fmt: skip


STEPS = ("explicit_euler_step", "semi_implicit_euler_step", "velocity_verlet_step", "rk4_step")


def handed_in(module, exercise):
    """A notebook as a grading run reads it back."""
    return opened({exercise.module: module.source, RECORD: module.record()}, exercise)


def behaviour(source):
    """What the functions of a module give, to the last bit."""
    names = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about escapes and the like in strings
        exec(compile(source, "integrators.py", "exec", dont_inherit=True), names)
    system = systems.Oscillator(omega=2.0)
    start = np.array([1.0]), np.array([0.5])
    runs = [names["integrate"](names[step], system, *start, 0.5, 0.1) for step in STEPS]
    times = names["integrate"](names["rk4_step"], system, *start, 0.5, 0.05)[0]
    return [np.concatenate([q.ravel(), v.ravel()]).tobytes() for _, q, v in runs] + [times.tobytes()]


@pytest.mark.parametrize("first", range(0, 500, 125))
def test_500_random_edits_leave_the_code_what_it_was(solved, solution, integrators, first):
    right = behaviour(solution.encode())
    for seed in range(first, first + 125):
        module = notebook_source(edited(solved, seed), integrators)
        assert behaviour(module.source) == right, f"seed {seed}"


@pytest.mark.parametrize("function", STEPS)
def test_a_wrong_function_stays_wrong(solved, solution, integrators, function):
    """The comparison above can fail."""
    wrong = f"{solution}\n\ndef {function}(accel, t, q, v, h):\n    return q + h * v, v\n"
    assert behaviour(wrong.encode()) != behaviour(notebook_source(solved, integrators).source)


def test_the_same_code_scores_the_same_as_a_file_and_as_a_notebook(solved, solution, integrators, catalog):
    """Some of its checks pass and some fail."""
    right, wrong = "h / 6 * (dq1", "h / 5 * (dq1"
    assert right in solution
    with GradingSession(integrators, catalog, scope="full") as session:
        as_file = session.grade(Submission({"integrators.py": solution.replace(right, wrong).encode()}))
        assert 0 < as_file.score < integrators.max_points
        for seed in (1, 2):
            edits = edited(solved.replace(right.encode(), wrong.encode()), seed)
            module = notebook_source(edits, integrators)
            as_notebook = session.grade(handed_in(module, integrators))
            assert as_notebook.score == as_file.score
            statuses = [[check.status for check in one.checks] for one in (as_notebook, as_file)]
            assert statuses[0] == statuses[1]
            assert as_notebook.warnings == module.notes


def test_an_error_in_a_notebook_is_told_by_its_cell(solved, integrators, catalog):
    raising = solved.replace(b"return q + h * v, v + h * accel(t, q, v)", b"return q / (0 * h).nothing")
    assert raising != solved
    module = notebook_source(raising, integrators)
    with GradingSession(integrators, catalog) as session:
        verdict = session.grade(handed_in(module, integrators))
        line = next(n for n, text in enumerate(module.source.decode().split("\n"), 1) if "nothing" in text)
        check = next(check for check in verdict.checks if check.task == "explicit_euler_step")
        assert f"in {module.place(line)} of your notebook" in check.message
        assert (check.traceback or "").startswith(f"{module.place(line)} in explicit_euler_step")
        syntax = notebook_source(solved.replace(b"return q + h * v, v", b"return q + * h, v"), integrators)
        broken = session.grade(handed_in(syntax, integrators))
    assert broken.state == "graded"
    assert {check.task for check in broken.checks if check.status != "pass"} == {"explicit_euler_step"}
    (check,) = [one for one in broken.checks if one.id == check.id]
    assert check.message.startswith("Python cannot read `explicit_euler_step` in cell ")
    assert not broken.warnings  # the check has said it
