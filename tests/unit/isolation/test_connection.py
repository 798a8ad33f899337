"""The trusted end of the wire: what it believes of a worker, and how long it waits for one.

The worker here is a script of bytes sent over a socket pair, so each lie can be told by itself.
"""

import contextlib
import socket
import struct
import threading
from time import monotonic

import numpy as np
import pytest

from course.isolation.failures import IsolationError, StudentFailure
from course.isolation.inside.wire import Codec, Kind
from course.isolation.levels import Deadline, Exit, ticking
from course.isolation.session import Connection, LoadRefusedError, RemoteFunction
from course.physics import systems

_SOURCE = b"def f(x):\n    return x\n\nlast = 1\n"


class Liar:
    """A spawner and the worker it starts: a thread that sends each frame of its script, or calls it."""

    level = "L1"

    def __init__(self, *script):
        self._script = script
        self.printed = ""

    def spawn(self):
        self._ours, self._theirs = socket.socketpair()
        self.channel = ticking(self._ours)
        self._thread = threading.Thread(target=self._play, daemon=True)
        self._thread.start()
        return self

    def _play(self):
        with contextlib.suppress(OSError):
            for step in self._script:
                if callable(step):
                    step(self._theirs)
                else:
                    self._theirs.sendall(step)

    def output(self):
        return self.printed

    def cpu_s(self):
        return monotonic()  # a thread of this process: there is no other clock for it

    def asleep(self):
        return False

    def finish(self):
        for end in (self._ours, self._theirs):
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)  # wakes the thread, which closing alone would not
            end.close()
        return Exit(0, 0)


READY = Codec().encode(Kind.READY, None)
LOADED = Codec().encode(Kind.LOADED, {"names": ["f", "g"], "faults": []})


def _frame(kind, body):
    return struct.pack("<IB", len(body) + 1, kind) + body


def _value(kind, value):
    return Codec().encode(kind, value)


_opened = []


@pytest.fixture(autouse=True)
def _closed():
    yield
    while _opened:
        _opened.pop().close()


def _connect(*script, seconds=2.0, loaded=True):
    liar = Liar(*((READY, LOADED) if loaded else ()), *script)
    _opened.append(Connection(liar, {"a.py": _SOURCE}, "a.py", Deadline(seconds)))
    return _opened[-1]


def _failure(connection, *arguments, name="f"):
    with pytest.raises(StudentFailure) as caught:
        connection.call(name, *arguments)
    return caught.value


def _refusal(*frames, seconds=2.0):
    """The stage at which loading is refused."""
    with pytest.raises(LoadRefusedError) as caught:
        _connect(*frames, loaded=False, seconds=seconds)
    return caught.value.stage


def test_an_answer_is_taken_as_a_plain_value():
    connection = _connect(_value(Kind.RESULT, [1.0, None]))
    assert connection.call("f", 1) == [1.0, None]


def test_a_name_that_was_not_loaded_is_missing_without_asking():
    connection = _connect()
    assert _failure(connection, name="h").kind == "missing"


# -- starting -------------------------------------------------------------------------------------------


def test_a_lockdown_that_failed_is_our_fault():
    with pytest.raises(IsolationError, match="no Landlock"):
        _connect(_value(Kind.REFUSED, "LockdownError: no Landlock"), loaded=False)


def test_a_worker_that_ends_before_it_is_ready_is_our_fault():
    with pytest.raises(IsolationError, match="ready"):
        _connect(lambda theirs: theirs.close(), loaded=False)


def test_a_submission_cannot_claim_that_the_lockdown_failed():
    claim = {"stage": "lockdown", "message": "no Landlock", "type": "LockdownError"}
    assert _refusal(READY, _value(Kind.REFUSED, claim)) == "import"


def test_time_to_start_is_not_taken_from_the_submission():
    def late(theirs):
        threading.Event().wait(0.4)
        theirs.sendall(READY + LOADED)

    connection = _connect(late, seconds=0.2, loaded=False)
    assert connection.functions == {"f", "g"}


def test_loading_that_takes_too_long_is_the_submissions_timeout():
    assert _refusal(READY, seconds=0.2) == "timeout"


# -- answers --------------------------------------------------------------------------------------------

_BREACHES = {
    "a kind that is the grader's": _value(Kind.CALL, None),
    "ready again": READY,
    "loaded again": LOADED,
    "no length": struct.pack("<IB", 0, Kind.RESULT),
    "too long": struct.pack("<IB", 0xFFFFFFFF, Kind.RESULT),
    "not a value": _frame(Kind.RESULT, b"?"),
    "systems in systems": _frame(Kind.RESULT, b"p" * 100_000),
    "a seed": _frame(Kind.RESULT, b"g" + b"\0" * 8),
    "a function that was not lent": _frame(Kind.RESULT, b"c" + struct.pack("<I", 99)),
    "an unknown system": _frame(Kind.RESULT, b"p" + _value(0, "X")[5:] + _value(0, {})[5:]),
    "a system of a million numbers": _frame(
        Kind.RESULT, b"p" + _value(0, "Oscillator")[5:] + _value(0, {"omega": np.zeros(1 << 20)})[5:]
    ),
    "an exception that is no dict": _value(Kind.RAISED, [1]),
    "a callback without number": _value(Kind.CALLBACK, []),
    "a callback of number -1": _value(Kind.CALLBACK, [-1, None]),
    "a callback of number True": _value(Kind.CALLBACK, [False, None]),
    "a callback of an array": _value(Kind.CALLBACK, np.zeros(3)),
    "a callback beyond those lent": _value(Kind.CALLBACK, [1, None]),
    "keywords that are no dict": _value(Kind.CALLBACK, [0, 5]),
}


@pytest.mark.parametrize("frame", _BREACHES.values(), ids=_BREACHES.keys())
def test_speaking_out_of_turn_ends_the_worker_and_nothing_else(frame):
    connection = _connect(frame)
    assert _failure(connection, lambda: 1).kind == "protocol"
    assert not connection.alive


_REPORTS = {
    "arrays": {"type": "E", "message": "m", "frames": np.zeros(3), "bases": np.zeros(2), "line": 1.5},
    "numbers": {"type": 1, "message": 2, "frames": 3, "bases": 4, "line": None},
    "odd frames": {
        "frames": [[["x"], 1, "f"], [np.zeros(2), 1, "f"], [1], 7, [{}, {}, {}]],
        "bases": [[1], {}],
    },
    "text": {"frames": "text", "bases": "text", "line": True},
    "nothing": {},
}


@pytest.mark.parametrize("report", _REPORTS.values(), ids=_REPORTS.keys())
def test_a_report_of_an_exception_in_any_form_is_an_error_of_the_submission(report):
    connection = _connect(_value(Kind.RAISED, report))
    failure = _failure(connection)
    assert failure.kind == "error"
    assert failure.line is None


@pytest.mark.parametrize(
    ("line", "taken"), [(2, 2), (0, None), (5, None), (-1, None), (2**62, None), (True, None)]
)
def test_only_lines_that_the_file_has_are_believed(line, taken):
    for report in ({"line": line}, {"frames": [["a.py", line, "f"]]}):
        connection = _connect(_value(Kind.RAISED, report))
        assert _failure(connection).line == taken


def test_the_lines_of_a_file_are_told_apart_once_whatever_is_claimed_of_them():
    """A million of them, for each of twenty claims at each loading, took the grader 37 s of CPU."""

    class Read(bytes):
        times = 0

        def decode(self, *args):
            Read.times += 1
            return super().decode(*args)

    report = _value(Kind.RAISED, {"type": "E", "frames": [["a.py", 2, "f"]], "line": 2})
    connection = _connect(*[report] * 5)
    connection._files = {"a.py": Read(_SOURCE)}
    for _ in range(5):
        assert _failure(connection).line == 2
    assert Read.times == 1


def test_a_traceback_shows_the_last_frames_of_the_students_file_only():
    frames = [["/usr/lib/numpy.py", 1, "n"], *[["a.py", 1, "f"]] * 3_000, ["a.py", 2, "g\x1b[2J"]]
    connection = _connect(_value(Kind.RAISED, {"type": "E", "frames": frames}))
    lines = _failure(connection).traceback.splitlines()
    assert len(lines) <= 24
    assert lines[-2:] == ["a.py:2 in g\\x1b[2J", "    return x"]


def test_what_a_submission_says_cannot_steer_a_terminal():
    connection = _connect(
        _value(Kind.RAISED, {"type": "\x1b[2J", "message": "\x9b\u202e\r\n", "bases": ["\x07"]})
    )
    connection._handle.printed = "\x1b[1A100/100"
    failure = _failure(connection)
    assert (failure.type, failure.message) == ("\\x1b[2J", "\\x9b\\u202e\\r\\n")
    assert connection.output() == "\\x1b[1A100/100"
    connection.close()
    assert connection.output() == "\\x1b[1A100/100"


# -- callbacks ------------------------------------------------------------------------------------------


def test_functions_are_evaluated_here_and_counted_here():
    seen = []
    connection = _connect(_value(Kind.CALLBACK, [0, None, 2.0]), _value(Kind.RESULT, 1))
    assert connection.call("f", seen.append) == 1
    assert seen == [2.0]


def test_more_data_than_any_solution_needs_ends_a_call():
    kept = []
    connection = _connect(*[_value(Kind.CALLBACK, [0, None, np.zeros(1 << 18)])] * 20, _value(Kind.RESULT, 1))
    assert _failure(connection, kept.append).kind == "protocol"
    assert sum(array.nbytes for array in kept) <= 18 << 20


def test_each_call_may_use_the_allowance_anew():
    frames = [_value(Kind.CALLBACK, [0, None, np.zeros(1 << 20)]), _value(Kind.RESULT, 1)] * 3
    connection = _connect(*frames)
    assert [connection.call("f", lambda array: None) for _ in range(3)] == [1] * 3


def test_all_that_comes_in_one_check_has_a_limit_and_the_next_check_begins_anew():
    connection = _connect(*[_value(Kind.RESULT, np.zeros(1 << 20))] * 7)
    for _ in range(2):
        connection.deadline = Deadline(2.0)
        for _ in range(3):
            connection.call("f")
    connection = _connect(*[_value(Kind.RESULT, np.zeros(1 << 20))] * 4)
    for _ in range(3):
        connection.call("f")
    with pytest.raises(StudentFailure, match="more in one check"):
        connection.call("f")
    assert not connection.alive


def test_a_refusal_of_ours_outweighs_what_came_of_it():
    def refuses(_):
        raise AssertionError("not a vector")

    connection = _connect(_value(Kind.CALLBACK, [0, None, 1]), _value(Kind.RESULT, 5))
    with pytest.raises(AssertionError, match="not a vector"):
        connection.call("f", refuses)


def test_calling_each_other_across_the_wire_has_an_end():
    lent = _value(0, [0, None])[5:-1].replace(b"l\2", b"l\3", 1) + b"N" + b"w\0\0\0\0"
    connection = _connect(*[_frame(Kind.CALLBACK, lent)] * 20)

    def again(function):
        return function(1.0)

    assert _failure(connection, again).kind == "protocol"


def test_systems_and_functions_of_the_student_arrive_as_what_they_are():
    body = b"l\2\0\0\0w\7\0\0\0p" + _value(0, "Oscillator")[5:] + _value(0, {"omega": 2.0})[5:]
    connection = _connect(_frame(Kind.RESULT, body))
    function, system = connection.call("f")
    assert isinstance(function, RemoteFunction)
    assert function.number == 7
    assert system == systems.Oscillator(2.0)


@pytest.mark.parametrize("answer", [None, [1], [1, [2], 1], [1, [], True], np.zeros((3, 1)), {"a": 1}])
def test_an_inspection_in_another_form_is_a_breach(answer):
    connection = _connect(_value(Kind.RESULT, answer))
    with pytest.raises(StudentFailure) as caught:
        connection.inspect("f", 2)
    assert caught.value.kind == "protocol"


# -- deadlines ------------------------------------------------------------------------------------------


def _trickle(theirs):
    for byte in _value(Kind.RESULT, [0.5] * 500):
        theirs.sendall(bytes([byte]))
        threading.Event().wait(0.005)


def _endless_callbacks(theirs):
    while True:
        theirs.sendall(_value(Kind.CALLBACK, [0, None]))
        theirs.recv(100)


def _slow_reader(theirs):
    theirs.sendall(_value(Kind.CALLBACK, [0, None]))
    while theirs.recv(8192):
        threading.Event().wait(0.01)


_HANGS = {
    "silence": lambda theirs: threading.Event().wait(1),
    "half a header": lambda theirs: theirs.sendall(b"\x05\0\0"),
    "half a frame": lambda theirs: theirs.sendall(struct.pack("<IB", 500, Kind.RESULT) + b"l"),
    "a trickle": _trickle,
    "endless callbacks": _endless_callbacks,
    "slow reading": _slow_reader,
}


@pytest.mark.parametrize("script", _HANGS.values(), ids=_HANGS.keys())
def test_nothing_holds_the_grader_beyond_the_deadline(script):
    connection = _connect(script)
    connection.deadline = Deadline(0.3)
    large = np.zeros(1 << 19)  # five seconds of slow reading
    start = monotonic()
    assert _failure(connection, lambda: large).kind == "timeout"
    assert monotonic() - start < 30  # wall: a busy machine may take its time, a hang would last for ever
