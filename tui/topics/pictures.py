"""Images of a topic: decoded as they arrive, skipping those that are outdated by then."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from graph.data import Sample, TopicRow
from graph.heavy_types import COMPRESSED_IMAGE, IMAGE
from graph.pictures.picture import Picture, ramp_colours
from graph.pictures.pixels import ImageError, UnknownEncodingError
from text.i18n import _, decimal, localized
from text.plain import plain
from tui.topics.table import hz_text
from tui.widgets.image_view import ImageScale, NewestPicture

if TYPE_CHECKING:
    from tui.topics.detail import TopicDetail

LONGEST = 80


def carries_images(row: TopicRow | None) -> bool:
    return row is not None and not {IMAGE, COMPRESSED_IMAGE}.isdisjoint(row.type_names)


def is_image(sample: Sample) -> bool:
    return sample.type_name in {IMAGE, COMPRESSED_IMAGE}


class TopicPictures:
    """Shows the newest image of a topic in its detail, or why it cannot be shown."""

    def __init__(
        self, detail: TopicDetail, is_wanted: Callable[[Sample], bool], row: Callable[[], TopicRow | None]
    ) -> None:
        """Pass `is_wanted`, which says after decoding whether an image is still to be shown.

        `row` returns the current row of the topic.
        """
        self._detail = detail
        self._is_wanted = is_wanted
        self._row = row
        self._newest = NewestPicture(detail, self._fit, self._show, self._refuse_wanted)

    def show(self, sample: Sample) -> None:
        self._newest.take(sample)

    def _fit(self, width: int, height: int) -> tuple[int, int]:
        return self._detail.picture.wanted(width, height)

    def _show(self, sample: Sample, picture: Picture) -> None:
        if self._is_wanted(sample):
            self._put(picture)

    def _refuse_wanted(self, sample: Sample, error: ImageError) -> None:
        if self._is_wanted(sample):
            self._refuse(sample, error)

    def _put(self, picture: Picture) -> None:
        row = self._row()
        if picture.is_empty_depth:
            self._detail.picture.show_words(
                _("no valid depth"), _("no reading is a distance: each is NaN, infinite or 0")
            )
            return
        size = f"{plain(picture.encoding, LONGEST)} {picture.width}×{picture.height}"
        scale = None
        if picture.range_m is not None:
            near, far = (_("{n} m").format(n=decimal(f"{metres:g}")) for metres in picture.range_m)
            first = _("near {distance}").format(distance=near)
            scale = ImageScale(first, _("{distance} far").format(distance=far), ramp_colours())
        self._detail.picture.show(picture.rgb, size, scale, hz_text(row.hz if row else None))

    def _refuse(self, sample: Sample, error: ImageError) -> None:
        headline = _("this picture cannot be shown")
        if isinstance(error, UnknownEncodingError):
            encoding = str(sample.value.get("encoding"))
            words = _("pictures of the encoding {encoding} cannot be shown")
            headline = words.format(encoding=plain(encoding, LONGEST))
        self._detail.picture.show_words(headline, localized(error.words))
