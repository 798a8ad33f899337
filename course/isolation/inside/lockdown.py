"""How a process gives up what it could do, on Linux: namespaces, capabilities, Landlock, limits, seccomp.

Each function permanently does one of these to the calling process, or raises ``LockdownError``; none
continues half done. ``zygote`` calls them in a newly forked worker before a student's code is loaded. Like
all files that are copied next to that code, this one imports the standard library only.

Sources: landlock(7), seccomp(2), capabilities(7), pid_namespaces(7); constants from the kernel's uapi
headers.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import platform
import signal
import struct
from typing import Any

try:
    import resource
except ImportError:  # Windows, where none of this runs but the file is still type-checked and copied
    resource: Any = None  # type: ignore[no-redef]

NOBODY = 65534

_CLONE_NEWNS = 0x00020000
_CLONE_NEWUTS = 0x04000000
_CLONE_NEWIPC = 0x08000000
_CLONE_NEWPID = 0x20000000
_MS_RDONLY, _MS_NOSUID, _MS_NODEV, _MS_NOEXEC = 1, 2, 4, 8
_MS_REC, _MS_PRIVATE = 0x4000, 0x40000
_PR_SET_PDEATHSIG, _PR_SET_DUMPABLE, _PR_SET_SECCOMP = 1, 4, 22
_PR_CAPBSET_DROP, _PR_SET_NO_NEW_PRIVS = 24, 38
_PR_CAP_AMBIENT, _PR_CAP_AMBIENT_CLEAR_ALL = 47, 4
_SECCOMP_MODE_FILTER = 2
_LAST_CAP = 63  # beyond the newest there is: the kernel answers EINVAL past its own last

# Windows opens no library without a name; the file is copied there, and none of it runs.
_libc: Any = None if os.name == "nt" else ctypes.CDLL(None, use_errno=True)


class LockdownError(OSError):
    """A layer of the lockdown could not be put in place."""


def _check(result: int, what: str) -> int:
    if result < 0:
        number = ctypes.get_errno()
        raise LockdownError(number, f"{what}: {os.strerror(number)}")
    return result


def _prctl(option: int, *args: int) -> int:
    padded = [ctypes.c_ulong(argument) for argument in (*args, 0, 0, 0, 0)[:4]]
    return int(_libc.prctl(ctypes.c_int(option), *padded))


# -- namespaces and mounts ----------------------------------------------------------------------------


def new_pid_namespace(own_namespace: int) -> None:
    """Make the next fork of this process pid 1 of a pid namespace of its own.

    The kernel refuses a second unshare while the first is pending, so the process first points its
    children back at the namespace it lives in (``own_namespace``, an open /proc/self/ns/pid). That spares
    the extra fork that a helper process per worker would cost.
    """
    _check(_libc.setns(own_namespace, _CLONE_NEWPID), "setns")
    _check(_libc.unshare(_CLONE_NEWPID), "unshare pid")


def unshare_worker() -> None:
    """Leave the shared mount, ipc and uts namespaces; mounts no longer propagate either way."""
    _check(_libc.unshare(_CLONE_NEWNS | _CLONE_NEWIPC | _CLONE_NEWUTS), "unshare")
    _check(_libc.mount(b"none", b"/", None, _MS_REC | _MS_PRIVATE, None), "mount private")


def mount_tmpfs(path: str, *, size: str, owner: tuple[int, int], readonly: bool = False) -> None:
    """Mount an empty tmpfs that holds at most ``size`` and is its owner's (uid, gid) alone.

    Both must have a name in the user namespace at hand, or the kernel refuses.
    """
    flags = _MS_NOSUID | _MS_NODEV | _MS_NOEXEC | (_MS_RDONLY if readonly else 0)
    options = f"size={size},nr_inodes=1024,mode=0700,uid={owner[0]},gid={owner[1]}"
    _check(_libc.mount(b"tmpfs", path.encode(), b"tmpfs", flags, options.encode()), f"mount {path}")


# -- identity and capabilities ------------------------------------------------------------------------


def become_unprivileged() -> None:
    """Started as root: become nobody, or limits on processes would not bind and root's files would open."""
    os.setgroups([])
    os.setresgid(NOBODY, NOBODY, NOBODY)
    os.setresuid(NOBODY, NOBODY, NOBODY)


def drop_bounding_set() -> None:
    """Give up what an exec could regain, forks included; before the right to do so is itself given up."""
    for capability in range(_LAST_CAP + 1):
        if _prctl(_PR_CAPBSET_DROP, capability) < 0:
            break  # past the last one this kernel knows, or no CAP_SETPCAP: then no_new_privs must do


def drop_capabilities() -> None:
    """Give up every capability, and any way to gain one by exec."""
    _prctl(_PR_CAP_AMBIENT, _PR_CAP_AMBIENT_CLEAR_ALL)
    header = struct.pack("=Ii", 0x20080522, 0)  # _LINUX_CAPABILITY_VERSION_3, this process
    _check(_libc.capset(header, b"\0" * 24), "capset")
    _check(_prctl(_PR_SET_NO_NEW_PRIVS, 1), "no_new_privs")
    not_dumpable()


def not_dumpable() -> None:
    """Let no process of the same user read this one, trace it or open its descriptors; ptrace(2)."""
    _check(_prctl(_PR_SET_DUMPABLE, 0), "not dumpable")


def die_first() -> None:
    """Let the kernel end this process, rather than the grader, when memory runs out; forks inherit this.

    Among those marked so the kernel takes the largest, which is a worker and not the zygote.
    """
    with contextlib.suppress(OSError), open("/proc/self/oom_score_adj", "w", encoding="ascii") as handle:  # noqa: PTH123
        handle.write("1000")


def die_with_parent() -> None:
    """Be killed when the process that forked this one ends, for whatever reason."""
    parent = os.getppid()
    _check(_prctl(_PR_SET_PDEATHSIG, 9), "parent death signal")
    if os.getppid() != parent:
        os._exit(1)


# -- Landlock -----------------------------------------------------------------------------------------

_CREATE_RULESET, _ADD_RULE, _RESTRICT_SELF = 444, 445, 446
_FS_EXECUTE, _FS_WRITE_FILE, _FS_READ_FILE, _FS_READ_DIR = 1 << 0, 1 << 1, 1 << 2, 1 << 3
_FS_BY_ABI = {1: (1 << 13) - 1, 2: (1 << 14) - 1, 3: (1 << 15) - 1, 4: (1 << 15) - 1}
_FS_NEWEST = (1 << 16) - 1
_FS_FILE = _FS_EXECUTE | _FS_WRITE_FILE | _FS_READ_FILE | 1 << 14 | 1 << 15
_NET_TCP = 0b11
_SCOPE_ALL = 0b11
_FS_WRITE = _FS_WRITE_FILE | _FS_READ_FILE | _FS_READ_DIR | 1 << 4 | 1 << 5 | 1 << 7 | 1 << 8 | 1 << 14


def landlock_abi() -> int:
    """The Landlock version this kernel offers; 0 if it has none or has it switched off."""
    return max(
        0, int(_libc.syscall(ctypes.c_long(_CREATE_RULESET), None, ctypes.c_size_t(0), ctypes.c_uint(1)))
    )


def landlock_ruleset(readable: list[str], writable: list[str]) -> int:
    """A set of rules under which only these paths, and everything below them, can be read or written.

    TCP, signals to others and abstract sockets are refused too where the kernel can. Rule sets stack: a
    process under several may do what all of them allow. So the long list is built once and shared, and a
    worker adds a short one that names its own folder.

    Args:
        readable: files and folders; those that do not exist are skipped.
        writable: folders.

    Returns:
        A descriptor for ``landlock_apply``.
    """
    abi = landlock_abi()
    if abi < 1:
        raise LockdownError(0, "this kernel has no Landlock")
    handled = _FS_BY_ABI.get(abi, _FS_NEWEST)
    attributes = struct.pack("=QQQ", handled, _NET_TCP if abi >= 4 else 0, _SCOPE_ALL if abi >= 6 else 0)
    size = 8 if abi < 4 else 16 if abi < 6 else 24
    ruleset = _check(
        _libc.syscall(ctypes.c_long(_CREATE_RULESET), attributes, ctypes.c_size_t(size), ctypes.c_uint(0)),
        "landlock_create_ruleset",
    )
    for path in readable:
        _allow(ruleset, path, (_FS_READ_FILE | _FS_READ_DIR | _FS_EXECUTE) & handled)
    for path in writable:
        _allow(ruleset, path, _FS_WRITE & handled)
    _allow(ruleset, os.devnull, (_FS_READ_FILE | _FS_WRITE_FILE) & handled)
    return ruleset


def landlock_apply(ruleset: int) -> None:
    """Put this process under a rule set, for good; needs no_new_privs."""
    result = _libc.syscall(ctypes.c_long(_RESTRICT_SELF), ctypes.c_int(ruleset), ctypes.c_uint(0))
    _check(result, "landlock_restrict_self")


def _allow(ruleset: int, path: str, access: int) -> None:
    try:
        descriptor = os.open(path, os.O_PATH | os.O_CLOEXEC)
    except OSError:
        return
    try:
        if not os.path.isdir(path):  # noqa: PTH112 - pathlib is not worth its import here
            access &= _FS_FILE
        rule = struct.pack("=Qi", access, descriptor)
        result = _libc.syscall(
            ctypes.c_long(_ADD_RULE), ctypes.c_int(ruleset), ctypes.c_int(1), rule, ctypes.c_uint(0)
        )
        _check(result, f"landlock_add_rule {path}")
    finally:
        os.close(descriptor)


# -- limits -------------------------------------------------------------------------------------------


def apply_limits(*, cpu_s: int, memory: int, file_size: int, descriptors: int) -> None:
    """Hard limits of this process; soft and hard alike, since pid 1 of a namespace ignores the soft signal.

    Args:
        cpu_s: seconds of CPU.
        memory, file_size: bytes.
        descriptors: open files.
    """
    for kind, value in (
        (resource.RLIMIT_CPU, cpu_s),
        (resource.RLIMIT_AS, memory),
        (resource.RLIMIT_FSIZE, file_size),
        (resource.RLIMIT_NOFILE, descriptors),
        (resource.RLIMIT_NPROC, 0),
        (resource.RLIMIT_CORE, 0),
    ):
        resource.setrlimit(kind, (value, value))
    # A file that is too large raises OSError instead of killing the process.
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)


# -- seccomp ------------------------------------------------------------------------------------------

# What Python and numpy need once they are loaded, as name=x86_64/aarch64; all else answers EPERM. Not in
# it, on purpose: fork, exec, new sockets, ptrace, kill, prlimit, changing modes or owners, truncating by
# path, memfd, keys, mounts, namespaces, io_uring, bpf, perf.
_CALLS = """
    # files
    read=0/63 write=1/64 readv=19/65 writev=20/66 pread64=17/67 pwrite64=18/68 close=3/57
    close_range=436/436 openat=257/56 open=2/- stat=4/- lstat=6/- fstat=5/80 newfstatat=262/79
    statx=332/291 lseek=8/62 access=21/- faccessat=269/48 faccessat2=439/439 readlink=89/-
    readlinkat=267/78 getcwd=79/17 chdir=80/49 fchdir=81/50 getdents64=217/61 getdents=78/-
    mkdir=83/- mkdirat=258/34 unlink=87/- unlinkat=263/35 rmdir=84/- rename=82/- renameat=264/38
    renameat2=316/276 ftruncate=77/46 fsync=74/82 fdatasync=75/83 dup=32/23 dup3=292/24 dup2=33/-
    pipe=22/- pipe2=293/59 umask=95/166 copy_file_range=326/285 sendfile=40/71
    # memory
    mmap=9/222 munmap=11/215 mprotect=10/226 mremap=25/216 brk=12/214 rseq=334/293
    # signals to itself and timers
    rt_sigaction=13/134 rt_sigprocmask=14/135 rt_sigreturn=15/139 rt_sigpending=127/136
    rt_sigtimedwait=128/137 sigaltstack=131/132 alarm=37/- setitimer=38/103 getitimer=36/102
    pause=34/- restart_syscall=219/128
    # itself
    getpid=39/172 gettid=186/178 getppid=110/173 getuid=102/174 geteuid=107/175 getgid=104/176
    getegid=108/177 getgroups=115/158 getresuid=118/148 getresgid=120/150 getpgrp=111/-
    uname=63/160 times=100/153 getrusage=98/165 getrlimit=97/163 getcpu=309/168 sched_yield=24/124
    arch_prctl=158/- exit=60/93 exit_group=231/94
    # time and waiting
    nanosleep=35/101 gettimeofday=96/169 time=201/- getrandom=318/278 poll=7/- ppoll=271/73 select=23/-
    pselect6=270/72
"""
# Two workers that run at once must not talk to each other. So these are left out too: sysinfo (how much
# memory others use), getpgid, getsid, getpriority and get_robust_list (whether a process exists),
# membarrier (interrupts the others), futex_waitv (its flags are out of a filter's reach), set_robust_list
# (wakes any thread that waits at an address), fadvise64 (drops a file that all can read from
# memory, which the next one notices), file locks; what follows is allowed with some arguments only.
_OWN_PID = 0xFEEDFACE  # replaced by the worker's own pid when the filter is put in place
_FUTEX_PRIVATE = 128
_MSG_NOSIGNAL = 0x4000


def _one_of(argument: int, *values: int) -> list[bytes]:
    """Refuse the call unless an argument, an int, is one of these."""
    left = range(len(values), 0, -1)
    tests = [_op(_IF_EQUAL, value, skip, 0) for value, skip in zip(values, left, strict=True)]
    return [_op(_LOAD, _ARGUMENT[argument]), *tests, _op(_RETURN, _EPERM)]


def _below(argument: int, bound: int) -> list[bytes]:
    """Refuse the call unless an argument, an int, is less; negative ones are not."""
    return [_op(_LOAD, _ARGUMENT[argument]), _op(_IF_AT_LEAST, bound, 0, 1), _op(_RETURN, _EPERM)]


def _with_bit(argument: int, bit: int) -> list[bytes]:
    """Refuse the call unless an argument has a bit."""
    return [_op(_LOAD, _ARGUMENT[argument]), _op(_IF_BIT, bit, 1, 0), _op(_RETURN, _EPERM)]


def _null(argument: int) -> list[bytes]:
    """Refuse the call unless an argument is the null pointer: both halves of it are 0."""
    offsets = (_ARGUMENT[argument], _ARGUMENT[argument] + 4)
    halves = [[_op(_LOAD, offset), _op(_IF_EQUAL, 0, 1, 0), _op(_RETURN, _EPERM)] for offset in offsets]
    return [*halves[0], *halves[1]]


_CLONE3 = 435
_AUDIT_ARCH = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}
_ALLOW, _EPERM, _ENOSYS, _KILL = 0x7FFF0000, 0x00050001, 0x00050026, 0x80000000
_LOAD, _IF_EQUAL, _IF_AT_LEAST, _IF_BIT, _RETURN = 0x20, 0x15, 0x35, 0x45, 0x06
_ARGUMENT = tuple(range(16, 64, 8))  # where the lower half of each is; both machines are little-endian


def _op(code: int, k: int, jump_true: int = 0, jump_false: int = 0) -> bytes:
    """One BPF instruction; the jumps skip that many of the next ones."""
    return struct.pack("=HBBI", code, jump_true, jump_false, k)


def _restricted() -> dict[str, tuple[int, int, list[bytes]]]:
    """Calls allowed with some arguments only: name -> (x86_64, aarch64, what refuses the others).

    The most frequent first: each call that is one of them comes past those before it.
    """
    clocks = _below(0, 12)  # those of the system and one's own; a negative number is another process's
    return {
        # On the one socket that is open: to its other end, and nothing out of band.
        "sendto": (44, 206, [*_one_of(3, 0, _MSG_NOSIGNAL), *_null(4)]),
        "recvfrom": (45, 207, _one_of(3, 0)),
        # Others share the pages of libraries with us, and a futex in one of them wakes across processes.
        "futex": (202, 98, _with_bit(1, _FUTEX_PRIVATE)),
        # NORMAL to DONTNEED, FREE, HUGEPAGE, NOHUGEPAGE; not MERGEABLE, which shows what others have.
        "madvise": (28, 233, _one_of(2, 0, 1, 2, 3, 4, 8, 14, 15)),
        "clock_gettime": (228, 113, clocks),
        "clock_getres": (229, 114, clocks),
        "clock_nanosleep": (230, 115, clocks),
        # DUPFD, GETFD, SETFD, GETFL, SETFL, DUPFD_CLOEXEC; not SETOWN and SETSIG, which would send a signal
        # of the student's choice to another process, and no locks.
        "fcntl": (72, 25, _one_of(1, 0, 1, 2, 3, 4, 1030)),
        "ioctl": (16, 29, _one_of(1, 0x5401, 0x541B, 0x5450, 0x5451)),  # TCGETS, FIONREAD, FIO(N)CLEX
        "tgkill": (234, 131, _one_of(0, _OWN_PID)),  # abort() works, signals to others do not
        "sched_getaffinity": (204, 123, _one_of(0, 0, _OWN_PID)),
    }


def allowed_calls(machine: str) -> dict[str, int]:
    """Names and numbers of the system calls a worker may make with any arguments."""
    column = list(_AUDIT_ARCH).index(machine)
    lines = [line for line in _CALLS.splitlines() if not line.strip().startswith("#")]
    pairs = (entry.partition("=") for entry in " ".join(lines).split())
    numbers = {name: numbers.split("/")[column] for name, _, numbers in pairs}
    return {name: int(number) for name, number in numbers.items() if number != "-"}


def seccomp_program(machine: str = "") -> bytes:
    """The filter as BPF, complete but for the worker's pid; built once, since building costs more than using.

    Raises:
        LockdownError: a machine whose system calls are not listed here.
    """
    machine = machine or platform.machine()
    if machine not in _AUDIT_ARCH:
        raise LockdownError(0, f"no list of system calls for {machine}")
    column = list(_AUDIT_ARCH).index(machine)
    program = [_op(_LOAD, 4), _op(_IF_EQUAL, _AUDIT_ARCH[machine], 1, 0), _op(_RETURN, _KILL), _op(_LOAD, 0)]
    program += [_op(_IF_AT_LEAST, 0x40000000, 0, 1), _op(_RETURN, _KILL)]  # x32 numbers its calls anew
    # clone3 must look absent, so that the C library falls back to clone, whose flags it reports properly.
    program += [_op(_IF_EQUAL, _CLONE3, 0, 1), _op(_RETURN, _ENOSYS)]
    for *numbers, conditions in _restricted().values():
        program += [_op(_IF_EQUAL, numbers[column], 0, len(conditions) + 1), *conditions]
        program.append(_op(_RETURN, _ALLOW))
    program += _search(_verdicts(set(allowed_calls(machine).values())))
    return b"".join(program)


def _verdicts(allowed: set[int]) -> list[tuple[int, int]]:
    """(first number, answer) of each run of calls with the same answer, from 0 up."""
    edges = [n for n in range(max(allowed) + 2) if n == 0 or (n in allowed) != (n - 1 in allowed)]
    return [(number, _ALLOW if number in allowed else _EPERM) for number in edges]


def _search(verdicts: list[tuple[int, int]]) -> list[bytes]:
    """The verdict on the loaded number, by halving.

    The kernel runs a filter once for every call there is when it is put in place, so the length of the way
    through it is paid for by every worker that starts.
    """
    if len(verdicts) == 1:
        return [_op(_RETURN, verdicts[0][1])]
    middle = len(verdicts) // 2
    below, above = _search(verdicts[:middle]), _search(verdicts[middle:])
    return [_op(_IF_AT_LEAST, verdicts[middle][0], len(below), 0), *below, *above]


def apply_seccomp(program: bytes) -> None:
    """Put the filter in place for this process; needs no_new_privs."""
    filled = program.replace(struct.pack("=I", _OWN_PID), struct.pack("=I", os.getpid()))
    code = ctypes.create_string_buffer(filled, len(filled))
    header = struct.pack("@HP", len(filled) // 8, ctypes.addressof(code))
    buffer = ctypes.create_string_buffer(header, len(header))
    _check(_prctl(_PR_SET_SECCOMP, _SECCOMP_MODE_FILTER, ctypes.addressof(buffer)), "seccomp")
