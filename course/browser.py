"""Opening a page or a picture in a window of its own, where there is a display for one.

Over ssh, in a container or in a terminal without a display nothing is tried: the course names the page or the
picture instead, and says how to get there.
"""

import contextlib
import os
import socket
import sys
import threading
from collections.abc import Callable
from urllib.parse import urlsplit

#: Browsers that run in this terminal: they would take it over, and draw no canvas.
_IN_TERMINAL = frozenset({"elinks", "links", "lynx", "w3m", "www-browser"})
_DISPLAYS = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")

_closed = False


def keep_closed() -> None:
    """Open nothing in this run."""
    global _closed  # noqa: PLW0603 - a wish about the whole process, as NO_COLOR is
    _closed = True


def can_open() -> bool:
    """Whether something here can show a page of the web or a picture in a window of its own."""
    if _closed:
        return False
    if any(os.environ.get(name) for name in _DISPLAYS):
        return True
    # A Mac or a PC has a screen, but a user who is logged in over ssh does not sit in front of it.
    return sys.platform in {"darwin", "win32"} and not over_ssh()


def over_ssh() -> bool:
    """Whether this is a session on another machine."""
    return bool(os.environ.get("SSH_CONNECTION") or os.environ.get("SSH_TTY"))


def opened(address: str) -> bool:
    """Show an address in a window, and say whether that was tried; False where there is no display."""
    if not can_open():
        return False
    import webbrowser  # a lesson opens without it, and it finds out what browsers there are

    with contextlib.suppress(webbrowser.Error, OSError):
        browser = webbrowser.get()
        if getattr(browser, "basename", "") not in _IN_TERMINAL:
            return browser.open(address)
    return False


def invite(address: str, say: Callable[[str], None], *, show: bool) -> None:
    """Show a page that this machine serves to itself until Ctrl+C; where nothing can, say how to get there.

    Args:
        say: takes lines for the user.
        show: open a browser, if there is one.
    """
    say("Only this machine's browser gets there, and only with the whole address. Ctrl+C ends it.")
    if show and can_open():
        # Starting a browser can take as long as it likes; the page is served meanwhile.
        threading.Thread(target=opened, args=(address,), daemon=True).start()
        return
    port = urlsplit(address).port
    say("From another machine, first forward the port, with the same number at both ends:")
    say(f"  ssh -N -L {port}:127.0.0.1:{port} {socket.gethostname()}")
