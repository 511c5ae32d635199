"""`deck level`: from which severity on a running node logs; read, or set.

Exit codes: 0 if it was read or set, 1 if the node refuses, does not answer, or is not there.
"""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from cli.running_domain import beyond_this_machine, running_domain
from graph.observer.observer import Observer
from launcher.processes.shared_memory_unfinished import discard_unfinished
from text.i18n import localized
from text.output import keep_stdout_to_ourselves, say_error, write
from text.plain import plain

if TYPE_CHECKING:
    from argparse import Namespace

    from graph.data import GraphUpdate

SEEN_WITHIN_S = 3.0
"""How long a node may take to be discovered."""


def level_command(options: Namespace) -> int:
    """Print the level that the node has now."""
    node = f"/{options.node.removeprefix('/')}"
    _name, domain, discovery = running_domain(options.domain, options.discovery)
    keep_stdout_to_ourselves()
    # There may be no supervisor here that does it.
    discard_unfinished()
    observer = Observer(domain, discovery)
    seen = threading.Event()

    def look(update: GraphUpdate) -> None:
        if update.error or any(row.name == node for row in update.nodes):
            seen.set()

    observer.start(look)
    try:
        seen.wait(SEEN_WITHIN_S)
        if options.level is None:
            result = observer.inner.logger_level(node).result()
        else:
            result = observer.inner.set_logger_level(node, options.level).result()
    finally:
        observer.stop()
    if result.error:
        say_error(f"deck: {plain(localized(result.error))}")
        if not seen.is_set() and (hint := beyond_this_machine(discovery)):
            say_error(f"deck: {localized(hint)}")
        return 1
    write(plain(result.level))
    return 0
