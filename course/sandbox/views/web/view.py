"""The view in a browser: a page on this machine, and the world behind it.

It needs the packages of the extra ``web``: whoever imports it has asked for them.
"""

import asyncio
import contextlib
import hmac
import secrets
import socket
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path

import anyio
import uvicorn
from starlette.applications import Starlette
from starlette.datastructures import MutableHeaders
from starlette.requests import Request
from starlette.responses import FileResponse, PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from course.browser import invite
from course.errors import UsageError
from course.extras import require
from course.sandbox.scene.loading import Chosen
from course.sandbox.views.stage import Desk
from course.sandbox.views.web.session import MAX_REQUEST, SCRIPTS, Page, Session

#: This machine alone.
_LOOPBACK = "127.0.0.1"


def play(
    chosen: Chosen | None,
    desk: Desk | None = None,
    *,
    port: int = 0,
    open_browser: bool = True,
    say: Callable[[str], None],
    guess: float | None = None,
) -> bytes:
    """Serve a scene until Ctrl+C.

    Args:
        chosen: the scene with the parameters that go into it; None to begin with the gallery.
        port: 0 for any that is free.
        open_browser: show the page; else only say where it is.
        say: takes lines for the user.
        guess: an answer to the scene's question.

    Returns:
        the recording of what was played last.

    Raises:
        MissingCapabilityError: the extra ``web`` is not installed.
        UsageError: the port is taken.
    """
    require("web")
    desk = desk or Desk()
    stage = None if chosen is None else desk.stage(chosen, guess=guess)
    session = Session(stage, desk)
    failures: list[BaseException] = []

    def failed(error: BaseException) -> None:
        failures.append(error)
        server.should_exit = True

    def ready() -> None:
        say(f"The world is at {address}")
        invite(address, say, show=open_browser)

    with contextlib.closing(_listener(port)) as listener:
        number = listener.getsockname()[1]
        token = secrets.token_urlsafe(24)
        address = f"http://{_LOOPBACK}:{number}/{token}/"
        app = make_app(session, number, token, ready=ready, failed=failed)
        server = uvicorn.Server(_configured(app))
        with contextlib.suppress(KeyboardInterrupt):
            server.run(sockets=[listener])
    if failures:
        raise failures[0]
    return session.stage.recording.encode()


def _configured(app: ASGIApp) -> uvicorn.Config:
    """A server for one user: it says nothing, and takes no message larger than what is answered."""
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
        why = getattr(error, "strerror", None) or "ports are numbers from 0 to 65535"
        raise UsageError(
            f"Port {port} cannot be used: {why}.",
            help="Leave --port out and a free one is taken.",
            code="bad_port",
        ) from error
    return listener


# ---
# What is served, and to whom: only to this machine's own browser, from a page of ours, with the token.
#
# A page elsewhere can make a browser send requests here, by a link, a form, a script, a WebSocket, or by a
# name that it lets point to 127.0.0.1. So every request must name this server as its host, come from no other
# origin, and have a token in its path that no other page can read.


STATIC = Path(__file__).parent / "static"
#: All files that can be fetched; a path is looked up here and never joined to a folder.
_FILES = {
    "": ("index.html", "text/html"),
    **{f"{name}.js": (f"{name}.js", "text/javascript") for name in SCRIPTS},
    "page.js": ("page.js", "text/javascript"),
    "style.css": ("style.css", "text/css"),
    "icon.svg": ("icon.svg", "image/svg+xml"),
}
#: Too many pages: "try again later".
_FULL = 1013
#: A page broke the rules or cannot keep up.
_BEHIND = 1008


def _headers(host: str) -> dict[str, str]:
    """The headers of every answer: it loads nothing from elsewhere; no other page may frame or read it."""
    policy = {
        "default-src": "'none'",
        "script-src": "'self'",
        "style-src": "'self'",
        "img-src": "'self'",
        # Not every browser takes 'self' to mean the socket as well.
        "connect-src": f"'self' ws://{host}",
        "base-uri": "'none'",
        "form-action": "'none'",
        "frame-ancestors": "'none'",
        "require-trusted-types-for": "'script'",
    }
    return {
        "content-security-policy": "; ".join(f"{key} {value}" for key, value in policy.items()),
        "cache-control": "no-store",
        "cross-origin-opener-policy": "same-origin",
        "cross-origin-resource-policy": "same-origin",
        "permissions-policy": "camera=(), geolocation=(), microphone=()",
        "referrer-policy": "no-referrer",
        "x-content-type-options": "nosniff",
        "x-frame-options": "DENY",
    }


class Guard:
    """Lets only requests through that a page of this server can have made.

    Args:
        port: of the server.
        token: first part of every path.
    """

    def __init__(self, app: ASGIApp, port: int, token: str) -> None:
        self._app = app
        self._hosts = {f"127.0.0.1:{port}", f"localhost:{port}"}
        self._token = token.encode()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, pass on or refuse one request."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        status = self._verdict(scope)
        if scope["type"] == "websocket":
            if status != 200:
                await receive()
                await send({"type": "websocket.close", "code": 1008, "reason": "refused"})
                return
            await self._app(scope, receive, send)
            return
        host = self._header(scope, b"host") if status == 200 else "127.0.0.1"
        extra = _headers(host or "")

        async def sealed(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(extra)
            await send(message)

        if status == 200:
            await self._app(scope, receive, sealed)
        else:
            await PlainTextResponse("Refused.\n", status)(scope, receive, sealed)

    def _verdict(self, scope: Scope) -> int:
        """200, or the status to refuse with."""
        host = self._header(scope, b"host")
        if host is None or host not in self._hosts:
            return 421
        if scope["type"] == "http" and scope["method"] not in {"GET", "HEAD"}:
            return 405
        if not self._from_here(scope, f"http://{host}"):
            return 403
        given = scope["path"].encode("utf-8", "replace").split(b"/", 2)[1:2]
        return 200 if given and hmac.compare_digest(given[0], self._token) else 404

    def _from_here(self, scope: Scope, own: str) -> bool:
        """Whether a page of this origin asks, or the user followed the address."""
        # Browsers always send it with a socket, and a script elsewhere cannot leave it out.
        named = scope["type"] == "websocket" or any(key == b"origin" for key, _ in scope["headers"])
        if named and self._header(scope, b"origin") != own:
            return False
        site, mode = self._header(scope, b"sec-fetch-site"), self._header(scope, b"sec-fetch-mode")
        return site in {None, "none", "same-origin"} or mode == "navigate"

    @staticmethod
    def _header(scope: Scope, name: bytes) -> str | None:
        """A header that occurs once; one that occurs twice counts as missing."""
        found = [value for key, value in scope["headers"] if key == name]
        return found[0].decode("latin-1").lower() if len(found) == 1 else None


def make_app(
    session: Session,
    port: int,
    token: str,
    *,
    ready: Callable[[], None] | None = None,
    failed: Callable[[BaseException], None] | None = None,
) -> ASGIApp:
    """The whole server of one world.

    Args:
        token: what the address must contain.
        ready: called once the world runs.
        failed: called if it cannot go on.
    """

    def ended(task: asyncio.Task[None]) -> None:
        error = None if task.cancelled() else task.exception()
        if error is not None and failed is not None:
            failed(error)

    @contextlib.asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        task = asyncio.create_task(session.run())
        task.add_done_callback(ended)
        if ready is not None:
            ready()
        try:
            yield
        finally:
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)

    async def socket(websocket: WebSocket) -> None:
        page = session.join()
        if page is None:
            await websocket.accept()
            await websocket.close(_FULL, "Too many pages look at this world.")
            return
        try:
            await websocket.accept()
            await _serve(websocket, session, page)
        finally:
            session.leave(page)

    files = [Route(f"/{token}/{name}", _file(*of), methods=["GET"]) for name, of in _FILES.items()]
    routes = [*files, WebSocketRoute(f"/{token}/socket", socket)]
    return Guard(Starlette(routes=routes, lifespan=lifespan), port, token)


def _file(name: str, kind: str) -> Callable[[Request], Response]:
    def fetch(_: Request) -> Response:
        return FileResponse(STATIC / name, media_type=kind)

    return fetch


async def _serve(websocket: WebSocket, session: Session, page: Page) -> None:
    """Talk to one page until it leaves, or is too far behind, or the server stops."""

    async def until_done(talk: Awaitable[None]) -> None:
        # Pages often leave in the middle of a message.
        with contextlib.suppress(WebSocketDisconnect, OSError):
            await talk
        both.cancel_scope.cancel()

    async with anyio.create_task_group() as both:
        both.start_soon(until_done, _listen(websocket, session, page))
        both.start_soon(until_done, _speak(websocket, page))
    if page.lost and websocket.application_state is WebSocketState.CONNECTED:
        with contextlib.suppress(RuntimeError, WebSocketDisconnect, OSError):
            await websocket.close(_BEHIND, "Too far behind, or too many requests.")


async def _listen(websocket: WebSocket, session: Session, page: Page) -> None:
    while True:
        message = await websocket.receive()
        if message["type"] == "websocket.disconnect":
            return
        session.receive(page, message.get("text") or message.get("bytes") or b"")


async def _speak(websocket: WebSocket, page: Page) -> None:
    while (data := await page.fetch()) is not None:
        if isinstance(data, str):
            await websocket.send_text(data)
        else:
            await websocket.send_bytes(data)
