"""The process that llama.cpp runs in: serves one model until nobody wants it any more.

Its only argument is an `Order` as JSON. Its standard output gets one line, the address, once the
model can be asked; what llama.cpp has to say goes to standard error. It ends when its standard
input does, and so with whoever has started it.
"""

from __future__ import annotations

import os
import resource
import signal
import sys
import time
from dataclasses import dataclass
from typing import Any

from text.nested import read_json

POLITENESS = 5
"""Added to its niceness: on a robot's own computer, the nodes that stop the wheels come first."""
_LOG_WRITTEN_S = 0.5
INFO = 3
"""The level at which llama.cpp tells how long each answer took."""


@dataclass(frozen=True)
class Order:
    """What is to be served, and how."""

    path: str
    name: str
    host: str
    port: int
    """0: any that is free."""
    context: int
    """How many tokens at once, question and answer together."""
    threads: int
    eyes: str = ""
    """The file that turns pictures into tokens (mmproj); without it the model is blind."""


def main(argument: str) -> None:
    """Serve until standard input ends; exit with 1 if that is impossible."""
    order = Order(**read_json(argument))
    # The terminal's Ctrl-C is for whoever has started this, and then ends this as well.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    os.nice(POLITENESS)
    answer = os.dup(1)
    os.dup2(2, 1)
    try:
        server = _served(order)
    except RuntimeError:
        # llama.cpp has told why, to a thread that writes it down, which nobody waits for at exit.
        time.sleep(_LOG_WRITTEN_S)
        sys.exit(1)
    os.write(answer, f"{server.listening_address}\n".encode())
    while os.read(0, 4096):
        pass
    # At once: its destructors would wait for an answer that nobody reads any more.
    os._exit(0)


def _served(order: Order) -> Any:  # noqa: ANN401 - the library has no types
    """Load the model; return what answers requests, in threads of its own, until it is deleted."""
    import xllamacpp

    wishes = xllamacpp.CommonParams()
    wishes.model.path = order.path
    if order.eyes:
        wishes.mmproj.path = order.eyes
    wishes.model_alias = {order.name}
    wishes.hostnames, wishes.port = [order.host], order.port
    wishes.n_ctx = order.context
    wishes.cpuparams.n_threads = wishes.cpuparams_batch.n_threads = order.threads
    # A damaged file is refused, rather than answering nonsense.
    wishes.check_tensors = True
    # A robot waits for the answer: what the model thinks has its place in it.
    wishes.enable_reasoning = 0
    # By default it keeps up to 8 GB of earlier conversations in memory.
    wishes.cache_ram_mib = 0
    # No page for people, no look at what others ask, no requests by other people's web pages.
    wishes.ui = wishes.endpoint_slots = wishes.cors_credentials = False
    wishes.cors_origins = ""
    wishes.verbosity = INFO
    return xllamacpp.Server(wishes)
