"""File names, and the names they were meant to be: spellings that are accepted without asking.

Letter case, and the number that a browser, Canvas or Windows adds to a second download, change nothing about
what a file is. Every such spelling is named in the result. What is called otherwise is for triage.
"""

from __future__ import annotations

import re
import unicodedata

__all__ = ["is_meant", "plain"]

_NUMBERED = re.compile(r"(?:\s*\([0-9]{1,3}\)|-[0-9]{1,3})+$")


def plain(name: str) -> str:
    """A file's name without letter case, and without the number of a copy: ``Name (2).py`` is ``name.py``."""
    stem, dot, suffix = unicodedata.normalize("NFC", name).rpartition(".")
    return (_NUMBERED.sub("", stem) + dot + suffix.rstrip()).casefold()


def is_meant(name: str, wanted: str) -> bool:
    """Whether a file of this name is the wanted one."""
    return name == wanted or plain(name) == wanted.casefold()
