"""The file that is handed in; and ``course report``: the functions on public data, in words and figures."""

import hashlib
import json
import platform
import shutil
import zipfile

import numpy as np
import pytest

pytestmark = pytest.mark.usefixtures("sandboxes")


def test_submit_writes_one_zip_with_checksums(course, workspace, write):
    source = write("RIGHT", "wrong").read_bytes()
    course("check")
    course("submit").ends(
        0,
        "doubling/doubling.py",
        "Not started, so not in it: halving.\n",
        "2/4 points from the public checks (a pass is 70% of all points, hidden checks included)",
    )
    with zipfile.ZipFile(workspace / "mini-submission.zip") as archive:
        assert archive.namelist() == ["doubling/doubling.py", "submission.json"]
        assert archive.read("doubling/doubling.py") == source
        manifest = json.loads(archive.read("submission.json"))
    assert manifest["format_version"] == 1
    assert manifest["written_with"] == {"python": platform.python_version(), "numpy": np.__version__}
    assert manifest["course"]["id"] == "mini"
    assert manifest["files"] == {"doubling/doubling.py": hashlib.sha256(source).hexdigest()}
    assert manifest["quiz"] == []


def test_the_same_files_give_the_same_bytes(course, workspace, write):
    write("RIGHT", "wrong")
    course("submit -o one.zip")
    course("submit -o two.zip")
    assert (workspace / "one.zip").read_bytes() == (workspace / "two.zip").read_bytes()
    with zipfile.ZipFile(workspace / "one.zip") as archive:
        # The two files may have been written within one tick of a zip's clock; this says it for good.
        assert {(info.date_time, info.create_system) for info in archive.infolist()} == {
            ((1980, 1, 1, 0, 0, 0), 3)
        }


def test_submit_keeps_what_it_replaces(course, workspace, write):
    write("RIGHT", "wrong")
    (workspace / "mine.zip").write_bytes(b"something else")
    body = course("submit -o mine.zip --json").json
    assert (workspace / body["backup"]).read_bytes() == b"something else"
    assert course("submit -o mine.zip --json").json["backup"] is None


@pytest.mark.parametrize("clone", [False, True])
def test_submit_leaves_an_untouched_stub_out_and_says_what_the_checks_say_of_the_rest(
    course, workspace, write, clone
):
    """A clone has no record of what was begun."""
    course("start halving")
    write("RIGHT", "wrong")
    if clone:
        shutil.rmtree(workspace / ".course")
    body = course("submit --json").json
    (file,) = body["files"]
    assert (file["path"], file["last_score"], file["max_score"]) == ("doubling/doubling.py", 2.0, 4.0)
    assert body["left_out"] == [{"path": "halving/halving.py", "action": "still the stub"}]
    course("submit").says("2/4 points from the public checks")


def test_submit_with_nothing_written_writes_nothing(course, workspace):
    assert course("submit --json").error == (3, "nothing_to_submit")
    assert not list(workspace.glob("*.zip"))
    ran = course("submit halving").ends(3)
    assert ran.err == "You have not started halving.\n`course start halving` begins it.\n"


def test_an_exercise_that_is_named_twice_is_handed_in_once(course, workspace, write):
    write("RIGHT", "wrong")
    body = course("submit 1 doubling --json").json
    assert [file["path"] for file in body["files"]] == ["doubling/doubling.py"]
    assert body["output"].endswith("/doubling-submission.zip")


def test_submit_warns_about_a_file_that_cannot_be_graded(course, workspace):
    (workspace / "doubling" / "doubling.py").write_text("UNREADABLE\n")
    body = course("submit --json").json
    assert body["files"][0]["last_score"] is None
    assert "cannot be graded as it is: Line 1 cannot be read." in body["warnings"][0]


@pytest.mark.parametrize("output", ["nowhere/mine.zip", "doubling/doubling.py"])
def test_submit_refuses_an_output_that_makes_no_sense(course, workspace, write, output):
    source = write("RIGHT", "wrong").read_bytes()
    assert course("submit -o", output).code == 2
    assert (workspace / "doubling" / "doubling.py").read_bytes() == source


# -- reports ---------------------------------------------------------------------------------------------

RIGHT = "import numpy as np\n\n\ndef double(x):\n    return 2 * x\n\n\ndef doublings(x, n):\n"
DOUBLINGS = "    return x * 2.0 ** np.arange(n + 1)\n"


@pytest.fixture
def module(workspace):
    return workspace / "doubling" / "doubling.py"


def test_a_report_shows_tables_and_writes_figures_and_again_without_copies(course, module):
    module.write_text(RIGHT + DOUBLINGS)
    for _ in range(2):
        course("report doubling --plain").ends(
            0, "number: 2.5; double: 5", "Figure: Five points on a line that climbs from 1 to 16."
        )
        (figure,) = (module.parent / "report").iterdir()
        assert figure.name == "2-many-times.png"
        assert figure.read_bytes().startswith(b"\x89PNG")


def test_what_is_not_written_yet_says_so_and_the_rest_is_shown(course, module):
    module.write_text(RIGHT + "    raise NotImplementedError\n")
    course("report doubling --plain").ends(0, "double: 5", " is not written yet.").lacks("Wrote")


def test_a_report_as_json_has_every_number_and_every_file_and_no_bag_without_sensors(
    course, module, tmp_path
):
    module.write_text(RIGHT + DOUBLINGS)
    ran = course("report doubling --json -o", tmp_path / "seen")
    body = ran.json
    assert (body["schema"], body["ok"], body["exit_code"]) == ("course.report/1", True, 0)
    assert body["sections"][0]["rows"] == [["1", "2"], ["2.5", "5"]]
    assert body["sections"][1]["figure"]["path"] == str(tmp_path / "seen" / "2-many-times.png")
    assert course("report doubling --bag", tmp_path / "bag", "--json").error == (2, "no_streams")


def test_a_file_that_cannot_be_loaded_is_exit_3(course, module):
    module.write_text("def double(x:\n")
    assert course("report doubling --json").error == (3, "syntax_error")


def test_an_exercise_without_a_report_says_so(course, workspace):
    assert course("start halving").code == 0
    assert course("report halving --json").error == (5, "report_not_found")
