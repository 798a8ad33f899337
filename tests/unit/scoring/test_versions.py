"""The Python and NumPy at home, and those that grade: what only one can read is told before it costs."""

import sys

import pytest

from course.scoring import versions
from course.scoring.verdict import Places
from course.scoring.versions import Graders, notes

PLACES = Places(module="mine.py")
#: What grades, as an instructor's wheel notes it: an old Python, whose modules and NumPy lack some names.
OLD = Graders(
    python="3.9.1",
    numpy="2.4.6",
    names={
        "math": frozenset({"sqrt"}),
        "numpy": frozenset({"asarray", "linalg", "trapezoid"}),
        "numpy.linalg": frozenset({"solve"}),
    },
    modules=frozenset({"math", "os"}),
)


def told(source, graders=OLD):
    return notes(source.encode(), PLACES, graders)


@pytest.mark.parametrize(
    ("source", "line"),
    [
        ("x = 1\nmatch x:\n    case 1:\n        pass\n", 2),
        ("def f():\n    x = 1\n    try:\n        pass\n    except* ValueError:\n        pass\n", 3),
    ],
)
def test_a_statement_that_the_older_python_cannot_read_is_named_with_both_versions(source, line):
    (note,) = told(source)
    here = versions.here()["python"]
    assert note.startswith(
        f"mine.py, line {line}: Python 3.9.1, which grades, cannot read this; you have {here}."
    )


@pytest.mark.skipif(sys.version_info < (3, 12), reason="this Python cannot read it either")
@pytest.mark.parametrize(
    ("source", "is_new"),
    [
        ("f'{d['a']}'", True),
        ("f'{d[\"a\"]}'", False),
        ("f'{f'{x}'}'", True),
        ("f\"{f'{x}'}\"", False),
        ("f'{\"\\n\".join(a)}'", True),
        ("f'\\n{a}'", False),
        ("f'{\na}'", True),
        ("f'''{\na}'''", False),
        ("f'''{d['a']}'''", False),
        ("f'{a!r:>{width}}'", False),
        ("'#' + f'{a}' + '\\n'", False),
    ],
)
def test_a_freer_f_string_is_told_from_one_that_every_python_reads(source, is_new):
    assert bool(told(f"x = 1\n{source}\n", Graders("3.11.7"))) == is_new


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ("import math\nmath.floor(1)", "line 2: Python 3.9.1, which grades, has no `math.floor`; you have"),
        ("from math import sqrt, floor", "line 1: Python 3.9.1, which grades, has no `math.floor`"),
        ("import math as m\nm.floor(1)", "has no `math.floor`"),
        ("import numpy as np\nnp.vecdot", "line 2: NumPy 2.4.6, which grades, has no `np.vecdot`; you have"),
        ("import numpy as np\nnp.vecdot", "Use `np.einsum`."),
        ("import numpy\nnumpy.linalg.inv", "has no `np.linalg.inv`"),
        ("from numpy import linalg as la\nla.inv", "has no `np.linalg.inv`"),
        ("import graphlib", "line 1: Python 3.9.1, which grades, has no module `graphlib`."),
        ("from graphlib import TopologicalSorter", "has no module `graphlib`."),
    ],
)
def test_a_name_that_what_grades_has_not_is_named_with_both_versions(source, said):
    (note,) = told(source)
    assert said in note


@pytest.mark.parametrize(
    "source",
    [
        "import math\nmath.sqrt(2)\nmath.nothing",  # what is here no more than there is a mistake
        "import numpy as np\nnp.asarray(1)\nnp.linalg.solve",
        "import numpy as np\na = np.asarray([1])\na.vecdot",
        "def f(:\n",
        "import matplotlib",
        "\0",
    ],
)
def test_what_works_there_as_here_and_what_works_nowhere_is_no_matter_of_versions(source):
    assert told(source) == []


def test_a_checkout_grades_with_itself_and_says_nothing():
    assert notes(b"import math\nmath.floor(1)", PLACES) == []
