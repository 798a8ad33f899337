"""What a reader of the docs types: each command that a page prints is accepted, and most are run as printed.

``docs.toml`` says which are only parsed, and why. A block is run from its first line to its last, in a place
of its own; an ordinary run tries the blocks of the day, and parses every command.
"""

import itertools
import re
import shlex
import shutil
import sys
import tomllib
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from course.cli.frame.app import _program
from course.cli.frame.options import global_options
from tests.journeys.conftest import ROOT, Way, _environment, in_turn

PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
TABLE = tomllib.loads(Path(__file__).with_name("docs.toml").read_text("utf-8"))
CODE = re.compile(r"(`+)(?!`)(.+?)(?<!`)\1(?!`)", re.DOTALL)
#: A name, as of an exercise or a format; numbers, paths and settings are none.
NAME = re.compile(r"[a-z][a-z0-9-]+")
SHEET = """Student,ID,SIS User ID,SIS Login ID,Section
Ada Lovelace,101,,ada,A
Alan Turing,102,,alan,A
Grace Hopper,103,,grace,A
"""


@dataclass(frozen=True)
class Printed:
    """A command as a page prints it, and the line where its block begins; 0 within a sentence."""

    page: str
    line: int
    command: str
    block: int = 0

    def __str__(self):
        return f"{self.page}:{self.line}: {self.command}"

    @property
    def typed(self):
        """Its words, without a comment and without the program that reads what it prints."""
        try:
            words = shlex.split(self.command, comments=True)
        except ValueError as error:
            pytest.fail(f"{self}: {error}")
        return [word.strip("[]") for word in itertools.takewhile(lambda word: word != "|", words)]

    @property
    def rule(self):
        place, words = "block" if self.block else "sentence", " ".join(self.typed)
        for rule in TABLE["rule"]:
            if rule.get("in", place) == place and re.fullmatch(rule["command"], words):
                return dict(rule)
        pytest.fail(f"{self}: no rule of docs.toml is about it")

    def lines(self):
        """What a reader types: one line for each alternative, with a word for each in capitals."""
        chosen = itertools.product(*(word.split("|") for word in self.typed[1:]))
        return [[TABLE["words"].get(word, word) for word in line] for line in chosen]


def printed(page, text):
    """The commands of a page: lines of its blocks, fenced or indented, and code within its sentences."""
    found, prose, fence, block = [], "", "", 0
    for number, line in enumerate(text.splitlines(), 1):
        mark = re.match(r"(`{3,})[^`]*$", line)
        inside = bool(fence) or line.startswith("    ")
        if mark and not fence:
            fence, block = mark[1], number
        elif mark and line == fence:
            fence, block = "", 0
        else:
            block = (block or number) if inside else 0
            if inside and (command := re.match(r"\s*(?:\$ )?(course\s.*)", line)):
                found.append(Printed(page, number, command[1], block))
        prose += "\n" if mark or inside else f"{line}\n"
    for code in CODE.finditer(prose):
        if re.match(r"course\s", code[2]):
            number = prose.count("\n", 0, code.start()) + 1
            found.append(Printed(page, number, " ".join(code[2].split())))
    return found


def of_page(path):
    return printed(path.relative_to(ROOT).as_posix(), path.read_text("utf-8"))


EVERY = [one for path in PAGES for one in of_page(path)]
#: What a page makes is known to the commands after it.
MADE = {name for one in EVERY if one.typed[1:3] == ["author", "new"] for name in one.typed[4:5]}
MADE |= {name for one in EVERY if one.typed[1:3] == ["author", "pictures"] for name in one.typed[3:4]}


def refused(one):
    """Why the command line does not take a command; empty if it does."""
    try:
        for line in one.lines():
            parse(line, in_sentence=not one.block)
    except Exception as error:  # the parser's own classes moved between typer's versions
        said = getattr(error, "format_message", error.__str__)()
        return "" if getattr(error, "exit_code", None) == 0 else said  # 0: it asked for help
    return ""


def parse(line, *, in_sentence):
    """Give a line to the program's own parser, down to the command that it would run.

    A sentence may leave out what a command needs, but name nothing that does not exist.
    """
    command, context, name, rest = _program(fancy=False), None, "course", list(global_options(line).rest)
    while command is not None:
        if in_sentence:
            command.no_args_is_help = False
            for parameter in command.params:
                parameter.required = False
        context = command.make_context(name, rest, parent=context)
        leaf, rest = command, [*getattr(context, "_protected_args", ()), *context.args]
        deeper = bool(rest) and hasattr(command, "resolve_command")
        name, command, rest = command.resolve_command(context, rest) if deeper else (name, None, rest)
    # A name is one of those that the shell's completion offers, where it offers any.
    for parameter in leaf.params:
        given = context.params.get(parameter.name) or ()
        words = ",".join(map(str, given)) if isinstance(given, (list, tuple)) else str(given)
        known = {item.value for item in parameter.shell_complete(context, "") if item.type == "plain"}
        known |= MADE.union(TABLE["words"].values()) if known else set()
        strange = [word for word in words.split(",") if NAME.fullmatch(word) and word not in known]
        if known and strange:
            raise LookupError(f"{parameter.name} cannot be {', '.join(strange)}")


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Where there is no gradebook whose students would be offered."""
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_the_command_line_takes_every_command_of_a_page(path):
    faults = [f"{one}\n    {why}" for one in of_page(path) if (why := refused(one))]
    if faults:
        pytest.fail("\n".join(faults))


def test_every_rule_and_every_word_of_the_table_is_about_a_command():
    rules = [one.rule for one in EVERY]
    assert [rule for rule in TABLE["rule"] if rule not in rules] == []
    assert all(("run" in rule) != ("parsed" in rule) for rule in rules)
    told = {part for one in EVERY for word in one.typed for part in word.split("|")}
    assert {word for word in told if re.fullmatch(r"[A-Z]+|\.+", word)} == TABLE["words"].keys()


def test_blocks_and_sentences_are_read_and_comments_and_output_are_not():
    page = (
        "Type `course\ncheck` or `` `x` ``.\n\n```sh\ncourse demo  # `course no`\nof course not\n```\n\n"
        "    course go\n\n````markdown\n```console\n$ course a | b\n```\n````\n`course quiz take`"
    )
    found = [(one.line, one.block, " ".join(one.typed[1:])) for one in printed("page", page)]
    assert found == [(5, 4, "demo"), (9, 9, "go"), (13, 11, "a"), (1, 0, "check"), (16, 0, "quiz take")]


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
    text = (ROOT / "README.md").read_text("utf-8").replace("```sh\n", f"```sh\ncourse {wrong}\n", 1)
    (fault,) = [one for one in printed("README.md", text) if one.command == f"course {wrong}"]
    assert str(fault) == f"README.md:{fault.line}: course {wrong}"
    assert why in refused(fault)


@pytest.fixture(scope="session")
def workspace(installed, tmp_path_factory):
    """A student's: an attempt at the integrators that failed, and then the right file."""
    folder = tmp_path_factory.mktemp("docs") / "workspace"
    way = Way(installed[0], folder.parent, {**_environment(folder.parent), **installed[1]})
    way("init", folder)
    way("start", "integrators", cwd=folder)
    way("check", "integrators", cwd=folder, code=1)
    shutil.copy(ROOT / "solutions" / "integrators" / "integrators.py", folder / "integrators")
    return folder


@pytest.fixture(scope="session")
def graded(tmp_path_factory):
    """An instructor's class: the right file under a name of its own, the right file, and the stub."""
    folder = tmp_path_factory.mktemp("docs") / "graded"
    for student, part, name in (
        ("ada", "solutions", "homework.py"),
        ("alan", "solutions", "integrators.py"),
        ("grace", "exercises", "integrators.py"),
    ):
        (folder / "submissions" / student).mkdir(parents=True)
        shutil.copy(ROOT / part / "integrators/integrators.py", folder / "submissions" / student / name)
    for name in ("roster.csv", "class.csv", "canvas-gradebook.csv"):
        (folder / name).write_text(SHEET, "utf-8")
    times = "student,exercise,submitted_at\nalan,integrators,2026-12-02T10:00:00Z\n"
    (folder / "times.csv").write_text(times, "utf-8")
    # The late policy is the one that the page shows.
    (policy,) = re.findall(r"```toml\n(.*?)```", (ROOT / "docs/instructor.md").read_text("utf-8"), re.DOTALL)
    (folder / "late.toml").write_text(policy, "utf-8")
    way = Way([sys.executable, "-P", "-m", "course"], folder, _environment(folder))
    way(
        "grade", "run", "submissions", "--exercise", "integrators", "--out", "grades",
        code=6, PYTHONPATH=str(ROOT),
    )  # fmt: skip
    return folder


@pytest.fixture
def typing(student, instructor, tmp_path, request):
    """Types a line where a reader of it is: in a copy of the place, which stays until the test ends."""

    def type_(line, code):
        whole = " ".join(["course", *line, ""])
        place = next(place for start, place in TABLE["places"].items() if whole.startswith(start))
        there = tmp_path / place
        if place == "checkout" and not there.exists():
            for part in ("course", "exercises", "solutions", "quiz", "docs", "tests/graders"):
                shutil.copytree(ROOT / part, there / part, ignore=shutil.ignore_patterns("__pycache__"))
            shutil.copy(ROOT / "pyproject.toml", there)
        elif not there.exists():
            shutil.copytree(request.getfixturevalue(place), there)
        if line[:2] == ["grade", "run"]:  # "`grades` must be new", says the page
            shutil.rmtree(there / "grades")
        # A process always: a copy of the checkout has a program of its own.
        way = replace(instructor, here=False) if place in {"graded", "checkout"} else student
        own = {"PYTHONPATH": str(there)} if place == "checkout" else {}
        way(*line, cwd=there, code=code, **own)

    return type_


#: What is run: the commands of a block one after the other, and those in the sentences of a page.
STORIES = [
    [one for one in story if "run" in one.rule]
    for _, story in itertools.groupby(EVERY, key=lambda one: (one.page, one.block))
]
STORIES = [story for story in STORIES if story]


@pytest.mark.parametrize("story", in_turn(STORIES, 3), ids=lambda story: f"{story[0].page}:{story[0].line}")
def test_what_a_page_prints_does_what_it_says(story, typing):
    for one in story:
        try:
            if "first" in one.rule:
                typing(shlex.split(one.rule["first"])[1:], 0)
            for line in one.lines():
                typing(line, one.rule["run"])
        except AssertionError as error:
            pytest.fail(f"{one}\n{error}")
