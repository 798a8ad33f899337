"""A recording gives the same run again, or says where it does not."""

import json
import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from course.errors import CourseError, IntegrityError, NotFoundError, UsageError
from course.sandbox.runs.recording import Recording, read, replay
from course.sandbox.scene.loading import choose
from course.sandbox.world.world import World

NAMES = ["box-stack", "billiards-break", "robot-boxes", "restitution-row", "newtons-cradle", "head-on"]


def random_run(seed, turns=12):
    """A run with everything a hand can do in it."""
    chance = random.Random(seed)
    chosen = choose(chance.choice(NAMES))
    world = World(chosen.scene, chosen.settings)
    recording = Recording(world, every=25)
    for _ in range(turns):
        x, y = chance.uniform(-1.5, 1.5), chance.uniform(-1, 1.5)
        move = chance.choice(
            ["grab", "grab", "drag", "drag", "release", "throw", "spawn", "set", "reset", "look"]
        )
        if move == "grab":
            world.grab(x, y, 1.0)
        elif move == "drag":
            world.drag(x, y)
            world.drag(x + 0.1, y)
        elif move == "release":
            world.release()
        elif move == "throw":
            world.throw(x, y, chance.uniform(-5, 5), chance.uniform(-5, 5), 1.0)
        elif move == "spawn":
            world.spawn(chance.choice(["circle", "box"]), x, y, chance.uniform(-2, 2))
        elif move == "set":
            world.set(chance.choice(["gravity", "restitution", "friction"]), chance.random())
        elif move == "reset":
            world.reset()
        else:
            world.drain_events()
        if chance.random() < 0.5:
            world.step(chance.randrange(20))
        else:
            world.advance(chance.random() * 0.05)
    return recording.encode()


@pytest.mark.parametrize("seed", range(20))
def test_a_replay_of_random_input_is_the_same_bit_by_bit(seed, tmp_path):
    path = tmp_path / "run.jsonl"
    path.write_bytes(random_run(seed))
    difference = replay(read(path))
    assert difference.same, difference
    assert difference.versions == {}


@pytest.mark.soak
def test_a_thousand_replays_of_random_input_are_the_same(tmp_path):
    path = tmp_path / "run.jsonl"
    for seed in range(1000, 2000):
        path.write_bytes(random_run(seed))
        assert replay(read(path)).same, seed


def test_a_replay_says_between_which_steps_it_leaves_the_path(tmp_path):
    world = World(choose("billiards-break").scene)
    recording = Recording(world, every=10)
    world.step(200)
    lines = recording.encode().splitlines()
    moved = json.loads(lines[0])
    ball = next(body for body in moved["scene"]["body"] if body["name"] == "apex")
    ball["position"][0] += 1e-9
    path = tmp_path / "run.jsonl"
    path.write_bytes(b"\n".join([json.dumps(moved).encode(), *lines[1:]]))
    difference = replay(read(path))
    assert (difference.same, difference.tick, difference.good_until) == (False, 10, 0)


def test_other_versions_are_named(tmp_path):
    world = World(choose("head-on").scene)
    recording = Recording(world)
    world.step(5)
    lines = recording.encode().splitlines()
    head = json.loads(lines[0])
    head["versions"]["pymunk"] = "6.0.0"
    path = tmp_path / "run.jsonl"
    path.write_bytes(b"\n".join([json.dumps(head).encode(), *lines[1:]]))
    difference = replay(read(path))
    assert difference.same
    assert difference.versions["pymunk"][0] == "6.0.0"


def test_a_recording_cut_off_or_damaged_is_refused(tmp_path):
    lines = random_run(3).splitlines()
    path = tmp_path / "run.jsonl"
    for data, error in (
        (b"", UsageError),
        (b"hello", UsageError),
        (b"\n".join(lines[:-1]), IntegrityError),
        (b"\n".join([*lines[:2], b"{", *lines[2:]]), IntegrityError),
        (b"\n".join([lines[0], lines[-1], lines[1], lines[-1]]), IntegrityError),
        (b"\n".join([lines[0], b'{"kind":"input","tick":0,"what":"__init__"}', lines[-1]]), IntegrityError),
        (b"\n".join([lines[0], b'{"kind":"input","tick":0,"what":"drag"}', lines[-1]]), IntegrityError),
        (b"\n".join([*lines[:-1], lines[-1].replace(b'"tick":', b'"tick":9999')]), IntegrityError),  # days
    ):
        path.write_bytes(data)
        with pytest.raises(error):
            replay(read(path))
    with pytest.raises(NotFoundError):
        read(tmp_path / "nothing.jsonl")


def test_what_a_recording_cannot_do_is_named_with_the_file_and_the_step(tmp_path):
    world = World(choose("head-on").scene)
    recording = Recording(world)
    world.step(20)
    head, *rest = recording.encode().splitlines()
    path = tmp_path / "run.jsonl"
    for what, said in (
        (b'"remove","arguments":["nobody"]', "nobody"),
        (b'"set","arguments":["step",1]', "step"),
    ):
        line = b'{"kind":"input","tick":5,"what":' + what + b"}"
        path.write_bytes(b"\n".join([head, line, *rest]))
        with pytest.raises(UsageError, match=f"run.jsonl cannot do .* before step 6: .*{said}"):
            replay(read(path))


def test_a_cut_file_and_a_foreign_one_are_told_with_what_to_do(tmp_path):
    path, whole = tmp_path / "run.jsonl", random_run(7, turns=4)
    for data, said in (
        (b"time,x,y\n", "is not a recording: its first line"),
        (whole[:20], "is not a recording: its first line"),
        (whole[:-9], "is damaged: the file was cut off there"),
        (whole[: whole.rindex(b"\n", 0, -1) + 1], "has no end; it was cut off"),
    ):
        path.write_bytes(data)
        with pytest.raises((UsageError, IntegrityError), match=said) as raised:
            read(path)
        assert "course sandbox play SCENE --record FILE" in raised.value.help


def test_a_scene_that_a_recording_spoilt_is_refused_with_its_place(tmp_path):
    path = tmp_path / "run.jsonl"
    head, _, rest = random_run(7, turns=4).partition(b"\n")
    scene = json.loads(head)["scene"]
    old = json.dumps(scene["material"][0]["name"]).encode()
    path.write_bytes(head.replace(b'"name":' + old, b'"name":"stone"', 1) + b"\n" + rest)
    with pytest.raises(IntegrityError, match=r"run\.jsonl:1 is damaged: in its scene, there is no material"):
        replay(read(path))


@settings(max_examples=60)
@given(st.data())
def test_bytes_changed_anywhere_never_crash_a_replay(tmp_path_factory, data):
    lines = bytearray(random_run(7, turns=4))
    for _ in range(data.draw(st.integers(1, 4))):
        lines[data.draw(st.integers(0, len(lines) - 1))] = data.draw(st.integers(32, 126))
    path = tmp_path_factory.mktemp("r") / "run.jsonl"
    path.write_bytes(bytes(lines))
    try:
        recorded = read(path)
        if recorded.ticks < 5000:
            replay(recorded)
    except CourseError:
        pass


def test_a_recording_begins_before_the_first_step():
    world = World(choose("head-on").scene)
    world.step()
    with pytest.raises(UsageError):
        Recording(world)
