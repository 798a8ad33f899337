"""The page's server: who gets in, and what it says."""

import asyncio
import contextlib
import importlib.util
import json
import re
import socket

import numpy as np
import pytest

pytest.importorskip("starlette", reason="the extra `web` is not installed")
pytest.importorskip("httpx2", reason="starlette's test client needs httpx2")

from hypothesis import given, settings
from hypothesis import strategies as st
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from course.errors import MissingCapabilityError, UsageError
from course.sandbox.runs.tape import HEAD
from course.sandbox.scene.loading import choose
from course.sandbox.views.stage import Stage
from course.sandbox.views.web import view as web
from course.sandbox.views.web.session import MAX_PAGES, SCRIPTS, Session
from course.sandbox.views.web.view import STATIC, Guard, make_app

PORT, TOKEN = 8765, "a-token-of-some-length"
BASE = f"http://127.0.0.1:{PORT}"
SOCKET = f"ws://127.0.0.1:{PORT}/{TOKEN}/socket"
OWN = {"origin": BASE}
FILES = ("", *(f"{name}.js" for name in SCRIPTS), "page.js", "style.css", "icon.svg")


def session(name="restitution-row"):
    return Session(Stage(choose(name)))


@pytest.fixture(scope="module")
def client():
    with TestClient(make_app(session(), PORT, TOKEN), base_url=BASE) as made:
        yield made


def answer(*headers, path=f"/{TOKEN}/", method="GET", kind="http"):
    """The status that the guard alone gives a request with exactly these headers."""

    async def inside(scope, receive, send):
        start = {"http": "http.response.start", "websocket": "websocket.accept"}[scope["type"]]
        await send({"type": start, "status": 200, "headers": []})

    async def receive():
        return {"type": f"{kind}.connect"}

    sent = []

    async def send(message):
        sent.append(message)

    scope = {
        "type": kind,
        "method": method,
        "path": path,
        "query_string": b"",
        "headers": [(key.encode(), value.encode("latin-1")) for key, value in headers],
    }
    asyncio.run(Guard(inside, PORT, TOKEN)(scope, receive, send))
    if kind == "websocket":
        return 200 if sent[0]["type"] == "websocket.accept" else 403
    return sent[0]["status"]


HOST = ("host", f"127.0.0.1:{PORT}")


# -- who gets in -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", FILES)
def test_every_file_is_served_to_whoever_has_the_token_and_loads_nothing_from_elsewhere(client, name):
    got = client.get(f"/{TOKEN}/{name}")
    assert got.status_code == 200
    assert got.content == (STATIC / (name or "index.html")).read_bytes()
    rules = dict(rule.split(" ", 1) for rule in got.headers["content-security-policy"].split("; "))
    assert rules["default-src"] == "'none'"
    assert rules["script-src"] == rules["style-src"] == rules["img-src"] == "'self'"
    assert rules["connect-src"] == f"'self' ws://127.0.0.1:{PORT}"
    assert rules["frame-ancestors"] == rules["base-uri"] == rules["form-action"] == "'none'"
    assert got.headers["referrer-policy"] == "no-referrer"
    assert got.headers["x-content-type-options"] == "nosniff"
    assert got.headers["cache-control"] == "no-store"
    assert "set-cookie" not in got.headers
    outside = re.findall(r"(?:https?:)?//[a-z0-9.-]+\.[a-z]+\S*", got.text)
    assert [found for found in outside if found != 'http://www.w3.org/2000/svg"'] == []


@pytest.mark.parametrize(
    "path",
    [
        "/",
        "/wrong/",
        f"/{TOKEN}",
        f"/{TOKEN}x/",
        f"/x{TOKEN}/",
        f"/{TOKEN.upper()}/",
        "/world.js",
        "//",
        f"//{TOKEN}/",
    ],
)
def test_without_the_token_there_is_nothing(client, path):
    got = client.get(BASE + path, follow_redirects=False)
    assert got.status_code in ({404, 307} if path == f"/{TOKEN}" else {404})
    assert TOKEN not in got.text
    address = f"ws://127.0.0.1:{PORT}{path}socket"
    with pytest.raises(WebSocketDisconnect), client.websocket_connect(address, headers=OWN):
        pass


@pytest.mark.parametrize(
    "path", ["../web.py", "..%2fweb.py", "%2e%2e/web.py", "world.js/", "index.html", "static"]
)
def test_only_the_files_of_the_list_are_served(client, path):
    assert client.get(f"/{TOKEN}/{path}", follow_redirects=False).status_code in {404, 307}


@pytest.mark.parametrize(
    "host",
    [
        "evil.example",
        f"evil.example:{PORT}",
        "127.0.0.1",
        f"127.0.0.1:{PORT + 1}",
        f"127.0.0.1.evil.example:{PORT}",
        f"127.0.0.1:{PORT}.evil.example",
        f"0.0.0.0:{PORT}",
        f"[::1]:{PORT}",
        "",
    ],
)
def test_another_name_for_this_machine_is_refused(client, host):
    """A page elsewhere may let its own name point here; the browser then sends that name."""
    assert client.get(f"/{TOKEN}/", headers={"host": host}).status_code == 421
    with pytest.raises(WebSocketDisconnect), client.websocket_connect(SOCKET, headers={**OWN, "host": host}):
        pass


def test_no_host_or_two_of_them_are_refused():
    assert answer(HOST) == 200
    assert answer() == 421
    assert answer(HOST, HOST) == 421
    assert answer(HOST, ("host", "evil.example")) == 421


@pytest.mark.parametrize(
    "headers",
    [
        {},
        {"origin": "null"},
        {"origin": "http://evil.example"},
        {"origin": f"https://127.0.0.1:{PORT}"},
        {"origin": f"http://127.0.0.1:{PORT + 1}"},
        {"origin": f"http://localhost:{PORT}"},
        {"origin": ""},
        {**OWN, "sec-fetch-site": "cross-site"},
        {**OWN, "sec-fetch-site": "same-site"},
    ],
)
def test_a_socket_from_any_other_page_is_refused(client, headers):
    with pytest.raises(WebSocketDisconnect), client.websocket_connect(SOCKET, headers=headers):
        pass


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"origin": "http://evil.example"}, 403),
        ({"sec-fetch-site": "cross-site", "sec-fetch-mode": "no-cors"}, 403),
        (
            {"sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate"},
            200,
        ),  # a click on the address
    ],
)
def test_another_pages_script_gets_nothing(client, headers, status):
    assert client.get(f"/{TOKEN}/world.js", headers=headers).status_code == status


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE"])
def test_there_is_nothing_to_send_to(client, method):
    assert client.request(method, f"/{TOKEN}/").status_code == 405


@settings(max_examples=150)
@given(
    headers=st.lists(
        st.tuples(
            st.sampled_from(["host", "origin", "sec-fetch-site", "sec-fetch-mode", "cookie"]),
            st.sampled_from(
                [HOST[1], BASE, "null", "evil.example", "cross-site", "navigate", "none", "\xff"]
            ),
        ),
        max_size=5,
    ),
    path=st.one_of(st.just(f"/{TOKEN}/socket"), st.text(max_size=30).map(lambda text: "/" + text)),
    kind=st.sampled_from(["http", "websocket"]),
)
def test_whatever_is_sent_only_this_host_this_origin_and_this_token_get_in(headers, path, kind):
    hosts = [value for key, value in headers if key == "host"]
    origins = [value for key, value in headers if key == "origin"]
    if answer(*headers, path=path, kind=kind) == 200:
        assert hosts == [HOST[1]]
        assert origins == [BASE] or (kind == "http" and origins == [])
        assert path.startswith(f"/{TOKEN}/")


def test_the_guard_alone_knows_the_whole_token_and_the_methods():
    """What stands behind it would refuse as well; neither leans on the other."""
    assert answer(HOST, path=f"/{TOKEN}/anything") == 200
    for near in (TOKEN + "x", TOKEN[:-1], TOKEN[:-1] + "x", "", "é" * len(TOKEN)):
        assert answer(HOST, path=f"/{near}/") == 404
    assert answer(HOST, method="POST") == 405
    assert answer(HOST, ("origin", BASE), ("origin", BASE)) == 403


# -- what it says ----------------------------------------------------------------------------------------


def receive(socket):
    message = socket.receive()
    if message.get("text"):
        return json.loads(message["text"])
    return np.frombuffer(message["bytes"], "<f4")


def test_a_page_is_told_everything_it_needs_to_draw():
    made = session()
    made.stage.world.throw(3, 1, 3.0, -4.0, reach=5.0)
    made.stage.world.paused = True  # the frame is compared with the world a moment later
    with (
        TestClient(make_app(made, PORT, TOKEN), base_url=BASE) as client,
        client.websocket_connect(SOCKET, headers=OWN) as open_socket,
    ):
        scene, bodies = receive(open_socket), receive(open_socket)
        past, frame = receive(open_socket), receive(open_socket)
        assert scene["title"] == "A row of restitutions"
        assert {knob["name"] for knob in scene["knobs"]} == {
            "gravity",
            "restitution",
            "friction",
            "step",
            "iterations",
            "walls",
        }
        assert [body["name"] for body in bodies["bodies"]] == [part.name for part in made.stage.world.parts]
        assert past[0] == 3
        while isinstance(frame, dict):
            frame = receive(open_socket)
        shot, receipt = made.stage.world.snapshot(), made.stage.world.receipt
        assert frame[0] == 1
        assert len(frame) == HEAD + 5 * len(shot.x) + 4 * len(shot.joints)
        rows = frame[HEAD : HEAD + 5 * len(shot.x)].reshape(-1, 5)
        np.testing.assert_allclose(
            rows, np.stack([shot.x, shot.y, shot.angle, shot.vx, shot.vy], axis=1), rtol=1e-6
        )
        assert frame[12] == pytest.approx(receipt.potential, rel=1e-6)


def test_malformed_requests_are_answered_and_the_socket_stays_open():
    made = session()
    with (
        TestClient(make_app(made, PORT, TOKEN), base_url=BASE) as client,
        client.websocket_connect(SOCKET, headers=OWN) as open_socket,
    ):
        open_socket.send_text("{")
        open_socket.send_bytes(b"\xff\x00")
        open_socket.send_text('{"do": "set", "key": "gravity", "value": -1}')
        open_socket.send_text("x" * 2000)
        errors = []
        for _ in range(20):
            message = receive(open_socket)
            if isinstance(message, dict) and message["type"] == "error":
                errors.append(message["message"])
            if len(errors) == 4:
                break
        assert "1024 bytes" in errors[3]
        assert "gravity must be" in errors[2]
        open_socket.send_text('{"do": "pause", "on": false}')
        message = {}
        while not (isinstance(message, np.ndarray) and message[0] == 1 and message[2] > 0):
            message = receive(open_socket)


def test_too_many_pages_are_sent_away():
    made = session()
    with TestClient(make_app(made, PORT, TOKEN), base_url=BASE) as client, contextlib.ExitStack() as stack:
        for _ in range(MAX_PAGES):
            stack.enter_context(client.websocket_connect(SOCKET, headers=OWN)).receive()
        with (
            client.websocket_connect(SOCKET, headers=OWN) as one_more,
            pytest.raises(WebSocketDisconnect) as caught,
        ):
            one_more.receive_text()
        assert caught.value.code == 1013


# -- play ------------------------------------------------------------------------------------------------


def test_without_the_extra_it_says_what_to_install(monkeypatch):
    chosen = choose("head-on")
    lines = ["numpy>=2", 'starlette>=7.5; extra == "web"', 'uvicorn<9,>=8; extra == "web"']
    monkeypatch.setattr("importlib.metadata.requires", lambda name: lines)
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(MissingCapabilityError) as caught:
        web.play(chosen, say=print)
    assert "starlette, uvicorn and websockets" in caught.value.message
    assert caught.value.help.endswith("pip install 'starlette>=7.5' 'uvicorn<9,>=8' 'websockets'")


def test_it_listens_on_this_machine_only_and_a_port_that_is_taken_is_said():
    with contextlib.closing(web._listener(0)) as listener:
        assert listener.getsockname()[0] == "127.0.0.1"
        with socket.socket() as other:
            other.bind(("127.0.0.1", 0))
            other.listen()
            with pytest.raises(UsageError, match="cannot be used"):
                web._listener(other.getsockname()[1])
    for wrong in (-1, 70000):
        with pytest.raises(UsageError, match="cannot be used"):
            web._listener(wrong)
