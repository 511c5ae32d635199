"""The form of YAML: its colours, its verdict, and what it hands over."""

from __future__ import annotations

from typing import Any

import pytest
from textual.app import App, ComposeResult
from textual.pilot import Pilot

from tests.waiting import until
from text.i18n import set_language
from tui.widgets.qos_words import misfit_words
from tui.yaml_form.form import YamlForm

DRIVE = "ackermann_msgs/msg/AckermannDriveStamped"


class FormApp(App[None]):
    """A bare app with a form."""

    def __init__(self, type_name: str) -> None:
        super().__init__()
        self.form = YamlForm(type_name)
        self.submitted: list[Any] = []

    def compose(self) -> ComposeResult:
        yield self.form

    def on_yaml_form_submitted(self, message: YamlForm.Submitted) -> None:
        self.submitted.append(message.value)

    def lines(self) -> list[str]:
        editor = self.form.editor
        return [editor.render_line(y).text.rstrip() for y in range(editor.size.height)]


async def checked(pilot: Pilot[Any]) -> None:
    """Wait until what stands in the form has been checked."""
    form = pilot.app.query_one(YamlForm)
    await until(lambda: form.text and form.text == form._checked, "a form that is checked")
    await pilot.pause()


@pytest.mark.parametrize(
    ("language", "words"),
    [
        ("en", "✗ line 7: drive.speed: expected a number, got 'fast'"),
        ("ru", "✗ строка 7: drive.speed: нужно число, а здесь 'fast'"),
    ],
)
async def test_what_is_wrong_is_named_and_its_line_marked(language: str, words: str) -> None:
    set_language(language)
    app = FormApp(DRIVE)
    async with app.run_test(size=(80, 24)) as pilot:
        await checked(pilot)
        app.form.editor.replace_all(app.form.text.replace("speed: 0.0", "speed: fast"))
        await checked(pilot)
        assert app.form.verdict == words
        assert app.form.value is None
        assert "✗" in app.lines()[6]
        app.form.editor.replace_all(app.form.text.replace("speed: fast", "speed: 1"))
        await checked(pilot)
        assert "✗" not in "".join(app.lines())
        assert app.form.value is not None


async def test_ctrl_s_hands_over_what_is_right_and_goes_to_what_is_wrong() -> None:
    app = FormApp("std_msgs/msg/String")
    async with app.run_test(size=(80, 24)) as pilot:
        await checked(pilot)
        app.form.editor.focus()
        app.form.editor.replace_all("# a word\ndata: on")
        # At once: what is handed over is what stands there, not what was checked last.
        await pilot.press("ctrl+s")
        assert app.submitted == []
        assert app.form.editor.cursor_location == (1, 6)
        app.form.editor.replace_all('data: "on"')
        await pilot.press("ctrl+s")
        await pilot.pause()
        assert app.submitted == [{"data": "on"}]


async def test_a_type_that_is_not_there_says_so() -> None:
    app = FormApp("nope_msgs/msg/Thing")
    async with app.run_test(size=(80, 24)):
        await until(lambda: app.form.error is not None, "the error")
        assert "package nope_msgs is not installed" in app.form.verdict
        assert app.form.value is None


def facts(**values: str) -> dict[str, str]:
    return {"publisher": "/lidar", "subscriber": "/brain", **values}


APART = "/brain does not hear /lidar: "
LIFE = "it asks for a sign of life at least every 2 s (liveliness lease duration), "


@pytest.mark.parametrize(
    ("policy", "offered", "requested", "why", "way_out"),
    [
        (
            "liveliness", "automatic", "manual_by_topic",
            "liveliness manual_by_topic is asked for, automatic is offered.",
            " Let /lidar offer manual_by_topic, or let /brain ask for automatic.",
        ),
        (
            "deadline", "0.5", "0.25",
            "it asks for a message at least every 0.25 s (deadline), 0.5 s is offered.",
            " Let /lidar offer 0.25 s or less, or let /brain ask for 0.5 s or more.",
        ),
        (
            "lease", "3", "2",
            LIFE + "3 s is offered.",
            " Let /lidar offer 2 s or less, or let /brain ask for 3 s or more.",
        ),
    ],
)  # fmt: skip
def test_each_policy_has_its_own_words(
    policy: str, offered: str, requested: str, why: str, way_out: str
) -> None:
    values = facts(policy=policy, offered=offered, requested=requested)
    assert misfit_words(values) == APART + why + way_out
