"""Starting and ending workers: what they leave, how they fail, and that one end is not the end of all."""

import contextlib
import os
import select
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from time import monotonic, sleep

import pytest

from course.isolation import launch, probe, spawn
from course.isolation.failures import IsolationError, StudentFailure
from course.isolation.launch import View
from course.isolation.levels import Deadline, Level
from course.isolation.probe import open_spawner
from course.isolation.session import Connection
from course.isolation.spawn import spawner
from tests.contracts.boundary.levels import require_level

linux_only = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")

_LOCKDOWN = "course_worker/isolation/inside/lockdown.py"


@pytest.fixture
def temporary(tmp_path, monkeypatch):
    """Temporary files go here, so that a test can see what is left."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


def _connect(found, source):
    return Connection(found, {"a.py": source.encode()}, "a.py", Deadline(20))


def _connect_once(found):
    with contextlib.closing(_connect(found, "f = lambda: 1\n")) as connection:
        return connection.call("f")


@pytest.fixture
def opened():
    """Opens a level, or skips the test where the machine lacks it."""
    with contextlib.ExitStack() as stack:
        yield lambda level: stack.enter_context(contextlib.closing(spawner(require_level(level), ("numpy",))))


def deep(top, floors, name, *files):
    """A tree with empty files on each floor."""
    top.mkdir()
    here = os.open(top, os.O_RDONLY)
    for _ in range(floors):
        for file in files:
            os.close(os.open(file, os.O_CREAT | os.O_WRONLY, dir_fd=here))
        os.mkdir(name, dir_fd=here)
        below = os.open(name, os.O_RDONLY, dir_fd=here)
        os.close(here)
        here = below
    os.close(here)


# -- cleaning up ----------------------------------------------------------------------------------------


def test_what_cannot_be_deleted_keeps_nothing_else(tmp_path, monkeypatch):
    """However deep the rest is: what a killed session left behind must not end the next one."""
    top, stays = tmp_path / "top", "stays"
    deep(top, sys.getrecursionlimit() + 100, "d", "file", stays)
    unlink = os.unlink

    def refusing(path, **named):
        if str(path).endswith(stays):
            raise PermissionError(path)
        unlink(path, **named)

    monkeypatch.setattr(os, "unlink", refusing)
    launch.remove_tree(top)
    assert {path.name for path in top.rglob("*") if path.is_file()} == {stays}
    monkeypatch.undo()
    deep(tmp_path / "longer than a path may be, which is 4096", 250, "d" * 20)
    for path in list(tmp_path.iterdir()):
        launch.remove_tree(path)
        assert not path.exists()


def test_deleting_what_somebody_left_stops_in_time_and_goes_on_later(tmp_path, monkeypatch):
    tops = [tmp_path / name for name in "ab"]
    for top in tops:
        for number in range(100):
            (top / str(number) / "below").mkdir(parents=True)
    left = [launch.removing(top) for top in tops]
    monkeypatch.setattr(launch, "_TIDY_S", 0.0)
    calls = 0
    while left:
        launch.tidy(left)
        calls += 1
    assert 200 <= calls <= 700  # an entry at a time, and nothing twice
    assert list(tmp_path.iterdir()) == []


def test_closed_folders_and_links_are_removed_but_not_followed(tmp_path):
    kept = tmp_path / "kept"
    kept.mkdir(mode=0o755)
    (kept / "file").write_text("x", "utf-8")
    top = tmp_path / "top"
    (top / "a" / "b").mkdir(parents=True)
    (top / "a" / "b" / "file").write_text("x", "utf-8")
    (top / "a" / "link").symlink_to(kept)
    (top / "-1").symlink_to(kept)
    (top / "a" / "b").chmod(0o000)
    (top / "a").chmod(0o300)
    launch.remove_tree(top)
    assert not top.exists()
    assert (kept / "file").exists()
    assert kept.stat().st_mode & 0o777 == 0o755


@pytest.mark.skipif(sys.platform == "win32", reason="a process cannot be asked if it lives")
def test_folders_of_dead_processes_go_and_those_of_living_ones_stay(temporary):
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    dead = temporary / f"course-worker-{ended.pid}-x"
    living = temporary / f"course-worker-{os.getppid()}-x"
    strange = temporary / "course-worker-notes"
    for folder in (dead, living, strange):
        folder.mkdir()
        (folder / "file").write_text("x", "utf-8")
    own = launch.private_folder()
    assert own.stat().st_mode & 0o077 == 0
    assert sorted(temporary.iterdir()) == sorted([living, own, strange])


@pytest.mark.parametrize("level", ["L1", "L2", "L3"])
def test_a_session_leaves_no_file(level, temporary, opened):
    found = opened(level)
    connection = _connect(
        found, "import os\nos.mkdir('closed', 0o300)\nopen('closed/f', 'w').close()\nf = lambda: 1\n"
    )
    assert connection.call("f") == 1
    connection.close()
    found.close()
    found.close()
    assert list(temporary.iterdir()) == []


# -- L1 -------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def plain():
    with contextlib.closing(spawner(require_level("L1"), ("numpy",))) as found:
        yield found


def test_a_plain_process_answers_prints_and_ends(plain):
    connection = _connect(plain, "import os\ndef f():\n    print('hello')\n    return os.getpid()\n")
    pid = connection.call("f")
    assert pid != os.getpid()
    assert connection.output() == "hello\n"
    connection.close()
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


def test_a_plain_process_that_dies_is_a_crash_with_its_signal(plain):
    for ends, told in (("abort()", f"signal {int(signal.SIGABRT)}"), ("_exit(7)", "exit code 7")):
        connection = _connect(plain, f"import os\ndef f():\n    os.{ends}\n")
        with pytest.raises(StudentFailure) as caught:
            connection.call("f")
        assert (caught.value.kind, caught.value.type) == ("crash", told)


@linux_only
def test_what_a_plain_process_started_ends_with_it_even_if_it_left_first(plain):
    connection = _connect(
        plain,
        "import os, time\ndef f():\n    pid = os.fork()\n"
        "    if pid == 0:\n        time.sleep(20)\n        os._exit(0)\n    return pid\n"
        "def g():\n    os._exit(0)\n",
    )
    child = connection.call("f")
    connection.deadline = Deadline(0.5)  # the child holds the connection open
    with pytest.raises(StudentFailure):
        connection.call("g")
    end = monotonic() + 5
    while _alive(child) and monotonic() < end:
        sleep(0.01)
    assert not _alive(child)


def _alive(pid):
    with contextlib.suppress(OSError):
        return Path(f"/proc/{pid}/stat").read_text("utf-8").rpartition(")")[2].split()[0] != "Z"
    return False


@linux_only
def test_output_replaced_by_a_pipe_does_not_hold_the_grader(plain):
    connection = _connect(
        plain,
        "import os\ndef f():\n    print('before')\n    os.unlink('.output')\n    os.mkfifo('.output')\n",
    )
    connection.call("f")
    start = monotonic()
    assert connection.output() == "before\n"
    connection.close()
    assert monotonic() - start < 30  # reading the pipe would last for ever


def test_the_next_plain_process_is_ready_before_it_is_needed(plain):
    first = plain.spawn()
    waiting = plain._standby
    first.finish()
    second = plain.spawn()
    assert second is waiting
    second.finish()


# -- L2 and L3 ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("level", ["L2", "L3"])
def test_a_zygote_that_died_under_a_worker_is_our_error_and_is_replaced(level, opened):
    found = opened(level)
    connection = _connect(found, "import time\ndef f():\n    time.sleep(20)\n")
    found._process.kill()
    found._process.wait()
    with pytest.raises(IsolationError):
        connection.call("f")
    select.select([found._control], [], [], 10)  # what is inside bubblewrap ends a little later
    assert _connect_once(found) == 1


#: A layer that fails, or does nothing, and what is said. That a test can tell proves that it tests.
_LAYERS = [
    ("L2", "apply_seccomp", "raise LockdownError(0, 'sabotaged')", "sabotaged"),
    ("L3", "apply_seccomp", "raise LockdownError(0, 'sabotaged')", "sabotaged"),
    ("L2", "landlock_apply", "pass", "read a file"),
    ("L2", "apply_seccomp", "pass", "start a process"),
    ("L3", "apply_seccomp", "pass", "start a process|open a"),
]


@pytest.mark.parametrize(("level", "layer", "does", "said"), _LAYERS)
def test_a_layer_that_fails_or_does_nothing_is_noticed_before_any_stranger_runs(
    level, layer, does, said, monkeypatch
):
    require_level(level)
    copy = launch.copy_worker_files

    def changed(target):
        copy(target)
        with (target / _LOCKDOWN).open("a", encoding="utf-8") as handle:
            handle.write(f"\n\ndef {layer}(*_):\n    {does}\n")
            if does == "pass":
                handle.write("\n\ndef apply_limits(**_):\n    pass\n")  # or they would stop the fork as well

    monkeypatch.setattr(launch, "copy_worker_files", changed)
    with pytest.raises(IsolationError, match=said):
        open_spawner(("numpy",), at_least=Level(level), at_most=Level(level))


@pytest.mark.parametrize("words", [None, "setting up uid map: Permission denied"], ids=["absent", "fails"])
def test_a_bubblewrap_that_is_absent_or_fails_is_a_cause_in_its_own_words(words, tmp_path, monkeypatch):
    require_level("L2")
    if words is None:
        which = shutil.which
        monkeypatch.setattr(
            shutil, "which", lambda name, *more: None if name == "bwrap" else which(name, *more)
        )
    else:
        broken = tmp_path / "bwrap"
        broken.write_text(f"#!/bin/sh\necho 'bwrap: {words}' >&2\nexit 1\n", "utf-8")
        broken.chmod(0o755)
        monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    found = probe.probe()
    assert found.level is Level.L2
    assert (words or "bubblewrap is not installed") in found.causes[0]
    assert words or "bubblewrap" in found.advice[0]
    assert not words or not any("disable" in advice or "sysctl" in advice for advice in found.advice)


def test_a_list_of_readable_paths_may_be_longer_than_an_argument(monkeypatch, opened):
    many = [Path(f"/usr/lib/no-such-library-of-a-large-installation-{k}") for k in range(4000)]
    expanded = View.expanded
    monkeypatch.setattr(View, "expanded", lambda self: [*expanded(self), *many])
    assert _connect_once(opened("L2")) == 1


def test_no_level_between_the_bounds_is_an_error_that_gives_every_cause(monkeypatch):
    def refuse(level, _):
        raise IsolationError(f"no {level} today")

    monkeypatch.setattr(probe, "_proven", refuse)
    with pytest.raises(IsolationError, match=r"L3: no L3 today; L2: no L2 today"):
        open_spawner(("numpy",), at_least=Level.L2)


def test_folders_above_a_path_are_named_outermost_first_and_none_inside_a_bind():
    paths = (Path("/opt/a/lib"), Path("/opt/a/lib/python"), Path("/usr/lib"))
    assert spawn._folders_above(paths) == [Path("/opt"), Path("/opt/a"), Path("/usr")]
