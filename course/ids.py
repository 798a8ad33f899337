"""Identifiers of lessons, exercises, questions and scenes.

An id is what people type and what files are named after: lower-case words joined by hyphens. It is parsed
where it enters; past that point the type says that it is safe in a path, a URL and a shell word.
"""

import re
from typing import Self

from course.errors import UsageError

#: The folder that warm-ups lie in: among the exercises, their solutions, and in a workspace.
WARM_UPS = "warm-ups"

#: Lower-case words joined by hyphens.
SLUG = re.compile(r"[a-z][a-z0-9]*(?:-[a-z0-9]+)*")
_MAX_LENGTH = 60


class _Id(str):
    """A checked id; equal to, hashed and sorted as the string it is."""

    __slots__ = ()
    kind = "id"

    def __new__(cls, text: str) -> Self:
        if len(text) > _MAX_LENGTH or not SLUG.fullmatch(text):
            raise UsageError(
                f"{text[:80]!r} is not a valid {cls.kind} id.",
                help=f"Use lower-case words joined by hyphens, at most {_MAX_LENGTH} letters: sim-to-real.",
                code="invalid_id",
            )
        return super().__new__(cls, text)


class LessonId(_Id):
    """Id of a lesson: the name of its Markdown file."""

    __slots__ = ()
    kind = "lesson"


class ExerciseId(_Id):
    """Id of an exercise: the name of its folder."""

    __slots__ = ()
    kind = "exercise"


class QuestionId(_Id):
    """Id of a quiz question: the name of its file."""

    __slots__ = ()
    kind = "question"


class SceneId(_Id):
    """Id of a sandbox scene: the name of its file."""

    __slots__ = ()
    kind = "scene"
