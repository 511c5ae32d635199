"""The themes that Deck offers first; Textual's own are in the palette too."""

from __future__ import annotations

from textual.theme import Theme

HIGH_CONTRAST = Theme(
    name="high-contrast",
    primary="#00aaff",
    secondary="#ffffff",
    accent="#ffff00",
    warning="#ffff00",
    error="#ff5555",
    success="#00ff00",
    foreground="#ffffff",
    background="#000000",
    surface="#000000",
    panel="#202020",
    dark=True,
    text_alpha=1.0,
    variables={
        "text-muted": "#ffffff",
        "text-disabled": "#c0c0c0",
        "block-cursor-background": "#ffff00",
        "block-cursor-foreground": "#000000",
        "block-cursor-blurred-background": "#404040",
        "border": "#ffffff",
        "border-blurred": "#c0c0c0",
    },
)

_BRIGHT = {"success": "#55ff55", "warning": "#ffff55", "error": "#ff5555", "accent": "#55ffff"}
_DARK = {"success": "#00aa00", "warning": "#aa5500", "error": "#aa0000", "accent": "#0000aa"}
CYCLE = ("textual-dark", "textual-light", HIGH_CONTRAST.name)
"""The themes that the theme key switches between."""


def after(theme: str) -> str:
    """Return the next theme in the cycle."""
    return CYCLE[(CYCLE.index(theme) + 1) % len(CYCLE)] if theme in CYCLE else CYCLE[0]


def few_colours(*, dark: bool) -> dict[str, str]:
    """Return the theme variables that carry meaning, for a terminal with 16 colours.

    Each is one of these 16 (`rich.palette`), bright on dark and dark on light. Any other colour is
    shown as the nearest of them, and the pale green and red of a theme are both nearest to light
    grey.
    """
    colours = _BRIGHT if dark else _DARK
    return {f"{prefix}{name}": value for name, value in colours.items() for prefix in ("", "text-")}
