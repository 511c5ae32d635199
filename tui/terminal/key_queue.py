"""Keys in the order in which they were pressed, however busy the screen is.

Textual hands a key to the widget that has the focus when it comes. One that puts the focus
elsewhere takes effect later: on its way up from that widget to the app, where most keys are bound.
What was typed meanwhile would go to the widget that is about to lose the focus, and be lost.
"""

from __future__ import annotations

import asyncio
from collections import deque
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from textual.dom import DOMNode
    from textual.events import Key, Paste
    from textual.message_pump import MessagePump

PATIENCE_S = 3.0
"""A key that is on its way for so long holds up no other: its widget may be gone."""


class KeyQueue:
    """What is typed while a key is on its way, and where that key is."""

    def __init__(self, app: MessagePump) -> None:
        """What has waited is given to `app` again."""
        self._app = app
        self._waiting: deque[Key | Paste] = deque()
        self._due: Key | Paste | None = None
        self._number = 0
        self._giving_up: asyncio.TimerHandle | None = None
        self._busy = False

    def must_wait(self, event: Key | Paste) -> bool:
        """Whether it is not its turn."""
        return self._busy and event is not self._due

    def wait(self, event: Key | Paste) -> None:
        """Let it come again when it is its turn."""
        self._waiting.append(event)

    def given(self, event: Key | Paste, target: DOMNode) -> None:
        """A key has taken effect, or is on its way to `target`, and the others wait for it."""
        if event.is_forwarded:
            self.follow(target)
        else:
            self._next()

    def follow(self, target: DOMNode) -> None:
        """Keep the others until what has been sent to `target` has taken effect."""
        self._busy = True
        self._number += 1
        loop = asyncio.get_running_loop()
        self._giving_up = loop.call_later(PATIENCE_S, self._arrived, self._number)
        self._climb(self._number, target, target)

    def _climb(self, number: int, node: DOMNode | None, again: DOMNode | None) -> None:
        """Come to each node behind the key: none takes it up again once this has passed.

        A widget that says something because of the key says it behind this: hence once more.
        """
        while node is not None and not node.call_later(self._climb, number, node.parent, again):
            node = node.parent
        if node is None and again is not None:
            self._climb(number, again, None)
        elif node is None:
            self._arrived(number)

    def _arrived(self, number: int) -> None:
        if number == self._number:
            self._number += 1
            self._next()

    def _next(self) -> None:
        """It is the turn of the next."""
        if self._giving_up is not None:
            self._giving_up.cancel()
            self._giving_up = None
        self._busy = bool(self._waiting)
        self._due = self._waiting.popleft() if self._waiting else None
        if self._due is not None:
            self._app.post_message(self._due)
