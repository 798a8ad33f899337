"""Another kind of worker is entered from outside, and grades a submission; nothing above knows of it."""

from __future__ import annotations

import sys
import threading
from collections import deque
from pathlib import Path
from time import monotonic

import pytest

from course.catalog.load import Catalog
from course.catalog.locate import ENVIRONMENT_VARIABLE, content
from course.isolation import probe
from course.isolation.inside.worker import Worker
from course.isolation.levels import TICK_S, Exit, Level
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission, Terms

MINI_COURSE = Path(__file__).resolve().parents[2] / "fixtures" / "mini_course"


class Pipe:
    """Bytes one way, within this process: what one thread puts in, another takes out."""

    def __init__(self):
        self._bytes = deque()
        self._change = threading.Condition()
        self._closed = False

    def put(self, data):
        with self._change:
            if self._closed:
                raise BrokenPipeError
            self._bytes.append(bytes(data))
            self._change.notify_all()

    def take(self, most, patience=None):
        with self._change:
            if not self._change.wait_for(lambda: self._bytes or self._closed, patience):
                raise TimeoutError
            if not self._bytes:
                return b""
            data = self._bytes.popleft()
            if len(data) > most:
                self._bytes.appendleft(data[most:])
            return data[:most]

    def close(self):
        with self._change:
            self._closed = True
            self._change.notify_all()


class End:
    """One end of two pipes, with the calls that a channel has; no socket anywhere."""

    def __init__(self, incoming, outgoing, patience=None):
        self._incoming, self._outgoing, self._patience = incoming, outgoing, patience

    def recv(self, most, /):
        return self._incoming.take(most, self._patience)

    def recv_into(self, room, /):
        data = self.recv(len(room))
        room[: len(data)] = data
        return len(data)

    def send(self, data, /):
        self._outgoing.put(data)
        return len(data)

    sendall = send  # what the worker calls


class InThread:
    """A spawner whose workers are threads of this very process, and its handle at once."""

    level = Level.L1
    spawned = 0

    def __init__(self, level, imports):
        assert level is Level.L1
        self._imports = frozenset(imports)

    def spawn(self):
        type(self).spawned += 1
        there, back = Pipe(), Pipe()
        self.channel = End(back, there, TICK_S)
        self._pipes = (there, back)
        threading.Thread(target=Worker(End(there, back), self._imports).serve, daemon=True).start()
        return self

    def output(self):
        return ""

    def cpu_s(self):
        return monotonic()

    def asleep(self):
        return False

    def look(self):
        pass

    def finish(self):
        for pipe in self._pipes:
            pipe.close()
        return Exit(0, 0)

    def tidy(self):
        pass

    def close(self):
        pass


@pytest.fixture
def in_thread(monkeypatch, tmp_path):
    """Workers are threads: what loading changes of this process is put back afterwards."""
    monkeypatch.setattr(probe, "spawner", InThread)
    monkeypatch.setenv(ENVIRONMENT_VARIABLE, str(MINI_COURSE))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    monkeypatch.setattr(sys, "meta_path", [*sys.meta_path])
    modules = dict(sys.modules)
    yield
    for name in set(sys.modules) - set(modules):
        del sys.modules[name]


@pytest.mark.parametrize(("change", "state"), [("", "pass"), ("\ndef double(x):\n    return x\n", "fail")])
def test_a_worker_of_another_kind_grades(in_thread, change, state):
    catalog = Catalog(content())
    exercise = catalog.exercise("doubling")
    source = (MINI_COURSE / "solutions" / "doubling" / "doubling.py").read_text("utf-8") + change
    before = InThread.spawned
    with GradingSession(exercise, catalog, terms=Terms(level="L1")) as session:
        verdict = session.grade(Submission({exercise.module: source.encode()}))
    assert InThread.spawned > before
    assert (verdict.state, verdict.isolation) == ("graded", "L1")
    about = {check.status.value for check in verdict.checks if check.task == "double"}
    assert state in about
    assert verdict.all_pass is (state == "pass")


def test_what_is_no_part_of_the_handle_is_not_asked_for(in_thread):
    """The interface that is written down is the whole of it: another attribute would be an AttributeError."""
    from course.isolation.levels import Handle, Spawner

    wanted = {name for kind in (Handle, Spawner) for name in (*vars(kind), *kind.__annotations__)}
    offered = {name for name in (*vars(InThread), "channel") if not name.startswith("_")} - {"spawned"}
    assert offered == {name for name in wanted if not name.startswith("_")}
