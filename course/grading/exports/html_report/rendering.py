"""The templates of these pages: text is escaped, and characters that affect other text are spelled out."""

from __future__ import annotations

import base64
import hashlib
import re
from functools import cache, lru_cache
from pathlib import Path
from typing import Any, Final

import jinja2
from markupsafe import Markup, escape

from course.grading.exports.cells import number
from course.grading.exports.html_report.charts import duration, mark_of, percent, score_bins
from course.grading.exports.html_report.words import when
from course.grading.results.late import in_days
from course.printable import one_line

__all__ = ["MARKER", "macro", "render", "script", "shortened"]

#: The beginning of every page; a file that begins otherwise is not ours to replace.
MARKER: Final = "<!DOCTYPE html>\n<!-- course grade -->\n"
_TEMPLATES = Path(__file__).with_name("templates")
#: Searched for after escaping, when no character of HTML is left.
_CODE = re.compile(r"`([^`\n]{1,200})`")
#: Characters of a name that are shown: a folder may be called anything.
_LONGEST_NAME = 120


def render(template: str, **words: Any) -> str:
    """A page.

    Args:
        template: its name, without the end ``.html.j2``.
        words: what it shows. All text is literal: it contains no markup, and cannot hide or reorder other
            text.
    """
    return _environment().get_template(f"{template}.html.j2").render(words)


def macro(template: str, name: str, *arguments: Any, **more: Any) -> Markup:
    """The result of one macro of a template."""
    found = getattr(_environment().get_template(f"{template}.html.j2").module, name)
    return Markup(found(*arguments, **more))


def shortened(value: str, longest: int) -> str:
    """The text, shortened if it is too long to read."""
    return value if len(value) <= longest else value[:longest].rstrip() + "…"


@cache
def script() -> str:
    """The script that sorts and filters tables; the page is complete without it."""
    return (_TEMPLATES / "tables.js").read_text("utf-8")


# -- inside ----------------------------------------------------------------------------------------------


@cache
def _environment() -> jinja2.Environment:
    made = jinja2.Environment(
        loader=jinja2.FileSystemLoader([_TEMPLATES, _TEMPLATES.parents[2] / "similar"]),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        finalize=_shown,
        trim_blocks=True,
        lstrip_blocks=True,
        auto_reload=False,
    )
    made.filters |= {
        "name": _name,
        "prose": _prose,
        "short": shortened,
        "number": number,
        "when": when,
        "duration": duration,
        "days": in_days,
        "g": lambda value: f"{float(value):.4g}",
    }
    made.globals |= {
        "marker": Markup(MARKER),
        "percent": percent,
        "policy": _policy,
        "style": _style,
        "script": lambda: Markup(script()),
        "score_bins": score_bins,
        "mark_of": mark_of,
    }
    return made


def _shown(value: Any) -> Any:
    """Every value that goes into a page: control characters are spelled out, line breaks stay."""
    if isinstance(value, Markup) or not isinstance(value, str) or value.isprintable():
        return value
    return "\n".join(map(one_line, value.split("\n")))


@lru_cache(maxsize=4096)
def _name(student: str) -> Markup:
    """A name on one line, isolated so that one written from right to left does not turn its surroundings."""
    return Markup("<bdi>{}</bdi>").format(one_line(shortened(student, _LONGEST_NAME)))


@lru_cache(maxsize=8192)  # the same few hundred sentences stand on every student's page
def _prose(value: str, longest: int = 2000) -> Markup:
    """A sentence of ours, in which `code` stands between backquotes; whatever it quotes is text."""
    text = str(escape(_shown(shortened(value.strip(), longest))))  # joining Markup would escape again
    return Markup(_CODE.sub(r"<code>\1</code>", text))


@cache
def _style(more: str = "") -> Markup:
    lines = [*(_TEMPLATES / "page.css").read_text("utf-8").splitlines(), *more.splitlines()]
    return Markup("\n".join(line.strip() for line in lines if line.strip()))


@cache
def _policy(scripted: bool) -> Markup:
    """Nothing is loaded from anywhere; the one script that may run is known by its digest."""
    allowed = (
        "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'"
    )
    if not scripted:
        return Markup(allowed)
    digest = base64.b64encode(hashlib.sha256(script().encode()).digest()).decode()
    return Markup(f"{allowed}; script-src 'sha256-{digest}'")
