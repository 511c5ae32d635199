"""A text field for a message as YAML."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.yaml_scalars import escaped
from tui.widgets.marked_editor import MarkedEditor
from tui.yaml_form.tokens import tokens

if TYPE_CHECKING:
    from collections.abc import Iterable

    from tui.widgets.marked_editor import Token


class YamlEditor(MarkedEditor):
    """Edits YAML; Enter starts a new line with the indentation of the current one."""

    def escaped(self, character: str) -> str:
        return escaped(character)

    def tokens_of(self, line: str) -> Iterable[Token]:
        return tokens(line)
