"""Films and pictures are what they say they are."""

import io
import math

import pytest
from PIL import Image

from course.errors import MissingCapabilityError, UsageError
from course.sandbox.runs import recording as films
from course.sandbox.runs.recording import Film
from course.sandbox.scene.loading import choose
from course.sandbox.views.stage import Stage
from course.sandbox.world.world import World


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
    monkeypatch.setattr(films.shutil, "which", lambda name: None)
    with pytest.raises(MissingCapabilityError) as caught:
        film.mp4()
    assert "GIF" in caught.value.help


def test_ffmpeg_gets_every_frame_and_its_failure_is_told_in_words(monkeypatch, tmp_path):
    film, _ = filmed("head-on", 3)
    fake = tmp_path / "ffmpeg"
    fake.write_text('#!/bin/sh\nfor last; do :; done\ncat > "$last"\n')
    fake.chmod(0o755)
    monkeypatch.setattr(films.shutil, "which", lambda name: str(fake))
    assert len(film.mp4()) == 3 * film.size[0] * film.size[1] * 3
    fake.write_text("#!/bin/sh\necho no such encoder >&2\nexit 1\n")
    with pytest.raises(MissingCapabilityError, match="no such encoder"):
        film.mp4()


def test_of_a_long_run_the_last_part_is_filmed_and_its_name_says_so(monkeypatch):
    stage = Stage(choose("head-on"))
    while stage.world.t < 4.0:
        stage.tick(1 / 60, budget=60.0)
    monkeypatch.setattr(films, "_GIF_BYTES", 25 * math.prod(Film(stage.chosen.scene, 640).size))
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
    monkeypatch.setattr(films, "_MOST_FRAMES", 1)
    with pytest.raises(UsageError):
        filmed("head-on", 2)
