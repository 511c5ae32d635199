"""The destination of a message: the topic and its type."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from textual import on
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widgets import Input, Static

from graph.messages.browse import interfaces
from text.i18n import _
from text.ros_names import TOPIC_NAME
from tui.widgets.field import Field
from tui.widgets.working import Working
from tui.yaml_form.type_field import TypeField

if TYPE_CHECKING:
    from textual.app import ComposeResult


class PublishTarget(Vertical, Working):
    """Two lines; the second is completed from the installed types."""

    class TopicChanged(Message):
        """Another topic name was entered."""

    class TopicDone(Message):
        """Enter was pressed in the field of the name."""

    DEFAULT_CSS = """
    PublishTarget {
        height: auto;
        .target-row { height: auto; }
        .target-label { width: 8; color: $text-muted; }
        #target-topic { width: 1fr; }
    }
    """

    def compose(self) -> ComposeResult:
        """The topic above its type."""
        with Horizontal(classes="target-row"):
            yield Static(id="target-topic-label", classes="target-label", markup=False)
            yield Field(id="target-topic", compact=True, select_on_focus=False)
        with Horizontal(classes="target-row"):
            yield Static(id="target-type-label", classes="target-label", markup=False)
            yield TypeField()

    def on_mount(self) -> None:
        """Read the installed types."""
        self.on_language_changed()
        self.run_worker(self._learn_types(), group="types")

    @property
    def field(self) -> Input:
        return self.query_one("#target-topic", Input)

    @property
    def type(self) -> TypeField:
        return self.query_one(TypeField)

    @property
    def topic(self) -> str:
        """The topic that was entered; a relative name is below the root."""
        name = self.field.value.strip()
        return name if not name or name.startswith(("/", "~")) else f"/{name}"

    @property
    def is_name(self) -> bool:
        return TOPIC_NAME.fullmatch(self.topic) is not None

    def on_language_changed(self) -> None:
        self.query_one("#target-topic-label", Static).update(_("Topic"))
        self.query_one("#target-type-label", Static).update(_("Type"))
        self.field.placeholder = _("/name of an existing or a new topic")
        self.type.field.placeholder = _("words of its name: float32, twist")

    async def _learn_types(self) -> None:
        names = await asyncio.to_thread(interfaces)
        self.type.know(tuple(name for name in names if "/msg/" in name))

    @on(Input.Changed, "#target-topic")
    def _changed(self, event: Input.Changed) -> None:
        event.stop()
        self.post_message(self.TopicChanged())

    @on(Input.Submitted, "#target-topic")
    def _submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self.post_message(self.TopicDone())
