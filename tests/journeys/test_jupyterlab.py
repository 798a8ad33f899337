"""The notebooks in JupyterLab as the extra installs it, in a real browser without a network.

What a student takes hold of runs with every test; the rest is for soak.
"""

import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from course.notebooks.server import started
from course.sandbox.scene.loading import choose
from course.sandbox.world.world import World
from tests import browsers

ROOT = Path(__file__).resolve().parents[2]
MISSING = [name for name in ("jupyterlab", "nbclient", "ipykernel", "playwright") if find_spec(name) is None]
# Names that are not this machine's lead nowhere, so that whatever asks for the network fails here.
FLAGS = [*browsers.FLAGS, "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1"]
#: In ms; a machine that runs other tests beside this one is slow to start a kernel.
PATIENCE = 180_000
#: What stands beside a cell that has run.
_RUN = re.compile(r"\[[0-9]+\]")

pytestmark = [
    pytest.mark.skipif(bool(MISSING), reason=f"the extra notebook is not installed: {', '.join(MISSING)}"),
    pytest.mark.skipif(browsers.CHROMIUM is None, reason="there is no Chromium"),
]

WRONG = """def explicit_euler_step(accel, t, q, v, h):
    v_next = v + h * accel(t, q, v)
    return q + h * v_next, v_next
"""
RIGHT = """def explicit_euler_step(accel, t, q, v, h):
    return q + h * v, v + h * accel(t, q, v)
"""


@pytest.fixture(scope="module")
def notebooks(tmp_path_factory):
    """A folder with notebooks as a student gets them."""
    folder = tmp_path_factory.mktemp("jupyter") / "notebooks"
    _build(folder, "sandbox")
    return folder


def _build(folder, *words):
    command = [sys.executable, "-m", "course", "notebook", "build", "--out", str(folder), *words]
    subprocess.run(command, check=True, env=os.environ | {"PYTHONPATH": str(ROOT)}, cwd=folder.parent)


@pytest.fixture(scope="module")
def lab(notebooks):
    """The address and the token of JupyterLab on these notebooks, with settings and state of its own."""
    home = notebooks.parent
    settings = home / "settings" / "@jupyterlab"
    for path, text in (
        # Cells out of sight are in the page too, where the test can look at them.
        (settings / "notebook-extension" / "tracker.jupyterlab-settings", '{"windowingMode": "none"}'),
        (
            settings / "apputils-extension" / "notification.jupyterlab-settings",
            '{"checkForUpdates": false, "fetchNews": "false"}',
        ),
        # Node and the network are asked whether it could be built anew, or have other extensions.
        (
            home / ".jupyter" / "labconfig" / "page_config.json",
            '{"buildCheck": false, "disabledExtensions": {"@jupyterlab/extensionmanager-extension": true}}',
        ),
    ):
        path.parent.mkdir(parents=True)
        path.write_text(text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HOME", str(home))
        patch.setenv("JUPYTER_RUNTIME_DIR", str(home / "runtime"))
        patch.setenv("JUPYTERLAB_SETTINGS_DIR", str(home / "settings"))
        patch.setenv("JUPYTERLAB_WORKSPACES_DIR", str(home / "workspaces"))
        with started(notebooks) as running:
            address, _, token = running.address.partition("/lab?token=")
            yield address.replace("localhost", "127.0.0.1"), token


@pytest.fixture(scope="module")
def browser():
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=browsers.CHROMIUM, args=FLAGS)
        yield opened
        opened.close()


@pytest.fixture
def open_notebook(browser, lab, tmp_path):
    """Opens a notebook in a page of its own; pictures of the pages go to COURSE_SCREENSHOTS if it is set."""
    pages = []
    address, token = lab

    def open_(path):
        page = browser.new_page(viewport={"width": 1300, "height": 1000})
        page.set_default_timeout(PATIENCE)
        pages.append(page)
        page.goto(f"{address}/lab/workspaces/w{len(pages)}-{tmp_path.name}/tree/{path}?token={token}")
        page.wait_for_selector(".jp-Notebook .jp-Cell")
        _wait_for_kernel(page, address, path)
        return page

    yield open_
    shots = os.environ.get("COURSE_SCREENSHOTS")
    for number, page in enumerate(pages):
        if shots:
            page.screenshot(path=Path(shots) / f"{tmp_path.name}-{number}.png")
        page.close()


def _wait_for_kernel(page, address, path):
    """Until the page has an idle kernel, by the word of the server: the page calls it idle too early."""
    # Where kernels are slow to be listed, JupyterLab asks which one is wanted.
    asked = page.locator(".jp-Dialog", has_text="Select Kernel")
    for _ in range(PATIENCE // 500):
        if asked.count():
            asked.first.locator(".jp-mod-accept").click()
        elif any(
            session["path"] == path
            and session["kernel"]["connections"] > 0
            and session["kernel"]["execution_state"] == "idle"
            for session in page.request.get(f"{address}/api/sessions").json()
        ):
            return
        page.wait_for_timeout(500)
    pytest.fail(f"{path} has no kernel")


def shot(page, name, selector):
    """Keep a picture of a part of the page for whoever wants to look."""
    folder = os.environ.get("COURSE_SCREENSHOTS")
    if folder:
        page.locator(selector).first.scroll_into_view_if_needed()
        page.screenshot(path=Path(folder) / f"{name}.png")


@pytest.mark.soak
def test_a_lesson_opens_with_figures_diagrams_and_mathematics(open_notebook, notebooks):
    _build(notebooks, "numerical-integration", "--executed")
    page = open_notebook("lessons/numerical-integration.ipynb")
    page.wait_for_selector(".jp-MarkdownOutput mjx-container", state="attached")
    page.wait_for_selector(".jp-RenderedMermaid img, .jp-RenderedMermaid svg", state="attached")
    shown = page.evaluate(
        """() => ({
            figures: [...document.querySelectorAll('.jp-OutputArea-output img')].map(i => i.naturalWidth),
            diagrams: document.querySelectorAll('.jp-RenderedMermaid img, .jp-RenderedMermaid svg').length,
            formulas: document.querySelectorAll('mjx-container').length,
            wrong: document.querySelectorAll('mjx-merror, .jp-RenderedMermaid.jp-mod-warning').length,
            boxes: document.querySelectorAll('blockquote').length,
            text: document.querySelector('.jp-Notebook').innerText,
        })"""
    )
    for name, selector in (("figure", ".jp-OutputArea-output img"), ("diagram", ".jp-RenderedMermaid")):
        shot(page, f"lesson-{name}", selector)
    assert shown["figures"]
    assert all(width > 500 for width in shown["figures"])
    assert shown["diagrams"] >= 1
    assert shown["formulas"] >= 5
    assert shown["wrong"] == 0
    assert shown["boxes"] >= 3
    for stray in (":::", "{mermaid}", "$$", "```", "<div", "\\frac"):
        assert stray not in shown["text"], stray


@pytest.mark.soak
def test_a_prediction_opens_its_answer(open_notebook, notebooks):
    _build(notebooks, "accuracy")
    page = open_notebook("lessons/accuracy.ipynb")
    _run_all(page)
    cell = page.locator(".jp-CodeCell", has_text="my_prediction_1").first
    field = cell.locator("textarea[aria-label='Your prediction']")
    field.wait_for()
    assert cell.locator(".jp-OutputArea blockquote").count() == 0
    field.fill("It grows without end")
    cell.get_by_role("button", name="Keep it and open the answer").click()
    cell.locator(".jp-OutputArea blockquote").wait_for()
    assert "It grows without end" in cell.locator(".jp-OutputArea").first.inner_text()
    cell.locator("textarea:disabled").wait_for()
    shot(page, "prediction", ".jp-OutputArea blockquote")


@pytest.mark.soak
def test_the_quiz_is_handed_in_and_marked(open_notebook, notebooks):
    _build(notebooks, "quiz")
    page = open_notebook("quiz.ipynb")
    _run(page, "take()")
    cell = page.locator(".jp-CodeCell", has_text="take()").first
    groups = cell.locator("fieldset")
    groups.first.wait_for()
    for number in range(groups.count()):
        groups.nth(number).locator("input").first.check()
    cell.get_by_role("button", name="Hand in and see the marks").click()
    cell.locator(".jp-OutputArea", has_text=re.compile(r"\d of \d right, \d needed")).wait_for()
    cell.locator("fieldset input:disabled").first.wait_for()
    shot(page, "quiz-marks", ".jp-OutputArea fieldset")


@pytest.mark.soak
def test_an_exercise_is_edited_until_its_check_passes(open_notebook, notebooks):
    _build(notebooks, "integrators")
    page = open_notebook("exercises/integrators.ipynb")
    _run_all(page)
    _wait_for_check(page, "to do")
    shot(page, "exercise-unwritten", ".course-checks")
    _write(page, WRONG)
    _wait_for_check(page, "EULER")
    shot(page, "exercise-finding", ".course-checks")
    assert "semi-implicit" in _check(page).inner_text()
    _write(page, RIGHT)
    _wait_for_check(page, "All 2 public checks of explicit_euler_step pass")
    shot(page, "exercise-pass", ".course-checks")


def _run_all(page):
    page.keyboard.press("Escape")
    page.click("text=Run >> visible=true")
    page.click("text=Run All Cells >> visible=true")
    page.locator(".jp-CodeCell .jp-InputPrompt", has_text=_RUN).first.wait_for()


def _check(page):
    """What the check below the function shows."""
    cell = page.locator(".jp-CodeCell", has_text="%course_check integrators explicit_euler_step")
    return cell.locator(".jp-OutputArea")


def _write(page, text):
    """Replace the function and run its cell and the check below it."""
    cell = page.locator(".jp-CodeCell", has_text="def explicit_euler_step").first
    cell.locator(".cm-content").click()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text(text)
    page.keyboard.press("Shift+Enter")
    page.keyboard.press("Shift+Enter")


def _wait_for_check(page, text):
    """Until the check's output shows a text."""
    _check(page).filter(has_text=text).first.wait_for()


def test_the_sandbox_moves_and_a_throw_changes_a_path(open_notebook):
    page = _play(open_notebook, "head-on")
    widget = page.locator(".sandbox")
    canvas = widget.locator("canvas.world")
    canvas.wait_for()
    canvas.scroll_into_view_if_needed()
    widget.get_by_role("button", name="Pause", exact=True).click()
    widget.get_by_role("button", name="Reset", exact=True).click()
    page.wait_for_function("() => document.querySelector('.sandbox .clock').innerText === '0.00 s'")
    page.wait_for_timeout(500)  # the bodies are drawn in the frame after
    view = choose("head-on").scene.view
    # Time stands: the tip of an arrow sets a velocity of 2 m/s for each metre.
    row, x, y = _start("head-on", "left-puck")
    page.mouse.click(*browsers.on_the_page(canvas, view, x, y))
    page.mouse.move(*browsers.on_the_page(canvas, view, x + 1.0, y))
    page.mouse.down()
    page.mouse.move(*browsers.on_the_page(canvas, view, x, y + 0.5), steps=8)
    shot(page, "sandbox-dragging", "canvas.world")
    page.mouse.up()
    widget.locator(".body summary", has_text=re.compile(r"left puck, 1 kg: (0\.9|1\.0)")).wait_for()
    assert widget.locator(".clock").inner_text() == "0.00 s"
    widget.locator(".chip", has_text="You changed this run").wait_for()
    widget.get_by_role("button", name="Run", exact=True).click()
    page.wait_for_function("() => document.querySelector('.sandbox .clock').innerText !== '0.00 s'")
    page.wait_for_function("() => !document.querySelector('.sandbox .clock').innerText.startsWith('0')")
    shot(page, "sandbox-after", "canvas.world")
    # Left alone, the puck stays on its line; thrown, it is above it, by about 1 m for each s.
    page.locator(".jp-CodeCell").first.locator(".cm-content").click()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text(f"print('height', _.world.snapshot().y[{row}])")
    page.keyboard.press("Shift+Enter")
    said = page.locator(".jp-OutputArea-output", has_text=re.compile(r"height [-0-9.]+")).first.inner_text()
    assert float(said.split()[-1]) > y + 0.5


@pytest.mark.soak
def test_a_narrow_cell_puts_the_panel_below_the_world(open_notebook):
    page = _play(open_notebook, "newtons-cradle")
    panel, stage = page.locator(".sandbox .panel"), page.locator(".sandbox .stage")
    page.wait_for_function("() => document.querySelector('.sandbox .clock').innerText !== ''")
    wide = stage.bounding_box(), panel.bounding_box()
    assert wide[1]["x"] >= wide[0]["x"] + wide[0]["width"] - 1
    page.set_viewport_size({"width": 900, "height": 1000})  # the file browser takes its share of it
    page.wait_for_function(
        """() => document.querySelector('.sandbox .panel').getBoundingClientRect().top
            >= document.querySelector('.sandbox .stage').getBoundingClientRect().bottom"""
    )
    shot(page, "sandbox-narrow", ".sandbox .top")
    narrow = stage.bounding_box(), panel.bounding_box()
    assert narrow[1]["y"] >= narrow[0]["y"] + narrow[0]["height"]
    assert narrow[0]["width"] == pytest.approx(narrow[1]["width"], abs=2)
    assert narrow[0]["height"] > 150
    overflow = "() => { const s = document.querySelector('.sandbox'); return s.scrollWidth - s.clientWidth; }"
    assert page.evaluate(overflow) <= 1
    shot(page, "sandbox-narrow-panel", ".sandbox .panel")


@pytest.mark.soak
def test_keys_for_the_world_are_not_shortcuts_of_jupyter(open_notebook):
    page = _play(open_notebook, "newtons-cradle")
    canvas = page.locator(".sandbox canvas.world")
    canvas.wait_for()
    page.wait_for_function("() => document.querySelector('.sandbox .clock').innerText !== ''")
    cells = page.locator(".jp-Cell").count()
    canvas.focus()
    for key in ("n", "b", "x"):  # B and X would insert and cut cells
        page.keyboard.press(key)
    page.locator(".sandbox .events li").first.wait_for()
    assert page.locator(".jp-Cell").count() == cells


def _play(open_notebook, scene):
    """A page with the sandbox's notebook, in which a scene waits in a cell."""
    pytest.importorskip("anywidget")
    page = open_notebook("sandbox.ipynb")
    _run(page, "from course.notebooks.sandbox import play")
    _run(page, f'play("{scene}")')
    return page


def _run(page, text):
    """Run the cell with this text."""
    cell = page.locator(".jp-CodeCell", has_text=text).first
    cell.locator(".cm-content").click()
    page.keyboard.press("Shift+Enter")
    cell.locator(".jp-InputPrompt", has_text=_RUN).wait_for()


def _start(scene_id, name):
    """The row of a body among those of its world, and where it is at the start."""
    world = World(choose(scene_id).scene)
    index = [part.name for part in world.parts].index(name)
    shown = world.snapshot()
    return index, float(shown.x[index]), float(shown.y[index])
