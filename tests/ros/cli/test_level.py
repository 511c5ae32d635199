"""`deck level` on real nodes: the level in a word, and exit codes that a script can use."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.deck_process import deck
from tests.middleware_words import own_words
from tests.ros.managed_nodes import started
from tests.ros.node_process import NodeProcess

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.nightly


@pytest.fixture(autouse=True)
def _nodes(ros_domain: int) -> Iterator[None]:
    with started(ros_domain, "good"), NodeProcess("nodes.hello", ros_domain):
        yield


def test_a_level_is_shown_set_or_refused() -> None:
    for words, code, said in (
        (("good",), 0, "info"),
        (("/hello_node", "debug"), 0, "debug"),
        (("hello_node",), 0, "debug"),
        (("nobody", "debug"), 1, "deck: there is no node /nobody in the graph"),
        (("good", "loud"), 2, "invalid choice: 'loud'"),
    ):
        done = deck("level", *words)
        out, err = "\n".join(done.lines), own_words("\n".join(done.errors))
        assert done.process.returncode == code, (words, out, err)
        assert (out, err) == (said, "") if code == 0 else (out == "" and said in err), (out, err)
