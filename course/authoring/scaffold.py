"""New lessons and exercises: files in the right places, with marked blanks for the author.

The audit names every remaining blank, with file and line, and proves the rest once they are filled. Nothing
is ever overwritten, and either all files are written or none: an id or a signature that is none, a name that
is taken and a file that exists raise UsageError, and a student's installation MissingCapabilityError.
"""

import ast
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import jinja2

from course.authoring.exercises.proofs import MUTANTS_EACH
from course.catalog.load import Catalog
from course.errors import UsageError
from course.ids import WARM_UPS, ExerciseId, LessonId, QuestionId, SceneId

_TEMPLATES = Path(__file__).parent / "templates"


@dataclass(frozen=True, slots=True)
class Function:
    """A function that a new exercise asks for.

    Attributes:
        signature: as it stands in the stub: "swing_period(length, gravity=9.81)".
        gives: its result, as a sentence without a subject: "gives the period of small swings, s."
    """

    signature: str
    gives: str = ""

    @classmethod
    def parse(cls, text: str, gives: str = "") -> Self:
        """A function as its author writes it."""
        try:
            (node,) = ast.parse(f"def {text.strip()}: ...").body
        except (SyntaxError, ValueError):
            node = None
        plain = isinstance(node, ast.FunctionDef) and node.args.args and not node.args.vararg
        if not plain or "\n" in text.strip():
            raise UsageError(
                f"{text!r} is not a function with its arguments.",
                help="Write it as in the stub: swing_period(length, gravity)",
                code="bad_signature",
            )
        return cls(text.strip(), gives.strip())

    @property
    def name(self) -> str:
        return self.signature.partition("(")[0].strip()

    @property
    def docstring(self) -> str:
        """Its docstring in the stub."""
        if self.gives:
            return self.gives[:1].upper() + self.gives[1:]
        return "<<FILL IN: what it gives; shapes and units of arguments and result>>"

    @property
    def readme(self) -> str:
        """Its description in the README, after its name."""
        return self.gives or "<<FILL IN: what it gives, with formula, shapes and units of its arguments>>"

    def _arguments(self, first: float = 1.0) -> dict[str, float]:
        """By name; no two are equal, so that it shows when they are exchanged."""
        (node,) = ast.parse(f"def {self.signature}: ...").body
        assert isinstance(node, ast.FunctionDef)
        return {argument.arg: first + index / 2 for index, argument in enumerate(node.args.args)}

    @property
    def names(self) -> str:
        """The names of its arguments, as a tuple in Python."""
        return str(tuple(self._arguments())).replace("'", '"')

    def arguments(self, first: float) -> str:
        """Arguments of one call, as a tuple in Python."""
        return str(tuple(self._arguments(first).values()))

    def case(self, first: float) -> str:
        """Arguments of one call, as a dict in Python."""
        return json.dumps(self._arguments(first))


def new_exercise(
    catalog: Catalog,
    exercise_id: str,
    functions: Sequence[Function] = (),
    *,
    title: str = "",
    summary: str = "",
    lesson: str = "",
    warm_up: bool = False,
) -> tuple[Path, ...]:
    """Write the files of a new exercise, with all that is known about it filled in.

    Args:
        functions: that it asks for; one of the exercise's own name and an ``x`` if none is given.
        title, summary: its title, and one line for lists; blanks are left if empty.
        lesson: id of the one to read first; the last one if empty.
        warm_up: a small one: public checks only, two accepted variants, three mutants a function.

    Returns:
        The files, in the order an author fills them.
    """
    name = ExerciseId(exercise_id)
    if name in (*catalog.exercise_ids(), *catalog.warm_up_ids()):
        raise _exists(f"There is a {name} already")
    asked = tuple(functions) or (Function(f"{name.replace('-', '_')}(x)"),)
    if len({function.name for function in asked}) < len(asked):
        raise UsageError("Two functions have one name.", help="Name each one once.", code="bad_signature")
    if lesson:
        catalog.lesson(lesson)
    lessons = catalog.lesson_ids()
    lesson = lesson or (lessons[-1] if lessons else "<<FILL IN: id of the lesson to read first>>")
    others = catalog.warm_ups(lesson) if warm_up else catalog.exercises()
    module = _module(name.replace("-", "_"))
    words = {
        "id": name,
        "module": module,
        "functions": asked,
        "each": MUTANTS_EACH,
        "title": title or "<<FILL IN: what people call it>>",
        "summary": summary or "<<FILL IN: what it is about, in one line>>",
        "lesson": lesson,
        "order": 1 + max((one.order for one in others), default=0),
    }
    place = Path(WARM_UPS, name) if warm_up else Path(name)
    student = catalog.content.exercises / place
    solutions, graders = (folder / place for folder in catalog.content.instructors())
    if warm_up:
        own = ("exercise.toml", "README.md", "checks.py")
        files = {student / file: (f"warm-up/{file}", words) for file in own}
        files[student / module] = ("exercise/stub.py", words)
        files[solutions / module] = ("exercise/solution.py", words)
        files[solutions / "mistakes.py"] = ("warm-up/mistakes.py", words)
        return _write(files)
    files = {
        student / "exercise.toml": ("exercise.toml", words),
        student / "README.md": ("README.md", words),
        student / module: ("stub.py", words),
        student / "checks.py": ("checks.py", words),
        student / "questions.py": ("questions.py", words),
        graders / "checks.py": ("hidden_checks.py", words),
        solutions / module: ("solution.py", words),
        solutions / "README.md": ("prose.md", words),
        solutions / "mistakes.py": ("mistakes.py", words),
    }
    for number, function in enumerate((*asked, asked[0]), start=1):
        path = solutions / "accepted" / f"unusual_{number}.py"
        files[path] = ("unusual.py", words | {"f": function})
    return _write({path: (f"exercise/{template}", known) for path, (template, known) in files.items()})


def new_lesson(catalog: Catalog, lesson_id: str) -> tuple[Path, ...]:
    """Write the file of a new lesson; its place in the syllabus is the author's to choose."""
    catalog.content.instructors()
    name = LessonId(lesson_id)
    return _write({catalog.content.lessons / f"{name}.md": ("lesson.md", {"id": name})})


def new_question(catalog: Catalog, question_id: str) -> tuple[Path, ...]:
    """Write the file of a new quiz question, with as many variants as the audit asks for."""
    catalog.content.instructors()
    name = QuestionId(question_id)
    lessons = catalog.lesson_ids()
    words = {
        "id": name,
        "lesson": lessons[-1] if lessons else "<<FILL IN: id of the lesson it is about>>",
        "order": str(1 + len(catalog.question_ids())),
    }
    return _write({catalog.content.quiz / f"{name}.toml": ("question.toml", words)})


def new_scene(catalog: Catalog, scene_id: str) -> tuple[Path, ...]:
    """Write the file of a new sandbox scene, last in the list; it can run at once.

    It lies with the program's own for an author who is in the checkout, in ``scenes/`` of the course that
    ``COURSE_CONTENT`` names, and elsewhere where one is, as a scene of one's own.
    """
    from course.sandbox.scene.loading import FOLDER, scene_ids

    catalog.content.instructors()
    name, root = SceneId(scene_id), catalog.content.root
    here, folder = Path.cwd(), root / "scenes"
    if FOLDER.is_relative_to(root):
        folder = FOLDER if here.is_relative_to(root) else here
    if name in scene_ids():
        raise _exists(f"There is a scene {name} already")
    words = {"id": name, "order": str(1 + len(scene_ids()))}
    return _write({folder / f"{name}.toml": ("scene.toml", words)})


def _exists(what: str) -> UsageError:
    return UsageError(f"{what}, and nothing is overwritten.", help="Choose another id.", code="exists")


def _module(function: str) -> str:
    if function in {"checks", "diagnosis", "mistakes", "questions"}:
        raise UsageError(
            f"An exercise cannot be called {function}: its folder has a file of that name already.",
            help="Choose another id.",
            code="invalid_id",
        )
    return f"{function}.py"


def _write(files: Mapping[Path, tuple[str, Mapping[str, Any]]]) -> tuple[Path, ...]:
    """Fill each template with its words and write it where nothing is yet."""
    for target in files:
        if target.exists() or target.is_symlink():
            raise _exists(f"{target} exists")
    # Nothing is escaped: these are Python, TOML and Markdown.
    templates = jinja2.Environment(
        loader=jinja2.FileSystemLoader(_TEMPLATES),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    texts = {
        target: templates.get_template(f"{name}.tmpl").render(words)
        for target, (name, words) in files.items()
    }
    written: list[Path] = []
    try:
        for target, text in texts.items():
            target.parent.mkdir(parents=True, exist_ok=True)
            with target.open("x", encoding="utf-8", newline="\n") as file:
                written.append(target)
                file.write(text)
    except BaseException as error:
        for path in written:
            path.unlink()
        if isinstance(error, OSError):
            raise UsageError(
                f"{target} cannot be written: {error.strerror}.",
                help="Nothing was written. Make room for it.",
            ) from None
        raise
    return tuple(files)
