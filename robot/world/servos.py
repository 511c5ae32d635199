"""The servo controller of the simulated robot: it moves servos, and reports its battery."""

from __future__ import annotations

from robot.wire.lsc16 import CENTRE_US, Battery, BatteryRequest, ServoDecoder, ServoMove, encode


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
                answer += encode(Battery(round(self.battery_v * 1000)))
        return answer

    def advance(self, seconds: float) -> None:
        self._now_s += seconds

    def pulse_us(self, servo: int) -> float:
        start, goal, began_s, length_s = self._moves.get(servo, (CENTRE_US, CENTRE_US, 0.0, 0.0))
        passed_s = self._now_s - began_s
        return goal if passed_s >= length_s else start + (goal - start) * passed_s / length_s
