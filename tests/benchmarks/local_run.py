"""Run the checks of an exercise on its stub, solution, accepted variants and mutants, in this process.

    python tests/benchmarks/local_run.py integrators [--seeds N] [--only NAME] [--see]

Without a sandbox, so only for code of our own: it is for writing and calibrating checks.
"""

from __future__ import annotations

import argparse
import importlib.util
import inspect
import sys
import time
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "benchmarks")]


from course.authoring.exercises.grading import (  # noqa: E402
    LocalSubmission,
    accepted_sources,
    mistakes_of,
    solution_path,
)
from course.authoring.exercises.proofs import caught_by  # noqa: E402
from course.authoring.mistakes import Variant  # noqa: E402
from course.catalog.load import Catalog  # noqa: E402
from course.scoring import kit  # noqa: E402
from course.scoring.explain.story import read_table  # noqa: E402
from course.scoring.failures import finding_of  # noqa: E402
from course.scoring.judging.explaining import Explainer  # noqa: E402
from course.scoring.judging.outcomes import found  # noqa: E402
from course.scoring.verdict import CheckResult, Status, Visibility  # noqa: E402

CATALOG = Catalog()


@dataclass
class Check:
    exercise: str
    id: str
    title: str
    task: str
    points: float
    hidden: bool
    fn: Any

    @property
    def visibility(self) -> Visibility:
        return Visibility.HIDDEN if self.hidden else Visibility.PUBLIC


@dataclass
class Result:
    check: Check
    status: str
    finding: CheckResult | None


def load_checks(exercise: str) -> list[Check]:
    """Public checks, then hidden ones, in the order they are written in."""
    files = [
        (ROOT / "exercises" / exercise / "checks.py", False),
        (ROOT / "tests/graders" / exercise / "checks.py", True),
    ]
    checks = []
    for path, hidden in files:
        if not path.is_file():
            continue
        spec = importlib.util.spec_from_file_location(f"{exercise}_{'hidden' if hidden else 'public'}", path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        for name, fn in vars(module).items():
            if name.startswith("test_"):
                marks = {mark.name: mark.args[0] for mark in fn.pytestmark}
                title = (fn.__doc__ or "").splitlines()[0]
                checks.append(Check(exercise, name[5:], title, marks["task"], marks["points"], hidden, fn))
    return checks


def run(source: str, checks: list[Check], seed: int) -> list[Result]:
    """Run every check on one copy of the module, as in a grading run: inputs drawn, failures explained."""
    submission = LocalSubmission(source, seed)
    told: dict[str, CheckResult] = {}
    status, failed = dict.fromkeys((check.id for check in checks), "pass"), {}
    for check in checks:
        drawn = {name: _generator(check, seed) for name in {"rng", "draw"} & _asked(check)}
        try:
            check.fn(submission=submission, **drawn)
        except kit.CheckFailed as failure:
            status[check.id], failed[check.id] = "fail", failure
            told[check.id] = found(check, Status.FAIL, failure.finding, 0.0)
        except kit.StudentFailure as failure:
            status[check.id] = failure.kind
            told[check.id] = found(check, Status.ERROR, finding_of(failure), 0.0)
    if failed:
        table = read_table(ROOT / "exercises" / checks[0].exercise)
        questions = kit.companion(checks[0].exercise, "questions")
        assert table is not None
        Explainer(table, questions).explain(told, failed, submission, source.encode())
    return [Result(check, status[check.id], told.get(check.id)) for check in checks]


def _asked(check: Check) -> set[str]:
    return set(inspect.signature(check.fn).parameters)


def _generator(check: Check, seed: int) -> np.random.Generator:
    return np.random.default_rng([seed, zlib.crc32(f"test_{check.id}".encode())])


def sources(exercise: str) -> dict[str, str]:
    """Everything there is to run: kind/name to source text."""
    declared = CATALOG.exercise(exercise)
    solution = solution_path(CATALOG, declared)
    model = solution.read_text()
    found = {"stub": declared.stub_path.read_text(), "solution": model}
    for name, source in accepted_sources(CATALOG, declared).items():
        found[f"accepted/{name}"] = source.decode()
    for name, mutant in wrong(exercise).items():
        found[name] = mutant.composed(model, solution)
    return found


def wrong(exercise: str) -> dict[str, Variant]:
    """The wrong programs of an exercise, by name."""
    return {f"mutants/{one.name}": one for one in mistakes_of(CATALOG, CATALOG.exercise(exercise)).wrong}


def caught(exercise: str) -> dict[str, str]:
    """Which check is on record for catching each of them."""
    return {
        f"mutants/{name}": check for name, check in caught_by(CATALOG, CATALOG.exercise(exercise)).items()
    }


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("exercise")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--only", default="")
    parser.add_argument("--see", action="store_true", help="print what the student would see")
    options = parser.parse_args()
    checks = load_checks(options.exercise)
    total = sum(check.points for check in checks)
    print(f"{len(checks)} checks, {total} points ({sum(c.points for c in checks if not c.hidden)} public)")
    mutants, by = wrong(options.exercise), caught(options.exercise)
    faults = 0
    for name, source in sources(options.exercise).items():
        if options.only in name:
            mutant = (mutants[name], by.get(name, "")) if name in mutants else None
            faults += _report(name, source, checks, options, total, mutant)
    print("all as declared" if not faults else f"{faults} NOT as declared")
    return bool(faults)


def _report(
    name: str,
    source: str,
    checks: list[Check],
    options: Any,
    total: float,
    mutant: tuple[Variant, str] | None,
) -> int:
    start = time.process_time()
    faults: dict[str, int] = {}
    seen: dict[str, Result] = {}
    scores = []
    for seed in range(options.first, options.first + options.seeds):
        results = run(source, checks, seed)
        scores.append(sum(r.check.points for r in results if r.status == "pass"))
        for result in results:
            if result.status != "pass":
                seen.setdefault(result.check.id, result)
        for fault in _faults(name, results, mutant):
            faults[fault] = faults.get(fault, 0) + 1
    cpu = (time.process_time() - start) / options.seeds
    print(
        f"{name:48s} {min(scores):5.0f}..{max(scores):3.0f} of {total:.0f}  {1000 * cpu:6.0f} ms"
        f"{'  WRONG: ' + str(faults) if faults else ''}"
    )
    for result in seen.values() if name != "stub" else ():
        finding = result.finding
        where = finding.first_divergence
        print(
            f"    {result.check.id:36s} {result.status:8s} {finding.diagnosis}"
            f"{f'  left at t={where.t:.3g} {where.quantity}' if where else ''}"
        )
        if options.see:
            hidden = "hidden" if result.check.hidden else "public"
            print(f"      [{hidden}] {result.check.title}\n      {finding.message}\n      -> {finding.help}")
            if not result.check.hidden:
                print(
                    f"      input {finding.input}\n      expected {finding.expected} actual {finding.actual} "
                    f"{finding.units} tolerance {finding.tolerance} {finding.first_divergence}"
                )
    return bool(faults)


def _faults(name: str, results: list[Result], mutant: tuple[Variant, str] | None) -> list[str]:
    """What is not as it is declared to be."""
    failed = {r.check.id: r for r in results if r.status != "pass"}
    if name == "stub":
        return [f"{r.check.id} passes" for r in results if r.status == "pass"]
    if mutant is None:
        return [f"{check} fails" for check in failed]
    program, check = mutant
    faults = [
        f"loses {r.check.id} of {r.check.task}" for r in failed.values() if r.check.task != program.task
    ]
    found = failed.get(check)
    if found is None:
        faults.append(f"not caught by {check}")
    elif found.finding.diagnosis != program.code:
        faults.append(f"diagnosed {found.finding.diagnosis}")
    return faults


if __name__ == "__main__":
    sys.exit(main())
