"""Full marks under every seed: gradings of the model solution and of each accepted variant, in workers.

    python tests/benchmarks/calibration/seeds.py EXERCISE... [--seeds 1000] [--accepted 200] [--first 1]

Each seed is a grading run of its own, with its own hidden draws; everything else is what `course grade run`
does. A grading that is not full marks is printed with the check, the seed and the finding, and the exit code
is 1. CPU a submission is printed too, the worker's included.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "benchmarks")]

from protection import descendants_cpu  # noqa: E402

from course.authoring.variants import accepted_files, compose, solution_path  # noqa: E402
from course.catalog.load import Catalog  # noqa: E402
from course.grading.session import GradingSession, Submission  # noqa: E402
from course.grading.verdict import Status  # noqa: E402


def grade_all(exercise_id: str, seeds: int, accepted: int, first: int) -> int:
    """Grade under many seeds; how many gradings were not full marks."""
    catalog = Catalog()
    exercise = catalog.exercise(exercise_id)
    solution = solution_path(catalog, exercise)
    sources = {solution.name: (solution.read_bytes(), seeds)}
    for path in accepted_files(catalog, exercise):
        sources[f"accepted/{path.name}"] = (compose(solution, path), accepted)
    wrong = 0
    with GradingSession(exercise, catalog, scope="full") as session:
        for name, (source, count) in sources.items():
            submission = Submission({exercise.module: source})
            short, start = 0, time.process_time() + descendants_cpu(os.getpid())
            for seed in range(first, first + count):
                session._seed = seed  # a session keeps one seed for a whole run; here each grading is a run
                verdict = session.grade(submission)
                if not verdict.all_pass:
                    short += 1
                    bad = [check for check in verdict.checks if check.status is not Status.PASS]
                    for check in bad[:3]:
                        print(f"  {name} seed {seed}: {check.id} {check.status}: {check.message}")
                    if not bad:
                        print(f"  {name} seed {seed}: {verdict.state}: {verdict.error}")
            cpu = (time.process_time() + descendants_cpu(os.getpid()) - start) / max(count, 1)
            print(
                f"{exercise_id} {name}: {count - short} of {count} full marks, {cpu:.2f} s CPU each",
                flush=True,
            )
            wrong += short
    return wrong


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("exercise", nargs="+")
    parser.add_argument("--seeds", type=int, default=1000, help="for the model solution")
    parser.add_argument("--accepted", type=int, default=200, help="for each accepted variant")
    parser.add_argument("--first", type=int, default=1, help="the first seed")
    options = parser.parse_args()
    wrong = [grade_all(name, options.seeds, options.accepted, options.first) for name in options.exercise]
    return int(any(wrong))


if __name__ == "__main__":
    sys.exit(main())
