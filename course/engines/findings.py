"""The results of a comparison in sentences, each made only from its rows."""

import math
import statistics
from collections.abc import Callable, Iterable, Sequence
from typing import TypeVar

from course.engines.registry import ENGINES
from course.engines.results import DEFAULT, TUNED, Row, Setting
from course.engines.scenarios import DT, IMPACTS, SCENARIOS

T = TypeVar("T")
#: Two engines whose energies agree to this fraction after ten seconds of chaos use the same algorithm: in
#: double precision MuJoCo, Bullet 3 and DART agree to 1e-10, and PhysX in single precision to 1 %.
_SAME = 1e-6
#: Errors below these say nothing about a slope: a thousand steps of round-off in single precision; in double
#: precision, the error of the pendulum's reference itself.
_FLOOR_SINGLE, _FLOOR_DOUBLE = 2e-4, 1e-11


def findings(rows: Sequence[Row]) -> tuple[str, ...]:
    """All sentences, in reading order."""
    usable = [row for row in rows if row.ok]
    said = (fingerprints(usable), same_algorithm(usable), defaults(usable), phases(usable), chaos(usable))
    return tuple(sentence for sentence in said if sentence)


def _of(rows: Iterable[Row], scenario: str, setting: Setting) -> dict[str, Row]:
    """The rows of a scenario by engine; measured rows come before those of the reference."""
    found: dict[str, Row] = {}
    for row in rows:
        if row.scenario == scenario and row.setting == setting and math.isclose(row.dt, DT):
            found.setdefault(row.engine, row)
    return found


def fingerprints(rows: Iterable[Row]) -> str:
    """Which velocity each engine moves a body with, by the free fall: its error times the number of steps.

    The new one: velocity-first Euler does that, and so do implicit methods of first order.
    """
    kinds: dict[str, list[str]] = {}
    for engine, row in _of(rows, "free-fall", TUNED).items():
        share = (row.value or 0.0) / 100.0 * row.details.get("steps", 0)
        if abs(share - 1.0) < 0.02:
            kind = "the new one"
        elif abs(share + 1.0) < 0.02:
            kind = "the old one"
        elif 0.0 < share < 0.9:
            kind = f"the new one in each of {round(1.0 / share)} substeps"
        else:
            continue
        kinds.setdefault(kind, []).append(ENGINES[engine].name)
    if not kinds:
        return ""
    parts = "; ".join(f"{kind}: {_list(names)}" for kind, names in kinds.items())
    return f"The free fall shows with which velocity an engine moves a body. {parts[0].upper()}{parts[1:]}."


def same_algorithm(rows: Iterable[Row]) -> str:
    """Engines whose double pendulum ends with the same energy, start by start."""
    rows = list(rows)
    ends = [
        (ENGINES[engine].name, row.details.get("at_the_end_percent", []))
        for setting in (DEFAULT, TUNED)
        for engine, row in _of(rows, "double-pendulum", setting).items()
    ]
    same = [names for names, _ in grouped(ends, _agree) if len(names) > 1]
    if not same:
        return ""
    return (
        "Same algorithm, same number: ten seconds of a chaotic swing end with the same energy, start "
        f"by start, in {'; and in '.join(_list(names) for names in same)}."
    )


def grouped(found: Iterable[tuple[str, T]], alike: Callable[[T, T], bool]) -> list[tuple[list[str], T]]:
    """Names in groups, each with what its first one has: a name joins the first group that is like it."""
    groups: list[tuple[list[str], T]] = []
    for name, thing in found:
        names = next((names for names, known in groups if alike(known, thing)), None)
        if names is None:
            groups.append(([name], thing))
        elif name not in names:
            names.append(name)
    return groups


def _agree(one: Sequence[float], other: Sequence[float]) -> bool:
    return len(one) == len(other) > 0 and all(
        math.isclose(a, b, rel_tol=_SAME) for a, b in zip(one, other, strict=True)
    )


def defaults(rows: Sequence[Row]) -> str:
    """In how many scenarios one engine's options changed its result by more than well-set engines differ.

    With several phases or starts, the gap between the two ranges must be wider than the range of all well-set
    engines, so that the effect of a phase is not attributed to an option.
    """
    beyond, compared = [], 0
    for scenario in SCENARIOS.values():
        if scenario.truth is None or not math.isfinite(scenario.truth):
            continue
        default, tuned = (_of(rows, scenario.id, setting) for setting in (DEFAULT, TUNED))
        both = [engine for engine in default if engine in tuned]
        if len(both) < 2:
            continue
        compared += 1
        moved = max(_gap(default[engine], tuned[engine]) for engine in both)
        apart = max(tuned[e].highest for e in both) - min(tuned[e].lowest for e in both)
        if moved > apart:
            beyond.append(scenario.id)
    if not beyond:
        return ""
    return (
        f"Defaults are part of the model: in {len(beyond)} of {compared} scenarios ({', '.join(beyond)}) "
        "options move one engine, at every phase of the step, further than all well-set engines spread."
    )


def _gap(one: Row, other: Row) -> float:
    """How far apart the ranges of two rows are; 0 where they meet."""
    return max(0.0, one.lowest - other.highest, other.lowest - one.highest)


def phases(rows: Sequence[Row]) -> str:
    """The impact that depends most on its moment within a step, among the well-set engines."""
    impacts = [scenario for scenario in SCENARIOS.values() if scenario.id in IMPACTS and scenario.truth]
    wide = [
        ((row.highest - row.lowest) / (scenario.truth or 1.0), scenario, row)
        for scenario in impacts
        for row in _of(rows, scenario.id, TUNED).values()
        if len(row.samples) > 1
    ]
    if not wide:
        return ""
    share, scenario, row = max(wide, key=lambda one: one[0])
    if share < 0.05:
        return ""
    low, high = (f"{value:.{scenario.digits}f}" for value in (row.lowest, row.highest))
    return (
        f"One impact is one phase of the step: well set, {ENGINES[row.engine].name} gives between {low} and "
        f"{high} {scenario.unit} in {scenario.id}, depending on where in a step the ball arrives. So impacts "
        "are compared by their mean over phases."
    )


def chaos(rows: Iterable[Row]) -> str:
    """How much the double pendulum's answer depends on two degrees of the start."""
    widest: tuple[float, str, list[float]] | None = None
    for engine, row in _of(rows, "double-pendulum", TUNED).items():
        ends = row.details.get("at_the_end_percent", [])
        if len(ends) > 1 and (widest is None or max(ends) - min(ends) > widest[0]):
            widest = (max(ends) - min(ends), ENGINES[engine].name, ends)
    if widest is None or widest[0] < 1.0:
        return ""
    _, name, ends = widest
    return (
        f"Never rank engines on one chaotic run: well set, {name} ends with between {min(ends):+.1f} and "
        f"{max(ends):+.1f} % of energy gained or lost, depending on two degrees of the start."
    )


def slope(points: Sequence[tuple[float, float]], *, single: bool) -> float | None:
    """The order that errors show: the slope of log error over log step, by least squares.

    Args:
        points: (step in s, error as a share); errors at the level of round-off are left out.
        single: they were computed in single precision.
    """
    floor = _FLOOR_SINGLE if single else _FLOOR_DOUBLE
    used = [(math.log(dt), math.log(abs(error))) for dt, error in points if abs(error) > floor]
    if len(used) < 3:
        return None
    return statistics.linear_regression(*zip(*used, strict=True)).slope


def _list(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
