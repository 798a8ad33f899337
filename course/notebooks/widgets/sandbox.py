"""The live sandbox in a notebook: the world runs in the kernel, the page draws it as the web view does."""

from __future__ import annotations

import asyncio
import contextlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import anywidget

from course.notebooks.widgets.style import STATIC, style
from course.sandbox.scene.loading import choose
from course.sandbox.views.web.session import Page, Session
from course.sandbox.world.world import World

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Sandbox"]

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

    _esm = (STATIC / "world.js").read_text("utf-8") + Path(__file__).with_suffix(".js").read_text("utf-8")
    _css = style()

    def __init__(self, scene_id: str, **settings: float) -> None:
        super().__init__()
        chosen = choose(scene_id, settings)
        self.world = World(chosen.scene, chosen.settings)
        self.session = Session(self.world, chosen)
        self._page: Page | None = None
        self._tasks: list[asyncio.Task[None]] = []
        self._seen = asyncio.Event()
        self._stalled = False
        # Messages come on a thread of the kernel's (ipykernel 7 gives them a subshell of their own), and
        # everything here belongs to the loop that ran this cell.
        self._loop = asyncio.get_running_loop()
        self.on_msg(lambda _, message, __: self._soon(self._hear, message))

    def _soon(self, call: Callable[..., None], *given: Any) -> None:
        """Call a function on the loop that the world lives in, from any thread."""
        with contextlib.suppress(RuntimeError):  # the loop may have ended first, and the world with it
            self._loop.call_soon_threadsafe(call, *given)

    def _hear(self, message: Any) -> None:
        """Handle a message from a page."""
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
