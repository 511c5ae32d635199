"""The actions of the Devices screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce, actions_of
from tui.devices.drivers import BATTERY, NOISE, SILENCE, UNPLUGGED, SimulatedTrouble

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


@action(
    "devices.pause",
    "p",
    N_("Pause"),
    N_("Pause while frames come in, or follow the newest again."),
    footer=True,
    anywhere=True,
    when=_with_driver,
    label=lambda screen: N_("Pause") if screen.pane.view.following else N_("Resume"),
)
def pause_frames(screen: DevicesScreen) -> None:
    screen.pane.view.toggle_following()


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


@action(
    "devices.fold",
    "w",
    N_("Wrap"),
    N_("Wrap long lines, or show one row of each: left and right shift it."),
    footer=True,
    anywhere=True,
    when=_with_driver,
)
def fold_frames(screen: DevicesScreen) -> None:
    screen.pane.view.set_fold(not screen.pane.view.fold)


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


@action(
    "devices.copy",
    "y",
    N_("Copy"),
    N_("Copy the selected lines to the clipboard of your terminal."),
    footer=True,
    when=_with_driver,
)
def copy_frames(screen: DevicesScreen) -> None:
    screen.pane.copy()


@action(
    "devices.save",
    "W",
    N_("Write"),
    N_("Write the selected lines to a file, or all lines shown if none is selected."),
    means="write to a file",
    footer=True,
    when=_with_driver,
)
def save_frames(screen: DevicesScreen) -> None:
    screen.pane.save()


@action(
    "devices.search",
    "slash,ctrl+f",
    N_("Search"),
    N_("Find text in the frames as you type; Escape ends it."),
    means="find",
    priority=True,
    anywhere=True,
    when=lambda screen: _with_driver(screen) and not screen.pane.prompt.kind,
)
def search_frames(screen: DevicesScreen) -> None:
    screen.pane.search()


@action("devices.next", "n", N_("Next"), N_("Go to the next frame found."), means="next", when=_with_driver)
def next_frame(screen: DevicesScreen) -> None:
    screen.pane.find(1)


@action(
    "devices.previous",
    "N",
    N_("Previous"),
    N_("Go to the previous frame found."),
    means="previous",
    when=_with_driver,
)
def previous_frame(screen: DevicesScreen) -> None:
    screen.pane.find(-1)


def _may_have(screen: DevicesScreen, trouble: SimulatedTrouble) -> bool:
    """Only a device of the simulated robot that can have this trouble."""
    found = screen.simulated
    return found is not None and found[1] in trouble.devices


@action(
    "devices.unplug",
    "U",
    N_("Pull cable"),
    N_("Simulated robot: unplug the selected device; press again to plug it in."),
    footer=True,
    when=lambda screen: _may_have(screen, UNPLUGGED),
)
def unplug(screen: DevicesScreen) -> None:
    screen.switch_trouble(UNPLUGGED)


@action(
    "devices.noise",
    "Z",
    N_("Noise"),
    N_("Simulated robot: noise on the line of the selected device; press again to end it."),
    when=lambda screen: _may_have(screen, NOISE),
)
def noise(screen: DevicesScreen) -> None:
    screen.switch_trouble(NOISE)


@action(
    "devices.silence",
    "H",
    N_("Silence"),
    N_("Simulated robot: silence the selected device; press again to undo."),
    when=lambda screen: _may_have(screen, SILENCE),
)
def silence(screen: DevicesScreen) -> None:
    screen.switch_trouble(SILENCE)


@action(
    "devices.battery",
    "B",
    N_("Low battery"),
    N_("Simulated robot: the battery of Pico and servos is weak; press again to charge it."),
    when=lambda screen: _may_have(screen, BATTERY),
)
def low_battery(screen: DevicesScreen) -> None:
    screen.switch_trouble(BATTERY)


DEVICES_ACTIONS = actions_of(__name__)
