"""Nothing that a student's wheel ships answers an exercise.

Every Python file of every exercise is handed in, with the tasks' names bound to what it holds: by name, as a
table's key, and to whatever has a matching signature. What it imports of the course is not there, as for any
submission; files of the same exercise find each other. In a grading run each of them scores nothing, and
so does a program that looks the fixed inputs of the public checks up in the table that is shipped.
"""

import ast
import itertools
import types
from collections import defaultdict
from pathlib import Path

import pytest

from course.catalog.load import Catalog
from course.scoring import kit
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission, Terms

CATALOG = Catalog()
pytestmark = pytest.mark.usefixtures("sandboxes")

HEAD = '''\
import math
import types

import numpy as np


class Nothing:
    """What an import of the course's is replaced by: anything, and no help."""

    def __init__(self, *args, **names):
        pass

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return Nothing()

    def __call__(self, *args, **names):
        return args[0] if len(args) == 1 and callable(args[0]) else Nothing()

    def __iter__(self):
        return iter(())


class Kit(Nothing):
    def companion(self, exercise, name):
        return loaded(name)

    def sibling(self, file, name):
        return loaded(name)

    def reference(self, exercise, name):
        return None

    def as_number(self, value, *_):
        return float(value)

    def as_vector(self, value, *_):
        return np.asarray(value, dtype=float)


MODULES = {}


def loaded(name):
    if name not in MODULES:
        MODULES[name] = module = types.ModuleType(name)
        module.__dict__.update(Nothing=Nothing, Kit=Kit)
        try:
            exec(FILES[name], module.__dict__)
        except Exception:
            pass
    return MODULES[name]
'''


class Stripped(ast.NodeTransformer):
    """Imports of the course's become ``Nothing``, ``kit`` a helper that finds files of the same exercise."""

    def visit_ImportFrom(self, node):
        return None if node.module == "__future__" else self._stripped(node, [node.module or ""])

    def visit_Import(self, node):
        return self._stripped(node, [name.name for name in node.names])

    def _stripped(self, node, modules):
        if not {module.split(".")[0] for module in modules} & {"course", "pytest", "pymunk"}:
            return node
        text = "\n".join(
            f"{name.asname or name.name.split('.')[0]} = {'Kit' if name.name == 'kit' else 'Nothing'}()"
            for name in node.names
        )
        return ast.parse(text).body


def shipped(exercise):
    """The Python files of an exercise, but for the stub."""
    files = exercise.readme_path.parent.glob("*.py")
    return sorted(path for path in files if path.name != exercise.module)


def handed_in(exercise):
    """The files of an exercise in one module, ``FILES`` by name."""
    future = "from __future__ import annotations\n"
    files = {
        path.stem: future + ast.unparse(Stripped().visit(ast.parse(path.read_text("utf-8"))))
        for path in shipped(exercise)
    }
    # Annotations are left to text, so that types of the course's need not be there.
    return f"{HEAD}\nFILES = {files!r}\n"


FOUND = '''

def parameters(function):
    code = getattr(function, "__code__", None)
    return code.co_varnames[: code.co_argcount] if code else ()


def candidates(name, wanted, module, how):
    """What a module holds that may be meant for a task: named like it, or of its signature."""
    yield from named(name, module) if how == "named" else fitting(wanted, module)


def named(name, module):
    held = vars(loaded(module))
    yield from (value for key, value in sorted(held.items()) if callable(value) and key.strip("_") == name)
    for _, table in sorted(held.items()):
        if isinstance(table, dict) and name in table:
            yield from functions(table[name])


def fitting(wanted, module):
    held = vars(loaded(module))
    for _, value in sorted(held.items()):
        owners = [value, *vars(value).values()] if isinstance(value, type) else [value]
        for one in owners:
            given = tuple(p for p in parameters(one) if p != "self")
            if given == wanted or (len(given) == len(wanted) and len(wanted) > 1):
                yield one
        if isinstance(value, types.FunctionType) and len(parameters(value)) == len(value.__defaults__ or ()):
            try:
                made = value()  # a family: the defaults may be the right ones
            except Exception:
                continue
            yield from functions(made)


def functions(value, depth=3):
    if callable(value):
        yield value
    elif isinstance(value, (list, tuple)) and depth:
        for item in value:
            yield from functions(item, depth - 1)


def nth(name, wanted, module, how, number):
    for index, candidate in enumerate(candidates(name, wanted, module, how)):
        if index == number:
            return candidate
    return None

'''


def submission(exercise, module, how, number):
    """The module of an exercise with each task bound to the ``number``-th thing of a file meant for it."""
    lines = [handed_in(exercise), FOUND]
    for task in exercise.task:
        wanted = tuple(_parameters(exercise, task.id))
        lines.append(f"_chosen = nth({task.id!r}, {wanted!r}, {module!r}, {how!r}, {number})")
        # A name of its own, so that the grader finds a function; a missing one fails like any.
        lines.append(f"{task.id} = _chosen or (lambda *args, **names: None)")
    return "\n".join(lines)


def _parameters(exercise, task):
    tree = ast.parse(exercise.stub_path.read_text("utf-8"))
    node = next(node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == task)
    return [arg.arg for arg in node.args.args]


#: More things of one file than this that may be meant for one task are not tried.
MOST = 40


def winners(session, how):
    """The files that score, and the checks that passed with them.

    A task's checks are run where the choice is one that the task has not had: files load each other, so that
    most of what one holds another one holds, too.
    """
    exercise = session.exercise
    tried = defaultdict(dict)
    for path in shipped(exercise):
        namespace = {"__name__": "handed_in"}
        exec(compile(submission(exercise, path.stem, how, 0), "handed_in", "exec"), namespace)
        new = defaultdict(set)
        for task in exercise.task:
            held = namespace["candidates"](task.id, tuple(_parameters(exercise, task.id)), path.stem, how)
            for number, candidate in enumerate(itertools.islice(held, MOST)):
                same = _known_by(candidate)
                if same not in tried[task.id]:
                    tried[task.id][same] = candidate  # kept, or another one might get its id
                    new[number].add(task.id)
        for number, tasks in sorted(new.items()):
            source = submission(exercise, path.stem, how, number)
            only = [check.id for check in session.checks if check.task in tasks]
            verdict = session.grade(Submission({exercise.module: source.encode()}), only=only)
            if verdict.score > 0:
                yield path.name, [check.id for check in verdict.checks if check.points > 0]


def _known_by(candidate):
    """What two things that do the same have in common; a number of its own where that cannot be told."""
    if not isinstance(candidate, types.FunctionType):
        return id(candidate)
    enclosed = [repr(cell.cell_contents) for cell in candidate.__closure__ or ()]
    with_it = repr((candidate.__defaults__, enclosed))
    return id(candidate) if " at 0x" in with_it else (candidate.__code__, with_it)


#: What fits a task by its signature alone is two hundred things, and takes minutes.
HOW = ["named", pytest.param("fitting", marks=pytest.mark.soak)]


@pytest.mark.parametrize("how", HOW)
@pytest.mark.parametrize("exercise", CATALOG.exercises(), ids=lambda exercise: exercise.id)
def test_no_shipped_file_scores_a_point(exercise, how):
    with GradingSession(exercise, CATALOG, scope="full", terms=Terms(timeout=20.0)) as session:
        assert list(winners(session, how)) == []


@pytest.mark.parametrize("how", HOW)
def test_no_shipped_file_of_a_warm_up_passes_one_of_its_checks(how):
    found, kinds = {}, {".py", ".toml", ".md", ".json", ""}
    for warm_up in CATALOG.warm_ups():
        assert {path.suffix for path in Path(warm_up.folder).iterdir()} <= kinds
        with GradingSession(warm_up, CATALOG, scope="full", terms=Terms(timeout=20.0)) as session:
            found[warm_up.id] = list(winners(session, how))
    assert not any(found.values()), found


def test_the_shipped_answers_to_fixed_inputs_score_nothing_in_a_grading_run():
    exercise, questions = CATALOG.exercise("collisions"), kit.companion("collisions", "questions")
    known = defaultdict(dict)
    for check, task in questions.TASKS.items():
        if not task.startswith("simulate"):
            answers = zip(questions.FIXED[check], kit.known_answers(exercise.id, check), strict=True)
            known[task] |= {repr(args): repr(answer) for args, answer in answers}
    source = f"from numpy import array, inf, nan\nKNOWN = {dict(known)!r}\n"
    for task in known:
        source += f"def {task}(*args):\n    return eval(KNOWN[{task!r}].get(repr(args), 'None'))\n"
    handed_in = Submission({exercise.module: source.encode()})
    with GradingSession(exercise, CATALOG, scope="public", terms=Terms(timeout=20.0)) as home:
        assert home.grade(handed_in).score > 0, "the table is what public checks expect"
    with GradingSession(exercise, CATALOG, scope="full", terms=Terms(timeout=20.0, seed=7)) as run:
        assert run.grade(handed_in).score == 0
