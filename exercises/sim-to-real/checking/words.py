"""The words a plan may use, and what its box says; the README lists the same."""

from __future__ import annotations

import math

from course.scoring import kit

cart = kit.companion("sim-to-real", "cart")
named = kit.words("sim-to-real")

#: Which parameters each source of the gap shows in.
PARAMETERS_OF = {
    "friction": ("b", "Fc"),
    "gear_backlash": ("play",),
    "actuator_lag": ("tau", "lag"),
    "delay": ("latency", "lag"),
    "sensor_noise": ("noise",),
    "environment": ("m", "b", "Fc"),
}
ESTIMATOR_OF = {
    "m": "integral_least_squares",
    "b": "integral_least_squares",
    "Fc": "integral_least_squares",
    "tau": "delay_grid",
    "latency": "delay_grid",
    "lag": "delay_grid",
    "noise": "standard_deviation",
    "play": "standard_deviation",
}
WORDS = {
    "source": tuple(PARAMETERS_OF),
    "parameter": tuple(ESTIMATOR_OF),
    "excitation": ("rest", "constant", "slow_sine", "chirp", "multisine", "prbs"),
    "estimator": ("integral_least_squares", "delay_grid", "standard_deviation"),
    "mitigation": ("system_identification", "domain_randomization", "transfer_learning", "noise_model"),
    "metric": ("relative_error", "relative_half_width"),
    "unit": ("%", "1"),
}
GAP_KEYS = (*(key for key in WORDS if key != "unit"), "threshold", "unit")
PLAN_KEYS = ("gaps", "excitation_budget_s", "randomization", "metric", "threshold")
#: How exactly each parameter is needed, as a share of its value, and how well an excitation has to show it:
#: a slow sine shows the lag to 3.5 to 9 % at best, and no fit finds it there.
NEEDED = {**dict.fromkeys(ESTIMATOR_OF, 0.10), "m": 0.03}
SHOWN = {**NEEDED, "lag": 0.03}


def gaps_of(plan):
    """The plan's gaps, each with exactly the keys it must have.

    Raises:
        CheckFailed: the plan, or one of its gaps, is no such dict.
    """
    gaps = kit.as_list(kit.as_record(plan, PLAN_KEYS)["gaps"], "gaps")
    return [kit.as_record(gap, GAP_KEYS, "the gap") for gap in gaps]


def threshold_of(gap):
    """A gap's threshold as a share; NaN if it is not a number."""
    number = kit.as_number(gap["threshold"], "threshold")
    return number / 100 if gap["unit"] == "%" else number


def of_promise(metric, threshold):
    """What is wrong with a promise of the plan as a whole, (metric, threshold)."""
    if metric != "success":
        return named("METRIC_DOES_NOT_JUDGE")
    if not threshold >= 0.90:
        return named("PROMISE_TOO_SMALL")
    return named("PROMISE_NOT_A_SHARE" if threshold > 1.5 else "PROMISE_OF_PERFECTION")


def budget_of(plan):
    """Bench time, s, if it is what there is of it.

    Raises:
        CheckFailed: it is not.
    """
    seconds = kit.as_number(kit.as_record(plan, PLAN_KEYS)["excitation_budget_s"], "excitation_budget_s")
    if not 0.0 < seconds <= cart.BUDGET_S:
        kit.fail(
            "The plan's bench time is not within what the bench allows.",
            diagnose=named("BUDGET_EXCEEDED"),
            expected=[0.0, cart.BUDGET_S],
            actual=seconds,
            units="s",
        )
    return seconds


def box_of(plan):
    """The plan's box: {name: (low, high)} with 0 < low <= high.

    Raises:
        CheckFailed: it is none.
    """
    box = kit.as_record(plan, PLAN_KEYS)["randomization"]
    if not isinstance(box, dict) or set(box) != set(cart.NAMES):
        kit.fail(
            "The randomisation box is not a dict of the five parameters.",
            diagnose=named("BOX_LACKS"),
            expected=list(cart.NAMES),
            actual=list(box) if isinstance(box, dict) else box,
        )
    found = {}
    for name in cart.NAMES:
        low, high = (float(end) for end in kit.as_vector(box[name], 2, f"randomization[{name!r}]"))
        if not (0.0 < low <= high < math.inf):
            logarithms = low < 0 < high and math.isclose(-low, high)
            kit.fail(
                "An interval of the randomisation box is not two positive factors, the smaller first.",
                diagnose=named("BOX_IN_LOGARITHMS" if logarithms else "BOX_REVERSED"),
                input={"parameter": name},
                actual=[low, high],
            )
        if not 0.01 < low <= high < 100.0:
            kit.fail(
                "A factor of the randomisation box is a hundredth or less, or a hundred or more.",
                help="Factors multiply the estimate: from e^-w to e^w, for a half-width w.",
                input={"parameter": name},
                actual=[low, high],
            )
        found[name] = (low, high)
    return found


def inside(name, low, high):
    """Share of the fleet's draws of a parameter that lie between these factors."""
    w = cart.FLEET[name]
    return max(0.0, min(w, math.log(high)) - max(-w, math.log(low))) / (2 * w) + _ROUNDING


def width(name, low, high):
    """How many times as wide as the fleet an interval of factors is, in the logarithm."""
    return (math.log(high) - math.log(low)) / (2 * cart.FLEET[name]) - _ROUNDING


#: In the caller's favour: log(exp(x)) is not always x.
_ROUNDING = 1e-9


def of_box(box, shown=cart.NAMES):  # noqa: PLR0911 - one return per mistake
    """What is wrong with a box of which some parameter is too narrow or too wide.

    shown: the parameters that the finding is about
    """
    if all(_near(box[k], (1 - w, 1 + w)) for k, w in cart.FLEET.items()):
        return named("BOX_IS_LINEAR")
    low, high = (
        {k: math.log(box[k][end]) / sign / w for k, w in cart.FLEET.items()}
        for end, sign in ((0, -1), (1, 1))
    )
    if _all_near(low.values(), 1.0) and all(abs(box[k][1] - 1 - w) < 0.011 for k, w in cart.FLEET.items()):
        return named("BOX_HALF_LINEAR")
    for code, times in (("BOX_FULL_WIDTH", 0.5), ("BOX_TWICE_AS_WIDE", 2.0)):
        if _all_near(low.values(), times) and _all_near(high.values(), times):
            return named(code)
    if _all_near(low.values(), 0.0) != _all_near(high.values(), 0.0):
        return named("BOX_ONE_SIDED")
    middles = {k: math.sqrt(low * high) for k, (low, high) in box.items()}
    if all(abs(math.log(middles[k] / cart.SHEET[k])) < 0.2 for k in cart.NAMES):
        return named("BOX_NOT_FACTORS")
    widths = sorted(math.log(high / low) / 2 for low, high in box.values())
    if _all_near([a / b for a, b in zip(widths, sorted(cart.FLEET.values()), strict=True)], 1.0):
        return named("BOX_EXCHANGED")
    narrow = any(inside(k, *box[k]) < 0.95 for k in shown)
    return named("BOX_TOO_NARROW" if narrow else "BOX_TOO_WIDE")


def _all_near(shares, expected):
    """Whether ends of the box lie at this share of w, in the logarithm, for every parameter."""
    return all(abs(share - expected) < 0.05 for share in shares)


def _near(a, b):
    return all(abs(x - y) < 0.011 for x, y in zip(a, b, strict=True))
