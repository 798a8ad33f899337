"""Full marks under every seed: gradings of the model solution and of each accepted variant, in workers.

    python tests/benchmarks/calibration/seeds.py EXERCISE... [--seeds 1000] [--accepted 200] [--own]
        [--variant NAME]

Each seed is a grading run of its own, with its own hidden draws; everything else is what `course grade run`
does. A grading that is not full marks is printed with the check, the seed and the finding, and the exit code
is 1. CPU a submission is printed too, the worker's included. With --own an accepted variant is put through
the checks of the tasks it does in its own way; all else in it is the model solution's code.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "benchmarks")]

from protection import descendants_cpu  # noqa: E402

from course.authoring.exercises.variants import accepted_files, compose, solution_path  # noqa: E402
from course.catalog.load import Catalog  # noqa: E402
from course.scoring.session import GradingSession, Submission  # noqa: E402
from course.scoring.terms import Terms  # noqa: E402
from course.scoring.verdict import Status  # noqa: E402

if TYPE_CHECKING:
    from course.catalog.models import Exercise
    from course.scoring.verdict import Verdict


def grade_all(
    exercise_id: str, seeds: int, accepted: int, first: int, *, own: bool, variants: list[str]
) -> int:
    """Grade under many seeds; how many gradings were not full marks."""
    catalog = Catalog()
    exercise = catalog.exercise(exercise_id)
    solution = solution_path(catalog, exercise)
    sources = {solution.name: (solution.read_bytes(), seeds)}
    paths = [path for path in accepted_files(catalog, exercise) if not variants or path.stem in variants]
    for path in paths:
        sources[f"accepted/{path.name}"] = (compose(solution, path), accepted)
    wrong = 0
    # What is asked is whether the answer is right: a machine that does other work too must not cost a mark.
    with GradingSession(exercise, catalog, scope="full", terms=Terms(timeout=60.0)) as session:
        for name, (source, count) in sources.items():
            submission = Submission({exercise.module: source})
            only: list[str | None] = [None]
            if own and name.startswith("accepted/"):
                tasks = _tasks_of(solution.parent / name, solution, exercise)
                own_checks = [check.id for check in session.checks if check.task in tasks]
                # Each is a grading with a worker of its own: many of them cost more than the whole.
                only = own_checks if 4 * len(own_checks) < len(session.checks) else only
            short, start = 0, time.process_time() + descendants_cpu(os.getpid())
            for seed in range(first, first + count):
                session._seed = seed  # a session keeps one seed for a whole run; here each grading is a run
                verdicts = [session.grade(submission, only=[check]) for check in only]
                full = [_is_full(verdict, f"{name} seed {seed}") for verdict in verdicts]
                short += not all(full)
            cpu = (time.process_time() + descendants_cpu(os.getpid()) - start) / max(count, 1)
            scope = "" if only == [None] else f" on {len(only)} checks"
            print(
                f"{exercise_id} {name}: {count - short} of {count} full marks{scope}, {cpu:.2f} s CPU each",
                flush=True,
            )
            wrong += short
    return wrong


def _is_full(verdict: Verdict, label: str) -> bool:
    """Whether it is full marks; what is not is printed."""
    if verdict.all_pass:
        return True
    bad = [check for check in verdict.checks if check.status is not Status.PASS]
    for check in bad[:3]:
        print(f"  {label}: {check.id} {check.status}: {check.message}", flush=True)
    if not bad:
        print(f"  {label}: {verdict.state}: {verdict.error}", flush=True)
    return False


def _tasks_of(path: Path, solution: Path, exercise: Exercise) -> set[str]:
    """Tasks that a variant does in its own way; all, if it changes another function of the solution."""
    tasks = {task.id for task in exercise.task}
    names = set(re.findall(r"^(?:def )?(\w+)(?:\(| = )", path.read_text(), re.M))
    others = set(re.findall(r"^def (\w+)\(", solution.read_text(), re.M)) - tasks
    return tasks if names & others else names & tasks


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("exercise", nargs="+")
    parser.add_argument("--seeds", type=int, default=1000, help="for the model solution")
    parser.add_argument("--accepted", type=int, default=200, help="for each accepted variant")
    parser.add_argument("--first", type=int, default=1, help="the first seed")
    parser.add_argument("--own", action="store_true", help="variants: only the tasks they do differently")
    parser.add_argument("--variant", action="append", default=[], help="only this one; repeatable")
    options = parser.parse_args()
    counts = options.seeds, options.accepted, options.first
    wrong = [grade_all(name, *counts, own=options.own, variants=options.variant) for name in options.exercise]
    return int(any(wrong))


if __name__ == "__main__":
    sys.exit(main())
