"""``course sandbox`` from the outside: piped, without a terminal, without extras."""

import csv
import json
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

import course
from tests.command_line import in_process

ROOT = Path(course.__file__).parents[1]
SCENES = ROOT / "course" / "sandbox" / "scenes"


def sandbox(*arguments, cwd, code=0):
    done = in_process("sandbox", *arguments, cwd=cwd, env={**os.environ, "COLUMNS": "80"})
    assert done.returncode == code, done.stderr + done.stdout
    return done


def test_the_list_comes_out_of_a_pipe_with_or_without_its_word(tmp_path):
    out = sandbox(cwd=tmp_path).stdout
    assert "newtons-cradle" in out
    assert len(out.splitlines()) >= 13
    assert sandbox("list", cwd=tmp_path).stdout == out


def test_one_scene_is_listed_with_its_question_and_parameters(tmp_path):
    data = json.loads(sandbox("list", "incline", "--json", cwd=tmp_path).stdout)
    assert data["schema"] == "course.sandbox-list/1"
    (scene,) = data["scenes"]
    assert "30 degrees steep, and the friction of the pair is 0.4" in scene["question"]
    assert {"angle", "gravity", "step"} <= {p["name"] for p in scene["parameters"]}
    listed = sandbox("list", "galton-board", cwd=tmp_path).stdout
    assert "walls=0 (0 to 1)" in listed
    assert f"file: {SCENES / 'galton-board.toml'}" in listed


@pytest.mark.parametrize("scene", [path.stem for path in SCENES.glob("*.toml")])
def test_a_scene_lists_every_parameter_that_it_says_it_knows(tmp_path, scene):
    (listed,) = json.loads(sandbox("list", scene, "--json", cwd=tmp_path).stdout)["scenes"]
    refused = sandbox("play", scene, "--set", "nope=1", "--json", cwd=tmp_path, code=2).stdout
    known = json.loads(refused)["error"]["help"].removeprefix("Known: ").rstrip(".").split(", ")
    assert [parameter["name"] for parameter in listed["parameters"]] == known


def test_a_piped_play_runs_unseen_and_compares_and_needs_no_word_play(tmp_path):
    out = sandbox("play", "head-on", "--guess", "1.5", cwd=tmp_path).stdout
    assert "your guess: 1.5 m/s" in out
    assert "simulation: 2 m/s" in out
    assert "25 % too low" in out
    for guess in "1.5", "1,5", "1.5 m/s":
        assert sandbox("head-on", "--guess", guess, cwd=tmp_path).stdout == out
    assert "Did you mean: course sandbox play head-on?" in sandbox("heda-on", cwd=tmp_path, code=2).stderr
    assert "No such command 'plai'" in sandbox("plai", cwd=tmp_path, code=2).stderr


def test_in_a_terminal_or_with_web_all_scenes_open(tmp_path, monkeypatch):
    from course.cli.frame.console import Console
    from course.cli.sandbox import play as opened

    asked = []

    def view(name):
        def play(chosen, desk, **more):
            path = desk.save("my-scene.toml", b"one")
            again = desk.save("my-scene.toml", b"two")
            asked.append((name, chosen, Path(path).name, Path(again).name, sorted(more)))
            return b""

        return play

    monkeypatch.setattr(opened, "_view", view)
    monkeypatch.setattr(opened, "require", lambda *_: None)  # no page is opened
    sandbox("--web", "--no-browser", cwd=tmp_path)
    monkeypatch.setattr(Console, "interactive", property(lambda _: True))
    monkeypatch.setenv("FORCE_COLOR", "1")
    sandbox(cwd=tmp_path)
    assert asked == [
        ("web", None, "my-scene.toml", "my-scene-2.toml", ["guess", "open_browser", "port", "say"]),
        ("terminal", None, "my-scene-3.toml", "my-scene-4.toml", ["guess"]),
    ]
    assert (tmp_path / "my-scene.toml").read_bytes() == b"one", "a file that is there stays"


def test_question_answer_and_reason_have_the_numbers_that_were_set(tmp_path):
    options = ["--headless", "--guess", "0.04", "--set", "step=0.0004"]
    data = json.loads(sandbox("play", "bullet-wall", *options, "--json", cwd=tmp_path).stdout)
    said = data["prediction"]
    assert (said["theory"], said["simulation"]) == (pytest.approx(0.04), pytest.approx(0.04))
    assert said["guess_right"]
    assert "one step of 0.0004 s" in said["question"]
    out = sandbox("play", "head-on", "--set", "restitution=0", cwd=tmp_path).stdout
    assert "nothing is lost" not in out
    assert "restitution of the pair is 0." in " ".join(out.split())


def test_a_value_that_is_no_number_gets_an_example_that_works(tmp_path):
    ran = sandbox("play", "head-on", "--set", "g=abc", cwd=tmp_path, code=2)
    assert "'abc' is not a number" in ran.stderr
    assert "--set g=1" not in ran.stderr
    assert "--set gravity=1.62" in ran.stderr
    sandbox("play", "head-on", "--set", "gravity=1.62", cwd=tmp_path)


def test_describe_tells_the_run(tmp_path):
    out = sandbox("play", "restitution-row", "--describe", cwd=tmp_path).stdout
    assert "0.45 s: ball 4 meets the floor at 4.41 m/s and leaves at 3.53; 36 %" in out
    assert "ball 0 comes to rest" in out
    assert "0.004167 s in 1 step\n" in sandbox("head-on", "--duration", "0.004", cwd=tmp_path).stdout


def test_a_run_that_was_cut_short_is_not_held_against_theory(tmp_path):
    short = sandbox("newtons-cradle", "--duration", "0.1", "--guess", "1.62", cwd=tmp_path).stdout
    assert "Your guess is right by the theory. The run ended after 0.1 s of the scene's 3, perhaps" in short
    assert "leaves something out" not in short
    assert "Theory and simulation agree." in sandbox("free-fall", "--duration", "0.5", cwd=tmp_path).stdout


def test_json_is_one_object_with_everything(tmp_path):
    done = sandbox("play", "unequal-masses", "--set", "ratio=1", "--headless", "--json", cwd=tmp_path)
    data = json.loads(done.stdout)
    assert data["schema"] == "course.sandbox/1"
    assert data["settings"]["ratio"] == 1
    assert data["prediction"]["simulation"] == pytest.approx(1.0)
    assert data["momentum"]["before"] == pytest.approx(data["momentum"]["after"])
    parts = data["receipt"]
    whole = sum(parts[k] for k in ("kinetic", "potential", "contacts", "friction", "rods", "residual"))
    assert whole == pytest.approx(parts["start"] + parts["given"])
    assert [event["kind"] for event in data["events"]] == ["contact", "rest"]


def test_csv_holds_a_row_for_each_body_and_time(tmp_path):
    sandbox("play", "head-on", "--csv", "run.csv", "--every", "0.5", cwd=tmp_path)
    rows = list(csv.reader((tmp_path / "run.csv").read_text().splitlines()))
    assert rows[0][:3] == ["t [s]", "body", "x [m]"]
    assert [row[0] for row in rows[1:]] == [f"{t}" for t in (0.0, 0.5, 1.0, 1.5, 2.0) for _ in range(2)]


def test_files_are_written_and_what_was_there_is_kept(tmp_path):
    (tmp_path / "a.gif").write_bytes(b"old")
    files = ["--gif", "a.gif", "--png", "a.png", "--at", "0.51", "--record", "a.jsonl"]
    out = sandbox("play", "head-on", "--duration", "1", *files, cwd=tmp_path).stdout
    assert "is kept at" in out
    assert (tmp_path / "a.gif").read_bytes().startswith(b"GIF89a")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    from PIL import Image

    with Image.open(tmp_path / "a.gif") as film:
        assert film.n_frames == 26
    data = json.loads(sandbox("replay", "a.jsonl", "--json", cwd=tmp_path).stdout)
    assert (data["schema"], data["same"], data["steps"]) == ("course.sandbox-replay/1", True, 240)


def test_a_replay_that_differs_says_where_and_exits_with_one(tmp_path):
    sandbox("play", "billiards-break", "--duration", "0.5", "--record", "a.jsonl", cwd=tmp_path)
    path = tmp_path / "a.jsonl"
    path.write_text(path.read_text().replace('"velocity":[6.0,', '"velocity":[6.1,'))
    out = sandbox("replay", "a.jsonl", cwd=tmp_path, code=1).stdout
    assert "differs at step 240" in out


@pytest.mark.parametrize("kind", ["sdf", "mjcf"])
def test_an_export_goes_to_the_screen_or_a_file(tmp_path, kind):
    out = sandbox("export", "head-on", "--format", kind, cwd=tmp_path).stdout
    assert out.startswith("<?xml")
    written = sandbox("export", "head-on", "--format", kind, "-o", "world.xml", "--json", cwd=tmp_path).stdout
    assert (tmp_path / "world.xml").read_text() == out
    beside = json.loads(written)["beside"]
    if kind == "sdf":
        assert beside["path"] == str(tmp_path / "gazebo_start.py")
        assert "def get_system" in (tmp_path / "gazebo_start.py").read_text()
    else:
        assert beside is None


def test_a_students_scene_is_played_and_a_wrong_one_refused_with_its_line(tmp_path):
    source = (SCENES / "head-on.toml").read_text()
    (tmp_path / "mine.toml").write_text(source)
    assert "simulation: 2 m/s" in sandbox("play", "mine.toml", cwd=tmp_path).stdout
    assert "Your own is a file: mine.toml." in sandbox("play", "mine", cwd=tmp_path, code=5).stderr
    (tmp_path / "mine.toml").write_text(source.replace("radius = 0.2", "radius = 0", 1))
    assert "mine.toml:" in sandbox("play", "mine.toml", cwd=tmp_path, code=2).stderr
    assert "radius` must be a number > 0.0." in sandbox("list", "mine.toml", cwd=tmp_path, code=2).stderr
    few = source.replace("order =", "# order =").replace('material = "puck"', "", 1)
    (tmp_path / "mine.toml").write_text(few)
    said = sandbox("play", "mine.toml", cwd=tmp_path, code=2).stderr
    assert "mine.toml:1: the file lacks the key `order`; `body[1]` lacks the key `material`." in said
    (tmp_path / "mine.toml").write_text(source.replace('shape = "circle"', 'shape = "cirle"', 1))
    said = sandbox("play", "mine.toml", "--json", cwd=tmp_path, code=2).stdout
    assert json.loads(said)["error"]["help"] == 'Write one of "box", "circle", "polygon", "segment".'


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["play", "nothing"], 5),
        (["play", "nothing.toml"], 5),
        (["replay", "nothing.jsonl"], 5),
        (["play", "head-on", "--set", "wind=1"], 2),
        (["play", "head-on", "--set", "gravity"], 2),
        (["play", "head-on", "--set", "gravity=much"], 2),
        (["play", "head-on", "--set", "gravity=nan"], 2),
        (["play", "head-on", "--duration", "-1"], 2),
        (["play", "head-on", "--gif", "a.png"], 2),
        (["play", "head-on", "--at", "1"], 2),
        (["play", "head-on", "--every", "1"], 2),
        (["play", "head-on", "--port", "8000"], 2),
        (["play", "head-on", "--guess", "1.6, 2"], 2),
        (["play", "head-on", "--at", "2.1", "--png", "a.png"], 2),
        (["play", "galton-board", "--set", "seed=1.5"], 2),
        (["play", "head-on", "--web", "--describe"], 2),
        (["export", "head-on", "--format", "urdf"], 2),
        (["export", "galton-board", "--format", "sdf"], 2),
    ],
)
def test_each_mistake_has_its_exit_code_and_a_help(tmp_path, arguments, code):
    data = json.loads(sandbox(*arguments, "--json", cwd=tmp_path, code=code).stdout)
    assert data["ok"] is False
    assert data["error"]["message"]


def test_a_guess_made_in_a_workspace_is_kept(tmp_path):
    assert in_process("init", ".", cwd=tmp_path).returncode == 0
    sandbox("play", "head-on", "--guess", "2", cwd=tmp_path)
    from course.progress.workspace import Workspace

    (event,) = Workspace.find(tmp_path).store.events("sandbox-guess")
    assert event.subject == "head-on"
    assert (event.data["guess"], event.data["right"]) == (2.0, True)


def test_the_address_of_the_page_reaches_a_pipe_while_the_page_is_served(tmp_path):
    pytest.importorskip("starlette")
    pytest.importorskip("uvicorn")
    command = [sys.executable, "-m", "course", "sandbox", "play", "incline", "--web", "--no-browser"]
    buffered = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    with subprocess.Popen(
        command, cwd=tmp_path, env=buffered, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True
    ) as serving:
        giving_up = threading.Timer(60, serving.kill)  # of what never says anything
        giving_up.start()
        try:
            assert "http://127.0.0.1:" in serving.stdout.readline()
        finally:
            giving_up.cancel()
            serving.kill()
