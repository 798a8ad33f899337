"""The mistakes of an exercise, ``solutions/<id>/mistakes.py``: words beside the wrong programs that they fit.

The file makes one ``Mistakes`` and calls it once for each code::

    mistakes = Mistakes()
    mistakes(
        "SIGN_TURNED",
        "The difference is taken the wrong way round.",
        "It is the coarse result less the fine one.",
    ).edit("error_left", {"coarse - fine": "fine - coarse"})

What ships is computed from it (``course author build``): the words, and what each program answers to the
exercise's questions. The file itself takes no part in grading and is in no wheel.
"""

from __future__ import annotations

import ast
import itertools
import re
import sys
import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, get_args

from course.errors import ContentError
from course.printable import meant
from course.scoring.explain.story import Entry, Kind

#: What a code looks like.
CODE = re.compile(r"[A-Z][A-Z0-9]*(_[A-Z0-9]+)*")

#: A wrong program as a function: its task, the code of each of its mistakes, and the function.
Wrong = tuple[str, tuple[str, ...], Callable[..., Any]]


@dataclass(frozen=True, slots=True)
class Variant:
    """A right or a wrong program, as what differs from the model solution.

    Attributes:
        name: of a wrong one its task, a dot and its code, with a number from the second on; of a right one
            what is unusual.
        task: the function whose points a wrong one loses, and the only one; empty for a right one.
        code: of its mistake.
        also: codes that it gets under other draws of a grading run and that are as true of it; "" for none.
        changed: texts of the function ``of`` in the model solution, each with what stands there instead.
        text: another body of that function; without one, definitions that win over the model solution's.
        around: whether that body calls the model solution's function, as ``_right``.
        line: where it stands in its file.
    """

    name: str
    task: str = ""
    code: str = ""
    also: tuple[str, ...] = ()
    changed: Mapping[str, str] = field(default_factory=dict)
    of: str = ""
    text: str = ""
    around: bool = False
    line: int = 0

    def composed(self, model: str, file: Path) -> str:
        """The model solution with this variant's definitions after it, so that they win.

        Raises:
            ContentError: the text to change is not in the function, or is there twice; the result is not
                Python. ``file`` and line are named.
        """
        text = textwrap.dedent(self.text).strip("\n")
        own = text if text and not self.of else self._changed(model, text, file)
        whole = f"{model.rstrip()}\n\n\n{own}\n"
        try:
            compile(whole, str(file), "exec")
        except (SyntaxError, ValueError) as error:
            why = getattr(error, "msg", error)
            said = f"{self.name}: the model solution with this is not valid Python: {why}."
            raise ContentError(file, self.line, said, help="Correct its definitions.") from None
        return whole

    def _changed(self, model: str, body: str, file: Path) -> str:
        """The function ``of`` with its texts changed, or with another body."""
        found = [
            node
            for node in ast.parse(model).body
            if isinstance(node, ast.FunctionDef | ast.ClassDef) and node.name == self.of
        ]
        if not found:
            said = f"{self.name}: the model solution has no function {self.of}."
            names = [node.name for node in ast.parse(model).body if isinstance(node, ast.FunctionDef)]
            raise ContentError(file, self.line, said, help=meant(self.of, names, "Name one that it has."))
        node, lines = found[0], model.splitlines()
        if body:
            head = lines[node.lineno - 1 : node.body[0].lineno - 1]
            kept = [f"_right = {self.of}", "", ""] if self.around else []
            return "\n".join([*kept, *head, textwrap.indent(body, "    ")])
        text = "\n".join(lines[node.lineno - 1 : node.end_lineno])
        for old, new in self.changed.items():
            if (times := text.count(old)) != 1:
                said = f"{self.name}: {old!r} stands {times} times in {self.of} of the model solution."
                advice = "Write a text that stands there once; the docstring counts."
                raise ContentError(file, self.line, said, help=advice)
            text = text.replace(old, new)
        return text


class Mistakes:
    """All that is known about the mistakes of one exercise.

    Attributes:
        words: by code.
        lines: of each code's words in the file.
        true_too: by code, what else is true of every program with that mistake.
        wrong: programs with one mistake each, in the order in which they stand.
        right: unusual programs that get full marks.
    """

    def __init__(self) -> None:
        self.words: dict[str, Entry] = {}
        self.lines: dict[str, int] = {}
        self.true_too: dict[str, tuple[str, ...]] = {}
        self.wrong: list[Variant] = []
        self.right: list[Variant] = []
        self._more: list[Callable[[], Iterable[Wrong]]] = []

    def __call__(
        self,
        code: str,
        looks_like: str = "",
        advice: str = "",
        *,
        kind: Kind = "cause",
        true_too: tuple[str, ...] = (),
    ) -> Mistake:
        """The words of a code, and where its programs are added; without words a code that the course has.

        Args:
            looks_like, advice, kind: as in ``Entry``.
            true_too: other codes that are true of every program with this mistake.
        """
        if not CODE.fullmatch(code):
            raise ValueError(f"{code!r} is no code, which is capital letters, digits and underscores")
        if kind not in get_args(Kind):
            raise ValueError(f"{kind!r} is none of the kinds {', '.join(get_args(Kind))}")
        if looks_like or advice:
            if code in self.words:
                raise ValueError(f"{code} has words twice")
            if not advice.strip():
                raise ValueError(f"{code} says what a mistake looks like, and not what to do about it")
            self.words[code] = Entry(looks_like, advice, kind)
            self.lines[code] = sys._getframe(1).f_lineno
        if true_too:
            self.true_too[code] = true_too
        return Mistake(self, code)

    def accept(self, unusual: str, text: str) -> None:
        """A right program that a narrow check would refuse; ``unusual`` says why it might."""
        self.right.append(Variant(unusual, text=text, line=sys._getframe(1).f_lineno))

    def terms(
        self, task: str, family: Callable[..., Callable[..., Any]], wrong: Mapping[str, Mapping[str, Any]]
    ) -> None:
        """The programs of a family with one term wrong, then those with two.

        Args:
            family: gives a program for its terms, the right one if it is given none.
            wrong: by term, the code of each mistake and the form that the term has then.
        """
        self._more.append(lambda: with_terms(task, family, wrong))

    def more(self, programs: Callable[[], Iterable[Wrong]]) -> Callable[[], Iterable[Wrong]]:
        """Programs that a function of one's own gives; to be written above it."""
        self._more.append(programs)
        return programs

    def functions(self) -> Iterator[Wrong]:
        """The programs that are functions, in the order in which they were added."""
        return itertools.chain.from_iterable(programs() for programs in self._more)


@dataclass(frozen=True, slots=True)
class Mistake:
    """One mistake, to which its programs are added."""

    mistakes: Mistakes
    code: str

    def edit(
        self, task: str, changed: Mapping[str, str], *, of: str = "", also: tuple[str, ...] = ()
    ) -> Mistake:
        """The model solution with some texts of a function changed.

        Args:
            changed: texts that stand once in the function, and what stands there instead.
            of: the function to change, where it is not the task itself.
            also: as in ``Variant``.
        """
        return self._add(task, also, changed=changed, of=of or task, line=sys._getframe(1).f_lineno)

    def body(self, task: str, text: str, *, of: str = "", also: tuple[str, ...] = ()) -> Mistake:
        """The model solution with another body of a function; the arguments are those of ``edit``."""
        return self._add(task, also, text=text, of=of or task, line=sys._getframe(1).f_lineno)

    def around(self, task: str, text: str, *, of: str = "", also: tuple[str, ...] = ()) -> Mistake:
        """As ``body``, with the function of the model solution at hand: the text calls it ``_right``."""
        return self._add(task, also, text=text, of=of or task, around=True, line=sys._getframe(1).f_lineno)

    def program(self, task: str, text: str, *, also: tuple[str, ...] = ()) -> Mistake:
        """The model solution with definitions of its own in the place of some."""
        return self._add(task, also, text=text, line=sys._getframe(1).f_lineno)

    def _add(self, task: str, also: tuple[str, ...], **how: Any) -> Mistake:
        number = 1 + sum((one.task, one.code) == (task, self.code) for one in self.mistakes.wrong)
        name = f"{task}.{self.code}" + (f".{number}" if number > 1 else "")
        self.mistakes.wrong.append(Variant(name, task, self.code, also, **how))
        return self


def with_terms(
    task: str, family: Callable[..., Callable[..., Any]], wrong: Mapping[str, Mapping[str, Any]]
) -> Iterator[Wrong]:
    for term, forms in wrong.items():
        for code, form in forms.items():
            yield task, (code,), family(**{term: form})
    for one, other in itertools.combinations(wrong, 2):
        for (code, form), (second, another) in itertools.product(wrong[one].items(), wrong[other].items()):
            yield task, (code, second), family(**{one: form, other: another})
