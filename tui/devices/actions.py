"""What can be done on the Devices screen; each letter also under its Cyrillic key."""

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
    """What these actions need of the screen of devices."""

    frames: FrameRows

    @property
    def chosen(self) -> Device | None:
        """The driver that is looked at."""

    @property
    def only_bad(self) -> bool:
        """Whether good frames are left out."""

    @property
    def simulated(self) -> tuple[str, str] | None:
        """The simulated robot's node and which line of it is chosen."""

    def next_way(self) -> None:
        """Show both ways, then in, then out."""

    def toggle_bad(self) -> None:
        """Show noise and bad frames only, or all."""

    def toggle_hex(self) -> None:
        """Show bytes that are text in hex, or as text."""

    def clear_frames(self) -> None:
        """Forget all frames."""

    def switch_trouble(self, trouble: SimulatedTrouble) -> object:
        """Make this trouble of the chosen device, or mend it."""


class DevicesAction(Action[DevicesTarget]):
    """Something about the frames of the chosen port."""

    @classmethod
    def possible(cls, target: DevicesTarget) -> bool | None:
        """Only with a driver to look at."""
        return bool(target.chosen)


class PauseFrames(PauseLines[DevicesTarget], DevicesAction):
    """Stand still, or follow."""

    id = "devices.pause"
    tooltip = N_("Pause while frames come in, or follow the newest again.")


class OneWay(DevicesAction):
    """Both ways, or one."""

    id = "devices.way"
    key = "b,и"
    title = N_("In/out")
    tooltip = N_("Show only what comes from the device, only what goes to it, or both.")
    footer = True
    from_elsewhere = True

    @classmethod
    async def run(cls, target: DevicesTarget) -> None:
        """Take the next of the three."""
        target.next_way()


class OnlyBad(DevicesAction):
    """Only bad frames and noise, or everything."""

    id = "devices.bad"
    key = "f,а"
    title = N_("Only bad")
    means = "only"
    tooltip = N_("Show only noise and frames whose check failed, or all.")
    footer = True
    from_elsewhere = True

    @classmethod
    def label(cls, target: DevicesTarget) -> str:
        """By what it would do now."""
        return N_("All frames") if target.only_bad else cls.title

    @classmethod
    async def run(cls, target: DevicesTarget) -> None:
        """Do the other of the two."""
        target.toggle_bad()


class Hex(DevicesAction):
    """Hex, or text."""

    id = "devices.hex"
    key = "v,м"
    title = N_("Hex")
    means = "another view"
    tooltip = N_("Show the bytes of lines of text in hex, or as text.")
    footer = True
    from_elsewhere = True

    @classmethod
    def label(cls, target: DevicesTarget) -> str:
        """By what it would do now."""
        return N_("Text") if target.frames.as_hex else cls.title

    @classmethod
    async def run(cls, target: DevicesTarget) -> None:
        """Do the other of the two."""
        target.toggle_hex()


class FoldFrames(FoldLines[DevicesTarget], DevicesAction):
    """Fold long lines, or not."""

    id = "devices.fold"


class ClearFrames(DevicesAction):
    """Forget the frames so far."""

    id = "devices.clear"
    key = "d,в"
    title = N_("Clear")
    means = "clear"
    tooltip = N_("Forget the frames that have come so far.")
    footer = True

    @classmethod
    async def run(cls, target: DevicesTarget) -> None:
        """Forget them."""
        target.clear_frames()


class SearchFrames(SearchLines[DevicesTarget], DevicesAction):
    """Search."""

    id = "devices.search"
    means = "find"
    tooltip = N_("Find text in the frames as you type; Escape ends it.")


class NextFrame(NextLine[DevicesTarget], DevicesAction):
    """The next found frame."""

    id = "devices.next"
    means = "next"
    tooltip = N_("Go to the next frame found.")


class PreviousFrame(PreviousLine[DevicesTarget], DevicesAction):
    """The previous found frame."""

    id = "devices.previous"
    means = "previous"
    tooltip = N_("Go to the previous frame found.")


class CopyFrames(CopyLines[DevicesTarget], DevicesAction):
    """Copy the frames chosen."""

    id = "devices.copy"


class SaveFrames(SaveLines[DevicesTarget], DevicesAction):
    """Write frames to a file."""

    id = "devices.save"
    means = "write to a file"


class _MakeTrouble(DevicesAction):
    """Trouble of the chosen device, or no more of it: only a simulated one can have it made."""

    trouble: ClassVar[SimulatedTrouble]

    @classmethod
    def possible(cls, target: DevicesTarget) -> bool | None:
        """Only with a device of the simulated robot, that may have it."""
        found = target.simulated
        return found is not None and found[1] in cls.trouble.devices

    @classmethod
    async def run(cls, target: DevicesTarget) -> None:
        """Make it, or mend it."""
        target.switch_trouble(cls.trouble)


class Unplug(_MakeTrouble):
    """No connection."""

    id = "devices.unplug"
    key = "U,Г"
    title = N_("Pull cable")
    tooltip = N_("Simulated robot: pull the cable of the chosen device; again: plug it in.")
    footer = True
    trouble = UNPLUGGED


class Noise(_MakeTrouble):
    """Bytes that nobody sent."""

    id = "devices.noise"
    key = "Z,Я"
    title = N_("Noise")
    tooltip = N_("Simulated robot: noise on the line of the chosen device; again: none.")
    trouble = NOISE


class Silence(_MakeTrouble):
    """Connected, and nothing comes."""

    id = "devices.silence"
    key = "H,Р"
    title = N_("Silence")
    tooltip = N_("Simulated robot: the chosen device says nothing; again: it speaks.")
    trouble = SILENCE


class LowBattery(_MakeTrouble):
    """Too little voltage."""

    id = "devices.battery"
    key = "B,И"
    title = N_("Low battery")
    tooltip = N_("Simulated robot: the battery of Pico and servos is weak; again: it is charged.")
    trouble = BATTERY


DEVICES_ACTIONS = (
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
