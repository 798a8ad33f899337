"""What tells wrong programs of ``engine-comparison`` apart; a task with a failed check is asked it besides.

The same at home and in a grading run. What should come back is not here.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from course.scoring import kit

bench = kit.companion("engine-comparison", "bench")
boxes = kit.companion("engine-comparison", "boxes")

# -- engines ----------------------------------------------------------------------------------------------


def explicit_euler(a, x, v, h):
    """Grows at every step, however small."""
    return x + h * v, v + h * a(x, v)


def implicit_euler(a, x, v, h):
    """Fades at every step, however large. a(x, v) is linear, so v' = v + h a(x + h v', v') is a division."""
    still, moving = a(x, 0.0), a(x + h, 1.0)
    v = (v + h * still) / (1 - h * (moving - still))
    return x + h * v, v


def two_verlet_steps(a, x, v, h):
    """Verlet over a fifth of h and then the rest: stability is lost, found again, and lost for good."""
    x, v = boxes.velocity_verlet(a, x, v, 0.188 * h)
    return boxes.velocity_verlet(a, x, v, 0.812 * h)


def two_euler_steps(a, x, v, h):
    """Semi-implicit Euler over 0.65 h and then the rest: less of a gap, with stable steps soon beyond it."""
    for part in (0.65 * h, 0.35 * h):
        x = x + part * v
        v = v + part * a(x, v)
    return x, v


def three_kutta_steps(a, x, v, h):
    """Kutta's third order, three times a third of h: stable for longer than other explicit engines here."""
    for _ in range(3):
        x, v = kutta(a, x, v, h / 3)
    return x, v


def kutta(a, x, v, h):
    dx1, dv1 = v, a(x, v)
    dx2, dv2 = v + h / 2 * dv1, a(x + h / 2 * dx1, v + h / 2 * dv1)
    dx3, dv3 = v + h * (2 * dv2 - dv1), a(x + h * (2 * dx2 - dx1), v + h * (2 * dv2 - dv1))
    return x + h / 6 * (dx1 + 4 * dx2 + dx3), v + h / 6 * (dv1 + 4 * dv2 + dv3)


def stiffer_than_told(a, x, v, h):
    """Keeps area, and at no step the energy that a spring of the told omega has."""
    v = v + 9 * h * a(x, v)
    return x + h * v, v


def grows_slowly(a, x, v, h):
    """Verlet, but every step grows, by 2e-4 or more: where it is called unstable tells limits apart."""
    x, v = boxes.velocity_verlet(a, x, v, h)
    growth = 1 + 2e-4 * math.exp(4.5 * h * boxes.BALSA.omega)
    return growth * x, growth * v


KNOWN = {"anvil": boxes.ANVIL, "balsa": boxes.BALSA, "cork": boxes.CORK}
#: Where the largest stable step is zero, infinite, followed by larger ones that are stable again, or large.
ENDS = {
    "an engine that is never stable": dataclasses.replace(boxes.BALSA, step=explicit_euler, damping=0.0),
    "an engine that is never unstable": dataclasses.replace(
        boxes.BALSA, step=implicit_euler, mass=0.8, damping=2.1
    ),
    "an engine that is stable again": dataclasses.replace(boxes.ANVIL, step=two_verlet_steps),
    "an engine that is stable again soon": dataclasses.replace(boxes.ANVIL, step=two_euler_steps),
    "an engine of third order": dataclasses.replace(
        boxes.ANVIL, step=three_kutta_steps, omega=0.4, dt=1 / 600, wall_thickness=0.08, contact="sided"
    ),
}

#: More engines for single keys: what forgives a small difference does not forgive these.
APART = {
    "symplectic": (
        "an engine stiffer than it says",
        dataclasses.replace(boxes.BALSA, step=stiffer_than_told, damping=0.0),
    ),
    "max_stable_step": (
        "an engine that grows slowly",
        dataclasses.replace(boxes.BALSA, step=grows_slowly, damping=0.0),
    ),
    "rest_penetration": ("an engine that is softer", dataclasses.replace(boxes.CORK, softness=0.007)),
    "deterministic": ("an engine that hardly repeats itself", dataclasses.replace(boxes.CORK, jitter=1e-3)),
}

# -- characterise -----------------------------------------------------------------------------------------

TASK = "characterise"
PARTS = {
    check: f"{TASK}.{key}" for key in bench.KEYS for check in (key, f"hidden_{key}", f"{key}_at_its_ends")
} | {"report_complete": f"{TASK}.report", "hidden_report_complete": f"{TASK}.report"}

#: key: (size below which differences count as they are, above it relative to the value; what counts as equal)
_NEAR = {
    "linear_damping": (0.1, 0.012),
    "max_stable_step": (1e-3, 0.02),
    "friction_anisotropy": (0.01, 0.04),
    "rest_penetration": (2e-3, 0.03),
    "restitution": (1.0, 0.04),
    "tunnelling_speed": (1.0, 0.06),
}
#: Keys of which three engines show too little.
_OF_ENDS = ("symplectic", "max_stable_step", "order", "linear_damping")


def _characterise(answer, names=None):
    """Numbers for each key. names: of the parts that are of interest; None for all."""
    wanted = [key for key in bench.KEYS if names is None or f"{TASK}.{key}" in names]
    known = [_case(answer, name, box) for name, box in KNOWN.items()] if wanted else []
    ends = [_case(answer, name, box) for name, box in ENDS.items()] if set(wanted) & set(_OF_ENDS) else []
    apart = {key: [_case(answer, *APART[key])] for key in wanted if key in APART}
    return {f"{TASK}.{key}": _numbers(key, known + apart.get(key, []), ends) for key in wanted}


def _case(answer, name, box):
    """One engine in the program's hands, with every run it makes."""
    case = bench.Case(name, dataclasses.replace(box, noise=np.random.default_rng(5)), {})  # as every time
    (case.report,) = answer([(bench.engine(case),)])
    return case


def _raised(case):
    return isinstance(case.report, dict) and case.report.keys() == {"raised"}


def _numbers(key, known, ends):
    cases = known + ends if key in _OF_ENDS else known
    numbers = [-4e3 if _raised(case) else _number(key, case.measured(key)) for case in cases]
    if key == "order":
        numbers.append(float(all(map(bench.ends_apart, cases))))
    if key == "symplectic":
        numbers += [float(min(map(_columns_at_one_half, cases))), float(any(map(_tiny_single_step, cases)))]
    if key == "rest_penetration":
        numbers.append(float(any(map(_pushed_upright, cases))))
    if key == "friction_anisotropy":
        numbers.append(float(max(map(_directions, cases))))
        numbers.append(float(any(map(_pushed_in_the_air, cases))))
    if key == "tunnelling_speed":
        numbers.append(float(max(map(_starts, cases))))
    if key == "linear_damping":
        numbers.append(float(any(map(_short_free_steps, cases))))
    if key in _AT_DT:
        numbers.append(float(all(_at_dt(key, case) for case in cases)))
    if key == "deterministic":
        numbers.append(float(max(map(bench.repeated, cases))))
    return tuple(numbers)


def _number(key, value):
    if isinstance(value, bool | np.bool_):
        return float(value)
    if value is None or not isinstance(value, int | float | np.number):
        return -1e3 if value is None else -2e3
    number = kit.in_range(value)
    if key not in _NEAR:
        return round(number, 3)
    least, equal = _NEAR[key]
    if abs(number) > 1e12:
        return math.copysign(3e3, number)
    return round(math.asinh(number / least) / equal * kit.SAME, 9)


def _columns_at_one_half(case):
    """From how many starts a single step of the spring was taken at h omega = 0.5; two are enough."""
    starts = {
        (q0, v0)
        for scene, q0, v0, h, n, _ in case.runs
        if scene == "spring" and n == 1 and math.isclose(h * case.box.omega, 0.5, rel_tol=1e-6)
    }
    return min(2, len(starts))


def _tiny_single_step(case):
    """Whether a single step of the spring was far smaller than asked for."""
    return any(
        scene == "spring" and n == 1 and h * case.box.omega < 0.04 for scene, _, _, h, n, _ in case.runs
    )


def _pushed_upright(case):
    """Whether a body on the floor was pushed up or down, and not sideways."""
    return any(scene == "floor" and force[2] and not any(force[:2]) for scene, *_, force in case.runs)


def _directions(case):
    """How the body on the floor was pushed: 0 never, 1 along the axes and diagonals, 2 askew as well, 3 along
    one axis or both, and not along a diagonal."""
    pushes = [
        sorted(map(abs, force[:2])) for scene, *_, force in case.runs if scene == "floor" and any(force)
    ]
    askew = any(1e-3 * most < least < 0.999 * most for least, most in pushes)
    if pushes and not any(least > 1e-3 * most for least, most in pushes):
        return 3
    return 2 if askew else min(1, len(pushes))


def _pushed_in_the_air(case):
    """Whether a body was pushed where it lay, or flew, higher than any engine holds it."""
    return any(
        scene == "floor" and any(force) and q0[2] > case.box.radius + 5e-3
        for scene, q0, _, _, _, force in case.runs
    )


def _starts(case):
    """From how many places, at most, a body was shot at the wall at one speed; two are several."""
    starts = {}
    for scene, q0, v0, *_ in case.runs:
        if scene == "wall" and abs(v0[0]) > 2.5:
            starts.setdefault(v0, set()).add(q0)
    return min(2, max(map(len, starts.values()), default=0))


def _short_free_steps(case):
    """Whether a free body was run with steps that are short enough."""
    return any(scene == "free" and h < 0.09 * case.box.dt for scene, _, _, h, _, _ in case.runs)


#: Which runs were made for a key that is defined at dt: (scene, whether a run counts).
_AT_DT = {
    "friction_anisotropy": ("floor", lambda v0, force: any(force)),
    "rest_penetration": ("floor", lambda v0, force: not any(force)),
    "tunnelling_speed": ("wall", lambda v0, force: abs(v0[0]) > 2.5),
}


def _at_dt(key, case):
    """Whether every run that was made for the key had steps of dt."""
    where, counts = _AT_DT[key]
    return all(
        math.isclose(h, case.box.dt, rel_tol=1e-6)
        for scene, _, v0, h, _, force in case.runs
        if scene == where and counts(v0, force)
    )


# -- choose_engine ----------------------------------------------------------------------------------------

_NAMES = ("mujoco", "kifo", "ode", "zaru", "balsa")
_KEYS = ("order", "noise_db", "symplectic", "limit")


def _choices():
    """Small reports and requirements, made of few values, so that limits are met exactly, values are
    missing, None, zero or False, equal numbers are of different types, costs zero or nearly the same, two
    requirements about one key, and any slip in a requirement or in the choice shows somewhere."""
    rng = np.random.default_rng(27)
    values = {
        "order": (0, 1, 2, 4, None),
        "noise_db": (0.0, 55.0, 60.0, 60.3, None),
        "symplectic": (True, False),
        "limit": (0.0, 0.5, 1.5, math.inf),
    }
    prices = ([1.0, 1.5, 1.7, 4.0, 9.0], [0.0, 1.5, 1.7, 4.0, 9.0], [2.0, 2.0 + 1e-9, 2.3, 2.32, 9.0])
    asked = []
    for number in range(150):
        costs = rng.permutation(prices[number % 3]).tolist()
        reports = {}
        for name, cost in zip(rng.permutation(_NAMES).tolist(), costs, strict=True):
            kept = [key for key in _KEYS if rng.random() < 0.85]
            picked = {key: _another(values[key][int(rng.integers(len(values[key])))]) for key in kept}
            reports[name] = {**picked, "cost": cost}
        needs = []
        for key in rng.permutation(_KEYS)[: int(rng.choice([0, 1, 1, 2, 2, 3]))].tolist():
            known = [value for value in values[key] if value is not None]
            ops = ("==",) if key == "symplectic" else ("<=", ">=", "==")
            op, value = ops[int(rng.integers(len(ops)))], known[int(rng.integers(len(known)))]
            if key in ("order", "symplectic") and rng.random() < 0.5:
                value = float(value)  # True and 2 equal 1.0 and 2.0
            needs.append({"key": key, "op": op, "value": value})
        if needs and number % 5 == 0:
            # Two about one key, of which either may come first.
            needs.insert(0 if number % 10 else len(needs), {**needs[0], "op": ">=", "value": 0})
        asked.append((reports, needs))
    close = {"kifo": {"limit": 1.5, "cost": 1.0}, "zaru": {"limit": 0.5, "cost": 2.0}}
    close["ode"] = {"limit": 2.5, "cost": 3.0}
    for op, past in (("<=", 0.0), (">=", 2.0), ("==", 0.0), ("==", 2.0)):
        asked.append((close, [{"key": "limit", "op": op, "value": math.nextafter(1.5, past)}]))
    dear = [
        ({name: {**report, "cost": 1e14 * report["cost"]} for name, report in reports.items()}, needs)
        for reports, needs in asked[:10]
    ]
    return [*asked, *dear]


def _another(value):
    """An equal number, and of those with decimals another object, as in a student's process."""
    return float(repr(value)) if isinstance(value, float) else value


QUESTIONS = {"choose_engine": _choices(), "engine_facts": []}
ASK = {TASK: _characterise}
