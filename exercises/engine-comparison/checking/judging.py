"""One check per key of the report, the same on public and hidden engines."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

from course.scoring import kit

bench = kit.companion("engine-comparison", "bench")
probes = kit.companion("engine-comparison", "probes")
probing = kit.companion("engine-comparison", "probing")

#: What a wrong value under each key means, without values.
MESSAGES = {
    "order": "The order of convergence on the spring is wrong.",
    "symplectic": "The answer to whether one spring step conserves area is wrong.",
    "linear_damping": "The rate at which a free body slows down is wrong.",
    "max_stable_step": "The largest stable step on the spring is wrong.",
    "friction_anisotropy": "The ratio of the sliding forces, along the diagonal to along x, is wrong.",
    "rest_penetration": "The depth of a resting body in the floor is wrong.",
    "restitution": "The ratio of the speeds after and before the hit is wrong.",
    "tunnelling_speed": "The largest speed at which the wall stops every body is wrong.",
    "deterministic": "The answer to whether the engine repeats itself is wrong.",
}

HELP = {
    "order": "Over one time like 1.3/omega take 16, 32 and 64 steps. With the ends y = (q, v/omega), the "
    "order is log2(|y1 - y2| / |y2 - y3|), rounded.",
    "symplectic": "Columns of the matrix are the states after one step of 0.5/omega. Is |det - 1| < 1e-6?",
    "linear_damping": "Give a free body a speed v0, and take n small steps, together about dt/10: the rate "
    "is ln(v0/v)/(n h).",
    "max_stable_step": "From 0.05/omega up, where does an eigenvalue of the step on (q, v/omega) first have "
    "a modulus above 1 + 1e-8?",
    "friction_anisotropy": "From where the body has settled, bisect the least force that makes it faster "
    "than 0.01 m/s within 0.5 s, from 0 to 5 mu m g: along x, and along the diagonal.",
    "rest_penetration": "Put the body down at z = radius, and report max(0, radius - z) five seconds later.",
    "restitution": "Let the body meet the wall at 2 m/s. Divide its speed in the first sample after the hit "
    "by that in the last one before it.",
    "tunnelling_speed": "Find to 5 % the largest speed at which no start in [-1 - v dt, -1] gets through. It "
    "is infinite if none does below 200 m/s.",
    "deterministic": "Make the same run of a moving body twice, and compare every number bit for bit.",
}


#: What is said of one engine is shown of that one: which of the wrong ones it is, by the diagnosis.
_SHOWN = {
    "DAMPING_SIGN": lambda case, key: case.measured(key) < 0,
    "RESTITUTION_SIGN": lambda case, key: case.measured(key) < 0,
    "NO_ZERO": lambda case, key: case.truth[key] == 0,
    "LIMIT_NEVER_SEEN": lambda case, key: case.measured(key) == math.inf,
    "LIMIT_AT_ONCE": lambda case, key: case.measured(key) * case.box.omega < bench.AT_ONCE,
    "TUNNEL_NEVER_SEEN": lambda case, key: case.measured(key) == math.inf,
    "TUNNEL_UNSAFE_REPORTED": lambda case, key: bench.unsafe(case, 1.0),
}


#: What the engine's `info` has to do with a key. With anything else a value would be alike by chance.
_INFO = {
    "linear_damping": ("dt", "mass"),
    "max_stable_step": ("dt", "omega"),
    "friction_anisotropy": ("dt", "mass", "g", "mu"),
    "rest_penetration": ("dt", "radius"),
    "restitution": ("dt", "radius", "wall_thickness"),
    "tunnelling_speed": ("dt", "radius", "wall_thickness"),
}


def _info(case: Any, key: str) -> dict[str, float]:
    """What `info` says of this engine for this key, but for a small whole number that the value is, too."""
    found = ((name, case.box.info()[name]) for name in _INFO[key])
    value = case.measured(key)
    return {
        name: number
        for name, number in found
        if number != value or number >= _SMALL or not float(number).is_integer()
    }


#: Whole numbers below it are the same by chance: many things are 2.
_SMALL = 20


def expect_key(found: list[Any], key: str, spared: int) -> None:
    """Every engine that has a report has the right value under ``key``.

    Raises:
        CheckFailed: one is wrong; the diagnosis looks at all of them together.
    """
    judged = bench.reported(found, spared)
    for case in judged:
        _expect_kind(case, key)
    wrong = [case for case in judged if not probing.right(key, case)]
    said = probes.of_key(key, judged) if wrong else None
    shows = _SHOWN.get(said.code if said else "", lambda *_: True)
    for case in sorted(wrong, key=lambda case: not shows(case, key)):
        value, truth = case.measured(key), case.truth[key]
        words = {
            "input": {"key": key, "engine": case.name},
            "message": MESSAGES[key],
            "help": HELP[key],
            "diagnose": lambda: said,
        }
        if key in probing.TOLERANCES:
            rel, abs_, units, source = probing.TOLERANCES[key]
            words["input"] |= _info(case, key)
            kit.expect_close(
                value, truth, rel=rel, abs=abs_, source=source, quantity=key, units=units, **words
            )
        else:
            kit.expect_equal(value, truth, **words)


def _expect_kind(case: Any, key: str) -> None:
    """The value is there and of its kind; it is kept as a plain number or bool."""
    value = case.measured(key)
    if value is None:
        there = isinstance(case.report, dict) and key in case.report
        kit.fail(
            f"`{key}` is None for one of the engines." if there else f"`{key}` is not in the report yet.",
            diagnose=probes.named("MEASURED_AS_NONE" if there else "NOT_MEASURED"),
            input={"engine": case.name},
        )
    if key in ("symplectic", "deterministic"):
        case.report[key] = kit.as_bool(value, key)
        return
    number = kit.as_number(value, key)
    if key != "order":
        case.report[key] = number
        return
    if not math.isfinite(number):  # before it is called anything else
        kit.expect_close(
            number,
            case.truth[key],
            source="a whole number",
            quantity=key,
            input={"engine": case.name},
            message="`order` is not a finite number.",
            help="Print the two differences and their ratio.",
        )
    if not number.is_integer():
        kit.fail(
            "`order` is not a whole number.",
            diagnose=probes.named("ORDER_NOT_WHOLE"),
            input={"engine": case.name},
            expected=case.truth[key],
            actual=number,
        )
    case.report[key] = int(number)


def expect_complete(submission: Any, found: list[Any]) -> None:
    """Every engine has a report with the nine keys and no other, and it stays. Values are judged key by key;
    only a report in which nothing was measured is none."""
    for case in bench.reported(found, 0):
        kit.as_record(case.report, bench.KEYS, "the report")
        if all(case.measured(key) is None for key in bench.KEYS):
            kit.fail(
                "Nothing is measured of this engine: every value of its report is None.",
                diagnose=probes.named("MEASURED_AS_NONE"),
                input={"engine": case.name},
            )
    again = [dataclasses.replace(case, runs=[], through=[]) for case in found[:2]]
    submission.call_each(bench.TASK, [(bench.engine(case),) for case in again])
