"""New lessons and exercises: files in the right places, with marked blanks where an author has to write.

The audit names every blank that is left, with file and line, and proves the rest once they are filled.
Nothing is ever overwritten, and either all files are written or none.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from course.authoring.exercises.variants import instructors
from course.errors import UsageError
from course.ids import ExerciseId, LessonId, QuestionId, SceneId

if TYPE_CHECKING:
    from course.catalog.load import Catalog

__all__ = ["new_exercise", "new_lesson", "new_question", "new_scene"]

_TEMPLATES = Path(__file__).parent / "templates"


def new_exercise(catalog: Catalog, exercise_id: str) -> tuple[Path, ...]:
    """Write the files of a new exercise.

    Returns:
        The files, in the order an author fills them.

    Raises:
        UsageError: the id is no id, cannot be a module, or one of the files exists.
        MissingCapabilityError: this installation has no place for solutions and graders.
    """
    name = ExerciseId(exercise_id)
    solutions, graders = (folder / name for folder in instructors(catalog))
    student = catalog.content.exercises / name
    function = name.replace("-", "_")
    module = _module(function)
    lessons = catalog.lesson_ids()
    words = {
        "id": name,
        "module": module,
        "function": function,
        "lesson": lessons[-1] if lessons else "<<FILL IN: id of the lesson to read first>>",
        "order": str(1 + max((exercise.order for exercise in catalog.exercises()), default=0)),
    }
    templates = _TEMPLATES / "exercise"
    return _write(
        {
            student / "exercise.toml": templates / "exercise.toml.tmpl",
            student / "README.md": templates / "README.md.tmpl",
            student / module: templates / "stub.py.tmpl",
            student / "hints.toml": templates / "hints.toml.tmpl",
            student / "checks.py": templates / "checks.py.tmpl",
            graders / "checks.py": templates / "hidden_checks.py.tmpl",
            solutions / module: templates / "solution.py.tmpl",
            solutions / "README.md": templates / "prose.md.tmpl",
            solutions / "mutants.toml": templates / "mutants.toml.tmpl",
            solutions / "accepted" / "unusual.py": templates / "unusual.py.tmpl",
            solutions / "mutants" / "wrong.py": templates / "wrong.py.tmpl",
        },
        words,
    )


def new_lesson(catalog: Catalog, lesson_id: str) -> tuple[Path, ...]:
    """Write the file of a new lesson; its place in the syllabus is the author's to choose.

    Raises:
        UsageError: the id is no id, or the file exists.
        MissingCapabilityError: this is a student's installation.
    """
    instructors(catalog)
    name = LessonId(lesson_id)
    return _write({catalog.content.lessons / f"{name}.md": _TEMPLATES / "lesson.md.tmpl"}, {"id": name})


def new_question(catalog: Catalog, question_id: str) -> tuple[Path, ...]:
    """Write the file of a new quiz question, with as many variants as the audit asks for.

    Raises:
        UsageError: the id is no id, or the file exists.
        MissingCapabilityError: this is a student's installation.
    """
    instructors(catalog)
    name = QuestionId(question_id)
    lessons = catalog.lesson_ids()
    words = {
        "id": name,
        "lesson": lessons[-1] if lessons else "<<FILL IN: id of the lesson it is about>>",
        "order": str(1 + len(list(catalog.content.quiz.glob("*.toml")))),
    }
    return _write({catalog.content.quiz / f"{name}.toml": _TEMPLATES / "question.toml.tmpl"}, words)


def new_scene(catalog: Catalog, scene_id: str) -> tuple[Path, ...]:
    """Write the file of a new sandbox scene, last in the list; it runs as it is.

    Raises:
        UsageError: the id is no id, or the file exists.
        MissingCapabilityError: this is a student's installation.
    """
    from course.sandbox.scene.loading import FOLDER, scene_ids

    instructors(catalog)
    name = SceneId(scene_id)
    words = {"id": name, "order": str(1 + len(scene_ids()))}
    return _write({FOLDER / f"{name}.toml": _TEMPLATES / "scene.toml.tmpl"}, words)


def _module(function: str) -> str:
    if function in {"checks", "diagnosis"}:
        raise UsageError(
            f"An exercise cannot be called {function}: its folder has a file of that name already.",
            help="Choose another id.",
            code="invalid_id",
        )
    return f"{function}.py"


def _write(files: dict[Path, Path], words: dict[str, str]) -> tuple[Path, ...]:
    """Fill each template and write it where nothing is yet."""
    for target in files:
        if target.exists() or target.is_symlink():
            raise UsageError(
                f"{target} exists, and nothing is overwritten.", help="Choose another id.", code="exists"
            )
    for target, template in files.items():
        text = template.read_text(encoding="utf-8")
        for key, word in words.items():
            text = text.replace(f"@{key}@", word)
        target.parent.mkdir(parents=True, exist_ok=True)
        with target.open("x", encoding="utf-8", newline="\n") as file:
            file.write(text)
    return tuple(files)
