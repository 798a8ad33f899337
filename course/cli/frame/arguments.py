"""Arguments that several commands share."""

from __future__ import annotations

from typing import Annotated

import typer

from course.cli.frame.completion import exercise_ids, lesson_ids, warm_up_ids

__all__ = ["ExerciseName", "LessonName", "OneExercise", "WarmUpName"]

#: An exercise, or the one the folder is of, or the one last worked on; or the path of its file.
ExerciseName = Annotated[
    str | None,
    typer.Argument(
        metavar="EXERCISE",
        help="Its id, its number, or its file; the one last worked on if left out.",
        autocompletion=exercise_ids,
    ),
]

#: An exercise that must be named.
OneExercise = Annotated[
    str, typer.Argument(metavar="EXERCISE", help="Its id or its number.", autocompletion=exercise_ids)
]

#: A lesson, or the next unread one.
LessonName = Annotated[
    str | None,
    typer.Argument(
        metavar="ID",
        help="Its id or its number, and perhaps #SECTION; the next unread one if left out.",
        autocompletion=lesson_ids,
    ),
]

#: A warm-up, or all of them.
WarmUpName = Annotated[
    str | None,
    typer.Argument(metavar="ID", help="Its id; a list of all if left out.", autocompletion=warm_up_ids),
]
