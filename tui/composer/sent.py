"""Texts that were sent from the composer, kept across sessions so that they can be recalled.

`$XDG_STATE_HOME/deck/composer.json`, by default under `~/.local/state`: a JSON list of texts, the
newest last. Losing it does no harm: a broken file counts as missing, and a full disk is ignored.
"""

from __future__ import annotations

import contextlib
import json
from pathlib import Path

from platformdirs import user_state_path

from text.nested import read_json

KEPT = 50
LONGEST = 64 * 1024


def sent_path() -> Path:
    """Return the path of the file."""
    return user_state_path("deck") / "composer.json"


class Sent:
    """The sent texts, and a position that moves through them from the newest to the oldest."""

    def __init__(self, path: Path) -> None:
        """Read the texts kept at `path`."""
        self._path = path
        self._texts = _read(path)
        self._at = len(self._texts)
        self._draft = ""
        """The text in the editor when the walk began."""

    def add(self, text: str) -> None:
        """Add a text that was sent; one that was sent before becomes the newest."""
        if len(text) <= LONGEST:
            self._texts = [*(old for old in self._texts if old != text), text][-KEPT:]
            _write(self._path, self._texts)
        self._at = len(self._texts)

    def older(self, current: str) -> str | None:
        """The previous text, None at the oldest; `current` is the text in the editor."""
        if self._at == 0:
            return None
        if self._at == len(self._texts):
            self._draft = current
        self._at -= 1
        return self._texts[self._at]

    def newer(self) -> str | None:
        """The next text, and after the newest the one the walk started from; then None."""
        if self._at >= len(self._texts):
            return None
        self._at += 1
        return self._draft if self._at == len(self._texts) else self._texts[self._at]


def _read(path: Path) -> list[str]:
    try:
        found = read_json(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return []
    texts = found if isinstance(found, list) else []
    return [text for text in texts if isinstance(text, str) and len(text) <= LONGEST][-KEPT:]


def _write(path: Path, texts: list[str]) -> None:
    beside = path.with_suffix(".new")
    with contextlib.suppress(OSError, UnicodeEncodeError):
        path.parent.mkdir(parents=True, exist_ok=True)
        beside.write_text(json.dumps(texts, ensure_ascii=False), encoding="utf-8")
        beside.replace(path)
