"""The boards of the simulated robot: the Pico, and the servo controller."""

from __future__ import annotations

from robot.limits import STEERING, first_excess, wheel_limits
from robot.wire import pico as wire
from robot.wire.lsc16 import CENTRE_US, Battery, BatteryRequest, ServoDecoder, ServoMove
from robot.wire.lsc16 import encode as encode_servos
from robot.world.world import STEP_S, Wheels, World

FIRMWARE = "simulated"
_STEP_MS, _WATCHDOG_MS = round(STEP_S * 1000), round(wire.WATCHDOG_S * 1000)
_TELEMETRY_MS, _QUIET_MS = 20, 1000
_LOW_V, _BACK_V, _LOW_FOR_MS = 6.0, 6.3, 500
_NEEDS_RELEASE = frozenset("ELRUH")


class SimulatedPico:
    """The firmware's rules, applied to the wheels of a `World`; advance its time together with that.

    A test keeps its behaviour equal to that of `firmware/pico2/control.py`.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self.battery_v = 7.4
        self.faults: frozenset[str] = frozenset()
        """Motor drivers with a fault: any of `L` and `R`."""
        self.flags = set("WHA")
        self._decoder = wire.PicoDecoder()
        self._now_ms = self._drove_ms = self._told_ms = self._well_ms = 0
        self._heard_ms: int | None = None
        self._asked = Wheels()
        self._steering_rad = 0.0
        self._obeyed = 0
        self._counts = False
        """Whether a drive line has come since the hello: the next one must have a higher number."""
        self._refused = 0
        """Drive lines that were out of order or beyond the limits."""
        self._sequence = 0
        self._out = b""

    def feed(self, data: bytes) -> None:
        """Take bytes from the computer."""
        for message in self._decoder.feed(data):
            self._heard_ms = self._now_ms
            if isinstance(message, wire.Drive):
                self._drive(message)
            elif isinstance(message, wire.Hello):
                self._hello(message)
            elif isinstance(message, wire.Halt):
                self._stop_anew("E")
            elif isinstance(message, wire.Release):
                self.flags.discard("E")
                self._stop_anew()
        self._obey()

    def step(self) -> bytes:
        """Let `STEP_S` pass; return the bytes for the computer."""
        self._now_ms += _STEP_MS
        if self._now_ms - self._drove_ms > _WATCHDOG_MS:
            self.flags |= set("WA")
        self._look_for_faults()
        self._obey()
        if self._heard_ms is None or self._now_ms - self._heard_ms >= _QUIET_MS:
            self._told_ms = self._now_ms
        elif self._now_ms - self._told_ms >= _TELEMETRY_MS:
            self._told_ms = self._now_ms
            self._say(self._telemetry())
        out, self._out = self._out, b""
        return out

    @property
    def refused(self) -> int:
        return self._decoder.errors + self._refused

    def _hello(self, message: wire.Hello) -> None:
        self._counts = False
        if message.protocol == wire.PROTOCOL:
            self.flags.discard("H")
            self._stop_anew()
        else:
            self._stop_anew("H")
        self._say(wire.Welcome(self._sequence, wire.PROTOCOL, FIRMWARE))

    def _drive(self, message: wire.Drive) -> None:
        if self._counts:
            ahead = (message.seq - self._obeyed) % wire.SEQUENCES
            if not 0 < ahead < wire.SEQUENCES // 2:
                self._refused += 1
                return
        wheels, steering = wheel_limits(), (message.steering_rad, STEERING)
        if first_excess((message.left_rad_s, wheels), (message.right_rad_s, wheels), steering):
            self._refused += 1
            self._stop_anew()
            return
        self._obeyed, self._counts = message.seq, True
        if message.left_rad_s == message.right_rad_s == 0 and not self.flags & _NEEDS_RELEASE:
            self.flags.discard("A")
        self.flags.discard("W")
        self._drove_ms = self._now_ms
        self._asked = Wheels(message.left_rad_s, message.right_rad_s)
        if not self.flags & set("HEA"):
            self._steering_rad = message.steering_rad

    def _stop_anew(self, *flags: str) -> None:
        self.flags.update(flags, "A")
        self._asked = Wheels()

    def _look_for_faults(self) -> None:
        self.flags -= set("LR")
        if self.faults:
            self.flags |= self.faults | {"A"}
        if self.battery_v >= _LOW_V:
            self._well_ms = self._now_ms
        if self._now_ms - self._well_ms > _LOW_FOR_MS:
            self.flags |= set("UA")
        elif self.battery_v >= _BACK_V:
            self.flags.discard("U")

    def _obey(self) -> None:
        stands = bool(self.flags & wire.STANDING_FLAGS)
        asked = Wheels() if stands else self._asked
        self.world.asked = Wheels(asked.left_rad_s, asked.right_rad_s, self._steering_rad)

    def _telemetry(self) -> wire.Telemetry:
        wheels = self.world.wheels
        left_a, right_a = (
            0.2 + 0.05 * abs(speed) if speed else 0.0 for speed in (self._asked.left_rad_s, self._asked.right_rad_s)
        )
        return wire.Telemetry(
            self._sequence,
            self._now_ms % 2**32,
            self._obeyed,
            wheels.left_rad_s,
            wheels.right_rad_s,
            self._steering_rad,
            self.battery_v,
            left_a,
            right_a,
            self.refused,
            frozenset(self.flags),
        )

    def _say(self, message: wire.FromPico) -> None:
        self._out += wire.encode(message)
        self._sequence = (self._sequence + 1) % wire.SEQUENCES


class SimulatedServos:
    """Servos that move at the commanded pace."""

    def __init__(self) -> None:
        self.battery_v = 7.4
        self._decoder = ServoDecoder()
        self._now_s = 0.0
        self._moves: dict[int, tuple[float, float, float, float]] = {}
        """Servo to start and end pulse in us, start time and duration in seconds."""

    def feed(self, data: bytes) -> bytes:
        """Take bytes from the computer; return the answer, usually empty."""
        answer = b""
        for frame in self._decoder.feed(data):
            if isinstance(frame, ServoMove):
                for servo, pulse_us in frame.pulses_us:
                    start = self.pulse_us(servo)
                    self._moves[servo] = (start, pulse_us, self._now_s, frame.time_ms / 1000)
            elif isinstance(frame, BatteryRequest):
                answer += encode_servos(Battery(round(self.battery_v * 1000)))
        return answer

    def advance(self, seconds: float) -> None:
        self._now_s += seconds

    def pulse_us(self, servo: int) -> float:
        start, goal, began_s, length_s = self._moves.get(servo, (CENTRE_US, CENTRE_US, 0.0, 0.0))
        passed_s = self._now_s - began_s
        return goal if passed_s >= length_s else start + (goal - start) * passed_s / length_s
