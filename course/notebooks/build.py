"""Which notebooks there are, and how each is generated."""

import ast
import posixpath
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path, PurePosixPath
from urllib.parse import quote

from course.catalog import blocks as b
from course.catalog.load import Catalog
from course.catalog.markdown import read_blocks
from course.catalog.models import Exercise, Lesson
from course.errors import NotFoundError
from course.handed_in.notebook import SETUP, SOLUTION
from course.notebooks.cells import Cell, Lowering, code, document, markdown, opening
from course.printable import counted, meant
from course.reading.parts import with_tasks
from course.scoring.judging.session import has_report
from course.scoring.verdict import in_points

Makers = dict[tuple[str, str], tuple[PurePosixPath, Callable[[], bytes]]]

# ---
# Where each notebook lies, and how one links to another.


@dataclass(frozen=True)
class Layout:
    """Where notebooks lie below the folder they are generated into.

    Attributes:
        of_exercise: a path with ``{id}`` and ``{module}`` in it.
    """

    of_exercise: str

    def lesson(self, lesson_id: str) -> PurePosixPath:
        return PurePosixPath("lessons", f"{lesson_id}.ipynb")

    def exercise(self, exercise: Exercise) -> PurePosixPath:
        module = exercise.module.removesuffix(".py")
        return PurePosixPath(self.of_exercise.format(id=exercise.id, module=module))

    def links(self, catalog: Catalog, lesson_id: str) -> Callable[[str], str]:
        """A function that turns a lesson's link targets into addresses that work from its notebook."""

        def link(target: str) -> str:
            kind, _, rest = target.partition(":")
            name, _, slug = rest.partition("#")
            if kind == "exercise":
                return _between(self.lesson(lesson_id), self.exercise(catalog.exercise(name)))
            if kind == "lesson":
                return _between(self.lesson(lesson_id), self.lesson(name)) + _anchor(catalog, name, slug)
            if target.startswith("#"):
                return _anchor(catalog, lesson_id, target[1:]) or target
            return target

        return link


#: One folder for lessons and one for exercises, below ``--out``.
FOLDERS = Layout("exercises/{id}.ipynb")
#: In a workspace an exercise's notebook lies beside its module, where it can be handed in.
WORKSPACE = Layout("{id}/{module}.ipynb")
#: Where nbgrader looks for an assignment's source.
NBGRADER = Layout("source/{id}/{module}.ipynb")


def _between(start: PurePosixPath, target: PurePosixPath) -> str:
    return posixpath.relpath(str(target), str(start.parent))


def _anchor(catalog: Catalog, lesson_id: str, slug: str) -> str:
    """JupyterLab's anchor of a heading: its words, joined by hyphens."""
    if not slug:
        return ""
    for block in read_blocks(catalog.content.lessons / f"{lesson_id}.md"):
        if isinstance(block, b.Heading) and b.slug(block) == slug:
            return "#" + quote(b.plain_text(block.inlines).replace(" ", "-"))
    return ""


QUIZ, SANDBOX = "quiz", "sandbox"


@dataclass(frozen=True)
class Generated:
    """One notebook.

    Attributes:
        kind: "lesson", "exercise", "quiz" or "sandbox".
        id: of the lesson or exercise; else the kind again.
        path: relative to the folder that notebooks go into.
    """

    kind: str
    id: str
    path: PurePosixPath
    data: bytes


def generate(
    catalog: Catalog, ids: Sequence[str] = (), layout: Layout = FOLDERS, *, there: Path | None = None
) -> Iterator[Generated]:
    """The notebooks of a course.

    Args:
        ids: of lessons and exercises, "quiz" or "sandbox"; an id shared by a lesson and an exercise gives
            both; none gives everything.
        there: only those that lie in this folder already.

    Raises:
        NotFoundError: there is nothing of that id.
        ContentError: a file of the course is wrong.
    """
    makers = _makers(catalog, layout)
    for wanted in ids:
        if not any(wanted == name for _, name in makers):
            raise _unknown(wanted, [name for _, name in makers])
    for (kind, name), (path, make) in makers.items():
        if (not ids or name in ids) and (there is None or (there / path).is_file()):
            yield Generated(kind, name, path, make())


def _makers(catalog: Catalog, layout: Layout) -> Makers:
    """By kind and id: where a notebook lies and what makes it. Content is read only when asked for."""
    from course.notebooks.quiz import quiz_notebook
    from course.notebooks.sandbox import sandbox_notebook

    makers: Makers = {}
    for name in catalog.lesson_ids():
        make = partial(lesson_notebook, catalog, name, layout)
        makers["lesson", name] = layout.lesson(name), make
    for exercise in catalog.exercises():
        make = partial(exercise_notebook, catalog, exercise)
        makers["exercise", exercise.id] = layout.exercise(exercise), make
    if any(catalog.content.quiz.glob("*.toml")):
        makers[QUIZ, QUIZ] = PurePosixPath("quiz.ipynb"), partial(quiz_notebook, catalog)
    makers[SANDBOX, SANDBOX] = PurePosixPath("sandbox.ipynb"), partial(sandbox_notebook, catalog)
    return makers


def _unknown(wanted: str, known: Sequence[str]) -> NotFoundError:
    names = list(dict.fromkeys(known))
    number = "A number may be a lesson's or an exercise's: write the name. " if wanted.isdecimal() else ""
    return NotFoundError(
        f"There is no lesson and no exercise called {wanted[:80]!r}.",
        help=meant(wanted, names, f"{number}Known: {', '.join(names)}."),
        code="notebook_not_found",
    )


# ---
# A stub taken apart: the functions that a student writes, and the lines between them.


@dataclass(frozen=True)
class Piece:
    """Consecutive lines of a stub.

    Attributes:
        task: the function these lines define; "" for what is given.
        text: the lines, without empty ones at either end.
    """

    task: str
    text: str


def pieces(source: str, tasks: Collection[str]) -> tuple[str, list[Piece]]:
    """The module's docstring, and its lines in order: one piece for each task, the rest joined between them.

    Comments belong to the statement that follows them.
    """
    tree = ast.parse(source)
    lines = source.split("\n")
    about = ast.get_docstring(tree) or ""
    body = tree.body[1:] if about else tree.body
    found: list[Piece] = []
    start = (tree.body[0].end_lineno or 0) if about else 0
    for node in body:
        end = node.end_lineno or start
        while end < len(lines) and lines[end].startswith((" ", "\t")):
            end += 1  # a comment below the last statement of a function is the function's
        text = "\n".join(lines[start:end]).strip("\n")
        start = end
        name = node.name if isinstance(node, ast.FunctionDef) and node.name in tasks else ""
        if not name and found and not found[-1].task:
            found[-1] = Piece("", f"{found[-1].text}\n{_gap(text, node)}{text}")
        else:
            found.append(Piece(name, text))
    return about, found


def _gap(text: str, node: ast.stmt) -> str:
    """The empty lines that a formatter would put before a statement."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return "\n\n"
    return "" if text.startswith(("import ", "from ")) else "\n"


# ---
# An exercise as a notebook: its README, a cell for each function, and its public checks after each.


_LOAD = "%load_ext course.notebooks"
_HOW = """\
## Work in the cells below

Write each function in its cell, run the cell, then run the check below it. Only the cells with your functions
are graded, and whatever other cells define that they use; plots, experiments and outputs are yours. After a
check that failed, `%course_hint {exercise}` gives a hint. If Jupyter does not know these words, run the next
cell: that is needed once after every start of the kernel. From a terminal, `course notebook check {file}`
checks the whole file."""
_LAST = """\
## All of it

All public checks at once; the hidden ones run when it is graded."""
_HAND_IN = """\
## Hand in

Save the notebook, take the # away and run the cell: it checks what goes in, just as it will be read when it
is graded, and writes one file. Upload that file where your instructor wants it."""
#: A link between files of the course: a notebook may lie anywhere, so it cannot follow it.
_LINK = re.compile(r"\[([^\]]+)\]\((lesson|exercise):([a-z0-9-]+)[^)]*\)")
_REPORT = """\
## See what your code does

Your functions on public data, in words, tables and figures. Sections that need a function you have not
written yet say so."""


def exercise_notebook(catalog: Catalog, exercise: Exercise) -> bytes:
    """The notebook file of an exercise, with its stub's functions to fill in."""
    cells = exercise_cells(exercise, exercise.stub_path.read_text(encoding="utf-8"))
    return document(cells, kind="exercise", id=exercise.id, version=catalog.version)


def exercise_cells(exercise: Exercise, source: str) -> list[Cell]:
    """The cells, in the order in which a student works through them.

    Args:
        source: the module's text: the stub, or a student's work that goes into a notebook.
    """
    tasks = {task.id: task for task in exercise.task}
    about, parts = pieces(source, tasks)
    readme = _LINK.sub(_as_command, _in_notebook(exercise))
    first, above, last = _placed(_sections(readme), list(tasks))
    cells = [opening(first), *map(markdown, above.pop("", ()))]
    file = exercise.stub_path.with_suffix(".ipynb").name
    here = about.replace("README.md", "This notebook")
    cells.append(markdown(f"{_HOW.format(file=file, exercise=exercise.id)}\n\n{here}"))
    cells.append(code(_LOAD, role="tools", exercise=exercise.id))
    for part in parts:
        if not part.task:
            cells.append(code(part.text, role=SETUP, exercise=exercise.id))
            continue
        cells += map(markdown, above.get(part.task, ()))
        task = tasks[part.task]
        cells.append(markdown(f"### {task.title}: `{task.id}` ({in_points(task.points)})"))
        of = {"exercise": exercise.id, "task": part.task}
        cells.append(code(part.text, role=SOLUTION, **of))
        cells.append(code(f"%course_check {exercise.id} {part.task}", role="check", **of))
    cells += map(markdown, last)
    cells.append(markdown(_LAST))
    cells.append(code(f"%course_check {exercise.id}", role="check", exercise=exercise.id))
    if has_report(exercise):
        cells.append(markdown(_REPORT))
        cells.append(code(f"%course_report {exercise.id}", role="report", exercise=exercise.id))
    cells.append(markdown(_HAND_IN))
    cells.append(code(f"# %course_submit {exercise.id}", role="hand-in", exercise=exercise.id))
    return cells


def _in_notebook(exercise: Exercise) -> str:
    """The README as it is true here: the functions stand in the notebook, so nothing has to import them."""
    readme = exercise.readme_path.read_text(encoding="utf-8")
    own = rf"from {re.escape(exercise.stub_path.stem)} import .*\n"
    imports = re.compile(rf"(?<=```python\n){own}\n?|^{own}", re.MULTILINE)
    readme = imports.sub("", readme).replace(f"`{exercise.module}`", "this notebook")
    return readme.replace(f"`course check {exercise.id}`", f"`%course_check {exercise.id}`")


def _as_command(link: re.Match[str]) -> str:
    words, kind, name = link.groups()
    return f"{words} (`course {'start' if kind == 'exercise' else 'lesson'} {name}`)"


def _sections(readme: str) -> list[str]:
    """A README, cut before each heading; fenced blocks stay whole, and a heading has text below it."""
    found: list[list[str]] = [[]]
    fenced = False
    for line in readme.strip("\n").split("\n"):
        if re.match(r"\s*(```|~~~)", line):
            fenced = not fenced
        if line.startswith(("## ", "### ")) and not fenced and any(found[-1][1:]):
            found.append([])
        found[-1].append(line)
    return ["\n".join(lines) for lines in found if any(lines)]


def _placed(sections: list[str], tasks: list[str]) -> tuple[str, dict[str, list[str]], list[str]]:
    """The first section, those above each function ("" for above all), and what stands below the last.

    A section stands above the first function that its heading names, or else its text. One that names most of
    them, or none, follows the section before it; the last one says what is checked.
    """
    first, *between = sections
    last = [between.pop()] if between and "checked" in between[-1].partition("\n")[0] else []
    above: dict[str, list[str]] = {}
    at = ""
    for section in between:
        heading = section.partition("\n")[0]
        named = [task for task in tasks if f"`{task}" in heading] or [t for t in tasks if f"`{t}" in section]
        at = named[0] if 0 < len(named) <= len(tasks) / 2 else at
        above.setdefault(at, []).append(section)
    return first, above, last


# ---
# A warm-up in its place in a lesson's notebook: its text, and a cell that checks itself when it is run.
#
# The cell stands for the warm-up's file. It does not run in the notebook's kernel, so its names cannot change
# the results of the lesson's own cells.


_ASKED = """\
### Warm-up: {title}

*About {minutes}; it counts for nothing. The cell below is its file: change it and run it, and it is
checked at once. If Jupyter does not know `%%course_check`, run the first cell of code above.*

{text}"""


def warm_up_cells(exercise: Exercise, task: b.Task, lowering: Lowering) -> list[Cell]:
    """Its text, and the stub to mend or to fill in."""
    text = "\n\n".join(lowering.block(block) for block in task.blocks)
    asked = _ASKED.format(title=task.title, minutes=counted(exercise.minutes, "minute"), text=text)
    stub = exercise.stub_path.read_text(encoding="utf-8")
    return [
        markdown(asked, role="warm-up", exercise=exercise.id),
        code(f"%%course_check {exercise.id}\n{stub}", role="warm-up", exercise=exercise.id),
    ]


# ---
# A lesson as a notebook: its text, its code and figures as running cells, a cell for each prediction.


_FIGURES = "from course.notebooks.show import figure"
_CHECKS = "%load_ext course.notebooks"
_PREDICTIONS = "from course.notebooks.predicting import predict"


def lesson_notebook(catalog: Catalog, lesson_id: str, layout: Layout) -> bytes:
    """The notebook file of a lesson.

    Raises:
        ContentError: the lesson's file is wrong.
    """
    lesson = catalog.lesson(lesson_id)
    cells = _lesson_cells(catalog, lesson, layout)
    return document(cells, kind="lesson", id=lesson.id, version=catalog.version)


def _lesson_cells(catalog: Catalog, lesson: Lesson, layout: Layout) -> list[Cell]:
    """The cells, in reading order; the text between two code cells is one cell for each section."""
    tasks = {one.id: one for one in catalog.warm_ups(lesson.id)}
    blocks = with_tasks(read_blocks(catalog.content.lessons / f"{lesson.id}.md"), tuple(tasks.values()))
    lowering = Lowering(layout.links(catalog, lesson.id))
    cells = [opening(_head(lesson))]
    kinds = {type(block) for block in b.walk_blocks(blocks)}
    needed = ((b.Task, _CHECKS), (b.Figure, _FIGURES), (b.Prediction, _PREDICTIONS))
    setup = [line for kind, line in needed if kind in kinds]
    if setup:
        cells.append(code("\n".join(setup), role="setup"))
    text: list[str] = []
    predictions = 0

    def flush() -> None:
        if text:
            cells.append(markdown("\n\n".join(text)))
            text.clear()

    for block in blocks:
        match block:
            case b.CodeCell(source=source, hidden=hidden):
                flush()
                cells.append(code(source, role="hidden" if hidden else "lesson"))
            case b.Figure(id=name, alt=alt, caption=caption):
                flush()
                cells.append(code(f'figure("{name}", lesson="{lesson.id}")', role="figure"))
                cells.append(markdown(_CAPTION.format(caption=lowering.inlines(caption), alt=alt)))
            case b.Prediction(blocks=inner):
                flush()
                predictions += 1
                cells.append(markdown(lowering.boxed("predict", inner)))
                cells.append(code(_PREDICT.format(number=predictions, lesson=lesson.id), role="prediction"))
            case b.Task(id=name):
                flush()
                cells += warm_up_cells(tasks[name], block, lowering)
            case b.Callout(kind="answer"):
                text.append(_FOLDED.format(answer=lowering.block(block)))
            case b.Heading():
                flush()
                text.append(lowering.block(block))
            case _:
                text.append(lowering.block(block))  # it takes every other kind, and mypy says if not
    flush()
    cells.append(code(_END.format(lesson=lesson.id), role="end"))
    return [_collapsed(cell) for cell in cells]


_PREDICT = '''my_prediction_{number} = """

"""  # write it down before you go on: a guess that is written is a guess that teaches
predict("{lesson}", {number}, my_prediction_{number})'''
_END = """# The end: run this cell, and the lesson counts as read.
from course.notebooks.predicting import finish

finish("{lesson}")"""
_CAPTION = """\
*{caption}*

<details><summary>What the figure shows, in words</summary>{alt}</details>"""
_FOLDED = """\
<details><summary>The answer: predict first</summary>

{answer}

</details>"""


def _head(lesson: Lesson) -> str:
    objectives = "\n".join(f"- {objective}" for objective in lesson.objectives)
    return (
        f"# {lesson.title}\n\n{lesson.summary}\n\n"
        f"About {counted(lesson.minutes, 'minute')}. Afterwards you can:\n\n{objectives}"
    )


def _collapsed(cell: Cell) -> Cell:
    """Code that only makes numbers or pictures starts folded; it still runs."""
    if cell.tags.get("role") not in {"hidden", "figure", "setup"}:
        return cell
    return Cell(cell.kind, cell.source, {**cell.metadata, "jupyter": {"source_hidden": True}})
