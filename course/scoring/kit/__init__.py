"""The functions that checks are written with.

Public checks and hidden graders both import this module, and nothing else from the grading side::

    from course.scoring import kit
    from course.physics import systems

Three groups of names come from here. ``as_...`` read what a student's function returned, which may be any
plain value. ``expect_...`` compare and, when they fail, build the finding that the student reads. The rest
is below: callbacks that count, and modules shared by the checks of one exercise.

This side is trusted: nothing here runs in the process that runs the student's code.
"""

from course.figures.described import Panel, Plot, Series
from course.isolation.failures import StudentFailure
from course.scoring.checks.collected import companion, known_answers, reference, sibling, words
from course.scoring.explain.fingerprint import SAME, in_range
from course.scoring.explain.story import Diagnosis, Words
from course.scoring.failures import CheckFailed, Report, Section, finding_for, guarded_section
from course.scoring.kit.callbacks import (
    Counted,
    Problem,
    acceleration,
    black_box,
    counted,
    first_divergence,
    march_all_errors,
    march_errors,
)
from course.scoring.kit.expectations import (
    Diagnose,
    attempt,
    expect_accepts,
    expect_array,
    expect_bounded,
    expect_close,
    expect_conserved,
    expect_equal,
    expect_evaluations,
    expect_length,
    expect_order,
    expect_raises,
    expect_true,
    expect_untouched,
    fail,
)
from course.scoring.values import (
    Inspected,
    as_array,
    as_bool,
    as_integer,
    as_list,
    as_matrix,
    as_number,
    as_pair,
    as_record,
    as_text,
    as_tuple,
    as_vector,
)
from course.scoring.verdict import Divergence, Finding, Tolerance

__all__ = [
    "SAME",
    "CheckFailed",
    "Counted",
    "Diagnose",
    "Diagnosis",
    "Divergence",
    "Finding",
    "Inspected",
    "Panel",
    "Plot",
    "Problem",
    "Report",
    "Section",
    "Series",
    "StudentFailure",
    "Tolerance",
    "Words",
    "acceleration",
    "as_array",
    "as_bool",
    "as_integer",
    "as_list",
    "as_matrix",
    "as_number",
    "as_pair",
    "as_record",
    "as_text",
    "as_tuple",
    "as_vector",
    "attempt",
    "black_box",
    "companion",
    "counted",
    "expect_accepts",
    "expect_array",
    "expect_bounded",
    "expect_close",
    "expect_conserved",
    "expect_equal",
    "expect_evaluations",
    "expect_length",
    "expect_order",
    "expect_raises",
    "expect_true",
    "expect_untouched",
    "fail",
    "finding_for",
    "first_divergence",
    "guarded_section",
    "in_range",
    "known_answers",
    "march_all_errors",
    "march_errors",
    "reference",
    "sibling",
    "words",
]
