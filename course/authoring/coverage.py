"""Where the course covers the parts of the chapter that it grew out of, and whether these places exist.

``docs/coverage.toml`` names each heading, objective, example, exercise and question in words of our own,
with the lines it takes up in the chapter, so that a part that was forgotten shows as a gap in the lines even
though the text itself is not here. ``docs/coverage.md`` is the same for readers; a test compares the two.
"""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, TypeAlias

import msgspec

from course.authoring.report import AuthorProblem, Findings
from course.catalog.blocks import Heading, slug, walk_blocks
from course.catalog.load import Catalog
from course.catalog.markdown import read_blocks
from course.catalog.reading import Document, read_document
from course.errors import ContentError, NotFoundError
from course.figures.registry import figure_ids
from course.printable import counted

#: Whether ``course`` followed by these words is a command.
IsCommand: TypeAlias = "Callable[[tuple[str, ...]], bool]"

_LINES = re.compile(r"([1-9]\d*)(?:-([1-9]\d*))?")
_KINDS = ("heading", "objective", "example", "exercise", "question")
#: How the course treats a part of the chapter, in one word.
WORDS = {
    "kept": "the same content, in other words",
    "deeper": "the course says more, or lets you do it yourself",
    "measured": "a claim in the chapter; in the course a number that you can measure again",
    "corrected": "not quite right in the chapter, or not any more; the course corrects it and says why",
}

Filled = Annotated[str, msgspec.Meta(min_length=1)]


class Part(msgspec.Struct, frozen=True, array_like=True, forbid_unknown_fields=True):
    """One part of the chapter.

    Attributes:
        lines: its lines in the chapter, "12" or "12-15", or several of these with commas.
        what: a name for it that is not the chapter's own sentence.
        word: how the course treats it, one of ``WORDS``.
        where: the places of the course that have it; see ``docs/coverage.toml``.
    """

    lines: str
    what: Filled
    word: str
    where: tuple[Filled, ...]

    @property
    def span(self) -> tuple[int, ...]:
        """Its lines; none if they are not in the right form."""
        found: list[int] = []
        for text in self.lines.split(", "):
            match = _LINES.fullmatch(text)
            if match is None:
                return ()
            found += range(int(match[1]), int(match[2] or match[1]) + 1)
        return tuple(found)


class Section(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Parts of one kind, one of ``_KINDS``."""

    title: Filled
    kind: str
    parts: tuple[Part, ...]


class Coverage(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The whole table; ``source_lines`` is the length of the chapter."""

    format_version: int
    source_lines: int
    section: tuple[Section, ...]

    @property
    def parts(self) -> tuple[Part, ...]:
        return tuple(part for section in self.section for part in section.parts)


def read_coverage(catalog: Catalog) -> Document[Coverage]:
    """The table of a course, with the lines its rows stand on."""
    path = catalog.content.root / "docs" / "coverage.toml"
    if not path.is_file():
        raise NotFoundError(
            f"There is no {path}.",
            help="The table belongs to the checkout of a course: run this there.",
            code="no_coverage",
        )
    return read_document(path, Coverage)


def written_to(catalog: Catalog) -> Path:
    """Where the table is kept for readers."""
    return catalog.content.root / "docs" / "coverage.md"


def check_coverage(
    document: Document[Coverage], catalog: Catalog, is_command: IsCommand
) -> tuple[AuthorProblem, ...]:
    """The table's faults: lines without a part, parts without a place, places that do not exist."""
    coverage, findings = document.value, Findings(catalog.content.root)
    wrong = findings.about(document.path, document.lines, "coverage")
    places = _Places(catalog, is_command)
    seen: dict[int, str] = {}
    for i, section in enumerate(coverage.section):
        if section.kind not in _KINDS:
            problem = f"{section.title}: there is no kind {section.kind!r}."
            wrong(("section", i), problem, f"The kinds are {', '.join(_KINDS)}.")
        for k, part in enumerate(section.parts):
            where = ("section", i, "parts", k)
            if part.what in seen.values():
                problem = f"{part.what}: another part is called so."
                wrong(where, problem, "Give each part a name of its own.")
            for problem, fix in (*_wrong_with(part, seen), *places.missing(part)):
                wrong(where, f"{part.what}: {problem}", fix)
            seen.update(dict.fromkeys(part.span, part.what))
    left = sorted(set(range(1, coverage.source_lines + 1)) - set(seen))
    if left:
        problem = f"{counted(len(left), 'line')} of the chapter belong{'s' * (len(left) == 1)} to no part: "
        problem += f"{', '.join(map(str, left[:10]))}{', …' if len(left) > 10 else ''}."
        wrong(("source_lines",), problem, "Add the parts they hold.")
    return findings.sorted()


def audit_coverage(catalog: Catalog, is_command: IsCommand, findings: Findings) -> None:
    """The table's faults, and a page that is out of date; nothing of a course without a table."""
    try:
        document = read_coverage(catalog)
    except NotFoundError:
        return
    except ContentError as error:
        findings.add_error(error)
        return
    faults, page = check_coverage(document, catalog, is_command), written_to(catalog)
    findings.problems += faults
    if not faults and (not page.is_file() or page.read_text("utf-8") != as_markdown(document.value)):
        fix = "Run `course author coverage --write`."
        findings.add(page, None, "stale", "it is not what docs/coverage.toml makes.", fix)


def _wrong_with(part: Part, seen: dict[int, str]) -> Iterator[tuple[str, str]]:
    """A fault of a single part, and the fix."""
    if not part.span:
        yield f"{part.lines!r} are not lines.", 'Write "12", "12-15" or "12-15, 20".'
    if part.word not in WORDS:
        yield f"there is no word {part.word!r}.", f"The words are {', '.join(WORDS)}."
    if not part.where:
        yield "the course has it nowhere.", "Name the place, or write it."
    twice = next((n for n in part.span if n in seen), None)
    if twice is not None:
        yield f"line {twice} belongs to {seen[twice]!r} already.", "Give every line to one part."


@dataclass(slots=True)
class _Places:
    """Knows which places exist."""

    catalog: Catalog
    is_command: IsCommand
    headings: dict[str, tuple[str, ...]] = field(default_factory=dict)

    def missing(self, part: Part) -> Iterator[tuple[str, str]]:
        """Each place of a part that is not there, and the fix."""
        for place in part.where:
            problem = self._problem_with(place)
            if problem:
                yield f"{place} {problem}", "Name a place that exists."

    def _problem_with(self, place: str) -> str | None:
        content, (kind, _, name) = self.catalog.content, place.partition(":")
        name, _, anchor = name.partition("#")
        match kind:
            case "lesson" if name in self.catalog.lesson_ids():
                return self._no_anchor(name, anchor)
            case "exercise":
                there = name in self.catalog.exercise_ids()
            case "solution":
                there = content.solutions is not None and (content.solutions / name / "README.md").is_file()
            case "quiz":
                there = (content.quiz / f"{name}.toml").is_file()
            case "figure":
                there = name in figure_ids()
            case "file":
                there = (content.root / name).is_file()
            case "command":
                there = self.is_command(tuple(name.split()))
            case _:
                there = False
        return None if there else "is not there."

    def _no_anchor(self, lesson_id: str, anchor: str) -> str | None:
        if lesson_id not in self.headings:
            try:
                blocks = read_blocks(self.catalog.content.lessons / f"{lesson_id}.md")
            except ContentError:
                return "is in a lesson that cannot be read."
            known = tuple(slug(block) for block in walk_blocks(blocks) if isinstance(block, Heading))
            self.headings[lesson_id] = known
        known = self.headings[lesson_id]
        return None if not anchor or anchor in known else f"names none of its headings: {', '.join(known)}."


def as_markdown(coverage: Coverage) -> str:
    """The table for readers, as ``docs/coverage.md`` holds it."""
    out = [
        "# Where each part of the chapter is",
        "",
        "The course grew out of a chapter that introduces physics simulation for robots. If you know that",
        "chapter, this page says where each part of it is now, and what became of it:",
        "",
        *(f"- **{word}**: {meaning}." for word, meaning in WORDS.items()),
        "",
        "`course author coverage` checks that each place exists and that no line of the chapter was left",
        "out; with `--write` it makes this page from `docs/coverage.toml`.",
    ]
    for section in coverage.section:
        out += ["", f"## {section.title}", "", "| in the chapter | | here |", "|:--|:--|:--|"]
        out += [
            f"| {part.what} | {part.word} | {', '.join(_shown(p) for p in part.where)} |"
            for part in section.parts
        ]
    return "\n".join(out) + "\n"


def _shown(place: str) -> str:
    """A place as a reader of the repository follows it."""
    kind, _, rest = place.partition(":")
    name, _, anchor = rest.partition("#")
    behind = f"#{anchor}" if anchor else ""
    below = f", {anchor.replace('-', ' ')}" if anchor else ""
    links = {
        "lesson": f"[{name}{below}](../course/lessons/{name}.md{behind})",
        "exercise": f"exercise [{name}](../exercises/{name}/README.md)",
        "solution": f"solution [{name}](../solutions/{name}/README.md)",
        "quiz": f"quiz [{name}](../quiz/{name}.toml)",
        "figure": f"figure `{name}`",
        "file": f"[{name}](../{name})",
        "command": f"`course {name}`",
    }
    return links[kind]
