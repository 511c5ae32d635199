"""The camera picture, at a rate that a slow line can carry."""

from __future__ import annotations

from time import monotonic
from typing import TYPE_CHECKING

from graph.pictures.images import to_rgb
from graph.pictures.pixels import ImageError
from robot.topics import CAMERA
from text.figures import whole
from text.i18n import N_, _, localized
from tui.panels.other_type import other_type
from tui.panels.panel import Panel, newest, row_of, trouble_of
from tui.widgets.image_view import ImageView
from tui.widgets.trouble import trouble_words

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from graph.data import GraphUpdate

TYPE = "sensor_msgs/msg/Image"
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

    def compose(self) -> ComposeResult:
        """The picture."""
        yield ImageView(bits=4)

    def watched(self) -> set[str]:
        """The picture."""
        return {CAMERA}

    def show(self, update: GraphUpdate) -> None:
        """Show the newest picture, at most as often as the line allows."""
        view = self.query_one(ImageView)
        sample = newest(update, CAMERA)
        trouble, detail, age_s = trouble_of(update, CAMERA)
        if trouble is not None:
            self._refused = False
            view.show_words(trouble_words(trouble, age_s), detail)
            return
        if sample is None:
            if not view.has_picture and not self._refused:
                view.show_words(_("waiting for the first picture"), CAMERA)
            return
        if (wrong := other_type(sample, TYPE)) is not None:
            self._refuse(view, *wrong)
            return
        now_s = monotonic()
        if view.has_picture and now_s - self._shown_s < PERIOD_S:
            return
        self._shown_s = now_s
        try:
            picture = to_rgb(sample.value)
        except ImageError as error:
            self._refuse(view, _("this picture cannot be shown"), localized(error.words))
            return
        self._refused = False
        row = row_of(update, CAMERA)
        hz = "" if row is None or row.hz is None else whole(row.hz)
        view.show(picture, f"{picture.shape[1]}×{picture.shape[0]}", hz=hz)

    def _refuse(self, view: ImageView, headline: str, detail: str) -> None:
        self._refused = True
        view.show_words(headline, detail)
