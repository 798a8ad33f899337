"""What scoring/checks/collected.py needs of pytest's insides still holds for the pytest installed here.

Checks are collected once and run again for every submission; that takes calls which pytest does not promise.
Each test names one thing that must go on being true. When a new major of pytest breaks one, it is repaired in
that one file, or the cap in pyproject.toml stays.
"""

import contextlib
import gc
import os
import re
import sys
import textwrap
import tomllib
from pathlib import Path

import numpy as np
import pytest

from course.errors import ContentError
from course.scoring.checks.collected import CollectedChecks
from course.scoring.failures import CheckFailed
from course.scoring.verdict import Finding, Visibility

_CHECKS = '''
    """Checks that tell through the submission what became of them."""

    import pytest
    from course.scoring.kit import CheckFailed, Finding


    @pytest.fixture
    def own(submission):
        submission.log.append("set up")
        yield object()
        submission.log.append("torn down")


    @pytest.mark.task("a")
    @pytest.mark.points(1)
    def test_passes(submission, own):
        """It passes (no points here, two in the grading run)
        and this is no part of the title."""
        submission.log.append(id(own))


    @pytest.mark.task("a")
    @pytest.mark.points(2.5)
    @pytest.mark.requires("passes", "draws")
    def test_fails(submission, own):
        """It fails"""
        raise CheckFailed(Finding(message=f"seen by {submission.name}"))


    @pytest.mark.task("b")
    @pytest.mark.points(1)
    def test_draws(submission, rng):
        """It draws"""
        submission.log.append(float(rng.random()))


    @pytest.mark.task("b")
    @pytest.mark.points(1)
    def test_breaks(submission):
        """It breaks"""
        return 1 / 0
'''


def _around(body, above="", mark="", taken=""):
    """A file with one check, and what its author put around it."""
    return f'''
import pytest

{above}

@pytest.mark.task("a")
@pytest.mark.points(1)
{mark}
def test_it({taken}):
    """It"""
    {body}
'''


class Fake:
    """What stands for a submission; the checks above ask nothing else of it."""

    def __init__(self, name="one", seed=1):
        self.name = name
        self.seed = seed
        self.log = []


@pytest.fixture
def collect(tmp_path):
    with contextlib.ExitStack() as stack:

        def collect(*sources):
            files = []
            for number, source in enumerate(sources or (_CHECKS,)):
                path = tmp_path / f"file{number}" / "checks.py"
                path.parent.mkdir(exist_ok=True)
                path.write_text(textwrap.dedent(source), "utf-8")
                files.append((path, Visibility.HIDDEN if number else Visibility.PUBLIC))
            return stack.enter_context(contextlib.closing(CollectedChecks(files)))

        yield collect


def _run(checks, name, submission):
    return checks.run(next(check for check in checks.checks if check.id == name), submission)


def test_names_titles_and_marks_are_read(collect):
    found = collect().checks
    assert [(check.id, check.title, check.task, check.points, check.requires) for check in found] == [
        ("passes", "It passes", "a", 1.0, ()),
        ("fails", "It fails", "a", 2.5, ("passes", "draws")),
        ("draws", "It draws", "b", 1.0, ()),
        ("breaks", "It breaks", "b", 1.0, ()),
    ]


def test_fixtures_are_made_anew_for_every_run(collect):
    checks, first, second = collect(), Fake("first"), Fake("second")
    for submission in (first, second, second):
        assert _run(checks, "passes", submission) is None
    assert [entry for entry in second.log if isinstance(entry, str)] == ["set up", "torn down"] * 2
    assert len(first.log) == 3


def test_what_a_check_raises_comes_out_as_it_was_raised(collect):
    checks = collect()
    found = _run(checks, "fails", Fake("Ada"))
    assert isinstance(found, CheckFailed)
    assert found.finding == Finding(message="seen by Ada")
    assert isinstance(_run(checks, "breaks", Fake()), ZeroDivisionError)
    assert _run(checks, "passes", Fake()) is None


@pytest.mark.parametrize(
    ("fixture", "kind"), [("raise OSError", OSError), ("yield\n    raise KeyError", KeyError)]
)
def test_a_fixture_that_fails_is_no_pass(fixture, kind, collect):
    above = f"@pytest.fixture\ndef broken():\n    {fixture}"
    assert isinstance(_run(collect(_around("", above, taken="broken")), "it", Fake()), kind)


@pytest.mark.parametrize("body", ["pytest.skip('not today')", "pytest.xfail('known')"])
def test_skipping_from_within_is_no_pass(body, collect):
    assert _run(collect(_around(body)), "it", Fake()) is not None


@pytest.mark.parametrize("taken", ["submission", "submission, own"])
def test_a_check_may_compute_with_infinite_numbers(taken, collect):
    """Numpy would warn, and a warning may be an error."""
    above = "import numpy as np\n@pytest.fixture\ndef own():\n    pass"
    submission = Fake()
    source = _around("submission.log.append(np.array([np.inf]) - np.inf)", above, taken=taken)
    assert _run(collect(source), "it", submission) is None
    assert np.isnan(submission.log).all()


def test_a_check_that_pytest_never_called_is_no_pass(collect, monkeypatch):
    checks = collect()
    monkeypatch.setattr("course.scoring.checks.collected._run_item", lambda _item: None)
    assert isinstance(_run(checks, "passes", Fake()), RuntimeError)


@pytest.mark.parametrize(
    ("said", "above", "mark", "taken", "body"),
    [
        (["before", "it"], "def setup_function():\n    seen.append('before')", "", "", "seen.append('it')"),
        (["before", "it"], "def setup_module():\n    seen.append('before')", "", "", "seen.append('it')"),
        (
            ["before", "it"],
            "@pytest.fixture(autouse=True)\ndef own():\n    seen.append('before')",
            "", "", "seen.append('it')",
        ),
        (
            ["before", "it"],
            "@pytest.fixture\ndef own():\n    seen.append('before')",
            "@pytest.mark.usefixtures('own')", "", "seen.append('it')",
        ),
        (["theirs"], "@pytest.fixture\ndef rng():\n    return 'theirs'", "", "rng", "seen.append(rng)"),
        (
            ["theirs"],
            "@pytest.fixture\ndef submission():\n    return 'theirs'",
            "", "draw, submission", "seen.append(submission)",
        ),
        ([], "", "@pytest.mark.skip", "", "seen.append('it')"),
        ([], "", "@pytest.mark.skipif(True, reason='always')", "", "seen.append('it')"),
        (["test_it"], "", "", "request", "seen.append(request.node.name)"),
    ],
)  # fmt: skip
def test_whatever_an_author_puts_around_a_check_counts(said, above, mark, taken, body, collect):
    checks = collect(_around(body, f"seen = []\n{above}", mark, taken))
    for _ in range(2):
        checks._items["it"].obj.__globals__["seen"].clear()
        outcome = _run(checks, "it", Fake())
        assert checks._items["it"].obj.__globals__["seen"] == said
        assert (outcome is None) == bool(said)


def test_a_check_has_its_parameters(collect):
    mark = "@pytest.mark.parametrize('x', [1, 2])"
    checks = collect(_around("submission.log.append(x)", mark=mark, taken="submission, x"))
    submission = Fake()
    assert [_run(checks, check.id, submission) for check in checks.checks] == [None, None]
    assert submission.log == [1, 2]


def test_a_package_around_the_checks_sets_itself_up(collect, tmp_path):
    (tmp_path / "file0").mkdir()
    (tmp_path / "file0" / "__init__.py").write_text(
        "import os\ndef setup_module():\n    os.environ['SET_UP'] = 'yes'\n", "utf-8"
    )
    body = "import os\n    assert os.environ.pop('SET_UP') == 'yes'"
    assert _run(collect(_around(body)), "it", Fake()) is None


def test_a_check_that_gives_something_is_pytests_to_judge(collect):
    above = "class Later:\n    def __await__(self):\n        yield"
    checks = collect(_around("return Later()", above))
    assert "async def functions are not natively supported" in str(_run(checks, "it", Fake()))


def test_it_makes_no_difference_whether_pytest_calls_a_check(collect, monkeypatch):
    def outcomes(checks):
        submission = Fake(seed=7)
        said = [(name, str(_run(checks, name, submission))) for name in ("draws", "breaks")]
        return [*said, *submission.log]

    called = collect()
    assert called._plain.keys() == {"draws", "breaks"}
    monkeypatch.setattr("course.scoring.checks.collected._plainly_taken", lambda _item: None)
    by_pytest = collect()
    assert not by_pytest._plain
    assert outcomes(called) == outcomes(by_pytest)


def test_numbers_drawn_depend_on_the_seed_and_the_check_alone(collect):
    checks = collect()
    drawn = []
    for seed in (1, 1, 2):
        submission = Fake(seed=seed)
        assert _run(checks, "draws", submission) is None
        drawn += submission.log
    assert drawn[0] == drawn[1] != drawn[2]


def test_public_checks_come_first_and_required_ones_before_those_that_need_them(collect):
    hidden = _CHECKS.replace("test_", "test_hidden_").replace('("passes", "draws")', '("hidden_draws")')
    checks = collect(_CHECKS, hidden)
    assert [check.visibility for check in checks.checks] == [Visibility.PUBLIC] * 4 + [Visibility.HIDDEN] * 4
    order = [check.id for check in checks.in_order()]
    assert order.index("draws") < order.index("fails")
    assert order.index("hidden_draws") < order.index("hidden_fails")


def test_two_sessions_at_once_do_not_mix(collect):
    first, second = collect(), collect()
    one, two = Fake("one"), Fake("two")
    assert "one" in str(_run(first, "fails", one))
    assert "two" in str(_run(second, "fails", two))
    assert one.log == two.log == ["set up", "torn down"]


def test_many_runs_keep_nothing(collect):
    checks = collect()

    def grade(times):
        for _ in range(times):
            for check in checks.checks:
                checks.run(check, Fake())
        gc.collect()
        return len(gc.get_objects())

    grade(20)
    before = grade(20)
    assert grade(200) - before < 200


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("conftest.py", "raise RuntimeError('a conftest was read')"),
        ("pytest.ini", "[pytest]\naddopts = --no-such-option\n"),
        ("pyproject.toml", "[tool.pytest.ini_options]\naddopts = '--no-such-option'\n"),
        ("sitecustomize.py", "raise RuntimeError('the working folder is on the path')"),
    ],
)
def test_files_around_the_checks_change_nothing(file, text, collect, tmp_path, monkeypatch):
    (tmp_path / "file0").mkdir()
    for folder in (tmp_path, tmp_path / "file0"):
        (folder / file).write_text(text, "utf-8")
    monkeypatch.chdir(tmp_path)
    path = list(sys.path)
    checks = collect()
    assert _run(checks, "passes", Fake()) is None
    assert sys.path == path


def test_settings_in_the_environment_change_nothing_and_stay(collect, monkeypatch):
    for name in ("PYTEST_ADDOPTS", "PYTEST_PLUGINS"):
        monkeypatch.setenv(name, "--no-such-option" if name == "PYTEST_ADDOPTS" else "no_such_plugin")
    before = {name: value for name, value in os.environ.items() if name != "PYTEST_CURRENT_TEST"}
    assert _run(collect(), "passes", Fake()) is None
    assert {name: value for name, value in os.environ.items() if name != "PYTEST_CURRENT_TEST"} == before


def test_nothing_is_written_beside_the_checks(collect, tmp_path):
    checks = collect()
    _run(checks, "fails", Fake())
    assert [path.name for path in (tmp_path / "file0").iterdir()] == ["checks.py"]


@pytest.mark.parametrize(
    ("source", "problem"),
    [
        ("import no_such_module", "no_such_module"),
        ("def test_a(:\n    pass", "cannot be imported"),
        ("x = 1", "no check in it"),
        ("def test_a():\n    pass", "no docstring"),
        ("def test_a():\n    '''Title'''", "lacks a mark"),
        ("import pytest\n\n@pytest.mark.pionts(1)\ndef test_a():\n    '''Title'''", "'pionts' not found"),
    ],
)
def test_a_file_that_is_wrong_is_named(source, problem, collect):
    with pytest.raises(ContentError, match=problem) as caught:
        collect(source)
    assert "checks.py" in str(caught.value)


def test_the_pytest_that_runs_here_is_one_the_project_allows():
    project = tomllib.loads((Path(__file__).parents[3] / "pyproject.toml").read_text("utf-8"))["project"]
    requirement = next(entry for entry in project["dependencies"] if entry.startswith("pytest"))
    low, high = re.fullmatch(r"pytest>=([\d.]+),<(\d+)", requirement).groups()
    here = tuple(map(int, re.findall(r"\d+", pytest.__version__)[:2]))
    assert tuple(map(int, low.split("."))) <= here < (int(high), 0)
