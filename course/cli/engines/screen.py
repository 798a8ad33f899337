"""A comparison on the screen: one table for each scenario, the truth in its first column."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

from course.cli.frame.console import Console
from course.engines.registry import ENGINES
from course.engines.results import DEFAULT, TUNED, Comparison, Row, Setting
from course.engines.scenarios import BOXES, SCENARIOS, Scenario

_STATUS = {
    "not_installed": "not installed",
    "unavailable": "cannot start",
    "crash": "crashed",
    "deadline": "no answer in time",
    "diverged": "not a number",
    "not_applicable": "does not apply",
    "failed": "failed",
}


def show(console: Console, comparison: Comparison, findings: Sequence[str]) -> None:
    best = best_rows(comparison.rows)
    for scenario in SCENARIOS.values():
        rows = [row for row in comparison.rows if row.scenario == scenario.id]
        if rows:
            _scenario(console, scenario, rows, best)
    _troubles(console, comparison)
    _origins(console, comparison)
    if findings:
        console.heading("What this shows")
        for sentence in findings:
            console.item("-", sentence) if console.fancy else console.line(f"- {sentence}", indent=2)


def _scenario(console: Console, scenario: Scenario, rows: Sequence[Row], best: frozenset[int]) -> None:
    if not console.quiet:
        console.heading(scenario.title, scenario.id)
        console.line((scenario.question, "dim"))
        console.line(f"Measured: {scenario.quantity}.")
    steps = sorted({row.dt for row in rows}, reverse=True)
    lines = []
    for dt in steps:
        for engine, origin in _lines(row for row in rows if row.dt == dt):
            cells = {
                row.setting: _cell(scenario, row, best)
                for row in rows
                if row.engine == engine and row.dt == dt and (row.origin == "reference") == origin
            }
            name = ENGINES[engine].name + (", reference" if origin else "")
            step = [_step(dt)] if len(steps) > 1 else []
            lines.append(
                (_truth(scenario), name, *step, cells.get(DEFAULT, ""), _tuned(cells, rows, engine, dt))
            )
    heads = ("Truth", "Engine", *(["Step"] if len(steps) > 1 else []), "As it comes", "Well set")
    console.table(heads, lines)
    if console.plain and not console.quiet:
        console.blank()


def _tuned(cells: Mapping[Setting, str], rows: Sequence[Row], engine: str, dt: float) -> str:
    """The well-set result of the engine; a word where it has nothing to set."""
    tuned = next((r for r in rows if (r.engine, r.setting, r.dt) == (engine, TUNED, dt) and r.ok), None)
    default = next((r for r in rows if (r.engine, r.setting, r.dt) == (engine, DEFAULT, dt) and r.ok), None)
    same = tuned is not None and default is not None and not tuned.options
    text = cells.get(TUNED, "")
    if same and text:
        return "the same, best" if text.endswith("best") else "the same"
    return "" if text == cells.get(DEFAULT) and not any(letter.isdigit() for letter in text) else text


def _lines(rows: Iterable[Row]) -> list[tuple[str, bool]]:
    """(engine, from the reference) in order; an engine that has a reference is not listed as missing too."""
    found = dict.fromkeys((row.engine, row.origin == "reference") for row in rows)
    return [key for key in found if key[1] or (key[0], True) not in found]


def best_rows(rows: Sequence[Row]) -> frozenset[int]:
    """Which rows, by ``id``, come nearest the truth in their column; ties are all best.

    A column is a scenario, a step and a setting. The reference does not compete: it comes from another
    machine, and the best row should have been measured on this one.
    """
    columns: dict[tuple[str, float, str], list[Row]] = {}
    for row in rows:
        if row.ok and row.origin != "reference":
            columns.setdefault((row.scenario, row.dt, row.setting), []).append(row)
    best: set[int] = set()
    for (scenario_id, _dt, _setting), column in columns.items():
        scenario = SCENARIOS[scenario_id]
        if len(column) < 2:
            continue
        distance = [_distance(scenario, row) for row in column]
        nearest, first = min(zip(distance, column, strict=True), key=lambda pair: pair[0])
        # Values that look equal on the screen share a rank, and so do those within the spread of phases or
        # starts.
        slack = max(0.5 * 10.0**-scenario.digits, 0.5 * (first.highest - first.lowest))
        if scenario.better == "large":
            slack = 1e-9
        best |= {id(row) for row, far in zip(column, distance, strict=True) if far - nearest <= slack}
    return frozenset(best)


def _distance(scenario: Scenario, row: Row) -> float:
    value = row.value or 0.0
    return -value if scenario.better == "large" else abs(value - (scenario.truth or 0.0))


def _truth(scenario: Scenario) -> str:
    if scenario.truth is None:
        return "none"
    if not math.isfinite(scenario.truth):
        return "any step" if scenario.unit == "ms" else "any speed"
    return _unit(f"{scenario.truth:g}", scenario)


def _cell(scenario: Scenario, row: Row, best: frozenset[int]) -> str:
    if not row.ok or row.value is None:
        return _STATUS[row.status]
    text = number(scenario, row.value)
    if rate := row.details.get("steps_per_second"):
        text = f"{text}, {_rate(rate)}"
    elif row.value in (row.details.get("fastest_tried_m_s"), row.details.get("longest_tried_ms")):
        text += ", all"
    if row.highest - row.lowest >= 10.0**-scenario.digits:
        text += f" ({_short(row.lowest)} to {_short(row.highest)})"
    elif row.repeats > 1 and row.spread and scenario.id != BOXES:
        text += f" ± {0.5 * row.spread:.1g}"
    return text + (" best" if id(row) in best else "")


def number(scenario: Scenario, value: float) -> str:
    """A value with its unit."""
    return _unit(_digits(scenario, value), scenario)


def _digits(scenario: Scenario, value: float) -> str:
    """A value: signed where the truth is zero, and never "0" for a number that is not zero."""
    sign = "+" if scenario.truth == 0.0 and scenario.unit == "%" else ""
    size = abs(value)
    if size >= 1000:
        return f"{value:{sign}.4g}" if size >= 1e5 else f"{value:{sign}.0f}"
    if 0.0 < size < 0.5 * 10.0**-scenario.digits:
        return f"{value:{sign}.0e}"
    return f"{value + 0.0:{sign}.{scenario.digits}f}"


def _short(value: float) -> str:
    """Three digits, for the ends of a range."""
    size = abs(value)
    digits = 2 - math.floor(math.log10(size)) if size >= 1e-3 else 0
    return f"{value + 0.0:.{max(0, digits)}f}"


def _rate(rate: float) -> str:
    return f"{rate:.0f}/s" if rate < 1000 else f"{rate / 1000:.1f}k/s"


def _unit(text: str, scenario: Scenario) -> str:
    return text if scenario.unit == "1" else f"{text}{'' if scenario.unit == 'x' else ' '}{scenario.unit}"


def _step(dt: float) -> str:
    rate = 1.0 / dt
    return f"1/{rate:.0f} s" if math.isclose(rate, round(rate), rel_tol=1e-6) else f"{dt:g} s"


def _troubles(console: Console, comparison: Comparison) -> None:
    """The rows without a number, and why; and the command that installs what is missing."""
    said: set[tuple[str, str]] = set()
    for row in comparison.rows:
        if row.status in ("ok", "not_installed", "not_applicable"):
            continue
        where = "" if row.status == "unavailable" else f" in {row.scenario} ({row.setting})"
        text = f"{ENGINES[row.engine].name} {_STATUS[row.status]}{where}: {row.message}"
        if (row.engine, text) not in said:
            said.add((row.engine, text))
            console.line(text)
    for state in comparison.engines:
        if state.version is None:
            command = f": {state.command}" if state.command else "."
            console.line(f"{state.name}: {state.missing}{command}")


def _origins(console: Console, comparison: Comparison) -> None:
    cached = sorted({row.measured for row in comparison.rows if row.origin == "cached"})
    console.note(("This machine: ", "bold"), str(comparison.machine))
    if cached:
        when = cached[0] if cached[0] == cached[-1] else f"{cached[0]} to {cached[-1]}"
        console.note(f"Remembered from {when}; --fresh measures again.")
    if comparison.reference is not None:
        console.note(
            ("Rows marked reference", "bold"), f" were not measured here: {comparison.reference.label}."
        )
    if comparison.quick:
        console.note("Quick: fewer starts, steps and repetitions; leave --quick out for the whole.")
