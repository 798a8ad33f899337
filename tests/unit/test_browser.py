"""Nothing is opened where there is no display, and what would have been opened is named."""

import webbrowser

import pytest

from course import browser


class Stand:
    """A browser that notes what it is asked to show."""

    def __init__(self, basename):
        self.basename = basename
        self.shown = []

    def open(self, address):
        self.shown.append(address)
        return True


@pytest.fixture
def stand(monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER", "SSH_CONNECTION", "SSH_TTY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(browser, "_closed", False)
    found = Stand("firefox")
    monkeypatch.setattr(webbrowser, "get", lambda: found)
    return found


@pytest.mark.parametrize(
    ("platform", "environment", "can"),
    [
        ("linux", {}, False),
        ("linux", {"DISPLAY": ":0"}, True),
        ("linux", {"WAYLAND_DISPLAY": "wayland-0"}, True),
        ("linux", {"BROWSER": "firefox"}, True),
        ("darwin", {}, True),
        ("win32", {}, True),
        ("darwin", {"SSH_CONNECTION": "10.0.0.1 1 10.0.0.2 22"}, False),
        ("win32", {"SSH_TTY": "/dev/pts/0"}, False),
        ("linux", {"SSH_CONNECTION": "10.0.0.1 1 10.0.0.2 22", "DISPLAY": "localhost:10"}, True),
    ],
)
def test_a_page_is_opened_where_there_is_a_display(stand, monkeypatch, platform, environment, can):
    monkeypatch.setattr("sys.platform", platform)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    assert browser.opened("http://127.0.0.1:1/") is can
    assert bool(stand.shown) is can


def test_a_browser_inside_the_terminal_is_not_started(stand, monkeypatch):
    monkeypatch.setenv("BROWSER", "w3m")
    stand.basename = "w3m"
    assert not browser.opened("http://127.0.0.1:1/")
    assert not stand.shown


def test_no_browser_keeps_everything_closed(stand, monkeypatch):
    monkeypatch.setenv("DISPLAY", ":0")
    browser.keep_closed()
    assert not browser.opened("http://127.0.0.1:1/")


def test_a_browser_that_does_not_start_is_no_error(stand, monkeypatch):
    monkeypatch.setenv("DISPLAY", ":0")

    def fails():
        raise webbrowser.Error("none")

    monkeypatch.setattr(webbrowser, "get", fails)
    assert not browser.opened("http://127.0.0.1:1/")


@pytest.mark.parametrize(("show", "display"), [(False, ":0"), (True, "")])
def test_how_to_forward_a_port_is_said_where_nothing_is_opened(stand, monkeypatch, show, display):
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("DISPLAY", display)
    said = []
    browser.invite("http://127.0.0.1:4321/token/", said.append, show=show)
    assert "ssh -N -L 4321:127.0.0.1:4321" in said[-1]
    assert not stand.shown
