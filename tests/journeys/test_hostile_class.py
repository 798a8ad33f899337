"""A class in which every fifth file is hostile: the others get what they would have got without them.

    COURSE_CLASS_OF=1000 pytest -m soak -n 0 -s tests/journeys/test_hostile_class.py

``COURSE_CLASS_OF`` is the size of the class, 60 unless said otherwise; of 1,000, 800 are honest and every
file of tests/attacks is handed in at least once. A smaller class gets as many of them as there is room for,
from all over the corpus. What was measured is printed.
"""

import os
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass, field
from typing import Any

import pytest

from tests.contracts.boundary.levels import require_level
from tests.journeys.conftest import results
from tests.journeys.processes import below, left_running, resident, stored
from tests.journeys.test_class_resume import ROOT, command, environment
from tests.unit.grading.made import NEEDS_CLUSTER

ATTACKS = ROOT / "tests" / "attacks"
ARENA = ATTACKS / "arena"
MODULE = "arena.py"
MODEL = (ARENA / "solutions" / "arena" / MODULE).read_bytes()
WRONG = (ATTACKS / "wrong_arena.py").read_bytes()
FRAMES = (ARENA / "frames.py").read_bytes()
#: Honest mistakes, so that the honest scores are not all alike.
MISTAKES = (
    b"",
    b"",
    b"\n\ndef compose(f, g, x):\n    return g(f(x))\n",
    b"\n\ndef draw(rng, n):\n    return [0.5] * n\n",
)
SIZE = int(os.environ.get("COURSE_CLASS_OF", "60"))
#: Memory of coordinator and graders in the last quarter of a run, in units of the second. `class_run.py`
#: allows a class of right and wrong answers 5 %; what a grader holds for a hostile file comes on top.
GROWTH = 1.10
#: The first hundred submissions fill caches that then stay: they are to be over before the second quarter.
FILLED = 400
#: Bytes of temporary files at any time. What a worker writes at L3 is in a file system of its own; here is
#: what coordinator and graders need: a copy of the content, and that of the worker's programs.
TEMPORARY = 64 << 20

pytestmark = [
    pytest.mark.soak,
    pytest.mark.skipif(sys.platform != "linux", reason="reads the process table of Linux"),
]


@dataclass
class Watched:
    """A run, and what it took over time."""

    code: int
    results: dict[str, dict[str, Any]]
    seconds: float
    memory: list[int] = field(default_factory=list)
    temporary: list[int] = field(default_factory=list)

    def quarters(self):
        """Bytes of memory in the second quarter of the run, and in the last."""
        quarter = max(1, len(self.memory) // 4)
        second, last = self.memory[quarter : 2 * quarter], self.memory[-quarter:]
        return statistics.median(second), statistics.median(last)

    def scores(self):
        """What each honest student got, check by check."""
        return {
            name: (
                line["state"],
                line["score"],
                [(check["id"], check["status"], check["points"]) for check in line["checks"]],
            )
            for name, line in self.results.items()
            if name.endswith("-honest")
        }


def hostile_files():
    """Every attack that is kept, in one order."""
    return [path for path in sorted(ATTACKS.glob("*.py")) if not path.name.startswith("wrong_")]


def make_class(folder, size, *, hostile):
    """Every fifth student is hostile, or left out; the corpus is gone through evenly."""
    attacks = hostile_files()
    most = max(len(attacks), size // 5)
    for number in range(size):
        if number % 5 < 4:
            name, source = f"{number:04}-honest", MODEL + MISTAKES[number % len(MISTAKES)]
        else:
            path = attacks[number // 5 * most // (size // 5) % len(attacks)]
            attack = path.read_bytes().replace(b"from frames import *\n", FRAMES)
            name, source = f"{number:04}-{path.stem}", WRONG + b"\n\n" + attack
        if hostile or number % 5 < 4:
            place = folder / name
            place.mkdir(parents=True)
            (place / MODULE).write_bytes(source + b"\n# %d\n" % number)


def trusted(pid):
    """Bytes that a process and the trusted ones below it hold; workers have a limit of their own."""
    below_it = (child for child, (_, line) in below(pid).items() if "course_worker" not in line)
    return sum(map(resident, (pid, *below_it)))


def grade(folder, out, *options):
    """One run, looked at every half second."""
    scratch = out.parent / f"scratch-{out.name}"
    words = ("--out", out, "--timeout", 2, "--seed", 11, "--quiet", *options)
    line, settings = command(folder, *words, exercise="arena"), environment(scratch, ARENA)
    start = time.monotonic()
    with (out.parent / f"{out.name}.txt").open("wb") as printed:
        run = subprocess.Popen(line, env=settings, stdout=printed, stderr=printed)
        memory, temporary = [], []
        while run.poll() is None:
            memory.append(trusted(run.pid))
            temporary.append(stored(scratch))
            time.sleep(0.5)
    found = {student: line for (student, _), line in results(out).items()}
    assert not list(scratch.iterdir()), "a run leaves no temporary file behind"
    assert not left_running(out.parent), "a run leaves no process behind"
    return Watched(run.returncode, found, time.monotonic() - start, memory, temporary)


def tell(name, run):
    """One line of what was measured."""
    early, late = run.quarters()
    print(
        f"{name}: {len(run.results)} results in {run.seconds:.0f} s, exit {run.code}; coordinator and"
        f" graders hold {early / 1e6:.0f} MB in the second quarter, {late / 1e6:.0f} MB in the last and"
        f" {max(run.memory) / 1e6:.0f} MB at most; temporary files {max(run.temporary) / 1e6:.1f} MB at most"
    )


@pytest.mark.parametrize("graders", ["-j", pytest.param("--local-cluster", marks=NEEDS_CLUSTER)])
def test_the_honest_get_what_they_would_have_got_without_the_hostile(tmp_path, graders):
    require_level("L3")
    make_class(tmp_path / "honest", SIZE, hostile=False)
    make_class(tmp_path / "class", SIZE, hostile=True)
    alone = grade(tmp_path / "honest", tmp_path / "alone", graders, "2")
    tell("honest alone", alone)
    among = grade(tmp_path / "class", tmp_path / "among", graders, "2")
    tell("among the hostile", among)

    assert alone.code == 0
    ungradable = [name for name, line in among.results.items() if line["state"] == "ungradable"]
    assert among.code == (6 if ungradable else 0)
    assert ungradable or len(hostile_files()) > SIZE, "a larger class has one that cannot be graded"
    assert among.results.keys() == {place.name for place in (tmp_path / "class").iterdir()}
    assert len(alone.scores()) == SIZE // 5 * 4
    assert among.scores() == alone.scores()
    assert len({line["score"] for name, line in alone.results.items()}) > 1, "honest scores that differ"
    for name, line in among.results.items():
        assert line["state"] != "grader_error", name
        assert "honest" in name or line["score"] <= 2, f"{name} is worth two points"
    if SIZE >= FILLED:
        early, late = among.quarters()
        assert late <= GROWTH * early
    assert max(among.temporary) <= TEMPORARY
