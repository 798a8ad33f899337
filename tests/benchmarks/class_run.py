"""A whole class in one run: how much of it is writing, what two graders bring, whether memory stays flat,
what a cluster on this machine costs, and how fast ``grade rerun --dry-run`` is beside the run.

    python tests/benchmarks/class_run.py                          all five, on the miniature course
    python tests/benchmarks/class_run.py --only rerun --submissions 10000 --rounds 1
    python tests/benchmarks/class_run.py --only memory --submissions 10000
    python tests/benchmarks/class_run.py --only cluster --workers 2
    python tests/benchmarks/class_run.py --exercise integrators   on the real one

Every figure is a ratio within one run of this script. ``jobs`` and ``cluster`` need processors that nothing
else uses: two, and as many as there are workers.
"""

import argparse
import importlib.util
import os
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from course.authoring.exercises.grading import mistakes_of, solution_path, source_of  # noqa: E402
from course.catalog.load import Catalog  # noqa: E402
from course.grading.cluster.connect import local_cluster  # noqa: E402
from course.grading.running.batch import grade_all  # noqa: E402
from course.grading.running.folder import open_results  # noqa: E402
from course.grading.running.rerun import RerunOptions, rerun  # noqa: E402
from course.grading.running.run import GradeAll, RunOptions, Summary, grade_class  # noqa: E402
from tests.journeys.processes import below, resident  # noqa: E402

MINI = ROOT / "tests" / "fixtures" / "mini_course"


def make_class(folder: Path, catalog: Catalog, exercise: str, students: int) -> None:
    """A class in which every file is another one: the model solution, a third of it with a mistake."""
    known = catalog.exercise(exercise)
    model = solution_path(catalog, known).read_bytes()
    mutants = [source_of(catalog, known, one) for one in mistakes_of(catalog, known).wrong]
    for number in range(students):
        place = folder / f"student-{number:05}"
        place.mkdir(parents=True)
        source = mutants[number // 3 % len(mutants)] if number % 3 == 0 and mutants else model
        (place / known.module).write_bytes(source + b"\n# %d\n" % number)


def run(
    folder: Path,
    catalog: Catalog,
    exercise: str,
    jobs: int,
    seen: Callable[[int], None],
    grade: GradeAll | None = None,
) -> tuple[Path, Summary]:
    """One run into a folder of its own, beside the class and removed with it; that folder, and its outcome.

    Removing it before the next run would slow that one down: a file system is loath to use again what was
    given up seconds ago, and making a file takes ten times as long meanwhile.
    """
    count = 0

    def report(*_: object) -> None:
        nonlocal count
        count += 1
        seen(count)

    out = Path(tempfile.mkdtemp(prefix="run-", dir=folder.parent)) / "out"
    options = RunOptions(exercises=(exercise,), seed=1)
    grade = grade or partial(grade_all, graders=jobs)
    summary = grade_class(folder, out, catalog, options, report, grade=grade)
    assert summary.exit_code == 0, summary.troubled[:3]
    return out, summary


def write_share(folder: Path, catalog: Catalog, options: argparse.Namespace) -> None:
    _, summary = run(folder, catalog, options.exercise, 1, lambda _: None)
    graded = summary.states["graded"]
    print(
        f"write: {summary.write_s / summary.elapsed_s:.2%} of the time (target: under 2 %); "
        f"{1e3 * summary.write_s / graded:.3f} ms of {1e3 * summary.elapsed_s / graded:.1f} ms a submission"
    )


def jobs_ratio(folder: Path, catalog: Catalog, options: argparse.Namespace) -> None:
    """Each way three times, taking turns; the best of each, which is the least disturbed."""
    times: dict[int, list[float]] = {1: [], 2: []}
    for _ in range(3):
        for jobs, seconds in times.items():
            _, summary = run(folder, catalog, options.exercise, jobs, lambda _: None)
            seconds.append(summary.elapsed_s)
    best = {jobs: min(seconds) for jobs, seconds in times.items()}
    print(
        f"jobs: -j 2 is {best[1] / best[2]:.2f} times -j 1 (target: at least 1.8), "
        f"on {os.cpu_count()} processors"
    )


def memory(folder: Path, catalog: Catalog, options: argparse.Namespace) -> None:
    """Resident memory of the grader and of this process, over the first and the last tenth of the class."""
    samples: list[tuple[int, int, int]] = []

    def seen(count: int) -> None:
        if count % 20 == 0:
            mine = below(os.getpid())
            graders = [pid for pid, (_, line) in mine.items() if "course.grading.running.grader" in line]
            samples.append((count, sum(map(resident, graders)), resident(os.getpid())))

    run(folder, catalog, options.exercise, 1, seen)
    students, tenth = options.submissions, options.submissions // 10
    for name, column in (("grader", 1), ("coordinator", 2)):
        # The very first hundred submissions fill caches that then stay.
        first = statistics.median(row[column] for row in samples if 100 <= row[0] <= tenth)
        last = statistics.median(row[column] for row in samples if row[0] > students - tenth)
        print(
            f"memory: {name} {first / 2**20:.1f} MB in the first {tenth}, {last / 2**20:.1f} MB in the last: "
            f"{last / first - 1:+.1%} (target: within 5 %)"
        )


class Cost(NamedTuple):
    """What a run took.

    Attributes:
        whole_s: wall seconds, the start of graders or of the cluster included.
        graded_s: of these, from the first tenth of the results to the last of them.
    """

    whole_s: float
    graded_s: float


def cost(grading: Callable[[Callable[[int], None]], None], students: int) -> Cost:
    """Time a run that says by its argument how many results there are."""
    at: list[float] = []
    started = time.monotonic()
    grading(lambda _: at.append(time.monotonic()))
    whole = time.monotonic() - started
    return Cost(whole, at[-1] - at[students // 10])


def cluster_ratio(folder: Path, catalog: Catalog, options: argparse.Namespace) -> None:
    """``-j N`` and a cluster of N on this machine, three times each, taking turns; the best of each."""
    missing = [name for name in ("distributed", "cryptography") if importlib.util.find_spec(name) is None]
    if missing:
        print(f"cluster: not measured, {' and '.join(missing)} not installed (the extra `cluster`)")
        return
    workers = options.workers

    def processes(seen: Callable[[int], None]) -> None:
        run(folder, catalog, options.exercise, workers, seen)

    def dask(seen: Callable[[int], None]) -> None:
        with local_cluster(workers) as grade:
            run(folder, catalog, options.exercise, 1, seen, grade)

    costs = [[cost(way, options.submissions) for way in (processes, dask)] for _ in range(3)]
    ours, theirs = (Cost(*map(min, *each)) for each in zip(*costs, strict=True))
    print(
        f"cluster: {workers} workers take {theirs.graded_s / ours.graded_s:.2f} times as long as -j {workers}"
        f" (target: at most 1.10); {theirs.whole_s / ours.whole_s:.2f} with what starting takes; on"
        f" {os.cpu_count()} processors"
    )


def rerun_ratio(folder: Path, catalog: Catalog, options: argparse.Namespace) -> None:
    """A run, and ``rerun --dry-run --all`` over what it wrote, taking turns; the best of each.

    Both start graders, grade everything and end; the run writes besides, and makes the reports.
    """
    costs: dict[str, list[float]] = {"run": [], "rerun": []}
    jobs = options.workers
    grade = partial(grade_all, graders=jobs)
    for _ in range(options.rounds):
        out, summary = run(folder, catalog, options.exercise, jobs, lambda _: None)
        costs["run"].append(summary.elapsed_s)
        began = time.monotonic()
        with open_results(out) as results:
            done = rerun(results, catalog, RerunOptions(dry_run=True, everything=True), grade=grade)
        costs["rerun"].append(time.monotonic() - began)
        assert (done.regraded, done.changes) == (summary.states["graded"], ()), "the same, and none changed"
        print(
            f"rerun: {done.regraded} with -j {jobs}: run {costs['run'][-1]:.1f} s, {costs['rerun'][-1]:.1f} s"
        )
    ratio = min(costs["rerun"]) / min(costs["run"])
    print(f"rerun: takes {ratio:.2f} times as long as the run (target: at most 1), best of {options.rounds}")


KINDS = {
    "write": write_share,
    "jobs": jobs_ratio,
    "memory": memory,
    "cluster": cluster_ratio,
    "rerun": rerun_ratio,
}


def main() -> None:
    parser = argparse.ArgumentParser(description="A whole class in one run.")
    parser.add_argument("--only", choices=KINDS, action="append")
    parser.add_argument("--exercise", default="doubling")
    parser.add_argument("--submissions", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2, help="of the cluster, and graders beside it")
    parser.add_argument("--rounds", type=int, default=3, help="of run and rerun")
    arguments = parser.parse_args()
    if arguments.exercise in {path.name for path in (MINI / "exercises").iterdir()}:
        os.environ["COURSE_CONTENT"] = str(MINI)
    # The workers of a cluster are told by this where the course is.
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    catalog = Catalog()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "class"
        make_class(folder, catalog, arguments.exercise, arguments.submissions)
        print(f"{arguments.submissions} submissions of {arguments.exercise}")
        for kind, measure in KINDS.items():
            if kind in (arguments.only or KINDS):
                measure(folder, catalog, arguments)


if __name__ == "__main__":
    main()
