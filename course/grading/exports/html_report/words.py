"""Times in words."""

from __future__ import annotations

__all__ = ["when"]


def when(iso: str) -> str:
    """A UTC time as a person reads it: "2026-12-01 23:59 UTC"."""
    return f"{iso[:10]} {iso[11:16]} UTC" if len(iso) >= 16 else iso
