"""The trusted end of one worker: sends calls, answers callbacks, keeps the deadline, and trusts nothing.

Nothing here waits for untrusted code without a deadline, nothing un-pickles, and a message out of turn ends
the worker instead of the grader.
"""

from __future__ import annotations

import ast
import contextlib
import functools
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from time import monotonic, sleep
from typing import Any, NamedTuple

from course.isolation.failures import (
    IsolationError,
    StudentFailure,
    claimed_line,
    claimed_names,
    claimed_text,
    raised,
)
from course.isolation.inside import statements, wire
from course.isolation.levels import START_TIMEOUT, Deadline, Exit, Handle, Spawner
from course.physics import systems
from course.printable import printable

# ---
# Where a student's code is when it does not answer; used only at home, where nothing is hidden.
#
# The worker is sampled a few times. A function that ends in between is not the one that hangs, so only the
# calls that are present in every sample count, and in the innermost of them the loop that it was in each
# time.


#: ``StudentFailure.type`` of a timeout whose line is the first one of a loop.
LOOP = "loop"
_BETWEEN_S = 0.05  # a step of a simulation takes far less, so it is not mistaken for the hang
_ANSWER_S = 1.0
_MOST = 1 << 16  # bytes; an answer has some hundreds


def where_it_hangs(handle: Handle, begun: bytes, main: str, source: bytes) -> StudentFailure | None:
    """The timeout with the line it hangs at; None if the worker does not say, or cannot be asked.

    Args:
        handle: the worker, which is to be ended afterwards.
        begun: what came from it and was not read yet.
        main: name of the submission's file.
    """
    if wire.LOOK is None:
        return None
    for _ in range(wire.LOOKS):
        handle.look()
        sleep(_BETWEEN_S)
    said = _answer(handle, begun)
    text = source.decode("utf-8", "replace")
    failure = raised(said, main, text.splitlines()) if said is not None else None
    if failure is None or failure.line is None:
        return None
    lines = said.get("lines") if isinstance(said, dict) else None
    seen = [line for line in lines if type(line) is int] if isinstance(lines, list) else []
    head = _loop_around(text, seen or [failure.line])
    return StudentFailure(
        "timeout", type=LOOP if head else "", line=head or failure.line, traceback=failure.traceback
    )


def _answer(handle: Handle, buffer: bytes) -> Any:
    """The place in the code that the worker reports; None if it sends nothing that can be read as one."""
    codec, deadline = wire.Codec(), Deadline(_ANSWER_S)
    deadline.watch(handle)
    while not deadline.passed() and len(buffer) < _MOST:
        if len(buffer) >= wire.HEADER.size:
            length, kind = wire.HEADER.unpack_from(buffer)
            if not 0 < length < _MOST:
                return None
            if len(buffer) >= 4 + length:
                if kind == wire.Kind.STUCK:
                    with contextlib.suppress(wire.WireError):
                        return codec.decode(buffer[wire.HEADER.size : 4 + length])
                    return None
                buffer = buffer[4 + length :]
                continue
        try:
            received = handle.channel.recv(_RECV)
        except (BlockingIOError, TimeoutError):
            # On a busy machine several looks may have reached it as one.
            handle.look()
            continue
        except OSError:
            return None
        if not received:
            return None
        buffer += received
    return None


def _loop_around(text: str, lines: list[int]) -> int | None:
    """The first line of the smallest loop that all these lines are in; None if there is none."""
    tree = statements.tree(text)
    if tree is None:
        return None
    loops = [
        (node.end_lineno - node.lineno, node.lineno)
        for node in ast.walk(tree)
        if isinstance(node, ast.While | ast.For) and node.end_lineno is not None
        if all(node.lineno <= line <= node.end_lineno for line in lines)
    ]
    return min(loops)[1] if loops else None


Kind = wire.Kind
_CALLBACK, _REPLY = int(Kind.CALLBACK), int(Kind.REPLY)
_RECV = 1 << 12
_SEND = 1 << 16
_HEADER = wire.HEADER.unpack_from
_MAX_NESTING = 8
#: The total size of the callbacks of one call, because a check may keep every argument it gets.
_CALLBACK_BYTES = 16 << 20
#: The total size of everything in one check: a check may keep all results, too. Accepted solutions of the
#: course were seen to need 1 MB.
_CHECK_BYTES = 32 << 20
_MOST_FAULTS = 60
_SYSTEM_TYPES = frozenset(systems.SYSTEMS.values())


@dataclass(eq=False)
class LoadRefusedError(Exception):
    """The submission could not be loaded at all.

    Attributes:
        stage: "syntax", "import", "timeout" or "crash".
        failure: what happened, as far as it is known.
        text: the offending line, for a syntax error.
        code: the line of the file.
        printed: what it printed till then.
    """

    stage: str
    failure: StudentFailure
    text: str = ""
    code: str = ""
    printed: str = ""

    def __post_init__(self) -> None:
        super().__init__(self.stage, str(self.failure))


class LoadFault(NamedTuple):
    """What of a submission could not be loaded, by its own account.

    Attributes:
        stage: "syntax", "import", "magic" for a line of IPython's, or "absent" for an import that something
            stands for.
        failure: why; its line is where what was left out begins.
        names: what that would have defined.
        text: the offending line, for a syntax error.
        code: that line of the file.
    """

    stage: str
    failure: StudentFailure
    names: frozenset[str]
    text: str = ""
    code: str = ""


class RemoteFunction:
    """A function of the student's that came as a value; calling it calls into the worker."""

    __slots__ = ("_connection", "number")

    def __init__(self, connection: Connection, number: int) -> None:
        self._connection = connection
        self.number = number

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        return self._connection.call(self, *args, **kwargs)


class Connection:
    """One worker with one submission loaded.

    Args:
        deadline: by which loading must be done.
        asks: ask where the code is if it does not answer in time. Only at home, because the code may have
            chosen the answer.
        needed: functions of which nothing but what they need is to be loaded; empty for all of the file.

    Attributes:
        functions: names of what can be called.
        faults: what was left out of the file.

    Raises:
        LoadRefusedError: the submission cannot be loaded.
        IsolationError: the worker could not be started or locked down.
    """

    def __init__(
        self,
        spawner: Spawner,
        files: Mapping[str, bytes],
        main: str,
        deadline: Deadline,
        *,
        asks: bool = False,
        needed: Sequence[str] = (),
    ) -> None:
        self._files = files
        self._needed = list(needed)
        self.faults: tuple[LoadFault, ...] = ()
        self._asks = asks
        self._main = main
        self._codec = wire.Codec(self)
        self._buffer = b""
        self._lent: list[Callable[..., Any]] = []
        self._nesting = 0
        self._refused: AssertionError | None = None
        self._received = 0  # bytes, since the call began
        self._taken = 0  # and since the check did
        self._printed = ""
        self._deadline = deadline
        self.alive = True
        self._handle: Handle = spawner.spawn()
        self._channel = self._handle.channel
        try:
            self.functions = self._load()
        except LoadRefusedError as refused:
            self.close()
            refused.printed = self._printed
            raise
        except BaseException:
            self.close()
            raise

    @property
    def deadline(self) -> Deadline:
        """By which the next answers must be there."""
        return self._deadline

    @deadline.setter
    def deadline(self, deadline: Deadline) -> None:
        self._deadline = deadline
        self._taken = 0
        if self.alive:
            deadline.watch(self._handle)

    # -- names: how functions and right-hand sides appear here ----------------------------------------

    def lower(self, value: Any) -> wire.Reference | wire.Rhs | wire.Seed | None:
        if type(value) in _SYSTEM_TYPES:
            return wire.Rhs(type(value).__name__, value.params())
        if isinstance(value, RemoteFunction):
            return wire.Reference(value.number, mine=True)
        numpy = sys.modules["numpy"]
        if isinstance(value, numpy.random.Generator):
            return wire.Seed(int(value.integers(2**62)))
        if callable(value):
            self._lent.append(value)
            return wire.Reference(len(self._lent) - 1, mine=False)
        return None

    def raise_(self, value: wire.Reference | wire.Rhs | wire.Seed) -> Any:
        if isinstance(value, wire.Reference):
            return self._lent[value.number] if value.mine else RemoteFunction(self, value.number)
        if isinstance(value, wire.Rhs):
            try:
                if not all(map(_few_numbers, value.params.values())):
                    raise TypeError
                return systems.SYSTEMS[value.name](**value.params)
            except Exception as error:  # noqa: BLE001 - any parameters may arrive
                message = f"a right-hand side that cannot be built: {type(error).__name__}"
                raise wire.WireError(message) from None
        raise wire.WireError("a seed from the worker")

    # -- calls ----------------------------------------------------------------------------------------

    def call(self, function: str | RemoteFunction, *args: Any, **kwargs: Any) -> Any:
        """The result of ``function``, as plain values (tuples as lists).

        Raises:
            StudentFailure: it raised, ran out of time, died, or returned what cannot cross.
        """
        return self._ask(Kind.CALL, [function, list(args), kwargs, False], function)

    def inspect(self, function: str, *args: Any) -> tuple[Any, list[Any], bool]:
        """Like ``call``; also the arguments as it left them, and whether the result shares their memory."""
        answer = self._ask(Kind.CALL, [function, list(args), {}, True], function)
        match answer:
            case [value, list() as after, bool() as shared] if len(after) == len(args):
                return value, after, shared
        raise self._breach("an inspection in another form")

    def march(self, step: str, marches: list[list[Any]]) -> list[Any]:
        """Positions and velocities of each march, or the worker's report why a step was unusable.

        Args:
            marches: [right-hand side, q0, v0, t0, h, n] each.
        """
        return self._batch(self._ask(Kind.MARCH, [step, marches], step), len(marches))

    def each(self, function: str, calls: list[list[Any]]) -> tuple[list[Any], bool]:
        """The results of ``function`` for each list of arguments; the loop runs in the student's process.

        Returns:
            The values, and whether a later call changed one of them.
        """
        values, changed = self._batch(self._ask(Kind.EACH, [function, calls], function), 2)
        return self._batch(values, len(calls)), changed is not None

    def fold(self, function: str, state: Any, calls: list[list[Any]], keep: list[str] | None) -> list[Any]:
        """The states that ``function(state, *args)`` goes through; see ``loops.fold``."""
        answer = self._ask(Kind.FOLD, [function, state, calls, keep], function)
        record, last = self._batch(answer, 2)
        record = self._batch(record, len(calls) + 1)
        return [*record[:-1], last] if keep is not None else record

    def _batch(self, answer: Any, length: int) -> list[Any]:
        if isinstance(answer, list) and len(answer) == length:
            return answer
        raise self._breach("a batch of another length")

    def output(self) -> str:
        return printable(self._handle.output()) if self.alive else self._printed

    def close(self) -> Exit | None:
        """How the worker ended; None if it had ended before."""
        if not self.alive:
            return None
        self.alive = False
        self._printed = printable(self._handle.output())
        self._deadline.watch(None)
        return self._handle.finish()

    # -- the conversation -----------------------------------------------------------------------------

    def _ask(self, kind: wire.Kind, request: list[Any], function: str | RemoteFunction) -> Any:
        name = function if isinstance(function, str) else "your function"
        if isinstance(function, str) and function not in self.functions:
            raise self.missing(function)
        if not self._nesting:
            self._lent.clear()
            self._refused = None
            self._received = 0
        try:
            frame = self._codec.encode(kind, request)
        except wire.TooMuchError as error:
            # Checks pass on what the code returned, with more beside it: that it just fitted is its doing.
            raise StudentFailure("protocol", type="UnsupportedValue", message=str(error)) from None
        except wire.UnsupportedValueError as error:
            raise IsolationError(f"a check passes {error} to {name}") from None
        self._deadline.waiting()
        self._send(frame)
        return self._await_result()

    def _await_result(self) -> Any:
        while True:
            kind, value = self._receive()
            if kind == _CALLBACK:
                if self._received > _CALLBACK_BYTES:
                    raise self._breach("more to the functions it was given than any solution needs")
                self._answer_callback(value)
            elif kind in (Kind.RESULT, Kind.RAISED):
                if self._refused is not None and not self._nesting:
                    # One of our functions refused its arguments: that is the finding, whatever the student's
                    # code did with the exception.
                    refused, self._refused = self._refused, None
                    raise refused
                if kind == Kind.RESULT:
                    return value
                raise self._raised(value)
            else:
                raise self._breach(f"a message of kind {kind}")

    def _answer_callback(self, value: Any) -> None:
        try:
            number, kwargs, *args = value
            if type(number) is not int or number < 0 or not (kwargs is None or type(kwargs) is dict):
                raise TypeError
            function = self._lent[number]
        except (TypeError, ValueError, IndexError):
            raise self._breach("a callback in another form") from None
        if self._nesting >= _MAX_NESTING:
            raise self._breach("functions that call each other across the grader too deeply")
        self._nesting += 1
        try:
            answer = self._codec.encode(_REPLY, function(*args, **(kwargs or {})))
        except (StudentFailure, IsolationError):
            raise
        except Exception as error:  # noqa: BLE001 - anything may be passed; the caller hears what was wrong
            if isinstance(error, AssertionError):
                self._refused = self._refused or error
            answer = self._codec.encode(Kind.REPLY_RAISE, f"{type(error).__name__}: {error}"[:500])
        finally:
            self._nesting -= 1
        self._send(answer)

    def missing(self, function: str) -> StudentFailure:
        """The failure of a function that is not there, with the reason if it was left out."""
        fault = next((fault for fault in self.faults if function in fault.names), None)
        return StudentFailure.missing(function, fault.failure if fault else None)

    def brought(self, name: str) -> StudentFailure | None:
        """What kept a name from being defined: its statement's failure, or that of a star import."""
        found = [fault for fault in self.faults if {name, "*"} & fault.names]
        return max(found, key=lambda fault: name in fault.names).failure if found else None

    def _load(self) -> frozenset[str]:
        self._await_lockdown()
        try:
            request = [dict(self._files), self._main, self._needed]
            self._send(wire.Codec().encode(Kind.LOAD, request))
            kind, value = self._receive()
        except StudentFailure as failure:
            raise LoadRefusedError(failure.kind, failure) from None
        if kind == Kind.LOADED and isinstance(value, dict):
            faults = value.get("faults")
            claims = faults[:_MOST_FAULTS] if isinstance(faults, list) else []
            self.faults = tuple(self._fault(claim) for claim in claims if isinstance(claim, dict))
            return frozenset(claimed_names(value.get("names")))
        if kind == Kind.REFUSED and isinstance(value, dict):
            fault = self._fault(value)
            stage = fault.stage if fault.stage == "syntax" else "import"
            raise LoadRefusedError(stage, fault.failure, fault.text, fault.code)
        raise LoadRefusedError("crash", self._breach("an answer of another form"))

    def _await_lockdown(self) -> None:
        """The worker's first message, sent before it is given a student's code: the only one that is trusted.

        The time for starting does not count.
        """
        deadline, self._deadline = self._deadline, Deadline(START_TIMEOUT, START_TIMEOUT)
        try:
            kind, value = self._receive()
        except StudentFailure as failure:
            raise IsolationError(f"a worker did not get ready: {failure.message}") from None
        if kind != Kind.READY:
            self.close()
            raise IsolationError(f"a worker could not be locked down: {value}")
        deadline.postpone(self._deadline.wall)
        self.deadline = deadline

    def _fault(self, value: dict[str, Any]) -> LoadFault:
        failure = self._raised(value)
        line = claimed_line(value.get("at"), self._lines)
        failure.line = line or failure.line
        said = value.get("stage")
        stage = said if said in ("syntax", "magic", "absent") else "import"
        names = frozenset(claimed_names(value.get("names")))
        code = self._lines[failure.line - 1] if failure.line else ""
        return LoadFault(stage, failure, names, claimed_text(value.get("text")), claimed_text(code, 200))

    @functools.cached_property
    def _lines(self) -> list[str]:
        """Of its file; a million of them are told apart once, and not for each claim about one."""
        return self._files[self._main].decode("utf-8", "replace").splitlines()

    def _raised(self, value: Any) -> StudentFailure:
        return raised(value, self._main, self._lines) or self._breach("an exception in another form")

    # -- frames ---------------------------------------------------------------------------------------

    def _send(self, frame: bytearray) -> None:
        rest: bytearray | memoryview = frame if len(frame) <= _SEND else memoryview(frame)
        while rest:
            try:
                # In pieces: a write waits anew whenever the other side has read a little of it.
                sent = self._channel.send(rest[:_SEND])
                if sent == len(rest):
                    return
                rest = memoryview(rest)[sent:]
                self._check_deadline()
            except (BlockingIOError, TimeoutError):
                self._check_deadline()
            except OSError:
                raise self._ended() from None

    def _receive(self) -> tuple[int, Any]:
        buffer = self._buffer or self._read(self._channel.recv, _RECV)
        while len(buffer) < 5:
            buffer += self._read(self._channel.recv, _RECV)
        length, kind = _HEADER(buffer)
        if not 0 < length <= wire.MAX_FRAME:
            raise self._breach("a frame of impossible length")
        end = 4 + length
        self._received += end
        self._taken += end
        if self._taken > _CHECK_BYTES:
            raise self._breach("more in one check than any solution needs")
        if len(buffer) >= end:
            body: bytes | memoryview = buffer[5:end]
            self._buffer = buffer[end:]
        else:
            body, self._buffer = self._read_rest(buffer, end)[5:], b""
        if monotonic() > self._deadline.earliest:
            self._check_deadline()  # a worker that keeps calling back never lets a read block
        try:
            return kind, self._codec.decode(body)
        except wire.WireError as error:
            raise self._breach(str(error)) from None

    def _read_rest(self, begun: bytes, end: int) -> memoryview:
        frame, at = wire.room_for(end, begun), len(begun)
        while at < end:
            at += self._read(self._channel.recv_into, frame[at:])
            self._check_deadline()  # one that trickles never lets a read block
        return frame

    def _read(self, receive: Callable[[Any], Any], what: Any) -> Any:
        while True:
            try:
                received = receive(what)
            except (BlockingIOError, TimeoutError):
                self._check_deadline()
                continue
            except OSError:
                raise self._ended() from None
            if not received:
                raise self._ended()
            return received

    def _check_deadline(self) -> None:
        if self._deadline.passed():
            raise self._timeout()

    def _timeout(self) -> StudentFailure:
        at = None
        if self._asks and self.alive:
            at = where_it_hangs(self._handle, self._buffer, self._main, self._files[self._main])
        self.close()
        return at or StudentFailure("timeout", message="it ran out of time")

    def _breach(self, what: str) -> StudentFailure:
        self.close()
        return StudentFailure("protocol", type="ProtocolBreach", message=f"the process sent {what}")

    def _ended(self) -> StudentFailure:
        """The process ended without an answer."""
        end = self.close()
        how = f"signal {end.signal}" if end and end.signal else f"exit code {end.code if end else 0}"
        return StudentFailure("crash", type=how, message=f"its process ended by itself ({how})")


def _few_numbers(value: Any) -> bool:
    """Whether it can be a parameter of a right-hand side: a number, or a handful of them."""
    if isinstance(value, list):
        return len(value) <= 64 and all(isinstance(item, int | float) for item in value)
    return isinstance(value, int | float)
