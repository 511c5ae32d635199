"""What the screen of topics does with images: decoded as they come, the late ones left out."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from graph.pictures.picture import COMPRESSED, IMAGE, Picture, ramp_colours
from graph.pictures.pixels import ImageError, UnknownEncodingError
from graph.pictures.reading import read_picture
from text.i18n import _, decimal, said
from text.plain import plain
from tui.topics.plotting import PlotPlace, TopicsPlotting
from tui.topics.table_columns import hz_text
from tui.widgets.image_view import Scale

if TYPE_CHECKING:
    from graph.data import Sample

STEADY_S, LIVELY_S = 0.25, 0.1
"""Seconds between two updates, without and with a picture in front."""
RATES_S = 0.2
"""Rates are not shown more often than so."""
LONGEST = 80


class TopicsPictures(TopicsPlotting):
    """A screen that shows the newest image of the chosen topic."""

    def __init__(self) -> None:
        super().__init__()
        self._waiting: Sample | None = None
        """The newest of those that came while another was decoded."""
        self._decoding = False
        self._rates_s = 0.0

    @property
    def shows_image(self) -> bool:
        """Whether the chosen topic carries images."""
        row = self.table.chosen_row if self.is_mounted else None
        return row is not None and not {IMAGE, COMPRESSED}.isdisjoint(row.type_names)

    @property
    def shows_picture(self) -> bool:
        """Whether a picture is on the screen and goes on."""
        in_front = self.detail.front is self.detail.picture and not self.is_covered
        return in_front and not self.detail.echo.paused

    def toggle_picture(self) -> None:
        """Show an image as a picture, or as a tree."""
        if self.detail.as_endpoints:
            self.detail.show_as_endpoints(False)
        else:
            self.detail.show_as_picture(not self.detail.as_picture)
        self.keep_pace()

    def show_plot(self, place: PlotPlace) -> None:
        """Show the plot there; it may cover a picture."""
        super().show_plot(place)
        self.keep_pace()

    def keep_pace(self) -> None:
        """Ask for updates as often as what is shown needs them."""
        period_s = LIVELY_S if self.shows_picture else STEADY_S
        if period_s != self.period_s:
            self.period_s = period_s
            self.topics_changed()

    def is_time_for_rates(self, time_s: float) -> bool:
        """Tell whether rates are to be shown now; pictures come more often than those change."""
        if self.period_s == LIVELY_S and 0 <= time_s - self._rates_s < RATES_S:
            return False
        self._rates_s = time_s
        return True

    def show_message(self, sample: Sample) -> None:
        """Show a message of the chosen topic, an image as a picture if that is wanted."""
        first = self.detail.sample is None
        self.detail.show_message(sample)
        if sample.type_name in {IMAGE, COMPRESSED}:
            if first:
                self.detail.show_as_picture(True)
            if self.shows_picture:
                self._show_picture(sample)
        if first:
            self.keep_pace()

    def _show_picture(self, sample: Sample) -> None:
        if sample.type_name == IMAGE:
            # A millisecond: less than to go to another thread and back.
            try:
                self._put(read_picture(IMAGE, sample.value, self.detail.picture.wanted))
            except ImageError as error:
                self._refuse(sample, error)
            return
        self._waiting = sample
        if not self._decoding:
            self._decoding = True
            self.run_worker(self._decode(), group="pictures")

    async def _decode(self) -> None:
        """Decode the newest image there is, until there is none."""
        try:
            while self._waiting is not None:
                sample, self._waiting = self._waiting, None
                fit = self.detail.picture.wanted
                try:
                    found = await asyncio.to_thread(read_picture, COMPRESSED, sample.value, fit)
                except ImageError as error:
                    if self._is_wanted(sample):
                        self._refuse(sample, error)
                else:
                    if self._is_wanted(sample):
                        self._put(found)
        finally:
            self._decoding = False

    def _is_wanted(self, sample: Sample) -> bool:
        """Tell whether the sample's topic is still the one that is shown, as a picture."""
        return self.is_attached and sample.topic == self.table.chosen and self.shows_picture

    def _put(self, picture: Picture) -> None:
        row = self.table.chosen_row
        size = f"{plain(picture.encoding, LONGEST)} {picture.width}×{picture.height}"
        scale = None
        if picture.range_m is not None:
            near, far = (_("{n} m").format(n=decimal(f"{metres:g}")) for metres in picture.range_m)
            first = _("near {distance}").format(distance=near)
            scale = Scale(first, _("{distance} far").format(distance=far), ramp_colours())
        self.detail.show_picture(picture.rgb, size, scale, hz_text(row.hz if row else None))

    def _refuse(self, sample: Sample, error: ImageError) -> None:
        headline = _("this picture cannot be shown")
        if isinstance(error, UnknownEncodingError):
            encoding = str(sample.value.get("encoding"))
            words = _("pictures of the encoding {encoding} cannot be shown")
            headline = words.format(encoding=plain(encoding, LONGEST))
        self.detail.show_no_picture(headline, said(error.words))
