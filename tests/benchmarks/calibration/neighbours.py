"""One edit away from right: what small changes to right programs are told.

    python tests/benchmarks/calibration/neighbours.py EXERCISE... [--each 200] [--seed 0] [--out FOLDER]

For each task, edits are drawn from all that can be made to the model solution and to the accepted variants:
an operator, a comparison, a number, a name, an argument, a sign, an index, a statement left out. Each program
is graded as in a grading run, in this process. Printed are, for each task, how many no check fails (most
compute the same), how many are told a mistake, how many only what is wrong with the result, how many raise.
With --out, every program that does not just raise goes into a file of its exercise, with its edit and with
what it is told, to be read: no program can say whether a mistake is the one made, or whether what no check
fails is right.
"""

import argparse
import ast
import copy
import difflib
import random
import resource
import signal
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT)]

from course.authoring.exercises.grading import accepted_files, compose, solution_path  # noqa: E402
from course.catalog.load import Catalog  # noqa: E402
from course.catalog.models import Exercise  # noqa: E402
from course.scoring.checks.collected import words  # noqa: E402
from course.scoring.judging.submission import Submission, Terms  # noqa: E402
from course.scoring.verdict import CheckResult, Status  # noqa: E402
from tests.benchmarks.calibration.seeds import Seeded  # noqa: E402

#: CPU seconds and bytes after which an edited program is given up: a loop may have lost its end.
_PATIENCE, _MEMORY = 10, 6 * 2**30

_OPERATORS = {
    ast.Add: (ast.Sub,),
    ast.Sub: (ast.Add,),
    ast.Mult: (ast.Div,),
    ast.Div: (ast.Mult,),
    ast.Pow: (ast.Mult,),
    ast.FloorDiv: (ast.Div,),
    ast.Mod: (ast.FloorDiv,),
    ast.MatMult: (ast.Mult,),
    ast.Lt: (ast.LtE, ast.Gt),
    ast.LtE: (ast.Lt, ast.GtE),
    ast.Gt: (ast.GtE, ast.Lt),
    ast.GtE: (ast.Gt, ast.LtE),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
    ast.And: (ast.Or,),
    ast.Or: (ast.And,),
}
_SISTERS = (
    ("min", "max"),
    ("minimum", "maximum"),
    ("sin", "cos"),
    ("floor", "ceil"),
    ("mean", "sum"),
    ("mean", "median"),
    ("any", "all"),
    ("zeros", "ones"),
    ("log", "log10"),
    ("argmin", "argmax"),
    ("append", "extend"),
)


class Neighbour(NamedTuple):
    """A right program with one edit: which, of what, and the lines that differ."""

    task: str
    origin: str
    source: str
    difference: str


class _GivenUpError(BaseException):
    """An edited program takes too long."""


def neighbours(exercise: Exercise, catalog: Catalog, task: str, each: int, seed: int) -> Iterator[Neighbour]:
    """Edits of right programs, drawn from one style after the other."""
    solution = solution_path(catalog, exercise)
    sources = {solution.name: solution.read_bytes()}
    for path in accepted_files(catalog, exercise):
        sources[f"accepted/{path.name}"] = compose(solution, path)
    others = frozenset(each.id for each in exercise.task) - {task}
    styles: dict[str, Iterator[str]] = {}
    for name, source in sources.items():
        tree = ast.parse(source)
        places = list(_places(tree, task, others))
        random.Random(f"{seed} {name} {task}").shuffle(places)
        styles[name] = _edited(tree, places)
    known = {ast.unparse(ast.parse(source)) for source in sources.values()}
    right = len(known)
    while styles:
        for name in list(styles):
            text = next(styles[name], None)
            if text is None:
                del styles[name]
            elif text not in known:
                known.add(text)
                before = ast.unparse(ast.parse(sources[name])).splitlines()
                lines = list(difflib.unified_diff(before, text.splitlines(), n=2, lineterm=""))
                yield Neighbour(task, name, text, "\n".join(lines[2:]))
                if len(known) == right + each:
                    return


def _places(tree: ast.Module, task: str, others: frozenset[str]) -> Iterator[tuple[int, int, int]]:
    """Where an edit can be made for a task: which statement of the module, which node of it, which edit."""
    # The last binding of a name counts: a variant's stands after the solution's.
    bodies: dict[str, int] = {}
    for i, node in enumerate(tree.body):
        targets = node.targets if isinstance(node, ast.Assign) else ()
        names = [getattr(node, "name", ""), *(each.id for each in targets if isinstance(each, ast.Name))]
        bodies |= dict.fromkeys(filter(None, names), i)
    mine, todo = set(), [task] if task in bodies else []
    while todo:
        name = todo.pop()
        if name not in mine:
            mine.add(name)
            used = {node.id for node in ast.walk(tree.body[bodies[name]]) if isinstance(node, ast.Name)}
            todo += used & set(bodies) - others
    for name in sorted(mine):
        statement = tree.body[bodies[name]]
        arguments = _arguments(statement)
        for place, node in enumerate(ast.walk(statement)):
            for which, _ in enumerate(_edits(node, arguments)):
                yield bodies[name], place, which


def _edited(tree: ast.Module, places: list[tuple[int, int, int]]) -> Iterator[str]:
    """Texts of the module with the edit of each of these places."""
    for where, place, which in places:
        changed = copy.copy(tree)
        statement = copy.deepcopy(tree.body[where])
        changed.body = [*tree.body[:where], statement, *tree.body[where + 1 :]]
        node = list(ast.walk(statement))[place]
        list(_edits(node, _arguments(statement)))[which](node)
        try:
            text = ast.unparse(ast.fix_missing_locations(changed))
            compile(text, "edited", "exec")
        except (SyntaxError, ValueError, TypeError, AttributeError):
            continue
        yield text


def _arguments(statement: ast.stmt) -> list[str]:
    return [node.arg for node in ast.walk(statement) if isinstance(node, ast.arg)]


def _edits(node: ast.AST, arguments: list[str]) -> Iterator[Callable[[Any], None]]:
    """What can be done to a node, as functions of its copy."""
    yield from _operators(node)
    yield from _statements(node)
    if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
        value = node.value
        others = {not value} if isinstance(value, bool) else {value + 1, value - 1, value * 2, value / 2}
        for other in sorted(others - {value}):
            yield lambda n, other=other: setattr(n, "value", other)
    elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load) and node.id in arguments:
        for other in sorted({*arguments} - {node.id}):
            yield lambda n, other=other: setattr(n, "id", other)
    elif isinstance(node, ast.Call) and node.args:
        yield lambda n: _become(n, n.args[0])
        if len(node.args) > 1:
            yield lambda n: n.args.__setitem__(slice(0, 2), n.args[1::-1])
        field = "attr" if isinstance(node.func, ast.Attribute) else "id"
        for one, other in (*_SISTERS, *(pair[::-1] for pair in _SISTERS)):
            if getattr(node.func, field, "") == one:
                yield lambda n, field=field, other=other: setattr(n.func, field, other)


def _operators(node: ast.AST) -> Iterator[Callable[[Any], None]]:
    if isinstance(node, ast.BinOp | ast.AugAssign | ast.BoolOp):
        for kind in _OPERATORS.get(type(node.op), ()):
            yield lambda n, kind=kind: setattr(n, "op", kind())
    if isinstance(node, ast.BinOp):
        for kept in ("left", "right"):
            yield lambda n, kept=kept: _become(n, getattr(n, kept))
        if isinstance(node.op, ast.Sub | ast.Div):
            yield lambda n: n.__dict__.update(left=n.right, right=n.left)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        yield lambda n: _become(n, n.operand)
    elif isinstance(node, ast.Compare):
        for kind in _OPERATORS.get(type(node.ops[0]), ()):
            yield lambda n, kind=kind: n.ops.__setitem__(0, kind())


def _statements(node: ast.AST) -> Iterator[Callable[[Any], None]]:
    for field in ("body", "orelse"):
        body = getattr(node, field, None)
        for i, statement in enumerate(body if isinstance(body, list) else ()):
            if isinstance(statement, ast.Assign | ast.AugAssign | ast.If | ast.Raise):
                yield lambda n, field=field, i=i: getattr(n, field).__setitem__(i, ast.Pass())


def _become(node: ast.AST, other: ast.AST) -> None:
    """Make a node another one, in place."""
    kind, fields = type(other), dict(other.__dict__)
    node.__class__ = kind
    node.__dict__.clear()
    node.__dict__.update(fields)


def tried(exercise: Exercise, session: Seeded, program: Neighbour) -> list[CheckResult] | None:
    """The checks that a program fails; None if it had to be given up."""

    late = []

    def give_up(*_: object) -> None:
        late.append(True)
        raise _GivenUpError

    checks = [check.id for check in session.checks if check.task == program.task]
    signal.signal(signal.SIGPROF, give_up)
    # Again and again: a probe may have caught the first.
    signal.setitimer(signal.ITIMER_PROF, _PATIENCE, 1.0)
    try:
        submission = Submission({exercise.module: program.source.encode()})
        verdict = session.grade(submission, only=checks)
    except (_GivenUpError, MemoryError, RecursionError):
        return None
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    if late:
        return None
    return [check for check in verdict.checks if check.status not in {Status.PASS, Status.SKIP}]


def fate(exercise: Exercise, failed: list[CheckResult] | None) -> str:
    """Where a program is counted."""
    if failed is None:
        return "given up"
    if not failed:
        return "no check fails"
    own = words(exercise.id)
    if any(check.diagnosis and own.kind(check.diagnosis) == "cause" for check in failed):
        return "a mistake"
    return "raises" if all(check.status is Status.ERROR for check in failed) else "what is wrong"


def report(program: Neighbour, failed: list[CheckResult]) -> str:
    """One program, for a reader."""
    told: dict[tuple[str, str], list[str]] = {}
    for check in failed:
        told.setdefault((check.diagnosis or "-", check.help), []).append(check.message)
    lines = [
        f"- [{code}] {' ... '.join(dict.fromkeys(said))} | ADVICE: {advice}"
        for (code, advice), said in told.items()
    ]
    return "\n".join([f"```diff\n{program.difference}\n```", *lines, ""])


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("exercise", nargs="+")
    parser.add_argument("--each", type=int, default=200, help="programs for each task")
    parser.add_argument("--seed", type=int, default=0, help="draws the edits")
    parser.add_argument("--task", action="append", default=[], help="only this one; repeatable")
    parser.add_argument("--out", type=Path, help="a folder for what the programs are told")
    options = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    catalog = Catalog()
    for name in options.exercise:
        exercise, pages = catalog.exercise(name), []
        with Seeded(exercise, catalog, scope="full", terms=Terms(timeout=60.0)) as session:
            session.here = True
            for task in [task.id for task in exercise.task if task.id in options.task or not options.task]:
                counts: Counter[str] = Counter()
                for number, program in enumerate(
                    neighbours(exercise, catalog, task, options.each, options.seed)
                ):
                    failed = tried(exercise, session, program)
                    kind = fate(exercise, failed)
                    counts[kind] += 1
                    if kind not in {"raises", "given up"}:
                        pages.append(
                            f"## {task} {number} ({kind}; {program.origin})\n{report(program, failed or [])}"
                        )
                print(name, task, ", ".join(f"{kind} {n}" for kind, n in counts.most_common()), flush=True)
        if options.out:
            options.out.mkdir(parents=True, exist_ok=True)
            (options.out / f"{name}.md").write_text("\n".join(pages), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
