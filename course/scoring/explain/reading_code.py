"""What a function's own text shows, whatever it is called with: sentences that no number is needed for."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from course.scoring.explain.fingerprint import functions_of
from course.scoring.explain.story import Diagnosis
from course.scoring.verdict import Places

#: A loop that its own ``return`` ends in the first pass.
RETURN_IN_LOOP = "RETURN_IN_LOOP"


def return_in_a_loop(source: bytes, task: str, places: Places) -> Diagnosis | None:
    """A ``for`` loop of the task's function, or of a helper of it, that cannot have a second pass."""
    for function in functions_of(source, task):
        for loop in ast.walk(function):
            if isinstance(loop, ast.For) and isinstance(loop.body[-1], ast.Return) and not _goes_on(loop):
                line = places.phrase(loop.body[-1].lineno)
                return Diagnosis(
                    RETURN_IN_LOOP,
                    f"The `return` {line} stands inside the loop, so the loop ends in its first pass.",
                    "Move that `return` out of the loop: indent it as far as the `for`.",
                )
    return None


def _goes_on(loop: ast.For) -> bool:
    """Whether a ``continue`` of its own takes the loop past its last line."""
    return any(isinstance(part, ast.Continue) for part in ast.walk(loop))


def why_none(source: bytes, task: str, places: Places, name: str = "") -> str:
    """The advice where a function gives None instead of a value; "" if its text does not tell more.

    Args:
        name: what is None, as the finding calls it: the result, or an entry of the dict that is returned.
    """
    function = next(iter(functions_of(source, task)), None)
    if function is None:
        return ""
    own = list(_own(function))
    given = [part for part in own if isinstance(part, ast.Return) and _is_value(part.value)]
    if several := _several([part.value for part in given], name):
        return f"{several}, and `{name}` is None. Which line should have set it?"
    if given:
        tests = [
            part for part in own if isinstance(part, ast.If) and any(one in ast.walk(part) for one in given)
        ]
        if not tests or function.body[-1] in given:  # it does not end without a `return`
            what = f"`{name}`" if name.isidentifier() else "what it gives"
            return f"There is a `return`, and {what} is None here. Which line should have set it?"
        where = places.phrase(tests[-1].lineno)
        return f"There is a `return`. Was the condition {where} never met for this input?"
    if any(isinstance(part, ast.Call) and getattr(part.func, "id", "") == "print" for part in own):
        return "It prints its result. Give it back: write `return` where `print` stands."
    return ""


def _several(returned: list[ast.expr | None], name: str) -> str:
    """That there are other values beside the one called ``name``; "" if a ``return`` shows none."""
    if any(
        isinstance(key, ast.Constant) and key.value == name
        for value in returned
        if isinstance(value, ast.Dict)
        for key in value.keys
    ):
        return "A dict is returned"
    beside = name.isidentifier() and any(isinstance(value, ast.Tuple) for value in returned)
    return "Several values are returned" if beside else ""


def _own(function: ast.FunctionDef) -> Iterator[ast.AST]:
    """The parts of a function that belong to no function inside it."""
    left: list[ast.AST] = list(function.body)
    while left:
        part = left.pop(0)
        yield part
        if not isinstance(part, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda | ast.ClassDef):
            left += ast.iter_child_nodes(part)


def _is_value(value: ast.expr | None) -> bool:
    return value is not None and not (isinstance(value, ast.Constant) and value.value is None)


def names_of(source: bytes, task: str) -> tuple[str, ...]:
    """The names of a function's arguments, in order."""
    function = next(iter(functions_of(source, task)), None)
    return tuple(arg.arg for arg in function.args.args) if function else ()
