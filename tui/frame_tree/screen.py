"""The tree of frames, what is wrong with it, and where one frame is in another."""

from __future__ import annotations

from typing import ClassVar

from text.i18n import N_
from tui.frame.screen import DeckScreen


class FramesScreen(DeckScreen):
    """The tree of frames, what is wrong with it, and where one frame is in another."""

    tab: ClassVar[str] = "frames"
    about: ClassVar[str] = N_("The tree of the frames on /tf and /tf_static.")
    wants_frames = True
