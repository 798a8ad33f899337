"""The rules for lessons beyond the format: what a lesson must have, must not have and must refer to.

The audit asks ``rules_broken`` for every lesson; each finding names a line and the fix. Whether code cells
print what is recorded is a different question, answered by running them: ``course.authoring.lessons.cells``.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias, assert_never
from urllib.parse import unquote

from course.authoring.lessons.cells import run_lesson
from course.authoring.report import Findings
from course.catalog import blocks as b
from course.catalog.blocks import Block, Figure, Heading, Link, slug, walk_blocks, walk_inlines
from course.catalog.load import Catalog
from course.catalog.markdown import read_blocks
from course.catalog.models import Exercise, Lesson
from course.catalog.questions import Question
from course.catalog.reading import Document, LineMap, read_document, read_text, split_front_matter
from course.errors import ContentError, UsageError
from course.figures import registry
from course.figures.registry import figure_ids
from course.ids import LessonId
from course.printable import meant

#: Code, output and drawings are never wrapped; this is what 60 columns leave beside a margin of two.
MAX_COLUMNS = 58
#: Of each lesson.
LEAST_WARM_UPS = 2
#: Reading a lesson: words and lines of code a minute, minutes for a prediction. Fluent readers take 238 words
#: of non-fiction a minute (Brysbaert, Journal of Memory and Language 109, 2019); who stops at formulas and
#: tries the cells, less than half. A head is rounded to five minutes, and may be that far off.
WORDS_A_MINUTE, LINES_A_MINUTE, FOR_A_PREDICTION = 100, 10, 1.5
OFF_BY = 5
#: Whole numbers up to here are words ("four methods, 12 of them"), not measurements.
_SMALL = 12
#: "In 2005": a date has a source, not a computation.
_YEARS = range(1600, 2100)
_NUMBER = re.compile(r"(?<![\w.])\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?(?![\w])")

#: Left in the text by ``[3](=a + b)``, which has spaces and is therefore not a link in Markdown.
_UNREAD_VALUE = re.compile(r"\]\(<?=")

#: Those of some commands that fail, by their place, and what each says.
Refused: TypeAlias = "Callable[[Sequence[str]], dict[int, str]]"


@dataclass(frozen=True, slots=True)
class Finding:
    """Something wrong with a lesson.

    Attributes:
        line: line of the file, counted from 1; 0 when something is missing altogether.
    """

    line: int
    problem: str
    fix: str


def rules_broken(
    blocks: tuple[b.Block, ...], *, figures: Collection[str], whole: bool = True
) -> list[Finding]:
    """Everything wrong with a lesson, in the order of its lines.

    Args:
        figures: the ids of those it may show.
        whole: it is to have all that docs/lesson-format.md says every lesson has.
    """
    found = [
        *((*_missing_parts(blocks), *_unplaced_sources(blocks)) if whole else ()),
        *_unpredicted(blocks),
        *_given_away(blocks),
        *_twice(blocks),
        *_unknown_figures(blocks, figures),
        *_unread_values(blocks),
        *_unproduced_numbers(blocks),
        *_too_wide(blocks),
    ]
    return sorted(found, key=lambda finding: finding.line)


def _missing_parts(blocks: tuple[b.Block, ...]) -> Iterator[Finding]:
    every = list(b.walk_blocks(blocks))
    callouts = {block.kind for block in every if isinstance(block, b.Callout)}
    for kind in ("myth", "fact", "analogy"):
        if kind not in callouts:
            yield Finding(0, f"the lesson has no {kind}", f"Add a quote: > **{kind.capitalize()}.** …")
    headings = [b.plain_text(block.inlines).lower() for block in every if isinstance(block, b.Heading)]
    for opening in ("before you start", "worked example", "try it", "what to do next"):
        if not any(heading.startswith(opening) for heading in headings):
            yield Finding(0, f"no section begins {opening!r}", f"Add one: ## {opening.capitalize()}")
    wanted = {
        b.Figure: ("figure", "Draw one in course/figures and show it: ![…](figure:id)."),
        b.CodeCell: ("code cell", "Add a ```python fence."),
        b.CommandList: ("command to try", "Add a ```console fence."),
        b.Prediction: ("prediction", "Add a quote: > **Predict.** …"),
        b.Sources: ("list of sources", "Add a section ## Sources with one source an item."),
    }
    for kind_of_block, (name, fix) in wanted.items():
        if not any(isinstance(block, kind_of_block) for block in every):
            yield Finding(0, f"the lesson has no {name}", fix)
    quoted = any(isinstance(inline, b.Value) for _, inline in b.walk_inlines(blocks))
    if not quoted and not any(_unread_values(blocks)):
        yield Finding(0, "the lesson has no number that its code gives", "Quote one: [0.0890](=error).")


def _unpredicted(blocks: tuple[b.Block, ...]) -> Iterator[Finding]:
    """A figure or a run with no prediction before it in its section, and predictions left unanswered."""
    asked: b.Prediction | None = None
    is_open = False
    for block in (*blocks, None):
        match block:
            case None | b.Heading(level=2) | b.Prediction():
                if asked and is_open:
                    problem = "a prediction that is not answered"
                    yield Finding(asked.line, problem, "Add > **Answer.** … after it.")
                asked = block if isinstance(block, b.Prediction) else None
                is_open = asked is not None
            case b.Callout(kind="answer"):
                is_open = False
            case b.Figure(line=line) if asked is None:
                yield Finding(line, "a figure without a prediction", "Put > **Predict.** … before it.")
            case b.CodeCell(line=line, output=str()) if asked is None:
                yield Finding(line, "a run without a prediction", "Put > **Predict.** … before it.")
            case _:
                pass


def _given_away(blocks: tuple[b.Block, ...]) -> Iterator[Finding]:
    """Numbers of an answer in a later prediction: both may stand on one screen, the answer still closed."""
    answered: set[str] = set()
    for block in blocks:
        if not isinstance(block, b.Prediction | b.Callout):
            continue
        quoted = {inline.text for _, inline in b.walk_inlines((block,)) if isinstance(inline, b.Value)}
        if isinstance(block, b.Prediction):
            for number in sorted(quoted & answered):
                problem = f"the prediction quotes {number}, which an answer above it gives away"
                yield Finding(block.line, problem, "Ask without that number.")
        elif block.kind == "answer":
            answered |= quoted


def _twice(blocks: tuple[b.Block, ...]) -> Iterator[Finding]:
    """Headings that a link could mean either of."""
    seen: dict[str, b.Heading] = {}
    for block in b.walk_blocks(blocks):
        if isinstance(block, b.Heading):
            if (name := slug(block)) in seen:
                problem = f"the heading on line {seen[name].line} has the anchor #{name}, too"
                yield Finding(block.line, problem, "Give each heading words of its own.")
            seen.setdefault(name, block)


def _unknown_figures(blocks: tuple[b.Block, ...], figures: Collection[str]) -> Iterator[Finding]:
    for block in b.walk_blocks(blocks):
        if isinstance(block, b.Figure) and block.id not in figures:
            fix = f"{meant(block.id, figures)} ".lstrip()
            fix += "A new one is entered in course/figures/registry.py: CONTRIBUTING.md, Add a figure."
            yield Finding(block.line, f"there is no figure {block.id}", fix)


def _unplaced_sources(blocks: tuple[b.Block, ...]) -> Iterator[Finding]:
    """Sources without an address; what was measured for the course is found in the course."""
    for block in blocks:
        for item in block.items if isinstance(block, b.Sources) else ():
            links = [inline.target for inline in item if isinstance(inline, b.Link)]
            words = b.plain_text(item)
            if "measured for this course" not in words and not any(
                link.startswith("https://") for link in links
            ):
                fix = "Link it, https://..., or say that it was measured for this course."
                yield Finding(block.line, f"the source {words[:40]!r} has no address", fix)


def _unread_values(blocks: tuple[b.Block, ...]) -> Iterator[Finding]:
    """Links to a value that were not parsed as links, so that a reader would see their source."""
    for block, text in _prose(blocks):
        if _UNREAD_VALUE.search(text):
            yield Finding(
                block.line,
                "a value link that Markdown does not read as one",
                "Close its brackets, and put an expression with spaces between < and >: [3](<=a + b>).",
            )


def _unproduced_numbers(blocks: tuple[b.Block, ...]) -> Iterator[Finding]:
    """Numbers in prose that no code produces: neither a value, nor a constant of a code cell.

    Mathematics, code, years, sources and alternative texts are left out; a constant of the code is what
    the author chose, and may be quoted as such.
    """
    given = {value for block in b.walk_blocks(blocks) for value in _constants(block)}
    for block, text in _prose(blocks):
        if _UNREAD_VALUE.search(text):
            continue
        for match in _NUMBER.finditer(text):
            number = float(match.group().replace(",", ""))
            if number in given or (number.is_integer() and (number <= _SMALL or number in _YEARS)):
                continue
            fix = f"Let code give it, [{match.group()}](=expression), or make it a constant of a code cell."
            yield Finding(block.line, f"{match.group()} is produced by no code", fix)


def _constants(block: b.Block) -> Iterator[float]:
    if not isinstance(block, b.CodeCell):
        return
    try:
        tree = ast.parse(block.source)
    except (SyntaxError, ValueError):
        return  # said where the cell is run
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
            yield float(node.value)


def _prose(blocks: tuple[b.Block, ...]) -> Iterator[tuple[b.Block, str]]:
    """The texts of paragraphs, captions and tables without code spans, each with its block."""
    prose = (one for one in b.walk_blocks(blocks) if isinstance(one, b.Paragraph | b.Figure | b.Table))
    for block in prose:
        for line in b.lines_of(block):
            words = tuple(one for one in line if not (isinstance(one, b.Span) and one.style == "code"))
            for inline in b.flattened(words):
                if isinstance(inline, b.Text):
                    yield block, inline.text


def _too_wide(blocks: tuple[b.Block, ...]) -> Iterator[Finding]:
    for block in b.walk_blocks(blocks):
        match block:
            case b.CodeCell(line, source, output, False):
                texts = [("code", line, source), ("output", block.output_line or line, output or "")]
            case b.Diagram(line, _, drawing):
                texts = [("drawing", line, drawing)]
            case b.Listing(line, text):
                texts = [("text", line, text)]
            case b.MathBlock(line, _, text):
                texts = [("formula", line, text)]
            case b.CodeCell() | b.CommandList() | b.Task():
                continue
            case b.Heading() | b.Paragraph() | b.ListBlock() | b.Table() | b.Figure():
                continue
            case b.Prediction() | b.Callout() | b.Sources():
                continue
            case _:
                assert_never(block)
        for kind, line, text in texts:
            widest = max((len(row) for row in text.splitlines()), default=0)
            if widest > MAX_COLUMNS:
                problem = f"{kind} {widest} columns wide"
                yield Finding(line, problem, f"Break it: 60 columns leave room for {MAX_COLUMNS}.")


# ---
# Whether every link of the course works.
#
# Three kinds are checked: ``lesson:ID`` and ``exercise:ID``, which work wherever the course is installed;
# ``#anchor`` alone or behind one of those; and files beside the text. Links to the web are left alone: the
# course works offline, and so does its audit.


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
            catalog, name = self._catalog, place.removeprefix("exercise:")
            known = (*catalog.exercise_ids(), *catalog.warm_up_ids())
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
            fix = "Use https://, lesson:ID, exercise:ID, or a file beside this one."
            return "is of an unknown kind.", fix
        destination = (path.parent / place).resolve()
        if not destination.is_relative_to(path.parent.resolve()):
            problem = "leaves its folder, which breaks where the course is installed."
            return problem, "Link with lesson:ID or exercise:ID."
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
        return frozenset(slug(one) for one in walk_blocks(read_blocks(path)) if isinstance(one, Heading))
    from markdown_it import MarkdownIt

    tokens = MarkdownIt("commonmark").enable("table").parse(read_text(path))
    return frozenset(
        b.anchor(_words(tokens[index + 1].children or []))
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


# ---
# The audit of lessons.
#
# The syllabus and the files agree, the heads name what exists, texts parse, links work, and every quoted or
# printed number is what the lesson's own code gives.


def audit_syllabus(catalog: Catalog, findings: Findings) -> None:
    """Every listed lesson has a file, and objectives name what there is, once."""
    syllabus = catalog.content.syllabus
    listed = catalog.lesson_ids()
    wrong = findings.about(syllabus, LineMap(read_text(syllabus)), "syllabus")
    for index, lesson_id in enumerate(listed):
        if not (catalog.content.lessons / f"{lesson_id}.md").is_file():
            fix = f"Write {lesson_id}.md beside the syllabus, or remove the line."
            wrong(("lessons", index), f"lesson {lesson_id} has no file.", fix)
    known = {"lessons": listed, "exercises": catalog.exercise_ids(), "quiz": catalog.question_ids()}
    named: set[tuple[str, str]] = set()
    for index, objective in enumerate(catalog.syllabus.objective):
        for kind, ids in known.items():
            for place, name in enumerate(getattr(objective, kind)):
                where = ("objective", index, kind, place)
                if name not in ids:
                    wrong(where, f"there is no {name} among the {kind}.", f"Known: {', '.join(ids)}.")
                elif (kind, name) in named:
                    problem = f"{name} belongs to an objective above already."
                    wrong(where, problem, "Leave it in one of the two.")
                named.add((kind, name))


def audit_objective(catalog: Catalog, kind: str, name: str, findings: Findings) -> None:
    """Something belongs to one of the course's objectives, if it has any: the overview goes by them.

    Args:
        kind: the key of an objective: "lessons", "exercises" or "quiz".
    """
    objectives = catalog.syllabus.objective
    if objectives and not any(name in getattr(objective, kind) for objective in objectives):
        syllabus = catalog.content.syllabus
        what = {"lessons": "lesson", "exercises": "exercise", "quiz": "question"}[kind]
        problem = f"{what} {name} belongs to no objective, so `course` does not show it."
        wrong = findings.about(syllabus, LineMap(read_text(syllabus)), "syllabus")
        wrong(("objective",), problem, f'Add "{name}" to `{kind}` of an [[objective]].')


def audit_listed(catalog: Catalog, lesson_id: str, findings: Findings) -> None:
    """A lesson has a place in the syllabus."""
    if lesson_id in catalog.lesson_ids():
        audit_objective(catalog, "lessons", lesson_id, findings)
        return
    path = catalog.content.lessons / f"{lesson_id}.md"
    fix = f'Add "{lesson_id}" to `lessons` in {catalog.content.syllabus.name}.'
    findings.add(path, None, "syllabus", "the syllabus does not list this lesson.", fix)


def audit_lesson(
    catalog: Catalog, lesson_id: str, findings: Findings, links: LinkChecker, refused: Refused | None = None
) -> None:
    """One lesson: its head, its text, its links and its commands.

    Args:
        refused: gives those of some commands that fail, by their place, and what each says.
    """
    path = catalog.content.lessons / f"{lesson_id}.md"
    try:
        LessonId(lesson_id)
        lesson = catalog.read_lesson(lesson_id)
        blocks = read_blocks(path)
        _audit_head(catalog, path, lesson, blocks, findings)
        links.check_lesson(path, blocks)
        whole = bool(catalog.syllabus.objective)
        if whole and len(catalog.warm_ups(lesson_id)) < LEAST_WARM_UPS and lesson_id in catalog.lesson_ids():
            problem = f"a lesson has at least {LEAST_WARM_UPS} warm-ups, and {lesson_id} has fewer."
            fix = f"Write one: course author new warmup ID --lesson {lesson_id}"
            findings.add(path, None, "lesson", problem, fix)
        for one in rules_broken(blocks, figures=figure_ids(), whole=whole):
            findings.add(path, one.line or None, "lesson", f"{one.problem}.", one.fix)
        if refused is not None:
            lists = [block for block in walk_blocks(blocks) if isinstance(block, b.CommandList)]
            commands = [(one.line + n, it.command) for one in lists for n, it in enumerate(one.commands, 1)]
            for place, said in refused([command for _, command in commands]).items() if commands else ():
                line, command = commands[place]
                problem = f"`{command}` fails in a fresh workspace: {said}"
                findings.add(path, line, "lesson", problem, "Give a command that works there.")
        _audit_numbers(path, findings)
    except UsageError as error:
        findings.add(path, None, "content", error.message, error.help)
    except ContentError as error:
        findings.add_error(error)


def reading_minutes(blocks: tuple[b.Block, ...]) -> float:
    """How long a lesson takes to read and try, its sources, drawings and hidden cells left out."""
    took = 0.0
    for block in b.walk_blocks(blocks):
        match block:
            case b.Paragraph(inlines=inlines) | b.Figure(caption=inlines):
                took += len(b.plain_text(inlines).split()) / WORDS_A_MINUTE
            case b.Table(rows=rows):
                took += sum(len(b.plain_text(cell).split()) for row in rows for cell in row) / WORDS_A_MINUTE
            case b.Prediction():
                took += FOR_A_PREDICTION
            case b.CodeCell(source=source, hidden=False):
                took += len([line for line in source.splitlines() if line.strip()]) / LINES_A_MINUTE
            case _:
                pass
    return took


def _audit_head(
    catalog: Catalog, path: Path, lesson: Lesson, blocks: tuple[b.Block, ...], findings: Findings
) -> None:
    head = split_front_matter(read_text(path), path)
    wrong = findings.about(path, LineMap(head.toml, first_line=2), "lesson")
    took = reading_minutes(blocks)
    if abs(lesson.minutes - took) > OFF_BY and catalog.syllabus.objective:
        problem = (
            f"`minutes` is {lesson.minutes}; by its words, predictions and code it takes about {took:.0f}."
        )
        wrong(("minutes",), problem, f"Write: minutes = {5 * max(round(took / 5), 1)}")
    order = catalog.lesson_ids()
    place = order.index(lesson.id) if lesson.id in order else len(order)
    for index, earlier in enumerate(lesson.before):
        if earlier not in order[:place]:
            problem = f"lesson {earlier} does not come before this one in the syllabus."
            wrong(("before", index), problem, "Correct the id, or change the order of the syllabus.")
    for index, exercise_id in enumerate(lesson.exercises):
        if exercise_id not in catalog.exercise_ids():
            fix = f"Known: {', '.join(catalog.exercise_ids())}."
            wrong(("exercises", index), f"there is no exercise {exercise_id}.", fix)


def _audit_numbers(path: Path, findings: Findings) -> None:
    """Recorded output and quoted numbers agree with the cells."""
    run = run_lesson(path)
    for cell in run.cells:
        if not cell.agrees:
            line = cell.cell.output_line or cell.cell.line
            problem = f"the code cell prints {cell.printed!r}, and the lesson records {cell.cell.output!r}."
            fix = "Put what it prints into the output block below the cell."
            findings.add(path, line, "lesson", problem, fix)
    for quoted in run.values:
        if not quoted.agrees:
            value, fix = quoted.value, "Correct the text, or the code if the text is right."
            problem = f"the text says {value.text}, and {value.expression} gives {quoted.computed}."
            findings.add(path, value.line, "lesson", problem, fix)


def audit_figures(catalog: Catalog, lessons: Collection[str] | None, findings: Findings) -> None:
    """The figures of some lessons, where the pictures of the course's figures are kept: in a checkout.

    Args:
        lessons: None for all, and for the figures that no lesson shows.
    """
    from course.figures.looks import faults

    kept = catalog.content.root / "tests" / "fixtures" / "golden"
    if not kept.is_dir():
        return
    shown: set[str] = set()
    try:
        for lesson_id in catalog.lesson_ids() if lessons is None else lessons:
            blocks = read_blocks(catalog.content.lessons / f"{lesson_id}.md")
            shown |= {block.id for block in walk_blocks(blocks) if isinstance(block, Figure)}
    except ContentError:
        return  # reported where the lesson is read
    if lessons is None:
        _audit_registry(findings)
    for figure_id in figure_ids():
        if lessons is None or figure_id in shown:
            for fault in faults(figure_id, kept):
                findings.add(fault.file, fault.line, "figure", fault.problem, fault.help)
        # `course sim run --plot` shows those of the simulations.
        if lessons is None and figure_id not in shown and not figure_id.startswith("sim-"):
            problem = f"no lesson shows figure {figure_id}."
            fix = f"Show it, ![...](figure:{figure_id}), or take it out."
            findings.add(Path(registry.__file__), None, "figure", problem, fix)


def _audit_registry(findings: Findings) -> None:
    """No id of a figure is entered twice: Python takes the last one and says nothing."""
    path = Path(registry.__file__)
    for node in ast.walk(ast.parse(read_text(path))):
        keys = (
            [key for key in node.keys if isinstance(key, ast.Constant)] if isinstance(node, ast.Dict) else []
        )
        for index, key in enumerate(keys):
            if key.value in [earlier.value for earlier in keys[:index]]:
                problem = f"figure {key.value!r} is entered twice."
                findings.add(path, key.lineno, "figure", problem, "Give each figure an id of its own.")
