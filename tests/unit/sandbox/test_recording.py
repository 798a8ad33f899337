"""What is kept of a run: a recording gives it again or says where it does not; films and pictures."""

import io
import json
import math
import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from course.errors import CourseError, IntegrityError, MissingCapabilityError, NotFoundError, UsageError
from course.sandbox.runs import recording as runs
from course.sandbox.runs.recording import Film, Recording, read, replay
from course.sandbox.scene.loading import choose
from course.sandbox.views.stage import Stage
from course.sandbox.world.world import World
from tests.unit.sandbox.hands import meddle

NAMES = ["box-stack", "billiards-break", "robot-boxes", "restitution-row", "newtons-cradle", "head-on"]


def random_run(seed, turns=12):
    """A run with everything a hand can do in it."""
    chance = random.Random(seed)
    chosen = choose(chance.choice(NAMES))
    world = World(chosen.scene, chosen.settings)
    recording = Recording(world, every=25)
    for _ in range(turns):
        meddle(world, chance)
        for x in (0.0, 0.1):  # of two places before one step only the last is felt
            world.drag(x, 0.5)
        if chance.random() < 0.2:
            chance.choice([world.reset, world.drain_events])()
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


def rewritten(recording, path, change):
    """The recording in a file, its first line changed."""
    first, *rest = recording.encode().splitlines()
    head = json.loads(first)
    change(head)
    path.write_bytes(b"\n".join([json.dumps(head).encode(), *rest]))
    return read(path)


def test_a_replay_says_between_which_steps_it_leaves_the_path(tmp_path):
    def push(head):
        ball = next(body for body in head["scene"]["body"] if body["name"] == "apex")
        ball["position"][0] += 1e-9

    world = World(choose("billiards-break").scene)
    recording = Recording(world, every=10)
    world.step(200)
    difference = replay(rewritten(recording, tmp_path / "run.jsonl", push))
    assert (difference.same, difference.tick, difference.good_until) == (False, 10, 0)


def test_other_versions_are_named(tmp_path):
    world = World(choose("head-on").scene)
    recording = Recording(world)
    world.step(5)
    older = rewritten(recording, tmp_path / "run.jsonl", lambda head: head["versions"].update(pymunk="6.0.0"))
    difference = replay(older)
    assert difference.same
    assert difference.versions["pymunk"][0] == "6.0.0"


DONE = b'{"kind":"input","tick":%d,"what":%s}'


def test_a_recording_cut_off_damaged_or_foreign_is_refused_with_what_to_do(tmp_path):
    path, whole = tmp_path / "run.jsonl", random_run(7, turns=4)
    head, *lines, end = whole.splitlines(keepends=True)
    days_later = end.replace(b'"tick":', b'"tick":9999')
    for data, error, said in (
        ([], UsageError, "its first line is no head"),
        ([b"time,x,y\n"], UsageError, "its first line is not that of one"),
        ([whole[:20]], UsageError, "its first line is not that of one"),
        ([whole[:-9]], IntegrityError, "the file was cut off there"),
        ([head, *lines], IntegrityError, "has no end; it was cut off"),
        ([head, b"{\n", *lines, end], IntegrityError, "run.jsonl:2 is damaged"),
        ([head, end, lines[0], end], IntegrityError, "its steps are out of order"),
        ([head, *lines, end, end], IntegrityError, "its steps are out of order"),
        ([head, DONE % (0, b'"__init__"'), b"\n", *lines, end], IntegrityError, "what no recording holds"),
        ([head, *lines, days_later], IntegrityError, "what no recording holds"),
    ):
        path.write_bytes(b"".join(data))
        with pytest.raises(error, match=said) as raised:
            read(path)
        assert "course sandbox play SCENE --record FILE" in raised.value.help
    with pytest.raises(NotFoundError):
        read(tmp_path / "nothing.jsonl")


def test_what_a_recording_cannot_do_is_named_with_the_file_and_the_step(tmp_path):
    world = World(choose("head-on").scene)
    recording = Recording(world)
    world.step(20)
    head, *rest = recording.encode().splitlines()
    path = tmp_path / "run.jsonl"
    for what, error, said in (
        (b'"remove","arguments":["nobody"]', UsageError, "run.jsonl cannot do .* before step 6: .*nobody"),
        (b'"set","arguments":["step",1]', UsageError, "run.jsonl cannot do .* before step 6: .*step"),
        (b'"drag"', IntegrityError, "drag at step 5 has the wrong values"),
    ):
        path.write_bytes(b"\n".join([head, DONE % (5, what), *rest]))
        with pytest.raises(error, match=said):
            replay(read(path))


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


# -- films and pictures ----------------------------------------------------------------------------------


def filmed(name, frames):
    world = World(choose(name).scene)
    film = Film(world.scene, width=200)
    for _ in range(frames):
        film.take(world.parts, world.snapshot())
        world.step(10)
    return film, world


def test_a_gif_has_every_frame_at_its_time_and_moves():
    film, _ = filmed("head-on", 12)
    picture = Image.open(io.BytesIO(film.gif(fps=25)))
    assert picture.n_frames == 12
    assert picture.size == film.size
    assert picture.info["duration"] == 40
    first = picture.convert("RGB").tobytes()
    picture.seek(11)
    assert picture.convert("RGB").tobytes() != first


def test_bodies_are_where_the_scene_has_them_in_their_own_colour():
    film, world = filmed("head-on", 1)
    image = film.draw(world.parts, World(world.scene).snapshot())
    left, bottom, right, top = world.scene.view
    for part in world.parts:
        x = round((part.x - left) / (right - left) * film.size[0])
        y = round((top - part.y) / (top - bottom) * film.size[1]) + 6  # beside the mark that shows turning
        assert "#{:02x}{:02x}{:02x}".format(*image.getpixel((x, y))) == part.colour


@pytest.mark.parametrize("name", ["newtons-cradle", "galton-board", "robot-boxes"])
def test_every_shape_joint_and_wheel_can_be_drawn(name):
    film, world = filmed(name, 1)
    image = Image.open(io.BytesIO(film.png(world.parts, world.snapshot())))
    assert len(image.getcolors(100_000)) > 10


def test_without_ffmpeg_an_mp4_says_what_to_do(monkeypatch):
    film, _ = filmed("head-on", 1)
    monkeypatch.setattr(runs.shutil, "which", lambda name: None)
    with pytest.raises(MissingCapabilityError) as caught:
        film.mp4()
    assert "GIF" in caught.value.help


def test_ffmpeg_gets_every_frame_and_its_failure_is_told_in_words(monkeypatch, tmp_path):
    film, _ = filmed("head-on", 3)
    fake = tmp_path / "ffmpeg"
    fake.write_text('#!/bin/sh\nfor last; do :; done\ncat > "$last"\n')
    fake.chmod(0o755)
    monkeypatch.setattr(runs.shutil, "which", lambda name: str(fake))
    assert len(film.mp4()) == 3 * film.size[0] * film.size[1] * 3
    fake.write_text("#!/bin/sh\necho no such encoder >&2\nexit 1\n")
    with pytest.raises(MissingCapabilityError, match="no such encoder"):
        film.mp4()


def test_of_a_long_run_the_last_part_is_filmed_and_its_name_says_so(monkeypatch):
    stage = Stage(choose("head-on"))
    while stage.world.t < 4.0:
        stage.tick(1 / 60, budget=60.0)
    monkeypatch.setattr(runs, "_GIF_BYTES", 25 * math.prod(Film(stage.chosen.scene, 640).size))
    film = stage.film("gif", 640)
    film.wait(60)
    assert (film.failed, film.name) == ("", "head-on-last-1-s.gif")
    assert Image.open(io.BytesIO(film.data)).n_frames == 25


def test_large_frames_are_kept_packed():
    film, world = Film(choose("head-on").scene, width=1920), World(choose("head-on").scene)
    for _ in range(3):
        film.take(world.parts, world.snapshot())
    assert sum(map(len, film._frames)) < 0.05 * 3 * film.size[0] * film.size[1]


def test_a_film_without_frames_or_too_long_is_refused(monkeypatch):
    film = Film(choose("head-on").scene)
    with pytest.raises(UsageError):
        film.gif()
    monkeypatch.setattr(runs, "_MOST_FRAMES", 1)
    with pytest.raises(UsageError):
        filmed("head-on", 2)
