"""The actions of the app, available on every screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_, _
from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.frame.host import Host


class AppAction(Action["Host"]):
    """An action of the app, whichever screen is in front."""


class SessionAction(AppAction):
    """An action that needs a session."""

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only while a session is shown."""
        return target.feed.link is not None


class EmergencyStop(SessionAction):
    """Stop the wheels at once."""

    id = "emergency.stop"
    key = "space,ctrl+x"
    title = N_("STOP")
    tooltip = N_("Emergency stop: hold the wheels at once, until it is released.")
    footer = True
    priority = True

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Also while a session is being opened."""
        return target.feed.link is not None or bool(target.sessions.opening)

    @classmethod
    def shown(cls, target: Host) -> bool:
        """Not in a replay."""
        return target.feed.replay is None

    @classmethod
    async def run(cls, target: Host) -> None:
        """Engage it; if it is already engaged, publish it again."""
        if target.feed.replay is None:
            target.emergency.engage()
        else:
            target.notify(_("This is a recording: there is nothing to stop."), markup=False)


class EmergencyRelease(SessionAction):
    """Let the wheels turn again."""

    id = "emergency.release"
    key = "ctrl+r"
    title = N_("Release")
    tooltip = N_("Release the emergency stop: nodes may move the robot again.")
    footer = True
    priority = True

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only while it is engaged."""
        return bool(cls.pressable(target)) and target.emergency.state.engaged

    @classmethod
    def pressable(cls, target: Host) -> bool | None:
        """Whenever there is a robot: pressed in vain, it says so."""
        is_there = target.feed.link is not None or target.emergency.state.waits
        return is_there and target.feed.replay is None

    @classmethod
    def shown(cls, target: Host) -> bool:
        return bool(cls.possible(target))

    @classmethod
    async def run(cls, target: Host) -> None:
        """Release it; a stop that this screen does not know of is not released by chance."""
        if target.emergency.state.engaged:
            target.emergency.release()
        else:
            words = _("Nothing is released: this screen knows of no emergency stop.")
            target.notify(words, markup=False)


class OpenedAction(AppAction):
    """An action that needs a session, which may have ended."""

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only while a session is shown, even one that has ended."""
        return target.feed.opened


class ShowScreen(OpenedAction):
    """Bring a screen of the session to the front."""

    screen = ""

    @classmethod
    async def run(cls, target: Host) -> None:
        await target.show_screen(cls.screen)


class ShowDeck(ShowScreen):
    """The running lesson."""

    id = "screen.deck"
    key = "1,f2"
    title = N_("Deck")
    tooltip = N_("The lesson at work: nodes, sensors, wheels, head and voice.")
    screen = "deck"


class ShowLesson(ShowScreen):
    """What the lesson asks for."""

    id = "screen.lesson"
    key = "L,Д"
    title = N_("Lesson")
    tooltip = N_("The task of this step, what is judged of your nodes, and hints.")
    screen = "lesson"


class ShowTopics(ShowScreen):
    """Every topic."""

    id = "screen.topics"
    key = "2,f3"
    title = N_("Topics")
    tooltip = N_("Every topic with its rates; the selected one live.")
    screen = "topics"


class ShowComposer(ShowScreen):
    """The LLM's JSON."""

    id = "screen.composer"
    key = "3,f4"
    title = N_("Composer")
    tooltip = N_("Write the JSON that an LLM would send, and see the result.")
    screen = "composer"


class ShowLogs(ShowScreen):
    """All logs."""

    id = "screen.logs"
    key = "4,f5"
    title = N_("Logs")
    tooltip = N_("The messages of all nodes: filter, search, save.")
    screen = "logs"


class ShowGraph(ShowScreen):
    """Nodes, services, actions and types."""

    id = "screen.graph"
    key = "5"
    title = N_("Graph")
    tooltip = N_("Who talks to whom; call services, send goals, set parameters.")
    screen = "graph"


class ShowFlow(ShowScreen):
    """What happened when, across nodes."""

    id = "screen.flow"
    key = "6"
    title = N_("Flow")
    tooltip = N_("One timeline of all nodes: what followed from a word that was said.")
    screen = "flow"


class ShowDevices(ShowScreen):
    """Drivers and their serial ports."""

    id = "screen.devices"
    key = "7"
    title = N_("Devices")
    tooltip = N_("Every driver, what it is connected to, and what goes over its port.")
    screen = "devices"


class ShowFrames(ShowScreen):
    """The tree of frames."""

    id = "screen.frames"
    key = "8"
    title = N_("Frames")
    tooltip = N_("The tree of frames: who publishes them, how often, and what is wrong with it.")
    screen = "frames"


class ShowSpace(ShowScreen):
    """What is where."""

    id = "screen.space"
    key = "9"
    title = N_("Space")
    tooltip = N_("The robot, its map and what its sensors see, from above or in perspective.")
    screen = "space"


class ShowWall(ShowScreen):
    """What matters, to be read from afar."""

    id = "screen.wall"
    key = "0"
    title = N_("Wall")
    tooltip = N_("Big numbers and a big picture, to be read across a room; Esc goes back.")
    screen = "wall"


class ShowHelp(AppAction):
    """The keys, and what the screen shows."""

    id = "app.help"
    key = "f1,question_mark"
    title = N_("Help")
    means = "help"
    tooltip = N_("Every key of this screen, and what it shows.")
    footer = True

    @classmethod
    async def run(cls, target: Host) -> None:
        """Open the help page of the screen in front."""
        target.show_help()


class ShowPalette(AppAction):
    """Every action by its name."""

    id = "app.palette"
    key = "ctrl+p"
    title = N_("Palette")
    tooltip = N_("Find anything that can be done by its name.")
    footer = True
    priority = True
    palette = False

    @classmethod
    async def run(cls, target: Host) -> None:
        target.show_palette()


class ShowTour(AppAction):
    """The tour of the first start."""

    id = "app.tour"
    key = "shift+f1"
    title = N_("Tour")
    tooltip = N_("What Deck is for and which keys matter, in five pages.")

    @classmethod
    async def run(cls, target: Host) -> None:
        target.show_tour()


class SwitchLanguage(AppAction):
    """English to Russian and back."""

    id = "app.language"
    key = "f9"
    title = N_("English / Русский")
    tooltip = N_("Switch the language of the screen.")
    priority = True

    @classmethod
    async def run(cls, target: Host) -> None:
        target.switch_language()


class SwitchTheme(AppAction):
    """Switch to the next theme."""

    id = "app.theme"
    key = "f10"
    title = N_("Theme")
    tooltip = N_("Dark, light, high contrast.")
    priority = True

    @classmethod
    async def run(cls, target: Host) -> None:
        target.next_theme()


class CloseSession(OpenedAction):
    """Back to the list of lessons."""

    id = "session.close"
    key = "f8"
    title = N_("Lessons")
    tooltip = N_("Back to the list of lessons; nodes that this screen has started are stopped.")

    @classmethod
    async def run(cls, target: Host) -> None:
        """Stop the session, or detach from it, and show the picker."""
        target.sessions.close()


class EndSession(SessionAction):
    """End a session that somebody else has started."""

    id = "session.end"
    key = "shift+f8"
    title = N_("End the session")
    tooltip = N_("End a session that was started elsewhere, after saying whose it is and asking.")

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only with a session whose supervisor was not started by this screen."""
        return target.feed.of_others

    @classmethod
    async def run(cls, target: Host) -> None:
        target.sessions.end_of_others()


class Redraw(AppAction):
    """Redraw everything."""

    id = "app.redraw"
    key = "ctrl+l"
    title = N_("Redraw")
    tooltip = N_("Redraw everything, if something else has written to the terminal.")
    priority = True

    @classmethod
    async def run(cls, target: Host) -> None:
        target.redraw()


class Quit(AppAction):
    """Leave."""

    id = "app.quit"
    key = "q,й,ctrl+q"
    title = N_("Quit")
    means = "leave"
    tooltip = N_("Leave; nodes that this screen has started are stopped, others go on.")
    footer = True
    priority = True

    @classmethod
    def label(cls, target: Host) -> str:
        """Named after whether anything is stopped by it."""
        return N_("Detach") if target.feed.of_others else cls.title

    @classmethod
    async def run(cls, target: Host) -> None:
        """Stop cleanly; if asked again, stop at once."""
        target.sessions.leave()


TABS = (
    ShowDeck,
    ShowLesson,
    ShowTopics,
    ShowComposer,
    ShowLogs,
    ShowGraph,
    ShowFlow,
    ShowDevices,
    ShowFrames,
    ShowSpace,
)
"""In the order in which the top line names them."""
APP_ACTIONS = (
    EmergencyStop,
    EmergencyRelease,
    ShowHelp,
    *TABS,
    ShowWall,
    ShowPalette,
    ShowTour,
    CloseSession,
    EndSession,
    SwitchLanguage,
    SwitchTheme,
    Redraw,
    Quit,
)
