"""Refusing system calls for good: seccomp(2), which needs no privileges.

Landlock has no word for what is done to a file without writing it, or to a process without a
signal. A filter sees numbers and no paths: mode, owner and times cannot be changed of any file,
one's own included, which is not told, as libraries change those of files that they have just made.
"""

from __future__ import annotations

import ctypes
import errno
import os
import platform
from dataclasses import dataclass

_SET_SECCOMP, _FILTER = 22, 2
_LOAD, _EQUAL, _ANY_BIT, _MASK, _RETURN = 0x20, 0x15, 0x45, 0x54, 0x06
"""BPF_LD|W|ABS, BPF_JMP|JEQ|K, BPF_JMP|JSET|K, BPF_ALU|AND|K, BPF_RET|K (linux/bpf_common.h)."""
_ALLOW, _ERRNO, _KILL = 0x7FFF0000, 0x00050000, 0x80000000
_NUMBER, _ARCHITECTURE, _ARGUMENTS = 0, 4, 16
"""Offsets in struct seccomp_data; of each argument, the lower half."""
_X32 = 0x40000000
_NEW_NAMESPACES = 0x7E020080
"""All of CLONE_NEW*."""
_TYPE_OF_SOCKET = 0xF
_FAMILIES = (2, 10, 16)
"""AF_INET, AF_INET6, AF_NETLINK: what DDS needs."""
_STREAM, _DATAGRAM, _RAW, _SEQPACKET = 1, 2, 3, 5
_TYPES = (_DATAGRAM, _RAW)
"""UDP, and what netlink calls raw. Landlock knows TCP only by bind(2) and connect(2): not what
MSG_FASTOPEN opens, nor MPTCP and SCTP."""
_PAIRS = (_STREAM, _SEQPACKET)
"""Other pairs of sockets could still be connected elsewhere."""
_TO_OTHERS = (0x5412, 0x541C, 0x8901, 0x8902)
"""TIOCSTI, TIOCLINUX: typing on somebody's terminal; FIOSETOWN, SIOCSPGRP: sending a signal."""
_OF_OTHERS = (8, 10, 15, 1024, 1026)
"""F_SETOWN, F_SETSIG, F_SETOWN_EX: any signal to anybody; F_SETLEASE, F_NOTIFY: a lease holds up
whoever opens the file."""

_MACHINES = {"x86_64": (0xC000003E, 0), "aarch64": (0xC00000B7, 1)}
_METADATA = {
    "chmod": (90, None), "fchmod": (91, 52), "fchmodat": (268, 53), "fchmodat2": (452, 452),
    "chown": (92, None), "fchown": (93, 55), "lchown": (94, None), "fchownat": (260, 54),
    "utime": (132, None), "utimes": (235, None), "futimesat": (261, None), "utimensat": (280, 88),
}  # fmt: skip
_ATTRIBUTES = {
    "setxattr": (188, 5), "lsetxattr": (189, 6), "fsetxattr": (190, 7), "removexattr": (197, 14),
    "lremovexattr": (198, 15), "fremovexattr": (199, 16), "setxattrat": (463, 463),
    "removexattrat": (466, 466), "file_setattr": (469, 469),
}  # fmt: skip
_NEVER = {
    "ptrace": (101, 117), "process_vm_readv": (310, 270), "process_vm_writev": (311, 271),
    "process_madvise": (440, 440), "process_mrelease": (448, 448), "pidfd_getfd": (438, 438),
    "kcmp": (312, 272), "move_pages": (279, 239), "migrate_pages": (256, 238),
    "perf_event_open": (298, 241), "bpf": (321, 280), "userfaultfd": (323, 282),
    "add_key": (248, 217), "request_key": (249, 218), "keyctl": (250, 219),
    "mount": (165, 40), "umount2": (166, 39), "pivot_root": (155, 41), "unshare": (272, 97),
    "setns": (308, 268), "open_by_handle_at": (304, 265), "quotactl": (179, 60),
    "reboot": (169, 142), "settimeofday": (164, 170), "clock_settime": (227, 112),
    "sethostname": (170, 161), "setdomainname": (171, 162), "init_module": (175, 105),
    "finit_module": (313, 273), "delete_module": (176, 106), "kexec_load": (246, 104),
    "shmget": (29, 194), "shmctl": (31, 195), "msgget": (68, 186), "msgctl": (71, 187),
    "semget": (64, 190), "semctl": (66, 191), "mq_open": (240, 180), "mq_unlink": (241, 181),
    "shmat": (30, 196), "msgsnd": (69, 189), "msgrcv": (70, 188), "semop": (65, 193),
    "semtimedop": (220, 192), "fanotify_init": (300, 262),
}  # fmt: skip
_ABSENT = {
    "io_uring_setup": (425, 425), "io_uring_enter": (426, 426), "io_uring_register": (427, 427),
    "clone3": (435, 435), "memfd_create": (319, 279), "memfd_secret": (447, 447),
}  # fmt: skip
"""What does by other means what is filtered or counted here; libraries go on without."""
_ON_ITSELF = {
    "sched_setparam": (142, 118), "sched_setscheduler": (144, 119),
    "sched_setaffinity": (203, 122), "sched_setattr": (314, 274),
}  # fmt: skip
"""Of this process, which is 0 in the first argument, and of no other."""
_OF_WHOM = {"setpriority": (141, 140), "ioprio_set": (251, 30)}
_PRLIMIT, _CLONE, _IOCTL, _FCNTL = (302, 261), (56, 220), (16, 29), (72, 25)
_SOCKET, _SOCKETPAIR = (41, 198), (53, 199)
_SIGNALS = {"kill": (62, 129), "tkill": (200, 130), "tgkill": (234, 131)}
_QUEUED_SIGNALS = {
    "rt_sigqueueinfo": (129, 138), "rt_tgsigqueueinfo": (297, 240), "pidfd_send_signal": (424, 424),
}  # fmt: skip


class _Instruction(ctypes.Structure):
    _fields_ = (
        ("code", ctypes.c_uint16),
        ("when", ctypes.c_uint8),
        ("otherwise", ctypes.c_uint8),
        ("value", ctypes.c_uint32),
    )


class _Program(ctypes.Structure):
    _fields_ = (("length", ctypes.c_uint16), ("filter", ctypes.POINTER(_Instruction)))


@dataclass(frozen=True)
class _Step:
    """One instruction; the jumps skip so many of the next."""

    code: int
    value: int
    when: int = 0
    otherwise: int = 0


def can_refuse() -> bool:
    """Whether the calls of this machine are known, and the kernel has filters."""
    return platform.machine() in _MACHINES and os.path.exists(  # noqa: PTH110
        "/proc/sys/kernel/seccomp/actions_avail"
    )


def refuse_calls(*, signals: bool) -> None:
    """Refuse this process, for good, what would reach beyond its own files and itself.

    `signals`: those to other processes too, its own children included. It has given up new
    privileges before.

    Raises:
        OSError: if the kernel refuses.
    """
    steps = _program(platform.machine(), os.getpid() if signals else 0)
    code = (_Instruction * len(steps))(*(_Instruction(one.code, one.when, one.otherwise, one.value) for one in steps))
    program = _Program(len(steps), code)
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.prctl(_SET_SECCOMP, _FILTER, ctypes.byref(program), 0, 0) != 0:
        code_of_error = ctypes.get_errno()
        raise OSError(code_of_error, os.strerror(code_of_error))


def _program(machine: str, alone: int) -> list[_Step]:
    """`alone`: the process that may signal itself and its group only; 0: any."""
    architecture, column = _MACHINES[machine]
    steps = [
        _Step(_LOAD, _ARCHITECTURE),
        _Step(_EQUAL, architecture, when=1),
        _Step(_RETURN, _KILL),
        _Step(_LOAD, _NUMBER),
        _Step(_ANY_BIT, _X32, otherwise=1),
        _Step(_RETURN, _KILL),
    ]
    for calls, error in (
        (_METADATA, 0),
        (_ATTRIBUTES, errno.EOPNOTSUPP),
        (_NEVER, errno.EPERM),
        (_ABSENT, errno.ENOSYS),
        ({} if not alone else _QUEUED_SIGNALS, errno.EPERM),
    ):
        for numbers in calls.values():
            number = numbers[column]
            if number is not None:
                steps += [_Step(_EQUAL, number, otherwise=1), _Step(_RETURN, _ERRNO | error)]
    rules = [
        *((numbers, _only_zero(0)) for numbers in _ON_ITSELF.values()),
        *((numbers, _own_priority()) for numbers in _OF_WHOM.values()),
        (_PRLIMIT, _only_zero(0)),
        (_CLONE, [_argument(0), _Step(_ANY_BIT, _NEW_NAMESPACES, 0, 1), _refused(), _allowed()]),
        (_SOCKET, _socket_of(_FAMILIES, _TYPES)),
        (_SOCKETPAIR, _one_of(1, _PAIRS, errno.EOPNOTSUPP, _TYPE_OF_SOCKET)),
        (_IOCTL, _none_of(1, _TO_OTHERS)),
        (_FCNTL, _none_of(1, _OF_OTHERS)),
    ]
    if alone:
        own = (alone, 0, -alone & 0xFFFFFFFF)
        rules += [(numbers, _one_of(0, own, errno.EPERM)) for numbers in _SIGNALS.values()]
    for numbers, rule in rules:
        steps += [_Step(_EQUAL, numbers[column], otherwise=len(rule)), *rule]
    return [*steps, _allowed()]


def _argument(number: int) -> _Step:
    return _Step(_LOAD, _ARGUMENTS + 8 * number)


def _allowed() -> _Step:
    return _Step(_RETURN, _ALLOW)


def _refused(error: int = errno.EPERM) -> _Step:
    return _Step(_RETURN, _ERRNO | error)


def _only_zero(argument: int) -> list[_Step]:
    return [_argument(argument), _Step(_EQUAL, 0, otherwise=1), _allowed(), _refused()]


def _own_priority() -> list[_Step]:
    """Of a process or group, which are 0 and 1 or 1 and 2, never of a user; and of nobody else."""
    return [
        _argument(1),
        _Step(_EQUAL, 0, otherwise=3),
        _argument(0),
        _Step(_ANY_BIT, 0xFFFFFFFE, when=1),
        _allowed(),
        _refused(),
    ]


def _one_of(argument: int, values: tuple[int, ...], error: int, mask: int = 0) -> list[_Step]:
    masked = [_Step(_MASK, mask)] if mask else []
    tests = [_Step(_EQUAL, value, when=len(values) - number) for number, value in enumerate(values)]
    return [_argument(argument), *masked, *tests, _refused(error), _allowed()]


def _socket_of(families: tuple[int, ...], types: tuple[int, ...]) -> list[_Step]:
    """Of one of these families, and of one of these types."""
    last = len(families)
    tests = [_Step(_EQUAL, family, when=last - number) for number, family in enumerate(families)]
    of_type = _one_of(1, types, errno.EACCES, _TYPE_OF_SOCKET)
    return [_argument(0), *tests, _refused(errno.EAFNOSUPPORT), *of_type]


def _none_of(argument: int, values: tuple[int, ...]) -> list[_Step]:
    tests = [_Step(_EQUAL, value, when=len(values) - number) for number, value in enumerate(values)]
    return [_argument(argument), *tests, _allowed(), _refused()]
