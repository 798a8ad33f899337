"""The ``submission`` that checks call: functions of a student's, run in a worker, under deadlines."""

from __future__ import annotations

import contextlib
import copy
from collections.abc import Iterable, Iterator, Mapping, Sequence
from time import monotonic
from typing import Any, NamedTuple, TypeVar

import numpy as np

from course.isolation.failures import StudentFailure
from course.isolation.levels import BUDGET_S, SEARCH_S, WALL, Deadline, Spawner
from course.isolation.session import Connection, LoadFault, LoadRefusedError
from course.scoring.values import Inspected, as_march, overwritten
from course.scoring.verdict import Places

T = TypeVar("T")
#: A step's name, the system that was marched along, and its times and states: t, (q, v).
March = tuple[str, Any, Any, Any]


class Heard(NamedTuple):
    """A call that returned.

    Attributes:
        method: of ``RemoteSubmission``, that made it.
        args: of that method; generators as they were before the call.
        value: what it gave.
    """

    method: str
    args: tuple[Any, ...]
    value: Any


#: Bytes of results that are kept of one submission to see whether the same call gives them again. A function
#: that keeps something may return megabytes each time, and the grader would hold them all.
_HEARD = 32_000_000


def _weight(value: Any) -> int:
    """About how many bytes a result takes."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list | tuple):
        return 64 + sum(map(_weight, value))
    return 64 + (
        value.nbytes if isinstance(value, np.ndarray) else len(value) if isinstance(value, str) else 0
    )


class RemoteSubmission:
    """One submission in a worker. A worker that died is replaced before the next check.

    Whatever calls the student's code raises StudentFailure where it gave no value.

    Args:
        timeout: seconds of CPU time per check.
        times: how many times the usual time all its checks together have.
        places: how its lines are told; failures carry it.
        home: a worker that does not answer is asked where it is.
        patience: seconds of CPU time for loading, if that is to have less than a check.
        tasks: functions; a file that hangs or dies while it is loaded is loaded without what these do not
            need.
        listened: functions whose calls are recorded in ``heard``.

    Attributes:
        heard: the calls of this check, in order, that returned.
        returned: name and value of the last of the student's functions that returned in this check.
        asking: name and arguments of the last ``call``; None after calls of another kind.
        asked: names of the functions that this check has used.
        marched: the first march of this check at home, if it made one.
        without: why only what the tasks need was loaded; None where all was.

    Raises:
        LoadRefusedError: it cannot be loaded.
    """

    def __init__(
        self,
        spawner: Spawner,
        files: Mapping[str, bytes],
        main: str,
        *,
        timeout: float,
        seed: int,
        times: float = 1.0,
        places: Places | None = None,
        home: bool = False,
        patience: float | None = None,
        tasks: Sequence[str] = (),
        listened: frozenset[str] = frozenset(),
    ) -> None:
        self._listened = listened
        self._tasks = tuple(tasks)
        self._needed: tuple[str, ...] = ()
        self.without: LoadRefusedError | None = None
        self.heard: list[Heard] = []
        self._room = _HEARD
        self._home = home
        self._places = places or Places(module=main)
        self.seed = seed
        self._spawner = spawner
        self._files = files
        self._main = main
        self._timeout = timeout
        self._cpu_left, self._wall_left = times * BUDGET_S, WALL * times * BUDGET_S
        self._search_left = SEARCH_S
        self._patience = min(timeout, timeout if patience is None else patience)
        self._deadline = Deadline(min(self._patience, self._cpu_left))
        self._printed_before = 0
        self._task = ""
        self.returned: tuple[str, Any] | None = None
        self.asking: tuple[str, tuple[Any, ...]] | None = None
        self.asked: set[str] = set()
        self.marched: March | None = None
        self._left: dict[str, float] = {}  # of each task's share, s
        self._connection = self._connect()

    @property
    def functions(self) -> frozenset[str]:
        """Names of the functions and classes the module defines."""
        return self._connection.functions

    @property
    def faults(self) -> tuple[LoadFault, ...]:
        """What of the file could not be loaded."""
        return self._connection.faults

    # -- for checks -----------------------------------------------------------------------------------

    def call(self, name: str, *args: Any, **kwargs: Any) -> Any:
        """The result of the student's function, as plain data.

        Args:
            args, kwargs: plain data, arrays, right-hand sides of ``course.physics.systems`` (evaluated
                beside the student's code), functions and ``kit.black_box`` objects (evaluated here, at a cost
                of some 50 microseconds a call), ``ref(name)``, or generators (which cross as a seed).

        Raises:
            StudentFailure: it gave no value.
            CheckFailed: a function given to it refused its arguments.
        """
        given = self._kept(name, args) if not kwargs else None
        self.asking = (name, args)
        with self._asking(name) as worker:
            return self._hear("call", name, given, worker.call(name, *args, **kwargs))

    def call_inspect(self, name: str, *args: Any) -> Inspected:
        """Call it, and report its value and its arguments after the call."""
        given = self._kept(name, args)
        with self._asking(name) as worker:
            value, after, shared = worker.inspect(name, *args)
        self._hear("call", name, given, value)
        return Inspected(value, after, shared)

    def ref(self, name: str) -> Any:
        """The student's own function, to be passed back as an argument."""
        self.asked.add(name)
        if name not in self._live().functions:
            raise self._live().missing(name)
        return {"$function": name}

    def march(
        self, step_name: str, system: Any, q0: Any, v0: Any, h: float, n: int, t0: float = 0.0
    ) -> tuple[Any, Any, Any]:
        """``n`` steps in a row, in a loop in the student's process.

        Returns:
            Times (n + 1,) in s, positions and velocities (n + 1, d).

        Raises:
            CheckFailed: a step returned something other than two vectors of d numbers.
        """
        return self.march_each(step_name, [(system, q0, v0, h, n, t0)])[0]

    def march_each(
        self, step_name: str, marches: Sequence[tuple[Any, Any, Any, float, int, float]]
    ) -> list[tuple[Any, Any, Any]]:
        """Several marches in one round trip.

        Args:
            marches: (system, q0, v0, h, n, t0) of each, as for ``march``.
        """
        sent = [[rhs, list(q0), list(v0), float(t0), float(h), int(n)] for rhs, q0, v0, h, n, t0 in marches]
        with self._asking(step_name) as worker:
            values = self._told(step_name, worker.march(step_name, sent))
        paths = [
            (t0 + h * np.arange(n + 1), *as_march(value, n, len(q0)))
            for value, (_, q0, _, h, n, t0) in zip(values, marches, strict=True)
        ]
        for one, path in zip(marches, paths, strict=True):
            self._hear("march", step_name, self._kept(step_name, one), path)
        if self._home and self.marched is None:
            t, *states = paths[0]
            self.marched = step_name, marches[0][0], t, tuple(states)
        return paths

    def call_each(self, name: str, calls: Iterable[Sequence[Any]]) -> list[Any]:
        """The results of the student's function for each sequence of arguments, in one round trip.

        Raises:
            StudentFailure: one of the calls gave no value; the later ones were not made.
            CheckFailed: a later call changed what an earlier one had returned.
        """
        sent = [list(args) for args in calls]
        given = self._kept_each(name, sent)
        with self._asking(name) as worker:
            values, changed = worker.each(name, sent)
        for args, value in zip(given, values, strict=True):
            self._hear("call", name, args, value)
        if changed:
            raise overwritten(name)
        return self._told(name, values)

    def fold(
        self, name: str, state: Any, calls: Iterable[Sequence[Any]], *, keep: Sequence[str] | None = None
    ) -> list[Any]:
        """Pass a state through ``name(state, *args)``, once for each sequence of arguments.

        Args:
            keep: the keys to report of states that are dicts; the last state is complete.

        Returns:
            The n + 1 states, the given one first.
        """
        kept = None if keep is None else list(keep)
        with self._asking(name) as worker:
            states = worker.fold(name, state, [list(args) for args in calls], kept)
        return self._told(name, states)

    def _kept(self, name: str, args: Sequence[Any]) -> tuple[Any, ...] | None:
        """A copy of the arguments of a call that is listened to; None if not, or if they cannot be kept."""
        if name not in self._listened:
            return None
        try:
            return copy.deepcopy(tuple(args))
        except TypeError:  # one of the student's own functions, which is part of a worker
            return None

    def _kept_each(self, name: str, calls: Sequence[Sequence[Any]]) -> list[tuple[Any, ...] | None]:
        """The same of several calls, which may share a generator: each crossing takes a number from it."""
        if name not in self._listened:
            return [None] * len(calls)
        try:
            calls = copy.deepcopy(calls)
        except TypeError:
            return [self._kept(name, args) for args in calls]
        given = []
        for args in calls:
            given.append(self._kept(name, args))
            for arg in args:
                if isinstance(arg, np.random.Generator):
                    arg.integers(2**62)  # as it crosses
        return given

    def _hear(self, method: str, name: str, args: tuple[Any, ...] | None, value: T) -> T:
        if args is not None and (size := _weight(value)) <= self._room:
            self._room -= size
            self.heard.append(Heard(method, (name, *args), value))
        return self._told(name, value)

    def _told(self, name: str, value: T) -> T:
        self.returned = name, value
        return value

    # -- for the grader -------------------------------------------------------------------------------

    def begin_check(self, task: str = "", patience: float | None = None) -> None:
        """Start the clock of one check.

        Together, the checks of a task have half of the time that is left when the first of them begins, so
        that a function that never returns costs only its own task, however many checks it has. Files left by
        workers are deleted before the clock starts.

        Args:
            patience: seconds of CPU time, if this check has less than others.
        """
        most = self._timeout if patience is None else min(self._timeout, patience)
        self._cpu_left -= self._deadline.used
        self._wall_left -= self._deadline.wall
        if self._task:
            self._left[self._task] -= self._deadline.used
        self._spawner.tidy()
        left = min(self._left.setdefault(task, self._cpu_left / 2), self._cpu_left)
        self._task = task
        self._deadline = Deadline(min(most, left), min(WALL * most, self._wall_left))
        self.returned = self.asking = None
        self.asked, self.marched = set(), None
        self.heard = []
        self._connection.deadline = self._deadline
        self._printed_before = len(self._connection.output()) if self._connection.alive else 0

    def not_charged(self, seconds: float) -> None:
        """So much of the check's time went into the search for a cause: it is not taken from later checks.

        All searches together have ``SEARCH_S``; what they take beyond that counts.
        """
        free = min(seconds, self._search_left)
        self._search_left -= free
        self._cpu_left += free
        self._wall_left += WALL * free
        if self._task:
            self._left[self._task] += free

    @property
    def used(self) -> float:
        """Seconds of CPU time that the check has taken."""
        return self._deadline.used

    def printed(self) -> str:
        """The submission's output since the check began."""
        return self._connection.output()[self._printed_before :]

    def give_up(self) -> None:
        """From another thread: its time is over, for the present call and all later ones."""
        self._cpu_left = self._wall_left = 0.0
        self._deadline.end()

    def close(self) -> None:
        """End the worker, and delete what it left."""
        self._connection.close()
        self._spawner.tidy()

    def _connect(self) -> Connection:
        try:
            return self._loaded()
        except LoadRefusedError as refused:
            if self._needed or refused.stage not in {"timeout", "crash"}:
                raise
            # Something beside the functions may hang or end the process: without that they can be had.
            self._needed = self._tasks
            self._cpu_left -= self._deadline.used
            self._wall_left -= self._deadline.wall
            self._deadline = Deadline(min(self._patience, self._cpu_left))
            try:
                connection = self._loaded()
            except LoadRefusedError:
                raise refused from None
            if not connection.functions.intersection(self._tasks):
                connection.close()
                raise refused
            self.without = refused
            return connection

    def _loaded(self) -> Connection:
        return Connection(
            self._spawner, self._files, self._main, self._deadline, asks=self._home, needed=self._needed
        )

    @contextlib.contextmanager
    def _asking(self, name: str) -> Iterator[Connection]:
        """The worker to call a function in; its failures know how lines are named."""
        self.asked.add(name)
        try:
            yield self._live()
        except StudentFailure as failure:
            failure.places = self._places
            if failure.type == "NameError":
                failure.why = self._connection.brought(failure.message.partition("'")[2].partition("'")[0])
            raise

    def _live(self) -> Connection:
        if monotonic() > self._deadline.earliest and self._deadline.passed():
            raise StudentFailure("timeout", message="it ran out of time")
        if not self._connection.alive:
            told, functions = (self._connection.faults, self.without), self._connection.functions
            try:
                self._connection = self._connect()
                # What is said of a file was known before its code received any input: by now it may know one,
                # and tell it by what it lacks.
                self._connection.faults, self.without = told
                if not functions.intersection(self._tasks) <= self._connection.functions:
                    self._connection.close()
                    raise StudentFailure("crash", message="functions were gone when it was loaded again")
                self._printed_before = len(self._connection.output())
            except LoadRefusedError as error:
                # It loaded before, so the submission itself makes the difference.
                raise error.failure from None
        return self._connection
