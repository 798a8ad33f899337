"""Shared by all ways of starting a worker: its files, its command, cleaning up after it."""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import shutil
import site
import sys
import sysconfig
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Any

from course.isolation.failures import IsolationError

#: What runs beside a stranger's code is copied as a package of its own, laid out as here: its files import
#: each other by the same relative names in both places.
_PACKAGE = "course_worker"
_COPIED = (
    "isolation/inside/wire.py",
    *(f"isolation/inside/{name}.py" for name in ("loops", "statements", "loading")),
    *(f"isolation/inside/{name}.py" for name in ("worker", "lockdown", "zygote")),
    "physics/systems.py",
)
#: Environment of a process whose numpy is to have one thread: on the one processor it stays on, others spin.
ONE_THREAD = {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL", "VECLIB_MAXIMUM")}
_PREFIX = "course-worker-"
_TIDY_S = 1.0
_SWEEP_S = 5.0  # wall seconds spent on deleting what a submission left behind


def keep_private() -> None:
    """Close this process to others of the same user: its memory, its descriptors, its environment.

    At L1 a submission runs as that user, and through /proc it could open the pipe that verdicts go through.
    Only Linux has /proc, and the one call that closes it.
    """
    if sys.platform == "linux":
        from course.isolation.inside import lockdown

        lockdown.not_dumpable()


def private_folder() -> Path:
    """A new folder for one session, named after this process."""
    sweep_after_the_dead()
    return Path(tempfile.mkdtemp(prefix=f"{_PREFIX}{os.getpid()}-"))


def sweep_after_the_dead() -> None:
    """Delete what killed processes left behind: the folders whose process is gone."""
    if hasattr(os, "getuid"):  # on Windows, asking whether a process lives would end it
        for old in Path(tempfile.gettempdir()).glob(f"{_PREFIX}*"):
            owner = old.name.removeprefix(_PREFIX).partition("-")[0]
            with contextlib.suppress(OSError):
                if owner.isdigit() and old.lstat().st_uid == os.getuid() and not _is_alive(int(owner)):
                    sweep(old)


def _is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except OSError as error:
        return not isinstance(error, ProcessLookupError)
    return True


def copy_worker_files(target: Path) -> None:
    """Put the worker's files into a folder that the worker's user can read."""
    course = Path(__file__).resolve().parents[1]
    package = target / _PACKAGE
    for folder in (package, package / "isolation", package / "isolation" / "inside", package / "physics"):
        folder.mkdir()
        (folder / "__init__.py").touch()
    for name in _COPIED:
        shutil.copy(course / name, package / name)
    for path in (package, *package.rglob("*")):
        path.chmod(0o755 if path.is_dir() else 0o644)


def command(view: View, folder: str, config: dict[str, Any]) -> list[str]:
    # -S and -s: no site-packages, so nothing but the declared packages on the path; -P: no current folder.
    flags = ["-S", "-s", "-P", "-B"]
    zygote = f"{folder}/{_PACKAGE}/isolation/inside/zygote.py"
    return [str(view.interpreter), *flags, zygote, json.dumps(config)]


def environment() -> dict[str, str]:
    names = {"SYSTEMROOT", "PATH"} & os.environ.keys() if sys.platform == "win32" else ()
    kept = {name: os.environ[name] for name in names}
    return {**kept, **ONE_THREAD, "LANG": "C.UTF-8", "HOME": "/nonexistent", "PYTHONHASHSEED": "0"}


def sweep(folder: Path) -> None:
    """Delete the folder of a session that ends; a later session deletes what remains."""
    _advance(removing(folder), _SWEEP_S)


def tidy(left: list[Iterator[None]]) -> None:
    """Continue some removals for a second of wall time, and remove the finished ones from the list.

    Deleting can take longer than making did, and a run must not stand still for that.
    """
    end = monotonic() + _TIDY_S
    while left and _advance(left[-1], end - monotonic()):
        left.pop()


def _advance(removal: Iterator[None], seconds: float) -> bool:
    """Whether a removal is done within so much time."""
    end = monotonic() + seconds
    return all(monotonic() < end for _ in removal)


def remove_tree(folder: Path) -> None:
    """Delete a folder that a submission filled, however long it takes."""
    for _ in removing(folder):
        pass


def removing(folder: Path) -> Iterator[None]:
    """Delete a folder that a submission filled: of any depth, with any permissions, with links to anywhere.

    Folders inside folders are moved up before they are emptied, so that neither the length of a path nor
    recursion sets a limit. Yields after each entry, so that the caller can continue later.
    """
    moved, prefix = 0, secrets.token_hex(8)  # a name that the submission cannot have used
    pending = [folder]
    while pending:
        here = pending.pop()
        entries: list[os.DirEntry[str]] = []
        with contextlib.suppress(OSError):
            here.chmod(0o700)
            entries = list(os.scandir(here))
        for entry in entries:
            with contextlib.suppress(OSError):  # an entry that cannot be deleted does not keep the others
                if entry.is_dir(follow_symlinks=False):
                    moved += 1
                    os.chmod(entry.path, 0o700)  # noqa: PTH101 - moving a folder needs to write to it
                    os.rename(entry.path, folder / f"{prefix}-{moved}")  # noqa: PTH104
                    pending.append(folder / f"{prefix}-{moved}")
                else:
                    os.unlink(entry.path)  # noqa: PTH108
            yield
        if here != folder:
            with contextlib.suppress(OSError):
                here.rmdir()
    with contextlib.suppress(OSError):
        folder.rmdir()


# ---
# The files that a student's code may read: the interpreter, the system's libraries and declared packages.
#
# One description serves both mechanisms: bubblewrap binds ``readable`` into an otherwise empty root and
# covers ``masked`` with empty folders; Landlock, which cannot subtract, gets the list from ``expanded``.


_SYSTEM = (
    "/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib", "/etc/ld.so.cache", "/etc/localtime",
    "/usr/share/zoneinfo", "/dev/null", "/dev/zero", "/dev/random", "/dev/urandom",
)  # fmt: skip


@dataclass(frozen=True)
class View:
    """Paths a worker may read.

    Attributes:
        interpreter: the Python to run, links resolved.
        prefix: the ``sys.prefix`` that interpreter must report.
        masked: folders inside ``readable`` that must look empty: other packages, and this course.
        packages: entries of site-packages that are declared, by name.
    """

    interpreter: Path
    prefix: Path
    readable: tuple[Path, ...]
    masked: tuple[Path, ...]
    packages: tuple[Path, ...]

    def expanded(self) -> list[Path]:
        """``readable`` without ``masked``, as a list of paths none of which contains a masked one."""
        found = [path for top in self.readable for path in _without(top, self.masked)]
        return [*dict.fromkeys(found), *self.packages]


def _without(top: Path, masked: tuple[Path, ...]) -> list[Path]:
    """``top``, or what is in it without the masked; links are followed first, as Landlock follows them."""
    top = Path(os.path.realpath(top))
    if any(top.is_relative_to(mask) for mask in masked):
        return []
    if not any(mask.is_relative_to(top) for mask in masked):
        return [top]
    try:
        children = sorted(top.iterdir())
    except OSError:
        return []
    found: list[Path] = []
    for child in children:
        # A link to a folder with something masked in it is not followed: that might never end.
        if not (child.is_symlink() and any(one.is_relative_to(os.path.realpath(child)) for one in masked)):
            found += _without(child, masked)
    return found


def view_for(imports: tuple[str, ...]) -> View:
    """The view of a worker whose exercise declares ``imports``."""
    base = {"base": sys.base_prefix, "platbase": sys.base_prefix, "installed_base": sys.base_prefix}
    stdlib = {Path(sysconfig.get_path(name, vars=base)) for name in ("stdlib", "platstdlib")}
    interpreter = Path(os.path.realpath(getattr(sys, "_base_executable", sys.executable) or sys.executable))
    readable = {interpreter, *stdlib, *_mapped_library_folders(), *map(Path, _SYSTEM)}
    masked = {path for path in _package_folders() if any(path.is_relative_to(top) for top in readable)}
    return View(
        interpreter=interpreter,
        prefix=Path(sys.base_prefix),
        readable=tuple(sorted(path for path in readable if path.exists())),
        masked=tuple(sorted(path for path in masked if path.is_dir())),
        packages=tuple(sorted({entry for name in imports for entry in _entries(name)})),
    )


def _package_folders() -> set[Path]:
    """Every folder that packages are installed to, and where this course and its graders live."""
    here = Path(__file__).resolve().parents[1]
    folders = {here, Path(site.getusersitepackages()), *map(Path, site.getsitepackages())}
    for prefix in (sys.base_prefix, sys.prefix):
        for scheme in sysconfig.get_scheme_names():
            for name in ("purelib", "platlib"):
                values = {"base": prefix, "platbase": prefix, "installed_base": prefix}
                folders.add(Path(sysconfig.get_path(name, scheme, values)))
    folders.update(Path(entry) for entry in sys.path if entry.endswith(("site-packages", "dist-packages")))
    for system in ("/usr/lib", "/usr/local/lib"):  # packages of other Pythons: this course may be among them
        for kind in ("site-packages", "dist-packages"):
            folders.update(Path(system).glob(f"*/{kind}"))
    if (here.parent / "pyproject.toml").exists():
        folders.add(here.parent)  # a checkout: solutions and graders are beside the package
    if "COURSE_CONTENT" in os.environ:
        folders.add(Path(os.environ["COURSE_CONTENT"]).resolve())
    return {Path(os.path.realpath(folder)) for folder in folders} | folders


def _mapped_library_folders() -> set[Path]:
    """Folders of the shared libraries this interpreter itself runs on, wherever the system keeps them."""
    try:
        lines = Path("/proc/self/maps").read_text("utf-8", "replace").splitlines()
    except OSError:
        return set()
    files = {line.partition("/")[2] for line in lines if ".so" in line and "/" in line}
    own = {"libpython", "libc.so", "libm.so", "ld-linux", "libpthread", "libdl.so", "libstdc++", "libgcc_s"}
    paths = [Path("/" + name) for name in files]
    return {
        path.parent for path in paths if any(path.name.startswith(name) for name in own) and path.is_file()
    }


def _entries(name: str) -> list[Path]:
    """The entries of site-packages that make up an importable package: itself and its bundled libraries."""
    import importlib.metadata  # takes long, and who only cleans up does without

    try:
        distributions = [importlib.metadata.distribution(name)]  # the common case, and cheap to look up
    except importlib.metadata.PackageNotFoundError:
        named = importlib.metadata.packages_distributions().get(name, [])
        distributions = [importlib.metadata.distribution(distribution) for distribution in named]
    if not distributions:
        raise IsolationError(f"the package {name!r}, which the exercise declares, is not installed")
    entries: set[Path] = set()
    for distribution in distributions:
        tops = {file.parts[0] for file in distribution.files or [] if file.parts}
        root = Path(str(distribution.locate_file("")))
        entries |= {root / top for top in tops - {"..", "__pycache__"}}
    return sorted(entry for entry in entries if entry.exists())
