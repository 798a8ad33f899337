"""The course's own content, and notebooks made of it."""

import pytest

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.notebooks.build import exercise_cells
from course.notebooks.cells import document


@pytest.fixture(scope="session")
def catalog() -> Catalog:
    return Catalog()


@pytest.fixture(scope="session")
def integrators(catalog: Catalog) -> Exercise:
    return catalog.exercise("integrators")


@pytest.fixture(scope="session")
def solution(catalog: Catalog) -> str:
    """The model solution's text."""
    return (catalog.content.solutions / "integrators" / "integrators.py").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def solved(integrators: Exercise, solution: str) -> bytes:
    """The exercise's notebook with the model solution in its cells."""
    return document(exercise_cells(integrators, solution), kind="exercise", id="integrators", version="1")
