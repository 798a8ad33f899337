"""The page of ``course grade similar``: one file, no script, nothing from elsewhere."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING

from course.isolation.failures import printable

if TYPE_CHECKING:
    from course.grading.similar import Document, Pair, Similar

__all__ = ["page"]

_STYLE = """
:root { color-scheme: light dark; }
body { font: 1rem/1.5 system-ui, sans-serif; margin: 1.5rem auto; max-width: 90rem; padding: 0 1rem; }
table { border-collapse: collapse; } th, td { border: 1px solid; padding: .25rem .6rem; text-align: left; }
td.number { text-align: right; }
details { border: 1px solid; margin: 1rem 0; padding: .5rem 1rem; } summary { cursor: pointer; }
.sides { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 28rem), 1fr)); gap: 1rem; }
pre { border: 1px solid; font-size: .85rem; margin: 0; overflow: auto; padding: .5rem; white-space: pre-wrap;
      overflow-wrap: anywhere; }
summary h2 { display: inline; font-size: 1.1rem; }
mark { background: #ffe08a; color: #000; } .line { user-select: none; }
@media print { details { break-before: page; } }
"""


def page(found: Similar) -> str:
    """The whole page."""
    rows = "".join(_row(number, pair) for number, pair in enumerate(found.pairs, 1))
    table = (
        "<table><caption>Pairs, the most alike first</caption><thead><tr><th scope='col'>Share</th>"
        "<th scope='col'>Exercise</th><th scope='col'>First</th><th scope='col'>Second</th>"
        f"<th scope='col'>Lines alike</th></tr></thead><tbody>{rows}</tbody></table>"
        if found.pairs
        else "<p>No two submissions are alike enough to be listed.</p>"
    )
    details = "".join(_details(number, pair) for number, pair in enumerate(found.pairs, 1))
    notes = ""
    if found.left_out:
        notes += f"<p>{found.left_out} more pairs are alike; raise --share or choose --exercise.</p>"
    if found.unreadable:
        listed = "".join(f"<li>{_text(entry)}</li>" for entry in found.unreadable)
        notes += f"<h2>Not compared: no Python</h2><ul>{listed}</ul>"
    return (
        "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>"
        "<meta name='viewport' content='width=device-width, initial-scale=1'>"
        "<meta http-equiv='Content-Security-Policy' "
        "content=\"default-src 'none'; style-src 'unsafe-inline'\">"
        f"<title>Similar submissions</title><style>{_STYLE}</style></head><body><main>"
        f"<h1>Similar submissions</h1><p>{found.compared} submissions were compared on this machine. Names, "
        "comments and layout do not count, nor does what the stub gave. A short exercise has few ways to be "
        "right: likeness is a reason to talk, not a finding.</p>"
        f"{table}{details}{notes}</main></body></html>\n"
    )


def _row(number: int, pair: Pair) -> str:
    return (
        f"<tr><td class='number'><a href='#pair-{number}'>{pair.share:.0%}</a></td>"
        f"<td>{_text(pair.exercise)}</td><td>{_text(pair.first.label)}</td>"
        f"<td>{_text(pair.second.label)}</td><td class='number'>{pair.lines}</td></tr>"
    )


def _details(number: int, pair: Pair) -> str:
    left = {line for (start, end), _ in pair.passages for line in range(start, end + 1)}
    right = {line for _, (start, end) in pair.passages for line in range(start, end + 1)}
    title = (
        f"{_text(pair.first.label)} and {_text(pair.second.label)}: {pair.share:.0%}, {_text(pair.exercise)}"
    )
    sides = _side(pair.first, left) + _side(pair.second, right)
    return (
        f"<details id='pair-{number}'><summary><h2>{title}</h2></summary>"
        f"<div class='sides'>{sides}</div></details>"
    )


def _side(document: Document, marked: set[int]) -> str:
    lines = []
    for number, line in enumerate(document.source.splitlines(), 1):
        shown = _text(line.expandtabs(4))
        shown = f"<mark>{shown}</mark>" if number in marked and shown.strip() else shown
        lines.append(f"<span class='line'>{number:4} </span>{shown}")
    body = "\n".join(lines)
    return (
        f"<section aria-label='{_text(document.label)}'><h3>{_text(document.label)}</h3>"
        f"<pre tabindex='0'>{body}</pre></section>"
    )


def _text(text: str) -> str:
    """Text as text: nothing in it is markup, steers, hides or reorders."""
    return html.escape(printable(text), quote=True)
