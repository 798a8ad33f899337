"""What a file that is hardly begun is told: functions as handed out, and marks that a merge left."""

import pytest

from course.catalog.load import Catalog
from course.scoring.judging.outcomes import untouched
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission

CATALOG = Catalog()
COLLISIONS = CATALOG.exercise("collisions")
STUB = COLLISIONS.stub_path.read_text("utf-8")


@pytest.mark.parametrize(
    ("text", "touched"),
    [
        (STUB, set()),
        (STUB + "\nnp.set_printoptions(precision=3)\n", set()),
        (STUB + "\nif __name__ == '__main__':\n    t = np.zeros(3)\n    np.savetxt('t.txt', t)\n", set()),
        (STUB + "\n\ndef impulse_1d(*given):\n    return 0.0\n", {"impulse_1d"}),
    ],
)
def test_what_is_tried_below_the_functions_does_not_touch_them(text, touched):
    found = untouched(COLLISIONS, Submission({COLLISIONS.module: text.encode()}))
    assert {task.id for task in COLLISIONS.task} - found == touched


def test_the_marks_of_a_merge_are_told_so_on_their_lines():
    lines = ["x = (1,", "<<<<<<< HEAD", "    2)", "=======", "    3)", ">>>>>>> other"]
    first = STUB.count("\n") + 1
    with GradingSession(COLLISIONS, CATALOG, scope="public") as session:
        verdict = session.grade(Submission({COLLISIONS.module: (STUB + "\n".join(lines)).encode()}))
    for number, line in enumerate(lines, start=first):
        mark = f"collisions.py, line {number}: left out. It is the mark of a merge"
        assert any(one.startswith(mark) for one in verdict.warnings) == (line[0] in "<=>"), line
