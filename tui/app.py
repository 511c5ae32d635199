"""The app: its screens, its languages and themes, and the session opened, closed and left."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Iterable, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from textual import work
from textual.app import App, SystemCommand
from textual.binding import Binding, BindingType

from launcher.errors import LauncherError
from tui.actions import REGISTRY, Acting, Action, bindings, bound
from tui.actions.app import (
    APP_ACTIONS,
    EmergencyRelease,
    ShowComposer,
    ShowDeck,
    ShowLogs,
    ShowTopics,
)
from tui.brake import Brake
from tui.emergency import stop_words
from tui.feed import Feed, GraphReady
from tui.i18n import LANGUAGES, NAMES, _, language, pick, said, set_language
from tui.messages import EmergencyChanged, LanguageChanged
from tui.orders import Order
from tui.screens.opening import OpeningScreen
from tui.themes import CYCLE, HIGH_CONTRAST, after
from tui.widgets.plain import plain

if TYPE_CHECKING:
    from textual.command import Provider
    from textual.driver import Driver
    from textual.screen import Screen

    from launcher.status import Stray
    from tui.seams import Launchpad

SCREENS = {
    "picker": ("tui.screens.picker", "PickerScreen"),
    "deck": ("tui.screens.deck", "LessonDeck"),
    "topics": ("tui.screens.topics", "TopicsScreen"),
    "composer": ("tui.screens.composer", "ComposerScreen"),
    "logs": ("tui.screens.logs", "LogsScreen"),
}
"""Imported when first shown: the first frame needs only one of them."""

TABS = (ShowDeck, ShowTopics, ShowComposer, ShowLogs)
WELL = frozenset({"ready", "running"})


def _commands() -> type[Provider]:
    from tui.palette import Commands

    return Commands


class DeckApp(App[int], Acting):
    """One screen for the lessons."""

    TITLE = "Deck"
    BINDINGS: ClassVar[list[BindingType]] = bindings(*APP_ACTIONS)
    COMMANDS: ClassVar = {_commands}
    ENABLE_COMMAND_PALETTE = False
    """Textual's own key for it; ours speaks the language of the screen."""

    def __init__(
        self,
        pad: Launchpad,
        order: Order,
        first_screen: str = "deck",
        driver_class: type[Driver] | None = None,
    ) -> None:
        """`pad` lists and opens; an `order` that names nothing is asked for by the picker."""
        super().__init__(driver_class=driver_class)
        self.pad = pad
        self.defaults = order
        """What every order has: hardware, overrides, domain."""
        self.feed = Feed(self)
        self.brake = Brake(self)
        self.parting_words = ""
        """Said on the terminal after the screen has gone."""
        self._picking = order.profile is None and order.attach is None
        self._first_screen = "picker" if self._picking else first_screen
        self._strays_asked: set[Stray] = set()
        self._opening = ""
        self._leaving = False
        self.register_theme(HIGH_CONTRAST)

    # Screens

    def get_default_screen(self) -> Screen[Any]:
        """Begin with a screen that costs next to nothing: nobody waits for a first frame."""
        return OpeningScreen(_("Lessons") if self._picking else self._ordered())

    def on_mount(self) -> None:
        """Go on when the first frame is out."""
        # A moment of rest lets the threads that write to the terminal have their turn.
        self.call_after_refresh(self.set_timer, 0.01, self._begin)

    async def _begin(self) -> None:
        """Show the lesson, or the picker if none was named, and open what was ordered."""
        await self.push_screen(self._made_screen(self._first_screen))
        if not self._picking:
            self.open(self.defaults)

    def _ordered(self) -> str:
        """Name what is being opened."""
        name = self.defaults.attach or (self.defaults.profile or Path()).stem
        return _("opening {name}…").format(name=name)

    async def show_screen(self, name: str) -> None:
        """Bring one of `SCREENS` to the front."""
        await self.switch_screen(self._made_screen(name))

    def _made_screen(self, name: str) -> Screen[Any]:
        """Return the screen called `name`, made when first asked for."""
        if not self.is_screen_installed(name):
            module, made = SCREENS[name]
            self.install_screen(getattr(import_module(module), made)(), name)
        return self.get_screen(name)

    def show_help(self) -> None:
        """Explain the screen in front."""
        from tui.screens.help import HelpScreen

        if not isinstance(self.screen, HelpScreen):
            self.push_screen(HelpScreen(self.screen))

    # The session

    @work(exclusive=True, group="session")
    async def open(self, order: Order) -> None:
        """Start or attach to a session and show it until it ends."""
        self._opening = order.attach or (order.profile or Path()).stem
        try:
            if self._picking:
                await self.show_screen("deck")
            link = await self.pad.open(order)
        except LauncherError as error:
            await self._refuse(error)
            return
        finally:
            self._opening = ""
        self.brake.forget()
        self.feed.connect(link, self.pad.observe(link.session))
        self.brake.prepare()
        self.refresh_bindings()
        await self.feed.listen()
        self.refresh_bindings()

    async def _refuse(self, error: LauncherError) -> None:
        """Say why nothing was opened: where it was picked, or by ending."""
        reason = _words_of(error)
        if not self._picking or self._leaving:
            self.parting_words = reason
            self.exit(return_code=error.exit_code)
            return
        from tui.screens.refused import RefusedScreen

        await self._show_picker()
        self.push_screen(RefusedScreen(reason))

    @work(group="strays")
    async def ask_about(self, found: tuple[Stray, ...]) -> None:
        """Offer to stop what an earlier run left behind, once."""
        from tui.screens.strays import StraysScreen

        strays = tuple(stray for stray in found if stray not in self._strays_asked)
        self._strays_asked.update(strays)
        if not strays:
            return
        if await self.push_screen_wait(StraysScreen(strays)) and self.feed.link is not None:
            with contextlib.suppress(LauncherError):
                await self.feed.link.stop_strays(strays)

    @work(exclusive=True, group="leaving")
    async def close_session(self) -> None:
        """Stop the nodes that this screen has started, or let go of the others; then pick anew."""
        await self._end_session()
        await self._show_picker()

    async def _show_picker(self) -> None:
        """Go back to the list; the screens of the session go with it."""
        self._picking = True
        self.feed.close()
        await self.show_screen("picker")
        for name in SCREENS:
            if name != "picker" and self.is_screen_installed(name):
                old = self.get_screen(name)
                self.uninstall_screen(old)
                if old.is_running:
                    await old.remove()

    async def _end_session(self) -> None:
        """Stop or let go of the session, with a dialog that shows what is waited for."""
        from tui.screens.stopping import StoppingScreen

        link, graph = self.feed.link, self.feed.graph
        if link is None or not link.session.foreground:
            await self.feed.disconnect()
            return
        dialog = StoppingScreen()
        await self.push_screen(dialog)
        ending = [asyncio.ensure_future(link.shutdown())]
        if graph is not None:
            ending.append(asyncio.ensure_future(asyncio.to_thread(graph.stop)))
        await asyncio.gather(*ending, return_exceptions=True)
        await self.feed.disconnect()
        if dialog.is_running and self.screen is dialog:
            await dialog.dismiss()

    @work(group="leaving")
    async def stop_now(self) -> None:
        """Skip the waiting for nodes that do not end by themselves."""
        link = self.feed.link
        if link is None:
            self.exit(return_code=self.return_code or 0)
            return
        with contextlib.suppress(LauncherError):
            await link.shutdown(now=True)

    @property
    def crashed(self) -> bool:
        """Whether the app ended by a fault of its own."""
        return self._exception is not None

    def leave(self, code: int = 0) -> None:
        """Stop what this screen has started, and end; asked again, at once."""
        if self._leaving:
            self.stop_now()
            return
        self._leaving = True
        self.end(code)

    @work(exclusive=True, group="leaving")
    async def end(self, code: int) -> None:
        """End the session, then the app."""
        await self._end_session()
        self.exit(return_code=code)

    # What the feed and the brake tell

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

    # Words

    def tabs(self, front: str) -> Sequence[tuple[str, str, bool]]:
        """Return (text, action, in front) of every screen of the session."""
        return [
            (f"{self.keys_of(tab)[0]} {_(tab.title)}", f"app.act({tab.id!r})", tab.screen == front)
            for tab in TABS
        ]

    @property
    def state_look(self) -> str:
        """How the title looks: `stop` while stopped, `alarm` while the safety node holds."""
        if self.feed.link is None:
            return "state"
        return (
            "stop" if self.brake.state.engaged else "alarm" if self.brake.state.blocked else "state"
        )

    def state_words(self) -> Sequence[str]:
        """Return what runs, in words, from long to short; the first that fits is shown."""
        session = self.feed.session
        look = self.state_look
        if look == "stop":
            return stop_words(self.brake.state, self.keys_of(EmergencyRelease)[0])
        if look == "alarm":
            reason = plain(self.brake.state.blocked, 400)
            return (_("⚠ Motion is held: {reason}").format(reason=reason), f"⚠ {reason}")
        if session is None:
            if self.feed.ended:
                return (said(self.feed.ended), _("ended"))
            return (_("opening {name}…").format(name=self._opening),) if self._opening else ()
        nodes = self.feed.nodes.values()
        well = sum(node.state.value in WELL for node in nodes)
        count = f"{'●' if well == len(nodes) else '◔'} {well}/{len(nodes)}"
        title = f"{session.lesson} {pick(session.title)}".strip() or session.name
        domain = _("domain {domain}").format(domain=session.domain)
        return (
            f"{title} · {session.hardware} · {domain} · {count}",
            f"{title} · {count}",
            f"{session.name} · {count}",
            count,
        )

    def keys_of(self, action: type[Action[Any]]) -> list[str]:
        """Return how the keys of `action` are written, those of the user's keymap."""
        keys = self._keymap.get(action.id, action.key).split(",")
        return [self.key_text(key.strip()) for key in keys]

    def key_text(self, key: str) -> str:
        """Return how a key is written."""
        return self.get_key_display(Binding(key, ""))

    def get_system_commands(self, screen: Screen[Any]) -> Iterable[SystemCommand]:
        """Fill the palette from the actions that are possible now."""
        targets = ((screen, bound(screen)), (self, bound(self)))
        for target, actions in targets:
            for action in actions:
                if action.palette and action.possible(target):
                    run = partial(action.run, target)
                    yield SystemCommand(_(action.title), _(action.tooltip), run)
        for code, name in NAMES.items():
            yield SystemCommand(name, _("Speak this language."), partial(self.speak, code))
        for theme in sorted(self.available_themes):
            words = _("Theme: {name}").format(name=theme)
            take = partial(setattr, self, "theme", theme)
            yield SystemCommand(words, _("Take these colours."), take, theme in CYCLE)

    def show_palette(self) -> None:
        """Open the palette in the language spoken now."""
        from textual.command import CommandPalette

        if not isinstance(self.screen, CommandPalette):
            words = _("What is to be done?")
            self.push_screen(CommandPalette(placeholder=words, id="--command-palette"))

    def action_help_quit(self) -> None:
        """Ctrl+C copies elsewhere: say how to leave."""
        self.notify(_("Press q, or Ctrl+Q in a text field, to leave."), markup=False)

    def speak(self, code: str) -> None:
        """Speak this language from now on, and draw every text anew."""
        set_language(code)
        for screen in self.screen_stack:
            screen.post_message(LanguageChanged())
        self.feed.tell(LanguageChanged)
        self.refresh_bindings()

    def switch_language(self) -> None:
        """Speak the next language."""
        self.speak(LANGUAGES[(LANGUAGES.index(language()) + 1) % len(LANGUAGES)])

    def redraw(self) -> None:
        """Draw everything anew."""
        self.refresh(layout=True)

    def get_key_display(self, binding: Binding) -> str:
        """Return how a key is written, in the language spoken now."""
        return _("space") if binding.key == "space" else super().get_key_display(binding)

    def next_theme(self) -> None:
        """Take the next theme of the cycle."""
        self.theme = after(self.theme)


def every_action() -> frozenset[str]:
    """Return the binding id of every action there is; it takes every screen to know them."""
    for module, _made in SCREENS.values():
        import_module(module)
    for dialog in ("help", "refused", "stopping", "strays"):
        import_module(f"tui.screens.{dialog}")
    return frozenset(REGISTRY)


def _words_of(error: LauncherError) -> str:
    """Return an error in the language spoken now, every problem of a profile on its line."""
    problems: Sequence[Any] = getattr(error, "problems", ())
    if not problems:
        return said(error.args[0]) if error.args else str(error)
    lines = []
    for problem in problems:
        field = f"{problem.field}: " if problem.field else ""
        hint = f" ({said(problem.hint)})" if problem.hint else ""
        lines.append(f"{problem.where}: {field}{said(problem.message)}{hint}")
    return "\n".join(lines)


def run_screen(
    profile: Path | None,
    *,
    hardware: str = "mock",
    overrides: Sequence[str] = (),
    domain: int | None = None,
    lang: str | None = None,
    attach: str | None = None,
) -> int:
    """Show the screen until it is left; return the exit code of the program.

    With a `profile` that is started, with `attach` that session is shown, else one is picked.
    """
    from tui.live import run_live

    order = Order(profile, attach, hardware, tuple(overrides), domain)
    return run_live(order, lang)
