"""The system call filter allows what it lists and nothing else: read back as the kernel reads it."""

import os
import platform
import re
import struct
from pathlib import Path

import pytest

from course.isolation.inside import lockdown

_MACHINES = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}
_ALLOW, _EPERM, _ENOSYS, _KILL = 0x7FFF0000, 0x00050001, 0x00050026, 0x80000000


def _decide(program, arch, number, *arguments):
    """What the filter answers to a call; an interpreter of the few BPF instructions it is made of."""
    padded = (*arguments, 0, 0, 0, 0, 0, 0)[:6]
    data = struct.pack("=IIQ6Q", number & 0xFFFFFFFF, arch, 0, *(a & (1 << 64) - 1 for a in padded))
    instructions = list(struct.iter_unpack("=HBBI", program))
    accumulator, at = 0, 0
    while True:
        code, jump_true, jump_false, k = instructions[at]
        at += 1
        if code == 0x20:
            accumulator = struct.unpack_from("=I", data, k)[0]
        elif code == 0x45:
            at += jump_true if accumulator & k else jump_false
        elif code == 0x15:
            at += jump_true if accumulator == k else jump_false
        elif code == 0x35:
            at += jump_true if accumulator >= k else jump_false
        else:
            assert code == 0x06
            return k


@pytest.fixture(params=_MACHINES)
def machine(request):
    return str(request.param)


def _restricted(machine):
    column = list(_MACHINES).index(machine)
    return {name: entry[:2][column] for name, entry in lockdown._restricted().items()}


def test_every_listed_call_is_allowed_and_every_other_is_refused(machine):
    program, allowed = lockdown.seccomp_program(machine), set(lockdown.allowed_calls(machine).values())
    restricted = set(_restricted(machine).values())
    for number in range(600):
        # No call that depends on its arguments takes these.
        found = _decide(program, _MACHINES[machine], number, *[0xDEAD0D00] * 6)
        if number in allowed:
            assert found == _ALLOW, number
        elif number == 435:
            assert found == _ENOSYS
        else:
            assert found == _EPERM, number
    assert not restricted & allowed


def test_other_interfaces_to_the_kernel_are_deadly(machine):
    program = lockdown.seccomp_program(machine)
    for arch in (0x40000003, 0x40000028, 0xC000003E ^ 1, 0):  # i386, 32-bit arm, nonsense
        assert _decide(program, arch, 0) == _KILL
    for number in (0x40000000, 0x40000000 | 57, 0xFFFFFFFF):  # x32, and -1
        assert _decide(program, _MACHINES[machine], number) == _KILL


_FUTEX, _FUTEX_PRIVATE, _CPU_CLOCK_OF_1 = 0, 128, (~1 << 3) | 2
_POINTER = 0x7F12_0000_0000  # its lower half is 0: a filter that looks at 32 bits takes it for none
#: Arguments of calls that are allowed with these and refused with those.
_ALLOWED = {
    "fcntl": [(3, 3)],  # F_GETFL
    "ioctl": [(1, 0x5401)],  # is it a terminal?
    "tgkill": [(lockdown._OWN_PID, lockdown._OWN_PID, 6)],
    "sendto": [(3, 1, 5, 0, 0, 0), (3, 1, 5, 0x4000, 0, 0)],
    "recvfrom": [(3, 1, 5, 0, 0, 0)],
    "futex": [(1, op | _FUTEX_PRIVATE, 1) for op in (0, 1, 9, 10, 9 | 256)],
    "madvise": [(0, 4096, 4), (0, 4096, 14)],
    "clock_gettime": [(clock,) for clock in range(12)],
    "clock_getres": [(2,)],
    "clock_nanosleep": [(1, 0)],
    "sched_getaffinity": [(0,), (lockdown._OWN_PID,)],
}
_REFUSED = {
    # Locks, SETOWN, SETSIG, SETOWN_EX, leases, notify, pipe sizes, seals.
    "fcntl": [(3, command) for command in (5, 6, 7, 8, 10, 15, 36, 37, 38, 1024, 1026, 1031, 1033)],
    # Put a character, owners of a socket, console.
    "ioctl": [(1, request) for request in (0x5412, 0x8901, 0x8904, 0x541C)],
    "tgkill": [(1, 1, 9)],
    # Out of band, more to come, and addresses.
    "sendto": [(3, 1, 5, 1, 0, 0), (3, 1, 5, 0x8000, 0, 0), (3, 1, 5, 0, 1, 16), (3, 1, 5, 0, _POINTER, 16)],
    "recvfrom": [(3, 1, 5, 2, 0, 0)],  # MSG_PEEK
    "futex": [(1, op, 1) for op in (_FUTEX, 1, 3, 9, 10, 256)],
    "madvise": [
        (0, 4096, advice) for advice in (9, 12, 20, 21, 100)
    ],  # remove, merge, cold, page out, poison
    "clock_gettime": [(_CPU_CLOCK_OF_1,), (-1,), (12,)],
    "clock_getres": [(_CPU_CLOCK_OF_1,)],
    "clock_nanosleep": [(_CPU_CLOCK_OF_1, 0)],
    "sched_getaffinity": [(1,)],
}


@pytest.mark.parametrize("name", lockdown._restricted())
def test_restricted_calls_depend_on_their_argument(machine, name):
    program, arch, number = lockdown.seccomp_program(machine), _MACHINES[machine], _restricted(machine)[name]
    for arguments in _ALLOWED[name]:
        assert _decide(program, arch, number, *arguments) == _ALLOW, arguments
    for arguments in _REFUSED[name]:
        assert _decide(program, arch, number, *arguments) == _EPERM, arguments


_NEVER = {
    "fork", "clone", "execve", "socket", "ptrace", "kill", "prctl", "unshare", "mount",
    # By which one process would learn of another, or tell it.
    "sysinfo", "getpgid", "getsid", "getpriority", "get_robust_list", "set_robust_list", "membarrier",
    "futex_waitv", "flock", "mincore", "statfs", "fstatfs", "fadvise64", "readahead", "sync_file_range",
    "cachestat", "preadv2",
}  # fmt: skip


def test_what_must_never_be_allowed_is_not(machine):
    assert lockdown.allowed_calls(machine).keys() & _NEVER == set()


_HEADERS = {
    "x86_64": ("x86_64-linux-gnu/asm/unistd_64.h", "asm/unistd_64.h"),
    "aarch64": ("asm-generic/unistd.h",),
}


def test_numbers_agree_with_the_kernels_own_headers(machine):
    headers = [path for name in _HEADERS[machine] if (path := Path("/usr/include") / name).exists()]
    if not headers:
        pytest.skip(f"no kernel headers for {machine} here")
    text = headers[0].read_text("utf-8")
    numbers = {name: int(number) for name, number in re.findall(r"#define __NR(?:3264)?_(\w+)\s+(\d+)", text)}
    aliases = {"newfstatat": "fstatat"} if machine == "aarch64" else {}
    for name, number in {**lockdown.allowed_calls(machine), **_restricted(machine)}.items():
        known = numbers.get(name, numbers.get(aliases.get(name, "")))
        if known is not None:  # the newest calls may be missing from older headers
            assert known == number, name
    assert len(numbers.keys() & lockdown.allowed_calls(machine).keys()) > 60


def test_a_machine_without_a_list_is_refused():
    with pytest.raises(lockdown.LockdownError, match="riscv64"):
        lockdown.seccomp_program("riscv64")


@pytest.mark.skipif(platform.system() != "Linux", reason="Landlock is Linux's")
def test_landlock_rules_hold_for_files_folders_and_links(tmp_path):
    if lockdown.landlock_abi() < 1:
        pytest.skip("no Landlock here")
    (tmp_path / "open").mkdir()
    (tmp_path / "closed").mkdir()
    for name in ("open/a", "closed/b"):
        (tmp_path / name).write_text("text", "utf-8")
    (tmp_path / "open" / "link").symlink_to(tmp_path / "closed" / "b")
    child = os.fork()
    if child == 0:
        os._exit(_read_and_write_under_rules(tmp_path))
    _, status = os.waitpid(child, 0)
    assert os.waitstatus_to_exitcode(status) == 0


def _read_and_write_under_rules(folder):
    """In a fork of its own: 0 if just what the rules allow was possible, else the number of what was not."""
    try:
        lockdown.drop_capabilities()
        lockdown.landlock_apply(lockdown.landlock_ruleset([str(folder / "open")], []))
        for number, (name, mode, allowed) in enumerate(
            [
                ("open/a", "r", True),
                ("open/a", "a", False),
                ("open/link", "r", False),
                ("closed/b", "r", False),
            ],
            1,
        ):
            try:
                open(folder / name, mode).close()  # noqa: PTH123
                opened = True
            except OSError:
                opened = False
            if opened is not allowed:
                return number
    except BaseException:
        return 99
    return 0
