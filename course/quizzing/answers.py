"""Answers from a file: the quiz without a terminal.

TOML, or JSON of the same shape where the name ends in ``.json``::

    format_version = 1     # may be left out
    seed = 42              # which questions these answers are for; may be left out where --seed is given

    [answers]              # every question once: the option's id, its letter or its number
    sim-to-real-gap = "model-differs"
    digital-twin = "c"
"""

import json
import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from course.catalog.reading import LineMap, syntax_error_line
from course.errors import UsageError
from course.printable import counted, meant
from course.quizzing.bank import Bank, PosedQuestion
from course.strangers import read_bytes, toml

FORMAT_VERSION = 1
MAX_BYTES = 100_000


@dataclass(frozen=True, slots=True)
class AnswerFile:
    """A file of answers, as far as it can be read without knowing the questions.

    Attributes:
        seed: which questions it is for; None if it does not say.
    """

    path: Path
    text: str
    seed: int | None
    answers: dict[str, Any]

    def fail(self, key: str, problem: str, fix: str, code: str = "answers_format") -> NoReturn:
        """Raise the UsageError that points at the line of ``key`` (empty: the whole file)."""
        raise UsageError(f"{self.path}{self._at(key)}: {problem}", help=fix, code=code)

    def choose(self, posed: Sequence[PosedQuestion], bank: Bank, seed: int) -> dict[str, str]:
        """Option ids by question id.

        Args:
            posed: the questions that are asked, posed with ``seed``.

        Raises:
            UsageError: an answer is missing, or is to a question or an option that is not there.
        """
        if self.seed is not None and self.seed != seed:
            other = f"these answers are for seed {self.seed}, and the questions of seed {seed} are asked."
            fix = f"Leave --seed out, or print the others: course quiz take --questions --seed {seed}."
            self.fail("seed", other, fix, "answers_for_other_seed")
        asked = {question.question: question for question in posed}
        listed = ", ".join(asked)
        for name in self.answers:
            if name in bank.ids and name not in asked:
                fix = f"Remove the line; asked: {listed}."
                self.fail(name, f"{name} is not asked now.", fix, "question_not_asked")
            if name not in asked:
                fix = meant(name, asked, f"The questions are {listed}.")
                self.fail(name, f"there is no question {name[:60]!r}.", fix, "question_not_found")
        missing = [name for name in asked if self.answers.get(name, "") == ""]
        if missing:
            entry = f'a line {missing[0]} = "..." under [answers]'
            if _is_json(self.path):
                entry = f'"{missing[0]}": "..." to "answers"'
            are = f"{counted(len(missing), 'answer')} {'is' if len(missing) == 1 else 'are'} missing"
            fix = f"Add {entry}; a guess counts like any answer."
            self.fail("answers", f"{are}: {', '.join(missing)}.", fix, "answers_missing")
        return {name: self._option(name, asked[name], bank, seed) for name in asked}

    def _option(self, name: str, posed: PosedQuestion, bank: Bank, seed: int) -> str:
        given = self.answers[name]
        if isinstance(given, int) and not isinstance(given, bool):
            given = str(given)
        if not isinstance(given, str):
            fix = 'Write an option\'s letter: "b".'
            self.fail(name, f"the answer to {name} is not text.", fix, "answer_not_text")
        choice = posed.choice(given)
        if choice is None:
            options = ", ".join(f"{choice.letter} ({choice.id})" for choice in posed.choices)
            variants = next(d.value.variant for d in bank.documents if d.value.id == name)
            if any(given == option.id for variant in variants for option in variant.option):
                fix = f"Use the file with the questions it was written for, or choose among {options}."
                other = f"{given!r} answers {name} as another seed asks it, not as seed {seed} does."
                self.fail(name, other, fix, "answers_for_other_seed")
            none = f"{name} has no option {given[:60]!r}."
            self.fail(name, none, f"Choose among {options}.", "option_not_found")
        return choice.id

    def _at(self, key: str) -> str:
        """``:line`` of a key, or nothing."""
        if not key:
            return ""
        if _is_json(self.path):
            spelled = re.escape(json.dumps(key, ensure_ascii=False))
            found = re.search(rf"^.*?{spelled}\s*:", self.text, re.M | re.S)
            return f":{self.text.count(chr(10), 0, found.end()) + 1}" if found else ""
        where = (key,) if key in {"seed", "answers", "format_version"} else ("answers", key)
        return f":{LineMap(self.text).line(where)}"


def read_answers(path: Path) -> AnswerFile:
    """Read a file of answers.

    Raises:
        UsageError: it is missing, unreadable, too large, or not of the form above.
    """
    text = _read(path)
    data = _parse_json(path, text) if _is_json(path) else _parse_toml(path, text)
    seed = data.get("seed")
    answers = data.get("answers")
    file = AnswerFile(path, text, seed, answers if isinstance(answers, dict) else {})
    version = data.get("format_version", FORMAT_VERSION)
    if version != FORMAT_VERSION or isinstance(version, bool):
        other = f"format_version is {version!r}, and this program knows {FORMAT_VERSION}."
        file.fail("format_version", other, "Write 1, or install a newer version of the course.")
    unknown = sorted(set(data) - {"format_version", "seed", "answers"})
    if unknown:
        file.fail("", f"unknown key {unknown[0]!r} outside of the answers.", _form(path))
    if not isinstance(answers, dict):
        file.fail("", "there is no table of answers.", _form(path))
    if seed is not None and (not isinstance(seed, int) or isinstance(seed, bool)):
        file.fail("seed", "`seed` is not a whole number.", _form(path))
    return file


def _read(path: Path) -> str:
    try:
        data = read_bytes(path)
    except OSError as error:
        problem = f"{path} cannot be read: {error.strerror or error}."
        fix = "Name a file of answers; `course quiz take --questions` prints one to fill in."
        raise UsageError(problem, help=fix, code="answers_unreadable") from None
    if len(data) > MAX_BYTES:
        large = f"{path} is larger than {MAX_BYTES:,} bytes."
        raise UsageError(large, help="Name a file of answers.", code="answers_format")
    try:
        return data.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        said = f"{path}:{line}: this is not UTF-8 text."
        raise UsageError(said, help="Save it as UTF-8.", code="answers_format") from None


def _parse_toml(path: Path, text: str) -> dict[str, Any]:
    try:
        return toml(text)
    except tomllib.TOMLDecodeError as error:
        reason = str(error).rsplit(" (at ", 1)[0]
        raise _syntax(path, syntax_error_line(error, text), f"not valid TOML: {reason}") from None


def _parse_json(path: Path, text: str) -> dict[str, Any]:
    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        names = [name for name, _ in pairs]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            problem = f"{path}: {twice[:60]!r} is there twice."
            raise UsageError(problem, help="Keep one of the two.", code="answers_format")
        return dict(pairs)

    try:
        data = json.loads(text, object_pairs_hook=unique)
    except json.JSONDecodeError as error:
        raise _syntax(path, error.lineno, f"not valid JSON: {error.msg}") from None
    except (RecursionError, ValueError):
        raise _syntax(path, 1, "not usable JSON") from None
    if not isinstance(data, dict):
        raise _syntax(path, 1, "not a JSON object")
    return data


def _form(path: Path) -> str:
    """What a file of its kind looks like."""
    if _is_json(path):
        return 'Write: {"seed": 42, "answers": {"why-simulate": "b"}}.'
    return 'Write: seed = 42, then [answers] with lines like why-simulate = "b".'


def _is_json(path: Path) -> bool:
    return path.suffix.lower() == ".json"


def _syntax(path: Path, line: int, problem: str) -> UsageError:
    return UsageError(f"{path}:{line}: this is {problem}.", help=_form(path), code="answers_format")
