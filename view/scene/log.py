"""What the nodes say on /rosout, and what Deck has to say of their messages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.plain import plain
from view.scene.drawn import Drawn

if TYPE_CHECKING:
    from view.scene.drawn import Message

LOG = "log"
"""The root of all log lines in the tree of entities."""
OURS = "deck"
LEVELS = ((50, "CRITICAL"), (40, "ERROR"), (30, "WARN"), (20, "INFO"), (0, "DEBUG"))
"""Least numbers of `rcl_interfaces/msg/Log` and Rerun's names."""
LONGEST, LONGEST_NAME = 4000, 200


def rosout(topic: str, message: Message) -> list[Drawn]:
    """Return a line of a node."""
    import rerun

    del topic
    number = int(message["level"])
    level = next(name for least, name in LEVELS if number >= least)
    node = plain(str(message["name"]), LONGEST_NAME) or "?"
    line = rerun.TextLog(plain(str(message["msg"]), LONGEST), level=level)
    return [Drawn((LOG, node), (line,))]


def remark(words: str) -> Drawn:
    """Return a line of Deck's own."""
    import rerun

    return Drawn((LOG, OURS), (rerun.TextLog(plain(words, LONGEST), level="WARN"),))
