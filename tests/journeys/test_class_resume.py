"""A run that is killed again and again, and one whose disk fills up: nothing is lost, nothing changes."""

import contextlib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import pytest

from course.grading.gradebook.book import Gradebook
from tests.journeys.processes import below, left_running
from tests.unit.grading.made import HAS_CLUSTER
from tests.unit.grading.running.test_run import scores

ROOT = Path(__file__).resolve().parents[2]
MINI = ROOT / "tests" / "fixtures" / "mini_course"
SOLUTION = (MINI / "solutions" / "doubling" / "doubling.py").read_bytes()
WRONG = b"\ndef double(x):\n    return x\n"
#: Attempts after which a run that never ends would be a failure.
MOST_ATTEMPTS = 60
GRADERS = 2
ON_ONE_MACHINE, ON_A_CLUSTER = ("-j", str(GRADERS)), ("--local-cluster", str(GRADERS))

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads the process table of Linux")


def make_class(folder, students):
    """Every third student is wrong about one function; returns what each must get."""
    due = {}
    for number in range(students):
        place = folder / f"student-{number:04}"
        place.mkdir(parents=True)
        wrong = number % 3 == 0
        who = b"\ndef who():\n    return %d\n" % number
        (place / "doubling.py").write_bytes(SOLUTION + WRONG * wrong + who)
        due[place.name] = 6.0 if wrong else 10.0
    return due


_TITLE = '    """A negative number becomes more negative"""\n'
#: Bytes of a note.
_WIDTH = 6
_NOTE = """    import os, time
    to = os.open(os.environ["GRADINGS"], os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    os.write(to, b"%05d\\n" % submission.call("who"))
    turn = os.lseek(to, 0, os.SEEK_CUR)
    os.close(to)
    gate = os.environ.get("GATE")
    while gate and os.stat(gate).st_size < turn:
        time.sleep(0.002)
"""


def make_course(folder):
    """The miniature course, with a hidden check that notes each grading, kept or not, and waits at a gate."""
    shutil.copytree(MINI, folder)
    checks = folder / "graders" / "doubling" / "checks.py"
    source = checks.read_text("utf-8")
    assert _TITLE in source
    checks.write_text(source.replace(_TITLE, _TITLE + _NOTE), "utf-8")
    return folder


def noted(scratch):
    """Who was graded, by the check's own account, as often and in the order as they were."""
    path = scratch.parent / "gradings"
    numbers = path.read_text("ascii").split() if path.exists() else []
    return [f"student-{int(number):04}" for number in numbers]


def command(*words, exercise="doubling"):
    return [sys.executable, "-m", "course", "grade", "run", *map(str, words), "--exercise", exercise]


def environment(scratch, content=MINI, gate=None):
    scratch.mkdir(exist_ok=True)
    path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    ours = {"COURSE_CONTENT": str(content), "GRADINGS": str(scratch.parent / "gradings")}
    ours |= {"GATE": str(gate)} if gate else {}
    return {**os.environ, **ours, "PYTHONPATH": path, "TMPDIR": str(scratch)}


def kind_of(pid, mine):
    """What a process of a run is there for."""
    parent, line = mine[pid]
    if "course.grading.running.grader" in line:
        return "grader"
    if "spawn_main" in line:
        return "dask worker"
    if "bwrap" not in line and line == mine.get(parent, (0, ""))[1]:
        return "worker"  # a zygote's fork: its death is the student's code's own
    while parent in mine:
        if "course.grading.running.grader" in mine[parent][1]:
            return "zygote"
        parent = mine[parent][0]
    return "helper"


def kill_one(coordinator, kind, rng):
    """Kill a process of this run."""
    mine = below(coordinator.pid)
    of_that_kind = sorted(pid for pid in mine if kind_of(pid, mine) == kind)
    os.kill(coordinator.pid if kind == "coordinator" else rng.choice(of_that_kind), signal.SIGKILL)


def said(log):
    """The students whose results a run has reported so far."""
    found = []
    for raw in log.read_bytes().splitlines():
        with contextlib.suppress(ValueError):  # the line it was killed in
            line = json.loads(raw)
            if line.get("state") == "graded":
                found.append(line["student"])
    return found


def rounds(kinds):
    """Deaths by the attempt in which they happen: that of a coordinator ends one."""
    found = [[]]
    for kind in kinds:
        found[-1].append(kind)
        if kind == "coordinator":
            found.append([])
    return found


def way(kinds):
    """Where an attempt grades: on a cluster if a worker of one is to die."""
    return ON_A_CLUSTER if "dask worker" in kinds else ON_ONE_MACHINE


class Gate:
    """Lets a number of gradings pass, so that a class is never over before the deaths it is to survive.

    Both graders of a run wait here in the middle of a grading, each for its turn, when a death comes.
    """

    def __init__(self, out, between):
        self.path = out.parent / "gate"
        self._scratch = out.parent / "scratch"
        self._between = between
        self._rng = random.Random(20261121)
        self._cut = set()
        self._let(self._rng.choice(between))

    def _let(self, gradings):
        self._open_to = gradings
        with self.path.open("ab") as file:
            file.truncate(gradings * _WIDTH)

    def holds(self, reported):
        """Whether both graders wait, and none of whom a death would interrupt was interrupted before."""
        names = noted(self._scratch)
        if len(names) < self._open_to + GRADERS:
            return False
        if self._cut & (set(names) - reported):
            self._let(self._open_to + 1)
            return False
        return True

    def kill(self, coordinator, kind, reported):
        """Kill a process of the run that waits, and let what is left of it go on."""
        names = noted(self._scratch)
        kill_one(coordinator, kind, self._rng)
        self._cut |= set(names) - reported
        self._let(len(names) + self._rng.choice(self._between))

    def open(self):
        """Let everybody pass."""
        self._let(10**6)


def disturbed(run, out, kills, between):
    """Run until everything is graded, killing on the way; returns how often each student was reported.

    Args:
        between: how many gradings there may be between two deaths.
    """
    reported = Counter()
    waiting = rounds(kills)
    gate = Gate(out, between)
    for attempt in range(MOST_ATTEMPTS):
        log = out.parent / f"log-{attempt}"
        kept = set(scores(out)) if attempt else set()
        words = [*run, *way(waiting[0]), *(["--resume"] if attempt else [])]
        settings = environment(out.parent / "scratch", out.parent / "content", gate.path)
        with log.open("wb") as sink, log.with_suffix(".words").open("wb") as errors:
            process = subprocess.Popen(words, env=settings, stdout=sink, stderr=errors)
            while process.poll() is None:
                if not any(waiting):
                    gate.open()
                elif waiting[0] and gate.holds(done := kept.union(said(log))):
                    gate.kill(process, waiting[0].pop(0), done)
                time.sleep(0.01)
        if process.returncode != 0 and not waiting[0] and len(waiting) > 1:
            waiting.pop(0)
        reported.update(said(log))
        if process.returncode == 0:
            assert waiting == [[]], f"the class was graded before these deaths: {waiting}"
            return reported
        assert process.returncode in {-signal.SIGKILL, 70}, log.with_suffix(".words").read_text("utf-8")
    pytest.fail("it never finished")


def outcomes(out):
    """By student, what every check gave."""
    with Gradebook(out / "gradebook.sqlite") as book:
        return {
            result.key.student: [(check.id, check.status, check.points) for check in result.verdict.checks]
            for result in book.results()
        }


def check_undisturbed(tmp_path, students, kills, between):
    """Kill and resume, then compare with a run that nobody disturbed."""
    due = make_class(tmp_path / "class", students)
    make_course(tmp_path / "content")
    run = command(tmp_path / "class", "--out", tmp_path / "out", "--seed", 9, "--json")
    reported = disturbed(run, tmp_path / "out", kills, between)
    assert scores(tmp_path / "out") == due
    with Gradebook(tmp_path / "out" / "gradebook.sqlite") as book:
        rows = {name: book.history(name, "doubling") for name in due}
    assert {len(row) for row in rows.values()} == {1}
    assert max(reported.values()) == 1, "what was reported is never graded again"
    assert len(due) - len(reported) <= kills.count("coordinator"), "killed between keeping and saying so"
    graded = Counter(noted(tmp_path / "scratch"))
    assert len(graded) == students
    assert sum(graded.values()) >= students + len(kills), "each death cut somebody's grading short"
    assert max(graded.values()) <= 2, "each is graded once more at most"
    assert not left_running(tmp_path / "scratch")
    # A grader whose coordinator was killed has three seconds to clean up; the next run deletes what is left.
    settings = environment(tmp_path / "scratch", tmp_path / "content")
    subprocess.run([*run, "--resume"], env=settings, check=True)
    assert not list((tmp_path / "scratch").iterdir())


def test_a_run_that_is_killed_here_and_there_ends_as_an_undisturbed_one(tmp_path):
    check_undisturbed(tmp_path, 50, ["grader", "zygote", "coordinator"], range(4, 12))


@pytest.mark.soak
def test_two_thousand_submissions_survive_twenty_kills(tmp_path):
    kinds = ["coordinator"] * 7 + ["grader"] * 4 + ["zygote"] * 4
    kinds += ["dask worker" if HAS_CLUSTER else "grader"] * 5
    random.Random(5).shuffle(kinds)
    check_undisturbed(tmp_path, 2000, kinds, range(40, 90))
    run = command(tmp_path / "class", "--out", tmp_path / "calm", "--seed", 9, *ON_ONE_MACHINE, "--quiet")
    subprocess.run(run, env=environment(tmp_path / "scratch", tmp_path / "content"), check=True)
    assert outcomes(tmp_path / "out") == outcomes(tmp_path / "calm")


#: A run on a disk without room for the gradebook (its snapshot takes 0.9 MB, the log included), then with;
#: without room for the pages, then with; one that may be read only. Prints the exit codes.
_ON_A_SMALL_DISK = """
mount -t tmpfs -o size=1000k none "$DISK" || exit 99
"$@" > "$LOGS/gradebook" 2>&1; echo $?
mount -o remount,size=50m "$DISK"
"$@" --resume > "$LOGS/room" 2>&1; echo $?
rm -r "$DISK/out/students" "$DISK/out/report.html"
mount -o remount,size=$(($(df --output=used -k "$DISK" | tail -n 1) + 200))k "$DISK"
"$@" --resume > "$LOGS/pages" 2>&1; echo $?
ls -A "$DISK/out" > "$LOGS/listed"
mount -o remount,size=50m "$DISK"
"$@" --resume > "$LOGS/again" 2>&1; echo $?
cp -r "$DISK/out" "$LOGS/out"
mount -o remount,ro "$DISK"
"$@" --resume > "$LOGS/read-only" 2>&1; echo $?
diff -r "$DISK/out" "$LOGS/out" && echo same
"""


def on_a_small_disk(tmp_path):
    """What the script printed, and by name what each command said and what was listed."""
    if shutil.which("unshare") is None:
        pytest.skip("needs unshare, to have a small disk")
    disk, logs = tmp_path / "disk", tmp_path / "logs"
    disk.mkdir()
    logs.mkdir()
    run = command(tmp_path / "class", "--out", disk / "out", "--seed", 9, "-j", 1)
    as_root = [] if os.getuid() == 0 else ["--user", "--map-root-user"]
    done = subprocess.run(
        ["unshare", "--mount", *as_root, "sh", "-c", _ON_A_SMALL_DISK, "sh", *run],
        env=environment(tmp_path / "scratch") | {"DISK": str(disk), "LOGS": str(logs)},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if done.returncode == 99 or "unshare" in done.stderr:
        pytest.skip("no small disk is to be had here")
    said = {path.name: path.read_text("utf-8") for path in logs.iterdir() if path.is_file()}
    return done.stdout.split(), said


def test_a_full_disk_is_said_and_the_run_goes_on_when_there_is_room(tmp_path):
    due = make_class(tmp_path / "class", 60)
    printed, said = on_a_small_disk(tmp_path)
    assert printed == ["4", "0", "4", "0", "4", "same"], said
    assert "The disk is full" in said["gradebook"]
    assert "--resume" in said["gradebook"]
    before, after = (set(re.findall(r"student-\d+", said[name])) for name in ("gradebook", "room"))
    assert 0 < len(before) < 60
    assert not before & after, "what was reported is not graded again"
    assert len(before | after) >= 59, "the disk may be full between keeping one and saying so"
    assert "cannot be written: No space left on device" in said["pages"]
    assert ".html" in said["pages"]
    assert "--resume" in said["pages"]
    assert not [name for name in said["listed"].split() if name.startswith(".")], "half a page is no page"
    assert "gradebook.sqlite cannot be written" in said["read-only"]
    assert "/60 student" not in said["pages"] + said["again"] + said["read-only"]
    assert scores(tmp_path / "logs" / "out") == due
    assert len(list((tmp_path / "logs" / "out" / "students").iterdir())) == 60
