"""What an engine's process answers, whatever its engine does; its parent always gets a reply, and soon."""

import os
import re
import signal
import sys
import time

import numpy as np
import pytest

from course.engines import compare as module
from course.engines.base import AS_IT_COMES, EngineDivergedError, Motion, NotApplicableError, Tuning
from course.engines.compare import EngineProcess
from course.engines.worker import EngineServer

JOB = {"do": "measure", "scenario": "free-fall", "setting": "default", "dt": 1 / 240, "quick": False}


class Falling:
    """A world that falls exactly as it should, unless told to do something else."""

    def __init__(self, scene, trick=""):
        self.scene, self.trick, self.n = scene, trick, 0

    def step(self, n=1):
        self.n += n

    def motion(self):
        if self.trick == "raises":
            raise RuntimeError("no such thing")
        t = self.n * self.scene.dt
        x = np.array([body.position for body in self.scene.bodies])
        x[:, 2] -= 0.5 * 9.81 * t**2
        if self.trick == "nan":
            x[:] = np.nan
        return Motion(x, 0 * x, 0 * x)

    def overlaps(self):
        return []


class Engine:
    def __init__(self, trick=""):
        self.trick, self.given = trick, None

    def build(self, scene, options):
        self.given = dict(options)
        if self.trick == "planar":
            raise NotApplicableError("flat")
        return Falling(scene, self.trick)


def desk(engine, tuned=AS_IT_COMES):
    return EngineServer(engine.build, lambda _scenario: tuned)


def test_a_measurement_holds_value_and_details():
    reply = desk(Engine()).answer(JOB)
    assert reply["status"] == "ok"
    assert reply["value"] == pytest.approx(0.0, abs=1e-9)
    assert reply["details"]["steps"] == 200
    assert reply["options"] == {}


def test_tuned_options_reach_the_engine_and_the_reply_only_when_asked_for():
    tuned = Tuning({"iterations": 60}, ("because",))
    engine = Engine()
    reply = desk(engine, tuned).answer({**JOB, "setting": "tuned"})
    assert engine.given == {"iterations": 60}
    assert (reply["options"], reply["why"]) == ({"iterations": 60}, ["because"])
    desk(engine, tuned).answer(JOB)
    assert engine.given == {}


def test_while_settings_are_chosen_the_job_itself_says_what_to_set():
    engine = Engine()
    desk(engine).answer({**JOB, "options": {"erp": 0.5}})
    assert engine.given == {"erp": 0.5}


def test_the_runs_that_a_value_is_made_of_are_in_the_reply():
    reply = desk(Engine()).answer({**JOB, "scenario": "stack", "quick": True})
    assert len(reply["samples"]) == 3
    assert "samples" not in reply["details"]


@pytest.mark.parametrize(
    ("trick", "status"), [("nan", "diverged"), ("planar", "not_applicable"), ("raises", "failed")]
)
def test_what_goes_wrong_has_a_name(trick, status):
    reply = desk(Engine(trick)).answer(JOB)
    assert reply["status"] == status
    assert reply["message"]


def test_an_unknown_scenario_or_a_stretch_before_the_boxes_is_a_failure_not_an_end():
    one = desk(Engine())
    assert one.answer({**JOB, "scenario": "tea"})["status"] == "failed"
    assert one.answer({"do": "chunk", "steps": 5})["status"] == "failed"


def test_motion_that_is_not_a_number_is_refused_in_every_part():
    fine = np.zeros((1, 3))
    for parts in ((fine * np.nan, fine, fine), (fine, fine + np.inf, fine), (fine, fine, fine * np.nan)):
        with pytest.raises(EngineDivergedError):
            Motion(*parts).checked()
    assert Motion(fine, fine, fine).checked().x is fine


READY = 'import sys, os, time; print(\'{"status": "ok"}\', flush=True); '


def engine(after_start, before_start=""):
    """A process that says it is ready, waits for a job and then does something."""
    code = before_start or READY + "sys.stdin.readline(); " + after_start
    return EngineProcess("pymunk", [sys.executable, "-c", code])


def test_a_reply_comes_back_as_it_is():
    with engine('print(\'{"status": "ok", "value": NaN}\', flush=True)') as process:
        reply = process.ask(JOB, 10)
    assert reply["status"] == "ok"
    assert reply["value"] != reply["value"]


signals = pytest.mark.skipif(os.name != "posix", reason="names of signals")
REFUSES = 'print(\'{"status": "unavailable", "message": "ImportError: libvulkan.so.1"}\', flush=True)'
DIES = "import sys, os; sys.stderr.write('Illegal instruction\\n'); os._exit(132)"
ABORTS = "sys.stderr.write('so long\\nODE INTERNAL ERROR 1: assertion\\n'); os.abort()"


@pytest.mark.parametrize(
    ("after_start", "before_start", "status", "says"),
    [
        ("os._exit(7)", "", "crash", r"It ended with exit code 7\."),
        pytest.param(
            ABORTS, "", "crash", r"It was ended by SIGABRT\. Its last words: ODE INTERNAL ERROR 1: assertion",
            marks=signals,
        ),
        ("print('Segmentation fault (just kidding)', flush=True)", "", "crash", ".+"),
        ("", REFUSES, "unavailable", r"ImportError: libvulkan\.so\.1"),
        ("", DIES, "unavailable", ".*Illegal instruction.*"),
    ],
    ids=["ends", "aborts", "answers nonsense", "cannot load", "dies while it loads"],
)  # fmt: skip
def test_a_process_without_an_answer_is_a_crash_and_before_it_started_unavailable(
    after_start, before_start, status, says
):
    with engine(after_start, before_start) as process:
        reply = process.ask(JOB, 10)
    assert reply["status"] == status
    assert re.fullmatch(says, reply["message"])


def test_a_hang_ends_at_the_deadline_and_so_does_the_process():
    with engine("time.sleep(600)") as process:
        started = time.monotonic()
        reply = process.ask(JOB, 0.3)
        assert reply["status"] == "deadline"
        assert "0.3 s" in reply["message"]
        assert time.monotonic() - started < 60
        assert process.pid is None


def test_an_engine_that_loads_for_ever_is_ended(monkeypatch):
    monkeypatch.setattr(module, "START_S", 0.3)
    with engine("", "import time; time.sleep(600)") as process:
        assert process.ask(JOB, 10)["status"] == "deadline"


def test_a_program_that_is_not_there_is_unavailable():
    with EngineProcess("pymunk", ["/no/such/program"]) as process:
        assert process.ask(JOB, 10)["status"] == "unavailable"


@pytest.mark.skipif(os.name != "posix", reason="kills by signal")
def test_a_process_killed_from_outside_is_a_crash_and_the_next_question_starts_another():
    with engine("", READY + '[print(\'{"status": "ok"}\', flush=True) for _ in sys.stdin]') as process:
        assert process.ask(JOB, 30)["status"] == "ok"
        first = process.pid
        os.kill(first, signal.SIGKILL)
        reply = process.ask(JOB, 30)
        assert (reply["status"], reply["message"]) == ("crash", "It was ended by SIGKILL.")
        assert process.ask(JOB, 30)["status"] == "ok"
        assert process.pid not in (None, first)


def test_what_an_engine_prints_does_not_get_between_the_replies(tmp_path, monkeypatch):
    (tmp_path / "loud.py").write_text(
        "import os, sys\nprint('build time: today')\nos.write(1, b'from C\\n')\n"
        "from course.engines.adapters.pymunk import EngineWorld\n"
    )
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    command = [
        sys.executable,
        "-P",
        "-c",
        "import sys, course.engines.registry as r\n"
        "from importlib import import_module\n"
        "r.load = lambda name: import_module('loud').EngineWorld\n"
        "from course.engines.worker import main\nmain(['pymunk'])",
    ]
    with EngineProcess("pymunk", command) as process:
        reply = process.ask(JOB, 30)
    assert reply["status"] == "ok"
    assert reply["value"] == pytest.approx(-0.5)


def test_a_file_in_the_folder_one_stands_in_does_not_shadow_an_engine(tmp_path, monkeypatch):
    (tmp_path / "pymunk.py").write_text("raise SystemExit('wrong pymunk')\n")
    (tmp_path / "numpy.py").write_text("raise SystemExit('wrong numpy')\n")
    monkeypatch.chdir(tmp_path)
    with EngineProcess("pymunk") as process:
        assert process.ask({"do": "options", "scenario": "stack", "setting": "tuned"}, 30)["status"] == "ok"
