"""``%course_check``: what was run in a kernel is checked as a file would be, and recorded as its attempt."""

import json
import sys
from pathlib import Path
from types import MappingProxyType, SimpleNamespace

import msgspec
import pytest

from course.catalog.load import Catalog
from course.cli.frame import app
from course.errors import NotFoundError, UsageError
from course.handed_in.notebook import notebook_source
from course.notebooks import check, checking, magic
from course.notebooks.build import exercise_notebook
from course.notebooks.checking import module_of
from course.progress.history import fingerprint
from course.progress.workspace import Workspace
from course.scoring.verdict import Status

pytestmark = pytest.mark.usefixtures("sandboxes")


class Shell:
    """What a check asks of IPython's shell: the cells that were run in it, oldest first."""

    def __init__(self, texts):
        self.user_ns = {}
        self.history_manager = SimpleNamespace(input_hist_raw=["", *texts, "%course_check"])


MINI_COURSE = Path(__file__).resolve().parents[2] / "fixtures" / "mini_course"
DOUBLE = "def double(x):\n    return x + x"
DOUBLINGS = "def doublings(x, n):\n    return [x * 2**k for k in range(n + 1)]"
STUB = "def doublings(x, n):\n    raise NotImplementedError"


@pytest.fixture
def here(monkeypatch, tmp_path):
    """A workspace with ``doubling`` started; the kernel runs in the exercise's folder, as Jupyter has it."""
    monkeypatch.setenv("COURSE_CONTENT", str(MINI_COURSE))
    monkeypatch.chdir(tmp_path)
    for words in (("init", "work"), ("-C", "work", "start", "doubling")):
        assert app.run(words) == 0
    monkeypatch.chdir(tmp_path / "work" / "doubling")
    return Workspace.find(Path.cwd())


def check_in(texts, task=None):
    """A check in the kernel of a notebook, after these cells were run."""
    return checking.check("doubling", task, shell=Shell(texts))


def attempts(workspace):
    """What was recorded, without what differs from run to run."""
    found = [dict(event.data) for event in workspace.store.events("check", "doubling")]
    for one in found:
        one.pop("seconds")
        one.pop("sha256")
    return found


def test_what_nobody_edited_is_checked_and_not_recorded(here):
    stub = (MINI_COURSE / "exercises" / "doubling" / "doubling.py").read_text()
    assert not magic.check_cell(stub, "doubling").passed
    assert attempts(here) == []


def test_an_interrupted_check_is_one_sentence(monkeypatch, capsys):
    def stopped():
        raise KeyboardInterrupt

    assert magic._told(True, stopped, stopped) is None
    assert capsys.readouterr().out == "Interrupted; nothing was recorded.\n"


@pytest.mark.parametrize("second", [DOUBLINGS, STUB, "def doublings(x, n):\n    return 1 / 0"])
def test_a_check_in_a_notebook_is_recorded_as_the_same_check_in_a_terminal(here, second):
    table = check_in(["%load_ext course.notebooks", DOUBLE, second, "x = 1", second], "double")
    assert table.passed
    assert table.note == ""
    Path("doubling.py").write_text(f'"""Doubling."""\n\n\n{DOUBLE}\n\n\n{second}\n')
    app.run(("check", "doubling"))
    from_notebook, from_terminal = attempts(here)
    assert from_notebook == from_terminal
    assert from_notebook["only"] == ""
    assert [check["id"] for check in from_notebook["checks"]] == ["double_of_three", "doublings_length"]


def test_a_function_checked_before_the_others_were_run_is_an_attempt_at_it_alone(here):
    table = check_in([DOUBLE], "double")
    assert table.passed
    assert table.summary == "The one public check of double passes: 2 of 2 points."
    (attempt,) = attempts(here)
    assert attempt["only"] == "double"
    assert (attempt["score"], attempt["max_score"], attempt["passed"]) == (2.0, 2.0, True)
    assert [check["task"] for check in attempt["checks"]] == ["double"]
    to_do = check_in([DOUBLE.partition("return")[0] + "raise NotImplementedError"], "double")
    assert to_do.summary == "The one public check of double is to do: 0 of 2 points."
    wrong = check_in([DOUBLE.replace("x + x", "x + x + x")], "double")
    assert wrong.summary == "The one public check of double fails: 0 of 2 points."


def test_a_table_of_several_functions_names_them_and_says_what_costs_nothing(here):
    table = check_in([DOUBLE, DOUBLINGS])
    assert "double_of_three" not in repr(table)
    assert all(f"[{task}]: pass" in repr(table) for task in ("double", "doublings"))
    assert "<code>doublings</code>" in table._repr_html_()
    assert "costs none here" not in repr(table)
    first, *others = table.verdict.checks
    failed = msgspec.structs.replace(first, status=Status.FAIL, points=0.0, max_points=0.0)
    table.verdict = msgspec.structs.replace(table.verdict, checks=(failed, *others))
    assert "What fails without points costs none here; the grading run judges it." in repr(table)


def test_a_function_whose_cell_became_a_text_cell_is_told(here):
    """The key M does it, in Jupyter's command mode."""
    exercise = Catalog().exercise("doubling")
    notebook = json.loads(exercise_notebook(Catalog(), exercise))
    for cell in notebook["cells"]:
        if cell["metadata"]["course"].get("task") == "double" and "def" in "".join(cell["source"]):
            cell["cell_type"] = "markdown"
    (note,) = notebook_source(json.dumps(notebook).encode(), exercise).notes
    assert note.endswith("it is a text cell, and the key Y makes it one of code")


def test_code_that_cannot_be_run_is_recorded_as_that(here):
    table = check_in(["def double(x:\n    return 1"], "double")
    assert not table.passed
    assert "In [1], line 1" in table.summary
    assert [attempt["state"] for attempt in attempts(here)] == ["ungradable"]


def test_half_a_surrogate_in_a_source_is_one_wrong_character(here):
    for source in ("x = '\ud800'\n" + DOUBLE, ["x = '\ud800'", DOUBLE]):
        assert check("doubling", "double", source=source).passed


def test_outside_of_a_workspace_nothing_is_recorded_and_nothing_said(here, monkeypatch, tmp_path):
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    table = check_in([DOUBLE, DOUBLINGS])
    assert table.passed
    assert table.note == ""
    assert attempts(here) == []


def spoilt(workspace):
    (workspace.state / "progress.sqlite").write_bytes(b"not a database, not at all, no" * 10)


def of_another_course(workspace):
    marker = workspace.root / "course.toml"
    marker.write_text(marker.read_text().replace('id = "mini"', 'id = "other"'))


@pytest.mark.parametrize("spoil", [spoilt, of_another_course])
def test_where_nothing_can_be_recorded_the_check_is_shown_and_says_so(here, spoil):
    spoil(here)
    table = check_in([DOUBLE, DOUBLINGS])
    assert table.passed
    assert "not recorded" in table.note
    assert table.note in repr(table)
    assert "not recorded" in table._repr_html_()


def test_a_stub_is_one_attempt_in_every_form(catalog):
    for exercise in catalog.exercises():
        stub = fingerprint(exercise.stub_path.read_bytes())
        data = exercise_notebook(catalog, exercise)
        assert fingerprint(notebook_source(data, exercise).source) == stub
        texts = ["".join(cell["source"]) for cell in json.loads(data)["cells"] if cell["cell_type"] == "code"]
        assert fingerprint(module_of([*texts, *texts], exercise).source) == stub, exercise.id


def test_the_newest_version_of_a_cell_counts(here):
    wrong = DOUBLE.replace("x + x", "x")
    assert not check_in([DOUBLE, DOUBLINGS, wrong], "double").passed
    assert check_in([wrong, DOUBLINGS, DOUBLE], "double").passed


def double(x):
    return x + x


def doublings(x, n):
    return [double(x) * 2 ** (k - 1) for k in range(n + 1)]


@pytest.mark.parametrize("form", ["text", "path", "name", "notebook", "functions", "mixed"])
def test_a_check_needs_no_ipython(here, form):
    text = f"{DOUBLE}\n\n\n{DOUBLINGS}\n"
    Path("mine.py").write_text(text)
    made = json.loads(exercise_notebook(Catalog(), Catalog().exercise("doubling")))
    made["cells"] = [{**made["cells"][-1], "cell_type": "code", "source": text, "metadata": {}}]
    Path("mine.ipynb").write_text(json.dumps(made))
    source = {
        "text": text,
        "path": Path("mine.py"),
        "name": "mine.py",
        "notebook": Path("mine.ipynb"),
        "functions": [double, doublings],
        "mixed": (double, DOUBLINGS),
    }[form]
    table = check("doubling", source=source)
    assert table.passed, repr(table)
    assert len(table.checks) == 2
    (attempt,) = attempts(here)
    assert attempt["passed"]


def test_a_wrong_function_does_not_pass_without_ipython(here):
    assert not check("doubling", "double", source=["def double(x):\n    return x + 1"]).passed
    assert [attempt["only"] for attempt in attempts(here)] == ["double"]


def test_a_check_without_ipython_and_without_a_source_says_what_to_give(here, monkeypatch):
    monkeypatch.delitem(sys.modules, "IPython", raising=False)
    with pytest.raises(UsageError, match="no IPython") as caught:
        check("doubling")
    assert "source=" in caught.value.help
    with pytest.raises(UsageError, match="source of"):
        check("doubling", source=[len])
    with pytest.raises(NotFoundError):
        check("doubling", source="missing.py")
    with pytest.raises(NotFoundError, match="no function"):
        check("doubling", "treble", source=[double])


def test_a_cell_is_checked_as_a_file_and_does_not_run_here(here, capsys):
    source = f"print('loaded')\n\n\n{DOUBLE}\n\n\n{STUB}\n"
    table = magic.check_cell(source, "doubling")
    assert repr(table).startswith("loaded\n")
    assert [check.status.value for check in table.checks] == ["pass", "error"]
    for shown in repr(table), table._repr_html_():
        assert "– " in shown
        assert "to do" in shown
        assert shown.count("the docstring above it says") == 1
        assert "NotImplementedError" not in shown, "what is not written yet is no error"
    assert "loaded" not in capsys.readouterr().out
    assert [attempt["only"] for attempt in attempts(here)] == [""]


def test_a_report_stands_below_once_all_checks_pass(here):
    assert magic.check_cell(f"{DOUBLE}\n\n\n{STUB}\n", "doubling").report is None
    table = magic.check_cell(f"{DOUBLE}\n\n\n{DOUBLINGS}\n", "doubling")
    assert table.passed
    assert table.report._repr_html_() in table._repr_html_()


def test_a_warm_up_has_no_points(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    source = "def step_ahead(x, v, a, h):\n    print('here')\n    return x + h * v, v + h * a\n"
    table = magic.check_cell(source, "one-step-ahead")
    assert table.passed
    assert "points" not in repr(table)
    assert "<td>1/1</td>" not in table._repr_html_()
    wrong = magic.check_cell(source.replace("h * v", "h * a"), "one-step-ahead")
    assert "your code printed:" in repr(wrong)
    assert "here" in wrong._repr_html_()


def test_the_curve_of_a_failed_check_is_drawn_and_said(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    head = "def explicit_euler_step(accel, t, q, v, h):\n"
    step = f"{head}    v = v + h * accel(t, q, v)\n    return q + h * v, v\n"
    table = check("integrators", "explicit_euler_step", source=[step])
    said = "Your curve is visibly apart from that of explicit Euler at "
    page = table._repr_html_()
    assert said in repr(table)
    assert page.count(said) == 1
    assert page.count('src="data:image/png;base64,') == 1
    mended = f"{head}    return q + h * v, v + h * accel(t, q, v)\n"
    assert "<img" not in check("integrators", "explicit_euler_step", source=[mended])._repr_html_()


def test_hints_progress_and_handing_in_need_no_terminal(here, capsys):
    magics = {}

    class Registered:
        events = SimpleNamespace(register=lambda *_: None)
        user_ns = MappingProxyType({})
        history_manager = SimpleNamespace(input_hist_raw=["", ""])

        def register_magic_function(self, made, _kind, name):
            magics[name] = made

    magic.register(Registered())
    capsys.readouterr()
    magics["course_hint"]("")
    assert "Write: %course_hint EXERCISE [FUNCTION]" in capsys.readouterr().out
    Path("doubling.py").write_text(f"{DOUBLE}\n\n\ndef doublings(x, n):\n    return [x]\n")
    app.run(("check", "doubling"))
    capsys.readouterr()
    magics["course_hint"]("doubling doublings")
    assert "doublings" in capsys.readouterr().out
    magics["course_progress"]("")
    assert "checked 1 time" in capsys.readouterr().out
    magics["course_submit"]("doubling")
    assert "doubling-submission.zip" in capsys.readouterr().out
    assert (here.root / "doubling-submission.zip").is_file()
