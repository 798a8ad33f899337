"""What a worker answers to a job, whatever its engine does."""

from __future__ import annotations

import numpy as np
import pytest

from course.engines.base import AS_IT_COMES, EngineDivergedError, Motion, NotApplicableError, Tuning
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
