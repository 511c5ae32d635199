"""`deck level`: from which severity on a running node logs; read, or set.

Exit codes: 0 if it was read or set, 1 if the node refuses, does not answer, or is not there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cli.observing import domain_view
from cli.running_domain import beyond_this_machine
from text.i18n import localized
from text.output import say_error, write
from text.plain import plain

if TYPE_CHECKING:
    from argparse import Namespace


def level_command(options: Namespace) -> int:
    """Print the level that the node has now."""
    node = f"/{options.node.removeprefix('/')}"
    with domain_view(options.domain, options.discovery) as view:
        found = view.finds(node)
        inner = view.observer.inner
        asked = inner.logger_level(node) if options.level is None else inner.set_logger_level(node, options.level)
        result = asked.result()
    if result.error:
        say_error(f"deck: {plain(localized(result.error))}")
        if not found and (hint := beyond_this_machine(view.discovery)):
            say_error(f"deck: {localized(hint)}")
        return 1
    write(plain(result.level))
    return 0
