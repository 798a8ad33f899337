"""Writes bytecode where the next interpreter would load it from."""

import importlib.util
import os
import py_compile

with open("course_attack_source.py", "w") as handle:
    handle.write("print('poisoned')")
for module in (np, os):
    cached = importlib.util.cache_from_source(module.__file__)
    try:
        os.close(os.open(cached, os.O_WRONLY))  # opened only: if this works, nothing must come of it
        print("FILE-CANARY" + "-7f3a: could write to", cached)
    except OSError:
        pass
    try:
        target = os.path.join(os.path.dirname(cached), "course_attack.pyc")
        py_compile.compile("course_attack_source.py", cfile=target, doraise=True)
    except (OSError, py_compile.PyCompileError):
        pass
