"""Say in one line what this machine lacks for `make`, before anything is started.

It runs on any Python, even one far too old for Deck, because it has to say so.
"""

import os
import platform
import sys
import sysconfig

# Run by its path: the module beside it has a bare name.
from setup_words import tell, told

OLDEST, NEWEST = (3, 10), (3, 13)
PIXI = "install pixi (https://pixi.sh) and use `pixi run deck`"


class Machine(object):
    """The facts about a machine, gathered in one place so that tests can replace them."""

    def __init__(self, **facts):
        self.system = facts.get("system", platform.system())
        self.arch = facts.get("arch", platform.machine())
        self.bits = facts.get("bits", 64 if sys.maxsize > 2**32 else 32)
        self.libc = facts.get("libc", platform.libc_ver())
        self.python = facts.get("python", sys.version_info[:2])
        self.path = facts.get("path", os.environ.get("PATH", os.defpath))
        self.modules = facts.get("modules", installed("venv", "ensurepip"))
        self.include = facts.get("include", sysconfig.get_paths()["include"])


def installed(*names):
    """Return which of the named modules this Python can import."""
    found = []
    for name in names:
        try:
            __import__(name)
        except ImportError:
            continue
        found.append(name)
    return found


def has_program(path, names):
    """Return whether one of the programs is on the search path."""
    return any(
        os.access(os.path.join(folder or ".", name), os.X_OK) for folder in path.split(os.pathsep) for name in names
    )


def compilers(variable, *names):
    """Return the compiler that the environment names, else the usual ones."""
    asked = os.environ.get(variable, "").split()
    return asked[:1] or names


def release(text):
    """Return a version such as 2.36 as numbers that can be compared."""
    return tuple(int(part) for part in text.split(".")[:2])


def complaints(machine):
    """Yield what is wrong and how to fix it, the most serious first."""
    version = "%d.%d" % machine.python
    if machine.system != "Linux" or machine.arch != "x86_64" or machine.bits != 64:
        only = "ROS 2 is on PyPI for 64-bit Linux on x86-64 only, this is %s on %s, %d-bit: %s."
        yield told(only, machine.system, machine.arch, machine.bits, told(PIXI))
    if machine.libc[0] != "glibc" or release(machine.libc[1]) < (2, 28):
        yield told("the ROS 2 of PyPI needs glibc 2.28 or newer, which this Linux lacks: %s.", told(PIXI))
    if not OLDEST <= machine.python <= NEWEST:
        yield told("this is Python %s and Deck runs on 3.10 to 3.13: install one of them.", version)
    if "venv" not in machine.modules or "ensurepip" not in machine.modules:
        yield told("Python %s cannot make virtual environments: sudo apt install python%s-venv.", version, version)
    if not has_program(machine.path, compilers("CC", "cc", "gcc", "clang")):
        yield told("there is no C compiler: sudo apt install build-essential.")
    if not has_program(machine.path, compilers("CXX", "c++", "g++", "clang++")):
        yield told("there is no C++ compiler: sudo apt install build-essential.")
    if not os.path.exists(os.path.join(machine.include, "Python.h")):
        yield told("Python %s lacks its headers: sudo apt install python%s-dev.", version, version)


if __name__ == "__main__":
    for found in complaints(Machine()):
        tell("deck: " + found)
        sys.exit(1)
