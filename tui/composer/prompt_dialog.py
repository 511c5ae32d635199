"""The request that went out to the model: every message, word for word, and the answer's form."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, ClassVar

from textual.containers import VerticalScroll
from textual.content import Content

from text.i18n import N_, _
from text.plain import plain, plain_lines
from tui.actions import Announce, bindings
from tui.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from textual.binding import BindingType

    from brain.asking import AskedModels
    from brain.client import ModelRequest

action: Announce[PromptDialog] = Announce()

LONGEST = 64 * 1024
"""Characters of a part that are shown: as many as a prompt may have."""
KIB = 1024
_BASE64_SHARE = 3 / 4


@action("composer.prompt_close", "escape", N_("Close"), N_("Back to the Composer."), footer=True, palette=False)
def close_prompt(dialog: PromptDialog) -> None:
    dialog.dismiss(None)


class PromptDialog(Dialog[None]):
    """Scrolls with the arrow keys."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(close_prompt)
    DEFAULT_CSS: ClassVar[str] = "PromptDialog #dialog { width: 110; }"

    def __init__(self, models: AskedModels) -> None:
        """Show the last request of `models`."""
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
                yield Content(plain_lines(self._models.hidden_in(text)[:LONGEST]))
            yield Content("")
        yield Content.styled(_("The form of the answer"), "bold $text-accent")
        form = json.dumps(request.form, indent=2, ensure_ascii=False)
        yield Content.styled(plain_lines(self._models.hidden_in(form)[:LONGEST]), "$text-muted")


def _parts(content: object) -> Iterator[str]:
    """Yield the texts of a message; a picture is named by its size."""
    if isinstance(content, str):
        yield content
        return
    for part in content if isinstance(content, (list, tuple)) else ():
        yield _part(part)


def _part(part: Mapping[str, Any]) -> str:
    if part.get("type") != "image_url":
        return str(part.get("text", ""))
    data = str(part["image_url"].get("url", "")).partition(",")[2]
    size = len(data) * _BASE64_SHARE / KIB
    return _("[a picture of {size} KiB]").format(size=f"{size:.0f}")
