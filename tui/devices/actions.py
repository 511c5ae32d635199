"""The actions of the Devices screen; each letter also works as the Cyrillic one on its key."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Protocol

from text.i18n import N_
from tui.actions.action import Action
from tui.devices.trouble import BATTERY, NOISE, SILENCE, UNPLUGGED, SimulatedTrouble
from tui.log_view.actions import (
    CopyLines,
    FoldLines,
    NextLine,
    PauseLines,
    PreviousLine,
    SaveLines,
    SearchLines,
    ShowsLines,
)

if TYPE_CHECKING:
    from tui.devices.frame_rows import FrameRows
    from tui.devices.reading import Device


class DevicesTarget(ShowsLines, Protocol):
    """The part of the Devices screen that its actions use."""

    frames: FrameRows

    @property
    def chosen(self) -> Device | None:
        """The chosen driver."""

    @property
    def only_bad(self) -> bool:
        """Whether good frames are hidden."""

    @property
    def has_diagnostics(self) -> bool:
        """Whether anybody has said anything on /diagnostics."""

    @property
    def shows_tree(self) -> bool:
        """Whether the diagnostics of everybody are shown in place of the drivers."""

    def show_tree(self, shown: bool) -> None:
        """Show them, or the drivers."""

    @property
    def simulated(self) -> tuple[str, str] | None:
        """The simulated robot's node, and which of its serial lines is chosen."""

    def next_way(self) -> None:
        """Switch between both directions, in, and out."""

    def toggle_bad(self) -> None:
        """Show only noise and bad frames, or all."""

    def toggle_hex(self) -> None:
        """Show readable bytes in hex, or as text."""

    def clear_frames(self) -> None:
        """Discard all frames."""

    def switch_trouble(self, trouble: SimulatedTrouble) -> object:
        """Cause this trouble on the chosen device, or clear it."""


class NextDevicesTab(Action[DevicesTarget]):
    """Switch from the drivers to the diagnostics of everybody, and back."""

    id = "devices.tab"
    key = "right"
    title = N_("Diagnostics")
    means = "the tab to the right"
    tooltip = N_("Show what everybody says on /diagnostics as a tree, or the drivers.")
    from_elsewhere = True

    @classmethod
    def possible(cls, target: DevicesTarget) -> bool | None:
        """Only with something to show."""
        return target.has_diagnostics

    @classmethod
    async def run(cls, target: DevicesTarget) -> None:
        target.show_tree(not target.shows_tree)


class PreviousDevicesTab(NextDevicesTab):
    """The same: there are two."""

    id = "devices.tab_back"
    key = "left"
    title = N_("Drivers")
    means = "the tab to the left"
    from_elsewhere = False


class DevicesAction(Action[DevicesTarget]):
    """An action on the frames of the chosen port."""

    @classmethod
    def possible(cls, target: DevicesTarget) -> bool | None:
        """Only with a driver chosen."""
        return bool(target.chosen)


class PauseFrames(PauseLines[DevicesTarget], DevicesAction):
    """Pause, or follow the newest frame."""

    id = "devices.pause"
    tooltip = N_("Pause while frames come in, or follow the newest again.")


class OneWay(DevicesAction):
    """Show both directions, or one."""

    id = "devices.way"
    key = "b,и"
    title = N_("In/out")
    tooltip = N_("Show only what comes from the device, only what goes to it, or both.")
    footer = True
    from_elsewhere = True

    @classmethod
    async def run(cls, target: DevicesTarget) -> None:
        """Switch to the next of the three."""
        target.next_way()


class OnlyBad(DevicesAction):
    """Show only bad frames and noise, or everything."""

    id = "devices.bad"
    key = "f,а"
    title = N_("Only bad")
    means = "only"
    tooltip = N_("Show only noise and frames whose check failed, or all.")
    footer = True
    from_elsewhere = True

    @classmethod
    def label(cls, target: DevicesTarget) -> str:
        """Named after what it would do now."""
        return N_("All frames") if target.only_bad else cls.title

    @classmethod
    async def run(cls, target: DevicesTarget) -> None:
        target.toggle_bad()


class Hex(DevicesAction):
    """Show bytes in hex, or as text."""

    id = "devices.hex"
    key = "v,м"
    title = N_("Hex")
    means = "another view"
    tooltip = N_("Show the bytes of lines of text in hex, or as text.")
    footer = True
    from_elsewhere = True

    @classmethod
    def label(cls, target: DevicesTarget) -> str:
        """Named after what it would do now."""
        return N_("Text") if target.frames.as_hex else cls.title

    @classmethod
    async def run(cls, target: DevicesTarget) -> None:
        target.toggle_hex()


class FoldFrames(FoldLines[DevicesTarget], DevicesAction):
    """Wrap long lines, or not."""

    id = "devices.fold"


class ClearFrames(DevicesAction):
    """Discard the frames so far."""

    id = "devices.clear"
    key = "d,в"
    title = N_("Clear")
    means = "clear"
    tooltip = N_("Forget the frames received so far.")
    footer = True

    @classmethod
    async def run(cls, target: DevicesTarget) -> None:
        target.clear_frames()


class SearchFrames(SearchLines[DevicesTarget], DevicesAction):
    """Search the frames."""

    id = "devices.search"
    means = "find"
    tooltip = N_("Find text in the frames as you type; Escape ends it.")


class NextFrame(NextLine[DevicesTarget], DevicesAction):
    """Go to the next match."""

    id = "devices.next"
    means = "next"
    tooltip = N_("Go to the next frame found.")


class PreviousFrame(PreviousLine[DevicesTarget], DevicesAction):
    """Go to the previous match."""

    id = "devices.previous"
    means = "previous"
    tooltip = N_("Go to the previous frame found.")


class CopyFrames(CopyLines[DevicesTarget], DevicesAction):
    """Copy the chosen frames."""

    id = "devices.copy"


class SaveFrames(SaveLines[DevicesTarget], DevicesAction):
    """Write frames to a file."""

    id = "devices.save"
    means = "write to a file"


class _MakeTrouble(DevicesAction):
    """Causes or clears trouble on the chosen device; only a simulated one allows that."""

    trouble: ClassVar[SimulatedTrouble]

    @classmethod
    def possible(cls, target: DevicesTarget) -> bool | None:
        """Only with a device of the simulated robot that can have this trouble."""
        found = target.simulated
        return found is not None and found[1] in cls.trouble.devices

    @classmethod
    async def run(cls, target: DevicesTarget) -> None:
        target.switch_trouble(cls.trouble)


class Unplug(_MakeTrouble):
    """Cut the connection."""

    id = "devices.unplug"
    key = "U,Г"
    title = N_("Pull cable")
    tooltip = N_("Simulated robot: unplug the selected device; press again to plug it in.")
    footer = True
    trouble = UNPLUGGED


class Noise(_MakeTrouble):
    """Add bytes that nobody sent."""

    id = "devices.noise"
    key = "Z,Я"
    title = N_("Noise")
    tooltip = N_("Simulated robot: noise on the line of the selected device; press again to end it.")
    trouble = NOISE


class Silence(_MakeTrouble):
    """Stay connected, but send nothing."""

    id = "devices.silence"
    key = "H,Р"
    title = N_("Silence")
    tooltip = N_("Simulated robot: silence the selected device; press again to undo.")
    trouble = SILENCE


class LowBattery(_MakeTrouble):
    """Lower the battery voltage."""

    id = "devices.battery"
    key = "B,И"
    title = N_("Low battery")
    tooltip = N_("Simulated robot: the battery of Pico and servos is weak; press again to charge it.")
    trouble = BATTERY


DEVICES_ACTIONS = (
    NextDevicesTab,
    PreviousDevicesTab,
    PauseFrames,
    OneWay,
    OnlyBad,
    Hex,
    FoldFrames,
    ClearFrames,
    CopyFrames,
    SaveFrames,
    SearchFrames,
    NextFrame,
    PreviousFrame,
    Unplug,
    Noise,
    Silence,
    LowBattery,
)
