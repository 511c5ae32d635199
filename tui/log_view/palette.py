"""The colours of the log: from the theme for severities, from a fixed cycle of hues for nodes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rich.style import Style
from textual.color import Color

from tui.log_view.rows import WORDS

if TYPE_CHECKING:
    from textual.widget import Widget

_HUES = (200, 130, 285, 45, 170, 325, 90, 240)
PARTS = ("muted", "marker", "found", "cursor", *(word.lower() for word in WORDS))
PALETTE_CLASSES = {f"log--{part}" for part in PARTS}
PALETTE_CSS = """
    .log--muted { color: $foreground 60%; }
    .log--marker { color: $text-warning; text-style: italic; }
    .log--found { background: $warning; color: auto 90%; text-style: bold; }
    .log--cursor { background: $primary 35%; }
    .log--debug { color: $foreground 60%; }
    .log--info { color: $foreground; }
    .log--warn { color: $text-warning; text-style: bold; }
    .log--error { color: $text-error; text-style: bold; }
    .log--fatal { background: $error; color: auto 90%; text-style: bold; }
"""


@dataclass(frozen=True)
class Palette:
    """The styles of the current theme."""

    base: Style
    muted: Style
    severities: tuple[Style, ...]
    """By rank."""
    nodes: tuple[Style, ...]
    marker: Style
    found: Style
    cursor: Style
    selection: Style

    def node(self, place: int) -> Style:
        return self.nodes[place % len(self.nodes)]


def palette_of(widget: Widget) -> Palette:
    """Return the styles of the widget's current theme."""

    def part(name: str, *, partial: bool = False) -> Style:
        return widget.get_component_rich_style(f"log--{name}", partial=partial)

    base = widget.rich_style
    cursor = part("cursor")
    return Palette(
        base=base,
        muted=part("muted"),
        severities=tuple(part(word.lower()) for word in WORDS),
        nodes=tuple(base + style for style in _node_styles(dark=widget.app.current_theme.dark)),
        marker=part("marker"),
        found=part("found"),
        cursor=Style(bgcolor=cursor.bgcolor),
        selection=widget.screen.get_component_rich_style("screen--selection"),
    )


def _node_styles(*, dark: bool) -> list[Style]:
    lightness = 0.72 if dark else 0.34
    return [Style(color=Color.from_hsl(hue / 360, 0.55, lightness).rich_color) for hue in _HUES]
