"""Runs the scenarios: installed engines are measured, and the others are shown from the reference.

Accuracy is measured in several processes at once, since it does not depend on other processes. Speed is
measured afterwards, one engine at a time, each stretch next to a stretch of pymunk's, so that the ratio is
valid even on a busy machine.
"""

from __future__ import annotations

import dataclasses
import datetime
import statistics
import threading
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import msgspec

from course.catalog.locate import cache_folder
from course.engines import reference
from course.engines.process import EngineProcess
from course.engines.registry import ENGINES, Availability, EngineInfo, availability, get
from course.engines.results import (
    DEFAULT,
    OK,
    TUNED,
    Cache,
    Comparison,
    EngineState,
    Row,
    Setting,
    this_machine,
)
from course.engines.scenarios import BOXES, DT, SCENARIOS
from course.engines.scenarios import get as get_scenario

if TYPE_CHECKING:
    Progress = Callable[[int, int, str], None]

#: The steps that show how an error shrinks, s; the middle one is the step of everything else.
LADDER = tuple(1.0 / rate for rate in (60, 120, 240, 480, 960))
QUICK_LADDER = tuple(1.0 / rate for rate in (120, 240, 480))
#: The engine whose speed is the unit for the others.
YARDSTICK = "pymunk"
#: Stretches of each engine and of pymunk, taken in turn, and how long one is to last, s.
_PAIRS, _PAIRS_QUICK = 7, 3
_STRETCH_S, _STRETCH_QUICK_S = 0.2, 0.08
#: The length of a stretch is estimated from this many steps.
_TRIAL_STEPS = 10
#: Time limit of one measurement, s: the slowest so far took 4.
DEADLINE_S = 60.0


@dataclass(frozen=True, slots=True)
class Request:
    """The scope of a comparison.

    Attributes:
        engines, scenarios: ids; none means all.
        steps: dt in s; none means 1/240, and a ladder of steps where the integrator alone decides.
        repeat: how often each measurement is made.
        quick: fewer steps, starts and repetitions; the measured values may differ a little.
        fresh: measure again even if the result is stored.
        deadline: s for one measurement.
    """

    engines: tuple[str, ...] = ()
    scenarios: tuple[str, ...] = ()
    steps: tuple[float, ...] = ()
    repeat: int = 1
    quick: bool = False
    fresh: bool = False
    deadline: float = DEADLINE_S


@dataclass(frozen=True, slots=True)
class _Job:
    """One measurement to be made."""

    engine: EngineInfo
    version: str
    scenario: str
    setting: Setting
    dt: float

    def row(self, **more: Any) -> Row:
        return Row(
            engine=self.engine.id,
            scenario=self.scenario,
            setting=self.setting,
            dt=self.dt,
            version=self.version,
            measured=datetime.datetime.now(datetime.UTC).date().isoformat(),
            **more,
        )


@dataclass(slots=True)
class _Run:
    """A comparison in progress."""

    request: Request
    cache: Cache
    progress: Progress
    total: int
    rows: dict[_Job, Row] = field(default_factory=dict)
    lock: threading.Lock = field(default_factory=threading.Lock)
    stop: threading.Event = field(default_factory=threading.Event)

    def key(self, job: _Job) -> dict[str, Any]:
        return {
            "engine": job.engine.id,
            "version": job.version,
            "scenario": job.scenario,
            "setting": job.setting,
            "dt": job.dt,
            "quick": self.request.quick,
            "repeat": self.request.repeat,
        }

    def keep(self, job: _Job, row: Row) -> None:
        with self.lock:
            self.rows[job] = row
            self.progress(len(self.rows), self.total, f"{job.engine.id}: {job.scenario}")
        if row.origin == "measured":
            self.cache.put(self.key(job), row)


def state_of(info: EngineInfo, *, probe: bool = False) -> EngineState:
    """The state of an engine on this machine.

    Args:
        probe: start it, in a process of its own, to see whether it can.
    """
    found: Availability = availability(info)
    trouble = ""
    if probe and found.installed:
        with EngineProcess(info.id) as process:
            reply = process.ask({"do": "options", "scenario": "free-fall", "setting": "default"}, 30.0)
        trouble = "" if reply["status"] == OK else f"installed, but cannot start: {reply['message']}"
    return EngineState(
        id=info.id,
        name=info.name,
        package=info.package,
        extra=info.extra,
        licence=info.licence,
        about=info.about,
        version=found.version,
        usable=found.installed and not trouble,
        missing=found.missing or trouble,
        command=found.command,
    )


def compare(request: Request, progress: Progress = lambda _done, _total, _what: None) -> Comparison:
    """Measure, store, and fill in from the reference.

    Args:
        progress: called with measurements done, their total, and the last one's name.

    Raises:
        NotFoundError: no such engine or scenario.
    """
    infos = [get(name) for name in dict.fromkeys(request.engines or ENGINES)]
    scenarios = [get_scenario(name).id for name in dict.fromkeys(request.scenarios or SCENARIOS)]
    states = {info.id: state_of(info) for info in infos}
    jobs = [
        _Job(info, states[info.id].version or "", scenario, setting, dt)
        for info in infos
        for scenario in scenarios
        for dt in _steps(request, scenario)
        for setting in (DEFAULT, TUNED)
    ]
    machine = this_machine()
    wanted = [job for job in jobs if states[job.engine.id].usable]
    run = _Run(request, Cache(cache_folder("engines"), machine), progress, len(wanted))
    _measure(run, wanted)
    rows = [
        run.rows.get(job) or job.row(status="not_installed", message=states[job.engine.id].missing)
        for job in jobs
    ]
    # Rows that cannot be measured here are shown from the reference, if it has them.
    lacking = {(row.engine, row.scenario, row.setting, row.dt) for row in rows if _lacks(row)}
    shipped = reference.load()
    filled = [row for row in shipped.rows if (row.engine, row.scenario, row.setting, row.dt) in lacking]
    return Comparison(
        machine=machine,
        engines=tuple(states.values()),
        rows=(*rows, *filled),
        reference=msgspec.structs.replace(shipped, rows=()) if filled else None,
        quick=request.quick,
    )


def _lacks(row: Row) -> bool:
    return row.status in ("not_installed", "unavailable")


def _steps(request: Request, scenario: str) -> tuple[float, ...]:
    if request.steps:
        return request.steps
    if SCENARIOS[scenario].converges:
        return QUICK_LADDER if request.quick else LADDER
    return (DT,)


def _measure(run: _Run, jobs: Iterable[_Job]) -> None:
    """Measure everything that is not stored: accuracy in parallel, then speed one by one."""
    left: dict[str, list[_Job]] = {}
    for job in jobs:
        known = None if run.request.fresh else run.cache.get(run.key(job))
        if known is not None:
            run.keep(job, known)
        else:
            left.setdefault(job.engine.id, []).append(job)
    accuracy = [[job for job in mine if job.scenario != BOXES] for mine in left.values()]
    cores = this_machine().cores
    # Not a `with`: its exit would wait for every engine after an interrupt.
    pool = ThreadPoolExecutor(max_workers=min(4, cores))
    try:
        for done in [pool.submit(_one_engine, run, mine) for mine in accuracy if mine]:
            done.result()
        for mine in left.values():
            for job in mine:
                if job.scenario == BOXES:
                    run.keep(job, _speed(run, job))
    except BaseException:
        run.stop.set()
        raise
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _one_engine(run: _Run, jobs: list[_Job]) -> None:
    """All accuracy jobs of one engine, in one process as long as it is alive."""
    unavailable: Row | None = None
    with EngineProcess(jobs[0].engine.id) as process:
        for job in jobs:
            if run.stop.is_set():
                return
            if unavailable is not None:
                run.keep(job, job.row(status="unavailable", message=unavailable.message))
                continue
            row = _untuned(run, process, job) or _accuracy(run, process, job)
            if row.status == "unavailable":
                unavailable = row
            run.keep(job, row)


def _untuned(run: _Run, process: EngineProcess, job: _Job) -> Row | None:
    """The default row again, where the engine has nothing to set: a second measurement would be the same."""
    if job.setting != TUNED:
        return None
    twin = run.rows.get(dataclasses.replace(job, setting=DEFAULT))
    if twin is None or not twin.ok:
        return None
    question = {"do": "options", "scenario": job.scenario, "setting": TUNED}
    reply = process.ask(question, run.request.deadline)
    if reply["status"] != OK or reply["options"]:
        return None
    return msgspec.structs.replace(twin, setting=TUNED)


def _accuracy(run: _Run, process: EngineProcess, job: _Job) -> Row:
    message = {
        "do": "measure",
        "scenario": job.scenario,
        "setting": job.setting,
        "dt": job.dt,
        "quick": run.request.quick,
    }
    values: list[float] = []
    for _ in range(run.request.repeat):
        reply = process.ask(message, run.request.deadline)
        if reply["status"] != OK:
            return job.row(status=reply["status"], message=reply.get("message", ""))
        values.append(reply["value"])
    return job.row(
        status=OK,
        value=statistics.median(values),
        options=reply["options"],
        why=tuple(reply["why"]),
        samples=tuple(reply.get("samples", ())),
        details=reply["details"],
        repeats=len(values),
        spread=max(values) - min(values),
    )


def _speed(run: _Run, job: _Job) -> Row:
    """The rate with a hundred boxes as a multiple of pymunk's, from stretches taken in turn."""
    quick, deadline = run.request.quick, run.request.deadline
    pairs = (_PAIRS_QUICK if quick else _PAIRS) * run.request.repeat
    stretch = _STRETCH_QUICK_S if quick else _STRETCH_S
    build = {"do": "boxes", "scenario": BOXES, "dt": job.dt}
    rates: tuple[list[float], list[float]] = ([], [])
    with EngineProcess(job.engine.id) as one, EngineProcess(YARDSTICK) as other:
        if twin := _untuned(run, one, job):
            return twin
        asked = ((one, {**build, "setting": job.setting}), (other, {**build, "setting": "default"}))
        steps: list[int] = []
        known: dict[str, Any] = {}
        for process, message in reversed(asked):
            for question in (message, {"do": "chunk", "steps": _TRIAL_STEPS}):
                reply = process.ask(question, deadline)
                if reply["status"] != OK:
                    return job.row(status=reply["status"], message=reply.get("message", ""))
                known = reply if "options" in reply else known
            steps.insert(0, max(5, round(_TRIAL_STEPS * stretch / reply["seconds"])))
        for _ in range(pairs):
            for process, n, found in ((other, steps[1], rates[1]), (one, steps[0], rates[0])):
                reply = process.ask({"do": "chunk", "steps": n}, deadline)
                if reply["status"] != OK:
                    return job.row(status=reply["status"], message=reply.get("message", ""))
                found.append(n / reply["seconds"])
    ratios = [mine / theirs for mine, theirs in zip(*rates, strict=True)]
    return job.row(
        status=OK,
        value=statistics.median(ratios),
        options=known["options"],
        why=tuple(known["why"]),
        details={
            "steps_per_second": statistics.median(rates[0]),
            "slowest": min(rates[0]),
            "fastest": max(rates[0]),
            "pymunk_steps_per_second": statistics.median(rates[1]),
            "contacts": known["contacts"],
        },
        repeats=pairs,
        spread=max(ratios) - min(ratios),
    )
