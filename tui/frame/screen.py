"""What every session screen has: title, banner of agents, keys, and the data it asks for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from textual import on
from textual.events import ScreenResume
from textual.screen import Screen
from textual.widgets import Input, TextArea

from tui.actions import Acting, bindings
from tui.emergency.messages import EmergencyChanged
from tui.frame import title
from tui.frame.actions.enlarge import enlarge
from tui.frame.agent_banner import AgentBanner
from tui.frame.host import Host, host_of
from tui.frame.key_bar import KeyBar
from tui.frame.replay_bar import ReplayBar
from tui.frame.title_bar import TitleBar
from tui.session.messages import AgentsChanged, LanguageChanged, SessionChanged, StatusChanged
from tui.widgets.working import Working

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from textual.app import ComposeResult
    from textual.binding import BindingType
    from textual.widget import Widget

    from tui.actions import Action
    from tui.session.feed import Feed

BREAKPOINTS = [(0, "-tiny"), (60, "-compact"), (100, "-home"), (160, "-wide")]
"""Widths at which a screen changes its class: 80x24 is -compact, 120x40 -home, 200x60 -wide."""
HEIGHTS = [(0, "-flat"), (20, "-low"), (34, "-tall"), (50, "-high")]
"""Heights: 80x24 is -low, 120x40 -tall, 200x60 -high."""


class DeckScreen(Screen[None], Acting, Working):
    """Base of the screens that show a session.

    A subclass yields its widgets in `compose_body`, names its topics in `watch_topics` and
    `follow_topics`, and handles the messages of `tui.session.messages` that it needs. When the
    topics it wants have changed, it calls `topics_changed`. The keys space, Ctrl+X, Ctrl+R, Ctrl+P,
    Ctrl+Q, q, L, F1 to F5, 0 to 9, and Shift with F4, F5 and F9 belong to the app.

    `z` gives the whole screen to one of its `parts`, below the title and above the keys; focusing
    something else ends that.
    """

    BINDINGS: ClassVar[list[BindingType]] = bindings(enlarge)
    ALLOW_IN_MAXIMIZED_VIEW = "TitleBar, AgentBanner, ReplayBar, KeyBar"
    HORIZONTAL_BREAKPOINTS = BREAKPOINTS
    VERTICAL_BREAKPOINTS = HEIGHTS
    DEFAULT_CSS = """
    DeckScreen { layers: base overlay; layout: vertical; }
    DeckScreen.-maximized-view {
        TitleBar { dock: top; }
        .-maximized {
            width: 1fr !important; height: 1fr !important;
            max-width: 100% !important; max-height: 100% !important;
        }
    }
    """

    tab: ClassVar[str] = ""
    """The tab of the title bar that is highlighted while this screen is in front."""
    about: ClassVar[str] = ""
    """What the screen shows, in a few sentences for the help page, marked by `N_`."""
    parts: ClassVar[tuple[str, ...]] = ()
    """Selectors of what can be enlarged; if the focus is in none of them, the first one shown."""
    period_s: float = 0.25
    """Seconds between two updates of the graph while this screen is in front."""
    measure_all: bool = False
    """Whether the rates of every topic are wanted while this screen is in front."""
    measure_images: bool = True
    """Whether those of topics with pictures are, too, as far as they come from this machine."""
    wants_frames: bool = False
    """Whether the frames of /tf and /tf_static are wanted while this screen is in front."""
    _styled_for: tuple[str, frozenset[str], frozenset[str]] | None = None
    _focused_before: Widget | None = None
    """What had the focus when a part was enlarged."""

    @property
    def deck(self) -> Host:
        return host_of(self)

    @property
    def feed(self) -> Feed:
        """The session and its graph: `link`, `graph`, `nodes`, `session`, `update`."""
        return self.deck.feed

    def compose(self) -> ComposeResult:
        """Surround the body with the frame."""
        yield TitleBar()
        yield AgentBanner()
        yield from self.compose_body()
        yield ReplayBar()
        yield KeyBar()

    def compose_body(self) -> ComposeResult:
        """Yield the widgets between the title and the keys."""
        yield from ()

    def watch_topics(self) -> set[str]:
        """Return the topics whose newest message is needed while this screen is in front."""
        return set()

    def picture_topics(self) -> set[str]:
        """Return the topics of which it shows the pictures now."""
        return set()

    def past_topics(self) -> set[str]:
        """Return the topics of which it shows the past, also that before it was opened."""
        return set()

    def follow_topics(self) -> set[str]:
        """Return the topics of which every message is needed, even while another is in front."""
        return set()

    def keep_topics(self) -> set[str]:
        """Return the watched topics that are needed even while another is in front."""
        return set()

    def watch_goals(self) -> set[str]:
        """Return the actions whose goals from others are needed while this screen is in front."""
        return set()

    async def ros2_command(self) -> str:
        """Return what is chosen or filled in as a command line of `ros2`, empty if nothing is."""
        return ""

    def more_keys(self) -> Iterable[tuple[str, Sequence[Action[Any]]]]:
        """Yield headings and actions of the parts of the screen that have keys of their own."""
        yield from ()

    def part_to_enlarge(self) -> Widget | None:
        """Return the part that has the focus, else the first one that is shown."""
        around = [] if self.focused is None else self.focused.ancestors_with_self
        shown = [part for name in self.parts for part in self.query(name) if _is_shown(part)]
        return next((part for part in shown if part in around), shown[0] if shown else None)

    def toggle_enlarged(self) -> None:
        """Enlarge a part, or show all of them again."""
        part = self.part_to_enlarge() if self.maximized is None else None
        if part is None:
            self.minimize()
        else:
            self.enlarge(part)

    def enlarge(self, part: Widget) -> None:
        """Give the whole screen to this part, and the focus to what can be scrolled in it."""
        if self.maximized is None:
            self._focused_before = self.focused
        self.maximized = part
        inside = [one for one in self.focus_chain if part in one.ancestors_with_self]
        if self.focused not in inside:
            lists = [one for one in inside if not isinstance(one, (Input, TextArea))]
            self.set_focus(lists[0] if lists else None)
        self.refresh_bindings()

    def watch_maximized(self, before: Widget | None, now: Widget | None) -> None:
        """Give the focus back once all parts are shown again."""
        if before is None or now is not None:
            return
        had, self._focused_before = self._focused_before, None
        is_there = had is None or had.is_attached
        if is_there and self.focused in (None, *before.walk_children()):
            self.set_focus(had)
        self.refresh_bindings()

    def watch_focused(self, focused: Widget | None) -> None:
        """Show all parts again as soon as one that is hidden gets the focus."""
        large = self.maximized
        if large is not None and focused is not None and large not in focused.ancestors_with_self:
            self.minimize()

    def on_compose(self) -> None:
        """Set the classes for this size before the children exist, so that each is styled once."""
        across, down = self.app.size
        sizes = self._get_breakpoint_classes(across, BREAKPOINTS)
        sizes |= self._get_breakpoint_classes(down, HEIGHTS)
        self.update_classes(dict.fromkeys(sizes, True), update=False)
        self.app.stylesheet.apply(self)
        self._styled_for = self._surroundings()

    def topics_changed(self) -> None:
        """Tell the app that the topics this screen needs have changed."""
        if self.is_current:
            self.feed.ask_for_topics()

    def on_mount(self) -> None:
        """Show the frame, and ask for what happened before this screen was opened."""
        self.show_frame()
        self.feed.catch_up(self)

    def on_unmount(self) -> None:
        self.feed.forget(self)

    def on_pictures_changed(self) -> None:
        """Request the pictures that are shown now, and those only."""
        self.topics_changed()

    def on_screen_resume(self) -> None:
        self.show_frame()
        self.topics_changed()

    def on_status_changed(self, message: StatusChanged) -> None:
        del message
        self.show_frame()

    def on_session_changed(self, message: SessionChanged) -> None:
        del message
        self.show_frame()

    def on_emergency_changed(self, message: EmergencyChanged) -> None:
        del message
        self.show_frame()

    def on_agents_changed(self, message: AgentsChanged) -> None:
        del message
        self.show_frame()

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self.show_frame()

    def show_frame(self) -> None:
        """Show title, session and emergency stop in their current state."""
        for bar in self.query(TitleBar):
            title.show(bar, self.deck, self.tab)
        for banner in self.query(AgentBanner):
            banner.show(self.deck)
        for place in self.query(ReplayBar):
            place.show(self.feed.replay)

    @on(ScreenResume)
    def _keep_styles(self, event: ScreenResume) -> None:
        """Restyle the hundred or so widgets only if something outside has changed."""
        around = self._surroundings()
        event.refresh_styles = around != self._styled_for
        self._styled_for = around

    def _surroundings(self) -> tuple[str, frozenset[str], frozenset[str]]:
        """Everything outside this screen that its styles depend on."""
        return self.app.theme, self.app.pseudo_classes, self.app.classes


def _is_shown(part: Widget) -> bool:
    """Return whether neither the part nor anything around it is hidden."""
    return all(node.display for node in part.ancestors_with_self)
