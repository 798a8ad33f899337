"""Tries every system call that could give something back, by number."""

# Arguments are such that a call which is let through fails for another reason and changes nothing.
import ctypes

libc = ctypes.CDLL(None, use_errno=True)
blank = ctypes.create_string_buffer(4096)
calls = {
    "mount": (165, b"none", b"/no/such", b"tmpfs", 0, None), "umount2": (166, b"/no/such", 0), "unshare": (272, 0x10000000),
    "unshare_ns": (272, 0x00020000), "setns": (308, 3, 0), "chroot": (161, b"/no/such"), "pivot_root": (155, b"/no/such", b"/no/such"),
    "setuid": (105, 0), "setresuid": (117, 0, 0, 0), "setgroups": (116, 0, None), "capset": (126, blank, blank),
    "personality": (135, 0x0040000), "bpf": (321, 0, 1, 72), "perf": (298, blank, 0, -1, -1, 0),
    "userfaultfd": (323, 0), "add_key": (248, b"user", b"course", b"x", 1, -3), "keyctl": (250, 0, -3, 1),
    "io_uring": (425, 8, blank), "memfd": (319, b"course", 0), "execveat": (322, -100, b"/bin/true", None, None, 0),
    "clone3": (435, blank, 88), "clone": (56, 17, None), "fork": (57,), "vfork": (58,), "init_module": (175, 1, 1, 1),
    "finit_module": (313, -1, 1, 0), "kexec": (246, 1, 1, 1, 0), "reboot": (169, 1, 2, 3),
    "open_by_handle": (304, -100, blank, 0), "prlimit": (302, 0, 7, blank, None), "setrlimit": (160, 7, blank),
    "affinity": (203, 0, 8, blank), "setpriority": (141, 0, 0, -5), "prctl": (157, 4, 1), "seccomp": (317, 0, 0, None),
    "landlock": (444, None, 0, 1), "chmod": (90, b"/no/such", 0o777), "chown": (92, b"/no/such", 0, 0), "mknod": (133, b"/no/such/n", 0o20666, 259),
    "symlink": (88, b"/", b"course_attack_link"), "link": (86, b"arena.py", b"l"), "swapon": (167, b"/no/such", 0), "acct": (163, b"/no/such"),
    "sethostname": (170, 1, 1), "settimeofday": (164, 1, None), "clock_settime": (227, 0, 1), "iopl": (172, 3),
    "ioperm": (173, 0, 1, 1), "quotactl": (179, -1, None, 0, None), "ptrace": (101, 0, 0, 0, 0), "kcmp": (312, 1, 1, 0, 1, 1),
    "socket": (41, 2, 1, 0), "socketpair": (53, 1, 1, 0, blank), "sendmsg": (46, 3, blank, 0), "shmget": (29, 0, 4096, 0o1600),
    "semget": (64, 0, 1, 0o1600), "msgget": (68, 0, 0o1600), "mq_open": (240, b"course", 0o102, 0o600, None),
    "inotify": (253,), "fanotify": (300, 0, 0), "timer_create": (222, 0, None, blank), "name_to_handle": (303, -100, b"/", blank, blank, 0),
    "move_pages": (279, 0, 0, None, None, None, 0), "migrate_pages": (256, 0, 0, None, None), "vmsplice": (278, 1, blank, 1, 0),
    "splice": (275, 0, None, 1, None, 1, 0), "fsopen": (430, b"tmpfs", 0), "open_tree": (428, -100, b"/", 0), "fsmount": (432, 0, 0, 0),
    "openat2": (437, -100, b"/tmp", blank, 24), "pidfd_open": (434, 1, 0), "pidfd_getfd": (438, 3, 1, 0), "process_madvise": (440, 0, blank, 1, 0, 0),
    "memfd_secret": (447, 0), "lookup_dcookie": (212, 0, None, 0), "syslog": (103, 10, None, 0), "uselib": (134, b"/x"),
    "setxattr": (188, b"arena.py", b"user.x", b"x", 1, 0), "utimensat": (280, -100, b"arena.py", None, 0), "fchmodat2": (452, -100, b"/no/such", 0o777, 0),
}
for name, arguments in calls.items():
    ctypes.set_errno(0)
    result = libc.syscall(*[ctypes.c_long(a) if isinstance(a, int) else a for a in arguments])
    if result >= 0 or ctypes.get_errno() not in (1, 38):
        print("FILE-CANARY" + "-7f3a: system call", name, result, ctypes.get_errno())
