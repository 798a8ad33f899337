"""HTML by construction: whatever is not markup already is escaped when it becomes a child or an attribute."""

from __future__ import annotations

import base64
import hashlib
import html
import re
from functools import cache, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Final

from course.printable import one_line

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = [
    "MARKER", "Heading", "Html", "joined", "name_of", "page", "paragraphs", "prose", "region_table", "script",
    "shortened", "tag", "text",
]  # fmt: skip

#: Words of a column; with a class where it is a pair.
Heading = str | tuple[str, str]

#: Begins every page; what does not begin so is not ours to replace.
MARKER: Final = "<!DOCTYPE html>\n<!-- course grade -->\n"
_VOID = frozenset({"br", "hr", "img", "input", "link", "meta", "rect", "line", "path"})
#: Nothing that means something to HTML is left when this is looked for.
_CODE = re.compile(r"`([^`\n]{1,200})`")
_HERE = Path(__file__).parent
#: Characters of a name that are shown: a folder may be called anything.
_LONGEST_NAME = 120
#: Characters up to which a text is likely to come again.
_OFTEN = 120


class Html(str):
    """Text that is markup: it is not escaped again."""

    __slots__ = ()


def text(value: str) -> Html:
    """Text as text: nothing in it is markup, steers, hides or reorders; line breaks stay."""
    return _escaped_again(value) if len(value) <= _OFTEN else _escaped(value)


def _escaped(value: str) -> Html:
    if not value.isprintable():
        value = "\n".join(map(one_line, value.split("\n")))
    return Html(html.escape(value, quote=True))


#: The same few hundred titles and words stand on every student's page.
_escaped_again = lru_cache(maxsize=8192)(_escaped)


def shortened(value: str, longest: int) -> str:
    """The text, cut where it is longer than anybody reads."""
    return value if len(value) <= longest else value[:longest].rstrip() + "…"


def name_of(student: str) -> Html:
    """A name on one line, isolated so that one written from right to left does not turn its surroundings."""
    return Html(f"<bdi>{text(one_line(shortened(student, _LONGEST_NAME)))}</bdi>")


def tag(name: str, /, *children: str, **attributes: str | float | bool | None) -> Html:
    """An element. ``class_`` stands for class, ``aria_label`` for aria-label; None leaves one out."""
    written = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{_attribute(value)}"'
        for key, value in attributes.items()
        if value is not None and value is not False
    )
    if name in _VOID:
        return Html(f"<{name}{written}>" if name not in {"rect", "line", "path"} else f"<{name}{written}/>")
    inner = "".join(child if isinstance(child, Html) else text(child) for child in children)
    return Html(f"<{name}{written}>{inner}</{name}>")


def _attribute(value: str | float | bool) -> str:
    if value is True:
        return ""
    if isinstance(value, str):
        return text(value)
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def joined(parts: Iterable[Html]) -> Html:
    """Markup one after the other."""
    return Html("".join(parts))


def prose(value: str, longest: int = 2000) -> Html:
    """A sentence of ours, in which `code` stands between backquotes; whatever it quotes is text."""
    return Html(_CODE.sub(r"<code>\1</code>", text(shortened(value.strip(), longest))))


def paragraphs(value: str) -> Html:
    """Words of several lines: one paragraph, line breaks kept by the style sheet; nothing for no words."""
    return tag("p", prose(value), class_="words") if value.strip() else Html("")


def region_table(
    caption: str,
    headings: Iterable[Heading],
    rows: Iterable[Html],
    *,
    sortable: bool = False,
    filtered: str | None = None,
) -> Html:
    """A table in a region of its own that scrolls where it is wider than the screen.

    Args:
        headings: of the columns.
        filtered: label of a field that filters the rows, where scripts run.
    """
    pairs = [heading if isinstance(heading, tuple) else (heading, "") for heading in headings]
    head = joined(tag("th", words, scope="col", class_=kind or None) for words, kind in pairs)
    table = tag(
        "table",
        tag("caption", caption),
        tag("thead", tag("tr", head)),
        tag("tbody", joined(rows)),
        data_sortable=sortable or None,
        data_filter=filtered,
    )
    return tag("div", table, class_="scroll", role="region", aria_label=caption, tabindex="0")


@cache
def script() -> str:
    """What sorts and filters tables, where scripts run; everything is there without it."""
    return (_HERE / "tables.js").read_text("utf-8")


@cache
def _style(more: str) -> str:
    lines = [*(_HERE / "page.css").read_text("utf-8").splitlines(), *more.splitlines()]
    return "\n".join(line.strip() for line in lines if line.strip())


@cache
def _policy(scripted: bool) -> str:
    """Nothing is loaded from anywhere; the one script that may run is known by its digest."""
    allowed = (
        "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'"
    )
    if not scripted:
        return allowed
    digest = base64.b64encode(hashlib.sha256(script().encode()).digest()).decode()
    return f"{allowed}; script-src 'sha256-{digest}'"


def page(
    title: str, header: Html, navigation: Html, main: Html, footer: Html, *, scripted: bool, style: str = ""
) -> Html:
    """A whole page, with nothing from elsewhere; ``style`` is what it has beside the style of all pages."""
    head = joined(
        (
            tag("meta", charset="utf-8"),
            tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
            tag("meta", http_equiv="Content-Security-Policy", content=Html(_policy(scripted))),
            tag("meta", name="referrer", content="no-referrer"),
            tag("meta", name="robots", content="noindex"),
            tag("title", one_line(title)),
            tag("style", Html(_style(style))),
        )
    )
    body = tag(
        "body",
        tag("a", "Skip to the content", href="#content", class_="skip"),
        tag("header", header),
        navigation,
        tag("main", main, id="content", tabindex="-1"),
        tag("footer", footer),
        tag("script", Html(script())) if scripted else Html(""),
    )
    return Html(f"{MARKER}{tag('html', tag('head', head), body, lang='en')}\n")
