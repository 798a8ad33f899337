"""From a wrong value to a named mistake.

A task whose values are wrong is asked the questions of its exercise: a few fixed calls, the same at home and
in a grading run. What it answers is compared with what each known wrong program answers (``table``). A
program that answers as the student's does on every number decides the diagnosis; where there is none, the
probes of the single checks speak, and of several the one that the others do not contradict (``story``). The
words are data (``words``).
"""

from course.scoring.explain.fingerprint import Answers, fingerprint
from course.scoring.explain.story import Failure, Story, story_of
from course.scoring.explain.table import Row, Table, matching, read_table
from course.scoring.explain.words import Diagnosis, Words, read_words

__all__ = [
    "Answers",
    "Diagnosis",
    "Failure",
    "Row",
    "Story",
    "Table",
    "Words",
    "fingerprint",
    "matching",
    "read_table",
    "read_words",
    "story_of",
]
