"""Ids for the shell to complete; folder and file names, so that nothing is parsed to list them."""

from __future__ import annotations

__all__ = ["exercise_ids", "lesson_ids", "simulation_ids"]


def exercise_ids(incomplete: str) -> list[str]:
    """Exercises whose id begins with what was typed."""
    from course.catalog.locate import content
    from course.errors import CourseError

    try:
        folders = list(content().exercises.iterdir())
    except (CourseError, OSError):
        return []
    names = (folder.name for folder in folders if (folder / "exercise.toml").is_file())
    return sorted(name for name in names if name.startswith(incomplete))


def lesson_ids(incomplete: str) -> list[str]:
    """Lessons whose id begins with what was typed."""
    from course.catalog.locate import content
    from course.errors import CourseError

    try:
        files = list(content().lessons.glob("*.md"))
    except (CourseError, OSError):
        return []
    return sorted(file.stem for file in files if file.stem.startswith(incomplete))


def simulation_ids(incomplete: str) -> list[str]:
    """Simulations whose id begins with what was typed."""
    from course.simulations.registry import SIMULATIONS

    return sorted(name for name in SIMULATIONS if name.startswith(incomplete))
