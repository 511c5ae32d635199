"""Two models are asked the same in the Composer, of a real server."""

from __future__ import annotations

import pytest
from textual.widgets import Static

from tests.model_server import Exchange, ModelServer
from tests.tui.composer.asking import GOOD, WORDS, Answers, composer, sent, set_up
from tests.tui.composer.test_composer import ComposerStage
from tests.waiting import until
from tui.composer.compare import ComparedAnswer, CompareDialog
from tui.composer.json_editor import JsonEditor

pytestmark = pytest.mark.usefixtures("own_folders")


async def opened_comparison(stage: ComposerStage) -> CompareDialog:
    """Ask both, and wait for both."""
    await stage.pilot.press("alt+q")
    stage.screen.line.field.value = WORDS
    await stage.pilot.press("alt+c")
    await stage.pilot.pause()
    dialog = stage.app.screen
    assert isinstance(dialog, CompareDialog)
    both = dialog.query(ComparedAnswer)
    await until(lambda: all(one.state.whole for one in both), "both answers")
    await stage.pilot.pause()
    return dialog


def below(dialog: CompareDialog) -> list[str]:
    """What stands below each of the two answers."""
    return [str(one.content) for one in dialog.query(".compared-below").results(Static)]


async def test_two_models_are_compared_and_one_answer_is_taken(server: ModelServer) -> None:
    def by_model(exchange: Exchange) -> None:
        other = GOOD.replace("closer", "nearer")
        exchange.says(other if exchange.request["model"] == "m-2" else GOOD, usage=(412, 86))

    server.script = Answers(by_model)
    set_up(server.url, compare_with="m-2")
    async with composer() as stage:
        dialog = await opened_comparison(stage)
        assert [one.text for one in dialog.query(JsonEditor)] == [
            GOOD,
            GOOD.replace("closer", "nearer"),
        ]
        for words in below(dialog):
            assert words.startswith("✓ valid: 1 command\n412 + 86 tokens · first ")
        asked = [one.request["messages"] for one in server.exchanges if len(server.exchanges) > 3]
        assert asked[1] == asked[3]
        await stage.pilot.press("tab", "enter")
        await stage.pilot.pause()
        assert stage.screen.editor.text == GOOD.replace("closer", "nearer")
        assert sent(stage) == []
