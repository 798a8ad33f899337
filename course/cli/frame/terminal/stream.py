"""An output stream whose reader may go away."""

from __future__ import annotations

import contextlib
import os
from typing import TYPE_CHECKING, Any, TextIO

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Stream"]


class Stream:
    """A text stream whose reader may go away: ``course lessons | head -1`` is not an error."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._open = True

    def write(self, text: str) -> int:
        self._unless_gone(lambda: self._stream.write(text))
        return len(text)

    def write_bytes(self, data: bytes) -> None:
        """Write UTF-8 bytes as they are, whatever encoding the stream has."""
        binary = getattr(self._stream, "buffer", None)
        if binary is None:
            self.write(data.decode("utf-8"))
            return
        self.flush()
        self._unless_gone(lambda: binary.write(data))
        self._unless_gone(binary.flush)

    def flush(self) -> None:
        self._unless_gone(self._stream.flush)

    def _unless_gone(self, action: Callable[[], Any]) -> None:
        """Do something with the stream, unless its reader is gone."""
        if not self._open:
            return
        try:
            action()
        except BrokenPipeError:
            self._open = False
            # The interpreter flushes the real stream once more when it exits; give it somewhere to go.
            with contextlib.suppress(OSError, ValueError):
                null = os.open(os.devnull, os.O_WRONLY)
                os.dup2(null, self._stream.fileno())
                os.close(null)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)
