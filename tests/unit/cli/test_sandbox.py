"""``course sandbox`` from the outside: piped, without a terminal, without extras."""

import csv
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from course import __file__ as package
from course.progress.workspace import Workspace

SCENES = Path(package).parent / "sandbox" / "scenes"


@pytest.fixture
def sandbox(course):
    """``course sandbox`` with these words, which ends with this code."""
    return lambda line="", code=0: course(f"sandbox {line}").ends(code)


def test_the_list_comes_out_of_a_pipe_with_or_without_its_word(sandbox):
    out = sandbox().says("newtons-cradle").out
    assert len(out.splitlines()) >= 13
    assert sandbox("list").out == out


def test_one_scene_is_listed_with_its_question_and_parameters(sandbox):
    data = sandbox("list incline --json").json
    assert data["schema"] == "course.sandbox-list/1"
    (scene,) = data["scenes"]
    assert "30 degrees steep, and the friction of the pair is 0.4" in scene["question"]
    assert {"angle", "gravity", "step"} <= {p["name"] for p in scene["parameters"]}
    sandbox("list galton-board").says("walls=0 (0 to 1)", f"file: {SCENES / 'galton-board.toml'}")


@pytest.mark.parametrize("scene", [path.stem for path in SCENES.glob("*.toml")])
def test_a_scene_lists_every_parameter_that_it_says_it_knows(sandbox, scene):
    (listed,) = sandbox(f"list {scene} --json").json["scenes"]
    refused = sandbox(f"play {scene} --set nope=1 --json", 2).json
    known = refused["error"]["help"].removeprefix("Known: ").rstrip(".").split(", ")
    assert [parameter["name"] for parameter in listed["parameters"]] == known


def test_a_piped_play_runs_unseen_and_compares_and_needs_no_word_play(sandbox):
    ran = sandbox("play head-on --guess 1.5")
    ran.says("your guess: 1.5 m/s", "simulation: 2 m/s", "25 % too low")
    for guess in "1.5", "1,5", "'1.5 m/s'":
        assert sandbox(f"head-on --guess {guess}").out == ran.out
    sandbox("heda-on", 2).warns("Did you mean: course sandbox play head-on?")
    sandbox("plai", 2).warns("No such command 'plai'")


def test_in_a_terminal_or_with_web_all_scenes_open(sandbox, request, tmp_path, monkeypatch):
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
    sandbox("--web --no-browser")
    request.getfixturevalue("person")
    monkeypatch.setenv("FORCE_COLOR", "1")
    sandbox()
    assert asked == [
        ("web", None, "my-scene.toml", "my-scene-2.toml", ["guess", "open_browser", "port", "say"]),
        ("terminal", None, "my-scene-3.toml", "my-scene-4.toml", ["guess"]),
    ]
    assert (tmp_path / "my-scene.toml").read_bytes() == b"one", "a file that is there stays"


def test_question_answer_and_reason_have_the_numbers_that_were_set(sandbox):
    said = sandbox("play bullet-wall --headless --guess 0.04 --set step=0.0004 --json").json["prediction"]
    assert (said["theory"], said["simulation"]) == (pytest.approx(0.04), pytest.approx(0.04))
    assert said["guess_right"]
    assert "one step of 0.0004 s" in said["question"]
    ran = sandbox("play head-on --set restitution=0").lacks("nothing is lost")
    assert "restitution of the pair is 0." in ran.words


def test_a_value_that_is_no_number_gets_an_example_that_works(sandbox):
    ran = sandbox("play head-on --set g=abc", 2).warns("'abc' is not a number", "--set gravity=1.62")
    assert "--set g=1" not in ran.err
    sandbox("play head-on --set gravity=1.62")


def test_describe_tells_the_run(sandbox):
    sandbox("play restitution-row --describe").says(
        "0.45 s: ball 4 meets the floor at 4.41 m/s and leaves at 3.53; 36 %", "ball 0 comes to rest"
    )
    sandbox("head-on --duration 0.004").says("0.004167 s in 1 step\n")


def test_a_run_that_was_cut_short_is_not_held_against_theory(sandbox):
    short = sandbox("newtons-cradle --duration 0.1 --guess 1.62")
    short.says("Your guess is right by the theory. The run ended after 0.1 s of the scene's 3, perhaps")
    assert "leaves something out" not in short.out
    sandbox("free-fall --duration 0.5").says("Theory and simulation agree.")


def test_json_is_one_object_with_everything(sandbox):
    data = sandbox("play unequal-masses --set ratio=1 --headless --json").json
    assert data["schema"] == "course.sandbox/1"
    assert data["settings"]["ratio"] == 1
    assert data["prediction"]["simulation"] == pytest.approx(1.0)
    assert data["momentum"]["before"] == pytest.approx(data["momentum"]["after"])
    parts = data["receipt"]
    whole = sum(parts[k] for k in ("kinetic", "potential", "contacts", "friction", "rods", "residual"))
    assert whole == pytest.approx(parts["start"] + parts["given"])
    assert [event["kind"] for event in data["events"]] == ["contact", "rest"]


def test_csv_holds_a_row_for_each_body_and_time(sandbox, tmp_path):
    sandbox("play head-on --csv run.csv --every 0.5")
    rows = list(csv.reader((tmp_path / "run.csv").read_text().splitlines()))
    assert rows[0][:3] == ["t [s]", "body", "x [m]"]
    assert [row[0] for row in rows[1:]] == [f"{t}" for t in (0.0, 0.5, 1.0, 1.5, 2.0) for _ in range(2)]


def test_files_are_written_and_what_was_there_is_kept(sandbox, tmp_path):
    (tmp_path / "a.gif").write_bytes(b"old")
    ran = sandbox("play head-on --duration 1 --gif a.gif --png a.png --at 0.51 --record a.jsonl")
    ran.says("is kept at")
    assert (tmp_path / "a.gif").read_bytes().startswith(b"GIF89a")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    from PIL import Image

    with Image.open(tmp_path / "a.gif") as film:
        assert film.n_frames == 26
    data = sandbox("replay a.jsonl --json").json
    assert (data["schema"], data["same"], data["steps"]) == ("course.sandbox-replay/1", True, 240)


def test_a_replay_that_differs_says_where_and_exits_with_one(sandbox, tmp_path):
    sandbox("play billiards-break --duration 0.5 --record a.jsonl")
    path = tmp_path / "a.jsonl"
    path.write_text(path.read_text().replace('"velocity":[6.0,', '"velocity":[6.1,'))
    sandbox("replay a.jsonl", 1).says("differs at step 240")


@pytest.mark.parametrize("kind", ["sdf", "mjcf"])
def test_an_export_goes_to_the_screen_or_a_file(sandbox, tmp_path, kind):
    out = sandbox(f"export head-on --format {kind}").out
    assert out.startswith("<?xml")
    beside = sandbox(f"export head-on --format {kind} -o world.xml --json").json["beside"]
    assert (tmp_path / "world.xml").read_text() == out
    if kind == "sdf":
        assert beside["path"] == str(tmp_path / "gazebo_start.py")
        assert "def get_system" in (tmp_path / "gazebo_start.py").read_text()
    else:
        assert beside is None


def test_a_students_scene_is_played_and_a_wrong_one_refused_with_its_line(sandbox, tmp_path):
    source = (SCENES / "head-on.toml").read_text()
    mine = tmp_path / "mine.toml"
    mine.write_text(source)
    sandbox("play mine.toml").says("simulation: 2 m/s")
    sandbox("play mine", 5).warns("Your own is a file: mine.toml.")
    mine.write_text(source.replace("radius = 0.2", "radius = 0", 1))
    sandbox("play mine.toml", 2).warns("mine.toml:")
    sandbox("list mine.toml", 2).warns("radius` must be a number > 0.0.")
    mine.write_text(source.replace("order =", "# order =").replace('material = "puck"', "", 1))
    lacking = "mine.toml:1: the file lacks the key `order`; `body[1]` lacks the key `material`."
    sandbox("play mine.toml", 2).warns(lacking)
    mine.write_text(source.replace('shape = "circle"', 'shape = "cirle"', 1))
    said = sandbox("play mine.toml --json", 2).json["error"]["help"]
    assert said == 'Write one of "box", "circle", "polygon", "segment".'


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("play nothing", 5),
        ("play nothing.toml", 5),
        ("replay nothing.jsonl", 5),
        ("play head-on --set wind=1", 2),
        ("play head-on --set gravity", 2),
        ("play head-on --set gravity=much", 2),
        ("play head-on --set gravity=nan", 2),
        ("play head-on --duration -1", 2),
        ("play head-on --gif a.png", 2),
        ("play head-on --at 1", 2),
        ("play head-on --every 1", 2),
        ("play head-on --port 8000", 2),
        ("play head-on --guess '1.6, 2'", 2),
        ("play head-on --at 2.1 --png a.png", 2),
        ("play galton-board --set seed=1.5", 2),
        ("play head-on --web --describe", 2),
        ("export head-on --format urdf", 2),
        ("export galton-board --format sdf", 2),
    ],
)
def test_each_mistake_has_its_exit_code_and_a_help(sandbox, line, code):
    assert sandbox(f"{line} --json", code).json["error"]["message"]


def test_a_guess_made_in_a_workspace_is_kept(course, sandbox, tmp_path):
    course("init .").ends(0)
    sandbox("play head-on --guess 2")
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
