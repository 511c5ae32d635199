"""Decodes compressed pictures as they arrive, beside everything else, the newest only."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TYPE_CHECKING

from graph.pictures.picture import COMPRESSED, Picture, read_picture
from graph.pictures.pixels import ImageError

if TYPE_CHECKING:
    from textual.widget import Widget

    from graph.data import Sample
    from graph.pictures.picture import Fit


class NewestPicture:
    """Reads one picture after the other; those that are outdated by then are left out."""

    def __init__(
        self,
        widget: Widget,
        fit: Fit,
        show: Callable[[Sample, Picture], None],
        refuse: Callable[[Sample, ImageError], None],
    ) -> None:
        """`fit` as for `read_picture`; `show` or `refuse` is called with each that is read."""
        self._widget = widget
        self._fit = fit
        self._show = show
        self._refuse = refuse
        self._waiting: Sample | None = None
        """The newest one that came while another was being decoded."""
        self._decoding = False

    def take(self, sample: Sample) -> None:
        self._waiting = sample
        if not self._decoding:
            self._decoding = True
            self._widget.run_worker(self._decode(), group="pictures")

    async def _decode(self) -> None:
        try:
            while self._waiting is not None:
                sample, self._waiting = self._waiting, None
                try:
                    found = await asyncio.to_thread(read_picture, COMPRESSED, sample.value, self._fit)
                except ImageError as error:
                    self._refuse(sample, error)
                else:
                    self._show(sample, found)
        finally:
            self._decoding = False
