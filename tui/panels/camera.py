"""The camera picture, at a rate that a slow line can carry."""

from __future__ import annotations

from functools import partial
from time import monotonic

from textual.app import ComposeResult

from graph.data import GraphUpdate
from graph.heavy_types import COMPRESSED_IMAGE, IMAGE
from graph.pictures.picture import Picture
from robot.topics import CAMERA
from text.figures import whole
from text.i18n import N_, _, localized
from tui.panels.panel import Panel, newest, other_type, row_of, trouble_of
from tui.session.messages import PicturesChanged
from tui.widgets.image_view import ImageView
from tui.widgets.trouble import lost_words, trouble_words

PERIOD_S = 0.3
"""Three pictures a second are enough for a terminal, and for SSH."""


class CameraPanel(Panel):
    """The newest picture."""

    title = N_("Camera")
    least = 6
    weight = 5

    def __init__(self) -> None:
        super().__init__()
        self._shown_s = float("-inf")
        self._refused = False
        """Whether an error message is shown because the last message was not a picture."""
        self._in_sight = False

    def compose(self) -> ComposeResult:
        yield ImageView(bits=4)

    def pictures(self) -> set[str]:
        """The picture, unless the panel is on another page: it is a megabyte ten times a second."""
        return {CAMERA} if self._in_sight else set()

    def on_show(self) -> None:
        self._in_sight = True
        self.post_message(PicturesChanged())

    def on_hide(self) -> None:
        self._in_sight = False
        self.post_message(PicturesChanged())

    def show(self, update: GraphUpdate) -> None:
        """Show the newest picture, at most as often as the line allows."""
        view = self.query_one(ImageView)
        sample = newest(update, CAMERA)
        trouble, detail, age_s = trouble_of(update, CAMERA)
        if trouble is not None:
            self._refused = False
            row = row_of(update, CAMERA)
            words = lost_words() if row and row.raw_from_afar else None
            view.show_words(*(words or (trouble_words(trouble, age_s), detail)))
            return
        if sample is None:
            if not view.has_picture and not self._refused:
                view.show_words(_("waiting for the first picture"), CAMERA)
            return
        if sample.type_name != COMPRESSED_IMAGE and (wrong := other_type(sample, IMAGE)) is not None:
            self._refuse(*wrong)
            return
        now_s = monotonic()
        if view.has_picture and now_s - self._shown_s < PERIOD_S:
            return
        self._shown_s = now_s
        row = row_of(update, CAMERA)
        if row is not None and row.pictures_from:
            row = row_of(update, row.pictures_from)
        hz = "" if row is None or row.hz is None else whole(row.hz)
        title = _("this picture cannot be shown")
        view.read(sample, partial(self._show_read, hz), lambda error: self._refuse(title, localized(error.words)))

    def _show_read(self, hz: str, picture: Picture) -> None:
        self._refused = False
        self.query_one(ImageView).show(picture.rgb, f"{picture.width}×{picture.height}", hz=hz)

    def _refuse(self, headline: str, detail: str) -> None:
        self._refused = True
        self.query_one(ImageView).show_words(headline, detail)
