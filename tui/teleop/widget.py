"""Driving with keys: has the focus, reads the keys, and holds what they ask for.

It publishes nothing itself: the observer's thread repeats a command for as long as the last key
allows, so that a screen that hangs, or has gone, leaves no command behind.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.content import Content
from textual.message import Message

from graph.observer.requests import Hold, LetGo, PrepareHold
from graph.publishing.dead_man_switch import HeldCommand
from robot.topics import DRIVE, DRIVE_SAFE, DRIVE_TELEOP, WHEEL_COMMANDS
from robot.words import STOP, DriveSetpoint
from safety.gate_report import Gate, gate_in
from safety.topics import SAFETY_STATE
from text.i18n import N_, _
from text.plain import plain
from tui import clock
from tui.actions import REGISTRY, Acting, bindings
from tui.emergency.gate import gate_words
from tui.frame.actions.app import emergency_release
from tui.frame.host import Host, host_of
from tui.panels.panel import is_published, newest
from tui.panels.wheels import WheelsReading, wheels_in
from tui.teleop.actions import MOVES, TELEOP_ACTIONS, Move, open_teleop
from tui.teleop.keys import DRIVE_TYPE, NOTHING, RATE_HZ, Route, TeleopLimits, command, route
from tui.teleop.view import Driving, drawn
from tui.widgets.drawing import Drawing, Line
from tui.yaml_form.words import reason_words

if TYPE_CHECKING:
    from concurrent.futures import Future

    from textual.events import Key
    from textual.timer import Timer

    from graph.data import GraphUpdate, Sample

OUTDATED_S = 2.5
"""What is older is no news of now: the differential repeats itself every 2 s at the least, the gate
every second."""
LOOK_S = 0.05
"""How often to check whether a key is still down, while any is."""
TITLE = N_("Drive by keys")


class TeleopPanel(Drawing, Acting, can_focus=True):
    """What the keys ask for, what the gate allows, what the wheels do; large if there is room."""

    class Closed(Message):
        """The panel is to be removed."""

    BINDINGS: ClassVar = bindings(*TELEOP_ACTIONS)
    DEFAULT_CSS = """
    TeleopPanel {
        height: 8; min-height: 4; padding: 0 1;
        border-top: solid $primary 60%; border-title-style: bold;
        border-title-color: $foreground;
        &:focus { border-top: heavy $accent; }
    }
    """
    topics: ClassVar = frozenset({DRIVE_SAFE, WHEEL_COMMANDS, SAFETY_STATE})
    """The topics that it shows."""

    def __init__(self) -> None:
        super().__init__(id="teleop")
        self._keys = NOTHING
        self.limits = TeleopLimits()
        self._route = Route()
        self._allowed: DriveSetpoint | None = None
        self._wheels: WheelsReading | None = None
        self._gate: Gate | None = None
        self._heard_s: dict[str, float] = {}
        """When the newest message of each topic was received, Unix time."""
        self._time_s = 0.0
        """Time of the newest update."""
        self._error = ""
        self._timer: Timer | None = None

    @property
    def has_value(self) -> bool:
        return True

    @property
    def _deck(self) -> Host:
        return host_of(self)

    def change_limits(self, limits: TeleopLimits) -> None:
        """Use this speed and steering from the next press on."""
        self.limits = limits
        self.redraw()

    @property
    def asked(self) -> DriveSetpoint:
        return self._keys.at(clock.steady()).setpoint(self.limits)

    # Keys

    def check_consume_key(self, key: str, character: str | None) -> bool:
        """Keep letters from the screen and the app: a slip while driving must not stop a node."""
        del key
        return character is not None and character.isalpha()

    async def on_key(self, event: Key) -> None:
        """Take the driving keys with the time at which they were pressed, however late."""
        key = event.key
        if event.character is not None and event.character.isalpha():
            # Caps Lock must not prevent driving.
            key = event.character.lower()
        active = self.screen.active_bindings.get(key)
        action = None if active is None else REGISTRY.get(active.binding.id or "")
        if active is None or active.node is not self or action is None:
            return
        if action in MOVES:
            event.stop()
            event.prevent_default()
            self.press(MOVES[action], event.time)

    def press(self, move: Move, at_s: float | None = None) -> None:
        """Press a key now, or at that time of the monotonic clock."""
        now_s = clock.steady()
        at_s = now_s if at_s is None else min(at_s, now_s)
        deck = self._deck
        graph = deck.feed.graph
        if graph is None or not self._route.topic or deck.emergency.state.engaged:
            self.redraw()
            return
        if deck.stall_detector.may_precede(at_s):
            return
        self._keys = self._keys.pressed(move, at_s)
        if self._keys.at(now_s) is NOTHING:
            # It has waited too long to be obeyed.
            self._keys = NOTHING
            return
        asked = command(self._keys.setpoint(self.limits))
        drive = HeldCommand(asked, command(STOP), RATE_HZ, self._keys.until_s)
        held = graph.ask(Hold(self._route.topic, DRIVE_TYPE, drive))
        held.add_done_callback(self._held)
        if self._timer is not None:
            self._timer.resume()
        self.redraw()

    def release(self) -> None:
        self._keys = NOTHING
        graph = self._deck.feed.graph
        if graph is not None and self._route.topic:
            graph.ask(LetGo(self._route.topic))
        self.redraw()

    def close(self) -> None:
        self.release()
        self.post_message(self.Closed())

    def _held(self, done: Future[int]) -> None:
        """Called on the observer's thread."""
        error = None if done.cancelled() else done.exception()
        words = reason_words(error) if isinstance(error, Exception) else ""
        if words != self._error:
            self._error = words
            self.app.call_later(self.redraw)

    def _look(self) -> None:
        if self._keys.at(clock.steady()) is NOTHING:
            self._keys = NOTHING
            if self._timer is not None:
                self._timer.pause()
        self.redraw()

    # Events

    def on_mount(self) -> None:
        """Prepare for publishing, without publishing anything."""
        self._timer = self.set_interval(LOOK_S, self._look, pause=True)
        self._entitle()
        if self._deck.feed.update is not None:
            self.show(self._deck.feed.update)

    def on_unmount(self) -> None:
        """Make sure that nothing keeps moving."""
        self.release()

    def on_focus(self) -> None:
        self.redraw()

    def on_blur(self) -> None:
        """Others receive the keys, or the terminal has lost the focus."""
        self.release()

    def show(self, update: GraphUpdate) -> None:
        self._follow(route(update))
        self._time_s = update.time_s
        for topic in self.topics:
            for sample in update.samples.get(topic, ()):
                self._heard_s[topic] = max(self._heard_s.get(topic, 0.0), sample.received_s)
        for sample in update.samples.get(SAFETY_STATE, ()):
            self._gate = gate_in(sample.value) or self._gate
        self._allowed = _drive(newest(update, DRIVE_SAFE)) or self._allowed
        turned = newest(update, WHEEL_COMMANDS)
        self._wheels = (None if turned is None else wheels_in(turned.value)) or self._wheels
        for topic in (DRIVE_SAFE, WHEEL_COMMANDS):
            if is_published(update, topic):
                continue
            if topic == DRIVE_SAFE:
                self._allowed = self._gate = None
            else:
                self._wheels = None
        self.redraw()

    def _follow(self, found: Route) -> None:
        """Use another topic from now on, with its publisher created in advance."""
        if found.topic != self._route.topic:
            self.release()
            graph = self._deck.feed.graph
            if graph is not None and found.topic:
                ready = graph.ask(PrepareHold(found.topic, DRIVE_TYPE))
                # If it cannot be created, the first key reports that.
                ready.add_done_callback(lambda done: done.cancelled() or done.exception())
        self._route = found
        self._entitle()

    def _silent_s(self, topic: str) -> float:
        """For how long nothing has come on this topic; 0.0 before the first message."""
        return max(0.0, self._time_s - self._heard_s.get(topic, self._time_s))

    def _entitle(self) -> None:
        topic = f" → {self._route.topic}" if self._route.topic else ""
        self.border_title = Content(_(TITLE) + topic)

    def on_language_changed(self) -> None:
        self._entitle()

    # Drawing

    def draw(self, width: int, height: int) -> list[Line]:
        known = (self.asked, self._allowed, self._route.gated, self._wheels, self.limits)
        ages = self._outdated(DRIVE_SAFE), self._outdated(WHEEL_COMMANDS)
        return drawn(Driving(*known, *self._told(), *ages), width, height)

    def _outdated(self, topic: str) -> str:
        """Say since when a value is not current any more; empty while it is."""
        silent_s = self._silent_s(topic)
        return _("{seconds:.0f} s ago").format(seconds=silent_s) if silent_s > OUTDATED_S else ""

    def _told(self) -> tuple[str, str]:  # noqa: PLR0911 - one question after the other
        """Return the most serious remark for now, and its look."""
        if self._deck.emergency.state.unconfirmed:
            return _("emergency stop: pressed, nobody has confirmed it"), "stop"
        if self._deck.emergency.state.engaged:
            key = self._deck.keys_of(emergency_release)[0]
            return _("emergency stop: nothing moves; {key} releases").format(key=key), "stop"
        if not self._route.topic:
            words = _("Nobody listens to {gate} or {drive}: nothing will move. Start {nodes}.")
            nodes = "safety_stop, electronic_differential"
            return words.format(gate=DRIVE_TELEOP, drive=DRIVE, nodes=nodes), "warn"
        if not self.has_focus:
            key = self._deck.keys_of(open_teleop)[0]
            words = _("the keyboard focus is elsewhere; {key} or a click here brings it back")
            return words.format(key=key), "warn"
        if self._error:
            return plain(self._error, 400), "bad"
        if not self._route.gated:
            return _("no gate: nothing stops the robot before an obstacle"), "warn"
        if (silent_s := self._silent_s(SAFETY_STATE)) > OUTDATED_S:
            words = _("the gate has been silent for {seconds:.0f} s: what it allows is unknown")
            return words.format(seconds=silent_s), "warn"
        if self._gate is None:
            return _("the gate has not said anything yet"), "muted"
        look = "warn" if self._gate.is_held or self._gate.is_slowed else "good"
        return gate_words(self._gate), look


def _drive(sample: Sample | None) -> DriveSetpoint | None:
    """Read an AckermannDriveStamped; None for an invalid one."""
    drive = None if sample is None else sample.value.get("drive")
    if not isinstance(drive, dict):
        return None
    return DriveSetpoint(float(drive["speed"]), float(drive["steering_angle"]))
