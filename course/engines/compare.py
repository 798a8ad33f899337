"""Runs the scenarios: installed engines are measured, and the others are shown from the reference.

Accuracy is measured in several processes at once, since it does not depend on other processes. Speed is
measured afterwards, one engine at a time, each stretch next to a stretch of pymunk's, so that the ratio is
valid even on a busy machine.
"""

from __future__ import annotations

import contextlib
import datetime
import json
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import IO, Any, Self, cast

import msgspec

from course.catalog.locate import cache_folder
from course.engines import reference
from course.engines.registry import ENGINES, Availability, EngineInfo, availability, get
from course.engines.results import DEFAULT, OK, TUNED, Cache, Comparison, EngineState, Row, this_machine
from course.engines.scenarios import BOXES, DT, SCENARIOS
from course.engines.scenarios import get as get_scenario

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
    """

    engines: tuple[str, ...] = ()
    scenarios: tuple[str, ...] = ()
    steps: tuple[float, ...] = ()
    repeat: int = 1
    quick: bool = False
    fresh: bool = False


@dataclass(slots=True)
class _Run:
    """A comparison in progress. A measurement to be made is a row that has no value yet."""

    request: Request
    cache: Cache
    progress: Progress
    total: int
    rows: dict[tuple[Any, ...], Row] = field(default_factory=dict)
    lock: threading.Lock = field(default_factory=threading.Lock)
    stop: threading.Event = field(default_factory=threading.Event)

    def key(self, row: Row) -> tuple[Any, ...]:
        """What a measurement depends on, beside the machine and the code."""
        return *row.place, row.version, self.request.quick, self.request.repeat

    def keep(self, row: Row) -> None:
        with self.lock:
            self.rows[row.place] = row
            self.progress(len(self.rows), self.total, f"{row.engine}: {row.scenario}")
        if row.origin == "measured":
            self.cache.put(self.key(row), row)


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
    usable, missing = found.installed and not trouble, found.missing or trouble
    known = {**asdict(info), **asdict(found), "usable": usable, "missing": missing}
    return msgspec.convert(known, EngineState)


def compare(request: Request, progress: Progress = lambda _done, _total, _what: None) -> Comparison:
    """Measure, store, and fill in from the reference.

    Args:
        progress: called with measurements done, their total, and the last one's name.
    """
    infos = [get(name) for name in dict.fromkeys(request.engines or ENGINES)]
    scenarios = [get_scenario(name).id for name in dict.fromkeys(request.scenarios or SCENARIOS)]
    states = {info.id: state_of(info) for info in infos}
    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    jobs = [
        Row(
            engine=state.id, version=state.version or "", scenario=scenario, setting=setting, dt=dt,
            measured=today, status="not_installed", message=state.missing,
        )
        for state in states.values()
        for scenario in scenarios
        for dt in _steps(request, scenario)
        for setting in (DEFAULT, TUNED)
    ]  # fmt: skip
    machine = this_machine()
    wanted = [job for job in jobs if states[job.engine].usable]
    run = _Run(request, Cache(cache_folder("engines"), machine), progress, len(wanted))
    _measure(run, wanted)
    rows = [run.rows.get(job.place, job) for job in jobs]
    # Rows that cannot be measured here are shown from the reference, if it has them.
    lacking = {row.place for row in rows if row.status in ("not_installed", "unavailable")}
    shipped = reference.load()
    filled = [row for row in shipped.rows if row.place in lacking]
    return Comparison(
        machine=machine,
        engines=tuple(states.values()),
        rows=(*rows, *filled),
        reference=msgspec.structs.replace(shipped, rows=()) if filled else None,
        quick=request.quick,
    )


def _steps(request: Request, scenario: str) -> tuple[float, ...]:
    if request.steps:
        return request.steps
    if SCENARIOS[scenario].converges:
        return QUICK_LADDER if request.quick else LADDER
    return (DT,)


def _measure(run: _Run, jobs: Iterable[Row]) -> None:
    """Measure everything that is not stored: accuracy in parallel, then speed one by one."""
    left: dict[str, list[Row]] = {}
    for job in jobs:
        known = None if run.request.fresh else run.cache.get(run.key(job))
        if known is not None:
            run.keep(known)
        else:
            left.setdefault(job.engine, []).append(job)
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
                    run.keep(_speed(run, job))
    except BaseException:
        run.stop.set()
        raise
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _one_engine(run: _Run, jobs: list[Row]) -> None:
    """All accuracy jobs of one engine, in one process as long as it is alive."""
    unavailable: str | None = None
    with EngineProcess(jobs[0].engine) as process:
        for job in jobs:
            if run.stop.is_set():
                return
            if unavailable is not None:
                run.keep(msgspec.structs.replace(job, status="unavailable", message=unavailable))
                continue
            row = _untuned(run, process, job) or _accuracy(run, process, job)
            if row.status == "unavailable":
                unavailable = row.message
            run.keep(row)


def _without(job: Row, reply: Mapping[str, Any]) -> Row:
    """A row that says why it has no value."""
    return msgspec.structs.replace(job, status=reply["status"], message=reply.get("message", ""))


def _measured(job: Row, values: Sequence[float], known: Mapping[str, Any], **more: Any) -> Row:
    """A row with the middle of its values, and with the settings that a reply tells."""
    return msgspec.structs.replace(
        job,
        status=OK,
        message="",
        value=statistics.median(values),
        options=known["options"],
        why=tuple(known["why"]),
        repeats=len(values),
        spread=max(values) - min(values),
        **more,
    )


def _untuned(run: _Run, process: EngineProcess, job: Row) -> Row | None:
    """The default row again, where the engine has nothing to set: a second measurement would be the same."""
    if job.setting != TUNED:
        return None
    twin = run.rows.get(msgspec.structs.replace(job, setting=DEFAULT).place)
    if twin is None or not twin.ok:
        return None
    reply = process.ask({"do": "options", "scenario": job.scenario, "setting": TUNED})
    if reply["status"] != OK or reply["options"]:
        return None
    return msgspec.structs.replace(twin, setting=TUNED)


def _accuracy(run: _Run, process: EngineProcess, job: Row) -> Row:
    message = {
        "do": "measure",
        "scenario": job.scenario,
        "setting": job.setting,
        "dt": job.dt,
        "quick": run.request.quick,
    }
    values: list[float] = []
    for _ in range(run.request.repeat):
        reply = process.ask(message)
        if reply["status"] != OK:
            return _without(job, reply)
        values.append(reply["value"])
    return _measured(job, values, reply, samples=tuple(reply.get("samples", ())), details=reply["details"])


def _speed(run: _Run, job: Row) -> Row:
    """The rate with a hundred boxes as a multiple of pymunk's, from stretches taken in turn."""
    quick = run.request.quick
    pairs = (_PAIRS_QUICK if quick else _PAIRS) * run.request.repeat
    stretch = _STRETCH_QUICK_S if quick else _STRETCH_S
    build = {"do": "boxes", "scenario": BOXES, "dt": job.dt}
    rates: tuple[list[float], list[float]] = ([], [])
    with EngineProcess(job.engine) as one, EngineProcess(YARDSTICK) as other:
        if twin := _untuned(run, one, job):
            return twin
        asked = ((one, {**build, "setting": job.setting}), (other, {**build, "setting": "default"}))
        steps: list[int] = []
        known: dict[str, Any] = {}
        for process, message in reversed(asked):
            for question in (message, {"do": "chunk", "steps": _TRIAL_STEPS}):
                reply = process.ask(question)
                if reply["status"] != OK:
                    return _without(job, reply)
                known = reply if "options" in reply else known
            steps.insert(0, max(5, round(_TRIAL_STEPS * stretch / reply["seconds"])))
        for _ in range(pairs):
            for process, n, found in ((other, steps[1], rates[1]), (one, steps[0], rates[0])):
                reply = process.ask({"do": "chunk", "steps": n})
                if reply["status"] != OK:
                    return _without(job, reply)
                found.append(n / reply["seconds"])
    ratios = [mine / theirs for mine, theirs in zip(*rates, strict=True)]
    details = {
        "steps_per_second": statistics.median(rates[0]),
        "slowest": min(rates[0]),
        "fastest": max(rates[0]),
        "pymunk_steps_per_second": statistics.median(rates[1]),
        "contacts": known["contacts"],
    }
    return _measured(job, ratios, known, details=details)


#: How long an engine may take to load, s: usually 0.1 to 0.6, several times that from a cold disk.
START_S = 60.0
#: Every engine runs on one processor core: rates can be compared, and sums do not depend on the order of
#: threads.
_ONE_THREAD = {"OMP_NUM_THREADS": "1", "RAYON_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
_LAST_WORDS = 200


class EngineProcess:
    """One engine's process; a context manager. It starts with the first job, and again after it has died.

    Args:
        command: run in place of the worker, for tests.
    """

    def __init__(self, engine: str, command: list[str] | None = None) -> None:
        self.engine = engine
        self._command = command or [sys.executable, "-P", "-m", "course.engines.worker", engine]
        self._process: subprocess.Popen[str] | None = None
        self._words: Any = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def pid(self) -> int | None:
        return self._process.pid if self._process else None

    def ask(self, job: Mapping[str, Any], seconds: float = DEADLINE_S) -> dict[str, Any]:
        """The reply to a job, or a reply that says why there is none.

        Args:
            seconds: to wait at most; then the process is ended.
        """
        if self._process is None:
            started = self._start()
            if started["status"] != "ok":
                return started
        process = cast("subprocess.Popen[str]", self._process)
        asked = cast("IO[str]", process.stdin)
        try:
            asked.write(json.dumps({**job, "seconds": seconds}) + "\n")
            asked.flush()
        except OSError:
            return self._died()
        return self._read(seconds)

    def _start(self) -> dict[str, Any]:
        self._words = tempfile.TemporaryFile()  # noqa: SIM115 - closed in close()
        root = str(Path(__file__).parents[2])
        path = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH", ""))))
        try:
            self._process = subprocess.Popen(
                self._command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._words,
                text=True,
                encoding="utf-8",
                env={**os.environ, **_ONE_THREAD, "PYTHONPATH": path},
            )
        except OSError as error:
            self._words.close()
            return {"status": "unavailable", "message": f"No process could be started ({error.strerror})."}
        reply = self._read(START_S)
        if reply["status"] != "ok":
            self.close()
            if reply["status"] == "crash":
                return {"status": "unavailable", "message": reply["message"]}
        return reply

    def _read(self, seconds: float) -> dict[str, Any]:
        process = cast("subprocess.Popen[str]", self._process)
        began = time.monotonic()
        too_long = threading.Timer(seconds, process.kill)
        too_long.start()
        try:
            line = cast("IO[str]", process.stdout).readline()
        finally:
            too_long.cancel()
        if not line.endswith("\n"):
            if time.monotonic() - began < seconds:
                return self._died()
            self.close()
            return {"status": "deadline", "message": f"No answer within {seconds:g} s; it was ended."}
        try:
            reply: dict[str, Any] = json.loads(line)
        except ValueError:
            self.close()
            return {"status": "crash", "message": "Its answer was not one."}
        return reply

    def _died(self) -> dict[str, Any]:
        """The message about a process that ended by itself."""
        process = cast("subprocess.Popen[str]", self._process)
        try:
            code = process.wait(timeout=5)
        except subprocess.TimeoutExpired:
            process.kill()
            code = process.wait()
        how = f"It ended with exit code {code}."
        if code < 0:
            named = {one.value: one.name for one in signal.Signals}
            how = f"It was ended by {named.get(-code, f'signal {-code}')}."
        words = self._last_words()
        self.close()
        return {"status": "crash", "message": f"{how} {words}".strip()}

    def _last_words(self) -> str:
        self._words.seek(0, os.SEEK_END)
        self._words.seek(max(0, self._words.tell() - 4096))
        lines = self._words.read().decode("utf-8", errors="replace").splitlines()
        said = [line.strip() for line in lines if line.strip()]
        return f"Its last words: {said[-1][:_LAST_WORDS]}" if said else ""

    def close(self) -> None:
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            process.wait()
            for pipe in (process.stdin, process.stdout):
                if pipe is not None:
                    # What could not be flushed to a dead process is lost anyway.
                    with contextlib.suppress(OSError):
                        pipe.close()
        if self._words is not None:
            self._words.close()
