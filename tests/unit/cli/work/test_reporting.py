"""``course report``: the student's functions on public data, through the boundary, in words and figures."""

import pytest

pytestmark = pytest.mark.usefixtures("sandboxes")
RIGHT = "import numpy as np\n\n\ndef double(x):\n    return 2 * x\n\n\ndef doublings(x, n):\n"
DOUBLINGS = "    return x * 2.0 ** np.arange(n + 1)\n"


@pytest.fixture
def module(workspace):
    return workspace / "doubling" / "doubling.py"


def test_a_report_shows_tables_and_writes_figures_and_again_without_copies(course, module):
    module.write_text(RIGHT + DOUBLINGS)
    for _ in range(2):
        course("report", "doubling", "--plain").ends(
            0, "number: 2.5; double: 5", "Figure: Five points on a line that climbs from 1 to 16."
        )
        (figure,) = (module.parent / "report").iterdir()
        assert figure.name == "2-many-times.png"
        assert figure.read_bytes().startswith(b"\x89PNG")


def test_what_is_not_written_yet_says_so_and_the_rest_is_shown(course, module):
    module.write_text(RIGHT + "    raise NotImplementedError\n")
    ran = course("report", "doubling", "--plain").ends(0, "double: 5", " is not written yet.")
    assert "Wrote" not in ran.out


def test_a_report_as_json_has_every_number_and_every_file_and_no_bag_without_sensors(
    course, module, tmp_path
):
    module.write_text(RIGHT + DOUBLINGS)
    ran = course("report", "doubling", "--json", "-o", str(tmp_path / "seen"))
    body = ran.json
    assert (body["schema"], body["ok"], body["exit_code"]) == ("course.report/1", True, 0)
    assert body["sections"][0]["rows"] == [["1", "2"], ["2.5", "5"]]
    assert body["sections"][1]["figure"]["path"] == str(tmp_path / "seen" / "2-many-times.png")
    assert course("report", "doubling", "--bag", str(tmp_path / "bag"), "--json").error == (2, "no_streams")


def test_a_file_that_cannot_be_loaded_is_exit_3(course, module):
    module.write_text("def double(x:\n")
    assert course("report", "doubling", "--json").error == (3, "syntax_error")


def test_an_exercise_without_a_report_says_so(course, workspace):
    assert course("start", "halving").code == 0
    assert course("report", "halving", "--json").error == (5, "report_not_found")
