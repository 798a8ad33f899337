"""A world behind a page: requests, time, predictions, and everything that may come over the wire."""

import asyncio
import contextlib
import json
import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from course.errors import MissingCapabilityError
from course.sandbox.runs.running import run
from course.sandbox.scene.loading import choose
from course.sandbox.scene.rules import SETTINGS
from course.sandbox.views.stage import Desk, Stage
from course.sandbox.views.web.session import REQUESTS, Session


class Clock:
    """Real time that passes only when somebody looks, or is told to."""

    def __init__(self, each=0.0):
        self.now, self.each = 0.0, each

    def __call__(self):
        self.now += self.each
        return self.now


def make(name="restitution-row", clock=None, **more):
    chosen, clock = choose(name, more.pop("settings", None)), clock or Clock()
    desk = more.pop("desk", None)
    made = Session(Stage(chosen, clock=clock, **more), desk, clock=clock)
    page = made.join()
    return made, page


def told(page):
    """Every text a page was sent."""
    return [json.loads(data) for data in iter(page.take, None) if isinstance(data, str)]


def frames(page):
    """Every array of numbers a page was sent, the first of which says what they are."""
    return [np.frombuffer(data, "<f4") for data in iter(page.take, None) if isinstance(data, bytes)]


def of(messages, kind):
    return [message for message in messages if message["type"] == kind]


def send(made, page, do, **more):
    made.receive(page, json.dumps({"do": do, **more}))


def watch(made, seconds):
    """Real time passes in frames."""
    for _ in range(round(seconds * 60)):
        made.tick(1 / 60)


# -- hands -----------------------------------------------------------------------------------------------


def test_a_body_that_is_dragged_follows_the_hand_and_flies_on():
    made, page = make("head-on")
    send(made, page, "pause", on=False)
    send(made, page, "grab", x=-1, y=0, reach=0.1)
    assert made.stage.world.held == "left-puck"
    for i in range(30):
        send(made, page, "drag", x=-1.0, y=i / 30)
        made.tick(1 / 60)
    send(made, page, "release")
    row = [part.name for part in made.stage.world.parts].index("left-puck")
    shot = made.stage.world.snapshot()
    assert made.stage.world.held is None
    assert shot.y[row] > 0.5
    assert shot.vy[row] > 1.0


def test_only_the_page_that_holds_a_body_moves_it_and_leaving_lets_go():
    made, page = make("head-on")
    other = made.join()
    send(made, page, "grab", x=-1, y=0)
    send(made, other, "drag", x=5, y=5)
    send(made, other, "release")
    assert made.stage.world.held == "left-puck"
    assert made.stage.world.snapshot().hand[2:] == (-1.0, 0.0)
    made.leave(page)
    assert made.stage.world.held is None


def test_a_push_by_name_adds_to_the_velocity_and_fixed_bodies_do_not_move():
    made, page = make()
    names = [part.name for part in made.stage.world.parts]
    send(made, page, "push", name="ball-3", vx=1.5, vy=0.5)
    send(made, page, "push", name="ball-3", vx=1.0, vy=0.0)
    shot = made.stage.world.snapshot()
    assert (shot.vx[names.index("ball-3")], shot.vy[names.index("ball-3")]) == (2.5, 0.5)
    told(page)
    send(made, page, "push", name="floor", vx=1, vy=0)
    send(made, page, "push", name="nobody", vx=1, vy=0)
    assert [error["message"] for error in told(page)] == [
        "There is no 'floor' that moves.",
        "There is no 'nobody' that moves.",
    ]


def test_a_new_body_is_announced_before_the_frame_that_has_it():
    made, page = make("head-on")
    told(page)
    send(made, page, "spawn", shape="box", x=0, y=1)
    made.tick(0)
    first = [json.loads(page.take()) for _ in range(2)]
    bodies = of(first, "bodies") or of([json.loads(page.take())], "bodies")
    data = None
    while not isinstance(data, bytes):
        data = page.take()
    frame = np.frombuffer(data, "<f4")
    assert bodies[0]["version"] == frame[1]
    assert len(bodies[0]["bodies"]) == frame[4] == 3


# -- time ------------------------------------------------------------------------------------------------


def test_nothing_passes_while_nobody_looks():
    async def go(watching, pages):
        chosen = choose("head-on")
        made = Session(Stage(chosen))
        made.stage.world.paused = False
        if pages:
            page = made.join()
            made.receive(page, json.dumps({"do": "watch", "on": watching}))
        task = asyncio.create_task(made.run())
        for _ in range(20):
            await asyncio.sleep(0.005)
            if made.stage.world.ticks:
                break
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await task
        return made.stage.world.ticks

    assert asyncio.run(go(watching=True, pages=True)) > 0
    assert asyncio.run(go(watching=False, pages=True)) == 0
    assert asyncio.run(go(watching=True, pages=False)) == 0


def test_a_hand_is_answered_before_the_next_frame_is_due(monkeypatch):
    monkeypatch.setattr("course.sandbox.views.web.session._FPS", 0.2)

    async def go():
        made = Session(Stage(choose("head-on")))
        made.stage.world.paused = False
        page = made.join()
        task = asyncio.create_task(made.run())
        await asyncio.sleep(0.05)  # the first frame; the next one is due in five seconds
        x, y = (float(c) for c in made.stage.world.state()[0, :2])
        made.receive(page, json.dumps({"do": "grab", "x": x, "y": y, "reach": 0.5}))
        while True:
            data = await page.fetch()
            if isinstance(data, bytes) and np.frombuffer(data, "<f4")[[0, 6]].tolist() == [1, 1]:
                break
        task.cancel()

    asyncio.run(asyncio.wait_for(go(), 3))


def test_a_world_ends_though_a_request_comes_in_the_same_moment(monkeypatch):
    monkeypatch.setattr("course.sandbox.views.web.session._FPS", 0.2)

    async def go():
        made = Session(Stage(choose("head-on")))
        page = made.join()
        task = asyncio.create_task(made.run())
        await asyncio.sleep(0.05)  # now it waits for the next frame
        send(made, page, "pause", on=True)
        await asyncio.sleep(0)
        task.cancel()
        await asyncio.wait({task}, timeout=10)
        return task.cancelled()

    assert asyncio.run(go())


def test_a_world_that_is_too_much_work_runs_slower_and_says_so():
    clock = Clock(each=0.002)
    made, page = make("head-on", clock=clock, settings={"step": 1e-5})
    send(made, page, "guess", value=None)
    send(made, page, "speed", value=10)
    for _ in range(40):
        made.tick(1 / 60)
    # A frame asks for 16,667 steps; about six looks at the clock fit into its time.
    assert made.stage.world.ticks < 40 * 200
    frame = next(one for one in frames(page) if one[0] == 1)
    assert frame[3] < 0.2


def test_a_run_too_short_to_be_seen_starts_in_slow_motion():
    made, _ = make("bullet-wall")
    assert made.stage.world.speed < 0.1
    assert make("head-on")[0].stage.world.speed == 1.0


def test_of_frames_that_a_slow_page_did_not_fetch_only_the_newest_is_kept():
    made, page = make("head-on")
    send(made, page, "guess", value=None)
    told(page)
    watch(made, 0.5)
    (frame,) = [one for one in frames(page) if one[0] == 1]
    assert frame[2] == pytest.approx(made.stage.world.t)


def test_a_page_that_never_reads_is_let_go():
    made, page = make("head-on")
    for i in range(1000):
        made.stage.world.set("gravity", i % 2)
        made.tick(0)
    assert page.lost
    assert asyncio.run(page.fetch()) is None


def test_after_a_reload_a_page_knows_what_happened_before():
    made, page = make("head-on")
    send(made, page, "guess", value=2)
    watch(made, 1.0)
    send(made, page, "set", key="restitution", value=0.5)
    made.leave(page)
    again = made.join()
    data = list(iter(again.take, None))
    scene = json.loads(data[0])
    assert scene["status"]["settings"]["restitution"] == 0.5
    assert scene["status"]["guess"] == 2
    assert any("the right puck meet at" in event["text"] for event in scene["events"])
    past = np.frombuffer(data[2], "<f4")
    table = past[3:].reshape(int(past[1]), int(past[2]))
    assert table[-1, 0] == pytest.approx(made.stage.world.t, abs=0.05)
    assert table[0, 1] == pytest.approx(2.5)


# -- predict, run, compare -------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["head-on", "restitution-row", "free-fall", "robot-boxes", "bullet-wall"])
def test_the_run_that_was_watched_gives_what_a_run_unseen_gives(name):
    kept = []
    made, page = make(name, keep=kept.append)
    watch(made, 0.1)
    send(made, page, "guess", value=1.5)
    watch(made, 12)
    wanted = run(choose(name), guess=1.5).comparison
    assert kept == [wanted]
    assert not made.stage.world.paused, "no run ends"
    assert made.stage.world.t > made.stage.chosen.scene.duration
    last = of(told(page), "status")[-1]
    assert (last["stage"], last["comparison"]["verdict"]) == ("done", wanted.verdict)


def test_settings_from_before_the_first_step_count_for_theory_too():
    made, page = make("free-fall")
    send(made, page, "set", key="gravity", value=2)
    send(made, page, "guess", value=1)
    watch(made, 3)
    got = of(told(page), "status")[-1]["comparison"]
    wanted = run(choose("free-fall", {"gravity": 2})).comparison
    assert (got["theory"], got["simulation"]) == (wanted.theory, wanted.simulation)


@pytest.mark.parametrize(
    "request_",
    [
        {"do": "grab", "x": -1, "y": 0},
        {"do": "throw", "x": -1, "y": 0, "vx": 1, "vy": 0},
        {"do": "push", "name": "left-puck", "vx": 1, "vy": 0},
        {"do": "spawn", "shape": "box", "x": 0, "y": 1},
        {"do": "set", "key": "restitution", "value": 0.2},
    ],
)
def test_a_run_that_somebody_meddled_with_is_not_compared(request_):
    kept = []
    made, page = make("head-on", keep=kept.append)
    send(made, page, "guess", value=2)
    watch(made, 0.1)
    made.receive(page, json.dumps(request_))
    watch(made, 3)
    status = of(told(page), "status")[-1]
    assert (status["stage"], status["comparison"]) == ("touched", None)
    assert kept == []
    send(made, page, "reset")
    send(made, page, "pause", on=False)
    watch(made, 3)
    assert of(told(page), "status")[-1]["stage"] == "done"
    assert len(kept) == 1


def test_a_reset_ends_the_story_of_the_run_before():
    made, page = make("head-on")
    send(made, page, "pause", on=False)
    watch(made, 1)
    assert "meet at" in json.dumps(of(told(page), "events"))
    send(made, page, "reset")
    made.tick(0)
    assert [message for message in of(told(page), "events") if message.get("anew")]
    late = made.join()
    assert told(late)[0]["events"] == []


def test_a_comparison_that_cannot_be_kept_is_still_shown():
    def full(_):
        raise MissingCapabilityError("The disk is full.")

    made, page = make("head-on", keep=full)
    send(made, page, "guess", value=2)
    watch(made, 3)
    messages = told(page)
    assert [error["message"] for error in of(messages, "error")] == ["The disk is full."]
    assert of(messages, "status")[-1]["stage"] == "done"


# -- the time line, hands and the gallery --------------------------------------------------------------------


def test_a_page_looks_at_the_past_and_goes_on_from_it():
    made, page = make("newtons-cradle")
    watch(made, 1.5)
    told(page)
    send(made, page, "look", t=0.5)
    made.tick(0)
    numbers = frames(page)
    assert numbers[-1][2] == pytest.approx(0.5, abs=0.02)
    assert numbers[-1][23] == 1
    assert (made._status()["at"], made._status()["now"]) == (0.5, made.stage.world.t)
    send(made, page, "spawn", shape="box", x=0, y=1)
    assert "You look at" in of(told(page), "error")[-1]["message"]
    send(made, page, "go")
    made.stage.finish()
    made.tick(0)
    messages = told(page)
    assert of(messages, "events")[-1]["anew"]
    assert of(messages, "marks")[-1]["anew"]
    assert made.stage.world.t == pytest.approx(0.5, abs=0.02)
    send(made, page, "ghost", on=True)
    made.tick(1 / 60)
    data = list(iter(page.take, None))
    ghosts = [json.loads(one) for one in data if isinstance(one, str) and '"world":1' in one]
    shown = [np.frombuffer(one, "<f4") for one in data if isinstance(one, bytes)]
    assert [one[1] for one in shown if one[0] == 1 and one[21] == 1] == [ghosts[0]["version"]]


def test_plots_get_every_sample_however_few_frames_there_were():
    made, page = make("head-on")
    told(page)
    for _ in range(10):
        made.tick(0.1)
    rows = np.concatenate([one[3:].reshape(-1, int(one[2])) for one in frames(page) if one[0] == 2])
    assert np.diff(rows[:, 0]).max() == pytest.approx(1 / 120, rel=0.01)  # 240 in this scene's two seconds
    assert rows[-1, 0] == pytest.approx(made.stage.world.t, abs=1 / 120)
    assert len(rows) == pytest.approx(120 * made.stage.world.t, abs=2)
    receipt = made.stage.world.receipt
    np.testing.assert_allclose(rows[:, 1:7].sum(axis=1), receipt.start + receipt.given, rtol=1e-6)
    assert rows[-1, 3] == pytest.approx(receipt.contacts, rel=1e-3)


def test_start_and_given_are_in_every_frame_so_that_the_account_can_be_seen_to_close():
    made, page = make("restitution-row")
    watch(made, 1.0)
    send(made, page, "spawn", shape="circle", x=0, y=1)
    made.tick(1 / 60)
    last = [one for one in frames(page) if one[0] == 1][-1]
    assert last[22] == pytest.approx(last[11:17].sum(), rel=1e-5)


def test_the_gallery_shows_every_scene_with_a_loop_and_opens_any_in_place():
    opened = []
    made = Session(None, Desk(played={"incline"}, opened=opened.append), clock=Clock())
    page = made.join()
    assert told(page)[0]["gallery"]
    send(made, page, "scenes")
    for _ in range(20):
        made.tick(1 / 60)
    data = list(iter(page.take, None))
    listed = next(json.loads(one) for one in data if isinstance(one, str) and '"scenes"' in one)
    assert [one["id"] for one in listed["scenes"] if one["played"]] == ["incline"]
    cards = [json.loads(one)["id"] for one in data if isinstance(one, str) and '"card"' in one]
    loops = [one for one in data if isinstance(one, bytes) and np.frombuffer(one[:4], "<f4")[0] == 4]
    assert len(cards) == len(loops) == len(listed["scenes"]) == 13
    for name in ("dominoes", "head-on"):
        send(made, page, "open", id=name)
        scene = of(told(page), "scene")[-1]
        assert (scene["id"], scene["gallery"], scene["status"]["paused"]) == (name, False, False)
    assert opened == ["dominoes", "head-on"]
    send(made, page, "open", id="../secrets")
    assert "There is no scene" in of(told(page), "error")[-1]["message"]


def test_a_parameter_and_an_own_copy_are_requests(tmp_path):
    def save(name, data):
        (tmp_path / name).write_bytes(data)
        return str(tmp_path / name)

    made, page = make("newtons-cradle", desk=Desk(save=save))
    send(made, page, "parameter", key="angle", value=45)
    send(made, page, "parameter", key="colour", value=45)
    send(made, page, "parameter", key="angle", value=450)
    no_such, too_large = (one["message"] for one in of(told(page), "error"))
    assert no_such.startswith("This scene has no 'c")
    assert too_large.startswith("angle must be from 1")
    send(made, page, "set", key="restitution", value=0.7)
    send(made, page, "mine")
    messages = told(page)
    scene = of(messages, "scene")[-1]
    assert (scene["id"], scene["own"]) == ("my-newtons-cradle", True)
    assert of(messages, "error")[-1]["message"].endswith("but not what was set besides: restitution.")
    assert scene["status"]["parameters"]["angle"] == 45
    assert choose(str(tmp_path / "my-newtons-cradle.toml")).parameters["angle"] == 45


@pytest.mark.parametrize(("kind", "begins"), [("gif", b"GIF89a"), ("png", b"\x89PNG")])
def test_a_film_of_this_run_comes_as_a_file(kind, begins):
    made, page = make("head-on")
    watch(made, 1.0)
    told(page)
    send(made, page, "film", kind=kind, width=200)
    send(made, page, "open", id="incline")  # which is not what is filmed
    made._film[1].wait(60)
    made.tick(0)
    data = list(iter(page.take, None))
    files = [one[4:] for one in data if isinstance(one, bytes) and np.frombuffer(one[:4], "<f4")[0] == 6]
    assert [one[: len(begins)] for one in files] == [begins]
    assert any('"head-on.' in one for one in data if isinstance(one, str))


def test_undo_and_redo_are_offered_in_words():
    made, page = make("head-on")
    send(made, page, "pause", on=True)
    send(made, page, "place", name="left-puck", x=-1, y=0.5)
    send(made, page, "change", name="left-puck", key="mass", value=2)
    made.tick(0)
    assert of(told(page), "status")[-1]["undo"] == "changing left-puck"
    for _ in range(2):
        send(made, page, "undo")
        made.stage.finish()
    made.tick(0)
    status = of(told(page), "status")[-1]
    assert (status["undo"], status["redo"]) == ("", "placing left-puck")
    send(made, page, "undo")
    assert of(told(page), "error")[-1]["message"] == "There is nothing to undo."


def test_a_guess_given_on_the_command_line_is_not_asked_for_again():
    made, page = make("head-on", guess=1.0)
    assert told(page)[0]["status"]["stage"] == "run"
    assert not made.stage.world.paused


def test_a_probe_that_read_nothing_reaches_the_page_as_null():
    made, page = make("head-on", settings={"speed": 0.1})
    made.stage.world.throw(1, 0, 5, 0)
    watch(made, 4)
    texts = [message for message in told(page) if message["type"] == "status"]
    assert texts[-1]["comparison"]["simulation"] is None


# -- anything at all -------------------------------------------------------------------------------------

NUMBERS = st.one_of(
    st.floats(allow_nan=True, allow_infinity=True),
    st.integers(-(10**30), 10**30),
    st.sampled_from([0, 1, -1, 0.5, 1e-300, 1e300]),
)
VALUES = st.one_of(NUMBERS, st.text(max_size=20), st.booleans(), st.none(), st.lists(NUMBERS, max_size=3))
WORDS = st.sampled_from(["circle", "box", *SETTINGS, "ball-1", "floor", "left-puck", "picture", "solver"])
DOES = st.sampled_from(sorted(REQUESTS.keys() - {"film"}))  # which would be made beside the test
FIELDS = sorted({field for fields in REQUESTS.values() for field in fields})
SHAPED = st.fixed_dictionaries(
    {"do": st.one_of(DOES, st.text(max_size=8))},
    optional={name: st.one_of(VALUES, WORDS) for name in [*FIELDS, "extra"]},
)
FITTING = dict.fromkeys(("name", "shape", "key", "kind", "id"), WORDS)
FITTING |= {"on": st.booleans(), "way": st.integers(-1, 1)}
NEARLY = DOES.flatmap(
    lambda do: st.fixed_dictionaries(
        {"do": st.just(do)} | {name: FITTING.get(name, st.floats(-5.0, 120.0)) for name in REQUESTS[do]}
    )
)
REQUEST = st.one_of(SHAPED, NEARLY).map(json.dumps)
ANYTHING = st.one_of(REQUEST, st.text(max_size=60), st.binary(max_size=60), st.just("[" * 900))


@settings(max_examples=120)
@given(messages=st.lists(ANYTHING, max_size=12))
@example(messages=['{"do":"grab","x":0.0,"y":0.0,"reach":10}', '{"do": "redo"}'])
def test_whatever_arrives_the_world_lives_on(messages):
    made, page = make("head-on")

    def state():
        world = made.stage.world
        return world.ticks, dict(world.settings), world.state_hash(), world.held

    for message in messages:
        told(page)
        before = state()
        made.receive(page, message)
        errors = of(told(page), "error")
        if errors:
            assert state() == before, "what is answered with an error has changed nothing"
            assert len(errors[0]["message"]) < 400
        made.tick(1 / 60)
    assert not page.lost
    assert np.isfinite(made.stage.world.state()).all()
    made.stage.finish()
    send(made, page, "reset")
    send(made, page, "speed", value=1.0)
    send(made, page, "pause", on=False)
    made.tick(2 * SETTINGS["step"].high)  # whatever step it was told to take
    assert made.stage.world.ticks > 0


@settings(max_examples=60)
@given(data=st.one_of(st.binary(max_size=200), st.text(max_size=200)))
def test_what_is_no_request_is_answered_once_and_does_nothing(data):
    made, page = make("head-on")
    told(page)
    made.receive(page, data)
    assert [message["type"] for message in told(page)] == ["error"]


def test_requests_beyond_the_rate_are_dropped_with_one_answer_and_a_flood_ends_the_page():
    clock = Clock()
    made, page = make("head-on", clock=clock)
    told(page)
    for _ in range(400):
        send(made, page, "step", kind="solver")
    assert made.stage.world.ticks == 300
    assert [error["message"] for error in of(told(page), "error")] == [
        "Too many requests at once; some are dropped."
    ]
    clock.now += 1.0
    for _ in range(400):
        send(made, page, "step", kind="solver")
    assert made.stage.world.ticks == 500
    for _ in range(2000):
        send(made, page, "step")
    assert page.lost


def test_no_number_of_a_page_makes_a_request_too_large_to_be_refused():
    made, page = make("head-on")
    told(page)
    for text in (
        '{"do":"set","key":"gravity","value":1e999}',
        '{"do":"set","key":"gravity","value":NaN}',
        "1" * 1000,
    ):
        made.receive(page, text)
    errors = of(told(page), "error")
    assert len(errors) == 3
    assert math.isfinite(made.stage.world.settings["gravity"])
