"""A lesson in progress: what is closed, where a place is, what is kept."""

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import msgspec
import pytest

from course.catalog.models import Lesson
from course.progress.history import lesson_events
from course.progress.store import Event, Store
from course.reading.parts import read_script, words_of
from course.reading.record import (
    InProgress,
    Layout,
    Place,
    Row,
    Writer,
    find,
    predictions_of,
    tally,
    unless_hidden,
)

TEXT = """+++
ignored = true
+++

Opening words.

## First

> **Predict.** What comes out?

```python
print(2 + 2)
```

```output
4
```

Between stands [4](<=2 + 2>), the answer.

Plain words between.

![Two lines that cross at one](figure:integrators-stability)
They cross.

> **Answer.** Four.

After it.

## Second

```python hidden
x = 1
```

> **Predict.** And now?

```python
print(x)
```

```output
1
```
"""


@pytest.fixture
def lesson(tmp_path):
    path = tmp_path / "a-lesson.md"
    path.write_text(TEXT, encoding="utf-8")
    return Lesson(1, "a-lesson", "A lesson", 10, "What it is.", ("do this",), (), (), str(path))


def kinds(script, indices):
    return [type(script.blocks[i]).__name__ for i in indices]


def test_a_prediction_closes_what_follows_up_to_its_answer(lesson):
    script = read_script(lesson)
    first, second = script.questions
    closed = [i for i in range(len(script.blocks)) if script.question_over(i) is first]
    assert kinds(script, closed) == ["CodeCell", "Paragraph", "Paragraph", "Figure", "Callout"]
    shut = [i for i in closed if script.gives_away(i)]
    assert kinds(script, shut) == ["Paragraph", "Figure", "Callout"]  # the one that quotes the number
    assert script.question_over(closed[-1] + 1) is None
    assert second.answer is None
    assert second.end == len(script.blocks)


def test_a_screen_ends_below_an_open_prediction(lesson):
    rows = [Row(0), Row(1), Row(1), Row(2, blank=True, fresh=True), Row(2), Row(2)]
    layout = Layout(rows, 10)
    assert (layout.end_of(0), layout.next(0), layout.end_of(4)) == (3, 4, 6)
    assert layout.starts == [0, 4]
    script = read_script(lesson)
    first, second = script.questions
    hidden = next(cell.index for cell in script.cells if cell.hidden)
    assert script.after(first) < hidden
    assert script.after(second) == len(script.blocks)
    assert script.after(replace(first, end=hidden)) == second.index


def test_a_prediction_opens_once_it_is_answered_or_skipped(lesson):
    script = read_script(lesson)
    first, second = script.questions
    progress = InProgress(script)
    assert progress.closed_by(first.answer) is first
    progress.predict(first, "  five ")
    assert progress.closed_by(first.answer) is None
    progress.predict(first, "four, of course")  # after the answer was open: what was said first stays
    assert progress.prediction(first).text == "five"
    progress.predict(second, "")
    assert progress.prediction(second).skipped


def test_what_was_done_is_there_when_the_lesson_is_opened_again(lesson, tmp_path):
    script = read_script(lesson)
    store = Store(tmp_path / "progress.sqlite")
    write = Writer(store)
    progress = InProgress(script, (), write, "1.0")
    first, second = script.questions
    cell = script.shown_cells[0]
    progress.predict(first, "five")
    progress.judge(first, "wrong")
    progress.predict(second, "")
    progress.edit(cell, "print(5)")
    progress.ran(cell, "print(5)", "5", "", 0.25)
    progress.at(Place(6, 0.5), 8)
    progress.reached_end()
    progress.reached_end()
    write.close()
    events = store.events(subject=lesson.id)
    assert [event.kind for event in events].count("lesson") == 1
    again = InProgress(script, events)
    assert (again.prediction(first).text, again.prediction(first).judged) == ("five", "wrong")
    assert again.prediction(second).skipped
    state = again.cell(cell)
    assert (state.source, state.ran, state.printed, state.seconds) == ("print(5)", "print(5)", "5", 0.25)
    assert (again.place, again.furthest, again.read) == (Place(6, 0.5), 8, True)


def test_what_was_done_in_a_lesson_before_it_was_parted_is_in_both_parts(lesson, tmp_path):
    whole = read_script(lesson)
    part = replace(whole, lesson=msgspec.structs.replace(lesson, id="its-second-half"))
    store = Store(tmp_path / "progress.sqlite")
    first, _ = whole.questions
    cell = whole.shown_cells[0]
    store.append("prediction", lesson.id, {"key": first.key, "number": 1, "text": "five"})
    store.append("cell", lesson.id, {"key": cell.key, "number": 1, "source": "print(5)"})
    store.append("bookmark", lesson.id, {"block": 3, "part": 0.0, "words": words_of(whole.blocks[3])})

    def opened():
        events = lesson_events(store, part.lesson.id, {part.lesson.id: lesson.id})
        return InProgress(part, events, store.append)

    begun = opened()
    assert (begun.prediction(first).text, begun.cell(cell).source) == ("five", "print(5)")
    assert (begun.place, begun.furthest, begun.read) == (Place(), -1, False)
    InProgress(whole, (), store.append).reached_end()  # of the part that kept the name
    assert not opened().read
    store.append("lesson", lesson.id, {"version": "1.2.0"})
    assert (opened().read, opened().furthest) == (True, len(part.blocks) - 1)
    opened().reached_end()
    assert [event.subject for event in store.events("lesson")] == [lesson.id, lesson.id]


def test_a_place_and_answers_survive_an_edit_of_the_lesson(lesson, tmp_path):
    script = read_script(lesson)
    store = Store(tmp_path / "progress.sqlite")
    write = Writer(store)
    progress = InProgress(script, (), write)
    progress.predict(script.questions[1], "one")
    after = next(i for i, block in enumerate(script.blocks) if "After it" in str(block))
    progress.at(Place(after, 0.0), after)
    write.close()
    path = Path(lesson.path)
    path.write_text(
        path.read_text().replace("Opening words.", "Opening words.\n\nMore of them.\n\nAnd more.")
    )
    edited = read_script(lesson)
    again = InProgress(edited, store.events(subject=lesson.id))
    assert again.place.block == after + 2
    assert again.prediction(edited.questions[1]).text == "one"


def test_a_record_that_cannot_be_written_is_said_and_stops_nobody(lesson, tmp_path):
    (tmp_path / "progress.sqlite").write_bytes(b"not a database, not at all, no" * 10)
    write = Writer(Store(tmp_path / "progress.sqlite"))
    InProgress(read_script(lesson), (), write).reached_end()
    write.close()
    assert "not recorded" in write.trouble


@pytest.mark.parametrize("junk", [{}, {"block": "x"}, {"block": 999, "part": 1, "words": "?"}, {"key": 3}])
def test_events_that_fit_nothing_are_passed_over(lesson, tmp_path, junk):
    store = Store(tmp_path / "progress.sqlite")
    for kind in ("bookmark", "prediction", "cell"):
        store.append(kind, lesson.id, junk)
    assert InProgress(read_script(lesson), store.events()).place == Place()


def test_search_does_not_look_behind_an_open_prediction(lesson):
    script = read_script(lesson)
    progress = InProgress(script)

    def hits():
        return [hit.block for hit in find(progress, "  four ")]

    assert hits() == []
    assert unless_hidden(progress) == ", unless behind the open prediction.", "the other one hides nothing"
    assert unless_hidden(progress, progress) == ", unless behind one of 2 open predictions."
    for question in script.questions:
        progress.predict(question, "")
    assert hits() == [script.questions[0].answer]
    assert unless_hidden(progress) == "."


def test_search_looks_at_what_stands_above_a_lesson(lesson):
    progress = InProgress(read_script(lesson))
    for wanted in (lesson.title, lesson.summary[-12:], lesson.objectives[-1]):
        assert [hit.block for hit in find(progress, wanted)][:1] == [-1]


def test_minutes_left_fall_from_all_to_none(lesson):
    script = read_script(lesson)
    left = [script.minutes_left(i) for i in range(len(script.blocks) + 1)]
    assert left[0] == 10
    assert left[-1] == 0
    assert left == sorted(left, reverse=True)


# -- screens -------------------------------------------------------------------------------------------


def rows_of(*lengths, whole=False):
    return [Row(b, blank=False, joined=whole and r > 0) for b, n in enumerate(lengths) for r in range(n)]


@pytest.mark.parametrize("height", [1, 3, 7, 20, 100])
def test_screens_show_every_row_once(height):
    layout = Layout(rows_of(5, 1, 12, 3, 30, 2, whole=True), height)
    seen = [row for top in layout.starts for row in range(top, layout.end_of(top))]
    assert seen == list(range(len(layout)))
    assert layout.end_of(layout.last) == len(layout)


def test_what_fits_on_a_screen_is_not_cut():
    layout = Layout(rows_of(6, 9, 9, whole=True), 10)
    assert layout.starts == [0, 6, 15]
    assert Layout(rows_of(3, 30, whole=True), 10).starts[1] == 10  # this one never fits


def test_a_screen_begins_with_no_blank_line():
    rows = [Row(0), Row(0), Row(1, blank=True), Row(1, blank=True), Row(1), Row(1)]
    assert Layout(rows, 2).starts == [0, 4]


def test_forward_and_back_meet_and_neither_skips_a_row():
    layout = Layout(rows_of(*range(1, 20)), 7)
    top = 0
    while (following := layout.next(top)) != top:
        assert following <= layout.end_of(top)
        assert layout.previous(following) == top
        top = following
    assert top == layout.last


@pytest.mark.parametrize("widths", [(40, 160), (160, 40), (80, 81)])
def test_a_place_is_found_again_at_another_width(widths):
    """The same text, more rows where it is narrower: the row found is as far into the block."""
    lengths = [120, 900, 40, 3000, 500]
    before, after = (Layout(rows_of(*(-(-n // w) for n in lengths)), 20) for w in widths)
    for row in range(len(before)):
        place = before.place(row)
        found = after.place(after.row(place))
        assert found.block == place.block
        first, end = after.span(found.block)
        assert abs(found.part - place.part) <= 1 / (end - first)


def test_a_place_in_a_block_that_is_not_shown_is_the_block_before():
    layout = Layout([Row(0), Row(0), Row(3)], 2)
    assert layout.row(Place(2, 0.9)) == 0
    assert layout.row(Place(3, 0.0)) == 2


# -- predictions of all lessons, counted from what the reader writes -----------------------------------------

AT = datetime(2026, 11, 22, 10, tzinfo=UTC)


def events(*given):
    return [Event(number, AT, "prediction", lesson, data) for number, (lesson, data) in enumerate(given, 1)]


def test_what_was_said_first_stays_and_the_last_judgement_counts():
    (said,) = predictions_of(
        events(
            ("a", {"key": "k", "number": 1, "text": "five"}),
            ("a", {"key": "k", "number": 1, "text": "six"}),
            ("a", {"key": "k", "number": 1, "judged": "wrong"}),
            ("a", {"key": "k", "number": 1, "judged": "nearly"}),
            ("a", {"key": "k", "number": 1, "judged": "perfect"}),
        )
    )
    assert (said.text, said.judged) == ("five", "nearly")


def test_the_same_key_in_two_lessons_is_two_questions():
    both = predictions_of(events(("a", {"key": "k", "text": "x"}), ("b", {"key": "k", "text": "y"})))
    assert [one.text for one in both] == ["x", "y"]


def test_a_skipped_prediction_is_neither_said_nor_judged():
    counts = tally(
        predictions_of(
            events(
                ("a", {"key": "1", "text": ""}),
                ("a", {"key": "1", "judged": "right"}),
                ("a", {"key": "2", "text": "x"}),
                ("a", {"key": "3", "text": "y"}),
                ("a", {"key": "3", "judged": "right"}),
            )
        )
    )
    assert counts == {"said": 2, "skipped": 1, "right": 1, "nearly": 0, "wrong": 0, "unjudged": 1}
