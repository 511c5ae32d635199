"""The changelog: nothing stands in it twice, and what it says of versions is so."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

from launcher.wire import VERSION

TEXT = (Path(__file__).parents[3] / "CHANGELOG.md").read_text(encoding="utf-8")


WORDS = 12
"""What begins with so many equal words tells the same, if with another list."""


def test_no_paragraph_stands_twice() -> None:
    paragraphs = re.split(r"\n(?=- |#|\n)", TEXT)
    counted = Counter(" ".join(each.split()[:WORDS]) for each in paragraphs if len(each.split()) > 3)
    assert [each for each, count in counted.items() if count > 1] == []


def test_each_release_has_every_kind_of_change_once() -> None:
    for release in re.split(r"^## ", TEXT, flags=re.MULTILINE)[1:]:
        kinds = re.findall(r"^### (.+)$", release, re.MULTILINE)
        assert len(kinds) == len(set(kinds))


def test_one_version_of_the_control_protocol_is_told_and_it_is_the_one_that_is_spoken() -> None:
    unreleased = re.split(r"^## ", TEXT, flags=re.MULTILINE)[1]
    told = re.findall(r"control protocol (?:has|is) version (\d+)", unreleased)
    assert told == [str(VERSION)]
