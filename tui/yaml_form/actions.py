"""What can be done in a form of YAML."""

from __future__ import annotations

from typing import Protocol

from text.i18n import N_
from tui.actions.action import Action


class FormTarget(Protocol):
    """What these actions need of a form."""

    submits: bool
    submit_title: str

    def submit(self) -> None:
        """Check, and tell that it was submitted."""


class SubmitForm(Action[FormTarget]):
    """The message as it is filled in."""

    id = "form.submit"
    key = "ctrl+s"
    title = N_("Submit")
    means = "submit"
    tooltip = N_("Take the message as it is filled in, if nothing is wrong with it.")
    footer = True
    priority = True

    @classmethod
    def possible(cls, target: FormTarget) -> bool | None:
        """Only where the form is what is submitted."""
        return target.submits

    @classmethod
    def label(cls, target: FormTarget) -> str:
        """By what becomes of it."""
        return target.submit_title or cls.title

    @classmethod
    async def run(cls, target: FormTarget) -> None:
        """Check and take it."""
        target.submit()


FORM_ACTIONS = (SubmitForm,)
