"""Ids for the shell to complete; folder and file names, so that nothing is parsed to list them."""

from __future__ import annotations

__all__ = [
    "engine_ids",
    "exercise_ids",
    "lesson_ids",
    "notebook_ids",
    "scenario_ids",
    "scene_ids",
    "simulation_ids",
]


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


def engine_ids(incomplete: str) -> list[str]:
    """Physics engines whose id begins with what was typed."""
    from course.engines.registry import ENGINES

    return sorted(name for name in ENGINES if name.startswith(incomplete))


def scenario_ids(incomplete: str) -> list[str]:
    """Scenarios of the engine comparison whose id begins with what was typed."""
    from course.engines.scenarios import SCENARIOS

    return sorted(name for name in SCENARIOS if name.startswith(incomplete))


def scene_ids(incomplete: str) -> list[str]:
    """Scenes of the sandbox whose id begins with what was typed; lists a folder."""
    from pathlib import Path

    folder = Path(__file__).parents[2] / "sandbox" / "scenes"
    return sorted(path.stem for path in folder.glob("*.toml") if path.stem.startswith(incomplete))


def notebook_ids(incomplete: str) -> list[str]:
    """Everything there is a notebook of whose id begins with what was typed."""
    extra = [name for name in ("quiz", "sandbox") if name.startswith(incomplete)]
    return sorted({*exercise_ids(incomplete), *lesson_ids(incomplete), *extra})
