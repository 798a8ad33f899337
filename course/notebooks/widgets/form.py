"""A form in a cell, with a place below it for the reply."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import anywidget

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Form"]


class Form(anywidget.AnyWidget):  # type: ignore[misc]
    """A form whose page talks to this kernel.

    Raises:
        RuntimeError: no event loop runs here, as one does in every kernel.
    """

    def __init__(self) -> None:
        super().__init__()
        self._loop = asyncio.get_running_loop()  # see ``sandbox.Sandbox``: messages come on another thread
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
