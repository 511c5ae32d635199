"""Pictures come from where they cost least, and from nobody who only says so."""

from __future__ import annotations

import pytest

from graph.data import EndpointInfo
from graph.heavy_types import COMPRESSED_IMAGE, IMAGE
from graph.pictures.source import is_away, picture_source, to_see
from graph.qos import BEST_EFFORT, TRANSIENT_LOCAL, VOLATILE, Qos
from graph.scan.endpoints import TopicEnds

CAMERA = "/camera/image_raw"
HERE, ELSEWHERE = b"\x01\x0f\x11\x22", b"\x01\x0f\x33\x44"


def ends(name: str, kind: str, durability: str = VOLATILE, host: bytes = HERE) -> TopicEnds:
    gid = host + bytes(12)
    end = EndpointInfo("/camera", kind, "reliable", durability, 1, "keep_last", gid=gid)
    return TopicEnds(name, (kind,), (end,))


RAW = ends(CAMERA, IMAGE)
COMPRESSED = ends(f"{CAMERA}/compressed", COMPRESSED_IMAGE)
RELAYED = ends(f"{CAMERA}/_deck/compressed", COMPRESSED_IMAGE)


@pytest.mark.parametrize(
    ("there", "source"),
    [
        ((), CAMERA),
        ((RAW,), CAMERA),
        ((RAW, COMPRESSED), COMPRESSED.name),
        ((COMPRESSED,), COMPRESSED.name),
        ((RAW, COMPRESSED, RELAYED), RELAYED.name),
        ((RAW, ends(COMPRESSED.name, "std_msgs/msg/String")), CAMERA),
        ((RAW, TopicEnds(COMPRESSED.name, (COMPRESSED_IMAGE,))), CAMERA),
    ],
)
def test_the_smallest_pictures_are_taken(there: tuple[TopicEnds, ...], source: str) -> None:
    assert picture_source(CAMERA, {each.name: each for each in there}) == source


def test_a_lost_picture_is_not_asked_for_again_unless_it_is_the_only_one() -> None:
    assert to_see(RAW) == Qos(BEST_EFFORT)
    assert to_see(ends(CAMERA, IMAGE, TRANSIENT_LOCAL)).durability == TRANSIENT_LOCAL


def test_another_machine_is_told_by_the_identifier() -> None:
    assert not is_away(RAW, HERE)
    assert is_away(ends(CAMERA, IMAGE, host=ELSEWHERE), HERE)
    assert not is_away(ends(CAMERA, IMAGE, host=ELSEWHERE), b"")
