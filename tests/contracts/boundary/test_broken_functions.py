"""One function of a right solution is broken, or its results are spoilt: nothing else comes to harm by it.

Every task of every exercise, through the real boundary. Broken is a function that gives a value of the wrong
type, shape or kind, raises, is not there, never answers, exits, takes all memory, prints without end, or
plots: a finding helps, and all else is scored, for the rest of the solution keeps a copy of its own of it.

Spoilt are right results, in thirty ways and more, in one part or another, always, only for infinite
arguments, or from the third call on. Whatever a function returns, its checks end in pass, fail or the
student's own error, and in a verdict that can be written down.
"""

import ast
from contextlib import ExitStack
from functools import cache

import msgspec
import pytest

from course.authoring.exercises.grading import solution_path
from course.catalog.load import Catalog
from course.scoring.judging.outcomes import NOT_JUDGED
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission, Terms

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
FUTURE = "from __future__ import annotations\n"
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

    def __init__(self, name):
        self.name = name

    def visit_FunctionDef(self, node):
        given = [*node.args.args, *node.args.kwonlyargs, *node.args.posonlyargs]
        if node.name == self.name:
            node.name = f"own_{self.name}"
        return node if any(one.arg == self.name for one in given) else self.generic_visit(node)

    def visit_Name(self, node):
        if node.id == self.name:
            node.id = f"own_{self.name}"
        return node


def broken(source, names, way):
    """The solution with functions replaced, and its own copies for the rest of it."""
    tree, replaced = ast.parse(source), ""
    for name in names:
        tree = Renamed(name).visit(tree)
        replaced += f"{name} = own_{name}\n{way.format(name=name)}\n"
    return f"{FUTURE}{HEAD}{ast.unparse(tree).replace(FUTURE.strip(), '')}\n{replaced}{PLOTS_AT_THE_END}"


@pytest.fixture(scope="module")
def session_of():
    with ExitStack() as stack:

        @cache
        def session(exercise, timeout):
            terms = Terms(timeout=timeout)
            return stack.enter_context(GradingSession(exercise, CATALOG, scope="full", terms=terms))

        yield session


def graded(session, source):
    """The results, by task."""
    verdict = session.grade(Submission({session.exercise.module: source.encode()}))
    assert verdict.state == "graded", verdict.error
    by_task = {}
    for check in verdict.checks:
        by_task.setdefault(check.task, []).append(check)
    return by_task


def check_one(session, task, kind):
    path = solution_path(CATALOG, session.exercise)
    by_task = graded(session, broken(path.read_text("utf-8"), [task], WAYS[kind]))
    lost = [check for check in by_task[task] if check.status != "pass"]
    assert lost, f"{task} {kind}: no check of it fails"
    for check in lost:
        assert check.message, check.id
        assert check.help, check.id
        assert check.diagnosis != NOT_JUDGED, check.traceback
    assert kind in NUMBERS or any(check.diagnosis for check in lost), f"{task} {kind}: no mistake is named"
    others = [check for name, checks in by_task.items() if name != task for check in checks]
    fallen = [(check.id, str(check.status), check.message) for check in others if check.status != "pass"]
    assert not fallen, f"{task} {kind} takes others with it"


def cases():
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
def test_a_broken_function_costs_its_own_task_only(session_of, exercise, task, kind):
    patience = SOON.get(exercise.id, SOONEST) if kind == "slow" else LATE
    check_one(session_of(exercise, patience), task, kind)


@pytest.mark.parametrize("exercise", CATALOG.exercises(), ids=lambda exercise: exercise.id)
def test_what_is_printed_and_plotted_costs_nothing(session_of, exercise):
    path = solution_path(CATALOG, exercise)
    source = broken(path.read_text("utf-8"), [task.id for task in exercise.task], HARMLESS)
    by_task = graded(session_of(exercise, LATE), source)
    assert all(check.status == "pass" for checks in by_task.values() for check in checks)


# -- spoilt ---------------------------------------------------------------------------------------------

#: What becomes of a value, or of a part of it; ``x`` is the right one.
SPOILT = {
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

SPOIL = '''\
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


def spoilt(source, name, way, part, time):
    """A solution one of whose functions gives spoilt results."""
    wrapped = REPLACED.format(name=name, way=SPOILT[way], part=part, time=time)
    return f"{FUTURE}import numpy as np\n{SPOIL}{source.replace(FUTURE, '')}\n{wrapped}"


def plans():
    """Every way, with the parts and times it can make a difference in."""
    every = [(way, part, "always") for way in SPOILT for part in PARTS]
    return every + [
        (way, "whole", time) for way in ("nan", "inf", "none", "text", "huge") for time in TIMES[1:]
    ]


def verdicts(session, task, plan):
    """Of the checks of a task, on a solution spoilt there."""
    source = spoilt(solution_path(CATALOG, session.exercise).read_text("utf-8"), task, *plan)
    checks = [check.id for check in session.checks if check.task == task]
    # What counts calls is loaded anew for each check, so that each of them sees the spoilt ones.
    for only in [[check] for check in checks] if plan[2] == "later" else [checks]:
        yield session.grade(Submission({session.exercise.module: source.encode()}), only=only)


def spoilt_cases():
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


@pytest.mark.parametrize(("exercise", "task", "chosen"), list(spoilt_cases()))
def test_no_spoilt_result_ends_in_a_fault_of_the_grader(session_of, exercise, task, chosen):
    session, faults = session_of(exercise, LATE), []
    for plan in chosen:
        for verdict in verdicts(session, task, plan):
            msgspec.msgpack.encode(verdict)  # as it leaves the grader's process
            broke = [
                f"{check.id}: {check.traceback}" for check in verdict.checks if check.diagnosis == NOT_JUDGED
            ]
            if verdict.state == "grader_error" or broke:
                faults.append((*plan, verdict.error or broke))
    assert not faults
