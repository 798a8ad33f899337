"""The global options, anywhere on the line; a command's own options, and what the shell completes for them.

Parsers of sub-commands know only their own options, so these are taken out of the arguments first. ``--``
ends the search: what follows it is data. For the shell there are folder and file names, so that nothing is
parsed to list them.
"""

import ast
import importlib
from collections.abc import Callable, Iterable, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from course.cli.frame.console import Settings
from course.errors import CourseError, NotFoundError
from course.ids import WARM_UPS

_FLAGS = {"--json": "json", "--plain": "plain", "--quiet": "quiet", "-q": "quiet", "--version": "version"}


@dataclass(frozen=True, slots=True)
class Line:
    """A command line taken apart.

    Attributes:
        rest: everything else, in order.
        version: ``--version`` was given.
        problem: what is wrong with the global options; empty if nothing is. It is reported later, by the
            one place that reports, in the shape the other options ask for.
    """

    settings: Settings
    rest: tuple[str, ...]
    version: bool = False
    problem: str = ""


def global_options(arguments: Sequence[str]) -> Line:
    found: set[str] = set()
    directory: str | None = None
    rest: list[str] = []
    problem = ""
    words = iter(arguments)
    for word in words:
        if word == "--":
            rest += [word, *words]
        elif word in _FLAGS:
            found.add(_FLAGS[word])
        elif word.startswith("-C"):
            folder = word.removeprefix("-C") or next(words, None)
            if folder is None:
                problem = "-C needs the folder to work in."
            else:  # two in a row add up, the second below the first
                directory = folder if directory is None else str(Path(directory) / folder)
        else:
            rest.append(word)
    settings = Settings(
        json="json" in found, plain="plain" in found, quiet="quiet" in found, directory=directory
    )
    return Line(settings=settings, rest=tuple(rest), version="version" in found, problem=problem)


# ---
# How a command declares its arguments and options.


def argument(value: str, help: str | None = None, complete: Any = None) -> Any:  # noqa: A002 - typer's name
    """An argument: what its value is called, what it is, and what the shell offers."""
    return typer.Argument(metavar=value, help=help, autocompletion=complete)


def option(names: str, help: str | None = None, complete: Any = None, **limits: Any) -> Any:  # noqa: A002
    """An option: its names and what its value is called, as in "-o --output FILE"; the rest as above.

    Args:
        limits: what else typer knows of a value, such as the least that it may be.
    """
    named = [word for word in names.split() if word.startswith("-")]
    value = " ".join(names.split()[len(named) :]) or None
    return typer.Option(*named, metavar=value, help=help, autocompletion=complete, **limits)


# ---
# Ids for the shell to complete.


def choice_of(*values: str) -> Callable[[str], list[str]]:
    def complete(incomplete: str) -> list[str]:
        return _beginning(incomplete, values)

    return complete


def exercise_ids(incomplete: str) -> list[str]:
    """Exercises and warm-ups whose id begins with what was typed."""
    found = _in_content("exercises", "*/exercise.toml")
    return _beginning(incomplete, (*(file.parent.name for file in found), *warm_up_ids("")))


def warm_up_ids(incomplete: str) -> list[str]:
    return _beginning(incomplete, (folder.name for folder in _in_content("exercises", f"{WARM_UPS}/*")))


def lesson_ids(incomplete: str) -> list[str]:
    return _beginning(incomplete, (file.stem for file in _in_content("lessons", "*.md")))


def _key_of(module: str, table: str) -> Callable[[str], list[str]]:
    """Completes a key of a table in a module, which is imported when something is completed."""

    def complete(incomplete: str) -> list[str]:
        return _beginning(incomplete, getattr(importlib.import_module(module), table))

    return complete


simulation_ids = _key_of("course.simulations.registry", "SIMULATIONS")
engine_ids = _key_of("course.engines.registry", "ENGINES")
figure_ids = _key_of("course.figures.registry", "FIGURES")
#: Of the engine comparison.
scenario_ids = _key_of("course.engines.scenarios", "SCENARIOS")


_SCENES = Path(__file__).parents[2] / "sandbox" / "scenes"


def scene_ids(incomplete: str) -> list[str]:
    return _beginning(incomplete, (path.stem for path in _SCENES.glob("*.toml")))


def notebook_ids(incomplete: str) -> list[str]:
    """Everything that has a notebook, and whose id begins with what was typed."""
    extra = [name for name in ("quiz", "sandbox") if name.startswith(incomplete)]
    return sorted({*exercise_ids(incomplete), *lesson_ids(incomplete), *extra})


def task_ids(ctx: Any, incomplete: str) -> list[str]:
    """Functions of the exercise on the line, or of all of them where none is named."""
    import tomllib

    files = _of_exercises(ctx, "exercise.toml")
    heads = (tomllib.loads(file.read_text(encoding="utf-8")) for file in files)
    return _beginning(incomplete, (task["id"] for head in heads for task in head.get("task", ())))


def check_ids(ctx: Any, incomplete: str) -> list[str]:
    """Public checks of the exercise on the line, or of all of them; their modules are read, not run."""
    trees = (ast.parse(file.read_bytes()) for file in _of_exercises(ctx, "checks.py"))
    names = (node.name for tree in trees for node in tree.body if isinstance(node, ast.FunctionDef))
    return _beginning(incomplete, (name.removeprefix("test_") for name in names if name.startswith("test_")))


def simulation_settings(ctx: Any, incomplete: str) -> list[str]:
    """The names that ``--set`` takes for the simulation on the line, with the equals sign."""
    from course.simulations.registry import get

    with suppress(NotFoundError):
        return _beginning(incomplete, (f"{one.name}=" for one in get(_given(ctx, "name")).parameters))
    return []


def scene_settings(ctx: Any, incomplete: str) -> list[str]:
    """The names that ``--set`` takes for the scene on the line, with the equals sign."""
    from course.strangers import read_bytes, toml

    name = _given(ctx, "scene")
    path = Path(name) if name.endswith(".toml") else _SCENES / f"{name}.toml"
    with suppress(OSError, ValueError):
        found = toml(read_bytes(path).decode()).get("parameter", ())
        return _beginning(incomplete, (f"{one['name']}=" for one in found))
    return []


def submitted_ids(ctx: Any, incomplete: str) -> list[str]:
    """Students who handed something in to the folder on the line."""
    with suppress(OSError):
        folders = (entry for entry in Path(_given(ctx, "submissions")).iterdir() if entry.is_dir())
        return _beginning(incomplete, (folder.name for folder in folders))
    return []


def _column(query: str) -> Callable[[Any, str], list[str]]:
    """Completes what a query finds in the gradebook on the line; nothing where that cannot be read."""

    def complete(ctx: Any, incomplete: str) -> list[str]:
        import sqlite3

        from course.strangers import no_programs

        path = Path(_given(ctx, "out"), "gradebook.sqlite").resolve()
        with (
            suppress(sqlite3.Error, UnicodeDecodeError),
            closing(sqlite3.connect(f"{path.as_uri()}?mode=ro", uri=True)) as book,
        ):
            no_programs(book, millions=5)
            return _beginning(incomplete, (str(value) for (value,) in book.execute(query)))
        return []

    return complete


#: Students of the grading run on the line.
student_ids = _column("SELECT student FROM results UNION SELECT student FROM students")
#: Exercises of the grading run on the line, the quiz among them.
graded_ids = _column("SELECT id FROM exercises")
#: Runs that the gradebook on the line has had, by their numbers.
run_numbers = _column("SELECT number FROM runs")


def _beginning(incomplete: str, names: Iterable[str]) -> list[str]:
    return sorted(name for name in names if name.startswith(incomplete))


def _given(ctx: Any, name: str) -> str:
    """The first argument of the command; "" if it is not on the line.

    A line that ends in an option without its value cannot be parsed. The arguments that the parser had read
    by then have no names yet.
    """
    return str(ctx.params.get(name) or (ctx.args[0] if ctx.args else ""))


def _of_exercises(ctx: Any, name: str) -> list[Path]:
    """A file of the exercise on the line, or of every exercise where none is named."""
    wanted = _given(ctx, "exercise") or "*"
    return _in_content("exercises", f"{wanted}/{name}", f"{WARM_UPS}/{wanted}/{name}")


def _in_content(folder: str, *patterns: str) -> list[Path]:
    """Files and folders of the course's content; none where it cannot be found."""
    from course.catalog.locate import content

    with suppress(CourseError, OSError, ValueError):
        root: Path = getattr(content(), folder)
        return sorted(path for pattern in patterns for path in root.glob(pattern))
    return []


def grade_lists(incomplete: str) -> list[str]:
    """Grades that a student gives, joined by commas: what was typed with the next one."""
    before, comma, last = incomplete.rpartition(",")
    return [f"{before}{comma}{grade}" for grade in ("yes", "partly", "no") if grade.startswith(last)]


# ---
# Arguments and options that several commands share.


#: An exercise, or the one the folder is of, or the one last worked on; or the path of its file.
ExerciseName = Annotated[
    str | None,
    argument(
        "EXERCISE", "Its id, its number, or its file; the one last worked on if left out.", exercise_ids
    ),
]

#: An exercise that must be named.
OneExercise = Annotated[str, argument("EXERCISE", "Its id or its number.", exercise_ids)]

#: A lesson, or the next unread one.
LessonName = Annotated[
    str | None,
    argument(
        "ID", "Its id or its number, and perhaps #SECTION; the next unread one if left out.", lesson_ids
    ),
]

#: A warm-up, or all of them.
WarmUpName = Annotated[
    str | None, argument("ID", "Its id or its number; a list of all if left out.", warm_up_ids)
]

#: What a verdict hides.
Verbose = Annotated[bool, option("--verbose -v", "Show tracebacks and all that your code printed.")]
