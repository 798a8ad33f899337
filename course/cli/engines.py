"""``course engines``: which real engines this machine has, and the same scenarios in each of them."""

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import msgspec

from course.cli.frame import here
from course.cli.frame.console import Console, current, meter
from course.cli.frame.options import engine_ids, option, scenario_ids
from course.cli.frame.registry import COMMANDS, group
from course.cli.frame.replies import Envelope, WrittenFile, filled
from course.engines import compare as comparing
from course.engines.findings import findings
from course.engines.registry import ENGINES
from course.engines.results import DEFAULT, TUNED, Comparison, EngineState, Row, Setting
from course.engines.scenarios import BOXES, SCENARIOS, Scenario
from course.errors import MissingCapabilityError, UsageError

# ---
# The replies of ``course engines ... --json``, as types.


class EngineScenario(msgspec.Struct, frozen=True, kw_only=True):
    """One scenario; ``truth`` is None where nothing is true or false, "inf" for "any speed"."""

    id: str
    title: str
    question: str
    quantity: str
    unit: str
    truth: float | None
    source: str


class EngineList(Envelope, tag="course.engines-list/1", frozen=True, kw_only=True):
    engines: tuple[EngineState, ...]
    scenarios: tuple[EngineScenario, ...]


class EngineMachine(msgspec.Struct, frozen=True, kw_only=True):
    """Where and, for the reference, when it was measured."""

    cpu: str
    system: str
    cores: int
    python: str
    measured: str = ""


class EngineRow(msgspec.Struct, frozen=True, kw_only=True):
    """One engine in one scenario.

    ``setting`` is "default" or "tuned"; ``origin`` "measured", "cached" or "reference" (another machine).
    ``status`` is "ok" or why there is no value: not_installed, unavailable, crash, deadline, diverged,
    not_applicable, failed. ``samples`` are what ``value`` is the mean or median of: one for each phase of the
    step or each start. ``best`` marks what is nearest the truth among those measured on this machine.
    """

    engine: str
    version: str
    scenario: str
    setting: str
    dt: float
    status: str
    value: float | None
    truth: float | None
    error: float | None
    unit: str
    best: bool
    origin: str
    measured: str
    repeats: int
    spread: float
    message: str
    options: dict[str, Any]
    why: tuple[str, ...]
    samples: tuple[float, ...]
    details: dict[str, Any]


class Engines(Envelope, tag="course.engines/1", frozen=True, kw_only=True):
    """One comparison. ``reference`` is None unless rows of it are shown."""

    machine: EngineMachine
    reference: EngineMachine | None
    quick: bool
    engines: tuple[EngineState, ...]
    scenarios: tuple[EngineScenario, ...]
    rows: tuple[EngineRow, ...]
    findings: tuple[str, ...]
    plots: tuple[WrittenFile, ...] = ()
    csv: WrittenFile | None = None


# ---
# The files that ``course engines compare`` writes, and its rows as data.


#: Of the table: what is a single value.
_COLUMNS = [one for one in EngineRow.__struct_fields__ if one not in {"options", "why", "samples", "details"}]


app = group(COMMANDS["engines"].summary)

#: The longest and the shortest step that make sense in the scenarios, s.
_LONGEST, _SHORTEST = 0.02, 1e-4


@app.command("list", epilog="Example: course engines list")
def list_engines() -> int:
    """List the engines and the scenarios.

    Each installed engine is started once, in a process of its own, to see whether it runs. For each missing
    engine the list shows the command that installs it.
    """
    console = current()
    with console.working("Starting each engine"):
        states = tuple(comparing.state_of(info, probe=True) for info in ENGINES.values())
    console.heading("Engines")
    for state in states:
        version = f"{state.package} {state.version}" if state.version else "not installed"
        console.item(state.id, f"{state.name}; {version}; {state.licence}; {state.about}", width=8)
        if not state.usable:
            console.line(f"{state.missing}{f': {state.command}' if state.command else '.'}", indent=12)
    console.heading("Scenarios")
    for scenario in SCENARIOS.values():
        console.item(scenario.id, f"{scenario.title}. {scenario.question}", width=15)
    console.note(("Next: course engines compare --quick", "bold"))
    return console.answer(EngineList(engines=states, scenarios=_scenarios(SCENARIOS)))


@app.command(epilog="Example: course engines compare --engine mujoco --engine ode --scenario bounce --quick")
def compare(
    engine: Annotated[
        list[str] | None, option("--engine E", "Only this one; repeatable.", engine_ids)
    ] = None,
    scenario: Annotated[
        list[str] | None, option("--scenario S", "Only this one; repeatable.", scenario_ids)
    ] = None,
    dt: Annotated[list[str] | None, option("--dt STEP", "Step in s, as 0.005 or 1/240; repeatable.")] = None,
    repeat: Annotated[
        int, option("--repeat", "Repeat each measurement; show the spread.", min=1, max=100)
    ] = 1,
    quick: Annotated[bool, option("--quick", "Fewer starts, steps and repetitions.")] = False,
    fresh: Annotated[bool, option("--fresh", "Measure again; use no stored results.")] = False,
    plot: Annotated[Path | None, option("--plot FILE", "Write the figures: .png, .svg or .pdf.")] = None,
    csv: Annotated[Path | None, option("--csv FILE", "Write every number as a table.")] = None,
) -> int:
    """Run the same scenarios through every installed engine.

    Each engine runs in a process of its own; if one crashes or hangs, its line says so. For engines that are
    not installed, reference measurements are shown and marked. Exit code 4 if no engine could run.
    """
    console = current()
    plot = here.target(plot, "--plot", here.FORMATS) if plot else None
    csv = here.target(csv, "--csv", ("csv",)) if csv else None
    request = comparing.Request(
        tuple(engine or ()), tuple(scenario or ()), tuple(map(_step, dt or ())), repeat, quick, fresh
    )
    with meter(console) as progress:
        comparison = comparing.compare(request, progress)
    said = findings(comparison.rows)
    _show(console, comparison, said)
    best, numbers = best_rows(comparison.rows), []
    for row in comparison.rows:  # with its truth, its error and whether it is the best of its column
        scene = SCENARIOS[row.scenario]
        error = None if row.value is None else scene.error(row.value)
        numbers.append(filled(EngineRow, row, scene, error=error, best=id(row) in best))
    plots = _plotted(console, comparison, plot) if plot else ()
    table = None
    if csv:
        lines = ([getattr(row, column) for column in _COLUMNS] for row in numbers)
        table = here.write_told(csv, here.as_csv(_COLUMNS, lines), why="engines")
    code = 0 if comparison.ran else MissingCapabilityError.exit_code
    if code:
        none = "No engine could be run on this machine."
        if "not_applicable" in {row.status for row in comparison.rows}:
            none = "No engine that runs here can do what was asked."
        console.line((none, "bold"))
    shipped = comparison.reference
    return console.answer(
        Engines(
            exit_code=code,
            machine=filled(EngineMachine, comparison.machine),
            reference=filled(EngineMachine, shipped, shipped.machine) if shipped else None,
            quick=comparison.quick,
            engines=comparison.engines,
            scenarios=_scenarios(dict.fromkeys(row.scenario for row in comparison.rows)),
            rows=tuple(numbers),
            findings=said,
            plots=plots,
            csv=table,
        )
    )


def _plotted(console: Console, comparison: Comparison, plot: Path) -> tuple[WrittenFile, ...]:
    from course.figures.engines import render

    with console.working("Drawing"):
        pictures = render(comparison.rows, plot.suffix.lower().removeprefix("."))
    if not pictures:
        console.line("No figure: one of steps needs three values of --dt, one of speed boxes and stack.")
    to = {name: here.inserted(plot, name) for name in pictures}
    return tuple(here.write_told(to[name], picture, why="engines") for name, picture in pictures.items())


def _step(text: str) -> float:
    """A step from 0.005 or 1/240, s."""
    top, slash, bottom = text.partition("/")
    try:
        step = float(top) / (float(bottom) if slash else 1.0)
    except (ValueError, ZeroDivisionError):
        said = f"--dt {text}: this is not a step."
        raise UsageError(said, help="Give seconds, as 0.005 or 1/240.", code="bad_step") from None
    if not _SHORTEST <= step <= _LONGEST:
        problem = f"--dt {text}: the step is not between {_SHORTEST:g} and {_LONGEST:g} s."
        fix = "The scenarios last from half a second to ten seconds; 1/240 is usual."
        raise UsageError(problem, help=fix, code="bad_step")
    return step


def _scenarios(ids: Iterable[str]) -> tuple[EngineScenario, ...]:
    return tuple(filled(EngineScenario, SCENARIOS[name]) for name in ids)


# ---
# A comparison on the screen: one table for each scenario, the truth above it.


_STATUS = {
    "not_installed": "not installed",
    "unavailable": "cannot start",
    "crash": "crashed",
    "deadline": "no answer in time",
    "diverged": "not a number",
    "not_applicable": "does not apply",
    "failed": "failed",
}


def _show(console: Console, comparison: Comparison, findings: Sequence[str]) -> None:
    best = best_rows(comparison.rows)
    for scenario in SCENARIOS.values():
        rows = [row for row in comparison.rows if row.scenario == scenario.id]
        if rows:
            _scenario(console, scenario, rows, best)
    if best and not console.quiet:
        console.line("best: nearest the truth, or where more is better the most; ties within half its range.")
    said: dict[str, None] = {}
    for row in comparison.rows:  # those without a number, and why, each once
        if row.status not in ("ok", "not_installed", "not_applicable"):
            where = "" if row.status == "unavailable" else f" in {row.scenario} ({row.setting})"
            said[f"{ENGINES[row.engine].name} {_STATUS[row.status]}{where}: {row.message}"] = None
    for text in said:
        console.line(text)
    for state in comparison.engines:
        if state.version is None:
            console.line(f"{state.name}: {state.missing}{f': {state.command}' if state.command else '.'}")
    _origins(console, comparison)
    if findings:
        console.heading("What this shows")
        for sentence in findings:
            console.item("-", sentence) if console.fancy else console.line(f"- {sentence}", indent=2)


def _origins(console: Console, comparison: Comparison) -> None:
    cached = sorted({row.measured for row in comparison.rows if row.origin == "cached"})
    console.note(("This machine: ", "bold"), str(comparison.machine))
    if cached:
        when = cached[0] if cached[0] == cached[-1] else f"{cached[0]} to {cached[-1]}"
        console.note(f"Remembered from {when}; --fresh measures again.")
    if comparison.reference is not None:
        where = f" were not measured here: {comparison.reference.label}."
        console.note(("Rows marked reference", "bold"), where)
    if comparison.quick:
        console.note("Quick: fewer starts, steps and repetitions; leave --quick out for the whole.")


def _scenario(console: Console, scenario: Scenario, rows: Sequence[Row], best: frozenset[int]) -> None:
    if not console.quiet:
        console.heading(scenario.title, scenario.id)
        console.line((scenario.question, "dim"))
        console.line(f"Measured: {scenario.quantity}.{_truth(scenario)}")
    steps = sorted({row.dt for row in rows}, reverse=True)
    lines = []
    for dt in steps:
        whole = math.isclose(1.0 / dt, round(1.0 / dt), rel_tol=1e-6)
        step = [f"1/{1.0 / dt:.0f} s" if whole else f"{dt:g} s"] if len(steps) > 1 else []
        found: dict[tuple[str, bool], dict[Setting, str]] = {}  # by engine, and whether from the reference
        for row in (row for row in rows if row.dt == dt):
            cells = found.setdefault((row.engine, row.origin == "reference"), {})
            cells[row.setting] = _cell(scenario, row, best)
        for (engine, origin), cells in found.items():
            if not origin and (engine, True) in found:
                continue  # what has a reference is not listed as missing too
            name = ENGINES[engine].name + (", reference" if origin else "")
            lines.append((name, *step, cells.get(DEFAULT, ""), _tuned(cells, rows, engine, dt)))
    heads = ("Engine", *(["Step"] if len(steps) > 1 else []), "As it comes", "Well set")
    console.table(heads, lines)
    if console.plain and not console.quiet:
        console.blank()


def _tuned(cells: Mapping[Setting, str], rows: Sequence[Row], engine: str, dt: float) -> str:
    """The well-set result of the engine; a word where it has nothing to set."""
    mine = {row.setting: row for row in reversed(rows) if (row.engine, row.dt) == (engine, dt) and row.ok}
    text = cells.get(TUNED, "")
    if text and {TUNED, DEFAULT} <= mine.keys() and not mine[TUNED].options:
        return "the same, best" if text.endswith("best") else "the same"
    return "" if text == cells.get(DEFAULT) and not any(letter.isdigit() for letter in text) else text


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
        if len(column) < 2:
            continue
        scenario = SCENARIOS[scenario_id]
        large, truth = scenario.better == "large", scenario.truth or 0.0
        values = [row.value or 0.0 for row in column]
        distance = [-value if large else abs(value - truth) for value in values]
        nearest, first = min(zip(distance, column, strict=True), key=lambda pair: pair[0])
        # Values that look equal on the screen share a rank, and so do those within the spread of phases or
        # starts.
        slack = max(0.5 * 10.0**-scenario.digits, 0.5 * (first.highest - first.lowest))
        slack = 1e-9 if large else slack
        best |= {id(row) for row, far in zip(column, distance, strict=True) if far - nearest <= slack}
    return frozenset(best)


def _truth(scenario: Scenario) -> str:
    if scenario.truth is None:
        return ""
    any_ = "any step" if scenario.unit == "ms" else "any speed"
    return f" Truth: {_unit(f'{scenario.truth:g}', scenario) if math.isfinite(scenario.truth) else any_}."


def _cell(scenario: Scenario, row: Row, best: frozenset[int]) -> str:
    if not row.ok or row.value is None:
        return _STATUS[row.status]
    text = number(scenario, row.value)
    if rate := row.details.get("steps_per_second"):
        text += f", {rate:.0f}/s" if rate < 1000 else f", {rate / 1000:.1f}k/s"
    elif row.value in (row.details.get("fastest_tried_m_s"), row.details.get("longest_tried_ms")):
        text += ", all"
    if row.highest - row.lowest >= 10.0**-scenario.digits:
        text += f" ({_short(row.lowest)} to {_short(row.highest)})"
    elif row.repeats > 1 and row.spread and scenario.id != BOXES:
        text += f" ± {0.5 * row.spread:.1g}"
    return text + (" best" if id(row) in best else "")


def number(scenario: Scenario, value: float) -> str:
    """A value: signed where the truth is zero, and never "0" for a number that is not zero."""
    sign = "+" if scenario.truth == 0.0 and scenario.unit == "%" else ""
    size = abs(value)
    if size >= 1000:
        return _unit(f"{value:{sign}.4g}" if size >= 1e5 else f"{value:{sign}.0f}", scenario)
    form = ".0e" if 0.0 < size < 0.5 * 10.0**-scenario.digits else f".{scenario.digits}f"
    return _unit(f"{value + 0.0:{sign}{form}}", scenario)


def _short(value: float) -> str:
    """Three digits, for the ends of a range."""
    size = abs(value)
    digits = 2 - math.floor(math.log10(size)) if size >= 1e-3 else 0
    return f"{value + 0.0:.{max(0, digits)}f}"


def _unit(text: str, scenario: Scenario) -> str:
    return text if scenario.unit == "1" else f"{text}{'' if scenario.unit == 'x' else ' '}{scenario.unit}"
