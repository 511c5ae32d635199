"""What was sent from the composer, kept across sessions so that it can be recalled.

`$XDG_STATE_HOME/deck/composer.json`, by default under `~/.local/state`: a JSON list of texts, the
newest last. Losing it harms nobody: a broken file is as good as none, a full disk is passed over.
"""

from __future__ import annotations

import contextlib
import json
from pathlib import Path

from platformdirs import user_state_path

KEPT = 50
LONGEST = 64 * 1024


def sent_path() -> Path:
    """Return where the texts are kept."""
    return user_state_path("deck") / "composer.json"


class Sent:
    """Texts that were sent, and a walk through them from the newest to the oldest."""

    def __init__(self, path: Path) -> None:
        """Read what is kept at `path`."""
        self._path = path
        self._texts = _read(path)
        self._at = len(self._texts)
        self._draft = ""
        """What stood in the editor when the walk began."""

    @property
    def texts(self) -> tuple[str, ...]:
        """The texts, the newest last."""
        return tuple(self._texts)

    def add(self, text: str) -> None:
        """Keep a text that was sent; sent before, it is the newest now."""
        if len(text) <= LONGEST:
            self._texts = [*(old for old in self._texts if old != text), text][-KEPT:]
            _write(self._path, self._texts)
        self._at = len(self._texts)

    def older(self, current: str) -> str | None:
        """The text before, None at the oldest; `current` is what the editor holds."""
        if self._at == 0:
            return None
        if self._at == len(self._texts):
            self._draft = current
        self._at -= 1
        return self._texts[self._at]

    def newer(self) -> str | None:
        """The text after, at last the one the walk began with; None beyond it."""
        if self._at >= len(self._texts):
            return None
        self._at += 1
        return self._draft if self._at == len(self._texts) else self._texts[self._at]


def _read(path: Path) -> list[str]:
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return []
    texts = found if isinstance(found, list) else []
    return [text for text in texts if isinstance(text, str) and len(text) <= LONGEST][-KEPT:]


def _write(path: Path, texts: list[str]) -> None:
    beside = path.with_suffix(".new")
    with contextlib.suppress(OSError, UnicodeEncodeError):
        path.parent.mkdir(parents=True, exist_ok=True)
        beside.write_text(json.dumps(texts, ensure_ascii=False), encoding="utf-8")
        beside.replace(path)
