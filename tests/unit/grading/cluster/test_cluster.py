"""The cluster's parts without a cluster: who gets what, what crosses the wire, what a worker makes of it."""

import importlib.util
import os
import pickle
import pickletools
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any
from unittest.mock import Mock

import msgspec
import pytest

from course.catalog.load import Catalog
from course.catalog.locate import content
from course.cli.frame.app import run as course
from course.errors import CourseError, MissingCapabilityError, UsageError
from course.grading.cluster import connect, coordinator, worker
from course.grading.cluster.coordinator import LostBatch, Outcome, grade_on
from course.grading.cluster.worker import FORMAT, Answers, Batch, decode, encode
from course.grading.intake.students import Entry
from course.grading.running.batch import MAX_TRIES
from course.grading.running.grader import Answer, Config, Job
from course.grading.running.snapshot import Snapshot, in_use
from course.scoring.graders import grader_version
from course.scoring.judging.submission import Submission, Terms
from course.scoring.verdict import Problem
from tests.unit.grading.made import RIGHT

POISON = b"poison"


def perfect(job):
    return Answer(RIGHT, number=job.number, sha256=Submission(job.files).sha256, version=job.version)


@dataclass
class FakeWorkers:
    """Workers in a thread, all in step: a round is everything that was sent before it began.

    Attributes:
        most: how many batches they take at once.
        deadly: whether a batch takes its worker with it.
        together: whether all batches of a round are then lost, as if one process graded them all.
        each_s: wall seconds they say a submission takes them.
        lacking: how many of their processes have no snapshot yet.
    """

    most: int = 2
    answer: Callable[[Job], Answer] = perfect
    deadly: Callable[[Batch], bool] = lambda _: False
    together: bool = False
    deaths: int = 1
    each_s: float = 0.0
    lacking: int = 0
    rounds: list[list[Batch]] = field(default_factory=list)
    _sent: list[tuple[Batch, Callable[[Outcome], None]]] = field(default_factory=list)
    _lock: Any = field(default_factory=threading.Lock)
    _timer: threading.Timer | None = None

    def places(self):
        return self.most

    def send(self, payload, done):
        batch = decode(payload, Batch)
        with self._lock:
            self._sent.append((batch, done))
            if self._timer is None:
                self._timer = threading.Timer(0.01, self._round)
                self._timer.start()

    def _round(self):
        with self._lock:
            now, self._sent, self._timer = self._sent, [], None
        self.rounds.append([batch for batch, _ in now])
        dead = [self.deadly(batch) for batch, _ in now]
        for (batch, done), mine in zip(now, dead, strict=True):
            if mine or (self.together and any(dead)):
                done(LostBatch(self.deaths))
            elif self.lacking and not batch.graders:
                done(encode(Answers(FORMAT, "there", (), 0.0, wanting=True)))
            else:
                self.lacking = max(0, self.lacking - bool(batch.graders))
                answers = tuple(map(self.answer, batch.jobs))
                done(encode(Answers(FORMAT, "there", answers, self.each_s * len(answers))))


def entries_of(exercise, count, special=None):
    special = special or {}
    return [
        Entry(f"s{number:03}", exercise, Submission({"doubling.py": special.get(number, b"# %d" % number)}))
        for number in range(count)
    ]


def grade(workers, entries, **more):
    return list(grade_on(workers, iter(entries), Terms(seed=5), lambda _: "v1", **more))


def is_poison(batch):
    return any(POISON in content for job in batch.jobs for content in job.files.values())


def test_everyone_is_graded_once_in_batches_that_shrink_towards_the_end(doubling):
    entries = entries_of(doubling, 100)
    entries[3] = Entry("s003", doubling, problem=Problem("no_file", "There is none."))
    entries[4] = Entry("s004", doubling)  # not handed in
    workers = FakeWorkers(3)
    found = grade(workers, entries)
    assert sorted(item.entry.student for item in found) == [
        entry.student for entry in entries if entry.student != "s004"
    ]
    states = {item.entry.student: item.verdict.state for item in found}
    assert states.pop("s003") == "ungradable"
    assert set(states.values()) == {"graded"}
    sizes = [[len(batch.jobs) for batch in batches] for batches in workers.rounds]
    assert max(map(len, sizes)) <= 2 * 3, "one in hand and one waiting for each"
    assert sizes[0][0] == 8
    assert sizes[-1][-1] == 1
    assert {
        (batch.terms.seed, job.version) for row in workers.rounds for batch in row for job in batch.jobs
    } == {(5, "v1")}


@pytest.mark.parametrize(("each_s", "largest"), [(0.02, 50), (0.001, 64), (0.3, 8), (2.0, 8)])
def test_a_batch_is_about_a_second_of_work(doubling, each_s, largest):
    """The first ones, sent before anything is known, have eight submissions."""
    workers, count = FakeWorkers(1, each_s=each_s), 600 if each_s < 0.1 else 60
    assert len(grade(workers, entries_of(doubling, count))) == count
    sizes = [len(batch.jobs) for row in workers.rounds for batch in row]
    assert max(sizes) == largest
    assert sizes[5] == max(1, min(int(1 / each_s), 64))
    large = FakeWorkers(1, each_s=each_s)
    grade(large, entries_of(doubling, 20, dict.fromkeys(range(20), b"#" * 400_000)))
    assert max(len(batch.jobs) for row in large.rounds for batch in row) == min(2, largest)


@pytest.mark.parametrize(("deaths", "lives"), [(1, MAX_TRIES), (4, 2)])
def test_a_submission_that_ends_every_worker_is_recorded_and_nobody_else(doubling, deaths, lives):
    """``deaths``: how many workers a scheduler tries by itself before it says that a batch is lost."""
    workers = FakeWorkers(2, deadly=is_poison, deaths=deaths)
    found = {
        item.entry.student: item.verdict for item in grade(workers, entries_of(doubling, 40, {7: POISON}))
    }
    assert len(found) == 40
    poisoned = found.pop("s007")
    assert (poisoned.state, poisoned.error.code) == ("grader_error", "worker_died")
    assert {verdict.state for verdict in found.values()} == {"graded"}
    alone = [row for row in workers.rounds if is_poison(row[0]) and len(row[0].jobs) == 1]
    given = [batch for row in workers.rounds for batch in row if is_poison(batch) and len(batch.jobs) == 1]
    assert len(given) == lives
    assert len(alone[-1]) == 1, "before it is blamed, it is graded while nothing else is"


def test_who_is_graded_beside_a_deadly_submission_is_not_blamed(doubling):
    """One process with four threads: each death takes three others with it."""
    workers = FakeWorkers(4, deadly=is_poison, together=True)
    entries = entries_of(doubling, 60, {7: POISON, 8: POISON + b"2"})
    found = {item.entry.student: item.verdict.state for item in grade(workers, entries)}
    assert {student for student, state in found.items() if state == "grader_error"} == {"s007", "s008"}
    assert len(found) == 60


def test_what_a_batch_had_before_a_worker_refused_is_not_lost(doubling):
    entries = entries_of(doubling, 4)

    def answer(job):
        if job.files["doubling.py"] == b"# 0":
            return perfect(job)
        error = MissingCapabilityError("Other graders.", help="Install them.", code="version_mismatch")
        return worker.refusal(error)

    grading = grade_on(FakeWorkers(1, answer=answer), iter(entries), Terms(at_least="L2"), lambda _: "v1")
    assert next(grading).entry.student == "s000"
    with pytest.raises(CourseError, match="Worker on there: Other graders") as raised:
        next(grading)
    assert (raised.value.code, raised.value.exit_code) == ("version_mismatch", 4)


@pytest.mark.parametrize(
    ("answer", "code"),
    [
        (lambda job: Answer(number=job.number, sha256=Submission(job.files).sha256), "grader_died"),
        (lambda job: msgspec.structs.replace(perfect(job), version="v2"), "worker_died"),
    ],
    ids=["no grader survived it", "by other graders"],
)
def test_what_is_no_verdict_of_the_runs_graders_is_our_fault(doubling, answer, code):
    (found,) = grade(FakeWorkers(1, answer=answer), entries_of(doubling, 1))
    assert (found.verdict.state, found.verdict.error.code) == ("grader_error", code)


def test_a_cluster_that_lost_all_its_workers_is_not_waited_for_forever(doubling, monkeypatch):
    monkeypatch.setattr(coordinator, "_TICK_S", 0.01)

    nobody = Mock(**{"places.return_value": 0})
    with pytest.raises(MissingCapabilityError, match="no workers left"):
        grade(nobody, entries_of(doubling, 2), patience_s=0.05)


def test_messages_of_another_format_are_refused_and_not_half_understood():
    batch = Batch(FORMAT, Terms(), ())
    assert decode(encode(batch), Batch) == batch
    newer = msgspec.structs.replace(batch, format=FORMAT + 1)
    for payload in (encode(newer), b"", b"\xc1", msgspec.msgpack.encode({"format": FORMAT})):
        assert decode(payload, Batch) is None
        assert decode(payload, Answers) is None
        reply = decode(worker.grade_batch(payload), Answers)
        (answer,) = reply.answers
        assert answer.error.code == "version_mismatch"


def test_nothing_is_pickled_but_the_name_of_a_function_and_bytes():
    client = Mock()
    connect.DaskWorkers(client).send(b"payload", lambda _: None)
    function, payload = client.submit.call_args.args
    assert type(payload) is bytes
    names = [op.name for op, _, _ in pickletools.genops(pickle.dumps((function, payload)))]
    assert names.count("STACK_GLOBAL") == 1
    assert not {"REDUCE", "BUILD", "NEWOBJ", "NEWOBJ_EX", "INST", "OBJ"} & set(names)
    assert pickle.loads(pickle.dumps(function)) is worker.grade_batch


def test_what_dask_says_of_a_future_becomes_what_the_coordinator_understands():
    pytest.importorskip("distributed", reason="needs the extra `cluster`")
    from distributed import KilledWorker

    def understood(status, error=None, *, scheduler="running"):
        seen, future, client = [], Mock(status=status), Mock(status=scheduler)
        future.exception.return_value, future.result.return_value = error, b"x"
        client.submit.return_value.add_done_callback = lambda call: call(future)
        connect.DaskWorkers(client).send(b"", seen.append)
        return seen[0]

    absent = RuntimeError("while reading the graph")
    absent.__cause__ = ModuleNotFoundError("No module named 'course'")
    assert understood("finished") == b"x"
    assert understood("error", KilledWorker("key", None, 3)) == LostBatch(4)
    assert understood("lost") == LostBatch(1)
    assert understood("cancelled").code == "no_scheduler"
    assert understood("error", absent).code == "version_mismatch"
    assert understood("error", ZeroDivisionError("1/0")).code == "internal"
    assert understood("lost", scheduler="connecting").code == "no_scheduler"


# -- a worker, with a real grader process -----------------------------------------------------------------


@pytest.fixture
def at_work():
    """Has this process do what a Dask worker does, on the miniature course."""

    def answers(jobs, level="L1"):
        snapshot = Snapshot.take(content())
        terms = Terms(level, "L1", 5.0, graders=snapshot.sha256)
        reply = decode(
            worker.grade_batch(encode(Batch(FORMAT, terms, tuple(jobs), snapshot.packed))), Answers
        )
        assert reply is not None
        return reply

    yield answers
    worker._forget()
    for grader in list(worker._idle):
        grader.stay()
        grader.close()
    worker._idle.clear()


def test_a_worker_scores_as_a_session_does_with_a_grader_that_stays_warm_is_replaced_and_ends_without_work(
    at_work, session, catalog, solution,
    monkeypatch
):  # fmt: skip
    version = grader_version(session.exercise, catalog)
    sources = [solution, solution + b"\ndef double(x):\n    return x\n", b"def ("]
    processes = []
    for source in [*sources, solution]:
        if len(processes) == len(sources):
            processes[-1].kill()
            processes[-1].wait()
            monkeypatch.setattr(worker, "IDLE_S", 0.05)
        (answer,) = at_work([Job("doubling", {"doubling.py": source}, version)]).answers
        due = session.grade(Submission({"doubling.py": source}))
        assert (answer.verdict.state, answer.verdict.score) == (due.state, due.score)
        processes += [grader._process for grader in worker._idle]
    assert [process is processes[0] for process in processes[:3]] == [True] * 3
    deadline = time.monotonic() + 20
    while worker._idle and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not worker._idle


def test_a_worker_that_lacks_the_graders_is_sent_them(catalog):
    workers = FakeWorkers(2, lacking=2)
    entries = entries_of(catalog.exercise("doubling"), 60)
    found = grade(workers, entries, graders=b"a snapshot")
    assert sorted(one.entry.student for one in found) == sorted(entry.student for entry in entries)
    assert {one.version for one in found} == {"v1"}
    batches = [batch for batches in workers.rounds for batch in batches]
    assert {batch.graders for batch in batches} == {b"", b"a snapshot"}
    assert sum(bool(batch.graders) for batch in batches) <= 4, "only to those that ask"


def test_a_worker_grades_by_the_snapshot_it_was_sent(at_work, catalog, solution, copied):
    edited = Catalog()
    snapshot = Snapshot.take(edited.content)
    version = grader_version(edited.exercise("doubling"), edited)
    checks = copied / "graders" / "doubling" / "checks.py"
    checks.write_text(checks.read_text().replace("-34.5,", "-35.5,"))
    assert grader_version(edited.exercise("doubling"), edited) != version
    terms = Terms("L1", "L1", 5.0, graders=snapshot.sha256)
    job = Job("doubling", {"doubling.py": solution}, version)
    for packed, wanting in ((b"", True), (snapshot.packed, False), (b"", False)):
        reply = decode(worker.grade_batch(encode(Batch(FORMAT, terms, (job,), packed))), Answers)
        assert reply.wanting is wanting
        for answer in reply.answers:
            assert (answer.verdict.score, answer.version) == (10.0, version)
    damaged = encode(Batch(FORMAT, msgspec.structs.replace(terms, graders="0" * 64), (job,), snapshot.packed))
    reply = decode(worker.grade_batch(damaged), Answers)
    assert reply.answers[0].error is not None
    worker._forget()
    assert in_use(snapshot.sha256) is None


def test_a_worker_with_other_graders_refuses_before_it_grades(at_work, solution):
    for exercise in ("doubling", "unheard-of"):
        jobs = [Job(exercise, {"doubling.py": solution}, "0123456789abcdef")] * 2
        (answer,) = at_work(jobs).answers
        assert answer.verdict is None
        assert (answer.error.code, answer.exit_code) == ("version_mismatch", 4)
        assert "0123456789abcdef" in answer.error.message


@pytest.mark.skipif(not hasattr(os, "sched_getaffinity"), reason="processes are not kept on processors here")
def test_graders_on_one_machine_take_different_processors(monkeypatch):
    started = []

    def start(config):
        started.append(config.processor)
        raise OSError

    monkeypatch.setattr(worker, "start_grader", start)
    graders = [worker._WarmGrader(Config(Terms(), 0)) for _ in range(2)]
    for grader in (*graders, graders[0]):
        grader.close()
        with pytest.raises(OSError):
            grader.answer(Job("doubling", {}))
    one, two, again = started
    assert one != two
    assert again == one
    for grader in graders:
        grader.close()


# -- the command --------------------------------------------------------------------------------------------


def test_without_dask_the_command_that_installs_it_is_said(catalog, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    missing = pytest.raises(MissingCapabilityError, match="distributed and cryptography")
    with missing as raised, connect.local_cluster(2):
        pass
    assert "pip install 'distributed>=" in raised.value.help


def test_a_cluster_of_others_does_not_run_unprotected_submissions(catalog, monkeypatch):
    monkeypatch.setattr(connect, "require", lambda part: None)
    with (
        connect.remote_cluster("tls://nowhere.invalid:1") as grade,
        pytest.raises(UsageError, match="whole cluster"),
    ):
        next(grade(iter(()), Terms(at_least="L1")))


def test_ways_of_grading_exclude_each_other(tmp_path, capsys):
    out, alone = tmp_path / "out", "-j is for a run without a cluster"
    for words, said in (
        ("--local-cluster 2 --scheduler tls://x:1", "two clusters"),
        ("--local-cluster 2 -j 2", alone),
        ("--scheduler tls://x:1 -j 2", alone),
    ):
        assert course(["grade", "run", str(tmp_path), "--out", str(out), *words.split()]) == 2
        assert said in capsys.readouterr().err
    assert not out.exists()
