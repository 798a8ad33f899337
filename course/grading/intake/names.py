"""File names, and the spellings of them that are accepted without asking.

Letter case does not matter, nor does the number that a browser, Canvas or Windows adds to a second download.
Every such spelling is named in the result. Any other name is for triage.
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
