"""What separates sound plans from unsound ones in ``sim-to-real``, over groups of three realities each.

    python tests/benchmarks/calibration/sim-to-real.py PART... [--groups 200] [--first 0] [--save F.json]
    python tests/benchmarks/calibration/sim-to-real.py --merge F.json G.json > sim-to-real.md

A group is the three carts of one grading run. Part ``policies``: every policy tunes gains and is scored as
the grader scores, by the mean over three fleets of best over own settling. ``boxes``: the same for the other
boxes that ``tune`` is asked about. ``bench``: the model solution's identification of full and of weak
recordings. ``excitations``: what each kind shows at best, and how far off the README's fit is on it. A file
of results can be made in parts and merged. ``seeds.py`` proves the checks' verdicts; this shows how much
room there is between them.
"""

import argparse
import json
import math
import sys
from collections import defaultdict
from pathlib import Path
from unittest import mock

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT)]

from course.authoring.exercises.grading import compose  # noqa: E402
from course.scoring import kit  # noqa: E402

SOLUTION = ROOT / "solutions/sim-to-real/sim_to_real.py"
reference = kit.sibling(str(ROOT / "tests/graders/sim-to-real/checks.py"), "reference")
model = kit.reference("sim-to-real", SOLUTION.stem)
judge = kit.companion("sim-to-real", "judge")
cart, bench = reference.cart, reference.bench
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


def of_policies(seed: int, hard: tuple[float, float]) -> dict:
    """Success over the three fleets by policy."""
    shares: dict[str, list[float]] = defaultdict(list)
    for i, recording in enumerate(reference.recordings(seed)[:3]):
        for name, pair in policies(model.identify(*recording), hard).items():
            shares[name].append(reference.success(seed, i, *pair))
    found = {name: float(np.mean(each)) for name, each in shares.items()}
    return found | {"the stand-in's tuning, matched": reference.box_success(seed, cart.MATCHED)}


def of_boxes(seed: int, hard: tuple[float, float]) -> dict:
    """Success on carts drawn from the other boxes, each about one reality."""
    shares: dict[str, list[float]] = defaultdict(list)
    for i, (truth, asked) in enumerate(zip(reference.realities(seed), reference.OTHER_BOXES, strict=True)):
        estimate = cart.with_intervals(truth)
        ways = {
            "as asked": model.tune(estimate, asked),
            "the fleet's box, whatever is asked": model.tune(estimate, cart.MATCHED),
            "no box": model.tune(estimate, {k: [1.0, 1.0] for k in cart.NAMES}),
            "gains in proportion to the mass": {"kp": 9.3 * truth["m"], "kd": 4.5 * truth["m"]},
            "hard-coded gains": dict(zip(("kp", "kd"), hard, strict=True)),
        }
        for name, gains in ways.items():
            shares[name].append(reference.other_success(seed, i, gains["kp"], gains["kd"]))
    return {name: float(np.mean(each)) for name, each in shares.items()}


def of_bench(seed: int, _hard: tuple[float, float]) -> dict:
    """The model solution's identification of the group's recordings, full ones and weak ones."""
    carts, recordings = [*reference.realities(seed)] * 2, reference.recordings(seed)
    full = [model.identify(*each) for each in recordings]
    weak = [model.identify(*each) for each in reference.weak_recordings(seed)]
    known = [{**truth, "lag": truth["tau"] + truth["latency"]} for truth in carts]
    pairs = list(zip(full, known, strict=True))
    bounds = [
        cart.attainable(u, [each])[0, [0, 1, 2, 5]] for (_, u, _), each in zip(recordings, carts, strict=True)
    ]
    # The values that the judge compares with bounds, in order; none of them fails.
    with mock.patch.object(kit, "expect_bounded") as compared:
        judge.expect_growth(full, weak, carts)
        judge.expect_honest_widths(full, recordings, carts)
    growth, *widths = [float(call.args[0]) for call in compared.call_args_list]
    return {
        "error": np.max([[abs(e[k][0] / t[k] - 1) for k in SCORED] for e, t in pairs], axis=0).tolist(),
        "half": np.max([[(e[k][2] - e[k][1]) / 2 / t[k] for k in SCORED] for e, t in pairs], axis=0).tolist(),
        "hits": np.sum([[e[k][1] <= t[k] <= e[k][2] for k in SCORED] for e, t in pairs], axis=0).tolist(),
        "bound": np.max(bounds, axis=0).tolist(),
        "missed": judge.misses(full, carts)[0],
        "growth": growth,
        "widths": widths,
    }


def commands(seed: int) -> dict:
    """Twenty seconds of each kind of excitation, (2000,) each."""
    rng = np.random.default_rng([seed, 6])
    t = cart.H * np.arange(2000)
    made = {kind: bench.excitation(kind, 20.0, rng) for kind in ("prbs", "multisine", "chirp", "slow_sine")}
    for name in ("multisine", "shift_register"):
        variant = {}
        exec(compose(SOLUTION, SOLUTION.parent / "accepted" / f"{name}.py"), variant)
        force = variant["design_excitation"](20.0, cart.U_BENCH, rng)
        made[f"accepted {name}"] = np.asarray(force, dtype=float)
    made["sine of 0.5 Hz"] = cart.U_BENCH * np.sin(2 * np.pi * 0.5 * t)
    made["reversals every 2 s"] = cart.U_BENCH * np.where(t % 4 < 2, 1.0, -1.0)
    made["one push of 2 s"] = np.where(t < 2.0, cart.U_BENCH, 0.0)
    return made


def of_excitations(seed: int, _hard: tuple[float, float]) -> dict:
    """For each kind the widths attainable, worst cart, and the README's fit's errors, mean of the carts."""
    carts = reference.realities(seed)
    return {
        kind: {
            "reach": cart.attainable(u, carts)[:, [0, 1, 2, 5]].max(axis=0).tolist(),
            "fit": np.mean([bench.fit_errors(u, each) for each in carts], axis=0).tolist(),
        }
        for kind, u in commands(seed).items()
    }


PARTS = {"policies": of_policies, "boxes": of_boxes, "bench": of_bench, "excitations": of_excitations}


def report(groups: list[dict]) -> str:
    """The tables, as Markdown."""
    parts = {name: [g[name] for g in groups if name in g] for name in PARTS}
    lines = [
        "# Calibration of `sim-to-real`",
        "",
        "Written by `tests/benchmarks/calibration/sim-to-real.py`.",
    ]
    titles = {
        "policies": "Success: mean over three fleets of best over own settling",
        "boxes": "Success on carts drawn from three other boxes, for right estimates",
    }
    for name, title in titles.items():
        if parts[name]:
            lines += ["", f"{title}; {len(parts[name])} groups. A submission passes from {judge.PASS}."]
            lines += _success(parts[name])
    if parts["bench"]:
        lines += _bench(parts["bench"])
    if parts["excitations"]:
        lines += _excitations(parts["excitations"])
    return "\n".join(lines)


def _success(found: list[dict]) -> list[str]:
    lines = ["", "| policy | least | median | most | passes |", "|---|---|---|---|---|"]
    for name in found[0]:
        shares = [each[name] for each in found]
        passes = sum(x >= judge.PASS for x in shares)
        lines.append(
            f"| {name} | {min(shares):.3f} | {np.median(shares):.3f} | {max(shares):.3f} "
            f"| {passes} of {len(shares)} |"
        )
    return lines


def _bench(found: list[dict]) -> list[str]:
    n = len(found)
    lines = [
        "",
        f"Identification of {6 * n} recordings by the model solution, in per cent of the truth; `holds`: how "
        "often the 95 % interval does; `times the narrowest`: mean half-width over the Cramér-Rao bound.",
        "",
        "| parameter | largest error | allowed | widest half-width | allowed | holds | times the narrowest "
        f"(at most {judge.WIDEST:g}) |",
        "|---|---|---|---|---|---|---|",
    ]
    for j, k in enumerate(SCORED):
        error, half = (100 * max(each[key][j] for each in found) for key in ("error", "half"))
        holds = sum(each["hits"][j] for each in found) / (6 * n)
        widths = [each["widths"][j] for each in found]
        lines.append(
            f"| {k} | {error:.2f} | {100 * cart.SCORED[k]:.0f} | {half:.2f} | {100 * judge.USEFUL[k]:.0f} "
            f"| {holds:.3f} | {min(widths):.1f} to {max(widths):.1f} |"
        )
    growth, missed = [each["growth"] for each in found], [each["missed"] for each in found]
    return [
        *lines,
        "",
        f"Weak recordings: intervals {min(growth):.2f} to {max(growth):.2f} times as wide, at least "
        f"{judge.WIDER:g} asked. Doubled intervals that miss the truth: at most {max(missed)} of 24, in "
        f"{sum(m > 0 for m in missed)} of {n} groups any; 2 allowed.",
    ]


def _excitations(found: list[dict]) -> list[str]:
    lines = []
    for key, what, of, limits in (
        ("reach", "Narrowest half-width that any estimator could have", "its worst cart", cart.SCORED),
        ("fit", "rms error of the README's fit", "the mean of its carts", judge.GIVEN_FIT),
    ):
        lines += [
            "",
            f"{what}, in per cent: least and most over {len(found)} groups, of each {of}; and in how many "
            "all four are within the limits.",
            "",
            f"| excitation | {' | '.join(f'{k} (at most {100 * limits[k]:g})' for k in SCORED)} | within |",
            "|---|" + "---|" * (len(SCORED) + 1),
        ]
        for kind in found[0]:
            values = 100 * np.array([each[kind][key] for each in found])
            cells = [
                f"{low:.3g} to {high:.3g}" for low, high in zip(values.min(0), values.max(0), strict=True)
            ]
            within = int(np.sum(np.all(values <= [100 * limits[k] for k in SCORED], axis=1)))
            lines.append(f"| {kind} | {' | '.join(cells)} | {within} of {len(found)} |")
    return lines


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("parts", nargs="*", choices=[*PARTS, []])
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
        groups.append({part: PARTS[part](seed, middle[:2]) for part in options.parts or PARTS})
        if options.save:
            options.save.write_text(json.dumps(groups))
    if not options.save:
        print(report(groups))


if __name__ == "__main__":
    main()
