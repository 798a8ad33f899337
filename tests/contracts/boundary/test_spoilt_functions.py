"""Checks are total: whatever a function returns, its checks end in pass, fail or the student's own error.

Every function of every exercise, its right results spoilt in thirty ways and more, in one part or another,
always, only for infinite arguments, or from the third call on. None may end in a fault of the grader, nor
in a verdict that cannot be written down.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from typing import Any

import msgspec
import pytest

from course.authoring.exercises.grading import solution_path
from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission, Terms
from course.scoring.verdict import Verdict

CATALOG = Catalog()

#: What becomes of a value, or of a part of it; ``x`` is the right one.
WAYS = {
    "nan": "numbers(x, np.nan)",
    "inf": "numbers(x, np.inf)",
    "minus_inf": "numbers(x, -np.inf)",
    "huge": "numbers(x, 1e300)",
    "largest": "numbers(x, 1.7e308)",
    "tiny": "numbers(x, 5e-324)",
    "zero": "numbers(x, 0.0)",
    "whole_zero": "numbers(x, 0)",
    "negative": "scaled(x, -1.0)",
    "scaled_up": "scaled(x, 1e200)",
    "scaled_down": "scaled(x, 1e-200)",
    "twice": "scaled(x, 2.0)",
    "huge_whole": "numbers(x, 10**30)",
    "sixty_fourth_bit": "numbers(x, 2**63)",
    "none": "None",
    "numbers_none": "numbers(x, None)",
    "empty": "[]",
    "empty_dict": "{}",
    "empty_text": "''",
    "ragged": "[[1.0, 2.0], [3.0], 4.0]",
    "reversed": "turned(x)",
    "one_short": "x[:-1] if hasattr(x, '__len__') and not isinstance(x, dict) else []",
    "one_more": "longer(x)",
    "nested": "[x]",
    "deeply_nested": "[[[[[x]]]]]",
    "column": "np.reshape(np.asarray(x, dtype=float), (-1, 1)) if numeric(x) else [x]",
    "no_dimension": "np.float64(7.0) if numeric(x) else np.array(3)",
    "complex": "numbers(x, 1j)",
    "text": "'seven'",
    "numbers_text": "numbers(x, 'seven')",
    "true": "True",
    "numbers_true": "numbers(x, True)",
    "dict": "{'value': x}",
    "single": "np.asarray(x, dtype=np.float32) if numeric(x) else x",
    "unsigned": "numbers(x, np.uint64(2**64 - 1))",
}
PARTS = ("whole", "first", "last")
TIMES = ("always", "infinite", "later")

HEAD = '''\
import numpy as np

def numeric(x):
    try:
        return np.asarray(x).dtype.kind in "fiub"
    except ValueError:
        return False

def mapped(x, change):
    """The value with every number changed; True and False are not numbers here."""
    if isinstance(x, dict):
        return {key: mapped(item, change) for key, item in x.items()}
    if isinstance(x, (list, tuple)):
        return type(x)(mapped(item, change) for item in x)
    if isinstance(x, np.ndarray) and x.dtype.kind in "fiu":
        made = [change(item) for item in x.ravel().tolist()]
        try:
            array = np.array(made).reshape(x.shape)
        except (ValueError, OverflowError):
            return made
        return array if array.dtype.kind in "fiubc" else made
    if isinstance(x, (int, float, np.number)) and not isinstance(x, bool):
        return change(x)
    return x

def numbers(x, bad):
    return mapped(x, lambda _: bad)

def scaled(x, factor):
    return mapped(x, lambda item: float(item) * factor)

def turned(x):
    if isinstance(x, dict):
        return dict(reversed(list(x.items())))
    return x[::-1] if hasattr(x, "__len__") else [x]

def longer(x):
    if isinstance(x, dict):
        return {**x, "more": 1.0}
    if isinstance(x, np.ndarray):
        return np.concatenate([x, x[-1:]]) if x.ndim and len(x) else np.array([1.0, 2.0])
    return [*x, x[-1]] if isinstance(x, (list, tuple)) and len(x) else [x, x]

def part_of(x, part, spoil):
    sized = isinstance(x, (list, tuple, dict)) or isinstance(x, np.ndarray) and x.ndim > 0
    if part == "whole" or not sized or not len(x):
        return spoil(x)
    if isinstance(x, dict):
        key = list(x)[0 if part == "first" else -1]
        return {**x, key: spoil(x[key])}
    items = list(x)
    at = 0 if part == "first" else -1
    items[at] = spoil(items[at])
    return items

def has_infinity(args):
    for arg in args:
        try:
            if np.isinf(np.asarray(arg, dtype=float)).any():
                return True
        except (TypeError, ValueError):
            pass
    return False

'''
REPLACED = """
_right_{name}, _calls_{name} = {name}, [0]

def {name}(*args, **names):
    x = _right_{name}(*args, **names)
    _calls_{name}[0] += 1
    due = {{"always": True, "infinite": has_infinity(args), "later": _calls_{name}[0] > 2}}[{time!r}]
    return part_of(x, {part!r}, lambda x: {way}) if due else x
"""


def spoilt(source: str, name: str, way: str, part: str, time: str) -> str:
    """A solution one of whose functions gives spoilt results; the others use it as before."""
    tree = ast.parse(source)
    future = [node for node in tree.body if isinstance(node, ast.ImportFrom) and node.module == "__future__"]
    tree.body = [node for node in tree.body if node not in future]
    head = "from __future__ import annotations\n" if future else ""
    return (
        f"{head}{HEAD}{ast.unparse(tree)}\n{REPLACED.format(name=name, way=WAYS[way], part=part, time=time)}"
    )


def plans() -> list[tuple[str, str, str]]:
    """Every way, with the parts and times it can make a difference in."""
    every = [(way, part, "always") for way in WAYS for part in PARTS]
    return every + [
        (way, "whole", time) for way in ("nan", "inf", "none", "text", "huge") for time in TIMES[1:]
    ]


@pytest.fixture(scope="module")
def session_of() -> Iterator[Any]:
    opened: list[GradingSession] = []

    @cache
    def session(exercise: Exercise) -> GradingSession:
        opened.append(GradingSession(exercise, CATALOG, scope="full", terms=Terms(timeout=60.0)))
        return opened[-1]

    yield session
    for one in opened:
        one.close()


def verdicts(session: GradingSession, task: str, plan: tuple[str, str, str]) -> Iterator[Verdict]:
    """Of the checks of a task, on a solution spoilt there."""
    source = spoilt(solution_path(CATALOG, session.exercise).read_text("utf-8"), task, *plan)
    checks = [check.id for check in session.checks if check.task == task]
    # What counts calls is loaded anew for each check, so that each of them sees the spoilt ones.
    for only in [[check] for check in checks] if plan[2] == "later" else [checks]:
        yield session.grade(Submission({session.exercise.module: source.encode()}), only=only)


def cases() -> Iterator[Any]:
    """Every task with every plan under soak; in an ordinary run each plan once, each in another task."""
    every = plans()
    tasks = [(exercise, task.id) for exercise in CATALOG.exercises() for task in exercise.task]
    for number, (exercise, task) in enumerate(tasks):
        some = every[number :: len(tasks)]
        yield pytest.param(exercise, task, some, id=f"{exercise.id}-{task}-some")
        yield pytest.param(exercise, task, every, id=f"{exercise.id}-{task}-all", marks=pytest.mark.soak)
    for warm_up in CATALOG.warm_ups():
        for one in warm_up.task:
            name = f"warm-up-{warm_up.id}-{one.id}-all"
            yield pytest.param(warm_up, one.id, every, id=name, marks=pytest.mark.soak)


@pytest.mark.parametrize(("exercise", "task", "chosen"), list(cases()))
def test_no_spoilt_result_ends_in_a_fault_of_the_grader(
    session_of: Any, exercise: Exercise, task: str, chosen: list[tuple[str, str, str]]
) -> None:
    session, faults = session_of(exercise), []
    for plan in chosen:
        for verdict in verdicts(session, task, plan):
            msgspec.msgpack.encode(verdict)  # as it leaves the grader's process
            if verdict.state == "grader_error":
                faults.append((*plan, verdict.error))
    assert not faults


def test_there_are_at_least_three_thousand_spoilt_solutions() -> None:
    tasks = sum(len(exercise.task) for exercise in CATALOG.exercises())
    assert len(WAYS) >= 30
    assert len(plans()) * tasks >= 3000
