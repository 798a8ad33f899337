"""Every attack of the corpus fails: no score, no secret, no trace, no delay, no effect on the next one."""

from __future__ import annotations

import contextlib
import functools
import itertools
import os
import platform
import re
import resource
import select
import signal
import socket
import tomllib
import uuid
from dataclasses import dataclass, field
from pathlib import Path
from time import process_time

import msgspec
import numpy as np
import pytest

from course.catalog.load import Catalog
from course.catalog.locate import Content
from course.isolation import launch
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission, Terms
from course.scoring.verdict import for_student
from tests.benchmarks.protection import descendants_cpu
from tests.contracts.boundary.levels import require_level
from tests.contracts.boundary.users import ROOT, marked

CORPUS = ROOT / "tests" / "attacks"
EXERCISES = Catalog().exercise_ids()
ARENA = CORPUS / "arena"
TIMEOUT_S = 1.0
ENDLESS_S = 0.5  # for all of a submission that is endless, and half of it for a check
GRACE_S = 3.0  # starting workers, and what the grader itself does; what no deadline holds goes on for ever
FILE_CANARY = "FILE-CANARY-7f3a"  # in files that a submission must not read
INPUT_CANARY = "INPUT-CANARY-52a9"  # in the input of a hidden check
LEFTOVER = "FOUND-LEFTOVER"
MARKER = "COURSE_ATTACK_RUN"


class Attack(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """One entry of attacks.toml; the file says what each field means."""

    category: str
    ends: list[str]
    state: str | list[str] = "graded"
    error: str | list[str] = ""
    only: str = ""
    status: str | list[str] = ""
    slow: bool = False
    endless: bool = False
    l1: bool = False
    twice: bool = False
    never: list[str] = []
    machine: str = ""
    exercise: str = "arena"
    padded: bool = False


def _read_corpus():
    document = tomllib.loads((CORPUS / "attacks.toml").read_text("utf-8"))
    assert document.pop("format_version") == 1
    return {name: msgspec.convert(entry, Attack) for name, entry in document.items()}


ATTACKS = _read_corpus()


@dataclass
class Arena:
    """One grading session under observation, and what an attacker might reach from it."""

    session: GradingSession
    wrong: str
    model: bytes
    wrong_score: float
    marker: str
    listener: Listener
    secret: Path
    signals: list[int] = field(default_factory=list)

    @property
    def module(self):
        return self.session.exercise.module

    def grade(self, source, only=""):
        raw = source if isinstance(source, bytes) else source.encode()
        return self.session.grade(Submission({self.module: raw}), only=[only] if only else ())


class Listener:
    """Sockets of each kind on this machine that must stay silent."""

    def __init__(self):
        tcp = socket.create_server(("127.0.0.1", 0))
        self.port = tcp.getsockname()[1]
        udp = socket.socket(type=socket.SOCK_DGRAM)
        udp.bind(("127.0.0.1", self.port))
        unix = socket.socket(socket.AF_UNIX)
        unix.bind(f"\0course_attack_{self.port}")
        unix.listen()
        self._receive = {tcp: tcp.accept, udp: lambda: udp.recv(9), unix: unix.accept}

    def heard(self):
        """Those that something came to; it is taken, so that no other attack is blamed for it."""
        ready, _, _ = select.select(self._receive, [], [], 0)
        for one in ready:
            self._receive[one]()
        return ready

    def close(self):
        for one in self._receive:
            one.close()


def _catalog(exercise):
    if exercise != "arena":
        return Catalog()
    folders = {name: ARENA / name for name in ("exercises", "lessons", "quiz", "solutions", "graders")}
    return Catalog(Content(root=ARENA, **folders))


@contextlib.contextmanager
def _arena(level, exercise, folder, patch):
    require_level(level)
    marker = uuid.uuid4().hex
    inherited = launch.environment
    patch.setattr(launch, "environment", lambda: {**inherited(), MARKER: marker})
    secret = folder / "secret"
    secret.write_text(f"{FILE_CANARY}\n", "utf-8")
    for path in (secret, *secret.parents[:2]):
        path.chmod(0o755)
    catalog = _catalog(exercise)
    wrong = (CORPUS / f"wrong_{exercise}.py").read_text("utf-8")
    solution = catalog.content.solutions / exercise / f"{exercise}.py"
    listener, signals = Listener(), []
    handlers = {number: signal.signal(number, lambda got, _: signals.append(got)) for number in (10, 29)}
    try:
        terms = Terms(level=level, timeout=TIMEOUT_S, seed=5)
        with GradingSession(catalog.exercise(exercise), catalog, scope="full", terms=terms) as session:
            arena = Arena(session, wrong, solution.read_bytes(), 0.0, marker, listener, secret, signals)
            arena.wrong_score = arena.grade(wrong).score
            yield arena
        assert not marked(marker), "the session left processes"
    finally:
        listener.close()
        for number, handler in handlers.items():
            signal.signal(number, handler)


@pytest.fixture(scope="module")
def arenas(tmp_path_factory):
    """Opens each session on first use and keeps it, as a grading run does."""
    with contextlib.ExitStack() as stack, pytest.MonkeyPatch.context() as patch:

        @functools.cache
        def arena(level, exercise):
            return stack.enter_context(_arena(level, exercise, tmp_path_factory.mktemp("grader"), patch))

        yield arena


def cases():
    """Each attack at each level; in an ordinary run at one level, each level in turn."""
    turns = itertools.count()
    for name, attack in ATTACKS.items():
        levels = ("L3", "L2", "L1") if attack.l1 else ("L3", "L2")
        turn = levels[next(turns) % len(levels)]
        for level in levels:
            marks = () if level == turn else pytest.mark.soak
            yield pytest.param(name, level, id=f"{level}-{name}", marks=marks)


#: By level, so that a level's session is opened once.
CASES = sorted(cases(), key=lambda case: str(case.values[1]), reverse=True)


@pytest.mark.parametrize(("name", "level"), CASES)
def test_an_attack_gains_nothing_and_leaves_nothing(name, level, arenas):
    attack = ATTACKS[name]
    if attack.machine and attack.machine != platform.machine():
        pytest.skip(f"written for {attack.machine}")
    arena = arenas(level, attack.exercise)
    source = _source(name, attack, arena)
    before = marked(arena.marker)
    one = attack.slow or level == "L1"  # a new process for each check would take a third of a second
    verdicts = []
    for _ in range(2 if attack.twice else 1):
        used = _cpu_s()
        with pytest.MonkeyPatch.context() as patch:
            if attack.endless:
                patch.setattr("course.scoring.remote.BUDGET_S", ENDLESS_S)
            verdicts.append(arena.grade(source, attack.only or ("scale_small" if one else "")))
        used = _cpu_s() - used
    verdict = verdicts[-1]

    _expect_outcome(attack, verdict)
    assert verdict.score <= arena.wrong_score, "the attack scored"
    # By the CPU time of all that was started. That the wall ends a check too shows in that it ends.
    limit = ENDLESS_S if attack.endless else TIMEOUT_S
    assert used <= (len(verdict.checks) + 1) * limit + GRACE_S, "it used more than its checks may"
    _expect_silence(verdict, [FILE_CANARY, INPUT_CANARY, LEFTOVER, *attack.never])
    assert not arena.listener.heard(), "it reached a socket"
    assert not arena.signals, "it signalled the grader"
    assert arena.secret.read_text("utf-8") == f"{FILE_CANARY}\n", "it changed a file of the grader's"
    if level != "L1":
        assert marked(arena.marker) <= before, "a process of it is left"
        assert not _files_left(arena), "a file of it is left"
    _expect_model_unharmed(arena)


def _expect_model_unharmed(arena):
    following = arena.grade(arena.model)
    problems = [
        (check.id, check.status, check.message) for check in following.checks if check.status != "pass"
    ]
    assert following.state == "graded", following.error
    assert not problems, "the next submission was harmed"


def _source(name, attack, arena):
    known = {
        "PORT": arena.listener.port,
        "SECRET": arena.secret,
        "PID": os.getpid(),
        "ROOT": ROOT,
        "SOLUTION": ARENA / "solutions" / "arena",
        "SITE": Path(np.__file__).parents[1],
        "RETURNS": "return 1\n    if values: 0\n    " * 1500,
    }
    text = (CORPUS / f"{name}.py").read_text("utf-8")
    text = text.replace("from frames import *\n", (ARENA / "frames.py").read_text("utf-8"))
    text = re.sub(r"@([A-Z]+)@", lambda match: str(known[match[1]]), text)
    padding = ("#" * 99 + "\n") * 5000 if attack.padded else ""
    return f"{arena.wrong}\n\n{text}\n{padding}"


def _expect_outcome(attack, verdict):
    assert verdict.state in _listed(attack.state), (verdict.error, [c.message for c in verdict.checks])
    if verdict.error is not None and attack.error:
        assert verdict.error.code in _listed(attack.error)
    statuses = {check.id: check.status.value for check in verdict.checks}
    assert "grader_error" not in statuses.values()
    if verdict.state == "graded" and attack.ends and "scale_small" in statuses:
        assert statuses["scale_small"] in attack.ends
    if attack.status:
        assert statuses[attack.only] in _listed(attack.status)


def _listed(value):
    return [value] if isinstance(value, str) else value


def _cpu_s():
    """CPU seconds of this process, the grader, and of those below it so far, those that ended included."""
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    return process_time() + ended.ru_utime + ended.ru_stime + descendants_cpu(os.getpid())


def _expect_silence(verdict, never):
    """Nothing a student sees, nor anything a report shows of public checks, holds any of these."""
    seen = msgspec.structs.replace(verdict, checks=tuple(map(for_student, verdict.checks)))
    plain = _texts(msgspec.to_builtins(seen))
    found = [word for word in never if any(word in text for text in plain)]
    assert not found, "it told what it must not"
    everything = _texts(msgspec.to_builtins(verdict))
    assert not any(FILE_CANARY in text for text in everything), "it read what it must not"


def _texts(value):
    """Every text and number in a report, as text."""
    if isinstance(value, dict):
        return [text for key, item in value.items() for text in (*_texts(key), *_texts(item))]
    if isinstance(value, list | tuple):
        return [text for item in value for text in _texts(item)]
    return [str(value)]


def _files_left(arena):
    """What an attack wrote anywhere but in its own folder; all of them use one prefix. Removed, if any."""
    own = [
        Path(os.__file__).parent,
        Path(np.__file__).parent,
        Path(np.__file__).parents[1],
        arena.secret.parent,
    ]
    own += [folder / "__pycache__" for folder in own[:2]]
    shared = [Path(name) for name in ("/tmp", "/var/tmp", "/dev/shm", "/run", "/", "/usr/lib")]
    folders = {*own, *shared, ROOT, ROOT / "tests", Path.home(), Path.cwd()}
    found = [path for folder in folders for path in folder.glob("course_attack*")]
    for path in found:
        path.unlink(missing_ok=True)
    return [str(path) for path in found]


def test_every_attack_has_an_entry_and_says_what_it_tries():
    others = ("wrong_", "every_value")
    files = {path.stem: path for path in CORPUS.glob("*.py") if not path.stem.startswith(others)}
    assert files.keys() == ATTACKS.keys()
    for path in files.values():
        assert re.match(r'"""[A-Z].{10,110}\.', path.read_text("utf-8")), path


def test_the_model_earns_full_marks_and_the_wrong_code_almost_none(arenas):
    arena = arenas("L1", "arena")
    model = arena.grade(arena.model)
    assert model.all_pass
    assert model.score == model.max_score
    assert 0 < arena.wrong_score < 0.2 * model.score


@pytest.mark.parametrize("every", [False, pytest.param(True, marks=pytest.mark.soak)], ids=["some", "all"])
@pytest.mark.parametrize("exercise", EXERCISES)
def test_no_plain_value_makes_a_check_itself_fail(exercise, every):
    """What a student returns is never our error, so it can never put a verdict off.

    In an ordinary run an exercise gets every second answer, by turns again and again or followed by others,
    and the next exercise those between.
    """
    catalog, turn = Catalog(), EXERCISES.index(exercise)
    found = catalog.exercise(exercise)
    template = (CORPUS / "every_value.py").read_text("utf-8")
    template += "".join(f"{task.id} = _answer\n" for task in found.task)
    broken = {}
    with GradingSession(found, catalog, scope="full", terms=Terms(timeout=5.0)) as session:
        for number, start in enumerate(range(0, 52, 4)):
            for stride in (0, 1):
                if not every and ((number - turn) % 2 or (number // 2 + turn // 2) % 2 != stride):
                    continue
                source = template.replace("START", str(start)).replace("STRIDE", str(stride))
                verdict = session.grade(Submission({found.module: source.encode()}))
                broken |= {c.id: c.message for c in verdict.checks if c.status.value == "grader_error"}
                assert verdict.state == "graded", (start, stride, verdict.error, broken)
    assert not broken
