"""Reading what a student's function returned, which may be any plain value at all.

Each ``as_...`` returns the value in the shape that a check can use, or raises ``CheckFailed`` with a finding
that says what came instead. A wrong type, a wrong shape or None is the student's mistake and never an
exception in the grader. NaN and infinity are passed on: the check compares them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from course.isolation.inside.wire import MAX_VALUES
from course.printable import one_line
from course.scoring.failures import CheckFailed
from course.scoring.verdict import Finding

Array = NDArray[np.float64]

_SHOWN = 24  # numbers of an array that a finding shows
#: Verdicts are sent and stored with signed integers of 64 bits.
_STORED_BITS = 63
#: Beyond this a square overflows, so that sums of squares, energies and errors do.
_HUGE = 1e150


@dataclass(frozen=True, slots=True)
class Inspected:
    """The result of a call and its effect on the arguments.

    Attributes:
        value: the returned value.
        args_after: the arguments as they were after the call.
        shared: True if a returned array shares memory with an argument.
    """

    value: Any
    args_after: list[Any]
    shared: bool


def as_number(value: Any, name: str = "the result") -> float:
    """One real number; a zero-dimensional array counts, a list of one number does not."""
    if type(value) is float:  # nearly always
        return value
    if isinstance(value, np.ndarray) and value.ndim == 0 and value.dtype.kind in "fiu":
        value = value.item()
    if isinstance(value, bool) or not isinstance(value, int | float | np.integer | np.floating):
        _refuse(value, name, "a number")
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def as_integer(value: Any, name: str = "the result") -> int:
    """One whole number; 4.0 counts as 4."""
    number = as_number(value, name)
    if not number.is_integer():
        _refuse(value, name, "a whole number")
    return int(number)


def as_bool(value: Any, name: str = "the result") -> bool:
    """True or False; neither 1 nor "yes"."""
    if isinstance(value, np.ndarray) and value.ndim == 0 and value.dtype.kind == "b":
        value = value.item()
    if not isinstance(value, bool | np.bool_):
        _refuse(value, name, "True or False")
    return bool(value)


def as_text(value: Any, name: str = "the result") -> str:
    """A str."""
    if not isinstance(value, str):
        _refuse(value, name, "a str")
    return value


def as_list(value: Any, name: str = "the result", length: int | None = None) -> list[Any]:
    """A list or tuple (or the rows of an array), of the given length if one is given."""
    if isinstance(value, np.ndarray):
        if not value.ndim:
            _refuse_shape(value, name, "(n, ...)")
    elif not isinstance(value, list | tuple):
        _refuse(value, name, "a list", "a list" if length is None else f"a list of {length}")
    if len(value) > MAX_VALUES or (length is not None and len(value) != length):
        _fail(
            f"{_capital(name)} has the wrong length.",
            "Print its `len` and compare it with what the README asks for.",
            "WRONG_TYPE",
            "a shorter list" if length is None else f"a list of {length}",
            plain(value),
        )
    return list(value)


def as_array(value: Any, shape: Sequence[int | None], name: str = "the result") -> Array:
    """Real numbers of this shape; None in ``shape`` stands for any length. Nested lists count."""
    array = _real(value)
    if array is None:
        _refuse(value, name, "an array of numbers", f"numbers of shape {_spelled(shape)}")
    if array.shape != tuple(shape) and (
        array.ndim != len(shape) or any(w not in (None, n) for w, n in zip(shape, array.shape, strict=True))
    ):
        _refuse_shape(array, name, _spelled(shape))
    return array


def _refuse_shape(array: Array, name: str, wanted: str) -> NoReturn:
    message = f"{_capital(name)} {'has the wrong shape' if array.ndim else 'is a single number'}."
    advice = "Make it a list or an array: [x, v], or [x] where there is only one number."
    if array.ndim:
        advice = "Print its `numpy.shape` and compare it with what was expected."
    _fail(message, advice, "WRONG_SHAPE", f"shape {wanted}", f"shape {array.shape}")


def _fail(message: str, advice: str, diagnosis: str, expected: Any, actual: Any) -> NoReturn:
    raise CheckFailed(Finding(message, advice, diagnosis, expected=expected, actual=actual))


def as_vector(value: Any, d: int | None = None, name: str = "the result") -> Array:
    """Real numbers of shape (d,); of any length if d is None."""
    return as_array(value, (d,), name)


def as_matrix(value: Any, shape: tuple[int | None, int | None], name: str = "the result") -> Array:
    """Real numbers of shape (rows, columns)."""
    return as_array(value, shape, name)


def as_tuple(value: Any, names: Sequence[str]) -> list[Any]:
    """The results of a function that returns several: exactly as many as there are names."""
    wanted = f"({', '.join(names)})"
    if isinstance(value, np.ndarray) and value.shape[:1] == (len(names),):
        value = list(value)
    if not isinstance(value, list | tuple):
        _refuse(value, "the result", wanted)
    if len(value) != len(names):
        few = "too few" if len(value) < len(names) else "too many"
        message = f"The result has {few} parts: it should be {wanted}."
        advice = "Return exactly these, in this order, separated by commas."
        _fail(message, advice, "WRONG_TYPE", wanted, plain(value))
    return list(value)


def as_pair(value: Any, d: int, names: tuple[str, str] = ("q_next", "v_next")) -> tuple[Array, Array]:
    """Two vectors of shape (d,), as the steps return them."""
    first, second = as_tuple(value, names)
    return as_vector(first, d, names[0]), as_vector(second, d, names[1])


def as_record(value: Any, keys: Sequence[str], name: str = "the result") -> dict[str, Any]:
    """A dict with exactly these keys; a missing or an extra one is named."""
    if not isinstance(value, dict):
        _refuse(value, name, "a dict")
    missing = [key for key in keys if key not in value]
    extra = [str(key)[:80] for key in value if key not in keys]
    if missing or extra:
        parts = [f"lacks {', '.join(missing)}"] * bool(missing) + ["has unexpected keys"] * bool(extra)
        message = f"{_capital(name)} {' and '.join(parts)}."
        advice = f"Return a dict with exactly these keys: {', '.join(keys)}."
        _fail(message, advice, "WRONG_KEYS", list(keys), [str(key)[:80] for key in list(value)[:40]])
    return value


def as_march(result: Any, n: int, d: int) -> tuple[Array, Array]:
    """Positions and velocities of a march of n steps, each (n + 1, d), from what the worker said.

    The worker answers either the two arrays or ``{"bad": what came, "step": i}`` for a step that did not
    return two vectors of shape (d,).
    """
    if isinstance(result, dict) and "bad" in result:
        bad = str(result["bad"])[:200]
        expected = f"(q_next, v_next), each of shape ({d},)"
        if bad.startswith("NoneType"):
            _fail("Your step returned None.", _NO_RETURN, "RETURNS_NOTHING", expected, bad)
        advice = "Return two arrays as long as q: `return q_next, v_next`."
        _fail(_NOT_A_PAIR, advice, "NOT_A_PAIR", expected, bad)
    q, v = as_tuple(result, ("q", "v"))
    return as_array(q, (n + 1, d), "q"), as_array(v, (n + 1, d), "v")


def overwritten(name: str) -> CheckFailed:
    """The finding on a function whose later calls change what an earlier one returned."""
    advice = (
        "Make new arrays, lists and dicts in every call. One that is kept outside the function, or in a "
        "default argument, and filled again, is still in the hands of whoever called before."
    )
    message = f"A later call of `{name}` changed what an earlier call had returned."
    return CheckFailed(Finding(message, advice, "RESULT_OVERWRITTEN"))


def plain(value: Any, depth: int = 3) -> Any:  # noqa: PLR0911 - one return per kind of value
    """``value`` for a finding: numpy becomes lists and numbers, long values are cut, other objects named."""
    if isinstance(value, np.ndarray):
        few = math.prod(max(extent, 1) for extent in value.shape) <= _SHOWN  # an empty one may have many rows
        return plain(value.tolist(), value.ndim) if few else f"array of shape {value.shape}"
    if isinstance(value, np.longdouble | np.clongdouble):  # their item() is no Python number
        value = complex(value) if isinstance(value, np.clongdouble) else float(value)
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, dict | list | tuple) and depth == 0:
        return f"({type(value).__name__} of {len(value)})"
    if isinstance(value, dict):
        shown = list(value.items())[:_SHOWN]
        return {one_line(str(plain(key)), 80): plain(item, depth - 1) for key, item in shown}
    if isinstance(value, list | tuple):
        more = [f"… {len(value) - _SHOWN} more"] if len(value) > _SHOWN else []
        return [plain(item, depth - 1) for item in value[:_SHOWN]] + more
    if isinstance(value, int) and not isinstance(value, bool) and value.bit_length() > _STORED_BITS:
        return f"(a whole number of {value.bit_length()} bits)"
    if value is None or isinstance(value, bool | int | float):
        return value
    text = str(value) if isinstance(value, str | complex) else f"({type(value).__name__})"
    return one_line(text, 200)


def kind_of(value: Any) -> str:
    """The kind of a value and anything unusual in it, in words that reveal nothing of its content."""
    odd = sorted({name for item in leaves(value) if (name := _oddity(item))})
    within = f" with {' and '.join(odd)} in it" if odd else ""
    if isinstance(value, int | float | np.generic) and not isinstance(value, bool) and odd:
        return odd[0]
    return _kind(value) + ("" if value is None else within)


def leaves(value: Any, depth: int = 6) -> Iterator[Any]:
    """Up to a few thousand of the plain values in it."""
    if isinstance(value, np.ndarray):
        value = value.ravel()[:4096].tolist()
    if isinstance(value, list | tuple | dict) and depth:
        for item in list(value.values() if isinstance(value, dict) else value)[:4096]:
            yield from leaves(item, depth - 1)
    else:
        yield value


def _oddity(item: Any) -> str:
    """The unusual properties of one plain value; empty if there are none."""
    if isinstance(item, float):
        if math.isnan(item):
            return "nan"
        return "infinite numbers" if math.isinf(item) else "huge numbers" if abs(item) > _HUGE else ""
    if isinstance(item, int) and item.bit_length() > _STORED_BITS:
        return "huge numbers"
    return {type(None): "None", str: "text", complex: "complex numbers"}.get(type(item), "")


def _real(value: Any) -> Array | None:
    """``value`` as a float array, or None if it is not real numbers of one regular shape."""
    if type(value) is np.ndarray and value.dtype.kind == "f":  # nearly always
        return value.astype(float)
    if not _is_numeric(value) or isinstance(value, bool):
        return None
    try:
        array = np.asarray(value)
    except ValueError:  # ragged lists
        return None
    if array.size == 0 and array.dtype == object:
        return None
    return array.astype(float) if array.dtype.kind in "fiu" else None


def _is_numeric(value: Any) -> bool:
    """Whether it is made of numbers; of text numpy would make an array as wide as the longest, throughout."""
    if isinstance(value, list | tuple):
        return all(map(_is_numeric, value))
    return isinstance(value, np.ndarray | int | float)


def _spelled(shape: Sequence[int | None]) -> str:
    """A shape as Python prints one, with N for any length."""
    lengths = ", ".join("N" if n is None else str(n) for n in shape)
    return f"({lengths},)" if len(shape) == 1 else f"({lengths})"


def _refuse(value: Any, name: str, wanted: str, expected: str = "") -> NoReturn:
    """Fail because ``value`` is not ``wanted``; a wanted size appears only in ``expected``."""
    message = f"{_capital(name)} is {_kind(value)}, not {wanted}."
    advice = _NO_RETURN if value is None else _advice(value, wanted)
    diagnosis = "RETURNS_NOTHING" if value is None else "WRONG_TYPE"
    _fail(message, advice, diagnosis, expected or wanted, plain(value))


def _advice(value: Any, wanted: str) -> str:
    if any(isinstance(item, complex) for item in leaves(value)):
        return "A fractional power of a negative number is complex in Python: test its sign before."
    if wanted == "a number" and isinstance(value, list | tuple | np.ndarray):
        return "Return one plain number: no brackets around it, and no array, not even of one element."
    if wanted.startswith("an array of numbers") and isinstance(value, list | tuple):
        return "Every element must be a number, and all rows equally long: is there a None, or text, in it?"
    return "The README says what to return, and what each part is."


def _kind(value: Any) -> str:
    """The kind of a value, in words that reveal nothing of its content."""
    if isinstance(value, complex | np.ndarray) and np.iscomplexobj(value):
        return "an array of complex numbers" if np.ndim(value) else "a complex number"
    return _KINDS.get(type(value), "something else")


_KINDS = {
    type(None): "None",
    bool: "True or False",
    int: "a number",
    float: "a number",
    str: "a str",
    # A tuple comes out of the student's process as a list.
    list: "a list or a tuple",
    tuple: "a list or a tuple",
    dict: "a dict",
    np.ndarray: "an array",
}


def _capital(name: str) -> str:
    return name[:1].upper() + name[1:] if name.startswith("the ") else f"`{name}`"


_NOT_A_PAIR = "Your step does not return two arrays of the same shape as q and v."
_NO_RETURN = "Is a `return` missing? A function without one gives None."
