"""The view in a terminal: half blocks, a mouse or keys, and the accounts beside the picture."""

import os
import sys

from course.errors import MissingCapabilityError
from course.sandbox.scene.loading import Chosen
from course.sandbox.views.stage import Desk


def play(chosen: Chosen | None, desk: Desk | None = None, *, guess: float | None = None) -> bytes:
    """Play until the user leaves. The terminal is left as it was, whatever happens.

    Args:
        chosen: the scene with the parameters that go into it; None to begin with the gallery.
        guess: an answer to the scene's question.

    Returns:
        the recording of what was played last.

    Raises:
        MissingCapabilityError: this is no terminal, or one that cannot move its cursor.
    """
    _need_terminal()
    from course.sandbox.views.terminal.app import SandboxApp

    desk = desk or Desk()
    stage = None if chosen is None else desk.stage(chosen, guess=guess)
    app = SandboxApp(stage, desk)
    app.play()
    return app.stage.recording.encode()


def _need_terminal() -> None:
    dumb = os.environ.get("TERM", "") in {"dumb", "unknown"}
    if sys.stdin.isatty() and sys.stdout.isatty() and not dumb:
        return
    raise MissingCapabilityError(
        "This terminal cannot place its cursor." if dumb else "The view in a terminal needs a terminal.",
        help="Use --describe for sentences, --headless for numbers, or --gif FILE for a film.",
        code="no_terminal",
    )
