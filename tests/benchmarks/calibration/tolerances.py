"""How much of each tolerance correct solutions use, and by how much wrong ones overshoot, for any exercise.

    python tests/benchmarks/calibration/tolerances.py EXERCISE [--seeds 200] [--mutant-seeds 20] > EXERCISE.md

Every comparison a check makes is recorded as the share of its tolerance that was used: below 1 passes. For
each check the table gives the largest share that any correct solution used over all seeds, and the smallest
that a mutant used which that check must catch. A second table has the raw values of whatever was compared
with bounds; of `integrators` also the slopes behind the order checks and their errors, of
`engine-comparison` what the hidden engines are like: how far their truths lie apart is what the tolerances
must keep apart. What is graded is what ``seeds.py`` grades.
"""

import argparse
import math
import sys
from collections import Counter, defaultdict
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT)]

from course.authoring.exercises.proofs import caught_by  # noqa: E402
from course.catalog.load import Catalog  # noqa: E402
from course.physics.invariants import convergence_order  # noqa: E402
from course.scoring import kit  # noqa: E402
from course.scoring.judging.submission import Terms  # noqa: E402
from tests.benchmarks.calibration.seeds import Seeded, grade_one, programs  # noqa: E402


class Recorder:
    """Stands in for the kit's comparisons and notes how much of each tolerance is used.

    Attributes:
        share: the largest share since it was last set to 0.
        bounded: the values that were compared with bounds, by quantity.
    """

    def __init__(self) -> None:
        self.share = 0.0
        self.bounded: dict[str, list[float]] = defaultdict(list)
        self._close, self._array, self._bounded = kit.expect_close, kit.expect_array, kit.expect_bounded
        kit.expect_close, kit.expect_array, kit.expect_bounded = self.close, self.array, self.between
        self._order, self._marched = kit.expect_order, kit.march_all_errors
        kit.expect_order, kit.march_errors, kit.march_all_errors = self.order, self.march, self.march_all

    def note(self, used: float) -> None:
        """One comparison used this share of its tolerance."""
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
            scale = np.max(np.abs(wanted), initial=0.0)
            self.note(off / (rest.get("abs", 0.0) + rest.get("rel", 0.0) * scale))
        self._array(actual, expected, **rest)

    def between(self, actual, *, low=-np.inf, high=np.inf, **rest):
        if isinstance(actual, int | float | np.floating):
            self.bounded[rest["quantity"]].append(float(actual))
            if np.isfinite(low) and np.isfinite(high):
                self.note(abs(actual - (low + high) / 2) / ((high - low) / 2))
            elif high > 0:
                self.note(actual / high if np.isfinite(high) else low / actual)
        self._bounded(actual, low=low, high=high, **rest)

    def order(self, hs, errors, order, **rest):
        if np.all(np.isfinite(errors)) and np.all(errors > 0):
            self.note(abs(convergence_order(hs, errors) - order) / rest["abs"])
        self._order(hs, errors, order, **rest)

    def march(self, submission, step, problem, counts):
        return self.march_all(submission, step, [problem], counts)[0]

    def march_all(self, submission, step, problems, counts):
        measured = self._marched(submission, step, problems, counts)
        for problem, (hs, errors) in zip(problems, measured, strict=True):
            if np.all(np.isfinite(errors)) and np.all(errors > 0):
                self.bounded[f"order of {step} on {problem.name}"].append(convergence_order(hs, errors))
                self.bounded[f"error of {step}"].extend(errors.tolist())
        return measured


class Noting(Seeded):
    """A session that notes what its checks use of their tolerances.

    Attributes:
        shares: of each run of a check, by its id.
        failed: the checks that the first program after ``forget`` did not pass.
    """

    def __init__(self, recorder: Recorder, *args, **options) -> None:
        super().__init__(*args, **options)
        self.forget()
        run = self._checks.run

        def noted(check, submission):
            recorder.share = 0.0
            try:
                return run(check, submission)
            finally:
                self.shares[check.id].append(recorder.share)

        self._checks.run = noted

    def forget(self) -> None:
        self.shares: dict[str, list[float]] = defaultdict(list)
        self.failed: list[str] | None = None

    def grade(self, submission, *, only=()):
        verdict = super().grade(submission, only=only)
        if self.failed is None:
            self.failed = [check.id for check in verdict.checks if check.status != "pass"]
        return verdict


@dataclass
class Tables:
    """What was seen."""

    used: dict[str, float] = field(default_factory=lambda: defaultdict(float))
    caught: dict[str, float] = field(default_factory=lambda: defaultdict(lambda: math.inf))
    failed_by: Counter[str] = field(default_factory=Counter)
    bounded: dict[str, list[float]] = field(default_factory=dict)
    variants: int = 0
    mutants: int = 0
    failures: int = 0


def calibrate(session: Noting, recorder: Recorder, catalog: Catalog, options) -> Tables:
    """Grade every correct solution, then every mutant."""
    tables, caught = Tables(), caught_by(catalog, session.exercise)
    for program in programs(session.exercise, catalog, options):
        kind, _, name = program.name.partition("/")
        if kind == "mutants" and not tables.mutants:
            tables.bounded = {quantity: list(values) for quantity, values in recorder.bounded.items()}
        session.forget()
        short, _ = grade_one(session, program, first=0)
        tables.failures += short
        if kind == "mutants":
            tables.mutants += 1
            tables.failed_by.update(session.failed or ())
            by = caught[name]
            tables.caught[by] = min([tables.caught[by], *(share or math.inf for share in session.shares[by])])
        else:
            tables.variants += 1
            for check, shares in session.shares.items():
                tables.used[check] = max(tables.used[check], *shares)
    return tables


def report(session: Noting, tables: Tables, options) -> str:
    """The tables, as Markdown."""
    name = session.exercise.id
    lines = [
        f"# Calibration of `{name}`",
        "",
        f"{tables.variants} correct solutions over {options.seeds} seeds, {tables.mutants} mutants over "
        f"{options.mutants}; verdicts that are not as declared: {tables.failures}. Written by "
        f"`tests/benchmarks/calibration/tolerances.py {name}`.",
        "",
        "Share of the tolerance used: below 1 passes, a dash was decided without a number. `its mutants` "
        "are those that name the check; `fail it` counts all that do.",
        "",
        "| check | points | correct, at most | its mutants, at least | fail it |",
        "|---|---|---|---|---|",
    ]
    for check in session.checks:
        low = tables.caught.get(check.id)
        wrong = "" if low is None else "-" if not np.isfinite(low) else f"{low:.3g}"
        used = tables.used[check.id]
        lines.append(
            f"| {check.id} | {check.points:g} | {used:.2g} | {wrong} | {tables.failed_by[check.id]} |"
        )
    if tables.bounded:
        lines += ["", "Values of correct solutions that were compared with bounds, or that decide.", ""]
        lines += ["| quantity | least | mean | most | n |", "|---|---|---|---|---|"]
        lines += [
            f"| {name} | {min(v):.4g} | {np.mean(v):.4g} | {max(v):.4g} | {len(v)} |"
            for name, v in sorted(tables.bounded.items())
        ]
    return "\n".join(lines)


def truths(seeds: int) -> str:
    """What the hidden engines of ``engine-comparison`` are like, over the seeds."""
    lab = kit.reference("engine-comparison", "lab")
    seen = defaultdict(list)
    for seed in range(seeds):
        for parameters, truth in zip(lab.drawn(seed), lab.truths(seed), strict=True):
            for key, value in truth.items():
                seen[key].append(float(value))
            if rate := parameters.get("damping", 0.0):  # by what share it is off at the engine's own step
                keep = lab.boxes.Box(**parameters).matrix(0.0, parameters["dt"])[4]
                seen["error of damping at dt"].append(abs(-np.log(keep) / parameters["dt"] / rate - 1))
    lines = ["", "The hidden engines' truths.", "", "| key | least | most | infinite | zero | n |"]
    lines.append("|---|---|---|---|---|---|")
    for key, values in seen.items():
        finite = [value for value in values if math.isfinite(value)]
        zeros = sum(value == 0 for value in values)
        endless = len(values) - len(finite)
        lines.append(
            f"| {key} | {min(finite):.4g} | {max(finite):.4g} | {endless} | {zeros} | {len(values)} |"
        )
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("exercise")
    parser.add_argument("--seeds", type=int, default=200, help="for each correct solution")
    parser.add_argument("--mutant-seeds", type=int, default=20, dest="mutants", help="for each mutant")
    options = parser.parse_args()
    options.accepted, options.variant = options.seeds, []
    catalog, recorder = Catalog(), Recorder()
    exercise = catalog.exercise(options.exercise)
    with Noting(recorder, exercise, catalog, scope="full", terms=Terms(timeout=60.0)) as session:
        print(report(session, calibrate(session, recorder, catalog, options), options))
    if exercise.id == "engine-comparison":
        print(truths(options.seeds))


if __name__ == "__main__":
    main()
