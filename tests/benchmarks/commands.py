"""How soon the terminal answers: `course --help` against a bare program, and a save under `course watch`.

    python tests/benchmarks/commands.py

Run it with the Python of an environment the course is installed in. The two sides of each figure alternate.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "100"}

BARE = """
import typer
app = typer.Typer()
@app.command()
def hello(name: str = "you") -> None:
    '''Say hello.'''
@app.command()
def bye(name: str = "you") -> None:
    '''Say goodbye.'''
app()
"""


def seconds(command: list[str]) -> float:
    start = time.perf_counter()
    subprocess.run(command, env={**ENVIRONMENT, "FORCE_COLOR": "1"}, stdout=subprocess.DEVNULL, check=True)
    return time.perf_counter() - start


def help_page() -> None:
    """Both programs print their help in full colour, which is what makes typer load rich."""
    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        bare = Path(folder) / "bare.py"
        bare.write_text(BARE, "utf-8")
        for _ in range(20):
            ours = seconds([sys.executable, "-m", "course", "--help"])
            theirs = seconds([sys.executable, str(bare), "--help"])
            ratios.append(ours / theirs)
    ratio = statistics.median(ratios)
    print(f"course --help against a bare typer and rich program: median ratio {ratio:.2f} (target 1.5)")


def watch(rounds: int = 12) -> None:
    """From the save to the verdict on the screen, less what the checks themselves took."""
    run = [sys.executable, "-m", "course"]
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "mine"
        subprocess.run([*run, "init", str(place)], env=ENVIRONMENT, stdout=subprocess.DEVNULL, check=True)
        inside = [*run, "-C", str(place)]
        subprocess.run(
            [*inside, "start", "integrators"], env=ENVIRONMENT, stdout=subprocess.DEVNULL, check=True
        )
        module = place / "integrators" / "integrators.py"
        solution = (ROOT / "solutions" / "integrators" / "integrators.py").read_text("utf-8")
        process = subprocess.Popen(
            [*inside, "watch", "integrators", "--plain"], env=ENVIRONMENT, stdout=subprocess.PIPE, text=True
        )
        assert process.stdout is not None
        _until(process, "Score")
        extra = []
        for number in range(rounds):
            time.sleep(0.5)
            start = time.perf_counter()
            module.write_text(solution + f"# {number}\n", "utf-8")
            _until(process, "Score")
            elapsed = time.perf_counter() - start
            extra.append(elapsed - _checks_s(inside))
        process.terminate()
        process.wait()
    beyond = statistics.median(extra)
    print(f"watch, save to verdict beyond the checks' own time: median {beyond:.3f} s (target 0.25)")


def _until(process: subprocess.Popen[str], word: str) -> None:
    assert process.stdout is not None
    for line in process.stdout:
        if word in line:
            return
    raise SystemExit("course watch ended")


def _checks_s(inside: list[str]) -> float:
    """What the checks take, as the checks report it."""
    command = [*inside, "check", "integrators", "--json"]
    done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, check=False)
    return sum(check["duration_ms"] for check in json.loads(done.stdout)["checks"]) / 1e3


if __name__ == "__main__":
    help_page()
    watch()
