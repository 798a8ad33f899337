"""Class folders straight from learning platforms: whose is what, or a list of what is nobody's."""

import datetime as dt
import importlib.util

import pytest

from course.errors import MissingCapabilityError, NotFoundError, UsageError
from course.grading.gradebook.records import PlatformIdentity
from course.grading.intake.downloads import Place, class_list, is_folder_meant
from course.grading.intake.students import read_student
from tests.unit.grading.intake.test_intake import archive
from tests.unit.grading.made import put

SOURCE = b"def double(x):\n    return 2 * x\n"


def lay(folder, *names):
    for name in names:
        put(folder / name, SOURCE + name.encode())


def graded(found, exercise):
    """Student -> what would be graded, or the code of why not."""
    answers = {}
    for student in found.students:
        (entry,) = read_student(student, [exercise], required=True)
        if entry.submission is not None:
            answers[student.name] = entry.submission.files["doubling.py"].removeprefix(SOURCE)
        else:
            answers[student.name] = entry.problem.code
    return answers


def test_a_canvas_download_is_a_class(tmp_path, doubling):
    lay(
        tmp_path,
        "lovelaceada_101_9001_doubling.py",
        "hopper_LATE_102_9002_doubling-2.py",
        "o_neil_LATE_103_9003_other.txt",
        "twice_104_9004_doubling.py",
        "twice_104_9005_doubling-1.py",
        "anon_106_9007_doubling.py",
        "anon_Ab3dE_9008_doubling.py",
        "anon_LATE_x7KqZ_text.html",
        "typed_107_text.html",
        "link_LATE_108_link.html",
    )
    archive(tmp_path / "zipped_105_9006_physics-sim-submission.zip", {"doubling/doubling.py": SOURCE + b"z"})
    found = class_list(tmp_path)
    assert (found.layout, found.unrecognised) == ("canvas", [])
    assert graded(found, doubling) == {
        "lovelaceada_101": b"lovelaceada_101_9001_doubling.py",
        "hopper_102": b"hopper_LATE_102_9002_doubling-2.py",
        "o_neil_103": "no_file",
        "twice_104": "ambiguous_files",
        "zipped_105": b"z",
        "anon_106": b"anon_106_9007_doubling.py",
        "anon_Ab3dE": b"anon_Ab3dE_9008_doubling.py",
        "anon_x7KqZ": "no_file",
        "typed_107": "no_file",
        "link_108": "no_file",
    }
    by_name = {student.name: student for student in found.students}
    late = {"hopper_102", "o_neil_103", "anon_x7KqZ", "link_108"}
    assert {name for name, student in by_name.items() if student.flagged_late} == late
    assert by_name["lovelaceada_101"].identity == PlatformIdentity("canvas", "101", "lovelaceada")


def test_of_one_canvas_user_with_two_names_somebody_has_to_choose(tmp_path, doubling):
    lay(tmp_path, "ada_101_1_doubling.py", "eve_101_2_doubling.py", "bob_102_3_doubling.py")
    found = class_list(tmp_path)
    assert [student.name for student in found.students] == ["ada_101", "bob_102"]
    assert "'ada' and 'eve'" in found.students[0].unclear
    assert graded(found, doubling)["ada_101"] == "ambiguous_files"


def test_a_moodle_download_with_folders_is_a_class(tmp_path, doubling):
    lay(
        tmp_path,
        "Ada Lovelace_11_assignsubmission_file/doubling.py",
        "Ada Lovelace_11_assignsubmission_onlinetext/onlinetext.html",
        "Ada Lovelace_12_assignsubmission_file_/doubling/doubling.py",
        "Group A-漢 字_13_assignsubmission_file/notes.txt",
        "Bob_14_assignsubmission_onlinetext/onlinetext.html",
    )
    found = class_list(tmp_path)
    assert (found.layout, found.unrecognised) == ("moodle", [])
    assert graded(found, doubling) == {
        "Ada Lovelace_11": b"Ada Lovelace_11_assignsubmission_file/doubling.py",
        "Ada Lovelace_12": b"Ada Lovelace_12_assignsubmission_file_/doubling/doubling.py",
        "Group A-漢 字_13": "no_file",
        "Bob_14": "no_file",
    }
    (bob,) = [student for student in found.students if student.name == "Bob_14"]
    assert (bob.place.files, bob.typed) == ((), ("Bob_14_assignsubmission_onlinetext",))
    assert found.students[0].identity == PlatformIdentity("moodle", "11", "Ada Lovelace")


def test_a_moodle_download_without_folders_is_a_class_and_file_names_forge_nobody(tmp_path, doubling):
    lay(
        tmp_path,
        "Ada_11_assignsubmission_file_doubling.py",
        "Eve_12_assignsubmission_file_Bob_13_assignsubmission_file_doubling.py",
        "Bob_13_assignsubmission_file_doubling.py",
    )
    assert graded(class_list(tmp_path), doubling) == {
        "Ada_11": b"Ada_11_assignsubmission_file_doubling.py",
        "Eve_12": "no_file",
        "Bob_13": b"Bob_13_assignsubmission_file_doubling.py",
    }


def test_of_a_moodle_folder_and_files_of_one_student_somebody_has_to_choose(tmp_path, doubling):
    lay(
        tmp_path,
        "Ada_11_assignsubmission_file/doubling.py",
        "Ada_11_assignsubmission_file_doubling.py",
    )
    found = class_list(tmp_path)
    assert graded(found, doubling) == {"Ada_11": "ambiguous_files"}
    (entry,) = read_student(found.students[0], (doubling,), required=True)
    assert [one.name for one in entry.found.candidates] == [
        "Ada_11_assignsubmission_file/doubling.py",
        "files/doubling.py",
    ]


METADATA = """---
submission_900:
  :submitters:
  - :name: Ada Lovelace
    :sid: '31'
    :email: ada@x.org
  :created_at: 2026-12-01 23:59:30.000000000 Z
  :results:
    tests:
    - output: |
        submission_999:
          :submitters:
          - :name: forged
submission_901:
  :submitters:
  - :name: Bob
    :email: bob@x.org
  - :name: Cy
    :sid: '33'
submission_902:
  :submitters:
  - :name: Dan
    :sid: '34'
submission_903:
  :submitters:
  - :name: Dan
    :sid: '34'
submission_904:
  :submitters: []
../../etc:
  :submitters:
  - :name: Eve
    :sid: '35'
"""


def gradescope(folder, metadata=METADATA):
    numbers = (900, 901, 902, 903, 904, 905)
    lay(folder, *(f"submission_{number}/doubling.py" for number in numbers))
    (folder / "submission_metadata.yml").write_text(metadata, "utf-8")


def test_a_gradescope_download_is_a_class(tmp_path, doubling):
    pytest.importorskip("yaml")
    gradescope(tmp_path)
    found = class_list(tmp_path)
    assert found.layout == "gradescope"
    assert graded(found, doubling) == {
        "31": b"submission_900/doubling.py",
        "bob@x.org": b"submission_901/doubling.py",
        "33": b"submission_901/doubling.py",
        "34": "ambiguous_files",
    }
    at = dt.datetime(2026, 12, 1, 23, 59, 30, tzinfo=dt.UTC).timestamp()
    assert {student.name: student.submitted_at for student in found.students} == {
        "31": at, "bob@x.org": None, "33": None, "34": None,
    }  # fmt: skip
    words = "\n".join(sorted(found.unrecognised))
    assert "'34' has several submissions" in found.students[2].unclear
    assert len(found.unrecognised) == 3
    for fact in ("submission_905", "names no student", "../../etc"):
        assert fact in words


@pytest.mark.parametrize(
    "metadata", ["[1, 2", "- 1", "1: x", "!!python/object/apply:os.getcwd []", "&a [*a]"]
)
def test_metadata_that_gradescope_does_not_write_is_refused(tmp_path, metadata):
    pytest.importorskip("yaml")
    gradescope(tmp_path, metadata)
    with pytest.raises(UsageError) as caught:
        class_list(tmp_path)
    assert caught.value.code == "bad_metadata"


def test_without_a_reader_of_metadata_the_command_that_installs_it_is_named(tmp_path, monkeypatch):
    gradescope(tmp_path)
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(MissingCapabilityError, match="pyyaml") as caught:
        class_list(tmp_path)
    assert "pip install" in caught.value.help


@pytest.mark.parametrize(
    ("names", "odd"),
    [
        (["Ada_11_assignsubmission_file/doubling.py", "bob/doubling.py"], "bob"),
        (["ada_101_1_doubling.py", "doubling.py"], "doubling.py"),
        (["ada_101_1_doubling.py", "bob/doubling.py"], "bob"),
        (["ada_101_1_mine.ZIP", "bob/doubling.py"], "bob"),
        (["submission_metadata.yml", "submission_900/doubling.py", "bob/doubling.py"], "bob"),
    ],
)
def test_a_folder_that_is_two_things_is_refused_and_the_odd_names_listed(tmp_path, names, odd):
    lay(tmp_path, *names)
    layout = "moodle" if "assign" in names[0] else "canvas"
    if "metadata" in names[0]:
        pytest.importorskip("yaml")
        (tmp_path / names[0]).write_text("submission_900:\n  :submitters:\n  - :sid: ada\n", "utf-8")
        layout = "gradescope"
    with pytest.raises(UsageError) as caught:
        class_list(tmp_path)
    assert caught.value.code == "mixed_layout"
    assert odd in caught.value.message
    assert f"--layout {layout}" in caught.value.help
    found = class_list(tmp_path, layout)
    assert len(found.students) == 1
    assert len(found.unrecognised) == 1
    assert found.unrecognised[0].startswith(repr(odd))


def test_what_could_be_handed_in_beside_the_folders_is_listed(tmp_path):
    students = ["..evil", "; rm -rf ~"]
    lay(tmp_path, *(f"{name}/doubling.py" for name in students), "bob.zip", "Cy.IPYNB", "doubling.py")
    lay(tmp_path, "x_1_2_notes.txt", "readme.txt", "class.csv", ".git/doubling.py")
    found = class_list(tmp_path)
    assert (found.layout, [student.name for student in found.students]) == ("folders", students)
    listed = [sentence.split(":")[0] for sentence in found.unrecognised]
    assert listed == ["'Cy.IPYNB'", "'bob.zip'", "'doubling.py'"]


def test_an_empty_class_and_an_unknown_layout_are_said_plainly(tmp_path):
    with pytest.raises(NotFoundError, match="no submissions"):
        class_list(tmp_path)
    with pytest.raises(UsageError, match="--layout"):
        class_list(tmp_path, "blackboard")


@pytest.mark.parametrize("folder", ["warm-ups/error-left", "error-left", "Error-Left (1)", "."])
def test_a_warm_up_is_found_in_its_folder_with_or_without_the_one_above(tmp_path, folder):
    path = tmp_path / folder / "error_left.py"
    put(path, b"x = 1\n")
    assert Place(tmp_path).find("error_left.py", "warm-ups/error-left") == [path]
    assert is_folder_meant(folder, "warm-ups/error-left")
    assert not is_folder_meant("warm-ups", "warm-ups/error-left")
