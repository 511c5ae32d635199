"""A model file served by `deck model serve`, as a user has it: a process, a port, sentences."""

from __future__ import annotations

import json
import re
import signal
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import openai
import psutil

from robot.commands.schema import LlmResponse
from tests.deck_process import DeckProcess

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

ANSWER: Any = {
    "type": "json_schema",
    "json_schema": {"name": "answer", "strict": True, "schema": LlmResponse.model_json_schema()},
}
"""The form of what may move the robot."""
QUESTION: Any = [
    {"role": "system", "content": "You drive a robot."},
    {"role": "user", "content": "Forward, and a little to the left."},
]


class ServedModel:
    """A model that can be asked."""

    def __init__(self, process: DeckProcess) -> None:
        """Wait until it can be."""
        self.process = process
        said = process.said(" is served at ")
        found = re.fullmatch(r"(\S+) is served at (\S+), (\d+) tokens at once; Ctrl-C ends it", said)
        assert found
        self.name, self.base_url, self.context = found[1], found[2], int(found[3])

    @property
    def port(self) -> int:
        return int(self.base_url.split(":")[2].split("/")[0])

    def client(self) -> openai.OpenAI:
        return openai.OpenAI(base_url=self.base_url, api_key="none", max_retries=0, timeout=30)

    def llama(self) -> psutil.Process:
        (child,) = psutil.Process(self.process.process.pid).children()
        return child

    def end(self, by: signal.Signals = signal.SIGINT) -> int:
        self.process.signal(by)
        return self.process.finish()


@contextmanager
def served(path: Path, *options: str, cwd: Path | None = None) -> Iterator[ServedModel]:
    process = DeckProcess("model", "serve", str(path), "--port", "0", *options, cwd=cwd)
    try:
        yield ServedModel(process)
    finally:
        process.close()


def asked(model: ServedModel, **fields: Any) -> Any:
    """Ask for an answer that may move the robot; return the server's choice."""
    with model.client() as client:
        answer = client.chat.completions.create(model=model.name, messages=QUESTION, response_format=ANSWER, **fields)
    return answer.choices[0]


def fields_of(text: str) -> dict[str, Any]:
    """Return an answer's fields, which must be those of the schema."""
    found = json.loads(text)
    assert list(found) == ["thought", "commands"]
    assert isinstance(found["thought"], str)
    for command in found["commands"]:
        assert list(command) in (["action", "speed", "steering"], ["action", "pan", "tilt"])
        assert command["action"] == ("drive" if "speed" in command else "turn_head")
    return dict(found)
