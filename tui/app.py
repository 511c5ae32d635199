"""The app: which screens there are, and the session they show opened, closed and left."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar

from textual import work
from textual.app import App
from textual.binding import Binding, BindingType

from launcher.errors import LauncherError
from tui.actions import Acting, Action, bindings
from tui.actions.app import APP_ACTIONS, ShowComposer, ShowDeck, ShowLogs, ShowTopics
from tui.brake import Brake
from tui.feed import Feed, GraphReady
from tui.i18n import LANGUAGES, _, language, pick, said, set_language
from tui.messages import EmergencyChanged, LanguageChanged

if TYPE_CHECKING:
    from textual.screen import Screen

    from tui.seams import Launchpad, Order

SCREENS = {
    "deck": ("tui.screens.deck", "LessonDeck"),
    "topics": ("tui.screens.topics", "TopicsScreen"),
    "composer": ("tui.screens.composer", "ComposerScreen"),
    "logs": ("tui.screens.logs", "LogsScreen"),
}
"""Imported when first shown: the first frame needs only one of them."""

TABS = (ShowDeck, ShowTopics, ShowComposer, ShowLogs)


class DeckApp(App[int], Acting):
    """One screen for the lessons."""

    TITLE = "Deck"
    BINDINGS: ClassVar[list[BindingType]] = bindings(*APP_ACTIONS)
    ENABLE_COMMAND_PALETTE = True

    def __init__(self, pad: Launchpad, order: Order | None = None) -> None:
        """`pad` lists and opens; an `order` is opened at once, without one the picker is shown."""
        super().__init__()
        self.pad = pad
        self.order = order
        self.first_screen = "deck"
        self.feed = Feed(self)
        self.brake = Brake(self)

    def get_default_screen(self) -> Screen[Any]:
        """Begin with the lesson, or with the picker if none was named."""
        return self._session_screen(self.first_screen)

    async def show_screen(self, name: str) -> None:
        """Bring one of `SCREENS` to the front."""
        await self.switch_screen(self._session_screen(name))

    def _session_screen(self, name: str) -> Screen[Any]:
        """Return the screen called `name`, made when first asked for."""
        if not self.is_screen_installed(name):
            module, made = SCREENS[name]
            self.install_screen(getattr(import_module(module), made)(), name)
        return self.get_screen(name)

    def on_ready(self) -> None:
        """Open what was ordered, now that the first frame is out."""
        if self.order is not None:
            self.open(self.order)

    @work(exclusive=True, group="session")
    async def open(self, order: Order) -> None:
        """Start or attach to a session and show it until it ends."""
        try:
            link = await self.pad.open(order)
        except LauncherError as error:
            self.refuse(error)
            return
        self.brake.forget()
        self.feed.connect(link, self.pad.observe(link.session))
        await self.feed.listen()

    def refuse(self, error: LauncherError) -> None:
        """Say why nothing was opened."""
        words = "\n".join(said(part) for part in error.args if isinstance(part, str)) or str(error)
        self.exit(error.exit_code, message=words)

    def on_graph_ready(self, message: GraphReady) -> None:
        """Take the update that waits."""
        del message
        update = self.feed.take_update()
        if update is not None:
            self.brake.see(update)

    def emergency_changed(self) -> None:
        """Tell every screen, and the keys: a release is possible only when engaged."""
        self.feed.tell(lambda: EmergencyChanged(self.brake.state))
        self.refresh_bindings()

    def tabs(self, front: str) -> Sequence[tuple[str, str, bool]]:
        """Return (text, action, in front) of every screen of the session."""
        return [
            (f"{self.key_of(tab)} {_(tab.title)}", f"app.act({tab.id!r})", tab.screen == front)
            for tab in TABS
        ]

    def state_words(self) -> Sequence[str]:
        """Return what runs, in words: the longest first, the last always fits."""
        session = self.feed.session
        if session is None:
            return (said(self.feed.ended),) if self.feed.ended else ()
        nodes = self.feed.nodes.values()
        well = sum(node.state.value in {"ready", "running"} for node in nodes)
        count = f"{well}/{len(nodes)}"
        title = f"{session.lesson} {pick(session.title)}".strip() or session.name
        domain = _("domain {domain}").format(domain=session.domain)
        return (
            f"{title} · {session.hardware} · {domain} · {count}",
            f"{title} · {count}",
            f"{session.name} · {count}",
            count,
        )

    def key_of(self, action: type[Action[Any]]) -> str:
        """Return how the first key of `action` is written."""
        key = self._keymap.get(action.id, action.key).split(",")[0]
        return self.get_key_display(Binding(key, ""))

    def switch_language(self) -> None:
        """Speak the next language, and draw every text anew."""
        after = LANGUAGES[(LANGUAGES.index(language()) + 1) % len(LANGUAGES)]
        set_language(after)
        self.feed.tell(LanguageChanged)
        self.refresh_bindings()
