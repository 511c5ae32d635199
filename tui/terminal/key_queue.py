"""Keeps keys in the order in which they were pressed, however busy the screen is.

Textual passes a key to the widget that has the focus when it arrives. A key that moves the focus
takes effect later: on its way up from that widget to the app, where most keys are bound. Keys typed
in the meantime would go to the widget that is about to lose the focus, and be lost.
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
"""A key that takes longer no longer holds up others: its widget may be gone."""


class KeyQueue:
    """Keys typed while another key is on its way, and the state of that key."""

    def __init__(self, app: MessagePump) -> None:
        """Pass waiting keys to `app` later."""
        self._app = app
        self._waiting: deque[Key | Paste] = deque()
        self._due: Key | Paste | None = None
        self._number = 0
        self._giving_up: asyncio.TimerHandle | None = None
        self._busy = False

    def must_wait(self, event: Key | Paste) -> bool:
        """Whether it is not the key's turn yet."""
        return self._busy and event is not self._due

    def wait(self, event: Key | Paste) -> None:
        """Keep the key until it is its turn."""
        self._waiting.append(event)

    def given(self, event: Key | Paste, target: DOMNode) -> None:
        """Record that a key has taken effect, or is on its way to `target` while others wait."""
        if event.is_forwarded:
            self.follow(target)
        else:
            self._next()

    def follow(self, target: DOMNode) -> None:
        """Hold the other keys until what was sent to `target` has taken effect."""
        self._busy = True
        self._number += 1
        loop = asyncio.get_running_loop()
        self._giving_up = loop.call_later(PATIENCE_S, self._arrived, self._number)
        self._climb(self._number, target, target)

    def _climb(self, number: int, node: DOMNode | None, again: DOMNode | None) -> None:
        """Visit each node behind the key: none can still handle it after this has passed.

        A widget that posts a message because of the key posts it behind this, hence a second pass.
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
        if self._giving_up is not None:
            self._giving_up.cancel()
            self._giving_up = None
        self._busy = bool(self._waiting)
        self._due = self._waiting.popleft() if self._waiting else None
        if self._due is not None:
            self._app.post_message(self._due)
