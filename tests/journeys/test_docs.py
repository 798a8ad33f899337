"""What a reader of the docs types: each command that a page prints is accepted, and most are run as printed.

``docs.toml`` says which are only parsed, and why. Blocks are run from their first line to their last, each in
a place of its own; an ordinary run tries those of the day, and parses every command.
"""

from __future__ import annotations

import itertools
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from course.cli.frame.app import _program
from course.cli.frame.options import global_options
from tests.journeys.conftest import ROOT, Way, _environment, in_turn

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
TABLE = tomllib.loads(Path(__file__).with_name("docs.toml").read_text("utf-8"))
WORDS: dict[str, str] = TABLE["words"]
CODE = re.compile(r"(`+)(?!`)(.+?)(?<!`)\1(?!`)", re.DOTALL)
#: A name, as of an exercise or a format; numbers, paths and settings are none.
NAME = re.compile(r"[a-z][a-z0-9-]+")


@dataclass(frozen=True)
class Printed:
    """A command as a page prints it; commands of one block have its line, and those in sentences 0."""

    page: str
    line: int
    command: str
    block: int = 0

    def __str__(self) -> str:
        return f"{self.page}:{self.line}: {self.command}"

    @property
    def rule(self) -> dict[str, Any]:
        place = "block" if self.block else "sentence"
        for rule in TABLE["rule"]:
            if rule.get("in", place) == place and re.fullmatch(rule["command"], " ".join(self.typed)):
                return dict(rule)
        pytest.fail(f"{self}: no rule of docs.toml is about it")

    @property
    def typed(self) -> list[str]:
        """Its words, without a comment and without the program that reads what it prints."""
        return list(itertools.takewhile(lambda word: word != "|", shlex.split(self.command, comments=True)))

    def lines(self) -> list[list[str]]:
        """What a reader types: one line for each alternative, with a word for each in capitals."""
        chosen = [word.strip("[]").split("|") for word in self.typed[1:]]
        return [[WORDS.get(word, word) for word in line] for line in itertools.product(*chosen)]


def printed(page: str, text: str) -> list[Printed]:
    """The commands of a page: lines of its blocks, fenced or indented, and code within its sentences."""
    found, prose, fence, block = [], [], "", 0
    for number, line in enumerate(text.splitlines(), 1):
        mark = re.match(r"(`{3,})[^`]*$", line)
        indented = not fence and line.startswith("    ")
        if mark and not fence:
            fence, block = mark[1], number
        elif mark and line == fence:
            fence, block = "", 0
        elif fence or indented:
            block = block or number
            if command := re.match(r"\s*(?:\$ )?(course\s.*)", line):
                found.append(Printed(page, number, command[1], block))
        else:
            block = 0
        prose.append("" if fence or indented or mark else line)
    said = "\n".join(prose)
    for code in CODE.finditer(said):
        if re.match(r"course\s", code[2]):
            line_number = said.count("\n", 0, code.start()) + 1
            found.append(Printed(page, line_number, " ".join(code[2].split())))
    return found


def of_page(path: Path) -> list[Printed]:
    return printed(path.relative_to(ROOT).as_posix(), path.read_text("utf-8"))


ALL_PRINTED = [one for path in PAGES for one in of_page(path)]
#: What a page makes is known to the commands after it.
MADE = {one.typed[4] for one in ALL_PRINTED if one.typed[1:3] == ["author", "new"]}


def refused(one: Printed) -> str:
    """Why the command line does not take a command; empty if it does."""
    try:
        for line in one.lines():
            accepted(line, in_sentence=not one.block)
    except Exception as error:  # the parser's own classes moved between typer's versions
        asked_for_help = getattr(error, "exit_code", None) == 0
        return "" if asked_for_help else getattr(error, "format_message", lambda: str(error))()
    return ""


def accepted(line: list[str], *, in_sentence: bool) -> None:
    """Give a line to the program's own parser, down to the command that it would run.

    A sentence may leave out what a command needs, but name nothing that does not exist.
    """
    command, context, name, rest = _program(fancy=False), None, "course", list(global_options(line).rest)
    while True:
        if in_sentence:
            command.no_args_is_help = False
            for parameter in command.params:
                parameter.required = False
        context = command.make_context(name, rest, parent=context)
        rest = [*getattr(context, "_protected_args", ()), *context.args]
        if not hasattr(command, "resolve_command") or not rest:
            break
        name, command, rest = command.resolve_command(context, rest)
    # A name is one of those that the shell's completion offers, where it offers any.
    for parameter in command.params:
        given = context.params.get(parameter.name)
        words = [word for value in as_list(given) for word in str(value).split(",")]
        known = {item.value for item in parameter.shell_complete(context, "") if item.type == "plain"}
        strange = {word for word in words if NAME.fullmatch(word)} - known - MADE - {*WORDS.values()}
        assert not (known and strange), f"{parameter.name} cannot be {', '.join(strange)}"


def as_list(value: Any) -> Iterable[Any]:
    return value if isinstance(value, (list, tuple)) else [] if value is None else [value]


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_the_command_line_takes_every_command_of_a_page(path: Path) -> None:
    faults = [f"{one}\n    {why}" for one in of_page(path) if "excused" not in one.rule and (why := refused(one))]
    if faults:
        pytest.fail("\n".join(faults))


def test_every_rule_and_every_word_of_the_table_is_about_a_command() -> None:
    rules = [one.rule for one in ALL_PRINTED]
    assert [rule for rule in TABLE["rule"] if rule not in rules] == []
    assert all(len({"run", "parsed", "excused"} & rule.keys()) == 1 for rule in rules)
    words = {part for one in ALL_PRINTED for word in one.typed for part in word.strip("[]").split("|")}
    assert WORDS.keys() - words == set()
    assert {word for word in words if re.fullmatch(r"[A-Z]+|\.+", word)} - WORDS.keys() == set()


def test_blocks_and_sentences_are_read_and_comments_and_output_are_not() -> None:
    page = (
        "Type `course\ncheck` or `` `x` ``.\n\n```sh\npip x\ncourse demo  # `course no`\nof course not\n```\n\n"
        "    course go\n\n````markdown\n```console\n$ course a | b\n```\n````\n`course quiz take`"
    )
    found = [(one.line, one.block, one.typed[1:]) for one in printed("page", page)]
    assert found == [
        (6, 4, ["demo"]), (10, 10, ["go"]), (14, 12, ["a"]), (1, 0, ["check"]), (17, 0, ["quiz", "take"])
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("wrong", "why"),
    [
        ("chek", "No such command"),
        ("check --no-such-option", "No such option"),
        ("grade run submissions", "Missing option"),
        ("grade late grades            who is late", "unexpected extra"),
        ("grade export grades --format exel", "cannot be exel"),
        ("sim run free-fal", "cannot be free-fal"),
        ("init --with github,emacs", "cannot be emacs"),
    ],
)
def test_a_wrong_command_in_a_copy_of_a_page_is_seen(wrong: str, why: str) -> None:
    page = (ROOT / "README.md").read_text("utf-8")
    text = page.replace("```sh\n", f"```sh\ncourse {wrong}\n", 1)
    (fault,) = [one for one in printed("README.md", text) if one.command == f"course {wrong}"]
    assert str(fault) == f"README.md:{fault.line}: course {wrong}"
    assert why in refused(fault)
    assert not [one for one in printed("README.md", page) if refused(one)]


@pytest.fixture(scope="session")
def workspace(installed: tuple[list[str], dict[str, str]], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A student's: an attempt at the integrators that failed, and then the right file."""
    folder = tmp_path_factory.mktemp("docs") / "workspace"
    command, says = installed
    type_ = Way(command, folder.parent, {**_environment(folder.parent), **says})
    type_("init", folder)
    type_("start", "integrators", cwd=folder)
    type_("check", "integrators", cwd=folder, code=1)
    shutil.copy(ROOT / "solutions" / "integrators" / "integrators.py", folder / "integrators")
    return folder


@pytest.fixture(scope="session")
def class_(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An instructor's: the right file under a name of its own, the stub, and the right file, graded.

    The late policy is the one that the page shows.
    """
    folder = tmp_path_factory.mktemp("docs") / "class"
    files = {"ada": "solutions/{}/homework.py", "grace": "exercises/{}/{}.py", "alan": "solutions/{}/{}.py"}
    for student, file in files.items():
        work = folder / "submissions" / student
        work.mkdir(parents=True)
        name = Path(file.format("integrators", "integrators"))
        shutil.copy(ROOT / name.with_name("integrators.py"), work / name.name)
    own = "".join(f"{name},{name.title()},{name}@uni.example\n" for name in files)
    canvas = "".join(f"{name.title()},{id_},,{name},A\n" for id_, name in enumerate(files, 101))
    (policy,) = re.findall(r"```toml\n(.*?)```", (ROOT / "docs/instructor.md").read_text("utf-8"), re.DOTALL)
    for name, text in {
        "roster.csv": f"student,name,email\n{own}",
        "class.csv": (sheet := f"Student,ID,SIS User ID,SIS Login ID,Section\n{canvas}"),
        "canvas-gradebook.csv": sheet,
        "late.toml": policy,
        "times.csv": "student,exercise,submitted_at\nalan,integrators,2026-12-02T10:00:00Z\n",
    }.items():
        (folder / name).write_text(text, "utf-8")
    type_ = Way([sys.executable, "-P", "-m", "course"], folder, _environment(folder))
    type_(*"grade run submissions --out grades --exercise integrators".split(), code=6, PYTHONPATH=str(ROOT))
    return folder


@pytest.fixture
def typing(
    student: Way, instructor: Way, tmp_path: Path, request: pytest.FixtureRequest
) -> Callable[..., None]:
    """Types a line where a reader of it is: in a copy of the place, which stays until the test ends."""

    def make(place: str, there: Path) -> None:
        if place == "nothing":
            there.mkdir()
        elif place == "checkout":
            listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True)
            parts = ("course/", "exercises/", "solutions/", "quiz/", "docs/", "tests/graders/")
            for name in (
                "pyproject.toml",
                *filter(lambda name: name.startswith(parts), listed.stdout.decode().split("\0")),
            ):
                (there / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(ROOT / name, there / name)
        else:
            shutil.copytree(request.getfixturevalue({"class": "class_"}.get(place, place)), there)

    def type_(line: list[str], code: int) -> None:
        whole = " ".join(["course", *line, ""])
        place = next(place for start, place in TABLE["places"].items() if whole.startswith(start))
        there = tmp_path / place
        if not there.exists():
            make(place, there)
        if line[:2] == ["grade", "run"]:  # "`grades` must be new", says the page
            shutil.rmtree(there / "grades")
        if place == "checkout":
            instructor(*line, cwd=there, code=code, PYTHONPATH=str(there))
        else:
            (instructor if place == "class" else student)(*line, cwd=there, code=code)

    return type_


#: What is run: the commands of a block one after the other, and those in the sentences of a page.
STORIES = [
    [one for one in story if "run" in one.rule]
    for _, story in itertools.groupby(ALL_PRINTED, key=lambda one: (one.page, one.block))
]
STORIES = [story for story in STORIES if story]


@pytest.mark.parametrize("story", in_turn(STORIES, 3), ids=lambda story: f"{story[0].page}:{story[0].line}")
def test_what_a_page_prints_does_what_it_says(story: list[Printed], typing: Callable[..., None]) -> None:
    for one in story:
        try:
            if "first" in one.rule:
                typing(shlex.split(one.rule["first"])[1:], 0)
            for line in one.lines():
                typing(line, one.rule["run"])
        except AssertionError as error:
            pytest.fail(f"{one}\n{error}")


def test_a_command_that_ends_otherwise_is_seen(typing: Callable[..., None]) -> None:
    wrong = Printed("README.md", 1, "course lesson 99", 1)
    assert refused(wrong) == ""
    with pytest.raises(pytest.fail.Exception, match="README.md:1: course lesson 99"):
        test_what_a_page_prints_does_what_it_says([wrong], typing)
