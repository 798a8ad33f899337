"""What public checks and hidden graders of ``sim-to-real`` expect of a part of the plan."""

from __future__ import annotations

import functools

import numpy as np

from course.grading import kit

cart = kit.companion("sim-to-real", "cart")
words = kit.companion("sim-to-real", "words")
probes = kit.companion("sim-to-real", "probes")
named = words.named

#: Success that passes: mean of min(1, best/own). Between what correct solutions and the wrong ones reach.
PASS = 0.94
#: Widest useful half of an interval, as a share of the value.
USEFUL = {"m": 0.03, "b": 0.20, "Fc": 0.20, "lag": 0.20}


def expect_words(i, gap):
    """A gap is said in words of the lists, and they go together."""
    for key, known in words.WORDS.items():
        kit.expect_true(
            kit.as_text(gap[key], key) in known,
            "A word of the plan is in none of the lists.",
            diagnose=named("UNKNOWN_WORD"),
            input={"gap": i, "key": key},
            expected=list(known),
            actual=gap[key],
        )
    kit.expect_true(
        gap["source"] != "gear_backlash",
        "A gap of the plan does not exist on this cart.",
        diagnose=named("SOURCE_NOT_HERE"),
        input={"gap": i},
    )
    kit.expect_true(
        gap["parameter"] in words.PARAMETERS_OF[gap["source"]],
        "A gap's parameter does not belong to its source.",
        diagnose=named("PARAMETER_OF_ANOTHER_SOURCE"),
        input={"gap": i, "source": gap["source"]},
        expected=list(words.PARAMETERS_OF[gap["source"]]),
        actual=gap["parameter"],
    )
    kit.expect_true(
        gap["estimator"] == words.ESTIMATOR_OF[gap["parameter"]],
        "A gap's estimator does not estimate its parameter.",
        diagnose=named("ESTIMATOR_CANNOT"),
        input={"gap": i, "parameter": gap["parameter"]},
        expected=words.ESTIMATOR_OF[gap["parameter"]],
        actual=gap["estimator"],
    )


def expect_enough(gaps):
    """There are at least three gaps."""
    kit.expect_true(
        len(gaps) >= 3, "The plan lists too few gaps.", diagnose=named("TOO_FEW_GAPS"), actual=len(gaps)
    )


def shown(u, carts):
    """Whether the best of all estimators could measure each of the carts well enough from this command."""
    widths = cart.attainable(u, carts)
    return all(np.all(widths[:, i] <= cart.SCORED[name]) for name, i in _COLUMN.items())


_COLUMN = {"m": 0, "b": 1, "Fc": 2, "lag": 5}


def expect_shows(u, carts):
    """Every scored parameter of every cart can be seen in what this command makes it do."""
    widths = cart.attainable(u, carts)
    for name, i in _COLUMN.items():
        kit.expect_bounded(
            float(widths[:, i].max()),
            high=cart.SCORED[name],
            source="the accuracy asked of identify; random full force reaches a quarter of it",
            quantity=f"narrowest possible 95 % half-width of {name}, as a share",
            message="A recording with this excitation cannot show every parameter, whoever evaluates it.",
            input={"parameter": name},
            diagnose=lambda: probes.of_command(u),
        )


@functools.cache
def public_recordings():
    """Two bench recordings of the public cart and one of the data sheet's, and whose they are."""
    carts = [cart.PUBLIC, cart.PUBLIC, cart.SHEET]
    return cart.prbs_recordings(carts, 20.0, np.random.default_rng(21)), carts


def expect_accurate(estimates, carts):
    """The values are as near the truth as the README asks."""
    for estimate, truth in zip(estimates, carts, strict=True):
        known = {**truth, "lag": truth["tau"] + truth["latency"]}
        for name, rel in cart.SCORED.items():
            kit.expect_close(
                estimate[name][0],
                known[name],
                rel=rel,
                source="the README's; single recordings used up to six tenths of it",
                quantity=name,
                units=_UNITS[name],
                message="A parameter identified from a bench recording is too far from the cart's own.",
                help="Try it on a recording that you make yourself with `record`, where you know the cart.",
                input={"parameter": name},
                diagnose=lambda: probes.of_values(estimates, carts),
            )
        kit.expect_close(
            estimate["lag"][0],
            estimate["tau"][0] + estimate["latency"][0],
            rel=0.02,
            source="its definition, with room for a fit of its own",
            quantity="lag",
            units="s",
            message="The lag is not the sum of the motor's lag and the latency.",
            diagnose=named("LAG_NOT_SUM"),
        )


_UNITS = {"m": "kg", "b": "N s/m", "Fc": "N", "lag": "s"}


def expect_intervals(estimates):
    """Low, value and high are in order, and the scored ones are narrow enough to say something."""
    for estimate in estimates:
        for name, (value, low, high) in estimate.items():
            kit.expect_true(
                low <= value <= high and low < high,
                "An interval does not hold its own value.",
                diagnose=named("INTERVAL_REVERSED"),
                input={"parameter": name},
                actual=[value, low, high],
            )
        for name, limit in USEFUL.items():
            value, low, high = estimate[name]
            kit.expect_bounded(
                (high - low) / 2,
                high=limit * abs(value),
                source="the README's; correct solutions use a third of it",
                quantity=f"half-width of {name}",
                units=_UNITS[name],
                message="An interval is too wide to say anything.",
                diagnose=named("INTERVAL_USELESS"),
                input={"parameter": name, "value": value},
            )


def misses(estimates, carts):
    """How many scored intervals miss the truth even when taken twice as wide, and how many there are."""
    missed = total = 0
    for estimate, truth in zip(estimates, carts, strict=True):
        known = {**truth, "lag": truth["tau"] + truth["latency"]}
        for name in cart.SCORED:
            value, low, high = estimate[name]
            total += 1
            missed += not value + 2 * (low - value) <= known[name] <= value + 2 * (high - value)
    return missed, total
