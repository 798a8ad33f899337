"""Limits imports to the standard library, the submission's own files and packages its exercise declares.

This runs in the student's process and is no protection by itself: at L3 and L2 the files of other packages
cannot be read at all. It gives a clear message instead of a bare ModuleNotFoundError, and lets the rest of a
file work.
"""

from __future__ import annotations

import ast
import importlib.machinery
import itertools
import math
import opcode
import sys
import types
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

_BINARY = ("add", "sub", "mul", "matmul", "truediv", "floordiv", "mod", "divmod", "pow", "and", "or", "xor")
_UNPACK = opcode.opmap["UNPACK_SEQUENCE"]


class ImportNotDeclaredError(ImportError):
    """A submission imports a package that its exercise does not declare."""


class StandIn(types.ModuleType):
    """A stand-in for a package that a submission may not import, if it imports it at its top level.

    It stands for whatever is imported from there too. While the submission loads, it silently accepts any
    use, so that a plot at the end of a file costs nothing. After that every use raises: only the tasks that
    need the package fail.
    """

    loading = True

    def __init__(self, name: str, allowed: str) -> None:
        super().__init__(name)
        self._allowed = allowed

    def __getattr__(self, name: str) -> StandIn:
        if name.startswith("__"):
            raise AttributeError(name)
        self._use()
        return self

    def __call__(self, *_args: Any, **_kwargs: Any) -> StandIn:
        self._use()
        return self

    __getitem__ = __enter__ = __call__

    def __setitem__(self, _key: Any, _value: Any) -> None:
        self._use()

    def __exit__(self, *_error: object) -> None:
        self._use()

    def __iter__(self) -> Iterator[StandIn]:
        """As many as ``figure, axes = plt.subplots()`` wants; in a loop none."""
        self._use()
        caller = sys._getframe(1)
        operation, argument = caller.f_code.co_code[caller.f_lasti : caller.f_lasti + 2]
        return itertools.repeat(self, argument if operation == _UNPACK else 0)

    def __float__(self) -> float:
        self._use()
        return math.nan

    def __index__(self) -> int:
        self._use()
        return 0

    def _use(self) -> None:
        if not StandIn.loading:
            raise _not_declared(self.__name__.partition(".")[0], self._allowed)


# Operators are looked up on the class, so __getattr__ does not see them: a constant is used by them alone.
for _operator in (
    *(f"__{side}{name}__" for name in _BINARY for side in ("", "r", "i")),
    *("__neg__", "__pos__", "__abs__", "__invert__", "__lt__", "__le__", "__gt__", "__ge__", "__round__"),
    # numpy asks for these two, in its ufuncs and in its functions.
    *("__array_ufunc__", "__array_function__"),
):
    setattr(StandIn, _operator, StandIn.__call__)


def _not_declared(package: str, allowed: str) -> ImportNotDeclaredError:
    return ImportNotDeclaredError(
        f"this exercise does not allow importing {package!r} (allowed: the standard library, {allowed})",
        name=package,
    )


class Imports:
    """Refuses top-level packages that are neither the standard library's nor allowed; of these the
    sentence names the ``declared`` ones, as the others are files of the submission."""

    def __init__(self, allowed: frozenset[str], declared: frozenset[str]) -> None:
        self._allowed = allowed
        self._declared = ", ".join(sorted(declared)) or "none"
        self._replaced: set[str] = set()

    def stand_in(self, node: ast.stmt) -> bool:
        """Let a file load although this statement of it imports other packages; whether it may.

        Only an import at the top level: one inside a ``try`` has an alternative, and one in a function
        concerns only that function. Nothing can stand for whatever a star import would bring.
        """
        match node:
            case ast.Import(names=names):
                tops = {alias.name.partition(".")[0] for alias in names}
            case ast.ImportFrom(module=str() as module, names=[ast.alias(name=name), *_], level=0):
                tops = {module.partition(".")[0]} if name != "*" else set()
            case _:
                tops = set()
        new = tops - self._replaced
        self._replaced |= new
        return bool(new)

    def find_spec(self, name: str, _path: Any = None, _target: Any = None) -> Any:
        top = name.partition(".")[0]
        if top in self._allowed or top in sys.stdlib_module_names:
            return None
        if top in self._replaced:
            loader: Any = self
            return importlib.machinery.ModuleSpec(name, loader, is_package=True)
        raise _not_declared(top, self._declared)

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> StandIn:
        return StandIn(spec.name, self._declared)

    def exec_module(self, module: types.ModuleType) -> None:
        """A stand-in has nothing to run."""
