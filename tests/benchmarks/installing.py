"""What a wheel takes to install: a fresh environment for each extra, by pip and by uv.

    python tests/benchmarks/installing.py dist/*.whl base notebook --python python3.13

Packages leave out what the environment itself brings (pip, setuptools). Sizes are those of the files, without
the bytecode that pip writes and uv does not. Seconds depend on the network and on what is cached.
"""

import argparse
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

OWN = {"pip", "setuptools", "_distutils_hack", "pkg_resources", "_virtualenv", "wheel"}


def main() -> None:
    """Measure and print one row for each environment."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("wheel", type=Path)
    parser.add_argument("extras", nargs="*", default=["base"], help='"base" is no extra')
    parser.add_argument("--python", action="append", help="an interpreter; this one if left out")
    options = parser.parse_args()
    tools = ["pip", *(["uv"] if shutil.which("uv") else [])]
    print(f"{'interpreter':40} {'extra':12} tool  packages     MB   on disk  with bytecode      s")
    for python in options.python or [sys.executable]:
        for extra in options.extras:
            for tool in tools:
                with tempfile.TemporaryDirectory(prefix="installing-") as folder:
                    wanted = str(options.wheel) + ("" if extra == "base" else f"[{extra}]")
                    seconds = install(tool, python, wanted, Path(folder))
                    packages, files, disk, everything = measured(Path(folder))
                sizes = f"{files:6.0f} {disk:9.0f} {everything:14.0f}"
                print(f"{python:40} {extra:12} {tool:4} {packages:9} {sizes} {seconds:6.0f}", flush=True)


def install(tool: str, python: str, wanted: str, folder: Path) -> float:
    """Make an environment with what is wanted; how long that took, in s."""
    begin = time.perf_counter()
    if tool == "uv":
        subprocess.run(["uv", "venv", "--quiet", "--python", python, folder], check=True)
        # Copies, or what is shared with uv's cache would cost nothing.
        command = ["uv", "pip", "install", "--quiet", "--link-mode", "copy", "--python", folder]
    else:
        subprocess.run([python, "-m", "venv", folder], check=True)
        inside = folder / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")
        command = [str(inside), "-m", "pip", "install", "--quiet"]
    subprocess.run([*map(str, command), wanted], check=True)
    return time.perf_counter() - begin


def measured(folder: Path) -> tuple[int, float, float, float]:
    """Packages; MB of their files, of the blocks that these take, and of those with bytecode."""
    site = next(path for path in folder.rglob("site-packages") if not path.is_symlink())
    packages = [path for path in site.glob("*.dist-info") if path.name.partition("-")[0] not in OWN]
    files = blocks = everything = 0
    for path in site.rglob("*"):
        if not path.is_file() or path.relative_to(site).parts[0].partition("-")[0] in OWN:
            continue
        status = path.stat()
        taken = getattr(status, "st_blocks", status.st_size // 512) * 512
        everything += taken
        if path.suffix != ".pyc":
            files += status.st_size
            blocks += taken
    return len(packages), files / 1e6, blocks / 1e6, everything / 1e6


if __name__ == "__main__":
    main()
