"""What lives in a cell, without a page: messages come from another thread, as ipykernel 7 hands them on."""

import asyncio
import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

pytest.importorskip("anywidget")

from course.catalog.load import Catalog
from course.cli.frame import app
from course.errors import NotFoundError
from course.notebooks.predicting import LessonPrediction, OngoingAttempt, finish, predict, take
from course.notebooks.sandbox import Film, play
from course.notebooks.widgets import Predict, QuizForm, Sandbox
from course.progress.workspace import Workspace
from course.reading.parts import read_script
from course.reading.record import InProgress

#: In s; a frame takes a few ms, and a machine may be busy.
PATIENCE = 60


def said_by_a_page(widget, *messages):
    """Messages as a kernel hands them on from a subshell: on a thread without a loop."""
    with ThreadPoolExecutor(1) as thread:
        for message in messages:
            thread.submit(widget._handle_custom_msg, message, []).result()


def test_a_world_in_a_cell_moves_when_a_page_on_another_thread_says_so():
    async def cell():
        widget = play("head-on")
        assert isinstance(widget, Sandbox)
        kinds = []

        def send(message, buffers=None):
            kinds.append(message["kind"])
            if message["kind"] == "numbers":
                said_by_a_page(widget, {"kind": "seen"})

        widget.send = send
        run = {"kind": "request", "text": '{"do": "pause", "on": false}'}
        said_by_a_page(widget, {"kind": "hello"}, run)
        async with asyncio.timeout(PATIENCE):
            while widget.world.t < 0.05:
                await asyncio.sleep(0.01)
        moved = widget.world.t
        widget.close()
        await asyncio.sleep(0.05)
        assert widget.session.pages == []
        return moved, kinds

    moved, kinds = asyncio.run(cell())
    assert moved > 0
    assert {"words", "numbers"} <= set(kinds)


def test_a_script_gets_a_film_for_there_is_no_loop_to_live_in():
    assert isinstance(play("head-on"), Film)


@pytest.fixture
def workspace(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert app.run(("init", "work")) == 0
    monkeypatch.chdir(tmp_path / "work")
    return Workspace.find(Path.cwd())


def test_a_prediction_is_kept_as_the_reader_keeps_it_and_opens_the_answer(workspace):
    shown = []

    async def cell():
        widget = predict("accuracy", 1)
        assert isinstance(widget, Predict)
        widget._open = lambda *, update=True: shown.append((widget.asked.opened, update))
        said_by_a_page(widget, {"kind": "hello"})
        await asyncio.sleep(0.05)
        assert not shown
        said_by_a_page(widget, {"kind": "predict", "text": "it *grows* "})
        said_by_a_page(widget, {"kind": "predict", "text": "something else"})
        await asyncio.sleep(0.05)

    asyncio.run(cell())
    text, update = shown[0]
    assert update
    assert "You predicted: it \\*grows\\*" in text
    assert "Answer." in text
    lesson = Catalog().lesson("accuracy")
    kept = InProgress(read_script(lesson), workspace.store.events("", "accuracy"))
    question = kept.script.questions[0]
    said = kept.prediction(question)
    assert said.text == "it *grows*"
    assert len(workspace.store.events("prediction", "accuracy")) == 1

    asked = LessonPrediction("numerical-integration", 1)
    asked.say("\ud83d and " + "x" * 10**6)  # whatever a page sends
    assert asked.said.startswith("? and xx")
    assert len(asked.said) <= 4000

    again = predict("accuracy", 1)  # in a notebook that is opened again, and in the reader
    assert again.said == "it *grows*"
    assert again._repr_markdown_().startswith(text)


def test_a_prediction_is_compared_once_its_answer_is_open(workspace):
    async def cell():
        widget = predict("accuracy", 1)
        told = []
        widget._open = lambda *, update=True: None
        widget.send = lambda message, buffers=None: told.append(message)
        said_by_a_page(widget, {"kind": "predict", "text": "it grows"}, {"kind": "judge", "word": "best"})
        said_by_a_page(widget, {"kind": "judge", "word": "nearly"}, {"kind": "hello"})
        await asyncio.sleep(0.05)
        return told

    assert [one["waits"] for one in asyncio.run(cell())] == [True, True, False, False]
    assert predict("accuracy", 2, "it falls", "wrong").judged == "wrong"
    judged = [event.data.get("judged") for event in workspace.store.events("prediction", "accuracy")]
    assert judged == [None, "nearly", None, "wrong"]
    shown = predict("accuracy", 1)._repr_markdown_()
    assert "By your own word: nearly." in shown
    assert "How did it do?" not in shown


def test_a_lesson_counts_as_read_once_its_end_is_run_and_no_prediction_is_open(workspace):
    lesson = read_script(Catalog().lesson("accuracy"))
    assert repr(finish("accuracy")).startswith(f"{len(lesson.questions)} predictions are open")
    assert workspace.store.events("lesson") == ()
    for question in lesson.questions:
        LessonPrediction("accuracy", question.number).say("")
    assert "and it is recorded" in repr(finish("accuracy"))
    assert [event.subject for event in workspace.store.events("lesson")] == ["accuracy"]


def test_without_widgets_the_text_in_the_cell_is_the_prediction(workspace):
    empty = predict("accuracy", 1, "\n\n")
    assert empty.said is None
    assert "Answer." not in empty._repr_markdown_()
    assert workspace.store.events("prediction") == ()
    assert "Answer." in predict("accuracy", 1, "\nit grows\n")._repr_markdown_()
    (event,) = workspace.store.events("prediction")
    assert (event.subject, event.data["text"]) == ("accuracy", "it grows")
    with pytest.raises(NotFoundError):
        predict("accuracy", 99)


def test_outside_of_a_workspace_an_answer_opens_and_nothing_is_kept(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert "Answer." in predict("accuracy", 1, "it grows")._repr_markdown_()
    assert list(tmp_path.iterdir()) == []
    assert predict("accuracy", 1).said is None


def test_an_attempt_in_a_cell_counts_as_one_in_a_terminal(workspace, capsys):
    sent = []
    shown = []

    async def cell(letters):
        shown.clear()
        widget = take()
        assert isinstance(widget, QuizForm)
        widget.send = sent.append
        widget._open = lambda *, update=True: shown.append(update)
        said_by_a_page(widget, {"kind": "hello"})
        right = {one.question: one.key.letter for one in widget.taken.posed}
        said_by_a_page(widget, {"kind": "answers", "answers": {}})
        await asyncio.sleep(0.05)
        assert not shown
        for _ in range(2):  # handed in twice, it is scored once
            said_by_a_page(widget, {"kind": "answers", "answers": right | letters})
        await asyncio.sleep(0.05)
        return widget

    first = asyncio.run(cell({}))
    assert first.taken.result.passed
    asked = sent[0]["questions"]
    assert [one["id"] for one in asked] == [one.question for one in first.taken.posed]
    assert all(set(option) == {"letter", "text"} for one in asked for option in one["options"])
    capsys.readouterr()
    assert app.run(("quiz", "history", "--json")) == 0
    reply = json.loads(capsys.readouterr().out)
    assert reply["passed"]
    (attempt,) = reply["attempts"]
    assert attempt["seed"] == first.taken.attempt.seed
    assert attempt["score"] == len(asked)

    name = asked[0]["id"]
    second = OngoingAttempt()
    assert second.attempt.seed != first.taken.attempt.seed  # other questions, as in a terminal
    wrong = next(choice for choice in second.posed[0].choices if not choice.right)
    asyncio.run(cell({name: wrong.letter}))  # it goes on with the attempt that was begun
    assert second.finish({one.question: one.key.letter for one in second.posed})
    assert (second.result.score, "finished elsewhere" in second.note) == (len(asked) - 1, True)
    app.run(("quiz", "history", "--json"))
    reply = json.loads(capsys.readouterr().out)
    assert [one["score"] for one in reply["attempts"]] == [len(asked), len(asked) - 1]
    assert [one["question"] for one in reply["review"]] == [name]
