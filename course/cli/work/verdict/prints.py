"""The student's printed output, which many use to find a mistake; shown in full only on request."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from course.cli.frame.terminal.console import Console
    from course.scoring.verdict import Verdict

__all__ = ["show_lines", "show_loading", "show_unshown"]

#: Lines that are shown by default: as many as leave room for the finding on 24 lines.
_MOST = 6
_INDENT = 2


def show_lines(console: Console, heading: str, text: str, *, whole: bool, indent: int = 0) -> None:
    """The first printed lines, and how many more there are."""
    lines = text.rstrip().splitlines()
    if not lines:
        return
    kept = lines if whole else lines[:_MOST]
    console.line(heading, indent=indent)
    console.block("\n".join(kept), indent=indent + _INDENT)
    if len(kept) < len(lines):
        left = len(lines) - len(kept)
        more = f"and {left} more {'line' if left == 1 else 'lines'}; --verbose shows all"
        console.line((more, "dim"), indent=indent + _INDENT)


def show_loading(console: Console, printed: str, *, whole: bool) -> None:
    """Show a file's output while it was loaded, if any."""
    if printed and not console.quiet:
        show_lines(console, "Loading your file printed:", printed, whole=whole)
        if console.fancy:
            console.blank()


def show_unshown(console: Console, verdict: Verdict) -> None:
    """Say that passing checks printed something."""
    count = sum(1 for check in verdict.checks if check.status == "pass" and check.stdout)
    if count:
        what = "a check that passes" if count == 1 else f"{count} checks that pass"
        console.note((f"Your code printed in {what}; --verbose shows it.", "dim"))
