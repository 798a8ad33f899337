"""A run that is killed again and again, and one whose disk fills up: nothing is lost, nothing changes."""

from __future__ import annotations

import contextlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import pytest

from course.grading.gradebook import Gradebook

ROOT = Path(__file__).resolve().parents[2]
MINI = ROOT / "tests" / "fixtures" / "mini_course"
SOLUTION = (MINI / "solutions" / "doubling" / "doubling.py").read_bytes()
WRONG = b"\ndef double(x):\n    return x\n"
#: Attempts after which a run that never ends would be a failure.
MOST_ATTEMPTS = 60

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads the process table of Linux")


def make_class(folder: Path, students: int) -> dict[str, float]:
    """Every third student is wrong about one function; returns what each must get."""
    due = {}
    for number in range(students):
        place = folder / f"student-{number:04}"
        place.mkdir(parents=True)
        wrong = number % 3 == 0
        (place / "doubling.py").write_bytes(SOLUTION + WRONG * wrong + b"# %d\n" % number)
        due[place.name] = 6.0 if wrong else 10.0
    return due


def command(*words: object) -> list[str]:
    return [sys.executable, "-m", "course", "grade", "run", *map(str, words), "--exercise", "doubling"]


def environment(scratch: Path) -> dict[str, str]:
    scratch.mkdir(exist_ok=True)
    path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    return {**os.environ, "COURSE_CONTENT": str(MINI), "PYTHONPATH": path, "TMPDIR": str(scratch)}


def below(pid: int) -> dict[int, str]:
    """The processes a process started, and theirs: id -> command line."""
    parents, lines = {}, {}
    for entry in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
            parents[int(entry.name)] = int(fields[1])
            lines[int(entry.name)] = (
                (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode("utf-8", "replace")
            )
    found: dict[int, str] = {}
    waiting = [pid]
    while waiting:
        parent = waiting.pop()
        for child, its in parents.items():
            if its == parent and child not in found:
                found[child] = lines[child]
                waiting.append(child)
    return found


def kill_one(coordinator: subprocess.Popen[bytes], kind: str, rng: random.Random) -> bool:
    """Kill a process of this run; False if there is none of that kind."""
    if kind == "coordinator":
        coordinator.kill()
        return True
    mine = below(coordinator.pid)
    graders = [pid for pid, line in mine.items() if "course.grading.grader" in line]
    chosen = graders if kind == "grader" else [pid for pid in mine if pid not in graders]
    if not chosen:
        return False
    with contextlib.suppress(ProcessLookupError):
        os.kill(rng.choice(sorted(chosen)), signal.SIGKILL)
    return True


def count_lines(path: Path) -> int:
    return path.read_bytes().count(b"\n") if path.exists() else 0


def disturbed(folder: Path, out: Path, kills: list[str], every: int, rng: random.Random) -> Counter[str]:
    """Run until everything is graded, killing on the way; returns how often each student was reported."""
    reported: Counter[str] = Counter()
    scratch = out.parent / "scratch"
    waiting = list(kills)
    for attempt in range(MOST_ATTEMPTS):
        resume = ["--resume"] if out.exists() else []
        log = out.parent / f"log-{attempt}"
        with log.open("wb") as sink:
            process = subprocess.Popen(
                command(folder, "--out", out, "-j", 2, "--seed", 9, "--json", *resume),
                env=environment(scratch), stdout=sink, stderr=subprocess.DEVNULL,
            )  # fmt: skip
            goal = rng.randrange(every)
            while process.poll() is None:
                if waiting and count_lines(log) >= goal and kill_one(process, waiting[0], rng):
                    waiting.pop(0)
                    goal += 1 + rng.randrange(every)
                time.sleep(0.01)
        for raw in log.read_bytes().splitlines():
            with contextlib.suppress(ValueError):  # the line it was killed in
                line = json.loads(raw)
                if line.get("state") == "graded":
                    reported[line["student"]] += 1
        if process.returncode == 0 and not waiting:
            return reported
        if process.returncode == 0:
            kills_left = ", ".join(waiting)
            pytest.fail(f"the class was graded before these kills: {kills_left}")
    pytest.fail("it never finished")


def scores(out: Path) -> dict[str, float]:
    with Gradebook(out / "gradebook.sqlite") as book:
        return {result.key.student: result.verdict.score for result in book.results()}


def left_running(marker: Path) -> list[str]:
    """Processes of this test, which must end by themselves."""
    deadline = time.monotonic() + 20
    while True:
        left = []
        for entry in Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                known = (entry / "environ").read_bytes() + (entry / "cmdline").read_bytes()
                if str(marker).encode() in known and int(entry.name) != os.getpid():
                    left.append((entry / "cmdline").read_text("utf-8", "replace"))
        if not left or time.monotonic() > deadline:
            return left
        time.sleep(0.2)


def check_undisturbed(tmp_path: Path, students: int, kills: list[str], every: int) -> None:
    due = make_class(tmp_path / "class", students)
    rng = random.Random(20261121)
    reported = disturbed(tmp_path / "class", tmp_path / "out", kills, every, rng)
    assert scores(tmp_path / "out") == due
    with Gradebook(tmp_path / "out" / "gradebook.sqlite") as book:
        rows = {name: book.history(name, "doubling") for name in due}
    assert {len(row) for row in rows.values()} == {1}
    assert max(reported.values()) <= 2, "each is graded once more at most"
    assert not left_running(tmp_path / "scratch")
    assert not list((tmp_path / "scratch").iterdir())


def test_a_run_that_is_killed_here_and_there_ends_as_an_undisturbed_one(tmp_path: Path) -> None:
    check_undisturbed(tmp_path, 100, ["grader", "zygote", "coordinator"], every=25)


@pytest.mark.soak
def test_two_thousand_submissions_survive_twenty_kills(tmp_path: Path) -> None:
    rng = random.Random(5)
    kinds = ["coordinator"] * 8 + ["grader"] * 6 + ["zygote"] * 6
    rng.shuffle(kinds)
    check_undisturbed(tmp_path, 2000, kinds, every=150)


_ON_A_SMALL_DISK = """
mount -t tmpfs -o size=200k none "$1" || exit 99
shift
"$@" > "$LOGS/first" 2>&1; echo $?
cp -r "$DISK" "$LOGS/kept"
mount -o remount,size=50m "$DISK"
"$@" --resume > "$LOGS/second" 2>&1; echo $?
cp -r "$DISK/out" "$LOGS/out"
"""


def test_a_full_disk_is_said_and_the_run_goes_on_when_there_is_room(tmp_path: Path) -> None:
    if shutil.which("unshare") is None:
        pytest.skip("needs unshare, to have a small disk")
    due = make_class(tmp_path / "class", 20)
    disk, logs = tmp_path / "disk", tmp_path / "logs"
    disk.mkdir()
    logs.mkdir()
    run = command(tmp_path / "class", "--out", disk / "out", "--seed", 9)
    as_root = [] if os.getuid() == 0 else ["--user", "--map-root-user"]
    done = subprocess.run(
        ["unshare", "--mount", *as_root, "sh", "-c", _ON_A_SMALL_DISK, "sh", str(disk), *run],
        env=environment(tmp_path / "scratch") | {"DISK": str(disk), "LOGS": str(logs)},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if done.returncode == 99 or "unshare" in done.stderr:
        pytest.skip("no small disk is to be had here")
    first, second = (
        (logs / name).read_text("utf-8") if (logs / name).exists() else "" for name in ("first", "second")
    )
    assert done.stdout.split() == ["4", "0"], first + second
    assert "The disk is full" in first
    assert "--resume" in first
    before = first.count("/20 student")
    assert 0 < before < 20
    assert second.count("/20 student") == 20 - before, "what was reported is not graded again"
    assert scores(logs / "out") == due
