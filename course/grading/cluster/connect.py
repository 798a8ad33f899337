"""Grading a class with Dask: on a cluster on this machine, or on one that runs elsewhere.

    with local_cluster(4) as grade:
        grade_class(folder, out, catalog, options, report, grade=grade)

Nothing is started before there is something to grade. A local cluster speaks TLS with a key of its own that
is never on disk: any program that can talk to a scheduler can make its workers run anything, and every user
of the machine can reach a port.
"""

import contextlib
import json
import logging
import socket
import ssl
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from course.errors import CourseError, InternalError, MissingCapabilityError, UsageError
from course.extras import require
from course.grading.cluster.coordinator import LostBatch, Outcome, grade_on
from course.grading.cluster.worker import grade_batch
from course.grading.intake.students import Entry
from course.grading.running.batch import Graded
from course.grading.running.run import GradeAll
from course.grading.running.snapshot import in_use
from course.isolation.launch import private_folder, remove_tree
from course.scoring.judging.submission import Terms
from course.strangers import read_bytes

# ---
# Whether a scheduler can be reached with the present settings, found out before anything is started.
#
# Dask itself retries until its time is up, and then reports the last failure. Here each thing that can be
# wrong is looked at once, in order: the address, the certificates on this side, the scheduler's, and whether
# the scheduler accepts ours. Every answer is one sentence and what to do.


#: Wall seconds for a connection, for a handshake, and for a refusal to come: together less than five.
_CONNECT_S, _HANDSHAKE_S, _REFUSAL_S = 2.0, 1.5, 0.7
#: The settings that are needed, by Dask's name, and the variable for each.
_SETTINGS = {
    "ca_file": ("DASK_DISTRIBUTED__COMM__TLS__CA_FILE", "the authority's certificate"),
    "cert": ("DASK_DISTRIBUTED__COMM__TLS__CLIENT__CERT", "a certificate of yours"),
    "key": ("DASK_DISTRIBUTED__COMM__TLS__CLIENT__KEY", "the key of that certificate"),
}


def check_scheduler(address: str) -> None:
    """Find out within five seconds why a scheduler cannot be used, if it cannot.

    Args:
        address: as ``--scheduler`` takes it; a transport that Dask knows and this does not is let through.

    Raises:
        UsageError: it is no address.
        MissingCapabilityError: no scheduler answers there, or certificates are missing or wrong.
    """
    url = _address(address)
    place = urlsplit(url if "://" in url else f"tcp://{url}")
    try:
        host, port = place.hostname, place.port
    except ValueError:
        host = port = None
    if place.scheme not in {"tcp", "tls"}:
        return
    if not host or port is None:
        raise UsageError(f"--scheduler {address} is not an address.", help="It looks like tls://name:8786.")
    settings = _settings()
    if place.scheme == "tls":
        _check_tls(url, host, port, _context(settings), settings)
    elif settings.get("require_encryption"):
        fix = f"Name it as tls://{host}:{port}, or unset DASK_DISTRIBUTED__COMM__REQUIRE_ENCRYPTION."
        raise _problem(f"{url} is not encrypted, and Dask's settings require encryption.", fix)
    else:
        _check_plain(url, host, port)


def _address(named: str) -> str:
    """The address in a scheduler file, or the one that was named."""
    if not named.endswith(".json"):
        return named
    try:
        found: Any = json.loads(read_bytes(Path(named)).decode())
    except OSError as error:
        raise _silent(named, error) from None
    except (ValueError, RecursionError):
        found = None
    address = found.get("address") if isinstance(found, dict) else None
    if not isinstance(address, str):
        message = f"{named} is not a scheduler file."
        raise UsageError(message, help="`dask scheduler --scheduler-file` writes one.")
    return address


def _settings() -> dict[str, Any]:
    from distributed import Security

    security = Security()
    return {
        **security.get_tls_config_for_role("client"),
        "require_encryption": bool(security.require_encryption),
    }


def _context(settings: dict[str, Any]) -> ssl.SSLContext:
    """The TLS context that Dask would use, once all its files exist and belong together."""
    missing = [name for name in _SETTINGS if not settings.get(name)]
    if missing == ["key"] and "PRIVATE KEY" in _text(str(settings["cert"])):
        missing = []  # one file may hold both
    if missing:
        variables, wanted = zip(*(_SETTINGS[name] for name in missing), strict=True)
        message = f"A tls:// scheduler needs {' and '.join(wanted)}, and Dask's settings name none."
        raise _problem(message, f"Set {', '.join(variables)}.")
    for name, (variable, what) in _SETTINGS.items():
        path = str(settings[name] or settings["cert"])
        if "\n" in path:  # Dask takes the text of a certificate in place of a file
            continue
        try:
            Path(path).read_bytes()
        except OSError as error:
            message = f"{what.capitalize()} cannot be read: {path}: {(error.strerror or str(error)).lower()}."
            raise _problem(message, f"Set {variable}.") from None
    from distributed import Security

    try:
        context = Security().get_connection_args("client")["ssl_context"]
    except (ssl.SSLError, OSError, ValueError, TypeError) as error:
        reason = getattr(error, "reason", None) or str(error)
        wrong = "the key does not belong to the certificate" if "MISMATCH" in str(reason) else str(reason)
        fix = f"Look at {', '.join(variable for variable, _ in _SETTINGS.values())}."
        raise _problem(f"The certificates in Dask's settings cannot be used: {wrong}.", fix) from None
    assert isinstance(context, ssl.SSLContext)
    return context


def _text(cert: str) -> str:
    with contextlib.suppress(OSError, ValueError):
        return cert if "\n" in cert else Path(cert).read_text("latin-1")
    return ""


def _check_tls(url: str, host: str, port: int, context: ssl.SSLContext, settings: dict[str, Any]) -> None:
    with _connected(url, host, port) as plain:
        plain.settimeout(_HANDSHAKE_S)
        try:
            secure = context.wrap_socket(plain, server_hostname=host)
        except ssl.SSLCertVerificationError as error:
            raise _problem(
                f"The scheduler at {url} has a certificate that {settings['ca_file']} did not sign"
                f" ({error.verify_message}).",
                "Set DASK_DISTRIBUTED__COMM__TLS__CA_FILE to the authority the scheduler was started with.",
            ) from None
        except (ssl.SSLError, OSError) as error:
            raise _told(url, host, port, error) from None
        with secure:
            secure.settimeout(_REFUSAL_S)
            try:
                # A scheduler that refuses our certificate says so after the handshake.
                if not secure.recv(1):
                    raise ConnectionResetError
            except TimeoutError:
                return
            except (ssl.SSLError, OSError):
                raise _problem(
                    f"The scheduler at {url} does not take the certificate {settings['cert']}.",
                    "Set DASK_DISTRIBUTED__COMM__TLS__CLIENT__CERT and ..._KEY to one its authority signed.",
                ) from None


def _told(url: str, host: str, port: int, error: Exception) -> CourseError:
    """Why there was no handshake."""
    if isinstance(error, ssl.SSLError) and "ALERT" in str(error.reason):
        fix = "Set DASK_DISTRIBUTED__COMM__TLS__CLIENT__CERT and ..._KEY to one its authority signed."
        return _problem(f"The scheduler at {url} does not take the certificate of this side.", fix)
    fix = f"Is the scheduler tcp://{host}:{port}?"
    return _problem(f"What answers at {host}:{port} does not speak TLS.", fix)


def _check_plain(url: str, host: str, port: int) -> None:
    """Dask's scheduler greets every client; one with TLS waits for the client's greeting."""
    with _connected(url, host, port) as plain:
        plain.settimeout(_REFUSAL_S)
        with contextlib.suppress(OSError):
            if plain.recv(1):
                return
    asking = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    asking.check_hostname, asking.verify_mode = False, ssl.CERT_NONE
    with _connected(url, host, port) as plain, contextlib.suppress(OSError):
        plain.settimeout(_HANDSHAKE_S)
        asking.wrap_socket(plain, server_hostname=host).close()
        fix = f"Name it as tls://{host}:{port}, with the certificates that docs/cluster.md describes."
        raise _problem(f"The scheduler at {url} speaks TLS.", fix)


def _connected(url: str, host: str, port: int) -> socket.socket:
    try:
        return socket.create_connection((host, port), _CONNECT_S)
    except OSError as error:
        raise _silent(url, error) from None


def _silent(where: str, error: OSError) -> CourseError:
    reason = (error.strerror or str(error) or type(error).__name__).lower()
    fix = "Is it running, and can this machine reach it?"
    return _problem(f"No Dask scheduler answers at {where}: {reason}.", fix, "no_scheduler")


def _problem(message: str, fix: str, code: str = "no_tls") -> MissingCapabilityError:
    return MissingCapabilityError(message, help=fix, code=code)


#: Wall seconds for a scheduler to answer, and for its first worker to be there.
_ANSWER_S = 20.0


@contextlib.contextmanager
def local_cluster(workers: int) -> Iterator[GradeAll]:
    """What grades on a cluster of ``workers`` processes on this machine, for one run.

    Raises:
        MissingCapabilityError: Dask is not installed.
    """
    require("cluster")
    with contextlib.ExitStack() as stack:
        yield lambda entries, terms: _graded(start_cluster(stack, workers), entries, terms)


@contextlib.contextmanager
def remote_cluster(address: str) -> Iterator[GradeAll]:
    """What grades on the cluster whose scheduler is at ``address``, or is in the scheduler file of that name.

    Others may use it too, so unprotected submissions, which could command it, raise a UsageError there.

    Raises:
        MissingCapabilityError: Dask is not installed.
    """
    require("cluster")
    with contextlib.ExitStack() as stack:

        def grade(entries: Iterable[Entry], terms: Terms) -> Iterator[Graded]:
            if terms.at_least == "L1":
                raise UsageError(
                    "--isolation process leaves the network open, and a submission could give orders to the"
                    " whole cluster.",
                    help="Leave it out, or grade on one machine.",
                    code="unprotected_cluster",
                )
            check_scheduler(address)
            return _graded(_reach(stack, address), entries, terms)

        yield grade


def _graded(client: Any, entries: Iterable[Entry], terms: Terms) -> Iterator[Graded]:
    graders = in_use(terms.graders)
    if graders is None:
        raise InternalError("The snapshot that is to judge is not unpacked here.")
    return grade_on(DaskWorkers(client), entries, terms, graders.version, graders=graders.snapshot.packed)


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
        message = f"No Dask scheduler answers at {address}: {error}."
        advice = "Is it running, can this machine reach it, and has this command the same TLS settings?"
        raise MissingCapabilityError(message, help=advice, code="no_scheduler") from None
    except (ValueError, TypeError) as error:
        message = f"--scheduler {address} is not an address: {error}."
        raise UsageError(message, help="It looks like tls://name:8786.") from None
    stack.enter_context(client)
    try:
        client.wait_for_workers(1, timeout=_ANSWER_S)
    except TimeoutError:
        message = f"The scheduler at {address} has no workers."
        raise MissingCapabilityError(message, help="Start some first.", code="no_workers") from None
    return client


class DaskWorkers:
    """The workers of a Dask cluster, as the coordinator sees them.

    Args:
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
    cause = error
    while cause is not None and not isinstance(cause, ImportError | AttributeError):
        cause = cause.__cause__ or cause.__context__
    if cause is not None:
        message = f"The cluster's scheduler or a worker has no such course: {cause}."
        advice = "Install the same checkout of the course where the scheduler and the workers run."
        return MissingCapabilityError(message, help=advice, code="version_mismatch")
    return InternalError(f"A worker of the cluster failed: {type(error).__name__}: {error}.")


def _scheduler_gone() -> MissingCapabilityError:
    message = "The cluster's scheduler is gone; all results so far are kept."
    advice = "Start it again, then run the same command with --resume."
    return MissingCapabilityError(message, help=advice, code="no_scheduler")
