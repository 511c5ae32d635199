"""The command line: `deck`, `deck run`, `deck list` and the rest.

Other packages use only `main`. Each module is a command, or is shared by commands; `main` imports
only the requested one.
"""

from launcher.processes.interrupts import silent

with silent():
    from cli.main import main

__all__ = ["main"]
