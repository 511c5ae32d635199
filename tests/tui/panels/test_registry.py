"""Each panel that a profile may name has a place on the screen."""

from typing import get_args

from launcher.profile.panels import Panel
from tui.panels.registry import PANELS


def test_the_screens_know_the_panels_that_a_profile_may_name() -> None:
    assert tuple(PANELS) == get_args(Panel)
