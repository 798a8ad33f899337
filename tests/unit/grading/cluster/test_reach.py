"""A scheduler with wrong, missing and right certificates: one sentence each, at once, and nothing begun."""

import contextlib
import datetime as dt
import json
import socket
import ssl
import threading
import time

import pytest

from course.errors import CourseError, MissingCapabilityError, UsageError
from course.grading.running.run import RunOptions, grade_class
from tests.unit.grading.made import NEEDS_CLUSTER

pytestmark = NEEDS_CLUSTER


def certificate(folder, name, signer=None):
    """A certificate and its key, in files of that name; signed by itself if by nobody else."""
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes, serialization
    from cryptography.hazmat.primitives.asymmetric import ec

    key = ec.generate_private_key(ec.SECP256R1())
    subject = x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, name)])
    issuer, signing = signer or (subject, key)
    now = dt.datetime.now(dt.UTC)
    made = (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - dt.timedelta(days=1))
        .not_valid_after(now + dt.timedelta(days=1))
        .add_extension(x509.BasicConstraints(ca=signer is None, path_length=None), critical=True)
        .sign(signing, hashes.SHA256())
    )
    pem = serialization.Encoding.PEM
    (folder / f"{name}.pem").write_bytes(made.public_bytes(pem))
    private = key.private_bytes(pem, serialization.PrivateFormat.PKCS8, serialization.NoEncryption())
    (folder / f"{name}.key").write_bytes(private)
    return subject, key


@pytest.fixture(scope="module")
def pems(tmp_path_factory):
    """Of an authority: ``ca``, ``head`` and ``me``; of another one: ``other`` and ``stranger``."""
    folder = tmp_path_factory.mktemp("pems")
    for authority, signed in (("ca", ("head", "me")), ("other", ("stranger",))):
        signer = certificate(folder, authority)
        for name in signed:
            certificate(folder, name, signer)
    return folder


def serve(sock, context, stop):
    """Greets whoever comes, as a Dask scheduler does: in TLS, or plainly."""
    while not stop.is_set():
        try:
            client, _ = sock.accept()
        except OSError:
            return
        with contextlib.suppress(OSError), client:
            client.settimeout(5)
            with context.wrap_socket(client, server_side=True) if context else client as greeted:
                greeted.sendall(b"hello")
                greeted.recv(1)


@contextlib.contextmanager
def scheduler(pems):
    """The port of something that looks like a scheduler, with TLS if there are certificates for it."""
    context = None
    if pems is not None:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(pems / "head.pem", pems / "head.key")
        context.load_verify_locations(pems / "ca.pem")
        context.verify_mode = ssl.CERT_REQUIRED
    stop = threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as sock:
        thread = threading.Thread(target=serve, args=(sock, context, stop))
        thread.start()
        port = sock.getsockname()[1]
        try:
            yield port
        finally:
            stop.set()
            with contextlib.suppress(OSError):
                socket.create_connection(("127.0.0.1", port), 1).close()
            thread.join()


def said(address, settings):
    """Why that scheduler cannot be used with these settings of Dask's; None if it can."""
    import dask
    import distributed  # noqa: F401 - brings its settings

    from course.grading.cluster.connect import check_scheduler

    none = {"ca-file": None, "client.cert": None, "client.key": None}
    known = {f"distributed.comm.tls.{name}": value for name, value in (none | settings).items()}
    known["distributed.comm.require-encryption"] = settings.get("require-encryption")
    known.pop("distributed.comm.tls.require-encryption", None)
    found = None
    used = time.process_time()
    with dask.config.set(known):
        try:
            check_scheduler(address)
        except CourseError as error:
            found = error
    assert time.process_time() - used < 5
    if found is not None:
        assert found.message.count(". ") == 0, "one sentence"
        assert found.help
    return found


def mine(pems):
    return {
        "ca-file": str(pems / "ca.pem"),
        "client.cert": str(pems / "me.pem"),
        "client.key": str(pems / "me.key"),
    }


#: Settings -> what is said; ``{}`` stands for the folder of the certificates.
WRONG = {
    "none": ({}, "needs the authority's certificate and a certificate of yours and the key"),
    "no authority": ({"ca-file": ""}, "needs the authority's certificate, and"),
    "no key": ({"client.key": ""}, "needs the key of that certificate, and"),
    "no such file": ({"ca-file": "/nowhere/ca.pem"}, "cannot be read: /nowhere/ca.pem: no such file"),
    "another's key": ({"client.key": "{}/stranger.key"}, "the key does not belong to the certificate"),
    "no certificate": ({"client.cert": "{}/ca.key"}, "cannot be used"),
    "another authority": ({"ca-file": "{}/other.pem"}, "has a certificate that {}/other.pem did not sign"),
    "not signed by theirs": (
        {"client.cert": "{}/stranger.pem", "client.key": "{}/stranger.key"},
        "does not take the certificate {}/stranger.pem",
    ),
}


def test_each_wrong_setting_is_one_sentence_and_the_right_ones_are_none(pems):
    with scheduler(pems) as port:
        address = f"tls://127.0.0.1:{port}"
        for name, (change, words) in WRONG.items():
            settings = {}
            if name != "none":
                settings = mine(pems) | {key: value.format(pems) for key, value in change.items()}
            error = said(address, settings)
            assert isinstance(error, MissingCapabilityError), name
            assert words.format(pems, pems) in error.message, name
            assert error.code == "no_tls"
        assert said(address, mine(pems)) is None
        both = pems / "both.pem"
        both.write_bytes((pems / "me.pem").read_bytes() + (pems / "me.key").read_bytes())
        assert said(address, mine(pems) | {"client.cert": str(both), "client.key": None}) is None
        error = said(f"tcp://127.0.0.1:{port}", {})
        assert "speaks TLS" in error.message


def test_a_plain_scheduler_and_none_at_all(pems, tmp_path):
    with scheduler(None) as port:
        assert said(f"tcp://127.0.0.1:{port}", {}) is None
        assert said(f"127.0.0.1:{port}", {}) is None
        file = tmp_path / "scheduler.json"
        file.write_text(json.dumps({"address": f"tcp://127.0.0.1:{port}"}))
        assert said(str(file), {}) is None
        for address, settings, words in (
            (f"tls://127.0.0.1:{port}", mine(pems), "does not speak TLS"),
            (f"tcp://127.0.0.1:{port}", {"require-encryption": True}, "settings require encryption"),
        ):
            error = said(address, settings)
            assert words in error.message
    silent = said(f"tcp://127.0.0.1:{port}", {})
    assert (silent.code, silent.exit_code) == ("no_scheduler", 4)
    (tmp_path / "broken.json").write_text("[]")
    for address in ("tls://head", "tls://head:x", str(tmp_path / "broken.json")):
        assert isinstance(said(address, mine(pems)), UsageError), address
    assert isinstance(said(str(tmp_path / "none.json"), {}), MissingCapabilityError)
    assert said("ucx://somewhere:1", {}) is None, "Dask knows more ways than are looked at here"


def test_a_scheduler_that_cannot_be_reached_leaves_no_folder(tmp_path, catalog):
    from course.grading.cluster.connect import remote_cluster

    with socket.create_server(("127.0.0.1", 0)) as sock:
        port = sock.getsockname()[1]
    (tmp_path / "class" / "ada").mkdir(parents=True)
    (tmp_path / "class" / "ada" / "doubling.py").write_text("def double(x): return 2 * x\n")
    options = RunOptions(exercises=("doubling",), seed=1)
    with (
        remote_cluster(f"tcp://127.0.0.1:{port}") as grade,
        pytest.raises(MissingCapabilityError, match="No Dask scheduler answers"),
    ):
        grade_class(tmp_path / "class", tmp_path / "out", catalog, options, lambda *_: None, grade=grade)
    assert not (tmp_path / "out").exists()
