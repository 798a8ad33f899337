"""What wrong values of a report about floor and wall, and the runs behind them, have in common."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.scoring import kit

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Probe = Callable[[str, list[Any]], bool]

bench = kit.companion("engine-comparison", "bench")
probing = kit.companion("engine-comparison", "probing")

# -- floor and wall ---------------------------------------------------------------------------------------


def _pushed_at_once(_: str, cases: list[Any]) -> bool:
    """Every push on the floor began where the body just touches."""
    starts = [
        q0[2] - c.box.radius for c, (_, q0, _, _, _, force) in probing.runs(cases, "floor") if any(force)
    ]
    return bool(starts) and all(height > -1e-6 for height in starts)


def _pushed_in_the_air(key: str, cases: list[Any]) -> bool:
    """Every push of an engine with a wrong ratio began clearly above the floor, and one is wrong."""
    starts = [
        q0[2] - case.box.radius
        for case in cases
        if not probing.right(key, case)
        for _, (_, q0, _, _, _, force) in probing.runs([case], "floor")
        if any(force)
    ]
    return bool(starts) and min(starts) > _IN_THE_AIR


#: Further above the floor, m, than any engine here holds a body that rests on it.
_IN_THE_AIR = 5e-3


def _pushes(case: Any) -> list[float]:
    """How hard the body on the floor was pushed in each run, in units of mu m g; pushes alone."""
    weight = case.box.mu * case.box.mass * case.box.g
    return [math.hypot(*force[:2]) / weight for *_, force in case.runs if len(force) == 3 and any(force)]


def _pushed_softly(_: str, cases: list[Any]) -> bool:
    """No push was harder than mu m g."""
    pushes = [push for case in cases for push in _pushes(case)]
    return bool(pushes) and max(pushes) < 1.05


def _pushed_seldom(_: str, cases: list[Any]) -> bool:
    """Too few pushes for two forces between 0 and 5 mu m g to 3 %: that takes seven halvings each."""
    return all(0 < len(_pushes(case)) < 14 for case in cases)


def _pushed_less(key: str, cases: list[Any]) -> bool:
    """In each direction the last pushes of engines with a wrong ratio were weaker than slides them."""

    def looks(case: Any) -> bool:
        last = {}
        for *_, force in case.runs:
            if len(force) == 3 and any(force[:2]):
                x, y = abs(force[0]), abs(force[1])
                last[min(x, y) > 0.5 * max(x, y)] = math.hypot(x, y)
        straight = case.box.mu * case.box.grip * case.box.mass * case.box.g
        needed = {False: straight, True: case.truth[key] * straight}
        return all(push < 0.9 * needed[diagonal] for diagonal, push in last.items())

    return all(looks(case) for case in cases if not probing.right(key, case))


def _seen_moving(key: str, cases: list[Any]) -> bool:
    """Each wrong depth was that of a sample in a run at dt without a force, in which the body still moved."""
    wrong = [case for case in cases if not probing.right(key, case)]
    return all(_passed_by(case, case.measured(key), own_step=True) for case in wrong)


def _seen_at_other_step(key: str, cases: list[Any]) -> bool:
    """Each wrong depth was that of a sample in a run without a force, with another step than dt."""
    wrong = [case for case in cases if not probing.right(key, case)]
    return all(_passed_by(case, case.measured(key), own_step=False) for case in wrong)


def _passed_by(case: Any, depth: float, *, own_step: bool) -> bool:
    quiet = dataclasses.replace(case.box, jitter=0.0)
    runs = [run for _, run in probing.runs([case], "floor") if not any(run[5])]
    runs = [run for run in runs if math.isclose(run[3], case.box.dt, rel_tol=1e-6) == own_step]
    for run in runs[:_MOST_SEEN]:
        q, v = quiet.run(*run)
        seen = np.abs(case.box.radius - q[1:, 2] - depth) < 1e-9 + 1e-6 * depth
        if depth > 0 and np.any(seen & ((np.abs(v[1:, 2]) > _AT_REST) | (not own_step))):
            return True
    return False


#: Runs of an engine that are made again, to look at what they showed.
_MOST_SEEN = 20
#: A body that sinks in by a millimetre or more and is off by 3 % moves faster, m/s: it comes to rest within
#: seconds. One that has come to rest moves by rounding alone.
_AT_REST = 1e-7


def _upright(sideways: bool) -> Probe:
    """Bodies on the floor were pushed up or down, in runs with a push along the floor, too, or without."""

    def probe(_: str, cases: list[Any]) -> bool:
        return any(
            abs(force[2]) > 1e-6 * math.hypot(*force) and (math.hypot(*force[:2]) > 0) == sideways
            for _, (_, _, _, _, _, force) in probing.runs(cases, "floor")
        )

    return probe


def _other_step(scene: str, counts: Callable[[Any], bool] = lambda _: True) -> Probe:
    """Every run of that kind was made with another step than the engine's own."""

    def probe(_: str, cases: list[Any]) -> bool:
        steps = [
            math.isclose(run[3], c.box.dt, rel_tol=1e-6)
            for c, run in probing.runs(cases, scene)
            if counts(run)
        ]
        return bool(steps) and not any(steps)

    return probe


def _no_hit(key: str, cases: list[Any]) -> bool:
    """Of each engine with a wrong ratio, no run at 2 m/s took the body to the wall."""

    def missed(case: Any) -> bool:
        quiet = dataclasses.replace(case.box, jitter=0.0)
        runs = [run for _, run in probing.runs([case], "wall") if 1.9 < run[2][0] < 2.1]
        return bool(runs) and all(np.min(quiet.run(*run)[1]) > 0 for run in runs[:_MOST_SEEN])

    return all(missed(case) for case in cases if not probing.right(key, case))


def _from_afar(_: str, cases: list[Any]) -> bool:
    """Runs at the wall with 2 m/s began half a metre away or more, and no run at all began nearer."""
    starts = [
        abs(q0[0]) - c.box.radius
        for c, (_, q0, v0, _, _, _) in probing.runs(cases, "wall")
        if 1.99 < abs(v0[0]) < 2.6 and abs(q0[0]) > 0
    ]
    nearest = [abs(q0[0]) - c.box.radius for c, (_, q0, *_) in probing.runs(cases, "wall") if abs(q0[0]) > 0]
    return bool(starts) and min(nearest) > 0.5


def _too_fast(key: str, cases: list[Any]) -> bool:
    """No body was sent at 2 m/s, and wrong values are what a faster one keeps, of engines whose wall no body
    leaves faster than some speed. On the way it may lose a little more."""
    if any(abs(abs(v0[0]) - 2) < 0.02 for _, (_, _, v0, *_) in probing.runs(cases, "wall")):
        return False

    def looks(case: Any) -> bool:
        speeds = {abs(v0[0]) for _, (_, _, v0, *_) in probing.runs([case], "wall") if abs(v0[0]) > 2.5}
        kept = [case.box.bounce_most / speed for speed in speeds]
        return any(0.97 * share <= case.measured(key) <= 1.2 * share for share in kept)

    return all(looks(case) for case in cases if not probing.right(key, case))


def _shots(cases: list[Any]) -> Iterator[tuple[Any, Any]]:
    """(case, run) of every run at the wall that is too fast for a measurement of the restitution."""
    return ((case, run) for case, run in probing.runs(cases, "wall") if abs(run[2][0]) > 2.5)


#: As many shots an engine, or more, are a search for a speed; fewer measured something else.
_SHOTS = 5


def _elsewhere(_: str, cases: list[Any]) -> bool:
    """Most shots began elsewhere than they should: from one step before -1 to -1."""
    places = [-1 - 1.01 * v0[0] * c.box.dt <= q0[0] <= -0.99 for c, (_, q0, v0, _, _, _) in _shots(cases)]
    return len(places) >= _SHOTS * len(cases) and sum(places) < 0.5 * len(places)


def _speeds_apart(key: str, cases: list[Any]) -> bool:
    """Each wrong speed is too low, and the next one that was tried is beyond the right one."""

    def apart(case: Any) -> bool:
        value = case.measured(key)
        following = [run[2][0] for _, run in _shots([case]) if run[2][0] > 1.0001 * value]
        return bool(value < case.truth[key] <= min(following, default=0.0))

    return all(apart(case) for case in cases if not probing.right(key, case))


def _short_runs(_: str, cases: list[Any]) -> bool:
    """Most shots are over before the body has gone as far as it should, at the speed of its start."""
    ends = [n * h * v0[0] < 1.9 for _, (_, _, v0, h, n, _) in _shots(cases)]
    return len(ends) >= _SHOTS * len(cases) and sum(ends) > 0.5 * len(ends)


def _spread(cases: list[Any]) -> list[tuple[int, float]]:
    """For each speed: from how many places, and over which share of the way of a step."""
    starts: dict[Any, set[float]] = {}
    for case, (_, q0, v0, *_) in _shots(cases):
        starts.setdefault((case.box.dt * abs(v0[0]), v0), set()).add(q0[0])
    return [(len(places), (max(places) - min(places)) / step) for (step, _), places in starts.items()]


def _narrow(_: str, cases: list[Any]) -> bool:
    """Where a speed was tried from five places or more, they lay within less than two thirds of a step."""
    shares = [share for count, share in _spread(cases) if count >= 5]
    return bool(shares) and float(np.median(shares)) < 0.65


def _one_start(_: str, cases: list[Any]) -> bool:
    """Hardly any speed was tried from more than one place, and that place was not looked for beforehand, in
    the scene "free"."""
    looked = {(case.name, v0) for case, (_, _, v0, *_) in probing.runs(cases, "free")}
    shots = {(case.name, run[2]) for case, run in _shots(cases)}
    return (
        _share_of_speeds(cases, bool) > 0
        and _share_of_speeds(cases, lambda places: len(places) > 1) <= 0.2
        and len(shots & looked) < 0.5 * len(shots)
    )


def _several_starts(_: str, cases: list[Any]) -> bool:
    """Most speeds were tried from several places, that lie over the way of a step."""
    shares = [share for count, share in _spread(cases) if count > 1]
    most = max((count for count, _ in _spread(cases)), default=0)
    return (
        most < _ENOUGH
        and len(shares) > 0
        and 2 * len(shares) >= len(_spread(cases))
        and float(np.median(shares)) > 0.45
    )


#: With so many starts for a speed, the result is uncertain by 4 %, which is good enough.
_ENOUGH = 25


def _reported_unsafe(key: str, cases: list[Any]) -> bool:
    """Each wrong speed is one, or is above one, at which a body was seen to get through."""
    return all(bench.unsafe(case, 1.0) for case in cases if not probing.right(key, case))


def _share_of_speeds(cases: list[Any], looks: Callable[[set[Any]], bool]) -> float:
    starts: dict[Any, set[Any]] = {}
    for case, (_, q0, v0, *_) in probing.runs(cases, "wall"):
        starts.setdefault((case.name, v0), set()).add(q0)
    return sum(map(looks, starts.values())) / max(1, len(starts))


def _too_high(most: float) -> Probe:
    """Wrong values are too high, and up to so many times the right ones."""

    def probe(key: str, cases: list[Any]) -> bool:
        wrong = [case for case in cases if not probing.right(key, case)]
        return all(case.truth[key] < case.measured(key) <= most * case.truth[key] for case in wrong)

    return probe


#: key: (code, probe), the first that speaks is heard.
PROBES: dict[str, list[tuple[str, Probe]]] = {
    "friction_anisotropy": [
        ("PUSHED_IN_THE_AIR", _pushed_in_the_air),
        ("ANISOTROPY_ASSUMED", lambda key, cases: all(case.measured(key) == 1 for case in cases)),
        ("FORCE_UP_OR_DOWN", _upright(sideways=True)),
        ("OTHER_STEP_THAN_DT", _other_step("floor", lambda run: any(run[5]))),
        ("PUSHED_TOO_SOFTLY", _pushed_softly),
        ("PUSHED_TOO_SELDOM", _pushed_seldom),
        (
            "CREEP_TAKEN_FOR_SLIP",
            probing.both(
                probing.where(probing.creeps, lambda value, _: not math.isfinite(value) or 0.9 < value < 1.1),
                _pushed_less,
            ),
        ),
        ("NOT_SETTLED", probing.both(probing.where(probing.soft), _pushed_at_once)),
    ],
    "rest_penetration": [
        ("FORCE_UP_OR_DOWN", _upright(sideways=False)),
        ("OTHER_STEP_THAN_DT", _other_step("floor", lambda run: not any(run[5]))),
        ("OTHER_STEP_THAN_DT", probing.both(probing.where(probing.soft), _seen_at_other_step)),
        ("PENETRATION_TOO_EARLY", probing.both(probing.where(probing.soft), _seen_moving)),
    ],
    "restitution": [
        (
            "RESTITUTION_OTHER_SPEED",
            probing.where(lambda c: c.box.bounce_threshold > 0, lambda value, _: value == 0),
        ),
        ("RESTITUTION_TOO_FAST", _too_fast),
        ("RESTITUTION_NO_HIT", _no_hit),
        ("STOPPED_BODY_OVERLOOKED", probing.where(lambda c: c.truth["restitution"] == 0)),
        (
            "RESTITUTION_WITH_DRAG",
            probing.both(probing.where(probing.damped, lambda value, t: value < t), _from_afar),
        ),
    ],
    "tunnelling_speed": [
        ("OTHER_STEP_THAN_DT", _other_step("wall", lambda run: abs(run[2][0]) > 2.5)),
        ("TUNNEL_START_ELSEWHERE", _elsewhere),
        (
            "TUNNEL_NO_INFINITY",
            probing.where(probing.endless("tunnelling_speed"), lambda value, _: value >= 0),
        ),
        ("TUNNEL_UNSAFE_REPORTED", lambda _, cases: any(map(bench.unsafe, cases))),
        ("TUNNEL_SPEEDS_APART", _speeds_apart),
        ("TUNNEL_RUNS_SHORT", _short_runs),
        ("TUNNEL_ONE_START", probing.both(_too_high(math.inf), _one_start)),
        ("TUNNEL_STARTS_NARROW", probing.both(_too_high(math.inf), _narrow)),
        ("TUNNEL_FEW_STARTS", probing.both(_too_high(1.5), _several_starts)),
        ("TUNNEL_UNSAFE_REPORTED", _reported_unsafe),
        ("TUNNEL_NEVER_SEEN", probing.some_infinite),
    ],
}
