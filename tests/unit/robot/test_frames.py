"""Frames in words: what a person sees of a wire, and what noise makes of it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.frames.protocols import FramePiece, FrameReader
from robot.frames.readers import PicoReader, ServoReader, TofReader
from robot.wire import lsc16 as wire_lsc16
from robot.wire import pico as wire_pico
from robot.wire import tfluna as wire_tfluna
from robot.wire.line import wrap
from robot.wire.lsc16 import Battery, BatteryRequest, ServoMove
from robot.wire.pico import Drive, Halt, Hello, Release, Telemetry, Welcome
from robot.wire.tfluna import TofFrame
from tests.unit.streams import cut

TELEMETRY = Telemetry(3, 61250, 2, 6.18, -6.15, 0.35, 7.42, 0.81, None, 0, frozenset("EN"))
TELEMETRY_EN = (
    "wheels left 6.18 right -6.15 rad/s steering 0.35 rad, flags: emergency stop latched,"
    " no encoders: speeds are as commanded, 7.42 V, left 0.81 A, obeyed 2, refused 0,"
    " up 61.2 s, seq 3, crc ok"
)
TELEMETRY_RU = (
    "колёса: левое 6,18 правое -6,15 рад/с, руль 0,35 рад, флаги: аварийный стоп,"
    " без энкодеров: скорости по командам, 7,42 В, левый 0,81 А, исполнено 2,"
    " отвергнуто 0, работает 61,2 с, № 3, crc верна"
)
NEAR = wire_tfluna.encode(TofFrame(123, 1000, 25.0))

PARTS = st.one_of(
    st.binary(max_size=60),
    st.sampled_from([NEAR, wire_pico.encode(Halt(7)), wire_lsc16.encode(Battery(7400))]),
    st.sampled_from([b"Y", b"YY", b"UU", b"U", b"$", b"*"]),
)


def said(reader: FrameReader, *chunks: bytes) -> list[tuple[str, str]]:
    pieces = [piece for chunk in chunks for piece in reader.feed(chunk)]
    return [(piece.kind.value, piece.text) for piece in pieces]


@pytest.mark.parametrize(
    ("message", "en", "ru"),
    [
        (Hello(0), "hello, protocol 1, seq 0, crc ok", "привет, протокол 1, № 0, crc верна"),
        (Drive(17, 3.2, 3.4, 0.1),
         "drive left 3.20 right 3.40 rad/s steering 0.10 rad, seq 17, crc ok",
         "движение: левое 3,20 правое 3,40 рад/с, руль 0,10 рад, № 17, crc верна"),
        (Halt(7), "EMERGENCY STOP, seq 7, crc ok", "АВАРИЙНЫЙ СТОП, № 7, crc верна"),
        (Release(8), "emergency stop released, seq 8, crc ok",
         "аварийный стоп снят, № 8, crc верна"),
        (Welcome(0, 1, "1.0.0"), "the Pico answers: firmware 1.0.0, protocol 1, seq 0, crc ok",
         "Pico отвечает: прошивка 1.0.0, протокол 1, № 0, crc верна"),
        (TELEMETRY, TELEMETRY_EN, TELEMETRY_RU),
    ],
)  # fmt: skip
def test_lines_of_the_pico(message: wire_pico.Message, en: str, ru: str) -> None:
    line = wire_pico.encode(message)
    assert said(PicoReader("en"), line[:5], line[5:]) == [("frame", en)]
    assert said(PicoReader("ru"), line) == [("frame", ru)]


@pytest.mark.parametrize(
    ("line", "kind", "words"),
    [
        (b"$D,2,6200,-6200,350*2673\n", "bad", "CRC FAILED: got 2673, expected 2672"),
        (b"$D,2,6200,-62\r\n", "bad", "INCOMPLETE LINE"),
        (b"$D,2,6200,-6200,350*2672"[:-1] + b"\xff\n", "bad", "INCOMPLETE LINE"),
        (wrap("X,1"), "bad", "UNKNOWN LINE, though its crc is right"),
        (b"MicroPython v1.25\n", "noise", "noise 18 bytes"),
        (b"\x1b[31m" * 40, "noise", "noise 200 bytes"),
    ],
)
def test_what_is_no_line_of_the_pico(line: bytes, kind: str, words: str) -> None:
    assert said(PicoReader("en"), line) == [(kind, words)]


@pytest.mark.parametrize(
    ("frame", "words"),
    [
        (TofFrame(123, 1000, 25.0), "distance 1.23 m, strength 1000, 25.0 °C"),
        (TofFrame(0, 50, 30.0), "nothing in range (0 cm), strength 50, 30.0 °C"),
        (TofFrame(10, 900, 30.0), "too close to measure (10 cm), strength 900, 30.0 °C"),
        (TofFrame(0, 65535, 30.0), "no valid reading (0 cm), strength 65535, 30.0 °C"),
    ],
)
def test_frames_of_a_sonar(frame: TofFrame, words: str) -> None:
    assert said(TofReader("en"), wire_tfluna.encode(frame)) == [("frame", words)]


@pytest.mark.parametrize(
    ("octets", "found"),
    [
        (
            wire_lsc16.encode(ServoMove(500, ((1, 1500), (2, 1700)))),
            ("frame", "move in 500 ms: servo 1 to 1500 us, servo 2 to 1700 us"),
        ),
        (wire_lsc16.encode(Battery(7400)), ("frame", "battery 7.40 V")),
        (wire_lsc16.encode(BatteryRequest()), ("frame", "battery voltage?")),
        (wire_lsc16.encode(wire_lsc16.ActionRun(3, 2)), ("frame", "group 3 runs 2 times")),
        (b"\x55\x55\x02\x07", ("frame", "group stops")),
        (b"\x55\x55\x02\x63", ("bad", "NOT AN LSC-16 FRAME")),
        (b"\x55\x55\xff", ("noise", "noise 2 bytes")),
    ],
)
def test_frames_of_the_servos(octets: bytes, found: tuple[str, str]) -> None:
    assert said(ServoReader("en"), octets)[0] == found


@pytest.mark.parametrize("language", ["en", "ru"])
@given(parts=st.lists(PARTS, max_size=12), places=st.lists(st.integers(0, 500), max_size=6))
def test_no_byte_of_noise_is_lost_or_said_twice(language: str, parts: list[bytes], places: list[int]) -> None:
    stream = b"".join(parts)
    chunks = cut(stream, places)
    for make in (TofReader, ServoReader):
        reader: FrameReader = make(language)
        pieces: list[FramePiece] = [piece for chunk in chunks for piece in reader.feed(chunk)]
        assert b"".join(piece.octets for piece in [*pieces, *reader.flush()]) == stream
    reader = PicoReader(language)
    pieces = [piece for chunk in chunks for piece in reader.feed(chunk)]
    together = b"".join(piece.octets for piece in [*pieces, *reader.flush()])
    assert together.translate(None, b"\r\n") == stream.translate(None, b"\r\n")
