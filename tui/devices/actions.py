"""The actions of the Devices screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce, actions_of
from tui.devices.drivers import BATTERY, NOISE, SILENCE, UNPLUGGED, SimulatedTrouble
from tui.log_view.actions import folding, pausing, searching, taking

if TYPE_CHECKING:
    from tui.devices.screen import DevicesScreen

action: Announce[DevicesScreen] = Announce()


@action(
    "devices.tab",
    "right",
    N_("Diagnostics"),
    N_("Show what everybody says on /diagnostics as a tree, or the drivers."),
    means="the tab to the right",
    anywhere=True,
    when=lambda screen: screen.has_diagnostics,
)
def next_devices_tab(screen: DevicesScreen) -> None:
    screen.show_tree(not screen.shows_tree)


@action(
    "devices.tab_back",
    "left",
    N_("Drivers"),
    N_("Show what everybody says on /diagnostics as a tree, or the drivers."),
    means="the tab to the left",
    when=lambda screen: screen.has_diagnostics,
)
def previous_devices_tab(screen: DevicesScreen) -> None:
    screen.show_tree(not screen.shows_tree)


def _with_driver(screen: DevicesScreen) -> bool | None:
    """Only with a driver chosen."""
    return bool(screen.chosen)


pausing("devices.pause", _with_driver)


@action(
    "devices.way",
    "b",
    N_("In/out"),
    N_("Show only what comes from the device, only what goes to it, or both."),
    footer=True,
    anywhere=True,
    when=_with_driver,
)
def one_way(screen: DevicesScreen) -> None:
    screen.next_way()


@action(
    "devices.bad",
    "f",
    N_("Only bad"),
    N_("Show only noise and frames whose check failed, or all."),
    means="only",
    footer=True,
    anywhere=True,
    when=_with_driver,
    label=lambda screen: N_("All frames") if screen.only_bad else N_("Only bad"),
)
def only_bad(screen: DevicesScreen) -> None:
    screen.toggle_bad()


@action(
    "devices.hex",
    "v",
    N_("Hex"),
    N_("Show the bytes of lines of text in hex, or as text."),
    means="another view",
    footer=True,
    anywhere=True,
    when=_with_driver,
    label=lambda screen: N_("Text") if screen.frames.as_hex else N_("Hex"),
)
def in_hex(screen: DevicesScreen) -> None:
    screen.toggle_hex()


folding("devices", _with_driver)


@action(
    "devices.clear",
    "d",
    N_("Clear"),
    N_("Forget the frames received so far."),
    means="clear",
    footer=True,
    when=_with_driver,
)
def clear_frames(screen: DevicesScreen) -> None:
    screen.clear_frames()


taking("devices", _with_driver)
searching("devices", _with_driver)


def _may_have(screen: DevicesScreen, trouble: SimulatedTrouble) -> bool:
    """Only a device of the simulated robot that can have this trouble."""
    found = screen.simulated
    return found is not None and found[1] in trouble.devices


def _making(id: str, key: str, trouble: SimulatedTrouble, title: str, tooltip: str) -> None:
    footer = trouble is UNPLUGGED

    @action(id, key, title, tooltip, footer=footer, when=lambda screen: _may_have(screen, trouble))
    def switch(screen: DevicesScreen) -> None:
        screen.switch_trouble(trouble)


_making(
    *("devices.unplug", "U", UNPLUGGED, N_("Pull cable")),
    N_("Simulated robot: unplug the selected device; press again to plug it in."),
)
_making(
    *("devices.noise", "Z", NOISE, N_("Noise")),
    N_("Simulated robot: noise on the line of the selected device; press again to end it."),
)
_making(
    *("devices.silence", "H", SILENCE, N_("Silence")),
    N_("Simulated robot: silence the selected device; press again to undo."),
)
_making(
    *("devices.battery", "B", BATTERY, N_("Low battery")),
    N_("Simulated robot: the battery of Pico and servos is weak; press again to charge it."),
)
DEVICES_ACTIONS = actions_of(__name__)
