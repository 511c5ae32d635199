"""The simulated devices: the Pico obeys the rules of the firmware, line by line."""

from __future__ import annotations

import importlib.util
import random
import sys
from pathlib import Path
from typing import Any

import pytest

from robot.wire.lsc16 import Battery, BatteryRequest, ServoMove, decode
from robot.wire.lsc16 import encode as encode_servo
from robot.wire.pico import Drive, Halt, Hello, Message, PicoDecoder, Release, Telemetry, encode
from robot.world.pico import SimulatedPico
from robot.world.servos import SimulatedServos
from robot.world.world import World

PICO2 = Path(__file__).parents[3] / "firmware" / "pico2"


def load(name: str) -> Any:
    """A file of the firmware, in this Python."""
    spec = importlib.util.spec_from_file_location(name, PICO2 / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    finally:
        if name != "protocol":
            del sys.modules[name]
    return module


class Board:
    """What control.py needs, with a clock by hand."""

    def __init__(self) -> None:
        self.ms, self.battery, self.left_fault = 0, 7400, False
        self.out, self.moves = b"", False

    def now_ms(self) -> int:
        return self.ms

    def since_ms(self, then: int) -> int:
        return self.ms - then

    def write(self, data: bytes) -> None:
        self.out += data

    def drive(self, left: int, right: int) -> None:
        self.moves = bool(left or right)

    def brake(self) -> None:
        self.moves = False

    off = brake

    def steer(self, us: int) -> None:
        pass

    def faults(self) -> tuple[bool, bool]:
        return self.left_fault, False

    def currents_ma(self) -> tuple[int, int]:
        return 0, 0

    def battery_mv(self) -> int:
        return self.battery

    def counts(self) -> None:
        return None


@pytest.mark.parametrize("seed", range(4))
def test_the_simulated_pico_does_what_the_firmware_does(seed: int) -> None:
    dice = random.Random(seed)
    load("protocol")
    board = Board()
    firmware = load("control").Control(board, load("config"))
    world = World()
    pico = SimulatedPico(world)
    decoder, other = PicoDecoder(), PicoDecoder()
    sequence = 0
    for _ in range(600):
        octets = b""
        if dice.random() < 0.4:
            sequence = (sequence + dice.choice([1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 40_000])) % 65536
            said: list[Message] = [
                Drive(sequence, 0, 0, 0.1),
                Drive(sequence, 5, 4, -0.1),
                Drive(sequence, 18, 4, -0.1),
                Drive(sequence, 5, 4, -0.6),
                Hello(sequence),
                Hello(sequence, 2),
                Halt(sequence),
                Release(sequence),
            ]
            message = dice.choices(said, [20, 30, 1, 1, 2, 0.3, 0.5, 1.5])[0]
            octets = encode(message)
            if dice.random() < 0.05:
                octets = octets.replace(b",", b";", 1)
        if dice.random() < 0.01:
            board.left_fault = not board.left_fault
            pico.faults = frozenset("L") if board.left_fault else frozenset()
        if dice.random() < 0.02:
            board.battery = dice.choice([7400, 7400, 6100, 5500])
            pico.battery_v = board.battery / 1000
        for octet in octets:
            firmware.feed(octet)
        pico.feed(octets)
        for _ in range(dice.choice([1, 1, 1, 1, 30])):
            board.ms += 10
            firmware.step()
            told = [
                message for message in decoder.feed(pico.step()) if isinstance(message, Telemetry)
            ]
            real = [message for message in other.feed(board.out) if isinstance(message, Telemetry)]
            board.out = b""
            assert pico.flags | {"N"} == firmware.flags
            assert bool(world.asked.left_rad_s) == board.moves
            assert [(m.seq, m.obeyed, m.steering_rad, m.refused, m.uptime_ms) for m in told] == [
                (m.seq, m.obeyed, m.steering_rad, m.refused, m.uptime_ms) for m in real
            ]


def test_the_servos_move_at_their_pace_and_tell_their_battery() -> None:
    servos = SimulatedServos()
    assert servos.feed(encode_servo(ServoMove(1000, ((1, 2000),)))) == b""
    servos.advance(0.5)
    assert servos.pulse_us(1) == pytest.approx(1750)
    assert servos.pulse_us(2) == 1500
    servos.advance(1)
    assert servos.pulse_us(1) == 2000
    assert decode(servos.feed(encode_servo(BatteryRequest()))) == Battery(7400)
