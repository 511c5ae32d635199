"""All screens: created when first shown, removed together with the session that they showed."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple

from textual.app import App
from textual.widget import Widget

from text.i18n import N_
from tui.actions import REGISTRY

if TYPE_CHECKING:
    from textual.screen import Screen


class ScreenEntry(NamedTuple):
    """Where a screen is, and what its key, the title bar, the help and the palette say of it."""

    folder: str
    """In `tui`; what can be done on the screen is in the module `actions` there."""
    made: str
    """The class in the module `screen`."""
    key: str = ""
    """In Textual's notation; none for the list of lessons, where one is without a session."""
    title: str = ""
    about: str = ""

    def load(self) -> type[Screen[Any]]:
        """Return the class: the first frame needs only one of them."""
        screen: type[Screen[Any]] = getattr(import_module(f"tui.{self.folder}.screen"), self.made)
        return screen


SCREENS = {
    "picker": ScreenEntry("picker", "PickerScreen"),
    "deck": ScreenEntry(
        "deck", "LessonDeck", "1,f2", N_("Deck"), N_("The lesson at work: nodes, sensors, wheels, head and voice.")
    ),
    "lesson": ScreenEntry(
        "lesson",
        "LessonScreen",
        "L",
        N_("Lesson"),
        N_("The task of this step, what is judged of your nodes, and hints."),
    ),
    "topics": ScreenEntry(
        "topics", "TopicsScreen", "2,f3", N_("Topics"), N_("Every topic with its rates; the selected one live.")
    ),
    "composer": ScreenEntry(
        "composer",
        "ComposerScreen",
        "3,f4",
        N_("Composer"),
        N_("Write the JSON that an LLM would send, and see the result."),
    ),
    "logs": ScreenEntry(
        "logs", "LogsScreen", "4,f5", N_("Logs"), N_("The messages of all nodes: filter, search, save.")
    ),
    "graph": ScreenEntry(
        "graph", "GraphScreen", "5", N_("Graph"), N_("Who talks to whom; call services, send goals, set parameters.")
    ),
    "flow": ScreenEntry(
        "flow",
        "FlowScreen",
        "6",
        N_("Flow"),
        N_("One timeline of all nodes: what followed from a word that was said."),
    ),
    "devices": ScreenEntry(
        "devices",
        "DevicesScreen",
        "7",
        N_("Devices"),
        N_("Every driver, what it is connected to, and what goes over its port."),
    ),
    "frames": ScreenEntry(
        "frame_tree",
        "FramesScreen",
        "8",
        N_("Frames"),
        N_("The tree of frames: who publishes them, how often, and what is wrong with it."),
    ),
    "space": ScreenEntry(
        "space", "SpaceScreen", "9", N_("Space"), N_("The robot, its map and what its sensors see, from above.")
    ),
    "wall": ScreenEntry(
        "wall",
        "WallScreen",
        "0",
        N_("Wall"),
        N_("Distances, picture, wheels and words as large as possible, to be read across a room; Esc goes back."),
    ),
}
"""In the order in which the top line names them."""

DIALOGS = (
    "tui.bags.begin",
    "tui.bags.listing",
    "tui.dialogs.choice",
    "tui.help.screen",
    "tui.lifecycle.dialogs",
    "tui.topics.actions_of_publish",
    "tui.tour.screen",
    "tui.viewing.dialog",
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
            self._app.install_screen(SCREENS[name].load()(), name)
        return self._app.get_screen(name)

    def there(self) -> list[Screen[Any]]:
        """Return the screens that were made, in front or not."""
        return [self._app.get_screen(name) for name in SCREENS if self._app.is_screen_installed(name)]

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
    for screen in SCREENS.values():
        screen.load()
    for dialog in DIALOGS:
        import_module(dialog)
    return frozenset(REGISTRY)
