"""In a Russian sentence a fraction has a comma, wherever the sentence was made."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from cli.sessions import show
from graph.bag.reading import open_bag
from launcher.status import NodeState, NodeStatus, SessionInfo
from tests.unit.bags import write_bag
from text.i18n import localized, set_language
from text.sentences import say
from tui.logs.node_list import short_count

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

SESSION = SessionInfo("run-1", "/p/09-brain.yaml", "09-brain", domain=42)
NODE = NodeStatus("sonar", "nodes.mock_sonar", NodeState.READY, pid=7, cpu_percent=1.5)


@pytest.fixture(autouse=True)
def _in_russian() -> Iterator[None]:
    set_language("ru")
    yield
    set_language("en")


def test_a_number_has_a_comma_and_a_text_keeps_its_point() -> None:
    words = say("{a:.2f}, {b}, {c}", a=0.5, b="1.2.0", c=3)
    assert localized(words) == localized(words, "ru") == "0,50, 1.2.0, 3"
    assert localized(words, "en") == "0.50, 1.2.0, 3"


def test_the_nodes_in_the_background(capsys: pytest.CaptureFixture[str]) -> None:
    show(SESSION, [NODE, replace(NODE, name="camera", cpu_percent=None)])
    head, sonar = capsys.readouterr().out.splitlines()[1:3]
    assert "  ЦП %  МБ  " in head
    assert sonar.split()[4:5] == ["1,5"]


def test_where_a_recording_is_damaged(tmp_path: Path) -> None:
    file = write_bag(tmp_path / "long", seconds=500, hz=20) / "long.mcap"
    wrong = bytearray(file.read_bytes())
    wrong[9000:9200] = bytes(200)
    file.write_bytes(wrong)
    with open_bag(file) as bag:
        list(bag.messages())
        assert bag.damage is not None
        assert ", первое через 0,0 с от начала" in localized(bag.damage)


def test_how_many_lines_of_a_log() -> None:
    assert [short_count(1234), short_count(12345)] == ["1,2k", "12k"]
