"""Time is counted where it is spent: a busy machine costs nobody points, and nobody gets time for nothing."""

import contextlib
import os
import subprocess
import sys
from time import monotonic, sleep
from unittest.mock import Mock

import pytest

from course.isolation.failures import StudentFailure
from course.isolation.levels import Deadline, Level, ProcessClock
from course.isolation.session import Connection
from course.isolation.spawn import spawner
from tests.contracts.boundary.levels import require_level
from tests.contracts.boundary.users import IN_WORKERS, LEVELS_AND_USERS, run_as
from tests.turns import soak_unless

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="asks Linux for CPU times")


def process():
    """One whose clock and state are set by hand."""
    return Mock(spec=["cpu_s", "asleep"], **{"cpu_s.return_value": 0.0, "asleep.return_value": False})


def test_waiting_for_a_processor_costs_nothing():
    fake, deadline = process(), Deadline(0.2, wall=60)
    deadline.watch(fake)
    sleep(0.4)
    assert not deadline.passed()
    assert deadline.used == 0
    fake.cpu_s.return_value = 0.21
    assert deadline.passed()


def test_sleeping_while_the_grader_waits_counts():
    fake, deadline = process(), Deadline(0.5, wall=60)
    fake.asleep.return_value = True
    deadline.watch(fake)
    looks = 0
    while not deadline.passed() and looks < 100:
        sleep(0.1)
        looks += 1
    assert 3 <= looks <= 6  # a look counts for what has gone by since the last one, at most two ticks


def test_what_several_workers_use_adds_up():
    deadline = Deadline(1.0, wall=60)
    for _ in range(3):
        fake = process()
        deadline.watch(fake)
        fake.cpu_s.return_value = 0.3
    deadline.watch(None)
    assert deadline.used == pytest.approx(0.9)
    assert not deadline.passed()


def test_the_wall_clock_has_the_last_word():
    deadline = Deadline(100, wall=0.1)
    deadline.watch(process())
    sleep(0.15)
    assert deadline.passed()
    deadline.postpone(60)
    assert not deadline.passed()


def test_nothing_need_be_asked_before_it_can_have_passed():
    fake, deadline = process(), Deadline(5.0)
    deadline.watch(fake)
    fake.cpu_s.return_value = 2.0
    assert not deadline.passed()
    assert deadline.earliest - monotonic() == pytest.approx(3.0, abs=0.5)


def test_the_clock_of_another_process_is_that_process_s_own():
    with subprocess.Popen([sys.executable, "-c", "while True: pass"]) as busy:
        clock = ProcessClock(busy.pid)
        while clock.cpu_s() < 0.2:
            sleep(0.01)
        assert not clock.asleep()
        busy.kill()
    assert clock.cpu_s() >= 0.2
    with subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"]) as idle:
        clock = ProcessClock(idle.pid)
        while not clock.asleep():
            sleep(0.01)
        idle.kill()


@contextlib.contextmanager
def _crowd(processor, size):
    """So many processes that want nothing but this processor."""
    program = f"import os\nos.sched_setaffinity(0, {{{processor}}})\nos.write(1, b'.')\nwhile True: pass"
    with contextlib.ExitStack() as stack:
        busy = []
        for _ in range(size):
            one = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE)
            stack.enter_context(one)
            stack.callback(one.kill)
            busy.append(one)
        for one in busy:  # none of them is still starting
            assert one.stdout.read(1) == b"."
        yield


_WORK = """
import time
def work(seconds):
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass
    return True
def sleeps():
    time.sleep(600)
def spins():
    return sum(range(10**11))
"""


@pytest.mark.parametrize("level", soak_unless(["L3"], ["L1", "L2", "L3"]))
def test_honest_work_is_not_cut_off_on_a_machine_with_too_much_to_do(level):
    require_level(level)
    processor = min(os.sched_getaffinity(0))
    before = os.sched_getaffinity(0)
    with contextlib.ExitStack() as stack:
        stack.callback(os.sched_setaffinity, 0, before)
        # Whatever starts a worker hands its processor on, as in a session.
        os.sched_setaffinity(0, {processor})
        found = spawner(Level(level), ("numpy",))
        stack.callback(found.close)
        stack.enter_context(_crowd(processor, 8))

        def connected():
            made = Connection(found, {"a.py": _WORK.encode()}, "a.py", Deadline(10))
            stack.callback(made.close)
            return made

        connection = connected()
        connection.deadline = Deadline(0.6, wall=60)
        assert connection.call("work", 0.4) is True
        assert connection.deadline.wall > 0.6, (
            "the machine was not busy: by the wall it would have been in time"
        )
        for hopeless in ("sleeps", "spins"):
            connection = connected()
            connection.deadline = Deadline(0.5, wall=60)
            with pytest.raises(StudentFailure) as caught:
                connection.call(hopeless)
            assert caught.value.kind == "timeout"
            assert connection.deadline.wall < 30, hopeless


_AS_USER = """
for name in ("spins", "sleeps"):
    connection = connect(10)
    connection.deadline = Deadline(0.3, wall=100)
    try:
        connection.call(name)
    except StudentFailure as failure:
        assert failure.kind == "timeout"
        assert connection.deadline.used >= 0.3
        assert connection.deadline.wall < 50, connection.deadline.wall
        print(name, end=" ")
found.close()
"""


@pytest.mark.parametrize(("level", "user"), LEVELS_AND_USERS)
def test_time_is_told_whoever_the_grader_is(level, user):
    require_level(level)
    assert run_as(user, IN_WORKERS + _AS_USER, level, _WORK).split() == ["spins", "sleeps"]
