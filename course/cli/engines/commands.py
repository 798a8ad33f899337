"""``course engines``: which real engines this machine has, and the same scenarios in each of them."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated, Any

import msgspec

from course.cli.frame import here
from course.cli.frame.completion import engine_ids, scenario_ids
from course.cli.frame.console import Console, current, meter
from course.cli.frame.options import option
from course.cli.frame.registry import COMMANDS, group
from course.cli.frame.replies import Envelope, WrittenFile, filled
from course.engines.registry import ENGINES
from course.engines.results import Comparison, EngineState
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
    scenario: str
    setting: str
    dt: float
    status: str
    value: float | None
    truth: float | None
    error: float | None
    unit: str
    best: bool
    message: str
    origin: str
    measured: str
    version: str
    options: dict[str, Any]
    why: tuple[str, ...]
    samples: tuple[float, ...]
    repeats: int
    spread: float
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


_COLUMNS = (
    "engine",
    "version",
    "scenario",
    "setting",
    "dt",
    "status",
    "value",
    "truth",
    "error",
    "unit",
    "best",
    "origin",
    "measured",
    "repeats",
    "spread",
    "message",
)


def rows(comparison: Comparison) -> tuple[EngineRow, ...]:
    """Every row with its truth, its error and whether it is the best of its column."""
    from course.cli.engines.screen import best_rows
    from course.engines.scenarios import SCENARIOS

    best = best_rows(comparison.rows)
    return tuple(
        filled(
            EngineRow,
            row,
            scenario := SCENARIOS[row.scenario],
            error=None if row.value is None else scenario.error(row.value),
            best=id(row) in best,
        )
        for row in comparison.rows
    )


app = group(COMMANDS["engines"].summary)

#: The longest and the shortest step that make sense in the scenarios, s.
_LONGEST, _SHORTEST = 0.02, 1e-4


@app.command("list", epilog="Example: course engines list")
def list_engines() -> int:
    """List the engines and the scenarios.

    Each installed engine is started once, in a process of its own, to see whether it runs. For each missing
    engine the list shows the command that installs it.
    """
    from course.engines.compare import state_of
    from course.engines.scenarios import SCENARIOS

    console = current()
    with console.working("Starting each engine"):
        states = tuple(state_of(info, probe=True) for info in ENGINES.values())
    console.heading("Engines")
    for state in states:
        version = f"{state.package} {state.version}" if state.version else "not installed"
        facts = f"{state.name}; {version}; {state.licence}; {state.about}"
        console.item(state.id, facts, width=8)
        if not state.usable:
            trouble = state.missing if not state.version and state.command else f"{state.missing}. "
            console.line(f"{trouble}: {state.command}" if state.command else trouble.rstrip(), indent=12)
    console.heading("Scenarios")
    for scenario in SCENARIOS.values():
        console.item(scenario.id, f"{scenario.title}. {scenario.question}", width=15)
    console.note(("Next: course engines compare --quick", "bold"))
    console.emit(EngineList(engines=states, scenarios=_scenarios(SCENARIOS)))
    return 0


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
    from course.cli.engines import screen as engines_screen
    from course.engines.compare import Request
    from course.engines.compare import compare as run_comparison
    from course.engines.findings import findings

    console = current()
    plot = here.target(plot, "--plot", here.FORMATS) if plot else None
    csv = here.target(csv, "--csv", ("csv",)) if csv else None
    request = Request(
        tuple(engine or ()), tuple(scenario or ()), tuple(map(_step, dt or ())), repeat, quick, fresh
    )
    with meter(console) as progress:
        comparison = run_comparison(request, progress)
    said = findings(comparison.rows)
    engines_screen.show(console, comparison, said)
    plots, table = _write(console, comparison, plot, csv)
    code = 0 if comparison.ran else MissingCapabilityError.exit_code
    if code:
        console.line(("No engine could be run on this machine.", "bold"))
    console.emit(_reply(comparison, said, code, plots, table))
    return code


def _write(
    console: Console, comparison: Comparison, plot: Path | None, csv: Path | None
) -> tuple[tuple[WrittenFile, ...], WrittenFile | None]:
    """Write the requested figures and table, and say where they are."""
    plots: list[WrittenFile] = []
    if plot:
        from course.figures.engines import render

        with console.working("Drawing"):
            pictures = render(comparison.rows, plot.suffix.lower().removeprefix("."))
        for name, picture in pictures.items():
            plots.append(here.write_told(here.inserted(plot, name), picture, why="engines"))
        if not plots:
            console.line("No figure: steps need three values of --dt, speed needs boxes and stack.")
    if csv is None:
        return tuple(plots), None
    lines = ([getattr(row, column) for column in _COLUMNS] for row in rows(comparison))
    return tuple(plots), here.write_told(csv, here.as_csv(_COLUMNS, lines), why="engines")


def _step(text: str) -> float:
    """A step from 0.005 or 1/240, s."""
    top, slash, bottom = text.partition("/")
    try:
        step = float(top) / (float(bottom) if slash else 1.0)
    except (ValueError, ZeroDivisionError):
        raise UsageError(
            f"--dt {text}: this is not a step.", help="Give seconds, as 0.005 or 1/240.", code="bad_step"
        ) from None
    if not _SHORTEST <= step <= _LONGEST:
        raise UsageError(
            f"--dt {text}: the step is not between {_SHORTEST:g} and {_LONGEST:g} s.",
            help="The scenarios last from half a second to ten seconds; 1/240 is usual.",
            code="bad_step",
        )
    return step


def _scenarios(ids: Iterable[str]) -> tuple[EngineScenario, ...]:
    from course.engines.scenarios import SCENARIOS

    return tuple(filled(EngineScenario, SCENARIOS[name]) for name in ids)


def _reply(
    comparison: Comparison,
    said: Sequence[str],
    code: int,
    plots: tuple[WrittenFile, ...],
    csv: WrittenFile | None,
) -> Engines:
    shipped = comparison.reference
    return Engines(
        exit_code=code,
        machine=filled(EngineMachine, comparison.machine),
        reference=filled(EngineMachine, shipped, shipped.machine) if shipped else None,
        quick=comparison.quick,
        engines=comparison.engines,
        scenarios=_scenarios(dict.fromkeys(row.scenario for row in comparison.rows)),
        rows=rows(comparison),
        findings=tuple(said),
        plots=plots,
        csv=csv,
    )
