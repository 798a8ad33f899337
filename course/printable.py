"""Text of strangers as people may see it: it steers no terminal, hides nothing and turns nothing around.

Exception messages, names of folders, values and lines of code all come from submissions. Text that is shown
on one line goes through ``one_line``, so that a submission cannot add lines to a report, and a name within a
sentence through ``quoted``, so that it adds no sentence either.
"""

import os
import re
import shlex
from collections.abc import Iterable, Sequence

_UNUSUAL = re.compile(r"[^ -~]")
_UNUSUAL_IN_LINES = re.compile(r"[^\n\t -~]")
#: Control characters other than tab and newline; separators of lines; marks that turn the direction of text.
_STEERING = re.compile(
    r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028\u2029\u202a-\u202e\u2066-\u2069]"
)


def command(*words: object) -> str:
    """A command of the course as a sentence names it, ready to be pasted."""
    return f"`{shlex.join(['course', *map(str, words)])}`"


def counted(number: int, word: str) -> str:
    """A number and its noun, in the plural where it needs one: 1 step, 2,000 steps."""
    return f"{number:,} {word}{'' if number == 1 else 's'}"


def meant(typed: str, names: Iterable[str], otherwise: str = "") -> str:
    """Ask for a name that begins with what was typed, or looks like it; ``otherwise`` if there is none."""
    import difflib

    spelled = {name.lower().replace("_", "-"): name for name in names}
    typed = typed.lower().replace("_", "-")
    close = [name for name in spelled if typed and name.startswith(typed)]
    close += [name for name in difflib.get_close_matches(typed, spelled) if name not in close]
    return f"Did you mean {' or '.join(spelled[name] for name in close[:3])}?" if close else otherwise


def some(listed: Sequence[str], most: int) -> str:
    """The first of a list, and how many more there are: "a, b and 3 more"."""
    more = f" and {len(listed) - most} more" if len(listed) > most else ""
    return ", ".join(listed[:most]) + more


def ended(text: str) -> str:
    """A sentence with its full stop, unless it ends already: what Python says may be a question."""
    text = text.rstrip(" .")
    return text if text.endswith(("?", "!")) else f"{text}."


def beginning(text: str, most: int) -> str:
    """At most ``most`` characters of a text, in whole lines, and how much was left out."""
    if len(text) <= most:
        return text
    kept = text[: text.rfind("\n", 0, most) + 1] or text[:most] + "\n"
    return f"{kept}... ({counted(text[len(kept) :].rstrip().count(chr(10)) + 1, 'more line')} left out)"


def one_line(text: str, limit: int | None = None) -> str:
    """At most ``limit`` characters on one line, those that are not printable spelled out."""
    if text.isprintable():
        return text[:limit]
    return _UNUSUAL.sub(_spelled_out, text[:limit])[:limit]


def quoted(name: str) -> str:
    """A stranger's name within a sentence of ours, of which it must not look a part: in quotes, on one line.

    Of more than 80 characters the middle is left out.
    """
    return repr(name if len(name) <= 80 else f"{name[:57]}...{name[-20:]}")


def printable(text: str) -> str:
    """Text that is shown as lines of its own: line ends and tabs stay; else as ``one_line``."""
    return _UNUSUAL_IN_LINES.sub(_spelled_out, text)


def steady(text: str) -> str:
    """Any text, our own too: only characters that control or reverse the text around them are spelled out."""
    return _STEERING.sub(_escaped, text)


def unheeded(text: str) -> str:
    """Text as it may stand in the log of a workflow on GitHub, which obeys what it reads there.

    The runner takes ``::command::`` at the beginning of a line and ``##[command]`` anywhere in one for a word
    to itself (TryParseV2 and TryParse in actions/runner, src/Runner.Common/ActionCommand.cs). One
    such line forges an annotation, or stops all that follow. Elsewhere the text is as it was.
    """
    if os.environ.get("GITHUB_ACTIONS") != "true":
        return text
    return text.replace("##[", "## [").replace("::", ": :")


def _spelled_out(match: re.Match[str]) -> str:
    return match[0] if match[0].isprintable() else _escaped(match)


def _escaped(match: re.Match[str]) -> str:
    return match[0].encode("unicode_escape").decode("ascii")
