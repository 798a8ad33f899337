"""What lives in a cell: forms, each with a place below it for the reply, and the sandbox."""

import asyncio
import contextlib
import re
from collections.abc import Callable
from html import escape
from pathlib import Path
from typing import Any
from uuid import uuid4

import anywidget

import course.sandbox.views.web
from course.notebooks.quiz import Marks
from course.progress.store import numbered
from course.sandbox.scene.loading import choose
from course.sandbox.views.stage import Desk, Stage
from course.sandbox.views.web.session import SCRIPTS, Page, Session
from course.sandbox.world.world import World

_SCRIPTS = Path(__file__).parent / "static"
#: The web view's files.
STATIC = Path(course.sandbox.views.web.__file__).parent / "static"


class Form(anywidget.AnyWidget):  # type: ignore[misc]
    """A form whose page talks to this kernel.

    Raises:
        RuntimeError: no event loop runs here, as one does in every kernel.
    """

    def __init__(self) -> None:
        super().__init__()
        self._loop = asyncio.get_running_loop()  # see ``Sandbox``: messages come on another thread
        self._shown = uuid4().hex
        self.on_msg(lambda _, message, __: self._loop.call_soon_threadsafe(self._hear, message))

    def _hear(self, message: Any) -> None:
        """Handle a message from the page."""
        raise NotImplementedError

    def _below(self) -> dict[str, str]:
        """The reply below the form, by MIME type."""
        raise NotImplementedError

    def _ipython_display_(self) -> None:
        _show(super()._repr_mimebundle_()[0])
        self._open(update=False)

    def _open(self, *, update: bool = True) -> None:
        _show(self._below(), display_id=self._shown, update=update)


def _show(bundle: dict[str, Any], **place: Any) -> None:
    import IPython.display

    show: Callable[..., Any] = IPython.display.display  # typed or not, whether it is installed or not
    show(bundle, raw=True, **place)


# ---
# A field for a prediction in a cell; once the prediction is kept, the answer appears below it.


class Predict(Form):
    """A field that waits for a prediction.

    Args:
        asked: see ``predicting.LessonPrediction``; that module imports this one.
    """

    _esm = (_SCRIPTS / "predict.js").read_text("utf-8")
    # JupyterLab's own grey is too pale on its dark theme.
    _css = ".course-prediction::placeholder { color: inherit; opacity: 0.8; }"

    def __init__(self, asked: Any) -> None:
        super().__init__()
        self.asked = asked

    def _hear(self, message: Any) -> None:
        match message:
            case {"kind": "hello"} if self.asked.said is not None:
                self.send({"kind": "kept", "waits": self.asked.waits})
            case {"kind": "predict", "text": str(text)}:
                self.asked.say(text)
                self.send({"kind": "kept", "waits": self.asked.waits})
                self._open()
            case {"kind": "judge", "word": str(word)}:
                self.asked.judge(word)
                self.send({"kind": "kept", "waits": self.asked.waits})
                self._open()

    def _below(self) -> dict[str, str]:
        text = self.asked.opened if self.asked.said is not None else ""
        return {"text/markdown": text, "text/plain": text}


# ---
# The sandbox's style in a cell's output: the web view's own, adapted to a place inside a page.


#: Where the web view asks for its window's width, a cell has to ask for its own: two notebooks side by side
#: leave half a window. Below this width the picture would be narrower than the panel beside it.
_WINDOW, _CELL = "@media (max-width: 860px)", "@container (max-width: 720px)"
#: A cell's output is not a page: the cells above and below it should stay in sight. JupyterLab has its own
#: layout for lists of terms.
_HERE = f"""
.sandbox {{ height: min(75vh, 44rem); }}
.sandbox :is(dt, dd) {{ float: none; width: auto; margin: 0; padding: 0; }}
.sandbox dt {{ font-weight: inherit; }}
{_CELL} {{
  .sandbox {{ height: auto; min-height: 0; }}
  .sandbox .events ol {{ max-height: 8rem; }}
}}
"""


def style() -> str:
    """The style sheet of a world in a cell. The element around it must be a container of inline size."""
    return (STATIC / "style.css").read_text("utf-8").replace(_WINDOW, _CELL) + _HERE


def one_module() -> str:
    """The modules of the page as one script: a cell takes in no more."""
    texts = [(STATIC / f"{name}.js").read_text("utf-8") for name in SCRIPTS]
    return "".join(re.sub(r"(?m)^import .*\n|^export ", "", text) for text in texts)


def _save(name: str, data: bytes) -> str:
    """Write a file beside the notebook; one that is there already stays."""
    path = next(path for path in numbered(Path(name)) if not path.exists())
    path.write_bytes(data)
    return str(path)


# ---
# The live sandbox in a notebook: the world runs in the kernel, the page draws it as the web view does.


#: Between two frames, in s: the user's actions have to get through as well.
_PAUSE = 0.02
#: How long a page may take to draw a frame before it counts as gone, in s; it is asked again when it says
#: anything.
_GONE = 5.0


class Sandbox(anywidget.AnyWidget):  # type: ignore[misc]
    """A world to watch and to move bodies in.

    Args:
        scene_id: see ``course sandbox list``, or the path of a scene of your own.
        settings: the scene's parameters, and gravity, restitution, friction, step or iterations.

    Raises:
        NotFoundError: there is no such scene.
        UsageError: a setting is unknown or out of range.
        RuntimeError: no event loop runs here, as one does in every kernel.
    """

    _esm = one_module() + (_SCRIPTS / "sandbox.js").read_text("utf-8")
    _css = style()

    def __init__(self, scene_id: str, **settings: float) -> None:
        super().__init__()
        self.session = Session(Stage(choose(scene_id, settings)), Desk(save=_save))
        self._page: Page | None = None
        self._tasks: list[asyncio.Task[None]] = []
        self._seen = asyncio.Event()
        self._stalled = False
        # Messages come on a thread of the kernel's (ipykernel 7 gives them a subshell of their own), and
        # everything here belongs to the loop that ran this cell.
        self._loop = asyncio.get_running_loop()
        self.on_msg(lambda _, message, __: self._soon(self._hear, message))

    @property
    def world(self) -> World:
        """What is played now."""
        return self.session.stage.world

    def _soon(self, call: Callable[..., None], *given: Any) -> None:
        """Call a function on the loop that the world lives in, from any thread."""
        with contextlib.suppress(RuntimeError):  # the loop may have ended first, and the world with it
            self._loop.call_soon_threadsafe(call, *given)

    def _hear(self, message: Any) -> None:
        if self._page is not None and self._stalled:
            self._page.watching, self._stalled = True, False
        match message:
            case {"kind": "hello"}:
                self._leave()
                self._join()
            case {"kind": "bye"}:
                self._leave()
            case {"kind": "seen"}:
                self._seen.set()
            case {"kind": "request", "text": str(text)} if self._page is not None:
                self.session.receive(self._page, text)

    def _join(self) -> None:
        """A page has opened or reloaded."""
        self._page = self.session.join()
        if self._page is not None:
            self._tasks = [
                self._loop.create_task(self.session.run()),
                self._loop.create_task(self._speak(self._page)),
            ]

    def _leave(self) -> None:
        for task in self._tasks:
            task.cancel()
        self._tasks = []
        if self._page is not None:
            self.session.leave(self._page)
            self._page = None

    async def _speak(self, page: Page) -> None:
        """Forward the session's messages; a frame only once the last one was drawn."""
        while (data := await page.fetch()) is not None:
            if isinstance(data, str):
                self.send({"kind": "words", "text": data})
                continue
            self._seen.clear()
            self.send({"kind": "numbers"}, [data])
            try:
                async with asyncio.timeout(_GONE):
                    await self._seen.wait()
            except TimeoutError:
                page.watching, self._stalled = False, True
            await asyncio.sleep(_PAUSE)

    def close(self) -> None:
        """End it, here and in every page."""
        self._soon(self._leave)
        super().close()


# ---
# The questions of an attempt as a form in a cell; once it is sent, the result appears below it.


class QuizForm(Form):
    """An attempt at the quiz.

    Args:
        taken: see ``predicting.OngoingAttempt``; that module imports this one.
    """

    _esm = (_SCRIPTS / "take.js").read_text("utf-8")

    def __init__(self, taken: Any) -> None:
        super().__init__()
        self.taken = taken

    def _hear(self, message: Any) -> None:
        match message:
            case {"kind": "hello"}:
                self.send({"kind": "questions", "questions": self._questions()})
            case {"kind": "answers", "answers": dict(letters)} if self.taken.finish(letters):
                self._open()
        if self.taken.result is not None:
            self.send({"kind": "done"})

    def _questions(self) -> list[dict[str, Any]]:
        """The questions as they are asked: nothing in them says which option is right."""
        answers = self.taken.attempt.answers
        return [
            {
                "id": one.question,
                "title": one.title,
                "prompt": one.prompt,
                "options": [{"letter": each.letter, "text": each.text} for each in one.choices],
                "answered": next((c.letter for c in one.choices if c.id == answers.get(one.question)), ""),
            }
            for one in self.taken.posed
        ]

    def _below(self) -> dict[str, str]:
        result = self.taken.result
        if result is None:
            return {"text/html": "", "text/plain": ""}
        marks = Marks(result)
        return {
            "text/html": f"{marks._repr_html_()}<p>{escape(self.taken.note)}</p>",
            "text/plain": repr(marks),
        }
