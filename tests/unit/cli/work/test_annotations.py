"""Findings as annotations and as lines, read back as GitHub's runner and an editor read them."""

import io
import json
import os
import re
import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest
import yaml
from hypothesis import example, given
from hypothesis import strategies as st

from course.cli.frame.console import Console
from course.cli.work.verdict import _shown, github, line_of, unread_line
from tests.command_line import in_process

#: What the runner puts back, in its order: ActionCommand.cs of actions/runner.
DATA = (("%0D", "\r"), ("%0A", "\n"), ("%25", "%"))
PROPERTY = (("%0D", "\r"), ("%0A", "\n"), ("%3A", ":"), ("%2C", ","), ("%25", "%"))


def unescaped(text, pairs):
    for replacement, token in pairs:
        text = text.replace(replacement, token)
    return text


def parse(line):
    """A workflow command as ``ActionCommand.TryParseV2`` takes it apart; None if it is none.

    ``::name key=value,key=value::data``. A name that the runner does not know makes it an ordinary line, and
    a property without a value is passed over.
    """
    line = line.lstrip()
    if not line.startswith("::") or "::" not in line[2:]:
        return None
    info, _, data = line[2:].partition("::")
    name, _, rest = info.partition(" ")
    if name not in {"error", "warning", "notice"}:
        return None
    pairs = (re.split("=+", item.lstrip("="), maxsplit=1) for item in rest.strip().split(",") if item)
    known = {pair[0]: unescaped(pair[1], PROPERTY) for pair in pairs if len(pair) == 2 and pair[1]}
    return name, known, unescaped(data, DATA)


def annotations(out):
    return [found for line in out.splitlines() if (found := parse(line))]


#: Few letters, so that all of them come up.
ANY = st.text("%:,=\r\n02ADC x½", max_size=20)


@given(folder=ANY, title=ANY, message=ANY)
@example("a, b/c:d.py", "50 % off: a, b = c::d", "100 %\nof\r\nit :: ::error::x, y=z")
@example("C:\\a, b", "%0A and %250A", "%25 %3A C:\\a")
@example("%2C é", "α = β", "½")
def test_whatever_is_said_comes_back(folder, title, message):
    """Titles end with the id of their check, and paths with the name of a file."""
    file, title = f"x{folder}/a.py", f"Check {title} [id]"
    line = github("warning", file, 3, title, message)
    assert len(line.splitlines()) == 1
    assert line.endswith("\n")
    assert "\r" not in line
    assert parse(line.removesuffix("\n")) == ("warning", {"file": file, "line": "3", "title": title}, message)


@pytest.fixture
def integrators(tmp_path):
    """The file of an exercise that was started, of the course itself."""
    for words in (["init"], ["start", "integrators"]):
        assert in_process(*words, cwd=tmp_path).returncode == 0
    return tmp_path / "integrators" / "integrators.py"


@pytest.mark.parametrize("where", ["loading", "calling"])
def test_what_a_file_says_when_it_fails_is_no_command(where, tmp_path, integrators):
    """Run for real: the words of an exception are the student's."""
    said = 'raise ValueError("a\\n::stop-commands::x\\r\\n::error::y")'
    text = said if where == "loading" else f"def explicit_euler_step(accel, t, q, v, h):\n    {said}\n"
    integrators.write_text(text, "utf-8")
    environment = {name: value for name, value in os.environ.items() if name != "GITHUB_WORKSPACE"}
    ran = in_process("-C", tmp_path, "check", "integrators", "--format", "github", env=environment)
    lines = [line for line in (ran.stdout + ran.stderr).splitlines() if line.lstrip().startswith("::")]
    found = [parse(line) for line in lines]
    assert {(name, at["file"]) for name, at, _ in found} == {("error", "integrators/integrators.py")}
    assert found[0][1]["line"] == ("1" if where == "loading" else "2")
    assert "::stop-commands::x" in found[0][2], "it is said, inside the message"


def test_a_failed_check_is_an_annotation_at_its_function_from_the_top_of_the_repository(
    course, write, workspace, monkeypatch
):
    write("RIGHT", "wrong")
    ran = course("check --format github").ends(1)
    ((level, where, message),) = annotations(ran.out)
    assert (level, where["file"], where["line"]) == ("error", "doubling/doubling.py", "5")
    assert "doublings_works" in where["title"]
    assert message.startswith("It is not right.\nWrite RIGHT.\n")
    assert "\x1b" not in ran.out
    monkeypatch.setenv("GITHUB_WORKSPACE", str(workspace.parent))
    ran = course("check --format github --json")
    assert ran.json["schema"] == "course.check/1", "one object beside them"
    ((_, where, _),) = annotations(ran.err)
    assert where["file"] == "my course é/doubling/doubling.py"


def test_everything_right_is_no_annotation_and_an_unknown_format_is_refused(course, write):
    write("RIGHT", "RIGHT")
    ran = course("check --all --format github").ends(0)
    assert not annotations(ran.out)
    assert course("check --format xml").code == 2


def test_a_file_that_cannot_be_read_is_marked_where_it_cannot(course, write):
    write("UNREADABLE", "RIGHT", extra="def broken(:\n    pass\n")
    for words in (("check",), ("check", "--all")):
        ran = course(*words, "--format", "github").ends(3)
        ((level, where, message),) = annotations(ran.out)
        assert (level, where["line"], message) == ("error", "7", "Line 1 cannot be read.\nLook at line 1.")


def test_a_line_in_a_notebook_is_that_of_its_text():
    text = '{"cells": [\n  {"source": [\n    "def double(x):\\n",\n    "    return x\\n"\n]}]}'
    raised = SimpleNamespace(task="double", traceback="nb.py:9 in double")
    assert line_of(text, raised, traced=False) == 3
    assert line_of(text, SimpleNamespace(task="doublings", traceback=None), traced=False) == 1


def test_a_function_that_is_no_python_is_marked_where_python_stops(tmp_path, integrators):
    stub = integrators.read_text()
    text = stub.replace("    raise NotImplementedError", "    if h > 0\n        return q, v", 1)
    integrators.write_text(text)
    line = 1 + text[: text.index("    if h > 0")].count("\n")
    told = in_process("-C", tmp_path, "check", "integrators", "--format", "lines").stdout
    for said in (f"integrators.py:{line}: error: ", f"on line {line} of your file"):
        assert said in told


# -- course init --with ------------------------------------------------------------------------------------


def test_init_writes_what_is_asked_for(course, tmp_path):
    ran = course("init mine --with github,devcontainer,vscode --json").ends(0)
    assert ran.json["next"]["command"] == "course go"
    root = tmp_path / "mine"
    assert [file["path"] for file in ran.json["files"]] == [
        str(root / name)
        for name in (".github/workflows/course.yml", ".devcontainer/devcontainer.json", ".vscode/tasks.json")
    ]
    job = yaml.safe_load((root / ".github/workflows/course.yml").read_text("utf-8"))["jobs"]["check"]
    runs = [step["run"] for step in job["steps"] if "run" in step]
    assert runs == ["python -m pip install wheels/*.whl", "course check --all --format github"]
    container = json.loads((root / ".devcontainer/devcontainer.json").read_text("utf-8"))
    assert container["postCreateCommand"] == "python -m pip install wheels/*.whl"


def test_init_says_that_the_wheel_it_installs_from_is_not_there_yet(course, tmp_path):
    said = "none is there yet: put the one that your instructor handed out there, and commit it"
    told = [course("init mine --with", kinds) for kinds in ("github", "devcontainer", "vscode")]
    assert [said in ran.words for ran in told] == [True, True, False]
    (tmp_path / "mine" / "wheels").mkdir()
    (tmp_path / "mine" / "wheels" / "course-2.0.0-py3-none-any.whl").touch()
    assert said not in course("init mine --with github").words


@pytest.mark.parametrize("wanted", ["https://example.org/a b.whl#sha256=1", "it's \"quoted\": $HOME, 'x'"])
def test_a_requirement_reaches_pip_as_it_is(course, tmp_path, wanted):
    assert course("init mine --with github,devcontainer --requirement", wanted).code == 0
    text = (tmp_path / "mine/.github/workflows/course.yml").read_text("utf-8")
    install = yaml.safe_load(text)["jobs"]["check"]["steps"][2]
    assert (install["run"], install["env"]) == ('python -m pip install "$COURSE"', {"COURSE": wanted})
    container = json.loads((tmp_path / "mine/.devcontainer/devcontainer.json").read_text("utf-8"))
    assert container["postCreateCommand"] == ["python", "-m", "pip", "install", wanted]


@pytest.mark.parametrize(
    ("kinds", "wanted"),
    [("github", "--index-url=x"), ("github", "a\nb"), ("github", "${{ secrets.X }}"), ("github,emacs", "a")],
)
def test_what_is_no_requirement_or_kind_is_refused_before_anything_is_written(
    course, tmp_path, kinds, wanted
):
    assert course("init mine --with", kinds, f"--requirement={wanted}").code == 2
    assert not (tmp_path / "mine").exists()


def test_nothing_is_replaced_without_a_copy(course, workspace):
    path = workspace / ".vscode" / "tasks.json"
    path.parent.mkdir()
    path.write_text("mine")
    ran = course("init --with vscode --json")
    (file,) = ran.json["files"]
    assert Path(file["backup"]["backup"]).read_text("utf-8") == "mine"
    again = course("init --with vscode --json").json["files"]
    assert again[0]["backup"] is None


def test_the_editor_s_task_finds_what_the_check_prints(course, write, workspace):
    course("init --with vscode")
    task = json.loads((workspace / ".vscode" / "tasks.json").read_text("utf-8"))["tasks"][0]
    write("wrong", "RIGHT")
    assert task["command"] == "course"
    ran = course(*task["args"])
    pattern = task["problemMatcher"]["pattern"]
    (match,) = [found for line in ran.rows if (found := re.match(pattern["regexp"], line))]
    drive = re.match(pattern["regexp"], "C:/my course/a.py:12: error: off by 1:2: no")
    assert (drive[pattern["file"]], drive[pattern["line"]]) == ("C:/my course/a.py", "12")
    file, line = match[pattern["file"]], match[pattern["line"]]
    assert (file, line, match[pattern["severity"]]) == ("doubling/doubling.py", "1", "error")
    assert "It is not right." in match[pattern["message"]]


def test_a_checkout_without_the_record_is_checked(course, write, workspace):
    """A repository need not hold .course."""
    write("wrong", "RIGHT")
    shutil.rmtree(workspace / ".course")
    ran = course("check --all --format github").ends(1)
    assert len(annotations(ran.out)) == 1


#: What the runner knows, and a folder or an exception may be called; ``##[`` counts anywhere in a line.
FORGED = "::error::forged\n::stop-commands::x ##[add-mask]root ##[stop-commands]x"


def heeded(line):
    """A command of the first or the second form, as the runner looks for them in every line."""
    return parse(line) or ("##[" in line and "]" in line.partition("##[")[2])


def test_a_workflow_obeys_nothing_that_strangers_say(monkeypatch):
    """A folder called as a command was one in every list of a run, and so was what an exception said."""
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    out, err = io.StringIO(), io.StringIO()
    console = Console(stdout=out, stderr=err)
    console.line("  ", FORGED.partition("\n")[0])
    console.block(FORGED)
    console.warn(FORGED)
    console.error(FORGED, FORGED)
    console.item("::error::x", "##[error]")
    console.raw(_shown("lines", "error", "::error::a.py", 1, FORGED, FORGED))
    said = (out.getvalue() + err.getvalue()).splitlines()
    assert len(said) > 8
    assert not [line for line in said if heeded(line)]
    (line,) = _shown("github", "error", "a.py", 1, FORGED, FORGED).splitlines()
    assert parse(line) == ("error", {"file": "a.py", "line": "1", "title": FORGED}, FORGED)
    monkeypatch.delenv("GITHUB_ACTIONS")
    console.line("a[::2]")
    assert out.getvalue().endswith("a[::2]\n")


def test_the_line_that_cannot_be_read_is_that_of_a_letter_in_another_encoding_too():
    sources = b"x = 1\n", b"x = 1\nx x\n", b"x = 1\n# \xe9\n", "x = 1\nx x\n"
    assert [unread_line(source) for source in sources] == [1, 2, 2, 2]
    without_a_line = b"# x\n# \xe9\n", b"x = 1\r\xe9", b"x = 1\nx\0\n", b"# coding: ascii\n# \xc3\xa9"
    assert [unread_line(source) for source in without_a_line] == [2, 2, 2, 2]
