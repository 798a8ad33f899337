"""What separates sound plans from unsound ones in ``sim-to-real``, over groups of three realities each.

    python tests/benchmarks/calibration/sim-to-real.py [--groups 200] [--first 0] [--save F.json]
    python tests/benchmarks/calibration/sim-to-real.py --merge F.json G.json > sim-to-real.md

For each group (the three carts of one grading run) every policy tunes gains and is scored as the grader
scores: the mean over three fleets of best over own settling. The identification is tried on the same carts,
and what kinds of excitation could show at best. ``local_run.py`` proves the checks' verdicts; this shows how
much room there is between them. A file of results can be made in parts and merged.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import math
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT)]


def load(path: Path, name: str):
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


reference = load(ROOT / "tests/graders/sim-to-real/reference.py", "reference")
model = load(ROOT / "solutions/sim-to-real/sim_to_real.py", "model")
cart = reference.cart
SCORED = tuple(cart.SCORED)


def box(scale: float) -> dict[str, list[float]]:
    """A box ``scale`` times as wide as the fleet, in the logarithm."""
    return {k: [math.exp(-scale * w), math.exp(scale * w)] for k, w in cart.FLEET.items()}


def policies(estimate: dict[str, list[float]], hard: tuple[float, float]) -> dict[str, tuple[float, float]]:
    """Gains by name of the policy, from one estimate."""

    def gains(estimate, scale):
        found = model.tune(estimate, box(scale))
        return found["kp"], found["kd"]

    deaf = {**estimate, "latency": [0.001] * 3}
    return {
        "matched": gains(estimate, 1.0),
        "box three times too wide": gains(estimate, 3.0),
        "no randomisation": gains(estimate, 0.0),
        "latency-blind, randomised": gains(deaf, 1.0),
        "hard-coded gains": hard,
    }


def group(seed: int, hard: tuple[float, float]) -> dict:
    """Everything seen with the three realities of one seed."""
    shares: dict[str, list[float]] = defaultdict(list)
    carts = reference.realities(seed)
    errors, halves, hits = [], [], []
    recordings = reference.recordings(seed)
    for i, truth in enumerate(carts):
        known = {**truth, "lag": truth["tau"] + truth["latency"]}
        estimates = [model.identify(*recordings[i]), model.identify(*recordings[i + 3])]
        for estimate in estimates:
            errors.append([estimate[k][0] / known[k] - 1 for k in SCORED])
            halves.append([(estimate[k][2] - estimate[k][1]) / 2 / known[k] for k in SCORED])
            hits.append([estimate[k][1] <= known[k] <= estimate[k][2] for k in SCORED])
        for name, pair in policies(estimates[0], hard).items():
            shares[name].append(reference.success(seed, i, *pair))
    sound = reference.box_success(seed, cart.MATCHED)
    return {
        "success": {name: float(np.mean(found)) for name, found in shares.items()}
        | {"the stand-in's tuning, matched": sound},
        "error": np.abs(errors).max(axis=0).tolist(),
        "half": np.max(halves, axis=0).tolist(),
        "hits": np.sum(hits, axis=0).tolist(),
        "reach": {
            kind: [reference.reach(seed, kind, k, cart.BUDGET_S) for k in SCORED]
            for kind in ("constant", "slow_sine", "chirp", "multisine", "prbs")
        },
    }


def report(groups: list[dict]) -> str:
    """The tables, as Markdown."""
    n = len(groups)
    lines = [
        "# Calibration of `sim-to-real`",
        "",
        f"{n} groups of three realities. Written by `tests/benchmarks/calibration/sim-to-real.py`.",
        "",
        "Success: mean over three fleets of best over own settling. A submission passes from 0.94.",
        "",
        "| policy | least | median | most | passes |",
        "|---|---|---|---|---|",
    ]
    for name in groups[0]["success"]:
        found = [g["success"][name] for g in groups]
        passes = sum(x >= 0.94 for x in found)
        lines.append(
            f"| {name} | {min(found):.3f} | {np.median(found):.3f} | {max(found):.3f} | {passes} of {n} |"
        )
    lines += [
        "",
        f"Identification of {6 * n} recordings by the model solution, in per cent of the truth; `holds`: how "
        "often the 95 % interval does.",
        "",
        "| parameter | largest error | allowed | widest half-width | allowed | holds |",
        "|---|---|---|---|---|---|",
    ]
    useful = {"m": 3, "b": 20, "Fc": 20, "lag": 20}
    for j, k in enumerate(SCORED):
        error, half = (100 * max(g[key][j] for g in groups) for key in ("error", "half"))
        holds = sum(g["hits"][j] for g in groups) / (6 * n)
        lines.append(
            f"| {k} | {error:.2f} | {100 * cart.SCORED[k]:.0f} | {half:.2f} | {useful[k]} | {holds:.3f} |"
        )
    lines += [
        "",
        "Narrowest half-width that any estimator could have after twenty seconds, in per cent: least and "
        "most over the groups, each with its worst cart.",
        "",
        "| excitation | " + " | ".join(SCORED) + " |",
        "|---|" + "---|" * len(SCORED),
    ]
    for kind in groups[0]["reach"]:
        cells = []
        for j in range(len(SCORED)):
            found = [100 * g["reach"][kind][j] for g in groups]
            cells.append(f"{min(found):.3g} to {max(found):.3g}")
        lines.append(f"| {kind} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--groups", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--save", type=Path)
    parser.add_argument("--merge", type=Path, nargs="*")
    options = parser.parse_args()
    if options.merge:
        print(report([g for path in options.merge for g in json.loads(path.read_text())]))
        return
    middle = reference.search(
        cart.fleet(cart.SHEET, 400, np.random.default_rng(1)), 2, first=100
    )  # the best gains for the data sheet's cart
    groups = []
    for seed in range(options.first, options.first + options.groups):
        groups.append(group(seed, middle[:2]))
        if options.save:
            options.save.write_text(json.dumps(groups))
    if not options.save:
        print(report(groups))


if __name__ == "__main__":
    main()
