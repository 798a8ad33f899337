"""Reports and requirements drawn for ``choose_engine``, with the right answer by construction."""

from __future__ import annotations

import itertools
import math

from course.scoring import kit

bench = kit.companion("engine-comparison", "bench")
choosing = kit.reference("engine-comparison", "choosing")
measured = kit.companion("engine-comparison", "measured")

need = measured.need


def reports_of(rng, truths):
    """The hidden boxes' right reports under new names, with costs that are all different."""
    costs = rng.permutation([1.0, 1.5, 2.5, 4.0, 6.0, 9.0, 13.0, 18.0])
    called = choosing.names(rng, len(truths))
    return {
        name: {**truth, "cost": float(cost)} for name, truth, cost in zip(called, truths, costs, strict=False)
    }


def _limits(reports, key):
    """Values between those that occur, so that rounding decides nothing."""
    values = sorted({r[key] for r in reports.values() if math.isfinite(r[key])})
    return [(a + b) / 2 for a, b in itertools.pairwise(values) if b - a > 1e-6 * (1 + abs(a))]


def some_need(rng, reports):
    """A requirement that some reports meet and others do not."""
    key = str(rng.choice(bench.KEYS))
    if key in ("symplectic", "deterministic"):
        return need(key, "==", bool(rng.integers(2)))
    if key == "order":
        return need(key, str(rng.choice(["<=", ">=", "=="])), int(rng.choice([1, 2, 4])))
    limits = _limits(reports, key)
    return need(key, str(rng.choice(["<=", ">="])), float(rng.choice(limits)))


def questions(rng, truths, wanted, fits):
    """As many questions as are wanted, of one to three requirements, whose right answer ``fits``."""
    found = []
    while len(found) < wanted:
        reports = reports_of(rng, truths)
        needs = [some_need(rng, reports) for _ in range(int(rng.integers(1, 4)))]
        answer = choosing.choose(reports, needs)
        if fits(reports, needs, answer):
            found.append((reports, needs, answer))
    return found


def telling(reports, needs, answer):
    """A question in which neither the cheapest of all engines, nor the first, the last or the dearest that
    fits is right by accident."""
    if answer is None:
        return False
    fitting = [name for name, r in reports.items() if all(choosing.meets(r, n) for n in needs)]
    cheapest = min(reports, key=lambda name: reports[name]["cost"])
    return answer != cheapest and answer not in (fitting[0], fitting[-1])


def all_count(reports, needs, answer):
    """A question in which neither the first nor the last requirement alone gives the right answer."""
    alone = [choosing.choose(reports, [need]) for need in (needs[0], needs[-1])]
    return answer is not None and answer not in alone


def with_gaps(rng, question):
    """The same question with cheaper engines that would fit, had they been measured: one key is gone from
    one of them, and None in the other. In the right one a key is None that is not required."""
    reports, needs, answer = question
    key = str(rng.choice([n["key"] for n in needs]))
    reports = {name: dict(report) for name, report in reports.items()}
    fitting = dict(reports[answer])
    first, second = choosing.names(rng, 2)
    reports[first + "x"] = {**{k: v for k, v in fitting.items() if k != key}, "cost": 0.5}
    reports[second + "y"] = {**fitting, key: None, "cost": 0.7}
    reports[answer] |= {"noise_db": None}
    shuffled = [str(name) for name in rng.permutation(list(reports))]
    return {name: reports[name] for name in shuffled}, needs, answer


def at_the_limit(rng, truths):
    """A question whose right answer meets its limits exactly, from both sides."""
    reports = reports_of(rng, truths)
    finite = [n for n, r in reports.items() if 0 < r["max_stable_step"] < math.inf]
    chosen = str(rng.choice(finite))
    exact = reports[chosen]
    needs = [
        need(key, op, exact[key]) for key in ("max_stable_step", "restitution") for op in ("<=", ">=", "==")
    ]
    return reports, needs, choosing.choose(reports, needs)


def beyond_the_limit(rng, truths):
    """A question like it whose limits leave the engine out by as little as numbers allow."""
    reports, (atmost, atleast, *_), _ = at_the_limit(rng, truths)
    value, op = atmost["value"], str(rng.choice(["<=", ">="]))
    past = math.nextafter(value, 0.0 if op == "<=" else math.inf)
    needs = [need(atmost["key"], op, past), need(atmost["key"], atleast["op"] if op == "<=" else "<=", value)]
    return reports, needs, choosing.choose(reports, needs)


def other_types(rng, truths):
    """A question whose values are equal to those of the reports and of other types, twice about one key."""
    reports = reports_of(rng, truths)
    needs = [
        need("symplectic", "==", int(rng.integers(2))),
        need("order", ">=", 1.0),
        need("order", "==", 2.0),
    ]
    return reports, needs, choosing.choose(reports, needs)


def priced_alike(rng, question):
    """The same question with costs that differ in their tenth digit, or that are far below one."""
    reports, needs, answer = question
    size, base = (1.0, 7.0) if rng.random() < 0.5 else (1e-3, 0.0)
    near = {name: {**r, "cost": base + size * 1e-9 * r["cost"]} for name, r in reports.items()}
    return near, needs, answer


def priced_at_nothing(rng, question):
    """The same question with the right one for free, and the first of its reports."""
    reports, needs, answer = question
    free = {answer: {**reports[answer], "cost": 0.0}}
    return free | {name: r for name, r in reports.items() if name != answer}, needs, answer


def priced_high(rng, question):
    """The same question with costs beyond any number that a search might start from."""
    reports, needs, answer = question
    rate = 10.0 ** float(rng.uniform(9.0, 12.0))
    return {name: {**r, "cost": rate * r["cost"]} for name, r in reports.items()}, needs, answer


def priced_in_whole_numbers(question):
    """The same question with costs in whole numbers of which a float has not all digits."""
    reports, needs, answer = question
    ranks = {name: rank for rank, name in enumerate(sorted(reports, key=lambda name: reports[name]["cost"]))}
    dear = {name: {**r, "cost": 2**60 + ranks[name]} for name, r in reports.items()}
    return dict(sorted(dear.items(), key=lambda item: -item[1]["cost"])), needs, answer


def famous(questions):
    """Questions in which the dearest engine that fits has the name of a famous one."""
    told = []
    for known, (reports, needs, answer) in zip(measured.ENGINES, questions, strict=True):
        fitting = [name for name, r in reports.items() if all(choosing.meets(r, n) for n in needs)]
        dearest = max(fitting, key=lambda name: reports[name]["cost"])
        renamed = {known if name == dearest else name: report for name, report in reports.items()}
        told.append((renamed, needs, answer))
    return told


def passed_round(question):
    """The same names and requirements, with the reports passed on from each name to the one before it."""
    reports, needs, _ = question
    names, passed = list(reports), [*reports.values()]
    others = dict(zip(names, passed[1:] + passed[:1], strict=True))
    return others, needs, choosing.choose(others, needs)


def beyond_reach(rng, truths):
    """A question that no engine meets, though each requirement alone is met by some."""
    reports = reports_of(rng, truths)
    return reports, [need("order", ">=", 4), need("symplectic", "==", True)], None


def nothing_told(rng, truths, op):
    """A question about a key that some reports lack, and that is None in the others; zero is asked for."""
    reports = {
        name: r | ({"noise_db": None} if rng.random() < 0.5 else {})
        for name, r in reports_of(rng, truths).items()
    }
    return reports, [need("noise_db", op, rng.choice([0, 0.0, False]).item())], None


#: Further questions about the engines as measured: requirements, and the right name.
REAL = (
    ([need("as_it_comes", "==", True)], "physx, as it comes"),
    ([need("pendulum_loss", "<=", 0.2), need("slope_error", "<=", 0.001)], "physx, well set"),
    ([need("rebound_m", ">=", 0.2), need("rebound_m", "<=", 0.28), need("as_it_comes", "==", True)],
     "physx, as it comes"),
    ([need("graphics_card", "==", False), need("clash_error", "<=", 0.01)], "ode, as it comes"),
    ([need("graphics_card", "==", False), need("as_it_comes", "==", True), need("diagonal", "<=", 1.1)],
     "bullet, as it comes"),
    ([need("clash_error", "<=", 0.01), need("stack_mm", "<=", 0.1)], "mujoco, well set"),
    ([need("gazebo_classic", "==", True), need("rate", ">=", 0.2)], None),
    ([need("price_eur", "<=", 0.0)], None),
)  # fmt: skip
