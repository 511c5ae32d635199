"""The panels of the Deck: created with the session, or when others start publishing."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from textual.widgets import Static

from launcher.profile.panels import PANELS, panels_for
from text.i18n import _, ngettext
from text.plain import plain
from tui import clock
from tui.session.watching import robot_nodes

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from textual.screen import Screen

    from graph.data import GraphUpdate
    from launcher.status import SessionInfo
    from tui.panels.panel import Panel
    from tui.panels.panel_grid import PanelGrid

SMALL = (60, 18)
"""Columns and rows of the terminal below which panels are hidden."""


class DeckPanels:
    """Puts panels onto the `#board` of a screen, or says why there are none.

    The screen has the class `-with-panels` while there are panels, and `-small` while they do not
    fit.
    """

    def __init__(self, screen: Screen[None]) -> None:
        self._screen = screen
        self._grid: PanelGrid | None = None
        self._put: set[str] = set()
        """Panels that were added for topics that others publish."""
        self._watched: Watched | None = None

    @property
    def all(self) -> Sequence[Panel]:
        """All panels, shown or not."""
        return () if self._grid is None else self._grid.panels

    @property
    def pages(self) -> int:
        return 0 if self._grid is None or self._screen.has_class("-small") else self._grid.pages

    def turn_page(self) -> None:
        if self._grid is not None:
            self._grid.turn()

    @property
    def chosen(self) -> Panel | None:
        """The chosen panel, None if there are none or they do not fit."""
        return None if self._grid is None or not self.pages else self._grid.chosen

    @property
    def have_focus(self) -> bool:
        return self._grid is not None and self._grid.has_focus

    def choose_next(self) -> Panel | None:
        return None if self._grid is None else self._grid.choose_next(1)

    def watched(self) -> set[str]:
        """Return the topics that the panels show."""
        return set().union(*(panel.watched() for panel in self.all))

    def pictures(self) -> set[str]:
        """Return the topics of which the panels show the pictures now."""
        return set().union(*(panel.pictures() for panel in self.all))

    def kept(self) -> set[str]:
        """Return the topics whose history a panel shows."""
        return set().union(*(panel.kept() for panel in self.all))

    def followed(self) -> set[str]:
        """Return the topics of which the panels need every message."""
        return set().union(*(panel.followed() for panel in self.all))

    def take(self, update: GraphUpdate, *, seen: bool) -> None:
        """Update the panels; hidden ones take in only what they will need later."""
        for panel in self.all:
            panel.take(update, seen=seen)

    def measure_room(self, columns: int, rows: int) -> None:
        """Hide the panels if they do not fit."""
        self._screen.set_class(columns < SMALL[0] or rows < SMALL[1], "-small")

    async def put_up(self, names: Iterable[str]) -> None:
        """Replace the panels of the previous session with those of this one."""
        self._put.clear()
        self._watched = None
        await self._put_up(names)

    async def put_up_for(self, update: GraphUpdate, session: SessionInfo) -> bool:
        """Say which nodes run, and add panels for topics that have appeared; none is removed.

        Return whether any was added.
        """
        if self._watched is None:
            beyond = session.discovery != "localhost"
            self._watched = Watched(session.domain, beyond=beyond)
        words = self._watched.words(update)
        watched = self._screen.query_one("#watched", Static)
        # Updating a Static repeats the layout of the screen, and graph updates are frequent.
        if words != watched.content:
            watched.update(words)
        wanted = panels_for({row.name for row in update.topics if row.publishers})
        if self._put.issuperset(wanted):
            return False
        self._put |= set(wanted)
        await self._put_up([name for name in PANELS if name in self._put])
        return True

    async def _put_up(self, names: Iterable[str]) -> None:
        if self._grid is not None:
            self._screen.minimize()
            await self._grid.remove()
            self._grid = None
        panels = [made(name) for name in names if name in PANELS]
        self._screen.set_class(bool(panels), "-with-panels")
        if panels:
            from tui.panels.panel_grid import PanelGrid

            self._grid = PanelGrid(panels, id="panel-grid")
            await self._screen.query_one("#board").mount(self._grid, after="#nodes")
        self.say_small()

    def say_small(self) -> None:
        """Prepare the words that stand where the panels do not fit, in the current language."""
        words = _("Too small for panels: they need {columns}×{rows}")
        self._screen.query_one("#small", Static).update(words.format(columns=SMALL[0], rows=SMALL[1]))


def made(name: str) -> Panel:
    """Make the panel of this name: the class `SonarPanel` of the module `tui.panels.sonar`."""
    panel: Panel = getattr(import_module(f"tui.panels.{name}"), f"{name.title()}Panel")()
    return panel


MOST_NAMES = 12
LONGEST_NAME = 60
"""The list on the Graph screen shows longer names in full."""


class Watched:
    """Says who is there, and remembers that somebody was."""

    def __init__(self, domain: int, *, beyond: bool = False) -> None:
        """`beyond`: whether other machines are looked at as well."""
        self._domain, self._beyond = domain, beyond
        self._met = False
        self._gone_s: float | None = None
        """Since when nobody is seen, of those who were; Unix time."""

    def words(self, update: GraphUpdate) -> str:
        """Return which nodes are there, and that Deck neither starts nor stops them."""
        names = robot_nodes(update)
        if names:
            self._met, self._gone_s = True, None
            return _named([_shown(name.lstrip("/")) for name in names])
        if not self._met:
            return self._nobody_yet()
        if self._gone_s is None:
            self._gone_s = update.time_s
        words = (
            _("Nobody is seen any more since {time}: the network may be down, or all nodes have ended.")
            if self._beyond
            else _("Nobody is seen any more since {time}.")
        )
        return words.format(time=clock.time_of_day(self._gone_s))

    def _nobody_yet(self) -> str:
        words = (
            _(
                "Nobody is here yet. Start a node with ROS_DOMAIN_ID={domain}, here or on another"
                " machine that lets others in, or look elsewhere: deck watch --domain N."
            )
            if self._beyond
            else _(
                "Nobody is here yet. Start a node with ROS_DOMAIN_ID={domain}, or look elsewhere:"
                " deck watch --domain N, and --discovery subnet for other machines."
            )
        )
        return words.format(domain=self._domain)


def _named(names: list[str]) -> str:
    more = f" +{len(names) - MOST_NAMES}" if len(names) > MOST_NAMES else ""
    count = ngettext("{n} node runs here", "{n} nodes run here", len(names)).format(n=len(names))
    ours = _("Deck has started nothing here and stops nothing when it leaves.")
    return f"{ours} {count}: {', '.join(names[:MOST_NAMES])}{more}"


def _shown(name: str) -> str:
    return plain(name if len(name) <= LONGEST_NAME else name[: LONGEST_NAME - 1] + "…")
