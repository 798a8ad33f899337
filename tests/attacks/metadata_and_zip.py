"""Looks for the course through package metadata and a zip of its own."""

import importlib.metadata
import sys
import zipfile

for name in ("physics-sim-course", "course", "pytest"):
    try:
        for file in importlib.metadata.files(name) or []:
            if file.name == "checks.py" or "integrators" in file.name:
                print(file.read_text())
        print("FILE-CANARY" + "-7f3a: metadata of", name)
    except importlib.metadata.PackageNotFoundError:
        pass
with zipfile.ZipFile("course_attack.zip", "w") as archive:
    archive.writestr("course/__init__.py", "")
    archive.writestr("course/physics.py", "SECRET = 1")
sys.path.insert(0, "course_attack.zip")
