"""The lines between the computer and the Pico: the document, the shared vectors, and noise."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.wire.line import LONGEST, LineSplitter, crc16, unwrap, wrap
from robot.wire.pico import (
    FLAGS,
    Drive,
    Halt,
    Hello,
    Message,
    PicoDecoder,
    Release,
    Telemetry,
    Welcome,
    encode,
    parse,
)
from tests.unit.streams import cut, flipped, noise

ROOT = Path(__file__).parents[3]
VECTORS = json.loads((ROOT / "firmware/pico2/vectors.json").read_text(encoding="utf-8"))
DOCUMENT = (ROOT / "docs/pico-protocol.md").read_text(encoding="utf-8")
KINDS = {"V": Hello, "D": Drive, "E": Halt, "R": Release, "W": Welcome, "T": Telemetry}

sequences = st.integers(0, 65535)
speeds = st.integers(-200_000, 200_000).map(lambda milli: milli / 1000)
angles = st.integers(-1571, 1571).map(lambda milli: milli / 1000)
measured = st.none() | st.integers(0, 60_000).map(lambda milli: milli / 1000)
counters = st.integers(0, 0xFFFFFFFF)
versions = st.from_regex(r"[0-9a-z.]{1,16}", fullmatch=True)
messages: st.SearchStrategy[Message] = st.one_of(
    st.builds(Hello, sequences, st.integers(0, 255)),
    st.builds(Drive, sequences, speeds, speeds, angles),
    st.builds(Halt, sequences),
    st.builds(Release, sequences),
    st.builds(Welcome, sequences, st.integers(0, 255), versions),
    st.builds(
        Telemetry, sequences, counters, sequences, speeds, speeds, angles, measured, measured,
        measured, counters, st.frozensets(st.sampled_from(sorted(FLAGS))),
    ),
)  # fmt: skip


def decode(line: bytes) -> Message | None:
    body = unwrap(line)
    return None if body is None else parse(body)


@pytest.mark.parametrize(("text", "crc"), VECTORS["crc"])
def test_the_check_is_the_one_it_is_said_to_be(text: str, crc: str) -> None:
    assert f"{crc16(text.encode()):04X}" == crc


@pytest.mark.parametrize("vector", VECTORS["from_host"] + VECTORS["from_pico"], ids=str)
def test_shared_good_lines_are_understood_and_written_again(vector: dict[str, list[str]]) -> None:
    line = "".join(vector["line"]).encode()
    message = decode(line)
    assert type(message) is KINDS[vector["fields"][0]]
    assert message is not None
    assert encode(message) == line + b"\n"
    assert line.decode()[1:-5] == ",".join(map(str, vector["fields"]))


@pytest.mark.parametrize("vector", VECTORS["bad"], ids=lambda vector: vector["why"])
def test_shared_bad_lines_are_refused(vector: dict[str, str]) -> None:
    decoder = PicoDecoder()
    assert decode(vector["line"].encode()) is None
    # In a stream what stands before a `$` is noise, but here nothing good stands behind one.
    assert decoder.feed(vector["line"].encode() + b"\n") == []
    assert decoder.errors == bool(vector["line"])


def test_every_line_in_the_document_is_true_and_every_kind_is_there() -> None:
    lines = re.findall(r"\$[A-Z],[^`\s]*\*[0-9A-F]{4}", DOCUMENT)
    decoded = [decode(line.encode()) for line in lines]
    assert {type(message) for message in decoded} == set(KINDS.values())
    for flag in FLAGS:
        assert re.search(rf"^\| {flag} \|", DOCUMENT, re.MULTILINE)


def test_values_mean_what_the_document_says() -> None:
    assert decode(b"$D,2,6200,-6200,350*2672") == Drive(2, 6.2, -6.2, 0.35)
    told = decode(b"$T,4,61270,2,0,0,0,-1,-1,-1,12,EWA*D84B")
    assert isinstance(told, Telemetry)
    assert (told.battery_v, told.refused) == (None, 12)
    assert told.flags == set("EWA")


@given(messages)
def test_what_is_written_is_read_again(message: Message) -> None:
    line = encode(message)
    assert len(line) <= LONGEST
    assert decode(line[:-1]) == message


@pytest.mark.parametrize(
    "message",
    [
        Drive(1, math.nan, 0, 0), Drive(1, math.inf, 0, 0), Drive(1, 0, 201, 0),
        Drive(1, 0, 0, 1.6), Drive(-1, 0, 0, 0), Halt(65536), Welcome(0, 1, "a b"),
        Welcome(0, 1, ""),
    ],
)  # fmt: skip
def test_values_that_no_line_can_carry_are_refused(message: Message) -> None:
    with pytest.raises(ValueError, match=r"out of range|finite|NaN"):
        encode(message)


@pytest.mark.parametrize("body", ["", "a$b", "a*b", "a\nb", "x" * LONGEST])
def test_bodies_that_no_line_can_carry_are_refused(body: str) -> None:
    with pytest.raises(ValueError, match="no line"):
        wrap(body)


@pytest.mark.parametrize("message", [Drive(2, 6.2, -6.2, 0.35), Halt(7)], ids=str)
def test_no_one_or_two_turned_bits_make_a_message(message: Message) -> None:
    good = encode(message)
    for line in flipped(good, 2):
        heard = PicoDecoder().feed(line + b"\n")
        # The end may be a carriage return, and what is before the `$` does not matter.
        assert heard == [] or line[:-1] == good[:-1], line


@given(st.lists(st.binary(max_size=400)))
def test_noise_never_raises_and_is_not_kept(pieces: list[bytes]) -> None:
    splitter = LineSplitter()
    for piece in pieces:
        for body in splitter.feed(piece):
            assert unwrap(wrap(body)[:-1]) == body
            parse(body)
    assert len(splitter._rest) <= LONGEST


@given(st.text())
def test_any_body_is_parsed_or_refused(body: str) -> None:
    message = parse(body)
    assert message is None or decode(encode(message)[:-1]) == message


@given(noise, st.lists(messages, max_size=5), st.lists(st.integers(0, 2000), max_size=20))
def test_messages_behind_noise_are_found_however_the_stream_is_cut(
    before: bytes, sent: list[Message], places: list[int]
) -> None:
    decoder = PicoDecoder()
    stream = before + b"\n" + b"".join(map(encode, sent))
    heard = [message for piece in cut(stream, places) for message in decoder.feed(piece)]
    assert heard[len(heard) - len(sent) :] == sent
    assert len(heard) == len(sent)


def test_a_line_that_noise_runs_into_is_still_found() -> None:
    decoder = PicoDecoder()
    assert decoder.feed(b"\xff\x00garbage$D" + encode(Halt(7))) == [Halt(7)]
    assert decoder.errors == 1


def test_ten_megabytes_without_an_end_are_not_kept() -> None:
    decoder = PicoDecoder()
    for _ in range(160):
        assert decoder.feed(b"$D,1" * 16384) == []
    assert len(decoder._lines._rest) <= LONGEST
    assert decoder.feed(b"\n" + encode(Halt(1))) == [Halt(1)]
    assert decoder.errors == 1
