"""How far correct solutions stay inside each tolerance of ``engine-comparison``, and wrong ones overshoot.

python tests/benchmarks/calibration/engine-comparison.py [--seeds N] [--mutant-seeds N] > engine-comparison.md

A report of an engine is measured once and looked at by ten checks, so unlike in other exercises all checks
of a task run on one submission here. The second table says what the hidden engines are like: how far their
truths lie apart is what the tolerances must keep apart.
"""

from __future__ import annotations

import argparse
import math
from collections import defaultdict

import numpy as np
from recorder import ROOT, Recorder, Tables, local_run, noting, report, tasks_of

from course.scoring import kit

EXERCISE = "engine-comparison"


def calibrate(seeds: int, mutant_seeds: int) -> Tables:
    """Every correct solution and every mutant, all checks of a task on one submission."""
    recorder, shares, tables = Recorder(), {}, Tables()
    checks = noting(local_run.load_checks(EXERCISE), recorder, shares)
    sources = local_run.sources(EXERCISE)
    folder = ROOT / "solutions" / EXERCISE
    kept = {"choose_engine", "engine_facts"}
    for name in ["solution", *(n for n in sources if n.startswith("accepted/"))]:
        redone = kept | {"characterise"} if name == "solution" else tasks_of(folder / name, {})
        tasks = redone & kept if redone <= kept else {"characterise"} | redone
        tables.variants += 1
        for seed in range(seeds):
            for result in local_run.run(sources[name], [c for c in checks if c.task in tasks], seed):
                tables.expect(result.status == "pass", name, seed, result)
                tables.used[result.check.id] = max(tables.used[result.check.id], shares[result.check.id])
    caught = local_run.caught(EXERCISE)
    for name, mutant in local_run.wrong(EXERCISE).items():
        tables.mutants += 1
        for seed in range(mutant_seeds):
            for result in local_run.run(sources[name], checks, seed):
                _judge(tables, mutant, caught[name], result, shares[result.check.id], seed)
    return tables


def _judge(tables: Tables, mutant, check: str, result, share: float, seed: int) -> None:
    failed = result.status != "pass"
    tables.failed_by[result.check.id] += failed and seed == 0
    if result.check.id == check:
        right = failed and result.finding.diagnosis == mutant.code
        tables.expect(right, mutant.name, seed, result)
        low = tables.caught.get(result.check.id, math.inf)
        tables.caught[result.check.id] = min(low, share or math.inf)
    elif failed:  # it loses its own task's points only
        tables.expect(result.check.task == mutant.task, mutant.name, seed, result)


def truths(seeds: int) -> str:
    """What the hidden engines are like, over the seeds."""
    lab = kit.reference(EXERCISE, "lab")
    seen = defaultdict(list)
    for seed in range(seeds):
        for parameters, truth in zip(lab.drawn(seed), lab.truths(seed), strict=True):
            for key, value in truth.items():
                seen[key].append(float(value))
            seen["error of damping at dt"] += _error_at_dt(lab, parameters)
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


def _error_at_dt(lab, parameters) -> list[float]:
    """By what share the damping is off if it is measured at the engine's own step."""
    rate = parameters.get("damping", 0.0)
    if not rate:
        return []
    keep = lab.boxes.Box(**parameters).matrix(0.0, parameters["dt"])[4]
    return [abs(-np.log(keep) / parameters["dt"] / rate - 1)]


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--mutant-seeds", type=int, default=20)
    options = parser.parse_args()
    tables = calibrate(options.seeds, options.mutant_seeds)
    text = report(EXERCISE, tables, options.seeds, options.mutant_seeds)
    print(text.replace("engine_comparison.py", "engine-comparison.py"))
    print(truths(options.seeds))


if __name__ == "__main__":
    main()
