"""How the lines of a submission are named in messages to the student."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Places"]


@dataclass(frozen=True, kw_only=True)
class Places:
    """Lines of a file. A notebook has cells, and its own class for them.

    Attributes:
        module: name of the file whose functions are checked.
    """

    module: str = ""

    def phrase(self, line: int) -> str:
        """A line within a sentence: "on line 12 of your file"."""
        return f"on line {line} of your file"

    def heading(self, line: int) -> str:
        """A line at the head of a message: "integrators.py, line 12"."""
        return f"{self.module}, line {line}"

    def trace(self, text: str) -> str:
        """The student's frames, whose lines begin with "integrators.py:12 in "."""
        return text
