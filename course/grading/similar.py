"""Which submissions are alike, compared on this machine with each other and with the course's own code.

The fewer submissions have a fingerprint, the more it weighs; those of the stub weigh nothing. A pair's share
is how much of the smaller submission is also in the other. So code that all students write hardly counts, and
a copy with changed names counts in full. Similarity is a reason to talk, not a finding: a short exercise has
few right solutions.
"""

import ast
import contextlib
import hashlib
import math
import os
import sys
from collections import Counter, deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import msgspec

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.errors import NotFoundError
from course.grading.intake.archives import readable
from course.grading.pipes import Servant, limit_cpu, limit_memory, read_frame, write_frame
from course.grading.quiz import EXERCISE_ID as QUIZ
from course.grading.results.effective import Results

Passage = tuple[int, int]


# ---
# Fingerprints of Python code that do not depend on names, comments or layout.
#
# The syntax tree is flattened, in order, into a sequence of kinds of nodes; every run of a few of them is
# hashed, and in each window the smallest hash is kept (winnowing: Schleimer, Wilkerson, Aiken, "Winnowing:
# local algorithms for document fingerprinting", SIGMOD 2003, section 3). Any passage of at least ``RUN +
# WINDOW - 1`` nodes that two sources share leaves a fingerprint that they share.
#
# Parsing a stranger's source can exhaust the parser, so this module runs as a process of its own:
# ``python -m course.grading.similar`` reads sources as frames and answers with fingerprints. It
# never runs them.


#: Nodes in a hashed run: about two statements. Shorter ones are common to all Python.
RUN = 20
#: A function of fewer nodes than this is too short to show who wrote it.
_SHORTEST = 12
#: Hashes in a window; passages shorter than RUN + WINDOW - 1 nodes may go unnoticed.
WINDOW = 8
#: For one source. The largest takes under 2 s of CPU; a busy machine six times as long by the wall clock.
_CPU_S, _WALL_S = 10, 60.0
#: Bytes of a source that is compared. The longest file of this course has 27,000; a megabyte that is
#: legal Python becomes 700 MB of syntax tree, and a page of two hundred pairs shows it two hundred times.
LONGEST = 200_000
_MEMORY = 1 << 30

#: Reading or writing a name, or the name of an import, does not make another program.
_SKIPPED = (ast.expr_context, ast.alias)
_DOCUMENTED = (ast.Module, ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)


class Prints(msgspec.Struct, frozen=True):
    """Fingerprints of one source.

    Attributes:
        marks: hash -> the lines it was seen on, as (first, last) pairs, 1 first.
        whole: digest of the whole sequence of nodes; equal for sources that differ in names and layout only.
    """

    marks: dict[int, tuple[tuple[int, int], ...]]
    whole: str
    nodes: int


def fingerprints(source: bytes) -> Prints | None:
    """The fingerprints of a source; None if nothing in it is Python."""
    tree = readable(source)
    if tree is None:
        return None
    marks: dict[int, set[tuple[int, int]]] = {}
    whole = hashlib.sha256()
    nodes = 0
    for part in _parts(tree):
        walked = list(_walk(part))
        kinds = [kind for kind, _ in walked]
        whole.update("\0".join(kinds).encode() + b"\n")
        nodes += len(kinds)
        run = min(RUN, len(kinds))
        if run < _SHORTEST:
            continue
        runs = ("\0".join(kinds[i : i + run]).encode() for i in range(len(kinds) - run + 1))
        # A hash that is the same in every process.
        hashes = [int.from_bytes(hashlib.blake2b(one, digest_size=6).digest(), "little") for one in runs]
        for number, start in _winnowed(hashes):
            lines = [line for _, line in walked[start : start + run]]
            marks.setdefault(number, set()).add((min(lines), max(lines)))
    found = {number: tuple(sorted(places)) for number, places in marks.items()}
    return Prints(found, whole.hexdigest(), nodes)


def _parts(tree: ast.Module) -> Iterator[ast.AST]:
    """Functions and classes of a module, each by itself: their order means nothing. The rest comes last."""
    rest = ast.Module([], [])
    for statement in tree.body:
        if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield statement
        else:
            rest.body.append(statement)
    yield rest


def _walk(tree: ast.AST) -> Iterator[tuple[str, int]]:
    """Kinds of nodes in the order of the source, with their lines; no recursion, as trees may be deep."""
    waiting: deque[tuple[ast.AST, int]] = deque([(tree, 1)])
    while waiting:
        node, line = waiting.pop()
        if isinstance(node, _SKIPPED):
            continue
        line = getattr(node, "lineno", line)
        if not isinstance(node, ast.Module):
            yield _kind(node), line
        children = list(ast.iter_child_nodes(node))
        if isinstance(node, _DOCUMENTED) and ast.get_docstring(node, clean=False) is not None:
            children.remove(node.body[0])
        waiting.extend((child, line) for child in reversed(children))


def _kind(node: ast.AST) -> str:
    """A node's kind, without names and values: a copier changes these first."""
    if isinstance(node, ast.Constant):
        return f"Constant {type(node.value).__name__}"
    if isinstance(node, ast.Attribute):
        return f"Attribute {node.attr}"  # mostly a library's name, which says what is done
    return type(node).__name__


def _winnowed(hashes: list[int]) -> Iterator[tuple[int, int]]:
    """The smallest hash of every window, of equal ones the rightmost; each once."""
    last = -1
    for start in range(max(1, len(hashes) - WINDOW + 1) if hashes else 0):
        window = hashes[start : start + WINDOW]
        smallest = min(window)
        at = start + max(i for i, number in enumerate(window) if number == smallest)
        if at != last:
            last = at
            yield smallest, at


class Parser(Servant):
    """A process that fingerprints sources; started again if one of them kills it."""

    def __init__(self) -> None:
        super().__init__("course.grading.similar", wall_s=_WALL_S)

    def __call__(self, source: bytes) -> Prints | None:
        """The fingerprints of a source; None if it is not Python, takes too long or is too long."""
        if len(source) > LONGEST:
            return None
        frame = self.ask(source)
        return msgspec.msgpack.decode(frame, type=Prints | None) if frame is not None else None


def main() -> None:
    """Serve until standard input ends."""
    limit_memory(_MEMORY)
    source, sink = sys.stdin.buffer, sys.stdout.buffer
    write_frame(sink, None)
    while (frame := read_frame(source)) is not None:
        limit_cpu(_CPU_S)
        try:
            found = fingerprints(msgspec.msgpack.decode(frame, type=bytes))
        except MemoryError:
            os._exit(1)  # the parent process reports the source by name
        write_frame(sink, found)


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
    known = set(catalog.exercise_ids()) - {QUIZ}
    graded = [item.id for item in results.exercises() if item.id in known]
    unknown = [name for name in exercises if name not in graded]
    if unknown:
        message = f"The gradebook has no code for the exercise {unknown[0]!r}."
        raise NotFoundError(message, help=f"It has {', '.join(graded) or 'none'}.", code="exercise_not_found")
    with contextlib.closing(Parser()) as parse:
        shipped = _shipped(catalog, parse) if graded else {}
        for name in (name for name in graded if not exercises or name in exercises):
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
    package, content = Path(__file__).resolve().parents[1], catalog.content
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
            passages = sorted((first.prints.marks[mark][0], second.prints.marks[mark][0]) for mark in shared)
            lines = {line for (start, end), _ in passages for line in range(start, end + 1)}
            yield Pair(exercise, first, second, min(share, 1.0), tuple(passages), len(lines))


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


# ---
# The page of ``course grade similar``: one file, no script, nothing from elsewhere.


#: Blank lines that style guides put between two functions.
_BLANK = 2


def page(found: Similar) -> str:
    from course.grading.exports.html_report.pages import render

    style = Path(__file__).with_name("similar.css").read_text("utf-8")
    return render("similar", scripted=False, more_style=style, found=found, sides=_sides)


def _sides(pair: Pair) -> Iterator[tuple[Document, list[tuple[int, str, bool, list[int]]]]]:
    """Both sources by line: number, text, whether the other has it too, the passages that begin there."""
    blocks = _blocks(pair.passages)
    for side, document in enumerate((pair.first, pair.second)):
        own = [passage[side] for passage in pair.passages]
        marked = {line for first, last in own for line in range(first, last + 1)}
        begins: dict[int, list[int]] = {}
        for at, block in enumerate(blocks, 1):
            begins.setdefault(block[side][0], []).append(at)
        rows = []
        for number, line in enumerate(document.source.splitlines(), 1):
            theirs = number in marked and bool(line.strip())
            rows.append((number, line.expandtabs(4), theirs, begins.get(number, [])))
        yield document, rows


#: So many passages may be open at one place; a file with all of it on one line has thousands there.
_NEAR = 100


def _blocks(passages: Iterable[tuple[Passage, Passage]]) -> list[tuple[Passage, Passage]]:
    """Passages that follow each other on both sides, joined into one, as a reader sees them."""
    found: list[tuple[Passage, Passage]] = []
    near: list[int] = []  # of ``found``, those that a passage further down can continue
    for first, second in sorted(passages):
        near = [at for at in near if first[0] <= found[at][0][1] + _BLANK + 1][-_NEAR:]
        for at in near:
            one, other = found[at]
            if _continues(one, first) and _continues(other, second):
                found[at] = (one[0], max(one[1], first[1])), (other[0], max(other[1], second[1]))
                break
        else:
            near.append(len(found))
            found.append((first, second))
    return found


def _continues(before: Passage, after: Passage) -> bool:
    """Whether one begins within the other, or with no more than blank lines between."""
    return before[0] <= after[0] <= before[1] + _BLANK + 1


if __name__ == "__main__":
    main()
