"""The dialogs of the Composer: examples to start from, and the prompt that went out to the model."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from textual.containers import VerticalScroll
from textual.content import Content

from text.i18n import N_, _
from text.plain import plain, plain_lines
from tui.dialogs.choice import ChoiceScreen
from tui.dialogs.dialog import Dialog, answers

if TYPE_CHECKING:
    from collections.abc import Iterator

    from textual.binding import BindingType

    from brain.asking import AskedModels
    from brain.client import ModelRequest


class Template(NamedTuple):
    """One example; title and thought are message ids."""

    title: str
    thought: str
    commands: tuple[str, ...] = ()
    before: str = ""
    """What stands before the JSON."""

    def text(self) -> str:
        """The JSON with its thought in the current language."""
        commands = "[" + ",".join(f"\n    {command}" for command in self.commands)
        commands += "\n  ]" if self.commands else "]"
        return f'{self.before}{{\n  "thought": "{_(self.thought)}",\n  "commands": {commands}\n}}\n'


TEMPLATES = (
    Template(
        N_("Look right and drive there slowly"),
        N_("Something moved on the right. I look there and roll closer, slowly."),
        ('{"action": "turn_head", "pan": -45, "tilt": 10}', '{"action": "drive", "speed": 0.2, "steering": -0.3}'),
    ),
    Template(
        N_("Stand still"), N_("It is too close. I stop."), ('{"action": "drive", "speed": 0.0, "steering": 0.0}',)
    ),
    Template(
        N_("Look around without driving"),
        N_("I stay where I am and look left, right and ahead."),
        tuple(f'{{"action": "turn_head", "pan": {pan}, "tilt": 0}}' for pan in (60, -60, 0)),
    ),
    Template(N_("Only a thought"), N_("Nothing is to be done now.")),
    Template(
        N_("Wrong: faster than allowed"),
        N_("I am in a hurry!"),
        ('{"action": "drive", "speed": 5.0, "steering": 0.0}',),
    ),
    Template(
        N_("Wrong: words of its own"),
        N_("I jump over it."),
        ('{"action": "jump", "height": 1.5}', '{"action": "drive", "speed": "fast", "stering": 0.0}'),
    ),
    Template(N_("Wrong: text around the JSON"), N_("Here you are."), before="Sure! Here is the JSON:\n"),
)
"""The composer starts with the first one."""


def templates_dialog() -> ChoiceScreen:
    """Return the dialog that answers with the number of the chosen template, empty for none."""
    choices = {str(number): _(one.title) for number, one in enumerate(TEMPLATES)}
    return ChoiceScreen(lambda: _("Templates"), lambda: _("They replace what stands in the editor."), choices)


LONGEST = 64 * 1024
"""Characters of a part that are shown: as many as a prompt may have."""
KIB = 1024
_BASE64_SHARE = 3 / 4


class PromptDialog(Dialog[None]):
    """The last request that went out: every message, word for word, and the form of the answer."""

    BINDINGS: ClassVar[list[BindingType]] = answers(
        ("composer.prompt_close", "escape", N_("Close"), N_("Back to the Composer."), None)
    )
    DEFAULT_CSS: ClassVar[str] = "PromptDialog #dialog { width: 110; }"

    def __init__(self, models: AskedModels) -> None:
        super().__init__()
        self._models = models

    def on_mount(self) -> None:
        """Let the arrow keys scroll."""
        self.query_one(VerticalScroll).focus()

    def title_words(self) -> str:
        request = self._models.went_out
        if request is None:
            return _("Prompt")
        return _("Prompt to {model}").format(model=plain(request.model, 60))

    def words(self) -> Content:
        request = self._models.went_out
        if request is None:
            return Content(_("Nothing has been asked since this session was opened."))
        return Content("\n").join(self._lines(request))

    def _lines(self, request: ModelRequest) -> Iterator[Content]:
        for message in request.messages:
            yield Content.styled(plain(str(message.get("role", "")), 20), "bold $text-accent")
            for text in _parts(message.get("content", "")):
                yield Content(self._shown(text))
            yield Content("")
        yield Content.styled(_("The form of the answer"), "bold $text-accent")
        form = json.dumps(request.form, indent=2, ensure_ascii=False)
        yield Content.styled(self._shown(form), "$text-muted")

    def _shown(self, text: str) -> str:
        return plain_lines(self._models.hidden_in(text)[:LONGEST])


def _parts(content: object) -> Iterator[str]:
    """Yield the texts of a message; a picture is named by its size."""
    if isinstance(content, str):
        yield content
        return
    for part in content if isinstance(content, (list, tuple)) else ():
        if part.get("type") != "image_url":
            yield str(part.get("text", ""))
            continue
        data = str(part["image_url"].get("url", "")).partition(",")[2]
        size = len(data) * _BASE64_SHARE / KIB
        yield _("[a picture of {size} KiB]").format(size=f"{size:.0f}")
