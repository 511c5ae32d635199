"""The keys that can be used now in one line; each can be clicked."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from rich.cells import cell_len
from textual.content import Content
from textual.style import Style
from textual.widget import Widget

from text.i18n import _
from tui.actions import REGISTRY

if TYPE_CHECKING:
    from collections.abc import Iterable

    from textual.binding import ActiveBinding
    from textual.events import MouseMove
    from textual.screen import Screen

    from tui.actions import Action


SPARED = "app.palette"
"""Left out on a very narrow terminal."""


class Key(NamedTuple):
    """One action that can be run now."""

    key: str
    title: str
    id: str
    enabled: bool
    everywhere: bool
    """Whether it is an action of the app."""


class KeyBar(Widget):
    """A footer in the current language; one widget, drawn only when keys change."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"key-bar--key", "key-bar--title", "key-bar--off"}
    DEFAULT_CSS = """
    KeyBar {
        dock: bottom;
        height: 1;
        width: 1fr;
        background: $footer-background;
        color: $footer-foreground;
        link-style: none;
        link-color: $footer-description-foreground;
        link-background: transparent;
        link-style-hover: reverse;
        .key-bar--key { color: $footer-key-foreground; text-style: bold; }
        .key-bar--title { color: $footer-description-foreground; }
        .key-bar--off { color: $footer-description-foreground 50%; }
    }
    """

    def on_mount(self) -> None:
        """Redraw whenever the focus, or what is possible, changes."""
        self.screen.bindings_updated_signal.subscribe(self, self._bindings_updated)

    def _bindings_updated(self, screen: Screen[object]) -> None:
        if screen is self.screen:
            self.refresh()

    def keys(self) -> list[Key]:
        """Return the actions that can be run now, those of the focused widget first."""
        found: dict[str, list[ActiveBinding]] = {}
        for active in self.screen.active_bindings.values():
            name = active.binding.id or ""
            if active.binding.show and name in REGISTRY and REGISTRY[name].shown(active.node):
                found.setdefault(name, []).append(active)
        place = _places(found)
        names = sorted(found, key=lambda name: (found[name][0].node is self.app, place[name]))
        return [self._key(REGISTRY[name], found[name]) for name in names]

    def _key(self, action: Action[Any], keys: list[ActiveBinding]) -> Key:
        """Return the action with the first of its keys that the focused widget does not take."""
        wanted = action.key.split(",")
        first = min(keys, key=lambda one: (*wanted, one.binding.key).index(one.binding.key))
        key = self.app.get_key_display(first.binding)
        everywhere = first.node is self.app
        return Key(key, _(action.label(first.node)), action.id, first.enabled, everywhere)

    def on_mouse_move(self, event: MouseMove) -> None:
        """Explain the key under the pointer."""
        name = event.style.meta.get("key-bar", "")
        self.tooltip = _(REGISTRY[name].tooltip) if name in REGISTRY else None

    async def action_press(self, name: str) -> None:
        for active in self.screen.active_bindings.values():
            if active.binding.id == name:
                await self.app.run_action(active.binding.action, active.node)
                return

    def render(self) -> Content:
        """Draw the keys of the app on the right, and before them as many others as fit."""
        keys = self.keys()
        always = [entry for entry in keys if entry.everywhere]
        room = self.size.width - sum(map(_cells, always))
        if room < 0:
            # The help page has all keys, including that of the palette.
            always = [entry for entry in always if entry.id != SPARED]
        shown: list[Key] = []
        for entry in keys:
            room -= 0 if entry.everywhere else _cells(entry)
            if not entry.everywhere and room >= 0:
                shown.append(entry)
        return Content("").join(map(self._drawn, [*shown, *always]))

    def _drawn(self, entry: Key) -> Content:
        key_style = self.get_visual_style("key-bar--key" if entry.enabled else "key-bar--off")
        title_style = self.get_visual_style("key-bar--title" if entry.enabled else "key-bar--off")
        meta = {"@click": f"press({entry.id!r})"} if entry.enabled else {}
        click = Style.from_meta({"key-bar": entry.id, **meta})
        return Content.assemble((f" {entry.key}", key_style + click), (f" {entry.title} ", title_style + click))


def _places(names: Iterable[str]) -> dict[str, tuple[int, int]]:
    """Order these actions by module, in the order in which they appear, then within it.

    The registry has the modules in the order of import, which is accidental.
    """
    met: dict[str, int] = {}
    for name in names:
        met.setdefault(REGISTRY[name].module, len(met))
    return {
        name: (met[action.module], place)
        for place, (name, action) in enumerate(REGISTRY.items())
        if action.module in met
    }


def _cells(entry: Key) -> int:
    return cell_len(entry.key) + cell_len(entry.title) + 3
