"""A class on a Dask cluster: the scores of one machine, whatever happens to the workers."""

import contextlib
import os
import re
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from course.catalog.load import Catalog
from course.grading.cluster.coordinator import grade_on
from course.grading.cluster.worker import grade_batch
from course.grading.gradebook.book import Gradebook
from course.grading.running.run import RunOptions, grade_class
from course.grading.running.snapshot import Snapshot, frozen
from course.scoring.graders import grader_version
from course.scoring.judging.submission import Terms
from tests.journeys.processes import below, left_running
from tests.journeys.test_class_resume import MINI, ROOT, command, make_class
from tests.unit.grading.made import NEEDS_CLUSTER, read_class
from tests.unit.grading.running.test_run import scores
from tests.unit.grading.running.test_snapshot import judged_by_the_snapshot

POISON = b"# whoever grades this dies\n"

pytestmark = [
    pytest.mark.soak,
    NEEDS_CLUSTER,
    pytest.mark.skipif(sys.platform != "linux", reason="reads the process table of Linux"),
    # Dask closes some sockets and event loops of its own late.
    pytest.mark.filterwarnings("default::ResourceWarning"),
    pytest.mark.filterwarnings("default::pytest.PytestUnraisableExceptionWarning"),
]


def dask_workers(parent):
    return [pid for pid, (its, line) in below(parent).items() if its == parent and "spawn_main" in line]


@pytest.fixture
def catalog(monkeypatch):
    monkeypatch.setenv("COURSE_CONTENT", str(MINI))
    path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    monkeypatch.setenv("PYTHONPATH", path)
    return Catalog()


def test_a_submission_that_kills_dask_workers_takes_nobody_with_it(tmp_path, catalog):
    """A death that no grader process can keep from its worker: a machine that runs out of memory."""
    from course.grading.cluster.connect import DaskWorkers, start_cluster

    def deadly(payload):
        import os
        import signal

        if b"whoever grades this dies" in payload:
            os.kill(os.getpid(), signal.SIGKILL)
        return grade_batch(payload)

    make_class(tmp_path / "class", 12)
    with (tmp_path / "class" / "student-0004" / "doubling.py").open("ab") as file:
        file.write(POISON)
    doubling = catalog.exercise("doubling")
    entries = read_class(tmp_path / "class", [doubling], required=True)
    snapshot = Snapshot.take(catalog.content)
    terms = Terms(at_least="L1", graders=snapshot.sha256)
    with contextlib.ExitStack() as stack:
        graders = stack.enter_context(frozen(snapshot))
        workers = DaskWorkers(start_cluster(stack, 2), deadly)
        graded = grade_on(workers, entries, terms, graders.version, graders=snapshot.packed)
        found = {one.entry.student: one.verdict for one in graded}
    assert len(found) == 12
    poisoned = found.pop("student-0004")
    assert (poisoned.state, poisoned.error and poisoned.error.code) == ("grader_error", "worker_died")
    assert {verdict.state for verdict in found.values()} == {"graded"}


@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGKILL], ids=["ctrl-c", "kill -9"])
def test_an_interrupted_run_leaves_nothing_behind_and_is_resumed(tmp_path, catalog, sign):
    """Ctrl-C reaches every process of the terminal, the workers too; kill -9 the coordinator alone."""
    students = 120
    make_class(tmp_path / "class", students)
    environment = {**os.environ, "MARKER": str(tmp_path)}
    out = tmp_path / "out"
    how = ("--local-cluster", 2, "--seed", 9, "--plain", "--isolation", "process")
    run = command(tmp_path / "class", "--out", out, *how)
    with subprocess.Popen(
        run,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        first = process.stdout.readline()
        assert "student-" in first
        if sign is signal.SIGINT:
            os.killpg(process.pid, sign)
        else:
            process.kill()
        words = process.stderr.read()
        process.stdout.read()
    assert process.returncode == (130 if sign is signal.SIGINT else -sign)
    assert not left_running(tmp_path)
    done = len(scores(out))
    assert 0 < done < students
    if sign is signal.SIGINT:
        with Gradebook(out / "gradebook.sqlite") as book:  # one result may be kept, and not yet settled
            whole = students - len(book.waiting())
        assert done - 1 <= whole <= done
        said = f"Interrupted: all of the work of {whole} of {students} students is graded. What is graded is "
        said += "kept, and the rest is not graded yet. The same command with --resume goes on."
        assert words.split() == said.split()
    again = subprocess.run([*run, "--resume"], env=environment, capture_output=True, text=True, check=False)
    assert again.returncode == 0, again.stderr
    assert again.stdout.count(f"/{students} student") == students - done
    assert len(scores(out)) == students


@pytest.mark.parametrize("kill_at", [-1, 3], ids=["undisturbed", "a worker killed"])
def test_a_check_edited_during_a_run_on_a_cluster_changes_nothing(tmp_path, catalog, monkeypatch, kill_at):
    """Workers that start late, or again, judge by the snapshot too."""
    from course.grading.cluster.connect import local_cluster

    shutil.copytree(MINI, tmp_path / "content")
    monkeypatch.setenv("COURSE_CONTENT", str(tmp_path / "content"))
    course = Catalog()
    make_class(tmp_path / "class", 60)
    version = grader_version(course.exercise("doubling"), course)
    checks = tmp_path / "content" / "graders" / "doubling" / "checks.py"
    seen = []

    def report(item, *_):
        seen.append(item.student)
        if len(seen) == 1:
            checks.write_text(checks.read_text().replace("-34.5,", "-35.5,"))
        if len(seen) == kill_at:
            os.kill(dask_workers(os.getpid())[0], signal.SIGKILL)

    options = RunOptions(exercises=("doubling",), terms=Terms(), seed=3)
    out = tmp_path / "out"
    with local_cluster(2) as grade:
        summary = grade_class(tmp_path / "class", out, course, options, report, grade=grade)
    assert summary.states["graded"] == 60
    judged_by_the_snapshot(out, course, version, summary.graders)


@contextlib.contextmanager
def scheduler_and_worker(environment):
    """A Dask scheduler and one worker with a nanny, started as an instructor would start them."""
    started = []
    try:
        dask = [sys.executable, "-P", "-m", "distributed.cli.dask_scheduler"]
        plain = {"env": environment, "stderr": subprocess.PIPE, "text": True, "start_new_session": True}
        scheduler = subprocess.Popen([*dask, "--host", "127.0.0.1", "--port", "0", "--no-dashboard"], **plain)
        started.append(scheduler)
        line = next(line for line in scheduler.stderr if "Scheduler at:" in line)
        address = line.split()[-1]
        plain["stderr"] = subprocess.DEVNULL
        worker = [sys.executable, "-P", "-m", "distributed.cli.dask_worker", address]
        started.append(subprocess.Popen([*worker, "--nthreads", "2", "--no-dashboard"], **plain))
        yield address, started
    finally:
        stop(started)


def stop(started):
    for process in reversed(started):
        process.terminate()
    for process in started:
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        if process.stderr:
            process.stderr.close()


def test_a_cluster_somewhere_else_grades_and_its_end_is_said(tmp_path, catalog):
    make_class(tmp_path / "class", 300)
    environment = {**os.environ, "MARKER": str(tmp_path)}
    options = RunOptions(exercises=("doubling",), seed=3)
    from course.errors import MissingCapabilityError
    from course.grading.cluster.connect import remote_cluster

    with scheduler_and_worker(environment) as (address, (scheduler, _)):

        def report(*_):
            if scheduler.poll() is None:
                scheduler.kill()
                scheduler.wait()

        with (
            pytest.raises(MissingCapabilityError, match="scheduler is gone"),
            remote_cluster(address) as grade,
        ):
            grade_class(tmp_path / "class", tmp_path / "out", catalog, options, report, grade=grade)
    done = len(scores(tmp_path / "out"))
    assert 0 < done < 300
    with scheduler_and_worker(environment) as (address, _), remote_cluster(address) as grade:
        again = RunOptions(exercises=("doubling",), resume=True)
        summary = grade_class(
            tmp_path / "class", tmp_path / "out", catalog, again, lambda *_: None, grade=grade
        )
    assert (summary.already, summary.states["graded"]) == (done, 300)
    assert not left_running(tmp_path)


def commands_of_the_page(port):
    """The blocks of docs/cluster.md under "Two machines": certificates, scheduler, two of workers, the run.

    Both machines are this one, with one worker each, and the port is a free one; nothing else is changed.
    """
    page = (ROOT / "docs" / "cluster.md").read_text("utf-8")
    section = page.partition("## Two machines")[2].partition("\n## ")[0]
    for written, here in (
        ("tls://alpha:8786", f"tls://127.0.0.1:{port}"), ("--port 8786", f"--port {port}"),
        ("--nworkers 4", "--nworkers 1"), ("--nworkers 8", "--nworkers 1"),
    ):  # fmt: skip
        assert written in section
        section = section.replace(written, here)
    return re.findall(r"```\n(.*?)```", section, re.S)


@pytest.mark.skipif(shutil.which("openssl") is None, reason="openssl is not installed")
def test_the_page_for_two_machines_works_as_written(tmp_path):
    """A setting left out first: one sentence, no folder left behind; the corrected command is the same."""
    with socket.create_server(("127.0.0.1", 0)) as sock:
        port = sock.getsockname()[1]
    certificates, *daemons, grading = commands_of_the_page(port)
    alpha, beta = tmp_path / "alpha", tmp_path / "beta"
    make_class(alpha / "submissions", 12)
    environment = {
        **os.environ, "MARKER": str(tmp_path), "COURSE_CONTENT": str(MINI), "PYTHONPATH": str(ROOT),
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
    }  # fmt: skip

    def pasted(script):
        return subprocess.run(
            ["sh", "-c", script], check=False, cwd=alpha, env=environment, capture_output=True, text=True
        )

    assert pasted(f"set -e\n{certificates}").returncode == 0
    beta.mkdir()
    for name in ("ca.pem", "machines.pem", "machines.key"):
        shutil.copy(alpha / name, beta)
    started = []
    try:
        for folder, block in zip((alpha, alpha, beta), daemons, strict=True):
            how = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
            words = shlex.split(block.replace("\\\n", " "))
            started.append(
                subprocess.Popen(words, cwd=folder, env=environment, text=True, start_new_session=True, **how)
            )
        until_listening(port, started[0])
        wrong = pasted(grading.replace("CLIENT__KEY", "CLIENT__NONE"))
        assert (wrong.returncode, wrong.stderr.count("\n")) == (4, 2)
        assert "needs the key of that certificate" in wrong.stderr
        assert not (alpha / "grades").exists()
        right = pasted(grading)
        assert right.returncode == 0, right.stderr
    finally:
        stop(started)
    assert len(scores(alpha / "grades")) == 12
    assert not left_running(tmp_path)


def until_listening(port, server):
    while server.poll() is None:
        with contextlib.suppress(OSError):
            socket.create_connection(("127.0.0.1", port), 1).close()
            return
        time.sleep(0.1)
    pytest.fail("the scheduler ended")
