"""Live sessions: the supervisor and the observer behind the seams of the screen.

Nothing of them is imported before the first frame is out, and then on a thread: pydantic and
rclpy take their time.
"""

from __future__ import annotations

import asyncio
import os
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING

from tui.i18n import language
from tui.orders import Lesson

if TYPE_CHECKING:
    from launcher.catalog import ProfileEntry
    from launcher.status import SessionInfo
    from tui.orders import Order
    from tui.seams import GraphLink, SessionLink


@dataclass(frozen=True)
class LivePad:
    """Opens what the launcher has."""

    async def lessons(self) -> list[Lesson]:
        """Return every profile there is, broken ones with their error."""
        return await asyncio.to_thread(_lessons)

    async def running(self) -> list[SessionInfo]:
        """Return the sessions that run in the background."""
        await _imported("launcher.client")
        from launcher.client import running

        return await asyncio.to_thread(running)

    async def open(self, order: Order) -> SessionLink:
        """Start the profile, or attach to the session."""
        await _imported("launcher.client", "graph.observer")
        from launcher import client

        if order.profile is None:
            return await client.attach(order.attach)
        return await client.launch(
            order.profile,
            hardware=order.hardware,
            overrides=order.overrides,
            domain=order.domain,
            foreground=True,
            node_lang=language(),
        )

    def observe(self, session: SessionInfo) -> GraphLink:
        """Return the graph of the session's domain."""
        from graph.observer import Observer
        from launcher.discovery import hurry_discovery

        hurry_discovery(os.environ, session.discovery)
        return Observer(session.domain, session.discovery)


async def _imported(*modules: str) -> None:
    """Import on a thread, so that the screen answers meanwhile."""
    for module in modules:
        await asyncio.to_thread(import_module, module)


def _lessons() -> list[Lesson]:
    from launcher.catalog import list_profiles

    return [_lesson(entry) for entry in list_profiles()]


def _lesson(entry: ProfileEntry) -> Lesson:
    return Lesson(
        name=entry.name,
        path=entry.path,
        title=entry.title,
        about=entry.about,
        lesson=entry.lesson,
        nodes=entry.nodes,
        panels=entry.panels,
        error=entry.error,
    )
