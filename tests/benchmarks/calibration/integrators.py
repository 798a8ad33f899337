"""How far correct solutions stay inside each tolerance of ``integrators``, and how far wrong ones overshoot.

    python tests/benchmarks/calibration/integrators.py [--seeds 200] [--mutant-seeds 20] > integrators.md

Every comparison a check makes is recorded as the share of its tolerance that was used: below 1 passes. For
each check the table gives the largest share that any correct solution used over all seeds, and the smallest
that a mutant used which that check must catch. A second table has the raw slopes behind the order checks.
A correct variant is run through the checks of the tasks it redefines.
"""

from __future__ import annotations

import argparse
import re
import sys
import tomllib
from collections import defaultdict
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "benchmarks")]

import local_run  # noqa: E402

from course.grading import kit  # noqa: E402
from course.grading.marching import march_errors  # noqa: E402
from course.physics.invariants import convergence_order  # noqa: E402

EXERCISE = "integrators"


class Recorder:
    """Stands in for the kit's comparisons and notes how much of each tolerance is used."""

    def __init__(self) -> None:
        self.share = 0.0
        self.slopes: dict[tuple[str, str], list[float]] = defaultdict(list)
        self.errors: dict[str, list[float]] = defaultdict(list)
        self._close, self._array, self._order = kit.expect_close, kit.expect_array, kit.expect_order
        kit.expect_close, kit.expect_array, kit.expect_order = self.close, self.array, self.order
        kit.march_errors, kit.march_all_errors = self.march, self.march_all

    def note(self, used: float) -> None:
        self.share = max(self.share, used if np.isfinite(used) else np.inf)

    def close(self, actual, expected, **rest):
        if np.isfinite(expected) and isinstance(actual, int | float | np.floating):
            allowed = rest.get("abs", 0.0) + rest.get("rel", 0.0) * abs(expected)
            self.note(abs(actual - expected) / (allowed or 1.0))
        self._close(actual, expected, **rest)

    def array(self, actual, expected, **rest):
        wanted = np.asarray(expected, dtype=float)
        if np.shape(actual) == wanted.shape:
            off = np.max(np.abs(np.asarray(actual, float) - wanted), initial=0.0)
            self.note(
                off / (rest.get("abs", 0.0) + rest.get("rel", 0.0) * np.max(np.abs(wanted), initial=0.0))
            )
        self._array(actual, expected, **rest)

    def order(self, hs, errors, order, **rest):
        if np.all(np.isfinite(errors)) and np.all(errors > 0):
            self.note(abs(convergence_order(hs, errors) - order) / rest["abs"])
        self._order(hs, errors, order, **rest)

    def march(self, submission, step, problem, counts):
        hs, errors = march_errors(submission, step, problem, counts)
        if np.all(np.isfinite(errors)) and np.all(errors > 0):
            self.slopes[step, problem.name].append(convergence_order(hs, errors))
            self.errors[step].extend(errors)
        return hs, errors

    def march_all(self, submission, step, problems, counts):
        return [self.march(submission, step, problem, counts) for problem in problems]


def redefined(path: Path) -> set[str]:
    """Names that a variant defines anew."""
    return set(re.findall(r"^(?:def )?(\w+)(?:\(| = )", path.read_text(), re.M))


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--mutant-seeds", type=int, default=20)
    options = parser.parse_args()
    recorder = Recorder()
    checks = local_run.load_checks(EXERCISE)
    sources = local_run.sources(EXERCISE)
    used: dict[str, float] = defaultdict(float)
    failures = 0
    variants = {"solution": None} | {
        n: redefined(ROOT / "solutions" / EXERCISE / n) for n in sources if "accepted" in n
    }
    for name, tasks in variants.items():
        mine = [check for check in checks if tasks is None or check.task in tasks]
        for seed in range(options.seeds):
            for check in mine:
                recorder.share = 0.0
                (result,) = local_run.run(sources[name], [check], seed)
                failures += result.status != "pass"
                used[check.id] = max(used[check.id], recorder.share)
    slopes, errors = dict(recorder.slopes), dict(recorder.errors)
    recorder.slopes, recorder.errors = defaultdict(list), defaultdict(list)
    caught: dict[str, float] = {}
    failed_by: dict[str, int] = defaultdict(int)
    mutants = tomllib.loads((ROOT / "solutions" / EXERCISE / "mutants.toml").read_text())["mutant"]
    for mutant in mutants:
        check = next(c for c in checks if c.id == mutant["check"])
        for seed in range(options.mutant_seeds):
            recorder.share = 0.0
            (result,) = local_run.run(sources["mutants/" + mutant["file"]], [check], seed)
            failures += result.status == "pass" or result.finding.diagnosis != mutant["diagnosis"]
            caught[check.id] = min(caught.get(check.id, np.inf), recorder.share or np.inf)
        for result in local_run.run(sources["mutants/" + mutant["file"]], checks, 0):
            failed_by[result.check.id] += result.status != "pass"
    tables = used, caught, failed_by, slopes, errors
    print(report(options, len(variants), len(mutants), failures, checks, *tables))


def report(options, variants, mutants, failures, checks, used, caught, failed_by, slopes, errors) -> str:
    """The tables, as Markdown."""
    lines = [
        "# Calibration of `integrators`",
        "",
        f"{variants} correct solutions over {options.seeds} seeds, {mutants} mutants over "
        f"{options.mutant_seeds}; verdicts that are not as declared: {failures}. Written by "
        "`tests/benchmarks/calibration/integrators.py`.",
        "",
        "Share of the tolerance used: below 1 passes, a dash was decided without a number. `its mutants` "
        "are those that name the check; `fail it` counts all that do.",
        "",
        "| check | points | correct, at most | its mutants, at least | fail it |",
        "|---|---|---|---|---|",
    ]
    for check in checks:
        low = caught.get(check.id)
        wrong = "" if low is None else "-" if not np.isfinite(low) else f"{low:.3g}"
        lines.append(
            f"| {check.id} | {check.points} | {used[check.id]:.2g} | {wrong} | {failed_by[check.id]} |"
        )
    lines += ["", "Slopes of correct solutions, by problem.", ""]
    lines += ["| step | problem | least | most | n |", "|---|---|---|---|---|"]
    for (step, problem), values in sorted(slopes.items()):
        lines.append(f"| {step} | {problem} | {min(values):.3f} | {max(values):.3f} | {len(values)} |")
    lines += ["", "Errors behind these slopes.", "", "| step | least | most |", "|---|---|---|"]
    lines += [
        f"| {step} | {min(values):.1e} | {max(values):.1e} |" for step, values in sorted(errors.items())
    ]
    return "\n".join(lines)


if __name__ == "__main__":
    main()
