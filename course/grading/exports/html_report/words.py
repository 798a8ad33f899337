"""Times and lateness in words."""

from __future__ import annotations

__all__ = ["in_days", "when"]


def when(iso: str) -> str:
    """A UTC time as a person reads it: "2026-12-01 23:59 UTC"."""
    return f"{iso[:10]} {iso[11:16]} UTC" if len(iso) >= 16 else iso


def in_days(seconds: float) -> str:
    """A lateness in words, down to the minute."""
    days, rest = divmod(int(seconds), 86_400)
    hours, minutes = rest // 3600, rest % 3600 // 60
    parts = [f"{days} d"] * bool(days) + [f"{hours} h"] * bool(hours) + [f"{minutes} min"] * (not days)
    return " ".join(parts)
