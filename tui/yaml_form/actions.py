"""The actions of a YAML form."""

from __future__ import annotations

from typing import Protocol

from text.i18n import N_
from tui.actions.action import Action


class FormTarget(Protocol):
    """The part of a form that its actions use."""

    submits: bool
    submit_title: str

    def submit(self) -> None:
        """Check the text, and report that it was submitted."""


class SubmitForm(Action[FormTarget]):
    """Submit the message."""

    id = "form.submit"
    key = "ctrl+s"
    title = N_("Submit")
    means = "submit"
    tooltip = N_("Take the message as it is filled in, if nothing is wrong with it.")
    footer = True
    priority = True

    @classmethod
    def possible(cls, target: FormTarget) -> bool | None:
        """Only if the form itself is submitted."""
        return target.submits

    @classmethod
    def label(cls, target: FormTarget) -> str:
        """Named after what happens to the message."""
        return target.submit_title or cls.title

    @classmethod
    async def run(cls, target: FormTarget) -> None:
        target.submit()


FORM_ACTIONS = (SubmitForm,)
