"""At home on other systems: without what only POSIX has, with other encodings, paths and consoles."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MINI_COURSE = ROOT / "tests" / "fixtures" / "mini_course"
ELSEWHERE = Path(__file__).with_name("elsewhere.py")


def run(folder, *words, encoding="utf-8", program=(str(ELSEWHERE), "course"), **environment):
    """A command line in a folder, in a process without POSIX; its output as a console would decode it."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("LC_", "PYTHON"))}
    ran = subprocess.run(
        [sys.executable, *program, *words],
        cwd=folder,
        env={**kept, "COURSE_CONTENT": str(MINI_COURSE), "PYTHONPATH": str(ROOT), **environment},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        check=False,
    )
    out, err = ran.stdout.decode(encoding), ran.stderr.decode(encoding)
    assert ran.returncode != 70, err
    assert "Traceback" not in err, err
    return ran.returncode, out, err


@pytest.fixture(scope="module")
def workspace(tmp_path_factory):
    """A workspace in a folder with a space in its name; the exercise is solved."""
    root = tmp_path_factory.mktemp("else where") / "my course"
    assert run(root.parent, "init", str(root))[0] == 0
    assert run(root, "start", "doubling")[0] == 0
    solved = (MINI_COURSE / "solutions" / "doubling" / "doubling.py").read_bytes()
    (root / "doubling" / "doubling.py").write_bytes(solved)
    return root


def test_a_check_at_the_lowest_level_and_handing_in_work_without_posix(workspace, tmp_path):
    target = tmp_path / "for you.zip"
    for words in (("check", "doubling"), ("submit", "-o", str(target))):
        code, out, err = run(workspace, *words, "--json")
        assert code == 0, err
        assert json.loads(out)["ok"] is True
    assert target.is_file()


def test_a_function_that_hangs_or_dies_costs_its_checks_without_posix(workspace, tmp_path):
    root = shutil.copytree(workspace, tmp_path / "a b")
    with (root / "doubling" / "doubling.py").open("a", encoding="utf-8") as module:
        module.write("\ndef double(x):\n    import os\n    os._exit(3)\n")
    code, out, err = run(root, "check", "doubling", "--json")
    assert code == 1, err
    states = {(check["task"], check["status"]) for check in json.loads(out)["checks"]}
    assert ("double", "crash") in states
    assert ("doublings", "pass") in states


def test_the_quiz_is_taken_without_posix(tmp_path):
    assert run(tmp_path, "init", COURSE_CONTENT="")[0] == 0
    code, out, err = run(tmp_path, "quiz", "take", "--questions", "--json", COURSE_CONTENT="")
    assert code == 0, err
    assert json.loads(out)["questions"]


def test_a_fault_report_and_the_doctor_work_without_posix(workspace, tmp_path):
    code, _, err = run(tmp_path, "bug")
    assert code == 0, err
    text = (tmp_path / "course-bug.txt").read_text("utf-8")
    assert "protection: L1" in text


def console(encoding):
    """What makes a Python of this machine write as it would to such a console."""
    return {"PYTHONIOENCODING": encoding, "PYTHONUTF8": "0", "LC_ALL": "C"}


@pytest.mark.parametrize("encoding", ["cp1252", "latin-1"])
def test_a_console_of_another_encoding_gets_what_it_can_show(tmp_path, encoding):
    """A character that it cannot show is a question mark, never the end of the program."""
    there = {"program": ("-m", "course"), "COURSE_CONTENT": "", **console(encoding)}
    code, out, _ = run(tmp_path, "lesson", "why-simulate", "--plain", encoding=encoding, **there)
    assert code == 0
    assert "pilot" in out
    # JSON is UTF-8 everywhere: it is read by programs.
    _, out, _ = run(tmp_path, "lesson", "why-simulate", "--json", **there)
    assert json.loads(out)["id"] == "why-simulate"


@pytest.mark.parametrize("line", ["", "demo", "lesson numerical-integration --plain", "check doubling"])
def test_a_console_of_windows_shows_what_is_met_first(workspace, line):
    real = line.startswith(("demo", "lesson"))
    folder, content = (workspace.parent, "") if real else (workspace, str(MINI_COURSE))
    there = {"program": ("-m", "course"), "COURSE_CONTENT": content, **console("cp437")}
    code, out, _ = run(folder, *line.split(), encoding="cp437", **there)
    assert code == 0
    assert len(out.splitlines()) > 3


def test_files_are_utf_8_whatever_the_locale_says(tmp_path):
    """Everything written and read names its encoding: a locale without UTF-8 changes nothing."""
    root = tmp_path / "é à"
    root.mkdir()
    strict = {"PYTHONUTF8": "0", "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONWARNDEFAULTENCODING": "1"}
    program = ("-W", "error::EncodingWarning", "-m", "course")
    for words in ("init --with github,vscode", "start doubling", "bug"):
        assert run(root, *words.split(), program=program, encoding="latin-1", **strict)[0] == 0
