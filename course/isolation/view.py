"""The files that a student's code may read: the interpreter, the system's libraries and declared packages.

One description serves both mechanisms: bubblewrap binds ``readable`` into an otherwise empty root and covers
``masked`` with empty folders; Landlock, which cannot subtract, gets the list from ``expanded``.
"""

from __future__ import annotations

import importlib.metadata
import os
import site
import sys
import sysconfig
from dataclasses import dataclass
from pathlib import Path

from course.isolation.failures import IsolationError

__all__ = ["View", "view_for"]

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
        readable: files and folders.
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
    return [
        path for child in children if not _leads_around(child, masked) for path in _without(child, masked)
    ]


def _leads_around(path: Path, masked: tuple[Path, ...]) -> bool:
    """Whether it is a link to a folder with something masked in it: following those might never end."""
    return path.is_symlink() and any(mask.is_relative_to(os.path.realpath(path)) for mask in masked)


def view_for(imports: tuple[str, ...]) -> View:
    """The view of a worker whose exercise declares ``imports``.

    Raises:
        IsolationError: a declared package is not installed here.
    """
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
