"""The actions of a YAML form."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce, actions_of

if TYPE_CHECKING:
    from tui.yaml_form.form import YamlForm

action: Announce[YamlForm] = Announce()


@action(
    "form.submit",
    "ctrl+s",
    N_("Submit"),
    N_("Take the message as it is filled in, if nothing is wrong with it."),
    means="submit",
    footer=True,
    priority=True,
    when=lambda form: form.submits,
    label=lambda form: form.submit_title or N_("Submit"),
)
def submit_form(form: YamlForm) -> None:
    form.submit()


FORM_ACTIONS = actions_of(__name__)
