"""What can be done on the Devices screen; each letter also under its Cyrillic key."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from tui.actions.action import Action
from tui.i18n import N_

if TYPE_CHECKING:
    from tui.screens.devices import DevicesScreen


class DevicesAction(Action["DevicesScreen"]):
    """Something about the frames of the chosen port."""

    @classmethod
    def possible(cls, target: DevicesScreen) -> bool | None:
        """Only with a driver to look at."""
        return bool(target.chosen)


class Pause(DevicesAction):
    """Stand still, or follow."""

    id = "devices.pause"
    key = "p,з"
    title = N_("Pause")
    tooltip = N_("Stand still while frames come in, or follow the newest again.")
    footer = True

    @classmethod
    def label(cls, target: DevicesScreen) -> str:
        """By what it would do now."""
        return cls.title if target.pane.view.following else N_("Resume")

    @classmethod
    async def run(cls, target: DevicesScreen) -> None:
        """Do the other of the two."""
        target.pane.view.toggle_following()


class OneWay(DevicesAction):
    """Both ways, or one."""

    id = "devices.way"
    key = "i,ш"
    title = N_("In/out")
    tooltip = N_("Show only what comes from the device, only what goes to it, or both.")
    footer = True

    @classmethod
    async def run(cls, target: DevicesScreen) -> None:
        """Take the next of the three."""
        target.next_way()


class OnlyBad(DevicesAction):
    """What is no good frame, or everything."""

    id = "devices.bad"
    key = "b,и"
    title = N_("Only bad")
    tooltip = N_("Show only noise and frames whose check failed, or all.")
    footer = True

    @classmethod
    def label(cls, target: DevicesScreen) -> str:
        """By what it would do now."""
        return N_("All frames") if target.only_bad else cls.title

    @classmethod
    async def run(cls, target: DevicesScreen) -> None:
        """Do the other of the two."""
        target.toggle_bad()


class Hex(DevicesAction):
    """Hex, or text."""

    id = "devices.hex"
    key = "x,ч"
    title = N_("Hex")
    tooltip = N_("Show the bytes of lines of text in hex, or as text.")
    footer = True

    @classmethod
    def label(cls, target: DevicesScreen) -> str:
        """By what it would do now."""
        return N_("Text") if target.frames.as_hex else cls.title

    @classmethod
    async def run(cls, target: DevicesScreen) -> None:
        """Do the other of the two."""
        target.toggle_hex()


class Fold(DevicesAction):
    """Fold long lines, or not."""

    id = "devices.fold"
    key = "w,ц"
    title = N_("Fold")
    tooltip = N_("Fold long lines, or show one row of each: left and right shift it.")
    footer = True

    @classmethod
    async def run(cls, target: DevicesScreen) -> None:
        """Do the other of the two."""
        target.pane.view.set_fold(not target.pane.view.fold)


class Clear(DevicesAction):
    """Forget the frames so far."""

    id = "devices.clear"
    key = "d,в"
    title = N_("Clear")
    tooltip = N_("Forget the frames that have come so far.")
    footer = True

    @classmethod
    async def run(cls, target: DevicesScreen) -> None:
        """Forget them."""
        target.clear_frames()


class Search(DevicesAction):
    """Search."""

    id = "devices.search"
    key = "slash,ctrl+f"
    title = N_("Search")
    tooltip = N_("Find text in the frames while it is written; Escape ends it.")
    priority = True

    @classmethod
    def possible(cls, target: DevicesScreen) -> bool | None:
        """Not where one is asked already: there a slash is a slash."""
        return bool(target.chosen) and not target.pane.prompt.kind

    @classmethod
    async def run(cls, target: DevicesScreen) -> None:
        """Ask what for."""
        target.pane.search()


class _Find(DevicesAction):
    """Go to a frame that was found."""

    step: ClassVar[int]

    @classmethod
    async def run(cls, target: DevicesScreen) -> None:
        """Point at it."""
        target.pane.find(cls.step)


class FindNext(_Find):
    """The next found frame."""

    id = "devices.next"
    key = "n,т"
    title = N_("Next")
    tooltip = N_("Go to the next frame that was found.")
    step = 1


class FindPrevious(_Find):
    """The previous found frame."""

    id = "devices.previous"
    key = "N,Т"
    title = N_("Previous")
    tooltip = N_("Go to the previous frame that was found.")
    step = -1


class Copy(DevicesAction):
    """Copy the frames chosen."""

    id = "devices.copy"
    key = "c,с"
    title = N_("Copy")
    tooltip = N_("Copy the lines chosen to the clipboard of your terminal.")
    footer = True

    @classmethod
    async def run(cls, target: DevicesScreen) -> None:
        """Copy."""
        target.pane.copy()


class Save(DevicesAction):
    """Write frames to a file."""

    id = "devices.save"
    key = "ctrl+s"
    title = N_("Write")
    tooltip = N_("Write the lines chosen, else all shown, to a file.")
    footer = True

    @classmethod
    async def run(cls, target: DevicesScreen) -> None:
        """Ask for its name."""
        target.pane.save()


DEVICES_ACTIONS = (
    Pause,
    OneWay,
    OnlyBad,
    Hex,
    Fold,
    Clear,
    Copy,
    Save,
    Search,
    FindNext,
    FindPrevious,
)
