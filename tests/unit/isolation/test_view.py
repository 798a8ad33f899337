"""What a submission may read: the interpreter and declared packages, whatever links lead elsewhere."""

import os
import sys
from pathlib import Path

import numpy as np
import pytest

import course
from course.isolation import launch
from course.isolation.failures import IsolationError
from course.isolation.launch import View, view_for


def _view(readable, masked):
    return View(Path(sys.executable), Path(sys.prefix), tuple(readable), tuple(masked), ())


def _readable_under(paths, target):
    """As Landlock decides: whether a listed path, links followed, is the target or above it."""
    real = Path(os.path.realpath(target))
    return any(real.is_relative_to(os.path.realpath(path)) for path in paths)


@pytest.fixture
def tree(tmp_path):
    """usr/lib holds a package folder to be masked; lib is a link to it, as on merged systems."""
    packages = tmp_path / "usr" / "lib" / "python3" / "dist-packages"
    packages.mkdir(parents=True)
    (packages / "secret.py").write_text("secret", "utf-8")
    (tmp_path / "usr" / "lib" / "libc.so").write_text("", "utf-8")
    (tmp_path / "usr" / "lib" / "python3" / "os.py").write_text("", "utf-8")
    (tmp_path / "lib").symlink_to("usr/lib")
    return tmp_path


@pytest.mark.parametrize("top", ["usr/lib", "lib"], ids=["a folder", "a link to a folder"])
@pytest.mark.parametrize("links", [False, True], ids=["as it is", "with links inside"])
def test_expanding_leaves_out_what_is_masked_and_keeps_the_rest(tree, top, links):
    lib = tree / "usr" / "lib"
    if links:
        (lib / "shortcut").symlink_to("python3/dist-packages")
        (lib / "file").symlink_to("python3/dist-packages/secret.py")
        (lib / "around").symlink_to("..")
        (lib / "python3" / "up").symlink_to(lib)
    paths = _view([tree / top], [lib / "python3" / "dist-packages"]).expanded()
    assert not _readable_under(paths, lib / "python3" / "dist-packages" / "secret.py")
    assert _readable_under(paths, lib / "python3" / "os.py")
    assert _readable_under(paths, lib / "libc.so")


def test_a_readable_path_inside_a_masked_one_is_not_listed(tree):
    lib = tree / "usr" / "lib"
    assert _view([lib / "python3" / "dist-packages"], [lib / "python3"]).expanded() == []


def test_this_course_and_its_neighbours_are_not_readable():
    found = view_for(("numpy",))
    package = Path(course.__file__).parent
    allowed = found.expanded()
    for secret in (package / "grading" / "kit.py", package.parent / "solutions", Path(pytest.__file__)):
        assert not _readable_under(allowed, secret), secret
    assert _readable_under(allowed, Path(os.__file__))
    assert _readable_under(allowed, Path(np.__file__))


def test_a_course_chosen_by_the_environment_is_masked(tree, monkeypatch):
    chosen = tree / "usr" / "lib" / "course-content"
    (chosen / "solutions").mkdir(parents=True)
    monkeypatch.setenv("COURSE_CONTENT", str(chosen))
    monkeypatch.setattr(launch, "_SYSTEM", (str(tree / "usr" / "lib"),))
    found = view_for(("numpy",))
    assert chosen in found.masked
    assert not _readable_under(found.expanded(), chosen / "solutions")


def test_a_package_that_is_not_installed_is_our_error():
    with pytest.raises(IsolationError, match="no_such_package"):
        view_for(("no_such_package",))
