"""One function of a right solution is broken in some way: a finding that helps, and all else is scored.

Every task of every exercise, through the real boundary: a value of the wrong type, shape or kind, NaN, an
exception, a function that is not there, one that never answers, exits, takes all memory, prints without end,
or plots. The rest of the solution keeps a copy of its own of the function, so that nothing but the answer to
the checks is broken.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from typing import Any

import pytest

from course.authoring.exercises.grading import solution_path
from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission, Terms
from course.scoring.verdict import CheckResult

CATALOG = Catalog()
#: What stands in the place of a function; ``own`` is the right one. Each check of its task waits for "slow",
#: which stands where an ordinary run tries it on a task with few.
WAYS = {
    "missing": "del {name}",
    "raises": "def {name}(*args, **names):\n    raise ValueError('no idea')",
    "unfinished": "def {name}(*args, **names):\n    raise NotImplementedError",
    "nothing": "def {name}(*args, **names):\n    return None",
    "text": "def {name}(*args, **names):\n    return 'seven'",
    "slow": "def {name}(*args, **names):\n    while True:\n        pass",
    "shape": "def {name}(*args, **names):\n    return np.zeros((2, 3, 4))",
    "object": "def {name}(*args, **names):\n    return object()",
    "nan": "def {name}(*args, **names):\n    return spoiled(own_{name}(*args, **names), np.nan)",
    "infinite": "def {name}(*args, **names):\n    return spoiled(own_{name}(*args, **names), np.inf)",
    "exits": "def {name}(*args, **names):\n    import os\n    os._exit(0)",
    "memory": "def {name}(*args, **names):\n    return [0.0] * 10**12",
    "plots": "def {name}(*args, **names):\n    plt.plot([1])\n    return own_{name}(*args, **names)",
}
#: Where a number is wrong, a check may say so in its own words alone.
NUMBERS = ("nan", "infinite")
#: What a function may do beside its work without losing a point.
HARMLESS = "def {name}(*args, **names):\n    print('x' * 3000)\n    return own_{name}(*args, **names)"
PLOTS_AT_THE_END = "\nfigure, axes = plt.subplots()\naxes.plot([1, 2])\nplt.show()\n"
HEAD = '''\
import matplotlib.pyplot as plt
import numpy as np

def spoiled(value, bad):
    """Every number of it, or all of it if there is none."""
    if isinstance(value, dict):
        return {key: spoiled(item, bad) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(spoiled(item, bad) for item in value)
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiu":
        return np.full(value.shape, bad)
    return value if isinstance(value, bool) else bad

'''
#: Seconds of CPU time a check waits; one that never answers is waited for by each check of its task. What a
#: right solution takes for its longest check, with three times that to spare: 0.07 s, and of these exercises
#: 0.3 s, 0.7 s and, for all the tunings that a fleet of robots is driven by, more than a second.
LATE = 60.0
SOON = {"engine-comparison": 2.0, "validation": 5.0, "sim-to-real": 15.0}
SOONEST = 0.3


class Renamed(ast.NodeTransformer):
    """Give a function another name wherever the rest of a file uses it."""

    def __init__(self, name: str) -> None:
        self.name = name

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        given = [*node.args.args, *node.args.kwonlyargs, *node.args.posonlyargs]
        if node.name == self.name:
            node.name = f"own_{self.name}"
        return node if any(one.arg == self.name for one in given) else self.generic_visit(node)

    def visit_Name(self, node: ast.Name) -> ast.AST:
        if node.id == self.name:
            node.id = f"own_{self.name}"
        return node


def broken(source: str, names: list[str], way: str) -> str:
    """The solution with functions replaced, and its own copies for the rest of it."""
    tree, replaced = ast.parse(source), ""
    for name in names:
        tree = Renamed(name).visit(tree)
        replaced += f"{name} = own_{name}\n{way.format(name=name)}\n"
    future = "from __future__ import annotations\n"
    return f"{future}{HEAD}{ast.unparse(tree).replace(future.strip(), '')}\n{replaced}{PLOTS_AT_THE_END}"


@pytest.fixture(scope="module")
def session_of() -> Iterator[Any]:
    opened: list[GradingSession] = []

    @cache
    def session(exercise: Exercise, timeout: float) -> GradingSession:
        opened.append(GradingSession(exercise, CATALOG, scope="full", terms=Terms(timeout=timeout)))
        return opened[-1]

    yield session
    for one in opened:
        one.close()


def graded(session: GradingSession, source: str) -> dict[str, list[CheckResult]]:
    """The results, by task."""
    verdict = session.grade(Submission({session.exercise.module: source.encode()}))
    assert verdict.state == "graded", verdict.error
    by_task: dict[str, list[CheckResult]] = {}
    for check in verdict.checks:
        by_task.setdefault(check.task, []).append(check)
    return by_task


def check_one(session: GradingSession, task: str, kind: str) -> None:
    path = solution_path(CATALOG, session.exercise)
    by_task = graded(session, broken(path.read_text("utf-8"), [task], WAYS[kind]))
    lost = [check for check in by_task[task] if check.status != "pass"]
    assert lost, f"{task} {kind}: no check of it fails"
    for check in lost:
        assert check.message, check.id
        assert check.help, check.id
    assert kind in NUMBERS or any(check.diagnosis for check in lost), f"{task} {kind}: no mistake is named"
    others = [check for name, checks in by_task.items() if name != task for check in checks]
    fallen = [(check.id, str(check.status), check.message) for check in others if check.status != "pass"]
    assert not fallen, f"{task} {kind} takes others with it"


def cases() -> Iterator[Any]:
    """Everything; in an ordinary run every way once, each in another task."""
    number = 0
    for exercise in CATALOG.exercises():
        for task in exercise.task:
            for index, kind in enumerate(WAYS):
                turn = number % len(WAYS) == index and number < len(WAYS)
                yield pytest.param(
                    exercise,
                    task.id,
                    kind,
                    id=f"{exercise.id}-{task.id}-{kind}",
                    marks=() if turn else pytest.mark.soak,
                )
            number += 1


@pytest.mark.parametrize(("exercise", "task", "kind"), list(cases()))
def test_a_broken_function_costs_its_own_task_only(
    session_of: Any, exercise: Exercise, task: str, kind: str
) -> None:
    patience = SOON.get(exercise.id, SOONEST) if kind == "slow" else LATE
    check_one(session_of(exercise, patience), task, kind)


@pytest.mark.parametrize("exercise", CATALOG.exercises(), ids=lambda exercise: exercise.id)
def test_what_is_printed_and_plotted_costs_nothing(session_of: Any, exercise: Exercise) -> None:
    path = solution_path(CATALOG, exercise)
    source = broken(path.read_text("utf-8"), [task.id for task in exercise.task], HARMLESS)
    by_task = graded(session_of(exercise, LATE), source)
    assert all(check.status == "pass" for checks in by_task.values() for check in checks)
