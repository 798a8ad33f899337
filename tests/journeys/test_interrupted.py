"""A run that is stopped, by hand, by the system or by force: it says nothing untrue, and nothing lives on."""

import signal
import subprocess
import sys
import time

import pytest

from course.catalog.load import Catalog
from tests.journeys.conftest import in_turn, model
from tests.journeys.processes import left_running

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads the process table of Linux")

EXERCISE = Catalog().exercises()[0]
STUDENTS = [f"st{number:02}" for number in range(6)]
#: Never said of somebody who handed in.
UNTRUE = ("missing", "othing was handed in", "handed in nothing", "not_submitted")
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)
#: Wall seconds within which everything that a run started has to be gone.
GONE_S = 10.0
ENDLESS = f"""
def {EXERCISE.task[0].id}(*_):
    while True:
        pass
"""


@pytest.fixture
def started(tmp_path):
    """A class, and a roster with one more."""
    for number, name in enumerate(STUDENTS):
        place = tmp_path / "class" / name / EXERCISE.id
        place.mkdir(parents=True)
        text = f"{model(EXERCISE)}\n# {number}\n{ENDLESS if number > 1 else ''}"
        (place / EXERCISE.module).write_text(text, "utf-8")
    rows = [f"{name},{number},{number}" for number, name in enumerate([*STUDENTS, "gone"], 1)]
    (tmp_path / "roster.csv").write_text("\n".join(["student,canvas_id,moodle_key", *rows, ""]), "utf-8")
    return tmp_path / "class", tmp_path / "roster.csv"


def stop(instructor, started, out, by, after_s):
    """Send the signal after a while; the exit code."""
    folder, roster = started
    words = ("grade", "run", folder, "--out", out, "--roster", roster, "-j", "2", "--plain")
    process = subprocess.Popen(
        [*instructor.command, *map(str, words)],
        env={**instructor.environment, "OF_THIS_RUN": str(out)},
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    time.sleep(after_s)
    process.send_signal(by)
    code = process.wait(timeout=60)
    assert not left_running(f"OF_THIS_RUN={out}", GONE_S), by
    return code


def says_nothing_untrue(instructor, out):
    """Neither in a file nor on the screen, and a platform is sent nothing."""
    for path in out.rglob("*"):
        if path.suffix in {".csv", ".html", ".jsonl"}:
            lines = path.read_text("utf-8").splitlines()
            told = [line for line in lines if any(name in line for name in STUDENTS)]
            assert not [line for line in told if any(words in line for words in UNTRUE)], path
    if not (out / "gradebook.sqlite").exists():
        return
    instructor("grade", "export", out, "--format", "jsonl")
    if not (out / "results.jsonl").read_bytes():  # before the class was read
        shown = instructor("grade", "explain", out, STUDENTS[0], EXERCISE.id, code=5).stderr
        assert "--resume" in shown
        return
    for student in (STUDENTS[0], STUDENTS[-1]):
        shown = instructor("grade", "explain", out, student, EXERCISE.id).stdout
        assert not [words for words in UNTRUE if words in shown], shown
    log = instructor("grade", "log", out).stdout
    assert not [words for words in UNTRUE if words in log], log
    sent = instructor("grade", "export", out, "--format", "moodle", "--missing", "zero", code=4)
    assert "not graded yet" in sent.stderr


@pytest.mark.parametrize("by", in_turn(SIGNALS))
def test_a_run_that_is_stopped_by_a_signal_leaves_no_process_and_no_untruth(
    instructor, started, tmp_path, by
):
    """While functions that never end are graded, in the middle of everything."""
    code = stop(instructor, started, tmp_path / "out", by, 4.0)
    assert code in {130, -by}
    says_nothing_untrue(instructor, tmp_path / "out")


@pytest.mark.soak
@pytest.mark.parametrize("by", SIGNALS)
@pytest.mark.parametrize("moment", range(10))
def test_at_every_moment(instructor, started, tmp_path, by, moment):
    """From before the class is read to where most of it is graded."""
    stop(instructor, started, tmp_path / "out", by, 0.2 + 0.3 * moment)
    says_nothing_untrue(instructor, tmp_path / "out")
