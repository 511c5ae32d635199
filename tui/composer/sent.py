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
from tui.widgets.recalled import Recalled

KEPT = 50
LONGEST = 64 * 1024


def sent_path() -> Path:
    """Return the path of the file."""
    return user_state_path("deck") / "composer.json"


class Sent(Recalled):
    """The sent texts; one that was sent before becomes the newest."""

    def __init__(self, path: Path) -> None:
        """Read the texts kept at `path`."""
        super().__init__(KEPT)
        self._path = path
        try:
            found = read_json(path.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return
        for text in found if isinstance(found, list) else ():
            if isinstance(text, str) and len(text) <= LONGEST:
                super().keep(text)

    def keep(self, text: str) -> None:
        if len(text) > LONGEST:
            return
        self._said = [old for old in self._said if old != text]
        super().keep(text)
        beside = self._path.with_suffix(".new")
        with contextlib.suppress(OSError, UnicodeEncodeError):
            self._path.parent.mkdir(parents=True, exist_ok=True)
            beside.write_text(json.dumps(self._said, ensure_ascii=False), encoding="utf-8")
            beside.replace(self._path)
