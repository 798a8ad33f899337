"""A scene that is played: its history, any moment of it again, undo and redo."""

import random

import numpy as np
import pytest

from course.errors import UsageError
from course.sandbox.runs import recording
from course.sandbox.runs.tape import shot_of
from course.sandbox.scene.loading import choose, scene_ids
from course.sandbox.views.stage import Stage
from course.sandbox.world.engine import Ledger
from tests.unit.sandbox.hands import meddle


def make(name, **more):
    return Stage(choose(name, more.pop("settings", None)), **more)


def watch(stage, seconds):
    for _ in range(round(seconds * 60)):
        stage.tick(1 / 60, budget=60.0)


def go_on_from(stage, t):
    stage.look(t)
    stage.go_on()
    stage.finish()


@pytest.mark.parametrize("name", scene_ids())
def test_going_on_from_any_moment_gives_the_same_states_to_the_last_bit(name):
    chance, stage = random.Random(name), make(name)
    seen = {}
    stage.world.on_tick.append((1, lambda world=stage.world: seen.update({world.ticks: world.state_hash()})))
    watch(stage, 0.2)
    x, y = (float(c) for c in stage.world.state()[0, :2])
    stage.act("grab", x, y, 0.3)
    stage.act("drag", x + 0.2, y + 0.2)
    watch(stage, 0.2)
    meddle(stage.world, chance, stage.act)
    stage.act("release")
    watch(stage, 0.7)
    middle = stage.world.t - 0.2 * stage.world.speed
    go_on_from(stage, middle)
    assert not stage.world.paused
    assert stage.world.state_hash() == seen[stage.world.ticks]
    end = max(seen)
    stage.world.step(end - stage.world.ticks)
    assert stage.world.state_hash() == seen[end]


@pytest.mark.parametrize("name", scene_ids())
def test_undo_and_redo_through_random_acts_return_to_the_same_bytes(name):
    chance, stage = random.Random(1), make(name)
    stage.world.paused = True
    states = played(stage, chance, 12)
    taken_back_and_given_again(stage, states)
    for _ in states[1:]:
        stage.undo()
        stage.finish()
    with pytest.raises(UsageError, match="nothing to undo"):
        stage.undo()


@pytest.mark.soak
@pytest.mark.parametrize("name", scene_ids())
def test_undo_and_redo_through_five_hundred_acts_return_to_the_same_bytes(name):
    chance, stage = random.Random(7), make(name)
    stage.world.paused = True
    for _ in range(
        20
    ):  # each undo makes the run anew from its start, so not all acts are taken back each time
        states = played(stage, chance, 25)
        taken_back_and_given_again(stage, states[-chance.randrange(2, 7) :])


def played(stage, chance, acts):
    """The states before each act that can be undone, and after the last."""
    states = []
    for _ in range(acts):
        before = len(stage._undos)
        state = stage.world.state().tobytes(), dict(stage.world.settings)
        meddle(stage.world, chance, stage.act)
        if len(stage._undos) > before:
            states.append(state)
        stage.world.step(chance.randrange(3))
    states.append((stage.world.state().tobytes(), dict(stage.world.settings)))
    assert len(states) > acts / 4
    return states


def taken_back_and_given_again(stage, states):
    for state in reversed(states[:-1]):
        stage.undo()
        stage.finish()
        assert (stage.world.state().tobytes(), stage.world.settings) == state
    for state in states[1:]:
        stage.redo()
        stage.finish()
        assert (stage.world.state().tobytes(), stage.world.settings) == state


def test_what_is_played_is_a_recording_that_replays_after_undo_reset_and_going_on(tmp_path):
    stage, chance = make("restitution-row"), random.Random(1)
    for _ in range(3):
        watch(stage, 0.4)
        meddle(stage.world, chance, stage.act)
    stage.undo()
    stage.finish()
    stage.run(on=True)
    watch(stage, 0.3)
    stage.act("reset")
    watch(stage, 0.5)
    go_on_from(stage, 0.25)
    watch(stage, 0.5)
    file = tmp_path / "run.jsonl"
    file.write_bytes(stage.recording.encode())
    replayed = recording.replay(recording.read(file))
    assert (replayed.same, replayed.checked) == (True, 1 + len(stage.recording.hashes))
    assert stage.world.ticks > 240


def test_any_moment_that_is_looked_at_is_the_one_that_was_seen():
    stage = make("newtons-cradle")
    seen = {}
    for _ in range(60):
        watch(stage, 1 / 60)
        seen[stage.world.t] = stage.world.snapshot()
    t = sorted(seen)[30]
    stage.look(t)
    kept = shot_of(stage.frame())
    assert kept.t == pytest.approx(t, abs=1 / 60)
    assert np.abs(kept.x - seen[t].x).max() < 0.03
    assert stage.still
    stage.play_back(-1)
    watch(stage, 0.2)
    assert stage.t == pytest.approx(t - 0.2, abs=0.02)
    with pytest.raises(UsageError, match="You look at"):
        stage.act("spawn", "circle", 0, 0)
    stage.play_back(1)
    watch(stage, 2.0)
    assert stage.at is None, "played to its end, the past becomes the present, and time goes on"
    assert stage.world.t > 1.0


def test_the_run_before_is_a_ghost_and_so_is_what_was_left_behind():
    stage = make("head-on")
    watch(stage, 0.5)
    assert stage.ghost is None
    stage.act("reset")
    assert stage.ghost.frame_at(0.25)[2] == pytest.approx(0.25, abs=0.02)
    watch(stage, 0.2)
    go_on_from(stage, 0.1)
    assert stage.ghost.times[-1] == pytest.approx(0.2, abs=0.02)


def test_going_on_shows_how_far_it_is_and_can_be_stopped():
    stage = make("galton-board")
    stage.act("set", "gravity", 5.0)
    stage.undo()
    stage.finish()
    stage.run(on=True)
    watch(stage, 2.0)
    before = stage.world.state_hash()
    stage.clock = iter(float(n) for n in range(10**9)).__next__
    stage.look(1.9)
    stage.go_on()
    shares = []
    for _ in range(20):
        stage.tick(1 / 60)
        shares.append(stage.working[1])
    assert 0 < shares[0] < shares[-1] < 1
    for busy in (lambda: stage.act("reset"), stage.go_on):
        with pytest.raises(UsageError, match="One moment"):
            busy()
    stage.stop_work()
    assert (stage.working, stage.world.state_hash(), stage.undoable()) == (None, before, ("", "set gravity"))


@pytest.mark.parametrize("name", ["billiards-break", "newtons-cradle", "robot-boxes", "galton-board"])
def test_going_on_after_a_long_run_takes_what_is_known_from_its_tape(name, monkeypatch):
    """Far from the end nothing is booked again, and yet states, account, frames and ticks are the same."""
    monkeypatch.setattr("course.sandbox.views.stage._TOLD", 2.0)
    stage, booked = make(name), []
    monkeypatch.setattr(
        Ledger, "settle", lambda *a, real=Ledger.settle, **k: booked.append(1) or real(*a, **k)
    )
    watch(stage, 2.0)
    body = next(part.name for part in stage.world.parts if not part.fixed)
    stage.act("aim", body, 1.0, 0.5)
    watch(stage, 14.0)
    old, there = stage.tape, stage.tape.at(15.0)
    until = [mark for mark in old.marks if mark < 12.9]
    played = len(booked)
    go_on_from(stage, old.times[there])
    assert stage.world.ticks == old.ticks[there]
    assert stage.tape.ticks == old.ticks[: there + 1]
    for mine, kept in zip(stage.tape.frames, old.frames, strict=False):
        assert mine[2:] == pytest.approx(kept[2:], rel=1e-5, abs=1e-6)
    assert [mark for mark in stage.tape.marks if mark < 12.9] == until
    assert stage.world.sums == pytest.approx(old.sums[there], rel=1e-9, abs=1e-9)
    assert len(booked) - played < 0.8 * played
    seen = {one.tick: one.hash for one in old.recording.hashes}
    stage.world.step(200)
    assert all(seen.get(one.tick, one.hash) == one.hash for one in stage.recording.hashes)


def test_a_tape_is_known_only_up_to_where_two_histories_part():
    stage = make("head-on")
    watch(stage, 20.0)
    stage.act("aim", "left" if stage.world.moves("left") else stage.world.parts[0].name, 0.5, 0.0)
    parted = stage.world.ticks
    watch(stage, 20.0)
    tape, before = stage.tape, stage.recording
    assert tape.ticks[tape.shared(before, 1, 39.0)] > parted
    assert 0 < tape.ticks[tape.shared(before, 0, 39.0)] < parted
    other = make("head-on", settings={"step": 0.002})
    assert tape.shared(other.recording, 0, 39.0) == 0
    stage.act("reset")
    assert stage.tape.shared(stage.recording, 1, 39.0) == 0, "that run began at another moment"


def test_a_parameter_starts_the_scene_anew_keeps_the_settings_and_can_be_undone():
    stage = make("newtons-cradle")
    stage.act("set", "gravity", 3.0)
    watch(stage, 0.2)
    before = stage.world.state_hash()
    stage.set_parameter("angle", 60.0)
    assert (stage.world.t, stage.world.settings["gravity"], stage.chosen.parameters["angle"]) == (0, 3.0, 60)
    assert stage.world.settings["step"] == stage.chosen.scene.step
    stage.undo()
    stage.finish()
    assert (stage.world.state_hash(), stage.chosen.parameters["angle"]) == (before, 30)


def test_no_run_ends_and_the_comparison_is_made_on_the_way():
    kept = []
    stage = make("head-on", keep=kept.append)
    watch(stage, 0.5)
    stage.guess(2.0)
    assert stage.world.t == 0, "the run that is compared begins with the guess"
    watch(stage, 4.0)
    assert stage.world.t > 3.5
    assert not stage.world.paused
    assert [one.guess for one in kept] == [2.0]
    go_on_from(stage, 3.0)
    assert stage.experiment.stage == "done"
    assert len(kept) == 1, "the same run is not kept twice"


def test_a_run_is_compared_exactly_where_it_was_told_to():
    stage = make("head-on", clock=lambda: 0.0)
    while stage.experiment.stage != "done":
        before = stage.world.steps
        stage.tick(0.07)
    assert before < stage.world.steps == 480


@pytest.mark.parametrize("name", ["free-fall", "head-on", "incline", "restitution-row", "box-stack"])
def test_going_on_compares_the_same_moment_as_the_run_that_was_seen(name):
    stage = make(name, settings={"step": 0.0037})  # no number of steps ends with a picture
    watch(stage, stage.chosen.scene.duration + 1.0)
    seen = stage.experiment.report()["comparison"]
    assert seen is not None
    go_on_from(stage, stage.world.t - 0.3)
    assert stage.experiment.report()["comparison"] == seen


def test_of_the_past_the_next_contact_is_the_next_one_marked_and_then_now():
    stage = make("head-on")
    watch(stage, 1.0)
    stage.look(0.1)
    stage.step("contact")
    assert stage.at == stage.tape.marks[0] == pytest.approx(1.6 / 3, abs=0.01)
    stage.step("contact")
    assert stage.at is None


def test_a_step_is_a_picture_the_next_contact_or_the_solvers():
    stage = make("newtons-cradle", clock=lambda: 0.0)  # however busy the machine is, it is looked for
    stage.step()
    assert stage.world.t == pytest.approx(1 / 60, abs=1e-3)
    stage.step("solver")
    assert stage.world.t == pytest.approx(1 / 60 + 0.0005, abs=1e-3)
    stage.step("contact")
    assert any(event.kind == "contact" for event in stage.heard)
    assert stage.world.paused


def test_a_long_recording_thins_what_is_old_and_stays_small(monkeypatch):
    monkeypatch.setattr("course.sandbox.runs.tape._BYTES", 60_000)
    stage = make("head-on")
    watch(stage, 20.0)
    assert sum(kept.nbytes for kept in stage.tape.frames) < 60_000
    gaps = np.diff(stage.tape.times)
    assert gaps[0] > 1.9 * gaps[-1]
    assert stage.tape.times[0] == 0
    assert stage.tape.times == sorted(stage.tape.times)
