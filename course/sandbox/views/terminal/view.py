"""The view in a terminal: half blocks, a mouse or keys, and the accounts beside the picture."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable

from course.errors import MissingCapabilityError
from course.sandbox.scene.loading import Chosen, Comparison, as_it_is
from course.sandbox.scene.model import Scene
from course.sandbox.world.world import World


def play(
    world: World,
    scene: Scene,
    *,
    fps: float = 30.0,
    chosen: Chosen | None = None,
    guess: float | None = None,
    keep: Callable[[Comparison], None] | None = None,
) -> None:
    """Play with a world until its user leaves. The terminal is left as it was, whatever happens.

    Args:
        world: before its first step, with a receipt.
        scene: of the world.
        fps: pictures a second.
        chosen: the scene with the parameters that went into it; with their defaults if left out.
        guess: an answer to the scene's question that was given already; else the view asks for one.
        keep: called with each comparison that has a guess.

    Raises:
        MissingCapabilityError: this is no terminal, or one that cannot move its cursor.
    """
    _need_terminal()
    from course.sandbox.views.terminal.app import SandboxApp

    SandboxApp(world, chosen or as_it_is(scene), fps=fps, guess=guess, keep=keep).play()


def _need_terminal() -> None:
    dumb = os.environ.get("TERM", "") in {"dumb", "unknown"}
    if sys.stdin.isatty() and sys.stdout.isatty() and not dumb:
        return
    raise MissingCapabilityError(
        "This terminal cannot place its cursor." if dumb else "The view in a terminal needs a terminal.",
        help="Use --describe for sentences, --headless for numbers, or --gif FILE for a film.",
        code="no_terminal",
    )
