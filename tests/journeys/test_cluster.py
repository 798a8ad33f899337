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
from course.errors import MissingCapabilityError
from course.grading.cluster.connect import DaskWorkers, local_cluster, remote_cluster, start_cluster
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
def catalog(monkeypatch, tmp_path):
    """The miniature course, for this process and for all that it starts, which are marked by the folder."""
    monkeypatch.setenv("COURSE_CONTENT", str(MINI))
    path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    monkeypatch.setenv("PYTHONPATH", path)
    monkeypatch.setenv("MARKER", str(tmp_path))
    return Catalog()


@pytest.fixture
def start(catalog, tmp_path):
    """Starts programs, each in a session of its own; at the end all are stopped, and nothing is left."""
    started = []

    def begin(*words, **how):
        started.append(subprocess.Popen(words, text=True, start_new_session=True, **how))
        return started[-1]

    yield begin
    for process in reversed(started):
        process.terminate()
    for process in started:
        try:
            process.communicate(timeout=20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
    assert not left_running(tmp_path)


def test_a_submission_that_kills_dask_workers_takes_nobody_with_it(tmp_path, catalog):
    """A death that no grader process can keep from its worker: a machine that runs out of memory."""

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
def test_an_interrupted_run_leaves_nothing_behind_and_is_resumed(tmp_path, start, sign):
    """Ctrl-C reaches every process of the terminal, the workers too; kill -9 the coordinator alone."""
    students = 120
    make_class(tmp_path / "class", students)
    out = tmp_path / "out"
    how = ("--local-cluster", 2, "--seed", 9, "--plain", "--isolation", "process")
    run = command(tmp_path / "class", "--out", out, *how)
    process = start(*run, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert "student-" in process.stdout.readline()
    if sign is signal.SIGINT:
        os.killpg(process.pid, sign)
    else:
        process.kill()
    _, words = process.communicate()
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
    again = subprocess.run([*run, "--resume"], capture_output=True, text=True, check=False)
    assert again.returncode == 0, again.stderr
    assert again.stdout.count(f"/{students} student") == students - done
    assert len(scores(out)) == students


@pytest.mark.parametrize("kill_at", [-1, 3], ids=["undisturbed", "a worker killed"])
def test_a_check_edited_during_a_run_on_a_cluster_changes_nothing(tmp_path, catalog, monkeypatch, kill_at):
    """Workers that start late, or again, judge by the snapshot too."""
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


def scheduler_and_worker(start):
    """A Dask scheduler, its address, and one worker with a nanny, as an instructor would start them."""
    python = (sys.executable, "-P", "-m")
    here = ("--host", "127.0.0.1", "--port", "0", "--no-dashboard")
    scheduler = start(*python, "distributed.cli.dask_scheduler", *here, stderr=subprocess.PIPE)
    address = next(line for line in scheduler.stderr if "Scheduler at:" in line).split()[-1]
    worker = ("distributed.cli.dask_worker", address, "--nthreads", "2", "--no-dashboard")
    start(*python, *worker, stderr=subprocess.DEVNULL)
    return scheduler, address


def test_a_cluster_somewhere_else_grades_and_its_end_is_said(tmp_path, catalog, start):
    make_class(tmp_path / "class", 300)
    options, out = RunOptions(exercises=("doubling",), seed=3), tmp_path / "out"
    scheduler, address = scheduler_and_worker(start)

    def report(*_):
        if scheduler.poll() is None:
            scheduler.kill()
            scheduler.wait()

    gone = pytest.raises(MissingCapabilityError, match="scheduler is gone")
    with gone, remote_cluster(address) as grade:
        grade_class(tmp_path / "class", out, catalog, options, report, grade=grade)
    done = len(scores(out))
    assert 0 < done < 300
    again = RunOptions(exercises=("doubling",), resume=True)
    with remote_cluster(scheduler_and_worker(start)[1]) as grade:
        summary = grade_class(tmp_path / "class", out, catalog, again, lambda *_: None, grade=grade)
    assert (summary.already, summary.states["graded"]) == (done, 300)


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
def test_the_page_for_two_machines_works_as_written(tmp_path, start, monkeypatch):
    """A setting left out first: one sentence, no folder left behind; the corrected command is the same."""
    with socket.create_server(("127.0.0.1", 0)) as sock:
        port = sock.getsockname()[1]
    certificates, *daemons, grading = commands_of_the_page(port)
    alpha, beta = tmp_path / "alpha", tmp_path / "beta"
    make_class(alpha / "submissions", 12)
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")

    def pasted(script):
        return subprocess.run(["sh", "-c", script], check=False, cwd=alpha, capture_output=True, text=True)

    assert pasted(f"set -e\n{certificates}").returncode == 0
    beta.mkdir()
    for name in ("ca.pem", "machines.pem", "machines.key"):
        shutil.copy(alpha / name, beta)
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    scheduler, *_ = [
        start(*shlex.split(block.replace("\\\n", " ")), cwd=folder, **quiet)
        for folder, block in zip((alpha, alpha, beta), daemons, strict=True)
    ]
    until_listening(port, scheduler)
    wrong = pasted(grading.replace("CLIENT__KEY", "CLIENT__NONE"))
    assert (wrong.returncode, wrong.stderr.count("\n")) == (4, 2)
    assert "needs the key of that certificate" in wrong.stderr
    assert not (alpha / "grades").exists()
    right = pasted(grading)
    assert right.returncode == 0, right.stderr
    assert len(scores(alpha / "grades")) == 12


def until_listening(port, server):
    while server.poll() is None:
        with contextlib.suppress(OSError):
            socket.create_connection(("127.0.0.1", port), 1).close()
            return
        time.sleep(0.1)
    pytest.fail("the scheduler ended")
