"""The list of layers beside the picture: what is shown, how often it comes, and what is wrong."""

from __future__ import annotations

import textwrap
from functools import lru_cache
from typing import TYPE_CHECKING

from rich.cells import cell_len
from textual.events import Click

from graph.data import Trouble
from text.figures import figure
from text.i18n import _, localized
from text.plain import plain
from tui import clock
from tui.widgets.rows import MARK, Cell, Column, Row, Rows
from tui.widgets.trouble import advice, no_data_words

if TYPE_CHECKING:
    from tui.space.layers import SpaceLayer
    from tui.space.stage import Stage

FRAMES = "frames"
"""Key of the layer of frames; those of topics begin with a slash."""
ON, OFF = "●", "○"
RATE, RATE_HELD_S = 6, 1.0
LONGEST = 300


class LayerRows(Rows):
    """Layers, below each what is wrong with it; a click on its mark shows or hides it."""

    DEFAULT_CSS = """
    LayerRows { width: 30%; min-width: 29; max-width: 48; padding-right: 1; border-left: solid $panel; }
    """

    def __init__(self) -> None:
        super().__init__(header=False, id="space-layers")
        self._rates: dict[str, tuple[float, str]] = {}
        """Topic to when its rate was shown first, and what was shown."""

    def on_click(self, event: Click) -> None:
        super().on_click(event)
        if event.x <= MARK + 2 and event.chain == 1:
            self.action_open()

    def show_stage(self, stage: Stage) -> None:
        width = max(8, self.size.width - MARK - 3)
        frames = len(stage.buffer.frames)
        rows = [_head(FRAMES, _("frames"), str(frames or "–"), on=stage.show_frames)]
        if stage.show_frames:
            words = localized(stage.frames_why) if frames else _("nobody publishes /tf")
            rows += _words(words, width)
        for layer in stage.layers:
            rate = self._rate(layer)
            rows.append(
                _head(layer.topic, _short(layer.topic, width - RATE - 2), rate if layer.on else "", on=layer.on)
            )
            if layer.on:
                trouble = trouble_of_layer(layer)
                rows += _words(trouble, width)
                if not trouble and (calm := layer.frame or _rest_of(layer)):
                    rows.append(Row("", (Cell(""), Cell(plain(calm, width), "dim"))))
        columns = [Column("", 1), Column(""), Column("", RATE, right=True)]
        self.show(columns, rows)

    def _rate(self, layer: SpaceLayer) -> str:
        """Return how often it comes; it changes all the time, and need not be read so often."""
        if layer.row is None or layer.row.hz is None:
            self._rates.pop(layer.topic, None)
            return "–"
        now_s = clock.steady()
        since_s, shown = self._rates.get(layer.topic, (-RATE_HELD_S, ""))
        if now_s - since_s >= RATE_HELD_S:
            shown = figure(layer.row.hz, 1)
            self._rates[layer.topic] = now_s, shown
        return shown


def _head(key: str, name: str, rate: str, *, on: bool) -> Row:
    mark = Cell(ON, "good") if on else Cell(OFF, "dim")
    return Row(key, (mark, Cell(name, "" if on else "dim"), Cell(rate, "dim")))


def _short(name: str, width: int) -> str:
    name = plain(name)
    return name if cell_len(name) <= width else "…" + name[1 - max(2, width) :]


@lru_cache(maxsize=256)
def _words(words: str, width: int) -> tuple[Row, ...]:
    lines = textwrap.wrap(plain(words, LONGEST), max(8, width))
    return tuple(Row("", (Cell(""), Cell(line, "warn"))) for line in lines)


def _rest_of(layer: SpaceLayer) -> str:
    if not layer.rests or layer.row is None:
        return ""
    age_s = layer.row.age_s
    return _("no message yet") if age_s is None else no_data_words(age_s)


def trouble_of_layer(layer: SpaceLayer) -> str:
    row = layer.row
    if row is not None and row.trouble is not None and not layer.rests:
        headline, detail = advice(row)
        explained = row.trouble in {Trouble.QOS_MISMATCH, Trouble.UNKNOWN_TYPE}
        return f"{headline}: {detail}" if explained and detail else headline
    if row is not None and layer.type_name not in row.type_names:
        return _("its type is no longer {type}").format(type=layer.type_name)
    for words in (layer.refused, layer.apart, layer.reader.remark):
        if words:
            return localized(words)
    return ""
