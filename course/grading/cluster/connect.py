"""Grading a class with Dask: on a cluster on this machine, or on one that runs elsewhere.

    with local_cluster(4) as grade:
        grade_class(folder, out, catalog, options, report, grade=grade)

Nothing is started before there is something to grade. A local cluster speaks TLS with a key of its own that
is never on disk: any program that can talk to a scheduler can make its workers run anything, and every user
of the machine can reach a port.
"""

from __future__ import annotations

import contextlib
import logging
from concurrent.futures import CancelledError
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from course.errors import InternalError, MissingCapabilityError, UsageError
from course.extras import require
from course.grading.cluster.coordinator import LostBatch, grade_on
from course.grading.cluster.reach import check_scheduler
from course.grading.cluster.worker import grade_batch
from course.grading.running.snapshot import in_use
from course.isolation.launch import private_folder, remove_tree

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from course.grading.cluster.coordinator import Outcome
    from course.grading.intake.students import Entry
    from course.grading.running.batch import Graded
    from course.scoring.judging.terms import Terms

__all__ = ["Cluster", "DaskWorkers", "local_cluster", "remote_cluster", "start_cluster"]

#: Wall seconds for a scheduler to answer, and for its first worker to be there.
_ANSWER_S = 20.0


class Cluster:
    """Turns entries into verdicts, for ``grade_class``; a context manager that ends what it started.

    Args:
        connect: gives a client, and puts on the stack what must be closed.
        remote: address of a scheduler that others may use too; empty for one of our own.

    Raises:
        MissingCapabilityError: Dask is not installed.
    """

    def __init__(
        self,
        connect: Callable[[contextlib.ExitStack], Any],
        *,
        remote: str = "",
    ) -> None:
        require("cluster")
        self._connect = connect
        self._remote = remote
        self._stack = contextlib.ExitStack()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def __call__(self, entries: Iterable[Entry], terms: Terms) -> Iterator[Graded]:
        """Verdicts on all entries that have a submission or a problem.

        Raises:
            UsageError: unprotected submissions may not run on a cluster whose scheduler they could command.
            CourseError: there is no scheduler, or its workers cannot grade.
        """
        if self._remote and terms.at_least == "L1":
            raise UsageError(
                "--isolation process leaves the network open, and a submission could give orders to the whole"
                " cluster.",
                help="Leave it out, or grade on one machine.",
                code="unprotected_cluster",
            )
        if self._remote:
            check_scheduler(self._remote)
        workers = DaskWorkers(self._connect(self._stack))

        graders = in_use(terms.graders)
        if graders is None:
            raise InternalError("The snapshot that is to judge is not unpacked here.")
        yield from grade_on(workers, entries, terms, graders.version, graders=graders.snapshot.packed)


def local_cluster(workers: int) -> Cluster:
    """A cluster of ``workers`` processes on this machine, for one run."""
    return Cluster(lambda stack: start_cluster(stack, workers))


def remote_cluster(address: str) -> Cluster:
    """The cluster whose scheduler is at ``address``, or is described by the scheduler file of that name."""
    return Cluster(lambda stack: _reach(stack, address), remote=address)


def start_cluster(stack: contextlib.ExitStack, workers: int) -> Any:
    """A client of a new cluster on this machine."""
    import dask
    from distributed import Client, LocalCluster, Security

    folder = private_folder()
    stack.callback(remove_tree, folder)
    scratch = str(folder)
    settings = {
        # Dask makes this importable, here and in every worker: never a name that others can know or make.
        "temporary-directory": scratch,
        # A worker that dies with a batch is reported at once: retries are decided here.
        "distributed.scheduler.allowed-failures": 0,
        # The folder the command is run in, which may be a student's, never becomes importable.
        "distributed.nanny.pre-spawn-environ.PYTHONSAFEPATH": "1",
        # Dask's measurements of itself cost as much as a tenth of a grader.
        "distributed.worker.profile.enabled": False,
        "distributed.admin.tick.interval": "1s",
        "distributed.admin.tick.cycle": "5s",
        "distributed.admin.system-monitor.interval": "10s",
        "distributed.admin.system-monitor.gil.enabled": False,
        # Dask's web pages are not encrypted, so none are served.
        "distributed.scheduler.http.routes": [],
        "distributed.worker.http.routes": [],
    }
    stack.enter_context(dask.config.set(settings))
    cluster = stack.enter_context(
        LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            memory_limit=0,  # the graders take the memory, and have limits of their own
            scheduler_kwargs={"dashboard": False, "dashboard_address": "127.0.0.1:0"},
            security=Security.temporary(),
            local_directory=scratch,
            preload="course.grading.cluster.worker",
            silence_logs=logging.CRITICAL,
        )
    )
    return stack.enter_context(Client(cluster, set_as_default=False))


def _reach(stack: contextlib.ExitStack, address: str) -> Any:
    """A client of a running cluster, once that has a worker."""
    from distributed import Client

    file = Path(address)
    where = {"scheduler_file": address} if file.suffix == ".json" else {"address": address}
    try:
        client = Client(**where, timeout=_ANSWER_S, set_as_default=False)
    except (OSError, TimeoutError) as error:
        raise MissingCapabilityError(
            f"No Dask scheduler answers at {address}: {error}.",
            help="Is it running, can this machine reach it, and has this command the same TLS settings?",
            code="no_scheduler",
        ) from None
    except (ValueError, TypeError) as error:
        raise UsageError(
            f"--scheduler {address} is not an address: {error}.", help="It looks like tls://name:8786."
        ) from None
    stack.enter_context(client)
    try:
        client.wait_for_workers(1, timeout=_ANSWER_S)
    except TimeoutError:
        raise MissingCapabilityError(
            f"The scheduler at {address} has no workers.", help="Start some first.", code="no_workers"
        ) from None
    return client


class DaskWorkers:
    """The workers of a Dask cluster, as the coordinator sees them.

    Args:
        client: of ``distributed``.
        task: the function to run there, bytes to bytes; known there by the same name.
    """

    def __init__(self, client: Any, task: Callable[[bytes], bytes] = grade_batch) -> None:
        self._client = client
        self._task = task
        self._futures: set[Any] = set()

    def places(self) -> int:
        """Threads of all workers there are."""
        try:
            return sum(self._client.nthreads().values())
        except (OSError, TimeoutError, RuntimeError):
            return 0  # the scheduler is gone; the batches sent to it will report that

    def send(self, payload: bytes, done: Callable[[Outcome], None]) -> None:
        """Have a batch graded by the first worker that is free."""
        try:
            future = self._client.submit(self._task, payload, pure=False)
        except (OSError, RuntimeError):
            done(_scheduler_gone())
            return
        self._futures.add(future)
        future.add_done_callback(lambda it: self._finished(it, done))

    def _finished(self, future: Any, done: Callable[[Outcome], None]) -> None:
        self._futures.discard(future)
        done(_outcome(future, connected=self._client.status == "running"))


def _outcome(future: Any, *, connected: bool) -> Outcome:
    from distributed import CancelledError as DaskCancelledError
    from distributed import KilledWorker

    try:
        if future.status in {"cancelled", "lost"}:
            # Lost beside a scheduler that is there: its worker died before the answers were fetched.
            return LostBatch() if connected and future.status == "lost" else _scheduler_gone()
        error = future.exception() if future.status == "error" else None
        if error is None:
            reply = future.result()
            return reply if isinstance(reply, bytes) else InternalError("A worker answered with no bytes.")
    except (CancelledError, DaskCancelledError, OSError, TimeoutError, RuntimeError):
        return _scheduler_gone()
    if isinstance(error, KilledWorker):
        return LostBatch(int(getattr(error, "allowed_failures", 0)) + 1)
    cause = next((e for e in _chain(error) if isinstance(e, ImportError | AttributeError)), None)
    if cause is not None:
        return MissingCapabilityError(
            f"The cluster's scheduler or a worker has no such course: {cause}.",
            help="Install the same checkout of the course where the scheduler and the workers run.",
            code="version_mismatch",
        )
    return InternalError(f"A worker of the cluster failed: {type(error).__name__}: {error}.")


def _scheduler_gone() -> MissingCapabilityError:
    return MissingCapabilityError(
        "The cluster's scheduler is gone; all results so far are kept.",
        help="Start it again, then run the same command with --resume.",
        code="no_scheduler",
    )


def _chain(error: BaseException | None) -> Iterator[BaseException]:
    while error is not None:
        yield error
        error = error.__cause__ or error.__context__
