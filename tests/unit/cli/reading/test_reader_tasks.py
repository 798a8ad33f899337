"""Warm-ups and exercises in the reader: in their place, started, checked, mended, done without leaving it."""

import contextlib
from dataclasses import replace

import pytest
from textual.widgets import TextArea

from course.authoring.exercises.grading import solution_path
from course.catalog import blocks as b
from course.cli.reading.screen.app import ReaderApp
from course.cli.reading.screen.printing import _said
from course.cli.reading.screen.running import Drawer
from course.errors import MissingCapabilityError
from course.reading.parts import read_script, words_of
from tests.unit.cli.conftest import Said
from tests.unit.cli.reading.conftest import CATALOG, at_block, leave, opened, press, screen, until

LESSON, TASK = "numerical-integration", "which-line-first"
CHECK = {
    "id": "euler", "title": "It grows", "task": TASK, "status": "fail", "visibility": "public",
    "points": 0.0, "max_points": 1.0, "message": "Not as it should be.",
}  # fmt: skip


@contextlib.asynccontextmanager
async def doing(workspace, pictures=None):
    """The lesson open at its warm-up, and who presses keys."""
    app = ReaderApp(CATALOG, LESSON, workspace=workspace, pictures=pictures)
    async with opened(app) as pilot:
        blocks = app.page.progress.script.blocks
        index = next(i for i, one in enumerate(blocks) if isinstance(one, b.Task) and one.id == TASK)
        await at_block(app, pilot, index)
        yield app, pilot


def file_of(workspace):
    return workspace.root / "warm-ups" / TASK / "which_line_first.py"


async def answered(app, pilot, wait=0.0):
    """Until nothing is being checked; a file is looked at twice a second."""
    await pilot.pause(wait)
    await until(pilot, lambda: not app.page.practice.of(TASK).busy)
    await pilot.pause(0.1)


def test_a_warm_up_stands_at_the_end_of_its_section():
    script = read_script(CATALOG.lesson(LESSON), CATALOG.warm_ups(LESSON))
    bare = read_script(CATALOG.lesson(LESSON))
    tasks = [(i, one) for i, one in enumerate(script.blocks) if isinstance(one, b.Task)]
    assert [one.id for _, one in tasks] == [one.id for one in CATALOG.warm_ups(LESSON)]
    for index, task in tasks:
        section = script.section_at(index)
        assert CATALOG.exercise(task.id).after in (section.slug, "")
        assert index + 1 == section.end
    assert [cell.key for cell in script.cells] == [cell.key for cell in bare.cells]
    assert [one.key for one in script.questions] == [one.key for one in bare.questions]
    assert [one for one in script.blocks if not isinstance(one, b.Task)] == list(bare.blocks)
    assert "mass on a spring" in words_of(tasks[1][1]), "search finds it"


def test_no_prediction_keeps_a_task_closed():
    for lesson in CATALOG.lesson_ids():
        script = read_script(CATALOG.lesson(lesson), CATALOG.tasks(lesson))
        closed = [
            one.id
            for index, one in enumerate(script.blocks)
            if isinstance(one, b.Task) and script.question_over(index) is not None
        ]
        assert closed == [], lesson


@pytest.mark.parametrize("how", ["escape", "ctrl+q", "SIGTERM", "SIGHUP"])
async def test_what_is_typed_into_its_file_is_kept_however_the_editor_or_the_reader_is_left(mine, how):
    async with doing(mine) as (app, pilot):
        await press(pilot, "e", wait=0.2)
        assert "Ctrl-R: keep, check" in app.screen.query_one(".box").border_subtitle
        await pilot.press("#")
        await leave(pilot, how)
    assert file_of(mine).read_text().startswith("#")


async def test_a_file_that_was_not_changed_is_left_alone_when_the_reader_is_left(mine):
    path = file_of(mine)
    async with doing(mine) as (_, pilot):
        await press(pilot, "e", wait=0.2)
        path.write_text("# from another editor\n")
        await pilot.press("ctrl+q")
    assert path.read_text() == "# from another editor\n"


@pytest.mark.parametrize("typed", ["", "#"])
async def test_what_another_editor_saved_meanwhile_is_not_lost(mine, typed):
    path = file_of(mine)
    async with doing(mine) as (app, pilot):
        await press(pilot, "e", wait=0.2)
        path.write_text("# from another editor\n")
        await press(pilot, *typed, "escape", wait=0.2)
        told = "saved there meanwhile is in .course" if typed else "stays as it is there"
        assert told in app.message
    copies = [one.read_text() for one in (mine.root / ".course" / "backups").rglob("*.py")]
    assert (copies == ["# from another editor\n"]) == bool(typed)
    assert ("from another editor" in path.read_text()) == (not typed)


async def test_what_cannot_be_written_stays_in_the_editor(mine, monkeypatch):
    def refuse(*_):
        raise MissingCapabilityError(
            "The workspace cannot be written.", help="Make room.", code="not_writable"
        )

    async with doing(mine) as (app, pilot):
        await press(pilot, "e", wait=0.2)
        await pilot.press("#")
        monkeypatch.setattr(app.page.practice, "write", refuse)
        for key in ("escape", "ctrl+r", "ctrl+q"):
            await press(pilot, key, wait=0.2)
            box = app.screen.query_one(".box")
            assert box.border_subtitle == "The workspace cannot be written."
        monkeypatch.undo()
        await press(pilot, "escape", wait=0.2)
    assert file_of(mine).read_text().startswith("#")


async def test_what_is_done_is_remembered(mine):
    mine.store.append("check", TASK, {"all_pass": True})
    async with doing(mine) as (app, pilot):
        assert "5 minutes, done" in screen(app)
        await press(pilot, "t", wait=0.2)
        await press(pilot, "escape", "G", wait=0.2)
        assert f"{len(CATALOG.warm_ups(LESSON)) - 1} warm-ups are left" in screen(app)


async def test_outside_of_a_workspace_it_says_what_is_needed():
    async with doing(None) as (app, pilot):
        assert "course init my-course" in screen(app)
        await press(pilot, "r", "e", "enter")
        assert "Make a workspace first" in screen(app)


async def test_its_editor_opens_at_the_function_that_the_finding_is_about(mine):
    async with doing(mine) as (app, pilot):
        await press(pilot, "enter")
        path = file_of(mine)
        path.write_text("# a note\n" * 30 + path.read_text())
        await answered(app, pilot, wait=0.6)
        await press(pilot, "e", wait=0.2)
        area = app.screen.query_one(TextArea)
        (task,) = CATALOG.exercise(TASK).task
        assert area.text.splitlines()[area.cursor_location[0]].startswith(f"def {task.id}(")


async def test_one_is_started_checked_hinted_at_mended_and_done_in_its_place_and_is_so_when_opened_again(
    mine,
):
    async with doing(mine) as (app, pilot):
        assert "Which line comes first?" in screen(app)
        await pilot.pause(0.6)  # longer than between two looks at a file, which is not there yet
        assert "Enter puts its file into your workspace" in screen(app)
        await press(pilot, "enter")
        assert "h hint" not in screen(app)
        await pilot.press("r")
        await answered(app, pilot)
        assert "every step adds energy" in screen(app)
        assert "hint" not in screen(app), "nothing was tried yet"
        # Saved by an editor of the student's: checked without a key.
        path = file_of(mine)
        path.write_text(path.read_text().replace("return", "return -1.0 *", 1))
        await answered(app, pilot, wait=0.6)
        assert "h hint" in screen(app)
        path.write_bytes(solution_path(CATALOG, CATALOG.exercise(TASK)).read_bytes())
        await answered(app, pilot, wait=0.6)
        assert f"Fixed: {CATALOG.exercise(TASK).task[0].id}" in screen(app)
        assert "Done: every check passes." in screen(app)
    async with doing(mine) as (app, pilot):
        await press(pilot, *["down"] * 12)
        assert "Done: every check passed." in screen(app)
    passed = [event.data["all_pass"] for event in mine.store.events("check", TASK)]
    assert passed == [False, False, True]
    assert [event.subject for event in mine.store.events("start")] == [TASK]


def test_what_is_not_written_yet_is_no_error_and_stands_behind_what_fails():
    stub = {**CHECK, "status": "error", "diagnosis": "NOT_IMPLEMENTED", "help": "Replace it."}
    assert [str(line) for line in _said({"checks": [stub]}, "")] == ["to do: It grows", "Replace it."]
    assert str(next(_said({"checks": [stub, CHECK]}, ""))) == "FAIL: It grows"


async def test_the_curve_of_a_failed_check_stands_above_its_finding(mine):
    """An exercise's, put where a warm-up is: a reply is a reply."""
    words = {"quantity": "q", "units": "m", "right_is": "RK4", "description": "Your curve leaves it."}
    numbers = {"t": list(range(40)), "yours": [2 * i for i in range(40)], "right": list(range(40))}
    reply = {"ok": False, "checks": [CHECK], "curves": [words | numbers]}
    async with doing(mine, pictures=Drawer()) as (app, pilot):
        practice = app.page.practice
        practice.start(TASK)
        practice._standings[TASK] = replace(practice.of(TASK), reply=reply)
        app.page.show_answer(TASK)
        await until(pilot, lambda: "q over time" in screen(app))
        shown = Said(screen(app)).says_in_order(
            "q over time", "Your curve leaves it.", "Not as it should be."
        )
        assert sum("▀" in line for line in shown.rows) >= 8
