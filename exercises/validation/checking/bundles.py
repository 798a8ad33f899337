"""Comparisons of a report of ``validate`` that the public and the hidden checks share."""

from __future__ import annotations

import hashlib
import math
import pickle
from dataclasses import asdict, dataclass, replace

import numpy as np

from course.scoring import kit

probes = kit.companion("validation", "probes_verdict")
twins = kit.companion("validation", "twins")
shared = kit.companion("validation", "expectations")
named = probes.named

KEYS = ("accepted", "reasons", *probes.MEASURES, "intervals", "runs_used")

#: A lag is right to this share of the longest time between samples. Correct searches use 28 % of it
#: (calibration table); one in whole samples is off by 0.3 or more here.
LAG_SHARE = 0.2
#: Ends of the lag's interval: the errors of searches with one run or another left out, times Student's t.
LAG_END_SHARE = 0.5
#: Ends of the other intervals, in halves of their width: Student's t has three digits in the table.
END_SHARE = 2e-3

#: Limits that nothing breaks.
LENIENT = {
    "rmse_max": 900.0,
    "bias_max": 900.0,
    "lag_max_s": 1.0,
    "coverage_min": -1.0,
    "coverage_max": math.inf,
}


@dataclass(frozen=True)
class Case:
    """A simulation of recorded carts: how late it is, in all or in each (s), and the mass it believes in."""

    recorded: list
    sim: dict
    real: dict
    lates: object = 0.0
    mass: float = twins.MASS


#: By digest of the case: all submissions of a grading run meet the same thirty.
_FACTS = {}
_MOST_FACTS = 100


def facts(case):
    """What a report of it should say; where there is a model, that is in a grading run."""
    key = hashlib.sha256(pickle.dumps((case.sim, case.real, case.lates, case.mass))).digest()
    if key not in _FACTS:
        if len(_FACTS) >= _MOST_FACTS:
            _FACTS.clear()
        known = kit.reference("validation", "facts").facts(
            case.recorded, case.sim, case.real, case.lates, case.mass
        )
        _FACTS[key] = probes.Facts(**known)
    return _FACTS[key]


def public(check, draw):
    """(case, facts) of a public check: the same at home every time, drawn in a grading run."""
    cases = _PUBLIC[check](draw)
    if kit.reference("validation", "facts") is not None:
        return [(case, facts(case)) for case in cases]
    known = kit.known_answers("validation", check)
    return [(case, probes.Facts(**one)) for case, one in zip(cases, known, strict=True)]


def known():
    """What public checks expect for their fixed inputs, for ``course author build``."""
    return {check: [_plain(facts(case)) for case in cases(None)] for check, cases in _PUBLIC.items()}


def _plain(right):
    return asdict(replace(right, other_lags=right.by_other_rules()))


def _late(draw):
    """Carts with steps and sizes of their own, each simulated as late as it pleases."""
    recorded, lates = [], []
    # id: samples, dt, what it swings about, amplitude, how late the simulation is
    for name, n, dt, middle, size, late in (
        ("a", 400, 0.02, 1.5, 1.0, 0.06),
        ("b", 600, 0.01, -1.0, 0.5, 0.02),
        ("c", 300, 0.02, 0.4, 0.7, 0.04),
    ):
        more = 1.0 if draw is None else draw.uniform(0.93, 1.07)
        drive, t = twins.Wave(more * middle, more * size), dt * np.arange(n)
        recorded.append(twins.Recording(name, t, drive, drive.speed(t), 0.4))
        lates.append(more * late)
    sim, real = twins.simulated(recorded, late=lates), twins.measured(recorded)
    rng = np.random.default_rng(55) if draw is None else draw
    return [Case(recorded, sim, real, tuple(lates)), far_and_off(rng)]


def far_and_off(rng):
    """Carts whose simulation is off to one side, and late or early by 0.155 to 0.185 s.

    A search that ends at 0.1 s does not get there. A sum of squares in the place of their mean goes beyond
    it: each sample that no longer overlaps takes a large square with it. What overlaps at the right shift are
    whole swings, so the offset by itself moves nothing.
    """
    late = float(rng.choice([-1, 1]) * rng.uniform(0.155, 0.185))
    recorded = []
    for i, swings in enumerate((3, 4, 5)):
        drive = twins.Wave(rng.uniform(-1, 1), rng.uniform(0.8, 1.1))
        t = 0.005 * np.arange(200 * swings + math.ceil(200 * abs(late)))
        recorded.append(twins.Recording(f"far {i}", t, drive, drive.speed(t), 2.0))
    sim = twins.simulated(recorded, late=late, offset=float(rng.choice([-1, 1]) * rng.uniform(0.6, 0.7)))
    return Case(recorded, sim, twins.measured(recorded), late)


def _accepts(draw):
    """A good simulation of carts, but of the one it was calibrated on; then calibrated on more of them."""
    rng = np.random.default_rng(54) if draw is None else draw
    # What a simulation was calibrated on is a matter of whole ids.
    recorded = [twins.record(rng, name, 7.0, 0.02, 0.03) for name in ("a", "ab", "c", "d")]
    good, bad = twins.simulated(recorded, offset=-0.005), twins.simulated(recorded, mass=3.0)
    runs, real = [bad["runs"][1], *(good["runs"][i] for i in (3, 0, 2))], twins.measured(recorded)
    return [
        Case(recorded, {"calibrated_on": fitted, "runs": runs}, real)
        for fitted in (["ab"], ["a", "ab", "c", "d"], ["a", "ab", "c"])
    ]


def apart(rng, count):
    """Carts that a simulation is early for and too slow, by amounts of their own: whoever looks at the upper
    end alone lets both pass."""
    recorded = [
        twins.record(rng, f"run {i}", rng.uniform(5, 7), 0.02, rng.uniform(0.02, 0.03)) for i in range(count)
    ]
    lates = -rng.permutation(np.linspace(0.01, 0.07, count))
    sim = twins.simulated(
        recorded,
        late=lates,
        offset=-rng.permutation(np.linspace(0.01, 0.05, count)),
        sigma_factor=rng.permutation(np.linspace(2.0, 8.0, count)),
    )
    return Case(recorded, sim, twins.measured(recorded), tuple(lates))


_PUBLIC = {
    "validate_late": _late,
    "validate_accepts": _accepts,
    "validate_margins_apart": lambda draw: [apart(np.random.default_rng(31) if draw is None else draw, 3)],
}

# -- comparisons ----------------------------------------------------------------------------------------


def expect_report(submission, case, spec, right, shown):
    """``validate`` tells these facts, concludes from them what the limits say, and leaves its arguments.

    Args:
        right: the facts.
        shown: what a finding says about the case.
    """
    sim, real = case.sim, case.real
    inspected = submission.call_inspect("validate", sim, real, spec)
    report = kit.as_record(inspected.value, KEYS, "the report")
    expect_measures(submission, report, case, right, shown)
    _expect_conclusion(report, right, spec, shown)
    shared.expect_left_alone(inspected, [sim, real, spec], ["sim", "real", "spec"])


def expect_measures(submission, report, case, right, shown):
    """The runs, the four numbers and their intervals are right."""
    expect_numbers(report, case, right, shown)
    _expect_lag(submission, report, right, shown)
    _expect_intervals(submission, report, right, shown)


#: What each number is.
_POOLED = {
    "rmse": "Pool the errors, simulated minus real at the same times, of all runs that count. Then take the "
    "root of their mean square.",
    "bias": "Pool the errors, simulated minus real at the same times, of all runs that count. Then take "
    "their mean.",
    "coverage": "Pool the samples of all runs that count. Which share has y_real within y_sim ± 1.96 sigma?",
}


def expect_numbers(report, case, right, shown):
    """The right runs, with the right rmse, bias and coverage."""
    used = [str(item) for item in kit.as_list(report["runs_used"], "runs_used")]
    kit.expect_equal(
        sorted(used),
        sorted(right.used),
        message="`runs_used` does not list the runs that count.",
        help="Use the runs that both lists have, without those on which the simulation was calibrated.",
        input=shown,
        diagnose=lambda: probes.of_used(used, report, case.sim, case.real, right),
    )
    for key in probes.NUMBERS:
        value = kit.as_number(report[key], key)
        kit.expect_close(
            value,
            right.numbers[key],
            rel=1e-6,
            abs=1e-9,
            source="a closed formula: only rounding is allowed",
            quantity=key,
            message=f"`{key}` is wrong.",
            help=_POOLED[key],
            input=shown,
            diagnose=lambda key=key, value=value: (
                probes.of_pairs(key, value, case.sim, case.real)
                or probes.of_number(key, value, right, *probes.together(case.sim, case.real, right.used))
            ),
        )


def _expect_lag(submission, report, right, shown):
    lag = kit.as_number(report["lag_s"], "lag_s")
    kit.expect_close(
        lag,
        right.numbers["lag_s"],
        abs=LAG_SHARE * right.dt,
        source="a fifth of the longest time step",
        quantity="lag_s",
        units="s",
        message="`lag_s` is not how late the simulation is.",
        help="Find the one shift s for which sim(t + s) fits real(t) best, over the samples of all runs.",
        input=shown,
        diagnose=lambda: probes.of_lag(submission, lag, _half(report), right),
    )


def _half(report):
    """Half the width of the lag's interval, or nan."""
    ends = kit.attempt(lambda: kit.as_vector(kit.as_record(report["intervals"], probes.MEASURES)["lag_s"], 2))
    return math.nan if ends is None else float(ends[1] - ends[0]) / 2


def _expect_intervals(submission, report, right, shown):
    found = kit.as_record(report["intervals"], probes.MEASURES, "`intervals`")
    ends = {
        key: kit.as_vector(kit.as_tuple(found[key], ("lo", "hi")), 2, f"the interval of {key}")
        for key in probes.MEASURES
    }
    words = {
        "help": "The number, and t times its standard error to either side; the error from the numbers with "
        "one run left out, about their own mean. No end is cut off where a value could not be.",
        "input": shown,
    }
    for key in probes.NUMBERS:
        kit.expect_array(
            ends[key],
            right.intervals[key],
            abs=1e-9 + END_SHARE * right.half(key),
            source="three digits of Student's t",
            quantity=f"{key} interval",
            message=f"The interval of `{key}` has the wrong ends.",
            diagnose=lambda key=key: probes.of_interval(key, ends, right),
            **words,
        )
    kit.expect_array(
        ends["lag_s"],
        right.intervals["lag_s"],
        abs=LAG_END_SHARE * right.dt + 0.03 * right.half("lag_s"),
        source="the search for the lag with one run or another left out",
        quantity="lag_s interval",
        message="The interval of `lag_s` has the wrong ends.",
        diagnose=lambda: probes.of_lag_interval(submission, report["lag_s"], _half(report), right),
        **words,
    )


def reasons_of(report):
    """The reasons of a report, as they are listed."""
    return [kit.as_text(item, "a reason") for item in kit.as_list(report["reasons"], "reasons")]


def _expect_conclusion(report, right, spec, shown):
    reasons = reasons_of(report)
    expected = right.reasons(spec)
    kit.expect_equal(
        reasons,
        expected,
        message="The reasons are not the ones that apply.",
        help="Give one reason for each interval that reaches beyond its margin, in alphabetical order.",
        input=shown,
        diagnose=lambda: probes.of_reasons([(reasons, expected)]),
    )
    expect_accepted(report, not expected, shown)


def expect_accepted(report, accepted, shown):
    """The verdict goes with the reasons."""
    kit.expect_equal(
        kit.as_bool(report["accepted"], "accepted"),
        accepted,
        message="`accepted` is wrong.",
        help="A simulation is accepted exactly where there is no reason against it.",
        input=shown,
        diagnose=named("VERDICT_AGAINST_REASONS"),
    )


def expect_margins(submission, case, right):
    """Each measure is judged apart from the others, by its interval and not by the number alone.

    The same runs are judged by many limits: some let everything pass, the others leave out one measure's
    number, or the number lies inside and its interval does not.
    """
    sim, real, count = case.sim, case.real, len(case.recorded)
    specs = _specs(right)
    # The numbers are asked for by themselves: the limits below are made of them, and a function may see all
    # calls that come in one message.
    alone = kit.as_record(submission.call("validate", sim, real, LENIENT), KEYS, "the report")
    reports = submission.call_each("validate", [(sim, real, spec) for spec in specs])
    found = [reasons_of(kit.as_record(report, KEYS, "the report")) for report in reports]
    expect_measures(submission, alone, case, right, {"runs": count, "spec": LENIENT})
    for spec, report, reasons in zip(specs, reports, found, strict=True):
        expected = right.reasons(spec)
        shown = {"runs": count, "spec": spec}
        kit.expect_equal(
            reasons,
            expected,
            message="The reasons are not the ones that apply.",
            help="Give one reason for each interval that reaches beyond its margin: no more, and no fewer.",
            input=shown,
            diagnose=lambda reasons=reasons, expected=expected: probes.of_reasons(
                [(r, right.reasons(s)) for r, s in zip(found, specs, strict=True)], (reasons, expected)
            ),
        )
        expect_accepted(report, not expected, shown)


def expect_edges(submission, rng):
    """Ends that lie exactly on their margins are inside.

    Every error is the same binary fraction, so no rule for a mean makes another number of it, and no run left
    out changes it: both ends are the number itself.
    """
    off = float(rng.choice([-1, 1]) * rng.choice([0.125, 0.25, 0.5]))
    recorded = [twins.record(rng, f"edge {i}", rng.uniform(5, 7), 0.02, 0.02) for i in range(3)]
    sim, real = twins.simulated(recorded), twins.measured(recorded)
    for ours, theirs in zip(sim["runs"], real["runs"], strict=True):
        theirs["y"] = np.round(64 * ours["y"]) / 64
        ours |= {"y": theirs["y"] + off, "sigma": np.ones(len(theirs["y"]))}
    exact = {"rmse_max": abs(off), "bias_max": abs(off), "coverage_min": 1.0, "coverage_max": 1.0}
    for name, limit in exact.items():
        spec = LENIENT | {name: limit}
        report = kit.as_record(submission.call("validate", sim, real, spec), KEYS, "the report")
        shown = {"every error": off, "spec": spec}
        reasons = reasons_of(report)
        key = name.partition("_")[0]
        excluded = reasons == [key] and _reaches(report, key, limit)
        kit.expect_equal(
            reasons,
            [],
            message="An interval that ends exactly on its margin is refused."
            if excluded
            else "A reason is given, although no right interval reaches beyond its margin.",
            help="An end on the margin is inside: refuse where lo < least or hi > most.",
            input=shown,
            diagnose=lambda reasons=reasons, excluded=excluded: (
                named("MARGIN_EXCLUDED") if excluded else probes.of_reasons([(reasons, [])])
            ),
        )
        expect_accepted(report, True, shown)


def _reaches(report, key, margin):
    """Whether the interval that was given ends just on this margin."""
    ends = kit.attempt(lambda: kit.as_vector(kit.as_record(report["intervals"], probes.MEASURES)[key], 2))
    return ends is not None and float(np.max(np.abs(ends))) == margin


def expect_ends_covered(submission, rng):
    """A value that lies just on an end of its interval is covered.

    Every error is 1.96, and no value is as large: each sum and difference of them is exact.
    """
    recorded = [twins.record(rng, f"end {i}", rng.uniform(5, 7), 0.02, 0.02) for i in range(3)]
    for side in (-1.0, 1.0):  # the lower ends, and the upper ones
        sim, real = twins.simulated(recorded), twins.measured(recorded)
        for ours, theirs in zip(sim["runs"], real["runs"], strict=True):
            swing = ours["y"] / np.max(np.abs(ours["y"]))
            theirs["y"] = side * np.round(57 * swing - 58) / 64
            ours |= {"y": theirs["y"] + side * 1.96, "sigma": np.ones(len(theirs["y"]))}
        report = kit.as_record(submission.call("validate", sim, real, LENIENT), KEYS, "the report")
        kit.expect_close(
            kit.as_number(report["coverage"], "coverage"),
            1.0,
            rel=1e-6,
            source="a closed formula: only rounding is allowed",
            quantity="coverage",
            message="`coverage` is wrong where every error is exactly 1.96 sigma.",
            help="Ends are included: a value is covered where abs(y_sim - y_real) <= 1.96 * sigma.",
            input={"every error": side * 1.96, "sigma": 1.0},
        )


def _specs(right):
    """Limits: nothing is broken; one number is; one interval is, though its number is not."""
    largest = {key: max(map(abs, right.intervals[key])) for key in probes.MEASURES}
    number = {key: abs(right.numbers[key]) for key in probes.MEASURES}
    names = {"rmse": "rmse_max", "bias": "bias_max", "lag_s": "lag_max_s"}
    lo, hi = right.intervals["coverage"]
    share, half = right.numbers["coverage"], right.half("coverage")
    kept = {name: 1.3 * largest[key] for key, name in names.items()}
    limits = [kept | {"coverage_min": lo - 0.02, "coverage_max": hi + 0.02}]
    for key, name in names.items():
        limits += [{name: 0.6 * number[key]}, {name: (largest[key] + number[key]) / 2}]
    limits += [{"coverage_min": share - 0.5 * half}, {"coverage_max": share + 0.5 * half}]
    return [LENIENT | changed for changed in limits]


def expect_nothing(submission, case, spec, right, shown):
    """``validate`` says that no run, or a single one, is nothing to judge by."""
    report = kit.as_record(submission.call("validate", case.sim, case.real, spec), KEYS, "the report")
    reasons, used = reasons_of(report), kit.as_list(report["runs_used"], "runs_used")
    single, lacking = bool(right.used), [report[key] is None for key in probes.MEASURES]
    if single and not any(lacking):
        expect_numbers(report, case, right, shown)
        _expect_lag(submission, report, right, shown)
    told = report["intervals"] is None and (not any(lacking) if single else all(lacking))
    kit.expect_true(
        reasons == ["single_run" if single else "calibration_data"]
        and told
        and kit.as_bool(report["accepted"], "accepted") is False
        and len(used) == len(right.used),
        "A single run is left to judge by, and the report does not say exactly that."
        if single
        else "Every run was used to calibrate the simulation, and the report does not say exactly that.",
        help="With no run left, the only reason is calibration_data and every number is None; with one, the "
        "only reason is single_run. Then intervals is None, and it is not accepted.",
        input=shown,
        actual=report,
        diagnose=lambda: named(
            "CALIBRATION_RUNS_SCORED" if used and not single and _scored(report) else "NOTHING_LEFT"
        ),
    )


def _scored(report):
    """Whether a report has an rmse."""
    return kit.attempt(lambda: kit.as_number(report["rmse"], "rmse")) is not None
