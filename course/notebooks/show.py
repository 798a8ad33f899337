"""Functions that the cells of a generated notebook call to show something; none of them needs Jupyter."""

import base64
from dataclasses import dataclass
from html import escape
from pathlib import Path

from course.catalog.blocks import Figure, walk_blocks
from course.catalog.load import Catalog
from course.catalog.markdown import read_blocks
from course.figures.described import Plot
from course.scoring.failures import Report, Section


@dataclass(frozen=True)
class Picture:
    """A drawn figure, in the form that Jupyter asks for.

    Attributes:
        name: its id.
        data: the PNG.
        alt: what it shows, in words.
    """

    name: str
    data: bytes
    alt: str

    def __repr__(self) -> str:
        return f"<figure {self.name}>"

    def _repr_png_(self) -> bytes:
        return self.data

    def _repr_html_(self) -> str:
        return _image(self.data, self.alt)


def figure(name: str, lesson: str = "") -> Picture:
    """A figure of a lesson, drawn by the course's own code.

    Args:
        name: its id, as in the lesson.
        lesson: the one that says in words what it shows.

    Raises:
        NotFoundError: there is no figure of that name, or no such lesson.
    """
    from course.figures.registry import png

    blocks = walk_blocks(read_blocks(Path(Catalog().lesson(lesson).path))) if lesson else ()
    said = (block.alt for block in blocks if isinstance(block, Figure) and block.id == name)
    return Picture(name, png(name), next(said, ""))


# ---
# An exercise's report as a notebook shows it: words, tables and figures.


@dataclass(frozen=True)
class ReportPage:
    """A report: a page in Jupyter, lines in a plain terminal."""

    report: Report

    def __repr__(self) -> str:
        lines = [self.report.title]
        for section in self.report.sections:
            lines += ["", section.title, section.text]
            lines += ["  ".join(row) for row in section.rows]
            lines += [section.plot.description] if section.plot else []
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        return "".join((f"<h3>{escape(self.report.title)}</h3>", *map(_section, self.report.sections)))


def _section(section: Section) -> str:
    parts = [f"<h4>{escape(section.title)}</h4>"]
    for paragraph in section.text.split("\n\n"):
        if paragraph.lstrip().startswith("- "):
            items = (line.strip().removeprefix("- ") for line in paragraph.strip().split("\n"))
            parts.append("<ul>" + "".join(f"<li>{escape(item)}</li>" for item in items) + "</ul>")
        elif paragraph.strip():
            parts.append(f"<p>{escape(' '.join(paragraph.split()))}</p>")
    if section.rows:
        head = "".join(f"<th>{escape(name)}</th>" for name in section.columns)
        rows = ("".join(f"<td>{escape(cell)}</td>" for cell in row) for row in section.rows)
        body = "".join(f"<tr>{row}</tr>" for row in rows)
        parts.append(f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>")
    if section.plot is not None:
        parts.append(image_of(section.plot))
    return "".join(parts)


def image_of(plot: Plot) -> str:
    """A figure as HTML, with its description as alternative text."""
    from course.figures.plots import render

    return _image(render(plot), plot.description or plot.title)


def _image(png: bytes, described: str) -> str:
    data = base64.b64encode(png).decode()
    return f'<img alt="{escape(described)}" style="max-width:100%" src="data:image/png;base64,{data}">'
