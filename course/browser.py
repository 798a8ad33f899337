"""Opening a page or a picture in a window of its own, where there is a display for one.

Over ssh, in a container or in a terminal without a display nothing is tried: what would have been opened is
named instead, and how to get there.
"""

from __future__ import annotations

import contextlib
import os
import sys
import webbrowser

__all__ = ["can_open", "keep_closed", "opened", "over_ssh"]

#: Browsers that run in this terminal: they would take it over, and draw no canvas.
_IN_TERMINAL = frozenset({"elinks", "links", "lynx", "w3m", "www-browser"})
_DISPLAYS = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")

_closed = False


def keep_closed() -> None:
    """Open nothing in this run, whatever there is."""
    global _closed  # noqa: PLW0603 - a wish about the whole process, as NO_COLOR is
    _closed = True


def can_open() -> bool:
    """Whether something here can show a page of the web or a picture in a window of its own."""
    if _closed:
        return False
    if any(os.environ.get(name) for name in _DISPLAYS):
        return True
    # A Mac or a PC has a screen; who is logged in over ssh does not sit before it.
    return sys.platform in {"darwin", "win32"} and not over_ssh()


def over_ssh() -> bool:
    """Whether this is a session on another machine."""
    return bool(os.environ.get("SSH_CONNECTION") or os.environ.get("SSH_TTY"))


def opened(address: str) -> bool:
    """Show an address in a window, and say whether that was tried; False where there is no display."""
    if not can_open():
        return False
    with contextlib.suppress(webbrowser.Error, OSError):
        browser = webbrowser.get()
        if getattr(browser, "basename", "") not in _IN_TERMINAL:
            return browser.open(address)
    return False
