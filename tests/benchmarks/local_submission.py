"""The unprotected side of the benchmarks: ``course.authoring.exercises.unprotected``."""

from course.authoring.exercises.unprotected import LocalSubmission

__all__ = ["LocalSubmission"]
