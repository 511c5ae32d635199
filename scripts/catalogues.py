"""Compile the message catalogues that are older than their sources, or check them.

Usage: catalogues.py compile|check. `compile` writes a deck.mo beside each deck.po; `check` lists
messages that a catalogue does not translate, and entries that the code no longer uses.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from babel.messages import Catalog, Message

ROOT = Path(__file__).resolve().parent.parent
LOCALE = ROOT / "text" / "locale"
DOMAIN = "deck"
ROOMS = (
    *("agents", "brain", "cli", "course", "graph", "launcher", "nodes", "robot", "ros2", "safety"),
    *("space", "text", "tui", "view"),
)
KEYWORDS = (
    *("_", "N_", "ngettext:1,2", "refused", "say"),
    # The descriptions of node parameters.
    *("Choice:2", "Number:2", "Switch:2", "Text:2", "Whole:2"),
)


def babel(*words: str | Path) -> None:
    """Run `pybabel` with these arguments; raises its errors."""
    from babel.messages.frontend import CommandLineInterface

    CommandLineInterface().run(  # type: ignore[no-untyped-call]
        ["pybabel", "--quiet", *map(str, words)]
    )


def stale(locale: Path = LOCALE) -> list[Path]:
    """Return the sources that have changed since they were compiled."""
    sources = sorted(locale.glob(f"*/LC_MESSAGES/{DOMAIN}.po"))
    return [path for path in sources if changed(path) > changed(path.with_suffix(".mo"))]


def changed(path: Path) -> int:
    """Return the modification time of a file, 0 if there is none."""
    return path.stat().st_mtime_ns if path.exists() else 0


def compile_stale(locale: Path = LOCALE) -> None:
    """Compile stale sources; each catalogue is replaced atomically."""
    for source in stale(locale):
        with tempfile.TemporaryDirectory(dir=source.parent) as folder:
            made = Path(folder) / f"{DOMAIN}.mo"
            files = (f"--input-file={source}", f"--output-file={made}")
            babel("compile", *files, f"--locale={source.parents[1].name}")
            made.replace(source.with_suffix(".mo"))


def said() -> Catalog:
    """Return the messages that the code marks for translation."""
    from babel.messages.pofile import read_po

    with tempfile.TemporaryDirectory() as folder:
        found = Path(folder) / f"{DOMAIN}.pot"
        keywords = (f"--keywords={keyword}" for keyword in KEYWORDS)
        rooms = (ROOT / room for room in ROOMS)
        babel("extract", "--no-location", *keywords, f"--output-file={found}", *rooms)
        with found.open("rb") as file:
            return read_po(file, abort_invalid=True)


def translated(language: str) -> Catalog:
    """Return the catalogue that translators edit; a broken one raises babel's PoFileError."""
    from babel.messages.pofile import read_po

    with (LOCALE / language / "LC_MESSAGES" / f"{DOMAIN}.po").open("rb") as file:
        return read_po(file, locale=language, abort_invalid=True)


def wrong(language: str) -> list[str]:
    """Return the missing and the unused entries of a language's catalogue."""
    code, catalogue = said(), translated(language)
    found: list[str] = []
    for message in code:
        entry = catalogue.get(key(message))
        strings = "" if entry is None else entry.string
        whole = bool(strings) if isinstance(strings, str) else all(strings or [""])
        if (message.id and not (entry and whole)) or (entry and message.id and entry.fuzzy):
            found.append(f"not translated: {key(message)!r}")
    known = {key(message) for message in code}
    return found + [f"no longer used: {key(entry)!r}" for entry in catalogue if entry.id and key(entry) not in known]


def key(message: Message) -> str:
    """Return the English text of a message; for a plural message, its singular."""
    return message.id if isinstance(message.id, str) else str(message.id[0])


def main(words: list[str]) -> int:
    """Run one of the two commands."""
    if words == ["compile"]:
        compile_stale()
    elif words == ["check"]:
        found = wrong("ru")
        print("".join(f"{line}\n" for line in found), end="")
        return 1 if found else 0
    else:
        print(__doc__, file=sys.stderr)
        return os.EX_USAGE
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
