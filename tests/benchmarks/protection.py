"""What protection costs: the same graders over the same submissions, in workers and in one bare process.

    python tests/benchmarks/protection.py [EXERCISE...] [--rounds N] [--diagnosis]

Both sides run in this process, in turn, submission by submission, so that a noisy machine disturbs both
alike. The CPU of the protected side includes the zygote and every worker. The third side is what a simple
autograder does: one `pytest` process per submission.

With --diagnosis the two sides are a protected grading with diagnoses and one without: the median over the
mutants of an exercise, each handed in again and again as one common mistake would be.
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parent)]
os.environ["OPENBLAS_NUM_THREADS"] = "1"  # as a grader has it: a second thread would spin beside the worker

from course.authoring.exercises.grading import (  # noqa: E402
    accepted_sources,
    mistakes_of,
    solution_path,
    source_of,
)
from course.catalog.load import Catalog  # noqa: E402
from course.isolation.levels import Deadline  # noqa: E402
from course.isolation.session import Connection  # noqa: E402
from course.scoring import kit  # noqa: E402
from course.scoring.judging.session import GradingSession, pinned_to  # noqa: E402
from course.scoring.judging.submission import Submission, Terms  # noqa: E402
from tests.benchmarks.calibration.seeds import Seeded  # noqa: E402

TICK = os.sysconf("SC_CLK_TCK")


def submissions(exercise: Any, catalog: Catalog) -> dict[str, bytes]:
    """The model solution, every accepted variant and every mutant of an exercise."""
    model = solution_path(catalog, exercise).read_bytes()
    wrong = mistakes_of(catalog, exercise).wrong
    mutants = {one.name: source_of(catalog, exercise, one) for one in wrong}
    return {"solution": model, **accepted_sources(catalog, exercise), **mutants}


def descendants_cpu(pid: int) -> float:
    """CPU seconds of the processes below ``pid``, those they have waited for included."""
    parents: dict[int, list[tuple[int, float]]] = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                fields = (entry / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            parents.setdefault(int(fields[1]), []).append(
                (int(entry.name), sum(map(int, fields[11:15])) / TICK)
            )
    total, left = 0.0, [pid]
    while left:
        for child, cpu in parents.get(left.pop(), []):
            total += cpu
            left.append(child)
    return total


def protection(exercise_id: str, rounds: int) -> None:
    """Interleave both sides over all submissions of an exercise; then what one worker and one call cost."""
    catalog = Catalog()
    exercise = catalog.exercise(exercise_id)
    work = submissions(exercise, catalog)
    guarded = GradingSession(exercise, catalog, scope="full", processor=0)
    bare = Seeded(exercise, catalog, scope="full", terms=Terms(level="L1"), processor=0)
    bare.here = True  # the same checks by the same pytest calls, the student's module loaded right here
    count = counted()
    for session in (guarded, bare):  # warm both
        session.grade(Submission({exercise.module: work["solution"]}))
    print(
        f"{exercise_id}: level {guarded.level}, {len(guarded.checks)} checks, {len(work)} submissions,"
        f" {rounds} rounds"
    )
    ratios, extra = [], []
    for number in range(rounds):
        count.update(dict.fromkeys(count, 0))
        cpu = {"guarded": -descendants_cpu(os.getpid()), "bare": 0.0}
        for source in work.values():
            handed_in = Submission({exercise.module: source})
            for name, session in (("guarded", guarded), ("bare", bare)):
                start = time.process_time()
                verdict = session.grade(handed_in)
                cpu[name] += time.process_time() - start
                assert verdict.state == "graded", (name, verdict.error)
        cpu["guarded"] += descendants_cpu(os.getpid())
        each = {name: value / len(work) * 1e3 for name, value in cpu.items()}
        ratios.append(each["guarded"] / each["bare"])
        guarded_ms, bare_ms = each["guarded"], each["bare"]
        allowed = (10.0 * count["workers"] + 0.040 * count["callbacks"]) / len(work)
        extra.append((guarded_ms - bare_ms) / allowed)
        print(
            f"  round {number}: CPU per submission {guarded_ms:.1f} ms protected, {bare_ms:.1f} ms bare,"
            f" ratio {ratios[-1]:.3f}, difference {guarded_ms - bare_ms:.1f} ms; allowed {allowed:.1f} ms"
            f" ({count['workers'] / len(work):.2f} workers, {count['calls'] / len(work):.0f} calls,"
            f" {count['callbacks'] / len(work):.0f} callbacks)"
        )
    print(
        f"  median ratio {statistics.median(ratios):.3f} (target 1.2 for integrators), difference"
        f" {statistics.median(extra):.2f} of 10 ms a worker and 40 us a callback (target 1)"
    )
    if exercise_id == "integrators":
        with pinned_to(guarded._processor):  # as in a session that grades
            worker_start(guarded, work["solution"], exercise.module)
            callbacks(guarded)
        per_pytest(guarded, exercise.module, work["solution"])
    guarded.close()
    bare.close()


def diagnosis(exercise_id: str, rounds: int) -> None:
    """What naming the mistake costs: each mutant ``rounds`` times with diagnoses and without, in turn."""
    catalog = Catalog()
    exercise = catalog.exercise(exercise_id)
    explained = kit._explained
    ratios = {}
    with GradingSession(exercise, catalog, scope="full", processor=0) as session:
        explainer = session._explainer
        for mutant in mistakes_of(catalog, exercise).wrong:
            source = source_of(catalog, exercise, mutant)
            handed_in, cpu = Submission({exercise.module: source}), [0.0, 0.0]
            for number in range(2 * rounds + 2):
                silent = number % 2
                session._explainer = None if silent else explainer
                kit._explained = (lambda _: (None, "")) if silent else explained
                start = time.process_time() + descendants_cpu(os.getpid())
                session.grade(handed_in)
                # The first of each side is not counted: what all students of a run share is made in it.
                if number > 1:
                    cpu[silent] += time.process_time() + descendants_cpu(os.getpid()) - start
            ratios[mutant.name] = cpu[0] / cpu[1]
    kit._explained = explained
    worst = sorted(ratios, key=ratios.__getitem__)[-5:]
    print(
        f"{exercise_id}: {len(ratios)} mistakes, {rounds} gradings each; with diagnosis over without: median"
        f" {statistics.median(ratios.values()):.3f} (target 1.1), most "
        + ", ".join(f"{name} {ratios[name]:.2f}" for name in reversed(worst))
    )


def counted() -> dict[str, int]:
    """How many workers were started, calls made and callbacks answered since the counts were last zero."""
    count = {"workers": 0, "calls": 0, "callbacks": 0}

    def count_calls(name: str, key: str) -> None:
        original = getattr(Connection, name)

        def counting(*args: Any, **kwargs: Any) -> Any:
            count[key] += 1
            return original(*args, **kwargs)

        setattr(Connection, name, counting)

    for name, key in (("_load", "workers"), ("_ask", "calls"), ("_answer_callback", "callbacks")):
        count_calls(name, key)
    return count


def worker_start(session: GradingSession, source: bytes, module: str) -> None:
    """From asking for a worker to the answer of its first call, the submission loaded."""
    times = []
    for _ in range(200):
        start = time.perf_counter()
        connection = Connection(session._spawner, {module: source}, module, Deadline(10))
        connection.call("observed_order", [0.1, 0.05], [0.01, 0.0025])
        times.append((time.perf_counter() - start) * 1e3)
        connection.close()
    print(f"worker start to first call: median {statistics.median(times):.1f} ms (target 12)")


def callbacks(session: GradingSession) -> None:
    """Calls of a function of the grader's with a time and two arrays of 3."""
    source = b"""
import numpy as np
def spin(f, n):
    q = np.ones(3)
    for i in range(n):
        f(0.1, q, q)
"""
    connection = Connection(session._spawner, {"m.py": source}, "m.py", Deadline(60))
    rates = []
    for _ in range(5):
        start = time.perf_counter()
        connection.call("spin", lambda _t, q, _v: -4.0 * q, 20_000)
        rates.append(20_000 / (time.perf_counter() - start))
    connection.close()
    print(
        f"callbacks: median {statistics.median(rates):,.0f} a second, best {max(rates):,.0f} (target 20,000)"
    )


def trivial() -> None:
    """The same comparison where the checks compute next to nothing: what the machinery itself costs."""
    root = Path(__file__).resolve().parents[1] / "fixtures" / "mini_course"
    os.environ["COURSE_CONTENT"] = str(root)
    catalog = Catalog()
    exercise = catalog.exercise("doubling")
    with GradingSession(exercise, catalog, scope="full", processor=0) as session:
        source = (root / "solutions" / "doubling" / exercise.module).read_bytes()
        per_pytest(session, exercise.module, source)
    del os.environ["COURSE_CONTENT"]


def per_pytest(session: GradingSession, module: str, source: bytes) -> None:
    """One `pytest` process per submission with the same checks, against the protected session."""
    driver = Path(__file__).with_name("one_pytest.py")
    ratios = []
    bare = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / module
        path.write_bytes(source)
        for _ in range(5):
            before = os.times()
            plain = ["-q", "-c", os.devnull, "-p", "no:cacheprovider", "--noconftest"]
            command = [sys.executable, "-m", "pytest", *plain, str(driver)]
            # Without the plugins that happen to be installed here: they are no part of grading.
            environment = {**bare, "COURSE_BENCH_SOURCE": str(path), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
            done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
            after = os.times()
            assert done.returncode == 0, done.stdout
            simple = (
                after.children_user + after.children_system - before.children_user - before.children_system
            )
            start = time.process_time() + descendants_cpu(os.getpid())
            for _ in range(20):
                session.grade(Submission({module: source}))
            guarded = (time.process_time() + descendants_cpu(os.getpid()) - start) / 20
            ratios.append(simple / guarded)
            print(f"pytest process {simple * 1e3:.0f} ms, protected {guarded * 1e3:.0f} ms: {ratios[-1]:.1f}")
    name, ratio = session.exercise.id, statistics.median(ratios)
    print(f"{name}: {ratio:.1f} times less than a pytest process each (target 9)")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("exercise", nargs="*", default=["integrators"])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--diagnosis", action="store_true")
    options = parser.parse_args()
    for chosen in options.exercise:
        (diagnosis if options.diagnosis else protection)(chosen, options.rounds)
    if "integrators" in options.exercise and not options.diagnosis:
        trivial()
