"""The reader on the whole screen, driven by keys as a student presses them."""

import contextlib
import re
import time

import pytest
from textual.events import Key

from course.catalog import blocks as b
from course.cli.frame.app import run
from course.cli.frame.pictures import half_blocks
from course.cli.reading.screen import page as paging
from course.cli.reading.screen.app import ReaderApp
from course.cli.reading.screen.asking import Edit
from course.cli.reading.screen.items import CellItem, FigureItem, keys_of
from course.full_screen import fitting
from course.reading.record import Place
from tests.unit.cli.reading.conftest import CATALOG, at_block, leave, opened, press, screen, settled, until

LESSON, LESSONS = "numerical-integration", CATALOG.lesson_ids()
#: What the issue of this reader asks for: a key's screen at 200 columns, in s of this process's own time.
KEY_S = 0.05


@contextlib.asynccontextmanager
async def reading(*, size=(80, 24), lesson=LESSON, workspace=None, section=""):
    """A lesson in the reader, and who presses keys."""
    app = ReaderApp(CATALOG, lesson, section, workspace)
    async with opened(app, size) as pilot:
        yield app, pilot


async def ran(app, pilot):
    """Until the cell has ended."""
    await until(pilot, lambda: app.page.bench is None or app.page.bench.cell is None)
    await pilot.pause(0.05)


def everything(app):
    """The whole page, also above and below the screen."""
    return "\n".join("".join(s.text for s in line) for line in app.page.book.lines)


def figures_of(app):
    return [i for i, one in enumerate(app.page.progress.script.blocks) if isinstance(one, b.Figure)]


async def to_cell(app, pilot):
    """The first cell of the lesson, at hand: its prediction is skipped."""
    cell = app.page.progress.script.shown_cells[0]
    await to_question(app, pilot)
    await pilot.press("s")
    await at_block(app, pilot, cell.index)
    return cell


async def editing(app, pilot):
    """The first cell of the lesson, in the editor."""
    cell = await to_cell(app, pilot)
    await press(pilot, "e")
    return cell


def below(app):
    """What a box says at its lower edge."""
    return app.screen.query_one(".box").border_subtitle


async def to_question(app, pilot, number=1):
    await at_block(app, pilot, app.page.progress.script.questions[number - 1].index)


@pytest.mark.parametrize("lesson", LESSONS)
async def test_every_lesson_is_read_by_space_alone_to_its_end_and_each_figure_is_an_item(lesson):
    async with reading(lesson=lesson) as (app, pilot):
        title = CATALOG.lesson(lesson).title.split(":")[0][:20]
        assert not app.page.progress.read
        for _ in range(200):
            if app.page.progress.read:
                break
            shown = screen(app)
            assert title in shown or f"Lesson {LESSONS.index(lesson) + 1} of" in shown  # if it is too long
            await pilot.press("space")
        assert app.page.progress.read
        assert "You have read this lesson." in screen(app)
        for question in app.page.progress.script.questions:
            app.page.progress.predict(question, "")
        app.page.rebuild()
        assert [item.block for item in app.page.book.items if isinstance(item, FigureItem)] == figures_of(app)


async def test_a_prediction_is_typed_kept_and_compared_and_a_skip_is_kept_too(mine):
    async with reading(workspace=mine) as (app, pilot):
        await to_question(app, pilot)
        question, second = app.page.progress.script.questions[:2]
        assert "Enter predict" in screen(app)
        cell = app.page.progress.script.shown_cells[0]
        recorded = cell.output.splitlines()[0]
        assert recorded not in everything(app)
        assert "the answer is shown here" in everything(app)
        assert screen(app).count("skip") == 2, "once under the question, once among the keys"
        await pilot.press("r")  # not yet
        assert app.page.bench is None or app.page.bench.cell is None
        await pilot.press("enter")
        await press(pilot, *"half a metre", "enter")
        assert app.page.progress.prediction(question).text == "half a metre"
        for part in (recorded, "You said", "You will see below whether you were right."):
            assert part in everything(app)
        await at_block(app, pilot, question.answer)
        await pilot.press("3")
        assert "wrong" in screen(app)
        assert "You were wrong." in everything(app), "below the question, too"
        assert "You will see below" not in everything(app)
        await to_question(app, pilot, 2)
        await pilot.press("s")
        assert app.page.progress.prediction(second).skipped
    said, judged, skipped = [event.data for event in mine.store.events("prediction")]
    assert (said["text"], judged["judged"], skipped["text"]) == ("half a metre", "wrong", "")


async def test_a_second_key_that_closes_a_box_closes_nothing_else():
    async with reading() as (app, pilot):
        await press(pilot, "question_mark", wait=0.2)
        await press(pilot, "escape", wait=0.2)
        assert len(app.screen_stack) == 1
        await press(pilot, "t", wait=0.2)
        box = app.screen
        box.close(None)
        box.close(None)  # was on its way
        await pilot.pause(0.2)
        assert len(app.screen_stack) == 1


async def test_a_number_below_an_answer_judges_it_though_a_cell_is_at_hand(mine):
    async with reading(size=(80, 50), workspace=mine) as (app, pilot):
        question = app.page.progress.script.questions[0]
        app.page.progress.predict(question, "half")
        app.page.rebuild(*range(question.index, question.end))
        cell = next(
            c for c in app.page.progress.script.shown_cells if question.index < c.index < question.end
        )
        await at_block(app, pilot, cell.index)
        assert isinstance(app.page.item, CellItem)
        assert "Were you right?" in screen(app)
        assert "1 right, 2 nearly, 3 wrong   r run" in screen(app)
        await pilot.press("2")
        assert app.page.progress.prediction(question).judged == "nearly"
        await pilot.pause()
        assert "3 wrong" not in screen(app)


@pytest.mark.parametrize("moved", [False, True])
async def test_a_prediction_is_called_kept_only_where_it_is_recorded(mine, moved):
    async with reading(workspace=mine) as (app, pilot):
        await to_question(app, pilot)
        if moved:
            mine.root.rename(mine.root.with_name("moved"))
        await press(pilot, "enter", *"seven", "enter")
        words = "Not kept: q says why." if moved else "Kept."
        assert app.message.startswith(f"{words} The answer is open.")
    assert ("it was moved or removed" in app.page.trouble) == moved == (not mine.root.exists())


async def test_space_past_an_open_prediction_says_so_and_b_leads_back():
    async with reading() as (app, pilot):
        await to_question(app, pilot)
        while not app.message.startswith("You passed an open prediction."):
            before = app.page.top
            await pilot.press("space")
            assert app.page.top > before, "to the end without a word"
        await pilot.press("b")
        assert "predict" in keys_of(app.page)


async def test_the_bar_is_empty_until_the_whole_lesson_is_laid_out(monkeypatch):
    shares = []
    said = paging.Page.say_round

    def noted(page):
        said(page)
        shares.append((page.book.whole, page._share))

    monkeypatch.setattr(paging.Page, "say_round", noted)
    async with reading() as (app, _):
        assert {share for whole, share in shares if not whole} == {0.0}
        assert 0.0 < app.page._share < 0.3


async def test_a_cell_that_is_stopped_while_its_process_starts_took_the_time_that_its_reader_saw():
    async with reading() as (app, pilot):
        cell, bench = await to_cell(app, pilot), app.page.at_bench()
        start = bench._ready
        bench._ready = lambda: (time.sleep(0.3), start())[1]
        await pilot.press("r")
        bench.interrupt()
        await ran(app, pilot)
        state = app.page.progress.cell(cell)
        assert state.error == "Stopped."
        assert state.seconds >= 0.3


async def test_a_cell_runs_is_changed_fails_is_stopped_and_reset():
    async with reading() as (app, pilot):
        cell = await to_cell(app, pilot)
        await pilot.press("r")
        await ran(app, pilot)
        state = app.page.progress.cell(cell)
        assert (state.printed, state.error) == (cell.output, "")
        assert "prints the same" in screen(app)
        app.page.progress.edit(cell, cell.source + "\nprint(1 / 0)")
        await pilot.press("r")
        await ran(app, pilot)
        assert "ZeroDivisionError" in app.page.progress.cell(cell).error
        app.page.progress.edit(cell, "while True:\n    pass")
        await pilot.press("r")
        await pilot.pause(0.5)
        await pilot.resize_terminal(60, 30)  # in the middle of a cell
        await pilot.pause(0.2)
        assert "Ctrl-C stop it" in screen(app).splitlines()[-1]
        await pilot.press("ctrl+c")
        await ran(app, pilot)
        assert app.page.progress.cell(cell).error == "Stopped."
        await pilot.press("u", "r")
        await ran(app, pilot)
        assert app.page.progress.cell(cell).printed == cell.output


async def test_nothing_that_takes_an_answer_as_read_is_on_the_screen_of_its_prediction():
    async with reading(size=(80, 90)) as (app, pilot):
        await to_question(app, pilot, 9)
        assert "the answer is shown here" in screen(app)
        assert "why not always" not in screen(app)
        await pilot.press("space")
        assert "So why not always step implicitly?" in screen(app)
        await to_question(app, pilot, 9)
        await pilot.press("s")
        app.page.show(app.page.book.layout.row(Place(app.page.progress.script.questions[8].answer)))
        await pilot.pause()
        assert "The two implicit methods" in screen(app)
        assert "So why not always step implicitly?" in screen(app)


async def test_the_editor_keeps_and_drops():
    async with reading() as (app, pilot):
        cell = await editing(app, pilot)
        await press(pilot, "x", "escape")
        assert app.page.progress.cell(cell).source.startswith("x")
        await press(pilot, "e")
        await press(pilot, "y", "ctrl+d")
        assert "again" in below(app), "it asks once"
        await press(pilot, "z")
        assert "again" not in below(app)
        await press(pilot, "ctrl+d", "ctrl+d")
        assert app.page.progress.cell(cell).source.startswith("xf")
        await press(pilot, "e")
        await pilot.press("ctrl+d", "u")
        await pilot.press("u")
        assert app.page.progress.cell(cell).source == cell.source


async def test_keys_that_come_in_a_burst_act_in_their_order():
    """A terminal on a busy machine hands over many keys at once."""
    async with reading() as (app, pilot):
        typed = ["end", *["backspace"] * 6, *"v2, v1", "home", "#", "ctrl+r"]
        kept = []
        edit = Edit("", "return v1, v2", kept.append, "run")
        app.push_screen(edit, kept.append)
        await pilot.pause()
        for key in typed:
            app.post_message(Key(key, key if len(key) == 1 else None))
        await until(pilot, lambda: len(kept) == 2)
        assert kept == ["#return v2, v1", True]


@pytest.mark.parametrize("key", ["question_mark", "t", "slash"])
async def test_a_key_after_the_one_that_leaves_opens_nothing(key):
    async with reading() as (app, pilot):
        for one in ("q", key):
            app.post_message(Key(one, one if len(one) == 1 else None))
        await pilot.pause(0.2)
    assert app.failure is None


async def test_a_low_edge_that_is_too_short_names_the_first_keys_whole():
    async with reading(size=(40, 24)) as (app, pilot):
        await editing(app, pilot)
        assert below(app) == "Ctrl-R: keep, run   Escape: keep"
        await pilot.resize_terminal(80, 24)
        await pilot.pause()
        assert below(app) == "Ctrl-R: keep, run   Escape: keep   Ctrl-D: drop the changes"


async def test_the_editor_copies_indents_and_goes_to_both_ends_and_ctrl_c_never_loses_what_was_typed():
    async with reading() as (app, pilot):
        cell = await editing(app, pilot)
        await pilot.press(*"abc", "shift+left", "shift+left", "ctrl+c")
        assert app.clipboard == "bc"
        assert "Copied" in below(app)
        await pilot.press("right", "d", "ctrl+c")
        assert app.clipboard == "bc"
        assert "Nothing is selected" in below(app)
        await pilot.press("ctrl+end", "enter", *"if 1:  ", "enter", "1", "enter", "ctrl+home", "#", "ctrl+c")
        assert isinstance(app.screen, Edit), "who goes on typing is asked again"
        await press(pilot, "ctrl+c")
        changed = app.page.progress.cell(cell).source
        assert changed.startswith("#abcd")
        assert changed.endswith("\n    if 1:  \n        1\n        "), "it stands in a loop"
        assert len(app.screen_stack) == 1


async def test_ctrl_c_in_the_editor_stops_a_cell_that_runs():
    async with reading() as (app, pilot):
        cell = await editing(app, pilot)
        await press(pilot, *"while 1: pass", "enter", "ctrl+r", wait=0.3)
        await pilot.press("e", "x", "ctrl+c")
        await ran(app, pilot)
        assert app.page.progress.cell(cell).error == "Stopped."
        await press(pilot, "escape")
        assert app.page.progress.cell(cell).source.startswith("xwhile")


async def test_what_is_typed_is_kept_however_the_reader_is_left(mine):
    left = ["ctrl+q", "SIGINT", "SIGTERM", "SIGHUP"]
    for typed in ("", "3a", "2a3a", "1a2a3a", "0a1a2a3a"):
        async with reading(workspace=mine) as (app, pilot):
            source = app.page.progress.cell(app.page.progress.script.shown_cells[0]).source
            assert source.startswith(typed)
            assert ("cell 1, changed" in screen(app)) is bool(typed)
            if left:
                how = left.pop()
                await editing(app, pilot)
                await pilot.press(str(len(left)), "a")
                await leave(pilot, how)
                assert app._exit


async def test_the_place_is_kept_to_the_line_and_only_a_section_that_there_is_goes_before_it(mine):
    async with reading(workspace=mine) as (app, pilot):
        for _ in range(6):
            await pilot.press("space")
        place = app.page.place()
    async with reading(workspace=mine, section="no-such-section") as (app, _):
        assert app.page.place() == place
    async with reading(workspace=mine, size=(40, 20)) as (app, _):
        assert app.page.place().block == place.block
    async with reading(workspace=mine, section="swap-two-lines") as (app, _):
        assert "· Swap two lines" in screen(app).splitlines()[0]


async def test_the_place_is_kept_by_a_window_that_closes_as_it_changes(mine, monkeypatch):
    monkeypatch.setattr(paging, "_SETTLED", 1e6)  # nothing is kept but by leaving
    async with reading(workspace=mine) as (app, pilot):
        await pilot.press("space", "space", "space")
        app.page.lay_out(app.page.place())  # the rest of the lesson follows a moment later
        assert not app.page.book.whole
    assert mine.store.events("bookmark", LESSON)[-1].data["block"] == app.page.place().block > 0


async def test_search_finds_what_the_first_screen_says_and_does_not_deny_what_it_hides():
    async with reading(lesson="collisions-and-contact") as (app, pilot):
        lesson = app.page.progress.script.lesson
        word = lesson.summary.rstrip(".").split()[-1]
        assert word in screen(app)
        assert app._search(word)[0][0] == f"lesson:{lesson.id}:-1"
        ((key, said),) = app._search("zyx")
        assert not key
        assert re.fullmatch(r"In no lesson, unless behind one of \d+ open predictions\.", said)
        await press(pilot, "slash", *"zyx", "enter")
        await press(pilot, "escape", "slash", *word, "enter")
        await settled(app, pilot, "enter")
        assert app.page.place().block == -1


async def test_links_search_contents_and_the_way_back():
    async with reading() as (app, pilot):
        start = app.page.place()
        await pilot.press("slash")
        await press(pilot, *"restitution", "enter")
        await settled(app, pilot, "enter")
        assert app.page.progress.script.lesson.id != LESSON
        await settled(app, pilot, "backspace")
        assert (app.page.progress.script.lesson.id, app.page.place()) == (LESSON, start)
        await press(pilot, "t")
        await settled(app, pilot, "end", "enter")
        assert app.page.progress.script.lesson.id == CATALOG.lesson_ids()[-1]
        link = next(item for item in app.page.book.items if item.target.startswith("lesson:"))
        app.page.item = link
        await settled(app, pilot, "enter")
        assert app.page.progress.script.lesson.id == link.target.partition(":")[2].partition("#")[0]


async def test_tab_comes_to_predictions_cells_and_tasks_before_the_links_beside_them():
    async with reading(size=(80, 40)) as (app, pilot):
        while not (any(i.inline for i in app.page.items()) and any(not i.inline for i in app.page.items())):
            await pilot.press("space")
        app.page.item, blocks = None, sum(not item.inline for item in app.page.items())
        came = []
        for _ in app.page.items():
            await pilot.press("tab")
            came.append(app.page.item.inline)
        assert came == sorted(came)
        assert came.count(False) == blocks


async def test_tab_reaches_everything_that_can_be_acted_on():
    async with reading(size=(60, 20), lesson="why-simulate") as (app, pilot):

        def key_of(item):
            return type(item), item.block, item.number

        seen = set()
        for _ in range(4 * len(app.page.book.items)):
            await pilot.press("tab")
            if app.page.item is not None:
                seen.add(key_of(app.page.item))
            if seen >= {key_of(item) for item in app.page.book.items}:
                break
        else:
            pytest.fail("something is never reached")
        await pilot.press("G", "space")
        assert app.message == "This is the end. Enter: go on"


async def test_without_colour_nothing_is_said_by_colour(monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")
    async with reading() as (app, pilot):
        styles = [s.style for line in app.page.book.lines for s in line if s.style]
        assert not [style for style in styles if style.color or style.bgcolor]
        await to_question(app, pilot)
        assert "▸" in screen(app)
        assert "Predict first" in screen(app)


@pytest.mark.soak
async def test_a_key_is_answered_soon_at_200_columns():
    async with reading(size=(200, 50)) as (_, pilot):
        times = []
        for key in ["space"] * 8 + ["down"] * 4 + ["b"] * 4 + ["tab"] * 4:
            begin = time.process_time()
            await pilot.press(key)
            times.append(time.process_time() - begin)
        # The median: a collection of garbage may fall into any single one.
        assert sorted(times)[len(times) // 2] < KEY_S, times


def test_a_figure_is_pixels_with_letters_over_them():
    pixels = bytes([255, 255, 255] * 4 + [0, 0, 0] * 4)
    (line,) = half_blocks(pixels, 4, 1, [[1, 0, "ab", [255, 0, 0], False]])
    assert line.plain == "▀ab▀"
    upper, lower = line.spans[0].style.color, line.spans[0].style.bgcolor
    assert (upper.triplet.hex, lower.triplet.hex) == ("#ffffff", "#000000")
    assert line.spans[1].style.color.triplet.hex == "#ff0000"


def test_the_code_of_a_cell_is_printed_as_it_is_in_the_lesson(capsys):
    assert run(["lesson", LESSON, "--code", "1"]) == 0
    printed = capsys.readouterr().out
    compile(printed, "cell", "exec")
    assert printed.startswith("from math import cos")
    assert run(["lesson", LESSON, "--code", "99"]) == 5


async def test_a_file_that_is_there_is_not_overwritten(tmp_path, monkeypatch):
    async with reading() as (app, pilot):
        monkeypatch.chdir(tmp_path)
        (tmp_path / f"{LESSON}-1.py").write_text("mine")
        cell = await to_cell(app, pilot)
        await pilot.press("w")
        assert app.message == f"Wrote {LESSON}-1-2.py"
        assert (tmp_path / f"{LESSON}-1-2.py").read_text() == f"{cell.source}\n"
        assert (tmp_path / f"{LESSON}-1.py").read_text() == "mine"


async def test_a_box_leaves_no_letters_of_the_page_beside_it():
    async with reading() as (app, pilot):
        for columns in (40, 80, 90, 120):
            await pilot.resize_terminal(columns, 24)
            await settled(app, pilot)
            await press(pilot, "question_mark", wait=0.2)
            rows = ["".join(s.text for s in strip) for strip in app.screen._compositor.render_strips()]
            await press(pilot, "escape", wait=0.2)
            within = [re.split("[│╭╰╮╯]", row) for row in rows if set(row) & {*"│╭╰"}]
            assert {len(row) for row in rows} == {columns}
            assert len(within) > 10
            for left, *_, right in within:
                assert not left.strip() + right.strip()


async def test_what_stands_for_a_closed_answer_is_on_no_screen_of_its_own():
    async with reading(size=(120, 40)) as (app, _):
        layout, lines = app.page.book.layout, app.page.book.lines
        said = 0
        for start in layout.starts:
            rows = ["".join(s.text for s in line).strip() for line in lines[start : layout.end_of(start)]]
            words = [row for row in rows if row]
            said += any(row.startswith("After your prediction") for row in words)
            assert len(words) > 1, words
        assert said > 5


async def test_a_block_that_is_laid_out_again_below_leaves_the_screen_as_it_was_cut():
    async with reading(size=(40, 20), section="worked-example-one-step-by-hand") as (app, pilot):
        page = app.page
        cut = page.end()
        assert cut < page.top + page.room
        app.page.rebuild(figures_of(app)[-1])
        await pilot.pause()
        assert page.end() == cut


def test_a_line_of_keys_that_is_too_long_ends_with_how_to_see_all():
    keys = "r run   e change   u undo   c copy   w write   Space on   ? keys"
    assert fitting(keys, 100) == keys
    assert fitting(keys, 38, more="? keys") == "r run   e change   u undo   ? keys"
    assert fitting(keys, 38) == "r run   e change   u undo   c copy"
    judge = "1 right, 2 nearly, 3 wrong   "
    assert fitting(judge + keys, 38, more="? keys") == f"{judge}? keys"
    assert (
        fitting("were you 1 right, 2 nearly, 3 wrong   Space on", 38) == "were you 1 right, 2 nearly, 3 wrong"
    )
    assert fitting("the cell runs   Ctrl-C stop it", 12) == "the cell ru…"
