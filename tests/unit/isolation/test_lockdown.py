"""The system call filter allows what it lists and nothing else: read back as the kernel reads it."""

from __future__ import annotations

import os
import platform
import re
import struct
from pathlib import Path

import pytest

from course.isolation import lockdown

_MACHINES = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}
_ALLOW, _EPERM, _ENOSYS, _KILL = 0x7FFF0000, 0x00050001, 0x00050026, 0x80000000


def _decide(program: bytes, arch: int, number: int, *arguments: int) -> int:
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
        elif code == 0x15:
            at += jump_true if accumulator == k else jump_false
        elif code == 0x35:
            at += jump_true if accumulator >= k else jump_false
        else:
            assert code == 0x06
            return k


@pytest.fixture(params=_MACHINES)
def machine(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def test_every_listed_call_is_allowed_and_every_other_is_refused(machine: str) -> None:
    program, allowed = lockdown.seccomp_program(machine), set(lockdown.allowed_calls(machine).values())
    restricted = {numbers[list(_MACHINES).index(machine)] for numbers in lockdown._RESTRICTED.values()}
    for number in range(600):
        found = _decide(program, _MACHINES[machine], number, 0xDEAD, 0xDEAD)
        if number in allowed:
            assert found == _ALLOW, number
        elif number == 435:
            assert found == _ENOSYS
        else:
            assert found == _EPERM, number
    assert not restricted & allowed


def test_other_interfaces_to_the_kernel_are_deadly(machine: str) -> None:
    program = lockdown.seccomp_program(machine)
    for arch in (0x40000003, 0x40000028, 0xC000003E ^ 1, 0):  # i386, 32-bit arm, nonsense
        assert _decide(program, arch, 0) == _KILL
    for number in (0x40000000, 0x40000000 | 57, 0xFFFFFFFF):  # x32, and -1
        assert _decide(program, _MACHINES[machine], number) == _KILL


def test_restricted_calls_depend_on_their_argument(machine: str) -> None:
    program, arch = lockdown.seccomp_program(machine), _MACHINES[machine]
    column = list(_MACHINES).index(machine)
    fcntl, ioctl, tgkill = (lockdown._RESTRICTED[name][column] for name in ("fcntl", "ioctl", "tgkill"))
    assert _decide(program, arch, fcntl, 3, 3) == _ALLOW  # F_GETFL
    for command in (
        6,
        8,
        10,
        15,
        1024,
        1026,
        1033,
    ):  # locks, SETOWN, SETSIG, SETOWN_EX, leases, notify, seals
        assert _decide(program, arch, fcntl, 3, command) == _EPERM, command
    assert _decide(program, arch, ioctl, 1, 0x5401) == _ALLOW  # is it a terminal?
    for request in (0x5412, 0x8901, 0x8904, 0x541C):  # put a character, owners of a socket, console
        assert _decide(program, arch, ioctl, 1, request) == _EPERM, hex(request)
    own = lockdown._OWN_PID
    assert _decide(program, arch, tgkill, own, own, 6) == _ALLOW
    assert _decide(program, arch, tgkill, 1, 1, 9) == _EPERM


@pytest.mark.parametrize(
    "name", ["fork", "clone", "execve", "socket", "ptrace", "kill", "prctl", "unshare", "mount"]
)
def test_what_must_never_be_allowed_is_not(name: str) -> None:
    for machine in _MACHINES:
        assert name not in lockdown.allowed_calls(machine)


_HEADERS = {
    "x86_64": ("x86_64-linux-gnu/asm/unistd_64.h", "asm/unistd_64.h"),
    "aarch64": ("asm-generic/unistd.h",),
}


def test_numbers_agree_with_the_kernels_own_headers(machine: str) -> None:
    headers = [path for name in _HEADERS[machine] if (path := Path("/usr/include") / name).exists()]
    if not headers:
        pytest.skip(f"no kernel headers for {machine} here")
    text = headers[0].read_text("utf-8")
    numbers = {name: int(number) for name, number in re.findall(r"#define __NR(?:3264)?_(\w+)\s+(\d+)", text)}
    aliases = {"newfstatat": "fstatat"} if machine == "aarch64" else {}
    listed = {
        name: numbers_[list(_MACHINES).index(machine)] for name, numbers_ in lockdown._RESTRICTED.items()
    }
    for name, number in {**lockdown.allowed_calls(machine), **listed}.items():
        known = numbers.get(name, numbers.get(aliases.get(name, "")))
        if known is not None:  # the newest calls may be missing from older headers
            assert known == number, name
    assert len(numbers.keys() & lockdown.allowed_calls(machine).keys()) > 60


def test_a_machine_without_a_list_is_refused() -> None:
    with pytest.raises(lockdown.LockdownError, match="riscv64"):
        lockdown.seccomp_program("riscv64")


@pytest.mark.skipif(platform.system() != "Linux", reason="Landlock is Linux's")
def test_landlock_rules_hold_for_files_folders_and_links(tmp_path: Path) -> None:
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


def _read_and_write_under_rules(folder: Path) -> int:
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
