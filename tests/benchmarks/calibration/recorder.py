"""How much of each tolerance correct solutions use, and by how much wrong ones overshoot, for any exercise.

Every comparison a check makes is recorded as the share of its tolerance that was used: below 1 passes. For
each check the table gives the largest share that any correct solution used over all seeds, and the smallest
that a mutant used which that check must catch. A second table has the raw values of whatever was compared
with bounds. A correct variant is run through the checks of the tasks it redefines.

A script per exercise beside this file calls ``main``.
"""

from __future__ import annotations

import argparse
import inspect
import re
import sys
from collections import defaultdict
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "benchmarks")]

import local_run  # noqa: E402

from course.scoring import kit  # noqa: E402


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


@dataclass
class Tables:
    """What was seen."""

    used: dict[str, float] = field(default_factory=lambda: defaultdict(float))
    caught: dict[str, float] = field(default_factory=dict)
    failed_by: dict[str, int] = field(default_factory=lambda: defaultdict(int))
    bounded: dict[str, list[float]] = field(default_factory=dict)
    variants: int = 0
    mutants: int = 0
    failures: int = 0

    def expect(self, as_declared: bool, name: str, seed: int, result) -> None:
        """Count a verdict that is not as declared, and say on the error stream which."""
        if not as_declared:
            self.failures += 1
            found = result.finding and (result.finding.diagnosis, result.finding.message)
            print(
                f"{name} seed {seed}: {result.check.id} {result.status} {found}", file=sys.stderr, flush=True
            )


def noting(checks, recorder: Recorder, shares: dict[str, float]):
    """The checks, each noting the share of its tolerance that was used."""

    def wrap(check):
        def run(**fixtures):
            recorder.share = 0.0
            try:
                check.fn(**fixtures)
            finally:
                shares[check.id] = recorder.share

        run.__signature__ = inspect.signature(check.fn)  # type: ignore[attr-defined]
        return replace(check, fn=run)

    return [wrap(check) for check in checks]


def tasks_of(path: Path, helpers: dict[str, str]) -> set[str]:
    """Tasks that a variant does in another way; ``helpers`` says which task a helper belongs to."""
    names = set(re.findall(r"^(?:def )?(\w+)(?:\(| = )", path.read_text(), re.M))
    return {helpers.get(name, name) for name in names}


def calibrate(exercise: str, recorder: Recorder, seeds: int, mutant_seeds: int, helpers) -> Tables:
    """Run every correct solution and every mutant."""
    checks = local_run.load_checks(exercise)
    sources = local_run.sources(exercise)
    folder = ROOT / "solutions" / exercise
    tables = Tables()
    for name in ["solution", *(n for n in sources if n.startswith("accepted/"))]:
        tasks = None if name == "solution" else tasks_of(folder / name, helpers)
        mine = [check for check in checks if tasks is None or check.task in tasks]
        tables.variants += 1
        for seed in range(seeds):
            for check in mine:
                recorder.share = 0.0
                (result,) = local_run.run(sources[name], [check], seed)
                tables.expect(result.status == "pass", name, seed, result)
                tables.used[check.id] = max(tables.used[check.id], recorder.share)
    tables.bounded = {name: list(values) for name, values in recorder.bounded.items()}
    caught = local_run.caught(exercise)
    for name, mutant in local_run.wrong(exercise).items():
        tables.mutants += 1
        _mutant(tables, recorder, sources[name], mutant, caught[name], checks, mutant_seeds)
    return tables


def _mutant(tables: Tables, recorder: Recorder, source: str, mutant, by: str, checks, seeds: int) -> None:
    check, shares = next(c for c in checks if c.id == by), {}
    mine = noting([c for c in checks if c.task == check.task], recorder, shares)  # some remember other checks
    for seed in range(seeds):
        result = next(r for r in local_run.run(source, mine, seed) if r.check.id == check.id)
        right = result.status != "pass" and result.finding.diagnosis == mutant.code
        tables.expect(right, mutant.name, seed, result)
        tables.caught[check.id] = min(tables.caught.get(check.id, np.inf), shares[check.id] or np.inf)
    for result in local_run.run(source, checks, 0):
        tables.failed_by[result.check.id] += result.status != "pass"


def report(exercise: str, tables: Tables, seeds: int, mutant_seeds: int) -> str:
    """The tables, as Markdown."""
    lines = [
        f"# Calibration of `{exercise}`",
        "",
        f"{tables.variants} correct solutions over {seeds} seeds, {tables.mutants} mutants over "
        f"{mutant_seeds}; verdicts that are not as declared: {tables.failures}. Written by "
        f"`tests/benchmarks/calibration/{exercise}.py`.",
        "",
        "Share of the tolerance used: below 1 passes, a dash was decided without a number. `its mutants` "
        "are those that name the check; `fail it` counts all that do.",
        "",
        "| check | points | correct, at most | its mutants, at least | fail it |",
        "|---|---|---|---|---|",
    ]
    for check in local_run.load_checks(exercise):
        low = tables.caught.get(check.id)
        wrong = "" if low is None else "-" if not np.isfinite(low) else f"{low:.3g}"
        used = tables.used[check.id]
        lines.append(f"| {check.id} | {check.points} | {used:.2g} | {wrong} | {tables.failed_by[check.id]} |")
    if tables.bounded:
        lines += ["", "Values of correct solutions that were compared with bounds, or that decide.", ""]
        lines += ["| quantity | least | mean | most | n |", "|---|---|---|---|---|"]
        lines += [
            f"| {name} | {min(v):.4g} | {np.mean(v):.4g} | {max(v):.4g} | {len(v)} |"
            for name, v in sorted(tables.bounded.items())
        ]
    return "\n".join(lines)


def main(exercise: str, helpers: dict[str, str] | None = None, recorder: Recorder | None = None) -> None:
    """Calibrate one exercise and print its tables.

    Args:
        helpers: helper functions of the model solution and the task each belongs to.
        recorder: one of a kind, for an exercise that compares in other ways too.
    """
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--mutant-seeds", type=int, default=20)
    options = parser.parse_args()
    recorder = recorder or Recorder()
    tables = calibrate(exercise, recorder, options.seeds, options.mutant_seeds, helpers or {})
    print(report(exercise, tables, options.seeds, options.mutant_seeds))
