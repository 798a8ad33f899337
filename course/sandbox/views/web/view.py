"""The view in a browser: a page on this machine, and the world behind it.

Nothing here needs the packages of the extra ``web`` before ``play`` is called.
"""

from __future__ import annotations

import contextlib
import secrets
import socket
from pathlib import Path
from typing import TYPE_CHECKING

from course.browser import invite
from course.errors import UsageError
from course.extras import require

if TYPE_CHECKING:
    from collections.abc import Callable

    import uvicorn
    from starlette.types import ASGIApp

    from course.sandbox.scene.loading import Chosen
    from course.sandbox.scene.model import Scene
    from course.sandbox.scene.predicting import Comparison
    from course.sandbox.world.world import World

__all__ = ["play"]

#: This machine alone.
_LOOPBACK = "127.0.0.1"


def play(
    world: World,
    scene: Scene,
    *,
    port: int = 0,
    open_browser: bool = True,
    say: Callable[[str], None],
    chosen: Chosen | None = None,
    guess: float | None = None,
    keep: Callable[[Comparison], None] | None = None,
) -> None:
    """Serve a world until Ctrl+C.

    Args:
        world: before its first step, with a receipt.
        scene: of the world.
        port: 0 for any that is free.
        open_browser: show the page; else only say where it is.
        say: takes lines for the user.
        chosen: the scene with the parameters that went into it; with their defaults if left out.
        guess: an answer to the scene's question; the page asks for one if there is none.
        keep: called with each comparison that has a guess.

    Raises:
        MissingCapabilityError: the extra ``web`` is not installed.
        UsageError: the port is taken.
    """
    require("web")
    import uvicorn

    from course.sandbox.views.web.app import make_app
    from course.sandbox.views.web.session import Session

    session = Session(world, chosen or _as_it_is(scene), guess=guess, keep=keep)
    failures: list[BaseException] = []

    def failed(error: BaseException) -> None:
        failures.append(error)
        server.should_exit = True

    with contextlib.closing(_listener(port)) as listener:
        number = listener.getsockname()[1]
        token = secrets.token_urlsafe(24)
        address = f"http://{_LOOPBACK}:{number}/{token}/"
        app = make_app(
            session, number, token, ready=lambda: _invite(address, say, show=open_browser), failed=failed
        )
        server = uvicorn.Server(_configured(app))
        with contextlib.suppress(KeyboardInterrupt):
            server.run(sockets=[listener])
    if failures:
        raise failures[0]


def _configured(app: ASGIApp) -> uvicorn.Config:
    """A server for one user: it says nothing, and takes no message larger than what is answered."""
    import uvicorn

    from course.sandbox.views.web.messages import MAX_REQUEST

    return uvicorn.Config(
        app,
        log_config=None,
        log_level="critical",
        access_log=False,
        ws="websockets-sansio",
        # A little above what is answered: what is beyond this ends the connection.
        ws_max_size=4 * MAX_REQUEST,
        ws_max_queue=16,
        ws_per_message_deflate=False,
        limit_concurrency=64,
        timeout_graceful_shutdown=1,
        proxy_headers=False,
        server_header=False,
    )


def _invite(address: str, say: Callable[[str], None], *, show: bool) -> None:
    say(f"The world is at {address}")
    invite(address, say, show=show)


def _listener(port: int) -> socket.socket:
    """A socket on the loopback interface.

    Raises:
        UsageError: the port is taken, or is none.
    """
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((_LOOPBACK, port))
        listener.listen(64)
    except (OSError, OverflowError) as error:
        listener.close()
        raise UsageError(
            f"Port {port} cannot be used: {getattr(error, 'strerror', None) or error}.",
            help="Leave --port out and a free one is taken.",
            code="bad_port",
        ) from error
    return listener


def _as_it_is(scene: Scene) -> Chosen:
    from course.sandbox.scene.loading import Chosen

    defaults = {parameter.name: parameter.default for parameter in scene.parameter}
    return Chosen(scene=scene, parameters=defaults, settings={}, path=Path(f"{scene.id}.toml"))
