"""What a task with a failed check of ``sim-to-real`` is asked besides: nothing.

Right plans, excitations, estimates and gains differ from each other by more than many wrong ones do from
right ones, so no answer tells a program. The checks execute what they are given, and the probes compare it
with the carts, which they know.
"""

from __future__ import annotations

from typing import Any

QUESTIONS: dict[str, list[tuple[Any, ...]]] = {
    "plan": [],
    "design_excitation": [],
    "identify": [],
    "tune": [],
}
