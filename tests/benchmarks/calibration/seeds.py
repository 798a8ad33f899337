"""Full marks, and every mutant caught, under every seed: gradings in workers.

    python tests/benchmarks/calibration/seeds.py EXERCISE... [--seeds 1000] [--accepted 200] [--mutants 0]
        [--first 1] [--own] [--variant NAME] [--log FILE]

Each seed is a grading run of its own, with its own hidden draws; everything else is what `course grade run`
does. A grading of the model solution or of an accepted variant has to give full marks; one of a mutant what
mutants.toml says: points of its task only, by the check and with the diagnosis it names. What is not so is
printed with the seed, and the exit code is 1. CPU a submission is printed too, the worker's included. With
--own an accepted variant is put through the checks of the tasks it does in its own way; all else in it is the
model solution's code. With --log what is done is noted in a file, and a run with the same file goes on there.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "benchmarks")]

from protection import descendants_cpu  # noqa: E402

from course.authoring.exercises.mutants import judge, mutant_path  # noqa: E402
from course.authoring.exercises.variants import accepted_files, compose, solution_path  # noqa: E402
from course.catalog.load import Catalog  # noqa: E402
from course.scoring.judging.session import GradingSession, Submission  # noqa: E402
from course.scoring.judging.terms import Terms  # noqa: E402
from course.scoring.verdict import Status  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from course.catalog.models import Exercise
    from course.scoring.verdict import Verdict

    Faults = Callable[[Verdict], list[str]]


class Log:
    """What is done: of each program the exercise, name, first seed, number of gradings, and of wrong ones."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        lines = path.read_text(encoding="utf-8").splitlines() if path and path.is_file() else []
        self._done = {tuple(key): wrong for *key, wrong in map(json.loads, lines)}

    def done(self, *key: Any) -> int | None:
        return self._done.get(key)

    def note(self, *key: Any, wrong: int) -> None:
        if self._path:
            with self._path.open("a", encoding="utf-8") as file:
                file.write(json.dumps([*key, wrong]) + "\n")


def grade_all(exercise: Exercise, catalog: Catalog, options: argparse.Namespace) -> int:
    """Grade under many seeds; how many gradings were not as they should be."""
    log, wrong = Log(options.log), 0
    # What is asked is whether the answer is right: a machine that does other work too must not cost a mark.
    with GradingSession(exercise, catalog, scope="full", terms=Terms(timeout=60.0)) as session:
        for name, source, count, faults in programs(exercise, catalog, options):
            key = exercise.id, name, options.first, count
            known = log.done(*key)
            if known is not None:
                wrong += known
                continue
            checks = _own_checks(catalog, exercise, name, session) if options.own else []
            short, cpu = _grade(
                session, Submission({exercise.module: source}), checks, options.first, count, name, faults
            )
            what = "caught as declared" if name.startswith("mutants/") else "full marks"
            scope = f" on {len(checks)} checks" if checks else ""
            print(
                f"{exercise.id} {name}: {count - short} of {count} {what}{scope}, {cpu:.2f} s CPU each",
                flush=True,
            )
            log.note(*key, wrong=short)
            wrong += short
    return wrong


def programs(
    exercise: Exercise, catalog: Catalog, options: argparse.Namespace
) -> Iterator[tuple[str, bytes, int, Faults]]:
    """Name, source, number of seeds, and what is wrong with a verdict, of each program."""
    solution = solution_path(catalog, exercise)
    if options.seeds:
        yield solution.name, solution.read_bytes(), options.seeds, _short_of_full
    for path in accepted_files(catalog, exercise) if options.accepted else ():
        if not options.variant or path.stem in options.variant:
            yield f"accepted/{path.name}", compose(solution, path), options.accepted, _short_of_full
    for mutant in catalog.mutants(exercise) if options.mutants else ():
        if not options.variant or Path(mutant.file).stem in options.variant:
            source = compose(solution, mutant_path(catalog, exercise, mutant))
            told = lambda verdict, mutant=mutant: [fault.message for fault in judge(mutant, verdict)]  # noqa: E731
            yield f"mutants/{mutant.file}", source, options.mutants, told


def _grade(
    session: GradingSession,
    submission: Submission,
    checks: list[str],
    first: int,
    count: int,
    name: str,
    faults: Faults,
) -> tuple[int, float]:
    """How many gradings were not as they should be, and CPU seconds of one."""
    short, start = 0, time.process_time() + descendants_cpu(os.getpid())
    for seed in range(first, first + count):
        session._seed = seed  # a session keeps one seed for a whole run; here each grading is a run
        verdicts = [session.grade(submission, only=[check]) for check in checks] or [
            session.grade(submission)
        ]
        found = [fault for verdict in verdicts for fault in faults(verdict)]
        for fault in found[:3]:
            print(f"  {name} seed {seed}: {fault}", flush=True)
        short += bool(found)
    return short, (time.process_time() + descendants_cpu(os.getpid()) - start) / max(count, 1)


def _short_of_full(verdict: Verdict) -> list[str]:
    """What keeps a verdict from full marks."""
    if verdict.all_pass:
        return []
    bad = [check for check in verdict.checks if check.status is not Status.PASS]
    return [f"{check.id} {check.status}: {check.message}" for check in bad] or [
        f"{verdict.state}: {verdict.error}"
    ]


def _own_checks(catalog: Catalog, exercise: Exercise, name: str, session: GradingSession) -> list[str]:
    """Checks of the tasks that a variant does in its own way; none if that is nearly all of them."""
    if not name.startswith("accepted/"):
        return []
    solution = solution_path(catalog, exercise)
    tasks = {task.id for task in exercise.task}
    names = set(re.findall(r"^(?:def )?(\w+)(?:\(| = )", (solution.parent / name).read_text(), re.M))
    others = set(re.findall(r"^def (\w+)\(", solution.read_text(), re.M)) - tasks
    # One that changes another function of the solution may do every task in its own way.
    own = tasks if names & others else names & tasks
    checks = [check.id for check in session.checks if check.task in own]
    # Each is a grading with a worker of its own: many of them cost more than the whole.
    return checks if 4 * len(checks) < len(session.checks) else []


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("exercise", nargs="+")
    parser.add_argument("--seeds", type=int, default=1000, help="for the model solution")
    parser.add_argument("--accepted", type=int, default=200, help="for each accepted variant")
    parser.add_argument("--mutants", type=int, default=0, help="for each mutant")
    parser.add_argument("--first", type=int, default=1, help="the first seed")
    parser.add_argument("--own", action="store_true", help="variants: only the tasks they do differently")
    parser.add_argument("--variant", action="append", default=[], help="only this one; repeatable")
    parser.add_argument("--log", type=Path, help="note what is done here, and leave out what is noted")
    options = parser.parse_args()
    catalog = Catalog()
    wrong = [grade_all(catalog.exercise(name), catalog, options) for name in options.exercise]
    return int(any(wrong))


if __name__ == "__main__":
    sys.exit(main())
