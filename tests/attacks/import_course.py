"""Imports the course, its graders and its solutions by every name."""

import importlib

found = []
for name in (
    "course.physics.integrators", "course.scoring.kit", "course.isolation.session", "course.catalog.locate",
    "solutions.arena.arena", "tests.attacks.arena.solutions.arena.arena", "graders.arena.checks", "conftest",
):
    try:
        found.append(importlib.import_module(name))
    except BaseException:
        pass
if found:
    print("FILE-CANARY" + "-7f3a: imported", found)
