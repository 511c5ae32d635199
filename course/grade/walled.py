"""A program inside walls, without bubblewrap: `python -m course.grade.walled ROOT INSIDE COMMAND`.

ROOT is an empty folder, INSIDE the layers and the writable folders of a
`course.grade.walls.Inside`, as JSON. New namespaces for users, mounts, processes, network and IPC
(namespaces(7)); the command is the first process in them, with which all others end. Its root is a
copy of this one for reading (mount_setattr(2), Linux 5.12).
"""

from __future__ import annotations

import ctypes
import fcntl
import os
import platform
import signal
import socket
import struct
import sys
from pathlib import Path
from typing import Any

from course.grade.limits import IN_MEMORY_BYTES
from launcher.processes.confinement import give_up_privileges
from text.nested import read_json

_NAMESPACES = 0x10000000 | 0x00020000 | 0x20000000 | 0x40000000 | 0x08000000
"""CLONE_NEWUSER, NEWNS, NEWPID, NEWNET, NEWIPC."""
_NOSUID, _NODEV, _NOEXEC, _BIND, _REC, _PRIVATE = 2, 4, 8, 0x1000, 0x4000, 1 << 18
_READ_ONLY, _RECURSIVE, _HERE, _DETACH = 1, 0x8000, -100, 2
_MOUNT_SETATTR = 442
_PIVOT_ROOT = {"x86_64": 155, "aarch64": 41}
_INTERFACE_FLAGS, _SET_FLAGS, _UP = 0x8913, 0x8914, 1
_DIE_WITH_PARENT = 1
_DEVICES = ("null", "zero", "full", "random", "urandom", "tty")
_LINKS = {
    "fd": "/proc/self/fd", "stdin": "/proc/self/fd/0", "stdout": "/proc/self/fd/1",
    "stderr": "/proc/self/fd/2", "ptmx": "pts/ptmx",
}  # fmt: skip

_libc = ctypes.CDLL(None, use_errno=True)


def _checked(result: int) -> None:
    if result != 0:
        code = ctypes.get_errno()
        raise OSError(code, os.strerror(code))


def _mount(source: str, target: Path, kind: str = "", flags: int = 0, data: str = "") -> None:
    arguments = (source.encode(), bytes(target), kind.encode(), ctypes.c_ulong(flags))
    _checked(_libc.mount(*arguments, data.encode()))


def _read_only(target: Path) -> None:
    attributes = struct.pack("=QQQQ", _READ_ONLY, 0, 0, 0)
    arguments = (_HERE, bytes(target), _RECURSIVE, attributes, len(attributes))
    _checked(_libc.syscall(_MOUNT_SETATTR, *arguments))


def _new_namespaces() -> None:
    uid, gid = os.getuid(), os.getgid()
    _checked(_libc.unshare(_NAMESPACES))
    Path("/proc/self/setgroups").write_text("deny")
    Path("/proc/self/uid_map").write_text(f"{uid} {uid} 1")
    Path("/proc/self/gid_map").write_text(f"{gid} {gid} 1")


def _loopback_up() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        request = struct.pack("16sH14x", b"lo", 0)
        flags = struct.unpack("16sH14x", fcntl.ioctl(any_socket, _INTERFACE_FLAGS, request))[1]
        fcntl.ioctl(any_socket, _SET_FLAGS, struct.pack("16sH14x", b"lo", flags | _UP))


def _bind(path: str, root: Path, *, writable: bool) -> None:
    source, target = Path(path), root / path.lstrip("/")
    if source.is_dir():
        target.mkdir(parents=True, exist_ok=True)
    elif not target.exists():
        target.parent.mkdir(parents=True, exist_ok=True)
        target.touch()
    _mount(path, target, flags=_BIND | _REC)
    if not writable:
        _read_only(target)


def _devices(dev: Path) -> None:
    _mount("tmpfs", dev, "tmpfs", _NOSUID, "mode=0755")
    for name in _DEVICES:
        (dev / name).touch()
        _mount(f"/dev/{name}", dev / name, flags=_BIND)
    for name in ("shm", "pts"):
        (dev / name).mkdir()
    for name, target in _LINKS.items():
        (dev / name).symlink_to(target)
    _mount("tmpfs", dev / "shm", "tmpfs", _NOSUID | _NODEV, f"mode=1777,size={IN_MEMORY_BYTES}")
    _mount("devpts", dev / "pts", "devpts", _NOSUID | _NOEXEC, "newinstance,ptmxmode=0666,mode=620")


def _enter(root: Path, inside: dict[str, Any]) -> None:
    here = Path.cwd()
    _mount("none", Path("/"), flags=_REC | _PRIVATE)
    _mount("/", root, flags=_BIND | _REC)
    _read_only(root)
    _devices(root / "dev")
    _mount("proc", root / "proc", "proc", _NOSUID | _NODEV | _NOEXEC)
    options = f"mode=0755,size={IN_MEMORY_BYTES}"
    for path, is_hidden in inside["layers"]:
        if is_hidden:
            _mount("tmpfs", root / path.lstrip("/"), "tmpfs", _NOSUID | _NODEV, options)
        else:
            _bind(path, root, writable=False)
    for path in inside["writable"]:
        _bind(path, root, writable=True)
    os.chdir(root)
    # The old root is put over the new one, and taken away, see pivot_root(2).
    _checked(_libc.syscall(_PIVOT_ROOT[platform.machine()], b".", b"."))
    _checked(_libc.umount2(b".", _DETACH))
    os.chdir(here)


def _wait_for(child: int) -> int:
    """Wait for the first process inside; signals are its own affair. Return its exit code."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def main() -> None:
    """Run the command inside."""
    root, inside, command = Path(sys.argv[1]), read_json(sys.argv[2]), sys.argv[3:]
    _new_namespaces()
    parent = os.getpid()
    child = os.fork()
    if child:
        sys.exit(abs(_wait_for(child)))
    _checked(_libc.prctl(_DIE_WITH_PARENT, signal.SIGKILL, 0, 0, 0))
    if os.getppid() not in (0, parent):
        os._exit(1)
    _loopback_up()
    _enter(root, inside)
    give_up_privileges()
    os.execv(command[0], command)


if __name__ == "__main__":
    main()
