"""The sandbox in a real browser: hands, sliders, keys, reload, and nothing that leaves this machine.

Needs Chromium, Debian's or one that CHROMIUM names, and the package playwright, which downloads none.
"""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import pytest

from course.sandbox.runs.tape import HEAD
from course.sandbox.scene.loading import scene_ids
from tests.browsers import CHROMIUM, FLAGS, axe_core, on_the_page

pytestmark = [
    pytest.mark.soak,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium on this machine"),
]
sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
pytest.importorskip("uvicorn", reason="the extra `web` is not installed")

ROOT = Path(__file__).parents[2]
_COLOURS = """() => {
  const canvas = document.querySelector('canvas.world');
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  return new Set(new Uint32Array(data.buffer)).size;
}"""


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with sync_api.sync_playwright() as play:
        context = play.chromium.launch_persistent_context(
            tmp_path_factory.mktemp("chromium"), executable_path=CHROMIUM, headless=True, args=FLAGS
        )
        yield context
        context.close()


def complains(message):
    """Whether the browser has something against the page, and not against how this test reads its pixels."""
    return message.type in {"error", "warning"} and "willReadFrequently" not in message.text


class Sandbox:
    """A scene that is served, a page that shows it, and what went over the wire."""

    def __init__(self, context, scene, size, folder):
        played = ["play", scene] if scene else []
        self.server = subprocess.Popen(
            [sys.executable, "-m", "course", "sandbox", *played, "--web", "--no-browser"],
            cwd=folder,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "COLUMNS": "200", "PYTHONUNBUFFERED": "1"},
        )
        said = ""
        while not (found := re.search(r"http://127\.0\.0\.1:\d+/[\w-]+/", said)):
            line = self.server.stdout.readline()
            assert line, f"the server ended: {said}"
            said += line
        self.address = found[0]
        self.complaints = []
        self.requests = []
        self.frame = None
        self.names = []
        self.status = {}
        self.page = context.new_page()
        self.page.set_viewport_size({"width": size[0], "height": size[1]})
        self.page.on(
            "console", lambda message: self.complaints.append(message.text) if complains(message) else None
        )
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("websocket", self._wire)
        self.page.goto(self.address)
        self.until(lambda: self.frame is not None and self.status)

    def _wire(self, wire):
        self.requests.append(wire.url)
        wire.on("framereceived", self._heard)

    def _heard(self, data):
        if isinstance(data, bytes):
            numbers = np.frombuffer(data[: len(data) // 4 * 4], "<f4")  # a film has any length
            if numbers[0] == 1 and numbers[21] == 0:
                self.frame = numbers
            return
        message = json.loads(data)
        if message["type"] == "scene":
            self.status, self.view = message["status"], message["view"]
        elif message["type"] == "status":
            self.status = message
        elif message["type"] == "bodies" and message["world"] == 0:
            self.bodies = message["bodies"]
            self.names = [body["name"] for body in self.bodies]

    def until(self, true, patience=30.0):
        end = time.monotonic() + patience
        while not true():
            assert time.monotonic() < end, "it did not happen"
            self.page.wait_for_timeout(20)

    def body(self, name):
        """x, y, angle, vx, vy."""
        at = HEAD + 5 * self.names.index(name)
        return tuple(self.frame[at : at + 5].tolist())

    def highest(self):
        """The movable body without wheels that is highest."""
        hands = [body["name"] for body in self.bodies if not body["fixed"] and not body.get("wheels")]
        return max(hands, key=lambda name: self.body(name)[1])

    def catch(self, name):
        """Take hold of a body that moves, as somebody would: try again where it is now."""
        for _ in range(10):
            self.page.mouse.move(*self.pixel(*self.body(name)[:2]))
            self.page.mouse.down()
            self.page.wait_for_timeout(300)
            if self.frame[6] == 1:
                return
            self.page.mouse.up()
        pytest.fail(f"{name} cannot be caught")

    def stand_at_the_start(self):
        """Pause, and take everything back to where it began."""
        self.page.keyboard.press("Space")
        self.page.keyboard.press("r")
        self.until(lambda: self.status["paused"] and self.frame[2] == 0)

    def drag(self, start, *way):
        """Draw the mouse through places of the world."""
        self.page.mouse.move(*self.pixel(*start))
        self.page.mouse.down()
        for place in way:
            self.page.mouse.move(*self.pixel(*place), steps=4)
        self.page.mouse.up()

    def guess(self, number):
        """Predict, and wait for the answers."""
        self.page.keyboard.press("p")
        self.page.get_by_label("Your guess").fill(number)
        self.page.keyboard.press("Enter")
        self.page.locator(".answers").wait_for(timeout=30_000)

    def colours(self):
        """How many different colours the picture of the world has."""
        return self.page.evaluate(_COLOURS)

    def pixel(self, x, y):
        """Where a place of the world is on the page."""
        return on_the_page(self.page.locator("canvas.world"), self.view, x, y)

    def close(self):
        self.page.close()
        self.server.send_signal(signal.SIGINT)
        try:
            return self.server.wait(20)
        finally:
            self.server.kill()
            self.server.stdout.close()


@pytest.fixture
def sandbox(browser, tmp_path):
    made = []

    def make(scene, size=(1280, 800)):
        made.append(Sandbox(browser, scene, size, tmp_path))
        return made[-1]

    yield make
    for one in made:
        assert one.complaints == []
        origin = urlsplit(one.address).netloc
        assert {urlsplit(url).netloc for url in one.requests} == {origin}
        assert one.close() == 0


def test_while_time_stands_a_drag_places_and_a_drag_of_the_arrows_tip_aims(sandbox):
    at = sandbox("restitution-row")
    at.stand_at_the_start()
    x, y, *_ = at.body("ball-3")
    box = at.page.locator("canvas.world").bounding_box()
    at.drag((x, y), (x + 0.2, y + 0.3))
    at.until(lambda: at.body("ball-3")[:2] == pytest.approx((x + 0.2, y + 0.3), abs=0.02))
    assert at.page.locator("canvas.world").bounding_box() == box, "no card ever resizes the stage"
    x, y, *_ = at.body("ball-3")
    scale = at.pixel(1, 0)[0] - at.pixel(0, 0)[0]
    radius = next(body["radius"] for body in at.bodies if body["name"] == "ball-3")
    at.drag((x + radius + 14 / scale, y), (x + 0.5, y + 0.25))
    at.until(lambda: at.body("ball-3")[3] != 0)
    assert at.body("ball-3")[3:] == pytest.approx((1.0, 0.5), abs=0.05)
    assert at.status["paused"]
    for _ in range(2):
        at.page.get_by_role("button", name="Undo").click()
        at.page.wait_for_timeout(200)
    at.until(lambda: at.status["undo"] in {"", "the reset"} and at.body("ball-3")[3] == 0)


def test_a_run_is_scrubbed_gone_on_from_the_middle_and_filmed(sandbox):
    at = sandbox("newtons-cradle")
    at.until(lambda: at.frame[2] > 1.2)
    at.page.locator("#line").focus()
    for _ in range(40):
        at.page.keyboard.press("ArrowLeft")
    at.until(lambda: at.status["at"] is not None and at.frame[2] < 0.9)
    at.page.get_by_role("button", name="Go on from here").click()
    at.until(lambda: at.status["at"] is None and at.status["working"] is None and at.frame[23] == 0)
    at.until(lambda: not at.status["paused"] and at.frame[2] > 1.0)
    at.page.keyboard.press("Shift+Z")
    at.until(lambda: at.status["ghost"] is True)
    with at.page.expect_download() as film:
        at.page.get_by_label("Save this run").select_option("gif 640")
    assert Path(film.value.path()).read_bytes()[:6] == b"GIF89a"


def test_a_drag_along_the_time_line_looks_where_the_pointer_is(sandbox):
    at = sandbox("newtons-cradle")
    at.until(lambda: at.frame[2] > 1.5)
    line = at.page.locator("#line")
    box = line.bounding_box()
    at.page.mouse.move(box["x"] + box["width"] - 8, box["y"] + box["height"] / 2)
    at.page.mouse.down()
    at.page.mouse.move(box["x"] + box["width"] * 0.7, box["y"] + box["height"] / 2, steps=12)
    at.until(lambda: at.status["at"] is not None)
    at.page.wait_for_timeout(300)
    assert line.bounding_box() == box, "what appears beside the line moved it under the pointer"
    assert at.status["at"] == pytest.approx(0.7 * at.status["now"], abs=0.1 * at.status["now"])
    at.page.mouse.up()


def test_what_undo_does_to_a_slider_its_thumb_follows(sandbox):
    at = sandbox("free-fall")
    slider = at.page.get_by_role("slider", name="gravity")
    before = slider.input_value()
    slider.press("Home")
    at.until(lambda: at.status["settings"]["gravity"] == 0)
    at.page.keyboard.press("Control+z")
    at.until(lambda: at.status["settings"]["gravity"] > 9)
    at.until(lambda: slider.input_value() == before, patience=3)


def test_when_everything_has_left_the_picture_the_page_says_how_to_see_it_again(sandbox):
    at = sandbox("free-fall")
    at.page.get_by_text("Everything has left the picture").wait_for()
    at.page.keyboard.press("r")
    at.page.get_by_text("Everything has left the picture").wait_for(state="detached")
    at.page.keyboard.press("Space")
    for _ in range(8):
        at.page.get_by_role("button", name="Closer").click()
    at.page.get_by_text("⤢ shows all of it").wait_for()


def test_every_scene_opens_from_the_gallery_without_a_command(sandbox):
    at = sandbox(None)
    gallery = at.page.locator(".gallery .scene")
    gallery.nth(12).wait_for()
    titles = [card.locator("strong").inner_text() for card in gallery.all()]
    assert len(titles) == len(scene_ids())
    for number, title in enumerate(titles):
        gallery.nth(number).click()
        at.page.locator("h1").filter(has_text=title).wait_for()
        at.until(lambda: at.frame is not None and at.frame[2] > 0)
        at.page.keyboard.press("o")
        gallery.nth(12).wait_for()
    assert at.page.locator(".played").count() == len(titles)
    at.page.keyboard.press("Escape")
    assert not at.page.locator(".gallery").is_visible()


def test_the_scenes_own_numbers_are_the_first_sliders_and_its_file_becomes_ones_own(sandbox, tmp_path):
    at = sandbox("newtons-cradle")
    assert at.page.locator(".knob label").first.inner_text().lower() == "gap"
    at.page.get_by_role("slider", name="angle").press("End")
    at.until(lambda: at.status["parameters"]["angle"] == 80)
    at.page.get_by_text("About this scene").click()
    at.page.get_by_role("button", name="Make it mine").click()
    at.until((tmp_path / "my-newtons-cradle.toml").exists)
    assert "default = 80" in (tmp_path / "my-newtons-cradle.toml").read_text()


def test_wheel_zooms_a_drag_on_nothing_pans_and_a_tap_opens_a_body(sandbox):
    at = sandbox("restitution-row")
    at.page.keyboard.press("Space")
    at.until(lambda: at.status["paused"])
    ruler = at.page.locator(".ruler span")
    before = ruler.inner_text()
    at.page.mouse.move(*at.pixel(0, 1.5))
    at.page.mouse.wheel(0, -1500)
    at.page.wait_for_timeout(200)
    assert ruler.inner_text() != before
    at.page.keyboard.press("0")
    at.page.wait_for_timeout(100)
    assert ruler.inner_text() == before
    at.page.mouse.click(*at.pixel(*at.body("ball-2")[:2]))
    at.page.get_by_label("mass").fill("3")
    at.page.keyboard.press("Tab")
    at.until(lambda: {body["name"]: body["mass"] for body in at.bodies}["ball-2"] == 3)
    at.page.get_by_role("button", name="Delete").click()
    at.until(lambda: "ball-2" not in at.names)


def test_a_finger_drags_on_a_phone(sandbox):
    at = sandbox("head-on", (390, 844))
    at.page.get_by_role("button", name="Reset").click()
    at.page.locator("label.speed input").focus()
    at.page.keyboard.press("Home")
    at.until(lambda: at.status["speed"] == 0.01 and not at.status["paused"])
    touch = at.page.context.new_cdp_session(at.page)

    def finger(kind, *places):
        points = [{"x": x, "y": y} for x, y in places]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    before = at.body("right-puck")
    finger("touchStart", at.pixel(*before[:2]))
    at.until(lambda: at.frame[6] == 1)
    finger("touchMove", at.pixel(before[0], before[1] + 0.8))
    at.until(lambda: at.body("right-puck")[4] > 0.2)
    finger("touchEnd")
    at.until(lambda: at.frame[6] == 0)
    assert at.page.evaluate("document.documentElement.scrollWidth") <= 390


def test_sliders_act_and_say_what_they_are_at(sandbox):
    at = sandbox("restitution-row")
    for name, key in (
        ("gravity", "Home"),
        ("restitution", "End"),
        ("step", "ArrowLeft"),
        ("iterations", "ArrowRight"),
    ):
        slider = at.page.get_by_role("slider", name=name)
        before = at.status["settings"].get(name)
        slider.press(key)
        at.until(lambda name=name, before=before: at.status["settings"].get(name) != before)
    now = at.status["settings"]
    assert (now["gravity"], now["restitution"], now["iterations"]) == (0, 1, 40)
    assert now["step"] == pytest.approx(1 / 480)
    assert at.page.get_by_role("slider", name="step").get_attribute("aria-valuetext") == "2.08 ms"


def test_the_question_follows_the_sliders_and_what_was_typed_stays(sandbox):
    at = sandbox("bullet-wall")
    at.page.get_by_role("button", name="Predict?").click()
    question = at.page.locator(".card .question")
    question.filter(has_text="one step of 0.004167 s").wait_for(timeout=10_000)
    at.page.get_by_label("Your guess").fill("0,2")
    at.page.get_by_role("slider", name="step").press("ArrowLeft")
    question.filter(has_text="one step of 0.002083 s").wait_for(timeout=10_000)
    assert at.page.get_by_label("Your guess").input_value() == "0,2"


def test_a_guess_is_set_beside_theory_and_simulation(sandbox):
    at = sandbox("head-on")
    at.page.get_by_role("button", name="Predict?").click()
    at.page.get_by_label("Your guess").fill("two")
    at.page.get_by_role("button", name="Run and compare").click()
    assert at.page.get_by_role("alert").filter(has_text="A number, please.").is_visible()
    at.page.get_by_label("Your guess").fill("1,5")
    at.page.keyboard.press("Enter")
    at.page.locator(".answers").wait_for(timeout=30_000)
    at.page.get_by_text("Why, and once more").click()
    answers = at.page.locator(".answers").inner_text().split()
    assert answers == ["Your", "guess", "1.5", "m/s", "Theory", "2", "m/s", "Simulation", "2", "m/s"]
    assert not at.status["paused"], "no run ends"
    at.page.get_by_role("button", name="Run again").click()
    at.until(lambda: at.status["stage"] == "run")


def test_the_answers_lie_on_no_ball(sandbox):
    at = sandbox("newtons-cradle")
    at.guess("1.6")
    card = at.page.get_by_label("Prediction", exact=True).bounding_box()
    for name in at.names:
        x, y = at.pixel(*at.body(name)[:2])
        across = card["x"] < x < card["x"] + card["width"]
        assert not (name.startswith("ball") and across and card["y"] < y < card["y"] + card["height"]), name


def test_a_reload_changes_nothing(sandbox):
    at = sandbox("head-on")
    at.guess("2")
    at.page.get_by_role("button", name="Pause").click()
    at.until(lambda: at.status["paused"])
    at.page.wait_for_timeout(100)
    told = at.page.locator(".events ol").inner_text()
    where, answers = at.body("right-puck"), at.page.locator(".answers").inner_text()
    at.frame = None
    at.page.reload()
    at.until(lambda: at.frame is not None)
    at.page.get_by_role("button", name="Your guess: 2").click()
    at.page.locator(".answers").wait_for()
    assert at.body("right-puck") == where
    assert at.page.locator(".events ol").inner_text() == told
    assert at.page.locator(".answers").inner_text() == answers


def test_everything_can_be_done_with_keys(sandbox):
    at = sandbox("head-on")
    reached = set()
    for _ in range(40):
        at.page.keyboard.press("Tab")
        reached.add(
            at.page.evaluate("(e => e.id || e.textContent.trim() || e.className)(document.activeElement)")
        )
    wanted = {"Pause", "Step", "Contact", "Reset", "+ Ball", "+ Box", "Stop all", "Scenes", "speed", "line"}
    wanted |= {"world", "knob-speed", "knob-gravity", "knob-step", "knob-walls", "Predict?"}
    assert wanted <= {item.removesuffix(" over") for item in reached}
    at.page.locator("canvas.world").focus()
    press, live = at.page.keyboard.press, at.page.get_by_role("status")
    press(" ")
    at.until(lambda: at.status["paused"] and "Paused at" in live.inner_text())
    press("r")
    at.until(lambda: at.frame[2] == 0)
    press("n")
    assert "left puck" in at.page.locator(".body summary").inner_text()
    assert "left puck" in live.inner_text()
    press("ArrowUp")
    at.until(lambda: at.body("left-puck")[1] > 0)
    assert "left puck to x" in live.inner_text()
    press("u")
    at.until(lambda: at.body("left-puck")[1] == 0)
    press("y")
    at.until(lambda: "new-1" in at.names)
    press("Delete")
    at.until(lambda: "left-puck" not in at.names)
    press("c")
    at.until(lambda: "new-2" in at.names)
    press(".")
    at.until(lambda: at.frame[2] > 0)
    press("<")
    at.until(lambda: at.status["at"] is not None)
    press("Enter")
    at.until(lambda: at.status["at"] is None and not at.status["paused"] and not at.status["working"])
    press(" ")
    at.until(lambda: at.status["paused"])
    press("s")
    at.until(lambda: at.body("right-puck")[3] == 0)
    press("w")
    at.until(lambda: at.status["settings"].get("walls") == 1)
    press("r")
    at.until(lambda: at.frame[2] == 0 and "new-1" not in at.names and "left-puck" in at.names)
    # Keys belong to the page, whatever was used last.
    at.page.get_by_role("slider", name="gravity").press("ArrowRight")
    press(" ")
    at.until(lambda: not at.status["paused"] and "Running" in live.inner_text())
    press("n")
    press("ArrowUp")
    at.until(lambda: any(at.body(name)[4] > 0 for name in ("left-puck", "right-puck")))


@pytest.mark.parametrize("scene", scene_ids())
def test_every_scene_is_drawn_dragged_set_and_reloaded(sandbox, scene, tmp_path):
    at = sandbox(scene)
    page, speed = at.page, at.page.locator("label.speed input")
    at.until(lambda: at.colours() >= 3 and at.frame[2] > 0)
    at.stand_at_the_start()
    assert at.status["stage"] == "ask"

    # Time stands still: a drag says where it shall be.
    name = at.highest()
    x, y = at.body(name)[:2]
    before = at.body(name)[:2]
    left, bottom, right, top = at.view
    up = min(y + 0.12 * (top - bottom), top)
    page.mouse.move(*at.pixel(x, y))
    page.mouse.down()
    page.mouse.move(*at.pixel(x + 0.1 * (right - left), up), steps=3)
    page.screenshot(path=tmp_path / f"{scene}-placed.png")
    page.mouse.up()
    at.until(lambda: at.body(name)[:2] != before)

    # Time runs, as slowly as it can until a hand has hold of the body: then the body follows it upwards.
    page.get_by_role("button", name="Reset").click()
    speed.focus()
    page.keyboard.press("Home")
    at.until(lambda: at.status["speed"] == 0.01)
    page.get_by_role("button", name="Run", exact=True).click()
    page.get_by_role("button", name="Pause").wait_for()
    at.catch(name)
    assert at.names[int(at.frame[20])] == name
    page.mouse.move(*at.pixel(x, up), steps=3)
    speed.focus()
    for _ in range(3):
        page.keyboard.press("ArrowRight")
    at.until(lambda: at.body(name)[1] > y + 0.3 * (up - y))
    page.screenshot(path=tmp_path / f"{scene}-dragged.png")
    page.mouse.up()
    at.until(lambda: at.frame[6] == 0)
    assert at.status["stage"] == "touched"
    told = page.locator(".events ol").inner_text()
    assert "a hand takes" in told
    # What was done to the run before the reset is no part of this one's story.
    assert "thrown" not in told

    page.get_by_role("slider", name="restitution").press("End")
    page.get_by_role("slider", name="gravity").press("Home")
    at.until(lambda: at.status["settings"].get("restitution") == 1 and at.status["settings"]["gravity"] == 0)

    page.get_by_role("button", name="Pause").click()
    at.until(lambda: at.status["paused"])
    page.wait_for_timeout(100)
    where, status = at.frame.tolist(), at.status
    at.frame = None
    page.reload()
    at.until(lambda: at.frame is not None)
    at.until(lambda: at.colours() >= 3)
    assert (at.frame[HEAD:].tolist(), at.status) == (where[HEAD:], status)
    page.screenshot(path=tmp_path / f"{scene}-reloaded.png")


#: What can be operated and is too small for a finger, about which axe has no rule that is always on.
_SMALL = """() => [...document.querySelectorAll('button, input, summary')].filter((e) => {
  const box = e.getBoundingClientRect();
  return box.width && Math.min(box.width, box.height) < 16;
}).map((e) => e.outerHTML.slice(0, 80))"""


@pytest.fixture(scope="module")
def axe(tmp_path_factory):
    return axe_core(tmp_path_factory.mktemp("axe"))


@pytest.mark.parametrize(
    ("width", "scheme"), [(1280, "light"), (1280, "dark"), (390, "light"), (390, "dark")]
)
def test_axe_finds_nothing_on_any_screen(sandbox, axe, width, scheme):
    at = sandbox(None, (width, 844))
    at.page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
    console = at.page.context.new_cdp_session(at.page)

    def look(screen):
        at.page.wait_for_timeout(400)
        console.send("Runtime.evaluate", {"expression": axe})  # as the page's policy lets no script do
        found = at.page.evaluate("() => axe.run()")
        wrong = [
            (one["id"], [node["html"][:120] for node in one["nodes"][:3]]) for one in found["violations"]
        ]
        assert wrong == [], screen
        assert len(found["passes"]) > 10, "axe looked at something"
        assert at.page.evaluate(_SMALL) == [], screen
        paper = at.page.evaluate("getComputedStyle(document.querySelector('.sandbox')).backgroundColor")
        assert paper == {"light": "rgb(255, 255, 255)", "dark": "rgb(20, 23, 27)"}[scheme]

    at.page.locator(".gallery .scene").nth(12).wait_for()
    look("gallery")
    at.page.get_by_role("button", name="A row of restitutions").click()
    at.page.locator("h1").filter(has_text="A row").wait_for()
    look("running")
    # Where looking took long, the run was compared, and p would close what is shown.
    at.page.keyboard.press("r")
    at.until(lambda: at.status["stage"] == "ask")
    at.page.wait_for_timeout(200)
    at.page.keyboard.press("p")
    look("question")
    at.page.get_by_label("Your guess").fill("2")
    at.page.keyboard.press("Enter")
    at.page.locator(".answers").wait_for(timeout=30_000)
    look("comparison")
    at.page.get_by_role("button", name="Close the prediction").click()
    at.page.keyboard.press("n")
    at.page.keyboard.press("Enter")
    look("a body's numbers")
    at.page.keyboard.press("Escape")
    at.page.keyboard.press("j")
    at.until(lambda: at.status["at"] is not None)
    look("the past")


def test_another_page_reaches_nothing_even_with_the_address(browser, sandbox):
    at = sandbox("head-on")
    elsewhere = browser.new_page()
    try:
        elsewhere.goto("about:blank")
        address = at.address.replace("http:", "ws:") + "socket"
        opened = """(address) => new Promise((done) => {
          const socket = new WebSocket(address);
          socket.onopen = () => done('open');
          socket.onerror = () => done('refused');
        })"""
        assert elsewhere.evaluate(opened, address) == "refused"
        fetched = "(address) => fetch(address).then(() => 'read', () => 'refused')"
        assert elsewhere.evaluate(fetched, at.address + "world.js") == "refused"
    finally:
        elsewhere.close()
