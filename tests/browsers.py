"""The system's own Chromium, for tests of pages, and axe-core, which npm fetches."""

import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

CHROMIUM = os.environ.get("CHROMIUM") or next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)
FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
]  # fmt: skip
#: Its rules change with its version: a newer one is tried on purpose, not by accident.
_AXE = "axe-core@4.14.1"


def on_the_page(canvas: Any, view: Sequence[float], x: float, y: float) -> tuple[float, float]:
    """Where a place of a scene is on the page, whose canvas shows this view: left, bottom, right, top."""
    box = canvas.bounding_box()
    left, bottom, right, top = view
    scale = min(box["width"] / (right - left), box["height"] / (top - bottom))
    return (
        box["x"] + box["width"] / 2 + (x - (left + right) / 2) * scale,
        box["y"] + box["height"] / 2 - (y - (bottom + top) / 2) * scale,
    )


def axe_core(folder: Path) -> str:
    """The source of axe-core; skips the test that asks for it where it cannot be fetched."""
    npm = shutil.which("npm")
    if npm is None:
        pytest.skip("npm is missing: axe-core cannot be fetched")
    command = [npm, "install", "--no-audit", "--no-fund", "--ignore-scripts", "--prefix", str(folder), _AXE]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        pytest.skip(f"npm could not fetch axe-core: {done.stderr.strip()[-200:]}")
    return (folder / "node_modules" / "axe-core" / "axe.min.js").read_text("utf-8")
