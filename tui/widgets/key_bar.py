"""The keys of the moment in one line; each can be clicked."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, NamedTuple

from rich.cells import cell_len
from textual.content import Content
from textual.style import Style
from textual.widget import Widget

from tui.actions import REGISTRY
from tui.i18n import _

if TYPE_CHECKING:
    from textual.screen import Screen


class Key(NamedTuple):
    """One thing that can be done now."""

    key: str
    title: str
    action: str
    enabled: bool


class KeyBar(Widget):
    """A footer that speaks the language of the moment; one widget, drawn only when keys change."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"key-bar--key", "key-bar--title", "key-bar--off"}
    DEFAULT_CSS = """
    KeyBar {
        dock: bottom;
        height: 1;
        width: 1fr;
        background: $footer-background;
        color: $footer-foreground;
        .key-bar--key { color: $footer-key-foreground; text-style: bold; }
        .key-bar--title { color: $footer-description-foreground; }
        .key-bar--off { color: $footer-description-foreground 50%; }
    }
    """

    def on_mount(self) -> None:
        """Draw again whenever the focus, or what is possible, changes."""
        self.screen.bindings_updated_signal.subscribe(self, self._bindings_updated)

    def _bindings_updated(self, screen: Screen[object]) -> None:
        if screen is self.screen:
            self.refresh()

    def keys(self) -> list[Key]:
        """Return what can be done now, what the focused widget offers first."""
        found: dict[str, Key] = {}
        for _node, binding, enabled, _tooltip in self.screen.active_bindings.values():
            action = REGISTRY.get(binding.id or "")
            if binding.show and action is not None and binding.action not in found:
                key = self.app.get_key_display(binding)
                found[binding.action] = Key(key, _(action.title), binding.action, enabled)
        return list(found.values())

    def render(self) -> Content:
        """Draw as many as fit."""
        key_style = self.get_visual_style("key-bar--key")
        title_style = self.get_visual_style("key-bar--title")
        off_style = self.get_visual_style("key-bar--off")
        parts: list[Content] = []
        room = self.size.width
        for entry in self.keys():
            room -= cell_len(entry.key) + cell_len(entry.title) + 3
            if room < 0:
                break
            meta = Style.from_meta({"@click": entry.action}) if entry.enabled else Style()
            parts.append(
                Content.assemble(
                    (f" {entry.key}", (key_style if entry.enabled else off_style) + meta),
                    (f" {entry.title} ", (title_style if entry.enabled else off_style) + meta),
                )
            )
        return Content("").join(parts)
