"""The name under which checks import ``course.scoring.kit``::

from course.grading import kit
"""

from course.scoring import kit as _kit
from course.scoring.kit import *  # noqa: F403 - one set of names, kept where it is defined

__all__ = _kit.__all__
