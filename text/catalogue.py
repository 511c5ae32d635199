"""The message catalogues as files: `python -m text.catalogue compile|missing`.

For those who write the screen; the screen itself reads only the compiled catalogue.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from datetime import datetime, timezone
from pathlib import Path
from typing import TYPE_CHECKING

from text.i18n import DOMAIN, LOCALE

if TYPE_CHECKING:
    from babel.messages import Catalog

ROOT = Path(__file__).parent.parent
SOURCES = ("cli", "graph", "launcher", "nodes", "robot", "text", "tui")
KEYWORDS = {"_": None, "N_": None, "ngettext": (1, 2), "say": None}


def po_path(language: str) -> Path:
    """Return the catalogue that people edit."""
    return LOCALE / language / "LC_MESSAGES" / f"{DOMAIN}.po"


def read_po(language: str) -> Catalog:
    """Read the catalogue that people edit; a broken one raises babel's PoFileError."""
    from babel.messages import pofile

    with po_path(language).open("rb") as file:
        return pofile.read_po(file, locale=language, abort_invalid=True)


def used_messages() -> Iterator[tuple[str, str | tuple[str, str]]]:
    """Yield (place, message) for every string marked in the code of the screen."""
    from babel.messages.extract import extract

    for path in sorted(path for room in SOURCES for path in (ROOT / room).rglob("*.py")):
        with path.open("rb") as file:
            for line, message, _comments, _context in extract("python", file, KEYWORDS):
                place = f"{path.relative_to(ROOT)}:{line}"
                yield place, message if isinstance(message, str) else (message[0], message[1])


def missing(language: str) -> list[str]:
    """Return `place: message` for what the code says and the catalogue does not translate."""
    catalogue = read_po(language)
    found: list[str] = []
    for place, message in used_messages():
        entry = catalogue.get(message if isinstance(message, str) else message[0])
        strings = () if entry is None else entry.string
        done = bool(strings) if isinstance(strings, str) else all(strings or [""])
        if not done or (entry is not None and entry.fuzzy):
            found.append(f"{place}: {message!r}")
    return found


def compile_all() -> list[Path]:
    """Write a .mo beside every .po; return what was written."""
    from babel.messages import mofile

    written: list[Path] = []
    # Its header would else tell when it was made, and each making would be another file.
    timeless = datetime(2000, 1, 1, tzinfo=timezone.utc)
    for path in sorted(LOCALE.glob(f"*/LC_MESSAGES/{DOMAIN}.po")):
        target = path.with_suffix(".mo")
        with target.open("wb") as file:
            catalogue = read_po(path.parent.parent.name)
            catalogue.creation_date = catalogue.revision_date = timeless
            mofile.write_mo(file, catalogue)
        written.append(target)
    return written


def main(arguments: list[str]) -> int:
    """Compile the catalogues, or list what is not translated."""
    if arguments == ["compile"]:
        for path in compile_all():
            print(path.relative_to(ROOT))  # noqa: T201
        return 0
    if arguments == ["missing"]:
        gaps = missing("ru")
        print("\n".join(gaps))  # noqa: T201
        return 1 if gaps else 0
    print("usage: python -m text.catalogue compile|missing", file=sys.stderr)  # noqa: T201
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
