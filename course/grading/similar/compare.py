"""Which submissions are alike, compared on this machine with each other and with the course's own code.

The fewer submissions have a fingerprint, the more it weighs; those of the stub weigh nothing. A pair's share
is how much of the smaller submission is also in the other. So code that all students write hardly counts, and
a copy with changed names counts in full. Similarity is a reason to talk, not a finding: a short exercise has
few right solutions.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from course.errors import NotFoundError
from course.grading.quiz import EXERCISE_ID as QUIZ
from course.grading.similar.fingerprints import Parser, Prints

if TYPE_CHECKING:
    from collections.abc import Iterator

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise
    from course.grading.results.effective import Results

__all__ = ["Document", "Group", "Pair", "Similar", "compare"]

#: A fingerprint in more submissions than this proposes no pairs; it counts in those that others propose.
_COMMON = 40
#: Pairs that share fewer fingerprints than this are alike by chance.
_FEWEST = 3
MAX_PAIRS = 200


@dataclass(frozen=True)
class Document:
    """One source that is compared.

    Attributes:
        label: the student, or the name of the course's own file.
        own: the course's own code: compared with, but never reported as a copy.
    """

    label: str
    source: str
    prints: Prints = field(repr=False, compare=False)
    own: bool = False


@dataclass(frozen=True)
class Pair:
    """Two documents of one exercise.

    Attributes:
        share: how much of the smaller one, by weight, the other has too; 1 for all of it.
        passages: lines of the first and of the second that correspond, as (first, last).
        lines: of the first one in such passages.
    """

    exercise: str
    first: Document
    second: Document
    share: float
    passages: tuple[tuple[tuple[int, int], tuple[int, int]], ...]
    lines: int


@dataclass(frozen=True)
class Group:
    """Three or more submissions of one exercise that similar pairs link.

    Attributes:
        members: the students, by name; each is in a pair with another, not with all.
        share: of the weakest pair among them.
    """

    exercise: str
    members: tuple[str, ...]
    share: float


@dataclass
class Similar:
    """The result of a comparison.

    Attributes:
        pairs: the most alike first, at most ``MAX_PAIRS``.
        groups: the largest first, made from all pairs.
        compared: number of submissions.
        unreadable: "student exercise" of each file that is not Python, or is too long to compare.
        left_out: pairs beyond ``MAX_PAIRS``.
    """

    pairs: list[Pair] = field(default_factory=list)
    groups: list[Group] = field(default_factory=list)
    compared: int = 0
    unreadable: list[str] = field(default_factory=list)
    left_out: int = 0


def compare(results: Results, catalog: Catalog, exercises: tuple[str, ...], *, at_least: float) -> Similar:
    """Compare all submissions of each exercise with each other and with the course's own code.

    Args:
        exercises: ids; empty takes all that were graded.
        at_least: the smallest share to report.

    Raises:
        NotFoundError: no submission of such an exercise was graded.
    """
    found = Similar()
    graded = [
        item.id for item in results.exercises() if item.id != QUIZ and item.id in catalog.exercise_ids()
    ]
    unknown = [name for name in exercises if name not in graded]
    if unknown:
        raise NotFoundError(
            f"The gradebook has no code for the exercise {unknown[0]!r}.",
            help=f"It has {', '.join(graded) or 'none'}.",
            code="exercise_not_found",
        )
    with Parser() as parse:
        shipped = _shipped(catalog, parse) if graded else {}
        for name in graded:
            if exercises and name not in exercises:
                continue
            exercise = catalog.exercise(name)
            documents = list(_submissions(results, exercise, parse, found))
            documents += _own(catalog, exercise, shipped, parse)
            stub = parse(exercise.stub_path.read_bytes())
            ignored = set(stub.marks) if stub else set()
            found.pairs += _pairs(name, documents, ignored, at_least)
    found.pairs.sort(key=lambda pair: (-pair.share, -pair.lines, pair.exercise, pair.first.label))
    found.groups = _groups(found.pairs)
    found.left_out = max(0, len(found.pairs) - MAX_PAIRS)
    del found.pairs[MAX_PAIRS:]
    return found


def _groups(pairs: list[Pair]) -> list[Group]:
    """The connected pairs. The course's own code connects nobody: many students have read the same page."""
    head: dict[tuple[str, str], tuple[str, str]] = {}  # each student leads to another one, up to the group's

    def group_of(student: tuple[str, str]) -> tuple[str, str]:
        while head.setdefault(student, student) != student:
            head[student] = student = head[head[student]]
        return student

    linked = [pair for pair in pairs if not (pair.first.own or pair.second.own)]
    for pair in linked:
        head[group_of((pair.exercise, pair.first.label))] = group_of((pair.exercise, pair.second.label))
    together: dict[tuple[str, str], list[Pair]] = {}
    for pair in linked:
        together.setdefault(group_of((pair.exercise, pair.first.label)), []).append(pair)
    found = []
    for one in together.values():
        members = {document.label for pair in one for document in (pair.first, pair.second)}
        if len(members) > 2:
            found.append(Group(one[0].exercise, tuple(sorted(members)), min(pair.share for pair in one)))
    return sorted(found, key=lambda group: (-len(group.members), group.exercise, group.members))


def _submissions(results: Results, exercise: Exercise, parse: Parser, found: Similar) -> Iterator[Document]:
    for effective in results.all(exercise=exercise.id):
        files = results.book.submission(effective.result.key.submission_sha256) or {}
        source = files.get(exercise.module)
        if source is None:
            continue
        prints = parse(source)
        if prints is None:
            found.unreadable.append(f"{effective.student} {exercise.id}")
            continue
        found.compared += 1
        yield Document(effective.student, source.decode("utf-8", "backslashreplace"), prints)


def _own(
    catalog: Catalog, exercise: Exercise, shipped: dict[Path, Document], parse: Parser
) -> Iterator[Document]:
    """The model solution, and the modules every student has: all of the course's but the stub."""
    solutions = catalog.content.solutions
    if solutions is not None:
        yield from _read(solutions / exercise.id / exercise.module, "the model solution", parse)
    for path, document in shipped.items():
        if path.parent == Path(exercise.folder):
            if path != exercise.stub_path:
                yield replace(document, label=f"the exercise's {path.name}")
        else:
            yield document


def _shipped(catalog: Catalog, parse: Parser) -> dict[Path, Document]:
    """Every module that a student has."""
    package, content = Path(__file__).resolve().parents[2], catalog.content
    folders = (content.exercises, content.lessons, package / "physics", package / "simulations")
    found: dict[Path, Document] = {}
    for path in sorted(path for folder in folders for path in folder.rglob("*.py")):
        label = path.as_posix()
        if path.is_relative_to(package):
            label = ".".join(("course", *path.relative_to(package).with_suffix("").parts))
        elif path.is_relative_to(content.root):
            label = path.relative_to(content.root).as_posix()
        if path.name != "__init__.py":
            found.update((path, document) for document in _read(path, label, parse))
    return found


def _read(path: Path, label: str, parse: Parser) -> Iterator[Document]:
    if path.is_file():
        source = path.read_bytes()
        prints = parse(source)
        if prints is not None:
            yield Document(label, source.decode("utf-8"), prints, own=True)


def _pairs(exercise: str, documents: list[Document], ignored: set[int], at_least: float) -> Iterator[Pair]:
    having: dict[int, list[int]] = {}
    for number, document in enumerate(documents):
        for mark in document.prints.marks:
            if mark not in ignored:
                having.setdefault(mark, []).append(number)
    total = sum(not document.own for document in documents)
    weights = {mark: math.log1p(total / len(owners)) for mark, owners in having.items()}
    size = [sum(weights.get(mark, 0.0) for mark in document.prints.marks) for document in documents]
    for one, other in sorted(_candidates(documents, having)):
        first, second = documents[one], documents[other]
        if first.own and second.own:
            continue
        shared = [mark for mark in first.prints.marks if mark in second.prints.marks and mark in weights]
        # A textbook chapter is large: the share that counts is that of the student's code.
        smaller = size[one] if second.own else size[other] if first.own else min(size[one], size[other])
        share = sum(weights[mark] for mark in shared) / smaller if smaller else 0.0
        copy = first.prints.whole == second.prints.whole
        if share >= at_least and (copy or len(shared) >= _FEWEST):
            yield _pair(exercise, first, second, min(share, 1.0), shared)


def _candidates(documents: list[Document], having: dict[int, list[int]]) -> set[tuple[int, int]]:
    """Pairs worth comparing: those with enough rare fingerprints in common, and copies of one another.

    Of many copies each is paired only with the first, or with the course's own if there is one, and only the
    first with everything else: a thousand copies would make half a million pairs, and crowd out all others.
    """
    firsts: dict[str, int] = {}
    for number, document in sorted(enumerate(documents), key=lambda item: not item[1].own):
        firsts.setdefault(document.prints.whole, number)
    first = [firsts[document.prints.whole] for document in documents]
    common: Counter[tuple[int, int]] = Counter()
    for owners in having.values():
        if len(owners) <= _COMMON:
            alone = [number for number in owners if first[number] == number]
            common.update((one, other) for at, one in enumerate(alone) for other in alone[at + 1 :])
    found = {pair for pair, count in common.items() if count >= _FEWEST}
    copies = ((number, other) for number, other in enumerate(first) if number != other)
    return found | {(min(pair), max(pair)) for pair in copies}


def _pair(exercise: str, first: Document, second: Document, share: float, shared: list[int]) -> Pair:
    passages = sorted((first.prints.marks[mark][0], second.prints.marks[mark][0]) for mark in shared)
    lines = {line for (start, end), _ in passages for line in range(start, end + 1)}
    return Pair(exercise, first, second, share, tuple(passages), len(lines))
