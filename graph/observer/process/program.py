"""The program of the observer's process: `python program.py DESCRIPTOR PARENT`.

It is run by its path, so that it starts with whatever Python the screen runs on; where modules are
it gets by the socket DESCRIPTOR.
"""

from __future__ import annotations

import ctypes
import os
import signal
import socket
import sys

PLACE = os.path.abspath(f"{__file__}/../../../..")  # noqa: PTH100 - nothing is imported for this
PR_SET_NAME, PR_SET_PDEATHSIG = 15, 1
"""Source: prctl(2)."""


def main(descriptor: int, parent: int) -> None:
    """Serve until the other end is closed, or the parent is gone."""
    prctl = ctypes.CDLL(None).prctl
    # The end of the socket says the same, unless somebody else has got hold of the other end.
    prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    prctl(PR_SET_NAME, b"deck: observer")
    if os.getppid() != parent:
        return
    from graph.observer.process.serving import serve
    from graph.observer.process.wire import Wire

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    serve(Wire(socket.socket(fileno=descriptor)))


if __name__ == "__main__":
    sys.path[0] = PLACE
    main(int(sys.argv[1]), int(sys.argv[2]))
