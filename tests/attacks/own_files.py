"""Reads the files and arguments that its own process was started with."""

import ctypes
import sys

count, values = ctypes.c_int(), ctypes.POINTER(ctypes.c_wchar_p)()
ctypes.pythonapi.Py_GetArgcArgv(ctypes.byref(count), ctypes.byref(values))
print([values[k] for k in range(count.value)])
for name, module in list(sys.modules.items()):
    if name in ("worker", "wire", "systems", "lockdown", "__main__"):
        print(name, {k: str(v)[:80] for k, v in list(vars(module).items())[:200]})
