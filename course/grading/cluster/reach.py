"""Whether a scheduler can be reached with the present settings, found out before anything is started.

Dask itself retries until its time is up, and then reports the last failure. Here each thing that can be wrong
is looked at once, in order: the address, the certificates on this side, the scheduler's, and whether the
scheduler accepts ours. Every answer is one sentence and what to do.
"""

from __future__ import annotations

import contextlib
import json
import socket
import ssl
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

from course.errors import MissingCapabilityError, UsageError

if TYPE_CHECKING:
    from course.errors import CourseError

__all__ = ["check_scheduler"]

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
        raise _problem(
            f"{url} is not encrypted, and Dask's settings require encryption.",
            f"Name it as tls://{host}:{port}, or unset DASK_DISTRIBUTED__COMM__REQUIRE_ENCRYPTION.",
        )
    else:
        _check_plain(url, host, port)


def _address(named: str) -> str:
    """The address in a scheduler file, or the one that was named."""
    if not named.endswith(".json"):
        return named
    try:
        found: Any = json.loads(Path(named).read_text("utf-8"))
    except OSError as error:
        raise _silent(named, error) from None
    except ValueError:
        found = None
    address = found.get("address") if isinstance(found, dict) else None
    if not isinstance(address, str):
        raise UsageError(
            f"{named} is not a scheduler file.", help="`dask scheduler --scheduler-file` writes one."
        )
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
        wanted = " and ".join(_SETTINGS[name][1] for name in missing)
        variables = ", ".join(_SETTINGS[name][0] for name in missing)
        raise _problem(
            f"A tls:// scheduler needs {wanted}, and Dask's settings name none.", f"Set {variables}."
        )
    for name, (variable, what) in _SETTINGS.items():
        path = str(settings[name] or settings["cert"])
        if "\n" in path:  # Dask takes the text of a certificate in place of a file
            continue
        try:
            Path(path).read_bytes()
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise _problem(
                f"{what.capitalize()} cannot be read: {path}: {reason}.", f"Set {variable}."
            ) from None
    from distributed import Security

    try:
        context = Security().get_connection_args("client")["ssl_context"]
    except (ssl.SSLError, OSError, ValueError, TypeError) as error:
        reason = getattr(error, "reason", None) or str(error)
        wrong = "the key does not belong to the certificate" if "MISMATCH" in str(reason) else str(reason)
        raise _problem(
            f"The certificates in Dask's settings cannot be used: {wrong}.",
            f"Look at {', '.join(variable for variable, _ in _SETTINGS.values())}.",
        ) from None
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
        return _problem(
            f"The scheduler at {url} does not take the certificate of this side.",
            "Set DASK_DISTRIBUTED__COMM__TLS__CLIENT__CERT and ..._KEY to one its authority signed.",
        )
    return _problem(
        f"What answers at {host}:{port} does not speak TLS.", f"Is the scheduler tcp://{host}:{port}?"
    )


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
        raise _problem(
            f"The scheduler at {url} speaks TLS.",
            f"Name it as tls://{host}:{port}, with the certificates that docs/cluster.md describes.",
        )


def _connected(url: str, host: str, port: int) -> socket.socket:
    try:
        return socket.create_connection((host, port), _CONNECT_S)
    except OSError as error:
        raise _silent(url, error) from None


def _silent(where: str, error: OSError) -> CourseError:
    reason = (error.strerror or str(error) or type(error).__name__).lower()
    return _problem(
        f"No Dask scheduler answers at {where}: {reason}.",
        "Is it running, and can this machine reach it?",
        "no_scheduler",
    )


def _problem(message: str, fix: str, code: str = "no_tls") -> MissingCapabilityError:
    return MissingCapabilityError(message, help=fix, code=code)
