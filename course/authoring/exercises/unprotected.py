"""A submission run in this process, with the interface that checks use and no protection.

It is only for the course's own programs: to find the diagnosis of every known wrong one, to calibrate checks,
and as the unprotected side of the benchmark. It reproduces what the boundary does to values (tuples become
lists, numpy scalars plain numbers, arrays are copied) so that a check cannot come to rely on something that
would not cross.
"""

from __future__ import annotations

import traceback
import types
from typing import TYPE_CHECKING, Any

import numpy as np

from course.isolation.inside import loops
from course.physics.systems import SYSTEMS
from course.scoring.failures import StudentFailure
from course.scoring.values import Inspected, as_march, overwritten

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["LocalSubmission"]

_SYSTEM_TYPES = tuple(SYSTEMS.values())
_FILE = "<submission>"


class LocalSubmission:
    """One student's module, loaded here.

    Args:
        source: text of the module.
        seed: seed of the grading run.
        replaced: functions to put in the place of the module's own, by name.
    """

    def __init__(self, source: str, seed: int = 0, replaced: Mapping[str, Any] | None = None) -> None:
        self.seed = seed
        self.returned: tuple[str, Any] | None = None
        self.asked: set[str] = set()
        self.marched = None
        self.faults, self.without = (), None
        self.used = 0.0
        self.heard: list[Any] = []
        self._module = types.ModuleType("submission")
        exec(compile(source, _FILE, "exec", dont_inherit=True), self._module.__dict__)
        self._module.__dict__.update(replaced or {})

    @property
    def functions(self) -> frozenset[str]:
        """Names of what can be called."""
        return frozenset(name for name, value in vars(self._module).items() if callable(value))

    def begin_check(self, task: str = "", patience: float | None = None) -> None:  # noqa: ARG002 - of the interface
        """Forget which functions the last check used; there is no deadline."""
        self.asked = set()

    def printed(self) -> str:
        """Empty: its output goes to this process's own."""
        return ""

    def close(self) -> None:
        """Nothing to end."""

    def call(self, name: str, *args: Any, **kwargs: Any) -> Any:
        """Call the student's function with copies of the arguments; its value as plain data."""
        return self._inspect(name, args, kwargs).value

    def call_inspect(self, name: str, *args: Any) -> Inspected:
        """Call it, and report its value and its arguments after the call."""
        return self._inspect(name, args, {})

    def call_each(self, name: str, calls: Any) -> list[Any]:
        """Call the student's function once for each sequence of arguments."""
        function = self._function(name)
        escaped: list[BaseException] = []
        given = [[_given(arg, escaped) for arg in args] for args in calls]
        values, changed = self._loop(lambda: loops.each(function, given), escaped)
        if changed is not None:
            raise overwritten(name)
        return [_plain(value) for value in values]

    def fold(self, name: str, state: Any, calls: Any, *, carry: int | None = None, keep: Any = None) -> Any:
        """Pass a state through the student's function."""
        function = self._function(name)
        escaped: list[BaseException] = []
        given = [[_given(arg, escaped) for arg in args] for args in calls]
        values, last = self._loop(lambda: loops.fold(function, _plain(state), given, carry, keep), escaped)
        return [_plain(value) for value in (values if keep is None else [*values[:-1], last])]

    def ref(self, name: str) -> Any:
        """The student's own function, to be passed back as an argument."""
        return self._function(name)

    def march(
        self, step_name: str, system: Any, q0: Any, v0: Any, h: float, n: int, t0: float = 0.0
    ) -> tuple[Any, Any, Any]:
        """n steps in a row; times (n + 1,), positions and velocities (n + 1, d)."""
        return self.march_each(step_name, [(system, q0, v0, h, n, t0)])[0]

    def march_each(self, step_name: str, marches: Any) -> list[tuple[Any, Any, Any]]:
        """Several marches, (system, q0, v0, h, n, t0) each."""
        return [self._march(step_name, *march) for march in marches]

    def _march(self, step_name: str, system: Any, q0: Any, v0: Any, h: float, n: int, t0: float) -> Any:
        step = self._function(step_name)
        q, v = as_march(_guarded(lambda: loops.march(step, system, q0, v0, t0, h, n)), n, len(q0))
        return t0 + h * np.arange(n + 1), q, v

    def _inspect(self, name: str, args: Any, kwargs: Any) -> Inspected:
        function = self._function(name)
        escaped: list[BaseException] = []
        given = [_given(arg, escaped) for arg in args]
        named = {key: _given(arg, escaped) for key, arg in kwargs.items()}
        value = self._loop(lambda: function(*given, **named), escaped)
        after = [
            None if callable(arg) or isinstance(arg, np.random.Generator | loops.Methods) else _plain(arg)
            for arg in given
        ]
        return Inspected(_plain(value), after, _shares(value, given))

    def _loop(self, loop: Any, escaped: list[BaseException]) -> Any:
        """The value of student code; a callback that refused its arguments is the finding."""
        try:
            result = _guarded(loop)
        except StudentFailure:
            if escaped:
                raise escaped[0] from None
            raise
        if escaped:
            raise escaped[0]
        return result

    def _function(self, name: str) -> Any:
        self.asked.add(name)
        function = getattr(self._module, name, None)
        if not callable(function):
            raise StudentFailure.missing(name)
        return function


def _guarded(fn: Any) -> Any:
    """``fn()``, with the student code's exceptions as StudentFailure."""
    try:
        with np.errstate(all="ignore"):
            return fn()
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        frames = [f for f in traceback.extract_tb(error.__traceback__) if f.filename == _FILE]
        raise StudentFailure(
            "error",
            type=type(error).__name__,
            message=str(error),
            line=frames[-1].lineno if frames else None,
            traceback="".join(traceback.format_list(frames)),
            bases=[cls.__name__ for cls in type(error).__mro__],
        ) from None


def _given(value: Any, escaped: list[BaseException]) -> Any:
    """An argument as student code gets it: arrays copied, tuples as lists, callbacks behind a wrapper."""
    if isinstance(value, dict) and value.keys() == {"$methods"}:
        return loops.Methods(**{name: _given(fn, escaped) for name, fn in value["$methods"].items()})
    if isinstance(value, np.random.Generator):  # crosses as a seed
        return np.random.default_rng(int(value.integers(2**62)))
    if isinstance(value, _SYSTEM_TYPES) or not callable(value):
        return _plain(value) if not isinstance(value, _SYSTEM_TYPES) else value

    def callback(*args: Any, **kwargs: Any) -> Any:
        try:
            return _plain(value(*map(_crossing, args), **{k: _crossing(a) for k, a in kwargs.items()}))
        except BaseException as error:  # noqa: BLE001 - whatever it is, the check raises it
            escaped.append(error)
            raise ValueError("the grader's function refused its arguments") from None

    callback.original = value  # type: ignore[attr-defined]
    return callback


def _crossing(value: Any) -> Any:
    """The form in which a value arrives at a callback; a callback that is passed back arrives unchanged."""
    return getattr(value, "original", value) if callable(value) else _plain(value)


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in "fiubc":
            raise StudentFailure("protocol", message=f"an array of dtype {value.dtype}")
        return np.array(value)
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if callable(value):
        return value
    raise StudentFailure("protocol", message=f"a value of type {type(value).__name__}")


def _arrays(value: Any) -> list[Any]:
    if isinstance(value, np.ndarray):
        return [value]
    if isinstance(value, list | tuple):
        return [array for item in value for array in _arrays(item)]
    return []


def _shares(value: Any, args: Any) -> bool:
    return any(np.may_share_memory(a, b) for a in _arrays(value) for b in _arrays(args))
