"""All screens: created when first shown, removed together with the session that they showed."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from textual.app import App
from textual.widget import Widget

from tui.actions import REGISTRY

if TYPE_CHECKING:
    from textual.screen import Screen

SCREENS = {
    "picker": ("tui.picker.screen", "PickerScreen"),
    "deck": ("tui.deck.screen", "LessonDeck"),
    "lesson": ("tui.lesson.screen", "LessonScreen"),
    "topics": ("tui.topics.screen", "TopicsScreen"),
    "composer": ("tui.composer.screen", "ComposerScreen"),
    "logs": ("tui.logs.screen", "LogsScreen"),
    "graph": ("tui.graph.screen", "GraphScreen"),
    "flow": ("tui.flow.screen", "FlowScreen"),
    "devices": ("tui.devices.screen", "DevicesScreen"),
    "frames": ("tui.frame_tree.screen", "FramesScreen"),
    "space": ("tui.space.screen", "SpaceScreen"),
    "wall": ("tui.wall.screen", "WallScreen"),
}
"""Imported when first shown: the first frame needs only one of them."""

DIALOGS = (
    "tui.bags.begin",
    "tui.bags.listing",
    "tui.dialogs.choice",
    "tui.help.screen",
    "tui.lifecycle.dialogs",
    "tui.tour.screen",
)
"""Modules that define actions of their own, imported when first shown."""


class Screens:
    """The screens of one app."""

    def __init__(self, app: App[Any]) -> None:
        """Install them in `app`."""
        self._app = app

    async def show(self, name: str) -> None:
        """Bring the screen of this name (one of `SCREENS`) to the front."""
        await self._app.switch_screen(self.made(name))

    def made(self, name: str) -> Screen[Any]:
        """Return the screen called `name`, creating it on first use."""
        if not self._app.is_screen_installed(name):
            module, made = SCREENS[name]
            self._app.install_screen(getattr(import_module(module), made)(), name)
        return self._app.get_screen(name)

    async def forget(self) -> None:
        """Remove the screens of a session that is over."""
        for name in SCREENS:
            if name != "picker" and self._app.is_screen_installed(name):
                old = self._app.get_screen(name)
                self._app.uninstall_screen(old)
                if old.is_running:
                    # Textual's cache would keep alive what they have drawn.
                    for widget in (old, *old.walk_children(Widget)):
                        widget.refresh()
                    await old.remove()
        # Watchers of the theme, as every TextArea is, are kept until it changes, even once removed.
        self._app.mutate_reactive(App.theme)


def every_action() -> frozenset[str]:
    """Return the binding id of every action; this has to import every screen."""
    for module, _made in SCREENS.values():
        import_module(module)
    for dialog in DIALOGS:
        import_module(dialog)
    return frozenset(REGISTRY)
