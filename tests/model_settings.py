"""The user's settings of a language model, as a test wants them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from tests.model_server import KEY

if TYPE_CHECKING:
    from pathlib import Path


def write_settings(folder: Path, url: str, **fields: object) -> None:
    """Write `llm.yaml` for a server, with a key in a file beside it.

    `folder`: the user's folder of Deck's settings.
    """
    (folder / "key").write_text(KEY)
    (folder / "key").chmod(0o600)
    given = {"base_url": url, "model": "m-1", "key_file": f"{folder}/key", **fields}
    given.setdefault("budget", {"calls_per_minute": 1000})
    # JSON is YAML.
    (folder / "llm.yaml").write_text(json.dumps(given))
