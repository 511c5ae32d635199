"""Examples to start from, and the dialog that offers them."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, NamedTuple

from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import OptionList, Static

from text.i18n import N_, _
from tui.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from textual.app import ComposeResult


class Template(NamedTuple):
    """One example; title and thought are message ids."""

    title: str
    thought: str
    json: str
    """The whole text, with `{thought}` where the thought belongs."""

    def text(self) -> str:
        """The JSON with its thought in the current language."""
        return self.json.replace("{thought}", _(self.thought))


TEMPLATES = (
    Template(
        N_("Look right and drive there slowly"),
        N_("Something moved on the right. I look there and roll closer, slowly."),
        """{
  "thought": "{thought}",
  "commands": [
    {"action": "turn_head", "pan": -45, "tilt": 10},
    {"action": "drive", "speed": 0.2, "steering": -0.3}
  ]
}
""",
    ),
    Template(
        N_("Stand still"),
        N_("It is too close. I stop."),
        """{
  "thought": "{thought}",
  "commands": [
    {"action": "drive", "speed": 0.0, "steering": 0.0}
  ]
}
""",
    ),
    Template(
        N_("Look around without driving"),
        N_("I stay where I am and look left, right and ahead."),
        """{
  "thought": "{thought}",
  "commands": [
    {"action": "turn_head", "pan": 60, "tilt": 0},
    {"action": "turn_head", "pan": -60, "tilt": 0},
    {"action": "turn_head", "pan": 0, "tilt": 0}
  ]
}
""",
    ),
    Template(
        N_("Only a thought"),
        N_("Nothing is to be done now."),
        """{
  "thought": "{thought}",
  "commands": []
}
""",
    ),
    Template(
        N_("Wrong: faster than allowed"),
        N_("I am in a hurry!"),
        """{
  "thought": "{thought}",
  "commands": [
    {"action": "drive", "speed": 5.0, "steering": 0.0}
  ]
}
""",
    ),
    Template(
        N_("Wrong: words of its own"),
        N_("I jump over it."),
        """{
  "thought": "{thought}",
  "commands": [
    {"action": "jump", "height": 1.5},
    {"action": "drive", "speed": "fast", "stering": 0.0}
  ]
}
""",
    ),
    Template(
        N_("Wrong: text around the JSON"),
        N_("Here you are."),
        """Sure! Here is the JSON:
{
  "thought": "{thought}",
  "commands": []
}
""",
    ),
)
"""The composer starts with the first one."""


class TemplatesDialog(Dialog[str | None]):
    """Returns the text of the chosen template, None if none was chosen."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", show=False)]
    DEFAULT_CSS: ClassVar[str] = """
    TemplatesDialog OptionList { height: auto; background: $surface; }
    TemplatesDialog #dialog-text { padding: 1 0 0 0; color: $text-muted; }
    """

    def title_words(self) -> str:
        return _("Templates")

    def words(self) -> Content:
        return Content(_("Enter takes it, Escape closes"))

    def compose(self) -> ComposeResult:
        """Put the frame around the list."""
        with Vertical(id="dialog"):
            yield OptionList(*(_(one.title) for one in TEMPLATES), markup=False, compact=True)
            yield Static(id="dialog-text", markup=False)

    def on_mount(self) -> None:
        self.query_one(OptionList).focus()

    def action_leave(self) -> None:
        """Close without choosing one."""
        self.dismiss(None)

    @on(OptionList.OptionSelected)
    def _selected(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(TEMPLATES[event.option_index].text())
