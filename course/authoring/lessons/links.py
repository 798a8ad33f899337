"""Whether every link of the course works.

Three kinds are checked: ``lesson:ID`` and ``exercise:ID``, which work wherever the course is installed;
``#anchor`` alone or behind one of those; and files beside the text. Links to the web are left alone: the
course works offline, and so does its audit.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from urllib.parse import unquote

from course.catalog.blocks import Heading, Link, Text, slug, walk_blocks, walk_inlines
from course.catalog.markdown import read_blocks
from course.catalog.models import Exercise
from course.catalog.reading import read_document, read_text
from course.errors import ContentError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from course.authoring.report import Findings
    from course.catalog.blocks import Block
    from course.catalog.load import Catalog
    from course.catalog.questions import Question
    from course.catalog.reading import Document

__all__ = ["LinkChecker"]

_WEB = ("https://", "http://", "mailto:")


class LinkChecker:
    """Checks links of lessons and READMEs against one catalogue."""

    def __init__(self, catalog: Catalog, findings: Findings) -> None:
        self._catalog = catalog
        self._findings = findings
        self._anchors: dict[Path, frozenset[str]] = {}

    def check_lesson(self, path: Path, blocks: tuple[Block, ...]) -> None:
        """Every link in the text of a lesson."""
        for _, inline in walk_inlines(blocks):
            if isinstance(inline, Link):
                self._check(path, inline.line, inline.target)

    def check_readme(self, path: Path) -> None:
        """Every link and picture in an ordinary Markdown file."""
        for line, target in _links(read_text(path)):
            self._check(path, line, target)

    def check_reading(self, path: Path, exercise: Exercise) -> None:
        """The sections to which an ``exercise.toml`` refers."""
        lines = read_document(path, Exercise).lines
        for index, task in enumerate(exercise.task):
            if task.read:
                self._check(path, lines.line(("task", index, "read")), f"lesson:{task.read}")

    def check_question(self, document: Document[Question]) -> None:
        """The section to which a quiz question refers."""
        self._check(document.path, document.lines.line(("lesson",)), f"lesson:{document.value.lesson}")

    def _check(self, path: Path, line: int | None, target: str) -> None:
        problem = self._problem_with(path, target)
        if problem:
            self._findings.add(path, line, "link", f"the link {target!r} {problem[0]}", problem[1])

    def _problem_with(self, path: Path, target: str) -> tuple[str, str] | None:
        """A link's fault and the fix, or None."""
        if target.startswith(_WEB):
            return None
        place, _, anchor = target.partition("#")
        if place.startswith("lesson:"):
            name, known = place.removeprefix("lesson:"), self._catalog.lesson_ids()
            destination = self._catalog.content.lessons / f"{name}.md"
        elif place.startswith("exercise:"):
            catalog = self._catalog
            name, known = (
                place.removeprefix("exercise:"),
                (*catalog.exercise_ids(), *catalog.warm_up_ids()),
            )
            destination = catalog.content.exercise_folder(name) / "README.md"
        elif place:
            return self._problem_with_file(path, unquote(place), anchor)
        else:
            return self._problem_with_anchor(path, anchor)
        if name not in known:
            return "leads to nothing: the id does not exist.", f"Known: {', '.join(known)}."
        return self._problem_with_anchor(destination, anchor) if anchor else None

    def _problem_with_file(self, path: Path, place: str, anchor: str) -> tuple[str, str] | None:
        if ":" in place.split("/", maxsplit=1)[0]:
            return (
                "is of an unknown kind.",
                "Use https://, lesson:ID, exercise:ID, or a file beside this one.",
            )
        destination = (path.parent / place).resolve()
        if not destination.is_relative_to(path.parent.resolve()):
            return (
                "leaves its folder, which breaks where the course is installed.",
                "Link with lesson:ID or exercise:ID.",
            )
        if not destination.exists():
            return "leads to no file.", "Correct the name, or add the file."
        if anchor and destination.suffix == ".md":
            return self._problem_with_anchor(destination, anchor)
        return None

    def _problem_with_anchor(self, path: Path, anchor: str) -> tuple[str, str] | None:
        if path not in self._anchors:
            try:
                self._anchors[path] = _anchors(path, lesson=path.parent == self._catalog.content.lessons)
            except ContentError:
                return None  # that file has a problem of its own, which is reported where it is read
        if anchor in self._anchors[path]:
            return None
        known = ", ".join(sorted(self._anchors[path])) or "none"
        return "names a heading that does not exist.", f"Headings of {path.name}: {known}."


def _anchors(path: Path, *, lesson: bool) -> frozenset[str]:
    if lesson:
        return frozenset(
            slug(block) for block in walk_blocks(read_blocks(path)) if isinstance(block, Heading)
        )
    from markdown_it import MarkdownIt

    tokens = MarkdownIt("commonmark").enable("table").parse(read_text(path))
    return frozenset(
        slug(Heading(line=1, level=2, inlines=(Text(_words(tokens[index + 1].children or [])),)))
        for index, token in enumerate(tokens)
        if token.type == "heading_open"
    )


def _words(children: list) -> str:  # type: ignore[type-arg]  # tokens of a library that is imported late
    return "".join(child.content for child in children if child.type in {"text", "code_inline"})


def _links(text: str) -> Iterator[tuple[int | None, str]]:
    """Line and target of each link and picture of a Markdown text."""
    from markdown_it import MarkdownIt

    parser = MarkdownIt("commonmark").enable("table")
    parser.validateLink = lambda url: True  # type: ignore[method-assign]  # noqa: ARG005 - judged here instead
    line: int | None = None
    for token in parser.parse(text):
        if token.map:
            line = token.map[0] + 1
        if token.type != "inline":
            continue
        below = 0
        for child in token.children or []:
            below += child.type in {"softbreak", "hardbreak"}
            target = child.attrGet("href") or child.attrGet("src")
            if target:
                yield (line + below if line else None), str(target)
