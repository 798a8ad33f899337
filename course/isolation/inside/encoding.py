"""Values to bytes: one function per type, found by the exact type of a value."""

from __future__ import annotations

import struct
from array import array
from typing import TYPE_CHECKING, Any

import numpy as np

from .frames import (
    DTYPES,
    F64,
    FLOAT64,
    I64,
    MAX_DEPTH,
    MAX_DIMENSIONS,
    RHS_DEPTH,
    SHAPE,
    TABLE,
    U32,
    Reference,
    Rhs,
    Seed,
    UnsupportedValueError,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from .frames import Names

    Parts = list[bytes | memoryview]

_PLAIN_LISTS = frozenset((list, tuple))
_FLOATS = frozenset((float, np.float64))
#: Arrays from this size on are not copied before the frame is put together, bytes.
_LARGE = 1 << 14
_WIDEN = {"f": 0, "i": 1, "u": 1, "b": 2, "c": 3}


def put(value: Any, parts: Parts, names: Names | None, depth: int) -> int:
    """Append the encoding of ``value`` to ``parts``; returns how many bytes of it are array data."""
    return _PUT.get(type(value), _put_other)(value, parts, names, depth)


def _put_none(_value: None, parts: Parts, _names: Names | None, _depth: int) -> int:
    parts.append(b"N")
    return 0


def _put_bool(value: Any, parts: Parts, _names: Names | None, _depth: int) -> int:
    parts.append(b"T" if value else b"F")
    return 0


def _put_int(value: Any, parts: Parts, _names: Names | None, _depth: int) -> int:
    try:
        parts.append(b"i" + I64.pack(value))
    except struct.error:
        raise UnsupportedValueError("an integer beyond 64 bits") from None
    return 0


def _put_float(value: Any, parts: Parts, _names: Names | None, _depth: int) -> int:
    parts += (b"f", F64.pack(value))
    return 0


def _put_str(value: Any, parts: Parts, _names: Names | None, _depth: int) -> int:
    raw = value.encode("utf-8", "replace")
    parts.append(b"s" + U32.pack(len(raw)) + raw)
    return 0


def _put_bytes(value: bytes, parts: Parts, _names: Names | None, _depth: int) -> int:
    parts.append(b"y" + U32.pack(len(value)) + value)
    return len(value)


def _put_list(value: Any, parts: Parts, names: Names | None, depth: int) -> int:
    if depth <= 0:
        raise UnsupportedValueError(f"a value nested more than {MAX_DEPTH} deep")
    if value and type(value) in _PLAIN_LISTS:  # a relative may lie about what is in it
        first = type(value[0])
        if first in _FLOATS and _FLOATS.issuperset(map(type, value)):
            parts += (b"r", U32.pack(len(value)), array("d", value).tobytes())
            return 0
        if first is dict and len(value) > 1 and _are_records(value):
            return _put_records(value, parts, names, depth - 1)
    parts.append(b"l" + U32.pack(len(value)))
    arrays = 0
    for item in value:
        write = _PUT.get(type(item), _put_other)
        arrays += write(item, parts, names, depth - 1)
    return arrays


def _are_records(value: Any) -> bool:
    keys = list(value[0])
    return bool(keys) and all(type(item) is dict and list(item) == keys for item in value)


def _put_records(value: Any, parts: Parts, names: Names | None, depth: int) -> int:
    """Dicts with the same keys, each key's values as one list: the states of a simulation."""
    parts.append(b"t" + U32.pack(len(value[0])))
    arrays = 0
    for key in value[0]:
        _put_key(key, parts)
        arrays += _put_list([item[key] for item in value], parts, names, depth)
    return arrays


def _put_key(key: Any, parts: Parts) -> None:
    if not isinstance(key, str):
        raise UnsupportedValueError(f"a dict with a key that is not a str but {_name_of(key)}")
    raw = key.encode("utf-8", "replace")
    parts.append(U32.pack(len(raw)) + raw)


def _put_dict(value: Any, parts: Parts, names: Names | None, depth: int) -> int:
    if depth <= 0:
        raise UnsupportedValueError(f"a value nested more than {MAX_DEPTH} deep")
    parts.append(b"d" + U32.pack(len(value)))
    arrays = 0
    for key, item in value.items():
        _put_key(key, parts)
        arrays += put(item, parts, names, depth - 1)
    return arrays


def _put_array(value: Any, parts: Parts, _names: Names | None, _depth: int) -> int:
    if value.dtype is FLOAT64 and value.ndim == 1:  # what nearly every call and callback carries
        parts += (b"v", U32.pack(len(value)), _raw(value))
        return int(value.nbytes)
    if value.dtype is FLOAT64 and value.ndim == 2:
        parts += (b"a" + TABLE, SHAPE.pack(*value.shape), _raw(value))
        return int(value.nbytes)
    code = _WIDEN.get(value.dtype.kind)
    if code is None:
        raise UnsupportedValueError(f"an array of dtype {value.dtype}")
    if value.ndim > MAX_DIMENSIONS:
        raise UnsupportedValueError(f"an array of {value.ndim} dimensions")
    raw = value.astype(DTYPES[code], copy=False).tobytes()
    parts.append(b"a%c%c" % (code, value.ndim) + b"".join(map(U32.pack, value.shape)) + raw)
    return len(raw)


def _raw(value: Any) -> bytes | memoryview:
    return value.tobytes() if value.nbytes < _LARGE else np.ascontiguousarray(value).data.cast("B")


def _put_other(value: Any, parts: Parts, names: Names | None, depth: int) -> int:
    """Everything whose exact type has no entry: numpy scalars, subclasses, callables, strangers."""
    if isinstance(value, np.ndarray):
        return _put_array(np.asarray(value), parts, names, depth)
    if isinstance(value, np.generic):
        if value.dtype.kind not in _WIDEN:
            raise UnsupportedValueError(f"a numpy scalar of dtype {value.dtype}")
        if value.dtype.kind == "c":
            return _put_array(np.asarray(value), parts, names, depth)
        return put(value.item() if value.dtype.itemsize <= 8 else float(value), parts, names, depth)
    if isinstance(value, complex):
        return _put_array(np.asarray(complex(value)), parts, names, depth)
    for base, write in _BASES:
        if isinstance(value, base):
            return write(value, parts, names, depth)
    lowered = names.lower(value) if names is not None else None
    if isinstance(lowered, Reference):
        parts.append((b"c" if lowered.mine else b"w") + U32.pack(lowered.number))
    elif isinstance(lowered, Rhs):
        parts.append(b"p")
        _put_str(lowered.name, parts, None, 1)
        _put_dict(lowered.params, parts, None, min(depth, RHS_DEPTH))
    elif isinstance(lowered, Seed):
        parts.append(b"g" + I64.pack(lowered.value))
    else:
        raise UnsupportedValueError(f"a value of type {_name_of(value)}")
    return 0


def _name_of(value: Any) -> str:
    return str(type(value).__name__)[:80]


_PUT: dict[type, Callable[[Any, Parts, Names | None, int], int]] = {
    float: _put_float,
    np.float64: _put_float,
    np.ndarray: _put_array,
    int: _put_int,
    list: _put_list,
    tuple: _put_list,
    type(None): _put_none,
    bool: _put_bool,
    str: _put_str,
    dict: _put_dict,
    bytes: _put_bytes,
}
#: Subclasses arrive as the plain value they extend; bool before int, since every bool is an int.
_BASES: tuple[tuple[type, Callable[[Any, Parts, Names | None, int], int]], ...] = (
    (bool, _put_bool),
    (float, _put_float),
    (int, _put_int),
    (str, _put_str),
    (list, _put_list),
    (tuple, _put_list),
    (dict, _put_dict),
)
