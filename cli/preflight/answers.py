"""Whether the expected device is at a port: found out by listening and harmless requests.

A sonar is only listened to. The Pico gets a greeting, which moves nothing and stops any motion. The
servo board is asked for its battery voltage. No drive or move command is ever sent.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from cli.doctor.finding import Finding, warn
from cli.preflight.open_port import OpenPort, bad, good
from robot.wire.lsc16 import Battery, BatteryRequest, ServoDecoder
from robot.wire.lsc16 import encode as encode_servos
from robot.wire.pico import PROTOCOL, Hello, PicoDecoder, Telemetry, Welcome
from robot.wire.pico import encode as encode_pico
from robot.wire.tfluna import Model, TofDecoder, TofFrame
from text.i18n import LocalizedFloat, _

NAMES = {"pico": "Pico", "tf_luna": "TF-Luna", "tfmini_s": "TFmini-S", "lsc16": "LSC-16"}
"""Kind of device to its display name."""
LISTEN_S, ANSWER_S = 0.4, 1.0
GREETINGS = 10
"""How many are sent in that time, as they may be lost: on a noisy line every other one is."""
MEASURE_S = 0.5
ENOUGH_FRAMES = 3
"""Readings needed to recognise a sonar at an unexpected port: fewer may be chance."""


def ask(kind: str, line: OpenPort) -> Finding:
    """Check the device at a port; raises OSError if it disappears meanwhile."""
    if kind == "pico":
        return _pico(line)
    if kind == "lsc16":
        return _servos(line)
    if kind in ("tf_luna", "tfmini_s"):
        return _sonar(kind, line)
    return good(_("it can be opened; how it should answer is not known"))


def recognised(heard: bytes) -> str:
    """Return the name of the device that sends such data, empty if unknown."""
    if PicoDecoder().feed(heard):
        return NAMES["pico"]
    if len(TofDecoder().feed(heard)) >= ENOUGH_FRAMES:
        return _("a ToF sonar")
    if b">>>" in heard or b"MicroPython" in heard:
        return _("a Python prompt")
    return ""


def _pico(line: OpenPort) -> Finding:
    decoder = PicoDecoder()
    told: list[Telemetry | Welcome] = []

    def take(data: bytes) -> bool:
        told.extend(one for one in decoder.feed(data) if isinstance(one, (Telemetry, Welcome)))
        return any(isinstance(one, Welcome) for one in told)

    heard = line.hear(LISTEN_S, lambda data: take(data) or bool(told))
    if not told and recognised(heard):
        return _python_prompt(heard) or _another("pico", heard)
    heard += _greet(line, take)
    welcome = next((one for one in told if isinstance(one, Welcome)), None)
    telemetry = next((one for one in reversed(told) if isinstance(one, Telemetry)), None)
    if welcome is None and telemetry is None:
        return _python_prompt(heard) or _nothing("pico", heard, line.baud)
    # One line may have been cut when the port was opened.
    garbled = decoder.errors > 1
    if welcome is None and garbled:
        return bad(_("some lines arrive garbled"), _better_cable())
    if welcome is None:
        text = _("telemetry arrives, but no answer: what is sent gets lost")
        return bad(text, _("check the cable; unplug the Pico and plug it in again"))
    if welcome.protocol != PROTOCOL:
        text = _("the firmware speaks protocol {theirs}, this program {ours}")
        text = text.format(theirs=welcome.protocol, ours=PROTOCOL)
        return bad(text, _("flash firmware/pico2 (docs/pico-firmware.md)"))
    return _well_pico(welcome, telemetry, garbled=garbled)


def _greet(line: OpenPort, answered: Callable[[bytes], bool]) -> bytes:
    """Send the greeting until it is answered, then listen for a while for garbled lines."""
    heard = b""
    for _greeting in range(GREETINGS):
        line.say(encode_pico(Hello(0)))
        heard += line.hear(ANSWER_S / GREETINGS, answered)
        if answered(b""):
            return heard + line.hear(MEASURE_S, lambda data: answered(data) and False)
    return heard


def _well_pico(welcome: Welcome, telemetry: Telemetry | None, *, garbled: bool) -> Finding:
    text = _("firmware {firmware}").format(firmware=welcome.firmware)
    if telemetry is not None and telemetry.battery_v is not None:
        text += ", " + _("battery {volts:.1f} V").format(volts=LocalizedFloat(telemetry.battery_v))
    troubles = {
        "E": (_("the emergency stop is held"), _("start the robot and press Ctrl+R")),
        "L": (_("the left motor driver reports a fault"), _("check its wiring and power supply")),
        "R": (_("the right motor driver reports a fault"), _("check its wiring and power supply")),
        "U": (_("the battery is low"), _("charge it, and switch on the motors' power supply")),
    }
    flags = telemetry.flags if telemetry is not None else frozenset()
    found = [trouble for flag, trouble in troubles.items() if flag in flags]
    if garbled:
        found.append((_("some lines arrive garbled"), _better_cable()))
    if not found:
        return good(text)
    text = ", ".join([text, *(words for words, _fix in found)])
    return warn("", text, "; ".join(dict.fromkeys(fix for _words, fix in found)))


def _python_prompt(heard: bytes) -> Finding | None:
    if b">>>" not in heard and b"MicroPython" not in heard and b"Traceback" not in heard:
        return None
    text = _("a Pico answers, but not with Deck's firmware")
    return bad(text, _("flash firmware/pico2 (docs/pico-firmware.md)"))


def _sonar(kind: str, line: OpenPort) -> Finding:
    decoder = TofDecoder()
    model = Model(kind)
    heard = line.hear(ANSWER_S, lambda data: len(decoder.feed(data)) > 0)
    if not decoder.frames:
        return _another(kind, heard) if recognised(heard) else _nothing(kind, heard, line.baud)
    began_s, before = time.monotonic(), decoder.frames
    last: list[TofFrame] = []

    def take(data: bytes) -> bool:
        last[:] = decoder.feed(data)[-1:] or last
        return False

    line.hear(MEASURE_S, take)
    rate = (decoder.frames - before) / (time.monotonic() - began_s)
    if not last:
        return _nothing(kind, heard, line.baud)
    metres = last[0].distance_m(model)
    text = _("{distance}, {rate:.0f} readings a second").format(distance=_far(metres), rate=rate)
    if decoder.errors > before:
        garbled = _("{text}, many of them garbled").format(text=text)
        return warn("", garbled, _better_cable())
    return good(text)


def _far(metres: float) -> str:
    if math.isnan(metres):
        return _("no valid reading")
    if math.isinf(metres):
        return _("nothing in range") if metres > 0 else _("too close to measure")
    return _("{metres:.2f} m").format(metres=LocalizedFloat(metres))


def _better_cable() -> str:
    return _("check the cable: short, away from those of the motors, with a common ground")


def _servos(line: OpenPort) -> Finding:
    decoder = ServoDecoder()
    told: list[Battery] = []

    def take(data: bytes) -> bool:
        told.extend(one for one in decoder.feed(data) if isinstance(one, Battery))
        return bool(told)

    heard = line.hear(LISTEN_S, lambda _data: False)
    if recognised(heard):
        return _another("lsc16", heard)
    line.say(encode_servos(BatteryRequest()))
    heard += line.hear(ANSWER_S, take)
    if not told:
        return _nothing("lsc16", heard, line.baud)
    return good(_("battery {volts:.1f} V").format(volts=LocalizedFloat(told[0].millivolts / 1000)))


def _another(kind: str, heard: bytes) -> Finding:
    text = _("{found} answers here, not the {wanted}")
    return bad(
        text.format(found=recognised(heard), wanted=NAMES[kind]),
        _("give each device its own port; ls -l /dev/serial/by-id shows which is which"),
    )


def _nothing(kind: str, heard: bytes, baud: int) -> Finding:
    """Report that nothing useful was received: garbage, or not a single byte."""
    name = NAMES[kind]
    if heard:
        text = _("{count} bytes arrived, but no {name} sends such data").format(count=len(heard), name=name)
        fix = _("wrong baud (this is {baud}), another device, or a bad cable")
        return bad(text, fix.format(baud=baud))
    fixes = {
        "pico": _("flash firmware/pico2 (docs/pico-firmware.md), or try another cable"),
        "lsc16": _("switch the board on; cross TX and RX, connect the grounds; baud 9600"),
    }
    sonar = _("check its power supply (5 V), wiring and mode: serial, not I2C; baud 115200")
    return bad(_("the port is silent: no {name}").format(name=name), fixes.get(kind, sonar))
