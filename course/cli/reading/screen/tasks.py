"""A student's progress with a warm-up or an exercise, in lines below its text."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import msgspec
from rich.text import Text

from course.cli.frame.console import STATUS_STYLE
from course.cli.reading.screen.practice import Standing
from course.cli.work.verdict import line_of, unread_line
from course.scoring.verdict import CheckResult, numbers_of

#: Lines of what a student's code printed: there is more to see on a screen than these.
_PRINTED = 4


def standing_lines(now: Standing, name: str, *, possible: bool) -> Iterator[Text]:
    """The next step, or the last check's result: the first fault, and how many there are.

    Args:
        name: its id.
        possible: there is a workspace to work in.
    """
    if not possible:
        yield Text.assemble(("$ ", "dim"), ("course init my-course", "bold cyan"), "   makes a place for it")
        return
    if not now.file:
        yield Text.assemble(("Enter", "bold"), " puts its file into your workspace")
        return
    yield Text.assemble(("Your file: ", "bold"), now.file)
    if now.busy:
        yield Text(f"{now.busy} …", style="dim")
    elif now.reply is None and now.done:
        yield Text("Done: every check passed.", style="bold green")
    elif now.reply is None:
        yield Text.assemble(
            ("e", "bold"), " changes it here, or save it in your own editor; ", ("r", "bold"), " checks it"
        )
    else:
        if now.fixed:
            yield Text.assemble(("Fixed: ", "bold green"), ", ".join(now.fixed))
        yield from _said(now.reply, name)
    if now.hint:
        yield Text(now.hint, style="italic")


def hint_is_named(now: Standing) -> bool:
    """Whether the last check named a hint as the next step: one is due."""
    return _names_hint(now.reply or {})


def _names_hint(reply: dict[str, Any]) -> bool:
    return _step(reply).startswith("course hint")


def line_to_mend(now: Standing, source: str) -> int:
    """The line that the first finding of the last check is about; the first line before one."""
    reply = now.reply or {}
    if "error" in reply:
        return unread_line(source)
    checks = msgspec.convert(reply.get("checks", ()), tuple[CheckResult, ...])
    first = next((check for check in checks if check.status != "pass"), None)
    return line_of(source, first) if first is not None else 1


def _said(reply: dict[str, Any], name: str) -> Iterator[Text]:
    if "error" in reply:
        yield Text(reply["error"]["message"], style="red")
        yield Text(reply["error"].get("help", ""))
        return
    checks = msgspec.convert(reply["checks"], tuple[CheckResult, ...])
    passing = sum(check.status == "pass" for check in checks)
    first = next((check for check in checks if check.status != "pass"), None)
    yield from _printed("Loading your file printed:", reply.get("printed"))
    if first is None:
        yield Text("Done: every check passes.", style="bold green")
        step = _step(reply)
        if step.startswith("course report"):
            yield Text.assemble(("$ ", "dim"), (step, "bold cyan"), "   shows what has changed")
        return
    word = str(first.status).upper()
    yield Text.assemble((f"{word}: ", STATUS_STYLE.get(str(first.status), "red")), (first.title, "bold"))
    for text in (first.message, first.help):
        if text:
            yield Text(text)
    for label, text in numbers_of(first):
        if label != "diagnosis":
            yield Text(f"{label}: {text}", style="dim")
    yield from _printed("Your code printed:", first.stdout)
    some = f"{passing} of {len(checks)} checks pass.  " if len(checks) > 1 else ""
    offer = f"course hint {name} or h: a hint" if _names_hint(reply) else ""
    if some or offer:
        yield Text(f"{some}{offer}".rstrip(), style="dim")


def _step(reply: dict[str, Any]) -> str:
    """The command that the reply names as the next."""
    return str((reply.get("next") or {}).get("command", ""))


def _printed(heading: str, text: str | None) -> Iterator[Text]:
    lines = (text or "").rstrip().splitlines()
    if lines:
        yield Text(heading, style="bold")
        yield from (Text(f"  {line}") for line in lines[:_PRINTED])
    if len(lines) > _PRINTED:
        yield Text("  … `course check --verbose` shows all", style="dim")
