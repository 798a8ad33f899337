"""Swaps the modules beside it for its own."""

import sys
import types

for name in list(sys.modules):
    if name.rpartition(".")[2] in ("worker", "wire", "systems", "lockdown", "zygote", "__main__", "socket"):
        sys.modules[name] = types.ModuleType(name)
