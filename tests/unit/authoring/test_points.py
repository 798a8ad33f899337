"""Points and counts of an exercise follow from its checks."""

import re

import pytest

from course.authoring.exercises import files
from course.authoring.exercises.files import write_points
from course.catalog.load import Catalog
from course.errors import ContentError

TOML = "exercises/doubling/exercise.toml"


def built(mini):
    written = write_points(Catalog(), Catalog().exercise("doubling"))
    assert written == mini / TOML
    return written.read_text()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("points = 4", "points = 7"),
        ("hidden_checks = 2", "hidden_checks = 1"),
        ("hidden_points = 5", "hidden_points = 2.5"),
    ],
)
def test_a_number_that_is_old_is_written_anew(mini, old, new):
    path = mini / TOML
    right = path.read_text()
    path.write_text(right.replace(old, new + "  # why"))
    assert built(mini) == right.replace(old, old + "  # why")
    assert write_points(Catalog(), Catalog().exercise("doubling")) is None


def test_counts_that_were_left_out_are_put_above_the_tasks(mini):
    path = mini / TOML
    right = path.read_text()
    path.write_text(re.sub(r"hidden_\w+ = .*\n", "", right))
    assert built(mini) == right


def test_a_marker_that_changes_changes_the_points_of_its_task(mini):
    checks = mini / "graders" / "doubling" / "checks.py"
    checks.write_text(checks.read_text().replace("points(3)", "points(3.1)"))
    text = built(mini)
    assert "hidden_points = 5.1\n" in text
    assert "points = 6.1\n" in text
    assert Catalog().exercise("doubling").max_points == pytest.approx(10.1, rel=1e-12)


def test_a_task_without_points_keeps_what_is_written(mini):
    """Zero could not be loaded again; the audit says what is missing."""
    for folder in ("exercises", "graders"):
        path = mini / folder / "doubling" / "checks.py"
        path.write_text(path.read_text().replace('task("doublings")', 'task("double")'))
    assert re.findall(r"^points = (.*)", built(mini), re.MULTILINE) == ["10", "6"]


def test_times_are_measured_once_and_again_when_a_check_changes(mini, monkeypatch):
    """They are noise: another run of the same files changes nothing, least of all of other exercises."""

    def build(seconds):
        monkeypatch.setattr(files, "measured", lambda *_: {"a": seconds, "b": 0.02})
        catalog = Catalog()
        if files.write_times(catalog, catalog.exercises()) is None:
            return None
        return {name: one.slow for name, one in Catalog().times.exercises.items()}

    assert build(0.31) is None
    checks = mini / "exercises" / "doubling" / "checks.py"
    checks.write_text(checks.read_text() + "# changed\n")
    assert build(0.31) == {"doubling": {"a": 0.4}, "halving": {}}
    assert Catalog().exercise("doubling").slow == {"a": 0.4}
    assert build(9.0) is None


def test_times_that_cannot_be_read_name_their_file_and_the_fix(mini):
    (mini / "exercises" / "times.json").write_text("{")
    with pytest.raises(ContentError, match=r"times\.json: what was measured cannot be read") as caught:
        Catalog().exercise("doubling")
    assert "course author build" in caught.value.help


def test_what_is_measured_is_the_cpu_time_of_right_solutions(mini):
    most = files.measured(Catalog(), Catalog().exercise("doubling"))
    assert most.keys() == {"double_of_three", "doublings_length"}
    assert all(0 <= seconds < files.QUICK for seconds in most.values())
