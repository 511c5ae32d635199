"""What stands in a field is what is sent, and what comes from outside goes back as it came."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st
from textual.app import App, ComposeResult
from textual.events import Paste

from graph.data import ParameterRow, ParametersResult
from tests.hostile_text import EVIL
from tests.tui.graph_stage import opened
from tests.tui.recorded import RecordedGraph
from tests.tui.recorded_nodes import graph_update
from text.plain import is_plain, plain
from text.yaml_scalars import in_quotes, unquoted
from tui.graph.parameter_dialog import ParameterDialog
from tui.graph.parameter_words import meant, typed
from tui.widgets.field import Field

NODE = "/sonar_front"


class FieldApp(App[None]):
    """One field."""

    def compose(self) -> ComposeResult:
        yield Field(EVIL)


async def test_what_is_pasted_is_made_visible_and_that_is_the_value() -> None:
    app = FieldApp()
    async with app.run_test() as pilot:
        field = app.query_one(Field)
        assert field.value == plain(EVIL)
        field.clear()
        field.post_message(Paste("/dri\u200bve\x1b]52;c;QQ==\x07\u202e"))
        await pilot.pause()
        assert field.value == "/dri\ufffdve␛]52;c;QQ==␇\ufffd"
        assert field.cursor_position == len(field.value)


@given(st.text(st.characters(exclude_categories=["Cs"]), max_size=80))
def test_a_text_typed_as_it_is_shown_is_that_text(text: str) -> None:
    assert is_plain(typed(text))
    assert meant(typed(text)) == text
    assert unquoted(in_quotes(text)) == text


async def asked(value: object, *keys: str) -> tuple[str, object]:
    """Open a parameter of this value, press keys and Enter: what stood there, what was set."""
    row = ParameterRow("topic", "string", value)  # type: ignore[arg-type]
    graph = RecordedGraph(update=graph_update())
    graph.node_parameters[NODE] = ParametersResult(NODE, (row,))
    async with opened(graph) as stage:
        await stage.choose(NODE)
        await stage.press("E")
        await stage.wait(lambda: stage.screen.query("GraphParameters"))
        await stage.wait_for("topic")
        await stage.press("enter")
        await stage.wait(lambda: isinstance(stage.app.screen, ParameterDialog))
        stood = stage.app.screen.query_one(Field).value
        await stage.press("end", *keys, "enter")
        await stage.wait(lambda: graph.set_to)
        return stood, graph.set_to[0][1]["topic"]


async def test_a_parameter_that_nobody_changed_is_not_corrupted() -> None:
    stood, sent = await asked(EVIL)
    assert is_plain(stood)
    assert "\\u001b]52;c;" in stood
    assert sent == EVIL
