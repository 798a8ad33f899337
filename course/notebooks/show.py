"""Functions that the cells of a generated notebook call to show something; none of them needs Jupyter."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Picture", "figure"]


@dataclass(frozen=True)
class Picture:
    """A drawn figure, in the form that Jupyter asks for.

    Attributes:
        name: its id.
        data: the PNG.
    """

    name: str
    data: bytes

    def __repr__(self) -> str:
        return f"<figure {self.name}>"

    def _repr_png_(self) -> bytes:
        return self.data


def figure(name: str) -> Picture:
    """A figure of a lesson, drawn by the course's own code.

    Args:
        name: its id, as in the lesson.

    Raises:
        NotFoundError: there is no figure of that name.
    """
    from course.figures.registry import png

    return Picture(name, png(name))
