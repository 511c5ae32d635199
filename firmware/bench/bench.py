"""Runs the firmware on a simulated clock; each `play` is one order, JSON in and JSON out."""

import json

import board
import config
import control
import machine
import main
import protocol

ENCODERS = ((16, 17), (18, 19))
_WRAP_MS = 1 << 30
_IDLE_STEP_MS = 600000
_clock = [0]
_here = {}


class Usb:
    def __init__(self):
        self.incoming, self.outgoing, self.stuck = [], [], False

    def read(self):
        return self.incoming.pop(0) if self.incoming else None

    def write(self, data):
        self.outgoing.append(data.decode())


class Clocked(board.Board):
    """Its milliseconds wrap like those of a Pico, after 12.4 days."""

    def now_ms(self):
        return _clock[0] % _WRAP_MS

    def since_ms(self, then):
        return (self.now_ms() - then + _WRAP_MS // 2) % _WRAP_MS - _WRAP_MS // 2


def _boot(encoders):
    for pins, pair in zip((config.LEFT_PINS, config.RIGHT_PINS), ENCODERS):
        pins["encoder"] = pair if encoders else None
    for known in (machine.levels, machine.duties, machine.analog, machine.edges):
        known.clear()
    machine.timers.clear()
    machine.analog[config.BATTERY_PIN] = 14000
    usb = Usb()
    real = Clocked(config, usb)
    _here["before"] = _motors()
    _here["usb"], _here["board"] = usb, real
    _here["control"] = control.Control(real, config)
    real.watch(_here["control"].guard)


def _motors():
    """Return the duty of each motor, + forward, - backward, 0 if braking or off."""
    told = []
    for pins in (config.LEFT_PINS, config.RIGHT_PINS):
        way = machine.levels[pins["ina"]] - machine.levels[pins["inb"]]
        told.append(way * machine.duties[pins["pwm"]])
    return told


def _turn(side, count):
    a, b = ENCODERS[side]
    machine.levels[b] = int(count < 0)
    for _ in range(abs(count)):
        machine.edges[a](None)


def _pass(ms, only_timer, turning):
    seen = []
    for _ in range(ms):
        _clock[0] += 1
        if _clock[0] % 10 == 0:
            for side in (0, 1):
                if turning and machine.edges:
                    _turn(side, turning[side])
            for callback in machine.timers:
                callback(None)
        if not only_timer:
            main.serve(_here["board"], _here["control"])
        seen.append(_motors())
    return seen


def _idle(ms):
    """Let days pass with an occasional round."""
    for _ in range(ms // _IDLE_STEP_MS):
        _clock[0] += _IDLE_STEP_MS
        main.serve(_here["board"], _here["control"])


def play(text):
    order = json.loads(text)
    if "lines" in order:
        found = [protocol.Reader(), []]
        for octet in order["lines"].encode():
            fields = found[0].feed(octet)
            if fields is not None:
                found[1].append(fields)
        return json.dumps({"fields": found[1], "refused": found[0].refused})
    if "wrap" in order:
        return json.dumps({"line": protocol.wrap(*order["wrap"]).decode()})
    if "crc" in order:
        return json.dumps({"crc": protocol.crc16(order["crc"].encode())})
    if "boot" in order:
        _boot(order["boot"])
    for number, level in order.get("levels", {}).items():
        machine.levels[int(number)] = level
    for number, value in order.get("analog", {}).items():
        machine.analog[int(number)] = value
    usb = _here["usb"]
    usb.incoming.extend(order.get("octets", []))
    usb.outgoing.clear()
    _idle(order.get("idle_ms", 0))
    seen = _pass(order.get("ms", 0), order.get("only_timer", False), order.get("turning"))
    return json.dumps({
        "motors": _motors(), "seen": seen, "before": _here["before"],
        "servo_ns": machine.duties[config.SERVO_PIN], "text": "".join(usb.outgoing),
    })
