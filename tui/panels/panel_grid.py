"""The panels side by side and below each other; those that do not fit are on further pages."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, ClassVar, TypeAlias

from textual.binding import Binding, BindingType
from textual.containers import Container
from textual.events import Click, Resize
from textual.message import Message

from launcher.profile.panels import PANELS
from text.i18n import _

if TYPE_CHECKING:
    from tui.panels.panel import Panel

Row: TypeAlias = "list[Panel]"
BESIDE_FROM = 52
"""Width from which on two panels stand side by side."""
TWICE = 2


class PanelGrid(Container, can_focus=True):
    """Shows as many panels as fit, and the number of pages; one panel is the chosen one."""

    class PanelWanted(Message):
        """A panel was clicked twice."""

        def __init__(self, panel: Panel) -> None:
            super().__init__()
            self.panel = panel

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("right,down,l,j", "choose_next(1)", show=False),
        Binding("left,up,h,k", "choose_next(-1)", show=False),
    ]
    DEFAULT_CSS = """
    PanelGrid { layout: grid; grid-gutter: 0; width: 1fr; height: 1fr; overflow: hidden; }
    PanelGrid.-thin > Panel { border: none; border-top: solid $primary 60%; }
    PanelGrid.-thin > Panel:focus-within { border: none; border-top: solid $accent; }
    PanelGrid:focus > Panel.-chosen { border: round $accent; }
    PanelGrid.-thin:focus > Panel.-chosen { border: none; border-top: solid $accent; }
    """

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self._panels: list[Panel] = []
        self._page = 0
        self._frame = 2
        self._pages: list[list[list[Panel]]] = []
        self._chosen: Panel | None = None

    async def put_up(self, names: Iterable[str]) -> None:
        await self.remove_children()
        self._panels = [made(name) for name in names if name in PANELS]
        self._chosen, self._page, self._pages = None, 0, []
        await self.mount_all(self._panels)
        self._fit(*self.size)

    @property
    def chosen(self) -> Panel | None:
        shown = [panel for panel in self._panels if panel.display]
        return self._chosen if self._chosen in shown else next(iter(shown), None)

    def choose(self, panel: Panel) -> None:
        self._chosen = panel
        holds = (at for at, page in enumerate(self._pages) if any(panel in row for row in page))
        page = next(holds, self._page)
        if page != self._page:
            self._page = page
            self._lay_out(self.size.height)
        self._mark_chosen()

    def choose_next(self, step: int) -> Panel | None:
        """Choose the panel this many places further, after the last one the first; return it."""
        here = self.chosen
        if here is None:
            return None
        there = self._panels[(self._panels.index(here) + step) % len(self._panels)]
        self.choose(there)
        return there

    def action_choose_next(self, step: int) -> None:
        self.choose_next(step)

    def on_focus(self) -> None:
        self._mark_chosen()

    @property
    def pages(self) -> int:
        return len(self._pages)

    @property
    def panels(self) -> Sequence[Panel]:
        return self._panels

    def turn(self) -> None:
        if self._pages:
            self._page = (self._page + 1) % len(self._pages)
            self._lay_out(self.size.height)

    def on_click(self, event: Click) -> None:
        around = [] if event.widget is None else event.widget.ancestors_with_self
        clicked = [panel for panel in self._panels if panel in around]
        for panel in clicked:
            self.choose(panel)
            if event.chain == TWICE:
                self.post_message(self.PanelWanted(panel))
                return
        first = next((panel for panel in self._panels if panel.display), None)
        if first is not None and event.screen_y == first.region.y and self.pages > 1:
            self.turn()

    def on_resize(self, event: Resize) -> None:
        self._fit(*event.size)

    def _fit(self, width: int, height: int) -> None:
        self._frame = 2 if width >= BESIDE_FROM else 1
        self.set_class(self._frame == 1, "-thin")
        before = self.pages
        self._pages = paged(in_rows(self._panels, width), height, self._frame)
        if self.pages != before:
            # The key that turns the page is shown only with several pages.
            self.screen.refresh_bindings()
        self._page = min(self._page, max(0, len(self._pages) - 1))
        self._lay_out(height)

    def on_language_changed(self) -> None:
        self._lay_out(self.size.height)

    def _lay_out(self, height: int) -> None:
        rows = self._pages[self._page] if self._pages else []
        columns = max((len(row) for row in rows), default=1)
        self.styles.grid_size_columns = columns
        self.styles.grid_rows = " ".join(map(str, heights(rows, height, self._frame))) or "1fr"
        shown = [panel for row in rows for panel in row]
        for panel in self._panels:
            panel.display = panel in shown
            panel.styles.column_span = 1
        for row in rows:
            row[-1].styles.column_span = columns - len(row) + 1
        at = {"page": self._page + 1, "pages": len(self._pages)}
        whole, short = _("· page {page} of {pages}: v"), _("· p. {page}/{pages}: v")
        words = (whole.format(**at), short.format(**at)) if len(self._pages) > 1 else ()
        for panel in self._panels:
            panel.name_page(*(words if panel in shown[:1] else ()))
        self._mark_chosen()

    def _mark_chosen(self) -> None:
        chosen = self.chosen
        for panel in self._panels:
            panel.set_class(panel is chosen, "-chosen")


def made(name: str) -> Panel:
    """Make the panel of this name: the class `SonarPanel` of the module `tui.panels.sonar`."""
    panel: Panel = getattr(import_module(f"tui.panels.{name}"), f"{name.title()}Panel")()
    return panel


def in_rows(panels: Sequence[Panel], width: int) -> list[Row]:
    """Put panels into rows, two in each if there is room."""
    rows: list[Row] = []
    half: Row | None = None
    for panel in panels:
        if width < max(BESIDE_FROM, panel.across_below):
            rows.append([panel])
        elif half is None:
            half = [panel]
            rows.append(half)
        else:
            half.append(panel)
            half = None
    return rows


def paged(rows: Sequence[Row], height: int, frame: int) -> list[list[Row]]:
    """Put each row onto the first page with enough room, given the lines of a page."""
    pages: list[list[Row]] = []
    rooms: list[int] = []
    for row in rows:
        needed = frame + least(row)
        at = next((at for at, room in enumerate(rooms) if needed <= room), len(pages))
        if at == len(pages):
            pages.append([])
            rooms.append(height)
        pages[at].append(row)
        rooms[at] -= needed
    return pages


def heights(rows: Sequence[Row], height: int, frame: int) -> list[int]:
    """Divide the lines of a page: each row gets its minimum, and the rest is shared by weight.

    What a row has no use for goes to others, the heaviest first.
    """
    weights = [max(panel.weight for panel in row) for row in rows]
    spare = max(0, height - sum(frame + least(row) for row in rows))
    shares = [spare * weight // sum(weights) for weight in weights]
    lines = [useful(row, least(row) + share) for row, share in zip(rows, shares, strict=True)]
    left = max(0, height - sum(frame + each for each in lines))
    by_weight = sorted(range(len(rows)), key=lambda at: -weights[at])
    for at in by_weight:
        more = useful(rows[at], lines[at] + left) - lines[at]
        lines[at], left = lines[at] + more, left - more
    for at in by_weight[:1]:
        lines[at] += left
    return [frame + each for each in lines]


def least(row: Row) -> int:
    return max(panel.least for panel in row)


def useful(row: Row, lines: int) -> int:
    """Return of how many of these lines a row has any use."""
    return max(panel.useful(lines) for panel in row)
