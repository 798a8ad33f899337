"""The process that runs a stranger's code: loads one submission and answers calls.

Everything here shares an address space with code that may be hostile, so it contains no secrets, and
everything it reports is only a claim. It imports the standard library, numpy and the files copied beside it
(the wire, the loops and the right-hand sides), and nothing of this course.
"""

from __future__ import annotations

import contextlib
import gc
import importlib.util
import io
import itertools
import math
import os
import signal
import sys
import traceback
import types
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import socket

from ...physics import systems
from . import loading, loops, statements, wire

Kind = wire.Kind

_MAX_NESTING = 8
_RECV = 1 << 12
_HEADER = wire.HEADER.unpack_from
_CALLBACK, _REPLY = int(Kind.CALLBACK), int(Kind.REPLY)


class CallbackError(ValueError):
    """Raised in student code when the grader's function refuses its arguments."""


class CappedText(io.TextIOBase):
    """A text stream that keeps the first ``wire.MAX_OUTPUT`` bytes: printing a lot is not an error.

    What is written at once, as a number is, is kept whole or not at all, unless it has several lines.
    """

    def __init__(self, descriptor: int) -> None:
        super().__init__()
        self._descriptor = descriptor
        self._left = wire.MAX_OUTPUT - len(wire.CUT)

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._descriptor

    def write(self, text: str) -> int:
        if self._left > 0:
            kept = str(text).encode("utf-8", "replace")
            if len(kept) > self._left:
                kept = kept[: kept.rfind(b"\n", 0, self._left) + 1] + wire.CUT.encode()
                self._left = 0
            self._left -= len(kept)
            with contextlib.suppress(OSError):  # a full or closed output must not fail a print
                os.write(self._descriptor, kept)
        return len(text)


class Worker:
    """Answers one grader over one socket until the socket closes.

    Args:
        imports: top-level packages the submission may import beside the standard library.
    """

    def __init__(self, sock: socket.socket, imports: frozenset[str]) -> None:
        self._sock = sock
        self._buffer = b""
        self._codec = wire.Codec(self, accept_bytes=True)
        self._imports = imports
        self._module = types.ModuleType("submission")
        self._held: list[Any] = []  # callables of the student's that the grader may call back
        self._nesting = 0
        self._main = ""
        self._looks: list[list[tuple[types.FrameType, int]]] = []

    def serve(self) -> None:
        """Say that this process is ready, then answer until the grader closes the connection."""
        self._send(Kind.READY, None)
        while True:
            try:
                kind, value = self._receive()
            except EOFError:
                return
            self._answer(kind, value)

    # -- names: how references and right-hand sides appear here --------------------------------------

    def lower(self, value: Any) -> Any:
        if isinstance(value, _Callback):
            return wire.Reference(value.number, mine=True)
        if type(value) in _SYSTEM_TYPES:
            return wire.Rhs(type(value).__name__, value.params())
        if callable(value):
            self._held.append(value)
            return wire.Reference(len(self._held) - 1, mine=False)
        return None

    def raise_(self, value: Any) -> Any:
        if isinstance(value, wire.Rhs):
            return systems.SYSTEMS[value.name](**value.params)
        if isinstance(value, wire.Seed):
            return np.random.default_rng(value.value)
        if value.mine:
            return self._held[value.number]
        return _Callback(self, value.number)

    def look(self, _number: int, frame: types.FrameType | None) -> None:
        """Note where the submission is; at the last look, report the frames that were there every time."""
        seen = []
        while frame is not None:
            if frame.f_code.co_filename == self._main:
                seen.append((frame, frame.f_lineno))
            frame = frame.f_back
        self._looks.append(seen[::-1])
        if len(self._looks) < wire.LOOKS:
            return
        lines = [{id(frame): line for frame, line in look} for look in self._looks]
        lasting = [frame for frame, _ in seen[::-1] if all(id(frame) in look for look in lines)]
        frames = [[self._main, lines[-1][id(frame)], frame.f_code.co_name[:100]] for frame in lasting[-12:]]
        innermost = [look[id(lasting[-1])] for look in lines] if lasting else []
        self._send(Kind.STUCK, {"frames": frames, "lines": innermost})

    # -- frames ---------------------------------------------------------------------------------------

    def _receive(self) -> tuple[int, Any]:
        buffer = self._buffer or self._sock.recv(_RECV)
        while len(buffer) < 5:
            chunk = self._sock.recv(_RECV)
            if not chunk:
                raise EOFError
            buffer += chunk
        length, kind = _HEADER(buffer)
        end = 4 + length
        if len(buffer) >= end:
            self._buffer = buffer[end:]
            return kind, self._codec.decode(buffer[5:end])
        frame, at = wire.room_for(end, buffer), len(buffer)
        self._buffer = b""
        while at < end:
            size = self._sock.recv_into(frame[at:])
            if not size:
                raise EOFError
            at += size
        return kind, self._codec.decode(frame[5:])

    def _send(self, kind: wire.Kind, value: Any) -> None:
        self._sock.sendall(self._codec.encode(kind, value))

    def _answer(self, kind: int, value: Any) -> None:
        if kind == Kind.LOAD:
            self._load(*value)
            return
        try:
            if kind == Kind.CALL:
                result = self._call(*value)
            elif kind == Kind.MARCH:
                step, marches = self._function(value[0]), value[1]
                result = [loops.march(step, *march) for march in marches]
            elif kind == Kind.EACH:
                result = loops.each(self._function(value[0]), map(self._owned, value[1]))
            elif kind == Kind.FOLD:
                function, state, calls, *how = value
                result = loops.fold(self._function(function), state, map(self._owned, calls), *how)
            else:
                raise wire.WireError(f"unexpected kind {kind}")
            frame = self._codec.encode(Kind.RESULT, result)
        except wire.UnsupportedValueError as error:
            self._send(Kind.RAISED, {"type": "UnsupportedValue", "message": str(error)})
        except BaseException as error:  # noqa: BLE001 - whatever student code raises is the answer
            self._send(Kind.RAISED, _described(error))
        else:
            self._sock.sendall(frame)
        if not self._nesting:
            self._held.clear()

    # -- loading --------------------------------------------------------------------------------------

    def _load(self, files: dict[str, bytes], main: str, needed: list[str]) -> None:
        """Write the submission's files to the working folder and run its main module from memory.

        Byte-order marks, line endings and declared encodings are read as Python reads a file that it runs;
        ``compile`` on bare bytes would let undeclared ones pass in comments on some versions.

        Args:
            needed: functions of which nothing but what they need is to be run; empty for the whole file.
        """
        self._main = main
        for name, content in files.items():
            with contextlib.suppress(OSError), open(name, "wb") as handle:  # noqa: PTH123
                handle.write(content)
        sys.path.insert(0, os.getcwd())  # noqa: PTH109 - pathlib is not worth its import here
        imports = loading.Imports(self._imports | {name[:-3] for name in files}, self._imports)
        sys.meta_path.insert(0, imports)
        try:
            source = importlib.util.decode_source(files[main])
        except (SyntaxError, ValueError, LookupError) as error:
            if isinstance(error, LookupError):  # rot13, hex, zlib: codecs, and not of text
                error = SyntaxError("the encoding that its first lines declare is none of text")
            refused = {"stage": "syntax", **_described(error)}
            if line := statements.line_of_bytes(files[main], error):
                refused["line"] = line
            self._send(Kind.REFUSED, refused)
            return
        module = loading.Loading(source, main, imports, needed)
        if not module.run():
            fault = module.faults[0]
            self._send(Kind.REFUSED, {"stage": fault.stage, **_described(fault.error)})
            return
        loading.StandIn.loading = False
        self._module = module.module
        loaded = list(vars(self._module).items())
        names = [name for name, value in loaded if callable(value) and type(name) is str]
        faults = [
            {"stage": it.stage, "at": it.line, "names": it.names, **_described(it.error)}
            for it in module.faults
        ]
        self._send(Kind.LOADED, {"names": names[:1000], "faults": faults})

    # -- calls ----------------------------------------------------------------------------------------

    def _function(self, spec: Any) -> Any:
        """A function by name, or one that came as a reference."""
        return getattr(self._module, spec) if isinstance(spec, str) else spec

    def _call(self, spec: Any, args: list[Any], kwargs: dict[str, Any], inspect: bool) -> Any:
        function = self._function(spec)
        args = self._owned(args)
        value = function(*args, **{name: self._own(argument) for name, argument in kwargs.items()})
        if not inspect:
            return value
        # Generators and objects of methods have no value to look at.
        after = [None if isinstance(arg, np.random.Generator | loops.Methods) else arg for arg in args]
        return [value, after, shares_memory(value, args)]

    def _owned(self, args: list[Any]) -> list[Any]:
        return [self._own(argument) for argument in args]

    def _own(self, argument: Any) -> Any:
        """``{"$function": name}`` stands for the submission's own function of that name, and
        ``{"$methods": {...}}`` for an object with the grader's functions as methods."""
        if type(argument) is dict and len(argument) == 1:
            if "$function" in argument:
                return getattr(self._module, argument["$function"])
            if "$methods" in argument:
                return loops.Methods(**argument["$methods"])
        return argument

    def callback(self, number: int, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        """Ask the grader to evaluate one of its functions; meanwhile, answer calls from the grader."""
        self._sock.sendall(self._codec.encode(_CALLBACK, (number, kwargs or None, *args)))
        kind, value = self._receive()
        if kind == _REPLY:
            return value
        self._nesting += 1
        try:
            while kind != Kind.REPLY:
                if kind == Kind.REPLY_RAISE:
                    raise CallbackError(value)
                if self._nesting > _MAX_NESTING:
                    raise RecursionError("functions that call each other across the grader too deeply")
                self._answer(kind, value)
                kind, value = self._receive()
        finally:
            self._nesting -= 1
        return value


class _Callback:
    """A function of the grader's: calling it asks the grader, and reveals nothing about how it works."""

    __slots__ = ("_worker", "number")

    def __init__(self, worker: Worker, number: int) -> None:
        self._worker = worker
        self.number = number

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        return self._worker.callback(self.number, args, kwargs)


_SYSTEM_TYPES = frozenset(systems.SYSTEMS.values())


def _arrays(value: Any, depth: int = 4) -> list[np.ndarray[Any, Any]]:
    if isinstance(value, np.ndarray):
        return [value]
    if depth and isinstance(value, list | tuple):
        return [array for item in value for array in _arrays(item, depth - 1)]
    return []


def shares_memory(value: Any, args: list[Any]) -> bool:
    """Whether a returned array is, or is a view of, one of the arguments' arrays."""
    given = _arrays(args)
    return any(np.may_share_memory(a, b) for a in _arrays(value) for b in given)


def _described(error: BaseException) -> dict[str, Any]:
    """An exception as plain values: its type, its message and where in the student's code it arose."""
    try:
        message = str(error)[:2000]
    except BaseException:  # noqa: BLE001 - a hostile __str__ must not take the answer away
        message = "(an exception that cannot be printed)"
    frames = [
        [frame.f_code.co_filename[:200], line, frame.f_code.co_name[:100]]
        for frame, line in itertools.islice(traceback.walk_tb(error.__traceback__), 1000)
        if not frame.f_code.co_filename.startswith(_OWN_FOLDER)
    ]
    described: dict[str, Any] = {
        "type": type(error).__name__[:100],
        "message": message,
        "frames": frames[-12:],
        "bases": [base.__name__[:100] for base in type(error).__mro__[:10]],
    }
    if isinstance(error, SyntaxError):
        line = error.lineno
        described["line"] = line if isinstance(line, int) and math.isfinite(line) else 0
        described["text"] = str(error.text or "")[:200].rstrip("\n")
        described["message"] = str(error.msg)[:500]
    return described


_OWN_FOLDER = os.path.dirname(__file__)  # noqa: PTH120 - pathlib is not worth its import here


def run(sock: socket.socket, imports: frozenset[str]) -> None:
    """Serve one submission over ``sock``; never returns."""
    sys.stdout = CappedText(1)
    sys.stderr = CappedText(2)
    gc.enable()
    worker = Worker(sock, imports)
    if wire.LOOK is not None:
        signal.signal(wire.LOOK, worker.look)
    try:
        worker.serve()
    except BaseException:  # noqa: BLE001 - the last words go where the grader looks for them
        traceback.print_exc()
        os._exit(1)
    os._exit(0)
