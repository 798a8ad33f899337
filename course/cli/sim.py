"""``course sim``: runs simulations, and shows their numbers beside those of theory."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import msgspec

from course.cli.frame import here
from course.cli.frame.console import Console, current
from course.cli.frame.options import argument, option, simulation_ids, simulation_settings
from course.cli.frame.registry import COMMANDS, group
from course.cli.frame.replies import Envelope, WrittenFile, filled
from course.errors import UsageError
from course.simulations.base import Result, Row, describe
from course.simulations.base import run as run_simulation
from course.simulations.registry import CHAPTER, SIMULATIONS, get

# ---
# The replies of ``course sim ... --json``, as types.


Value = float | int | str


class SimParameter(msgspec.Struct, frozen=True, kw_only=True):
    """Something ``--set`` can set. ``low`` and ``high`` are None for words, ``choices`` empty for numbers.

    ``above`` is True if the lower end itself is not allowed. ``unit`` is "" for words, "1" for pure numbers.
    """

    name: str
    unit: str
    default: Value
    meaning: str
    low: float | None = None
    high: float | None = None
    above: bool = False
    choices: tuple[str, ...] = ()


class SimEntry(msgspec.Struct, frozen=True, kw_only=True):
    """A simulation in a list: the student answers ``question`` before the run."""

    id: str
    title: str
    question: str
    teaches: str
    parameters: tuple[SimParameter, ...]


class SimList(Envelope, tag="course.sim-list/1", frozen=True, kw_only=True):
    simulations: tuple[SimEntry, ...]


class SimRow(msgspec.Struct, frozen=True, kw_only=True):
    """A measured number; ``theory`` and ``error`` are None where nothing is known in closed form.

    "nan" means that it did not happen; for ``theory``, that it must not.
    """

    quantity: str
    simulated: float
    theory: float | None
    error: float | None
    unit: str
    source: str


class SimSetting(msgspec.Struct, frozen=True):
    """A parameter and its value."""

    value: Value
    unit: str


class Sim(Envelope, tag="course.sim/1", frozen=True, kw_only=True):
    """One run."""

    simulation: str
    title: str
    question: str
    settings: dict[str, SimSetting]
    results: tuple[SimRow, ...]
    finding: str
    plot: WrittenFile | None = None
    csv: WrittenFile | None = None


class SimAll(Envelope, tag="course.sim-all/1", frozen=True, kw_only=True):
    """``run --all``: the introductory simulations in order, and what they show together."""

    results: tuple[Sim, ...]
    concepts: tuple[str, ...]
    insights: tuple[str, ...]


app = group(COMMANDS["sim"].summary)

#: The common finding of the introductory simulations.
CONCEPTS = (
    "A body is its mass and its state: where it is and how it moves, to which rotation adds two more.",
    "Forces add up and give it an acceleration, a = F / m; nothing else does.",
    "An integrator turns accelerations into motion, step by step, and each one errs in its own way.",
    "Contact is a model of its own: a size, a moment at which surfaces touch, an impulse and a restitution.",
    "A fall, a throw, a collision and a spring need the same parts, put together differently.",
    "N steps make N + 1 samples, the start included, and sample i belongs to the time i h.",
)
INSIGHTS = (
    "Compare with a closed form where there is one, sample by sample and at the same instant.",
    "The method decides what kind of error you get; the step decides how much of it and, past a limit, "
    "whether there is an answer at all.",
    "A smaller step cannot repair a model that leaves something out: air, a radius, a rebound.",
    "Energy and momentum reveal an error even where no closed form exists.",
)


@app.command("list", epilog="Example: course sim list free-fall")
def list_simulations(
    name: Annotated[
        str | None, argument("NAME", "Only this one, with all its parameters.", simulation_ids)
    ] = None,
) -> int:
    """List the simulations.

    Each has a question. Answer it before you run the simulation.
    """
    console, entries = current(), []
    simulations = [get(one) for one in ((name,) if name else SIMULATIONS)]
    for simulation in simulations:
        console.heading(simulation.id, simulation.title)
        console.item("shows", simulation.teaches, width=5)
        console.item("guess", simulation.question, width=5)
        for parameter in simulation.parameters if name else ():
            console.item("set", describe(parameter), width=5)
        console.gap()
        parameters = tuple(
            # Words have no ends.
            filled(SimParameter, one, **({"low": None, "high": None} if one.choices else {}))
            for one in simulation.parameters
        )
        entries.append(filled(SimEntry, simulation, parameters=parameters))
    console.note((f"Next: course sim {'run' if name else 'list'} {name or CHAPTER[0]}", "bold"))
    return console.answer(SimList(simulations=tuple(entries)))


@app.command(epilog="Example: course sim run free-fall --set height=20 --plot fall.png")
def run(
    name: Annotated[str | None, argument("NAME", "See `course sim list`.", simulation_ids)] = None,
    everything: Annotated[
        bool, option("--all", "Run the four of the introduction, in order, and say what they show.")
    ] = False,
    settings: Annotated[
        list[str] | None, option("--set KEY=VALUE", "Set a parameter; repeatable.", simulation_settings)
    ] = None,
    plot: Annotated[Path | None, option("--plot FILE", "Write the figure: .png, .svg or .pdf.")] = None,
    csv: Annotated[Path | None, option("--csv FILE", "Write every sample as a table.")] = None,
) -> int:
    """Run a simulation, or the four of the introduction.

    Shows the results beside theory, with the error and the unit, and what they mean. If a file is replaced, a
    copy of it is kept.
    """
    console, pairs = current(), settings or []
    if everything:
        if name is not None or pairs:
            extra = name if name is not None else f"--set {pairs[0]}"
            problem = f"{extra}: --all runs all four with their defaults."
            raise UsageError(problem, help="Leave one of the two out.", code="all_and_one")
        return _run_all(console, plot, csv)
    if name is None:
        there = f"Known: {', '.join(SIMULATIONS)}."
        more = "`course sim list` says what each shows; --all runs the introduction's four."
        raise UsageError("Which simulation?", help=f"{there} {more}", code="no_name")
    return console.answer(_run_one(console, name, pairs, plot, csv))


def _run_all(console: Console, plot: Path | None, csv: Path | None) -> int:
    replies = []
    for name in CHAPTER:
        plot_to = here.inserted(plot, name) if plot else None
        csv_to = here.inserted(csv, name) if csv else None
        replies.append(_run_one(console, name, [], plot_to, csv_to))
        console.blank()
    for title, lines in (("What this showed", CONCEPTS), ("What to take along", INSIGHTS)):
        console.heading(title)
        for text in lines:
            console.item("-", text) if console.fancy else console.line(f"- {text}", indent=2)
    return console.answer(SimAll(results=tuple(replies), concepts=CONCEPTS, insights=INSIGHTS))


def _run_one(console: Console, name: str, pairs: Sequence[str], plot: Path | None, csv: Path | None) -> Sim:
    simulation = get(name)
    plot = here.target(plot, "--plot", here.FORMATS) if plot else None
    csv = here.target(csv, "--csv", ("csv",)) if csv else None
    with console.working(f"Running {simulation.id}"):
        result = run_simulation(simulation, pairs)
    if not console.quiet:
        console.heading(simulation.title)
        changed = [p.name for p in simulation.parameters if result.settings[p.name] != p.default]
        values = ((one, result.settings[one.name]) for one in simulation.parameters)
        texts = ((one, value if isinstance(value, str) else f"{value:.6g}") for one, value in values)
        every = ", ".join(f"{one.name} {_with_unit(text, one.unit)}" for one, text in texts)
        console.line((every, "dim"))
        if changed:
            console.line(f"Changed: {', '.join(changed)}.")
        console.figure(lambda: _drawn(result))
        heads = ("Measured", "Simulated", "Theory", "Error")
        console.table_or_facts(heads, [_cells(row) for row in result.rows])
    console.line((result.finding, "bold"))
    plotted = written = None
    if plot:
        from course.figures.experiments import render

        with console.working("Drawing"):
            picture = render(result, plot.suffix.lower().removeprefix("."))
        plotted = here.write_told(plot, picture, why="sim")
    if csv:
        names = (f"{column.name} [{column.unit}]" for column in result.columns)
        samples = zip(*(column.values.tolist() for column in result.columns), strict=True)
        written = here.write_told(csv, here.as_csv(names, samples), why="sim")
    settings = {p.name: SimSetting(result.settings[p.name], p.unit) for p in simulation.parameters}
    rows = tuple(filled(SimRow, row, simulated=float(row.simulated)) for row in result.rows)
    made = {"settings": settings, "results": rows, "plot": plotted, "csv": written}
    return filled(Sim, simulation, result, simulation=simulation.id, **made)


# -- on the screen ---------------------------------------------------------------------------------------


def _drawn(result: Result) -> Any:
    from course.figures.experiments import draw

    return draw(result)


def _cells(row: Row) -> tuple[str, str, str, str]:
    """A row as text: simulated and theory to the same digit, and the error as a number of its own."""
    places, error = _places(row.simulated, row.theory), row.error
    theory = "" if row.theory is None else _number(row.theory, row.unit, places)
    shown = "" if error is None else _with_unit(f"{error:+#.3g}", row.unit)
    # Beside a theory of 0 the simulated value is round-off where ``_number`` shows it as 0.
    if error is not None and abs(error) < 1e-11 * (max(abs(row.theory), 1e-3) if row.theory else 1.0):
        shown = "0" if error == 0 else "round-off"
    return row.quantity, _number(row.simulated, row.unit, places), theory, shown


def _places(*values: float | None) -> str:
    """A format that gives the largest of the values five digits and all of them the same decimals."""
    sizes = [abs(value) for value in values if value is not None and math.isfinite(value)]
    largest = max(sizes, default=0.0)
    if not 1e-4 <= largest < 1e6 or all(size == round(size) for size in sizes):
        return ".5g"
    return f".{max(0, 4 - math.floor(math.log10(largest)))}f"


def _number(value: float, unit: str, places: str) -> str:
    if math.isnan(value):
        return "never" if unit == "s" else "did not happen"
    if math.isinf(value):
        return "beyond all numbers"
    return _with_unit(f"{0.0 if abs(value) < 1e-11 else value:{places}}", unit)


def _with_unit(text: str, unit: str) -> str:
    return f"{text} {unit}" if unit not in ("", "1") else text
