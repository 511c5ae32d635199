"""Which Latin letter is printed where a letter of another keyboard layout is.

A terminal that sends `ctrl+ч` means the key that is marked X. Where it can it says so itself (the
base layout of the kitty keyboard protocol); for all others the usual layouts are here. Ukrainian
letters stand beside the Russian ones, whose keys they share but for their own four.

A letter alone is bound on all of them: in a text field it is a letter, elsewhere the key it is on.
"""

from __future__ import annotations

_LAYOUTS = (
    ("qwertyuiop[]asdfghjkl;'zxcvbnm,.`", "йцукенгшщзхъфывапролджэячсмитьбюё"),
    ("s]'u", "іїєґ"),
    ("wertyuiopasdfghjklzxcvbnm", "ςερτυθιοπασδφγηξκλζχψωβνμ"),
    ("ertyuiopasdfghjkl;zxcvbnm,.", "קראטוןםפשדגכעיחלךףזסבהנמצתץ"),
)
LATIN_OF: dict[str, str] = {
    letter: key for keys, letters in _LAYOUTS for key, letter in zip(keys, letters, strict=True)
}
"""The key of a US keyboard for each letter, both in lower case."""


def on_all_layouts(keys: str) -> str:
    """Return keys in Textual's notation, comma-separated, and those in their places elsewhere."""
    named = keys.split(",")
    more = [
        f"{before}{letter.upper() if key.isupper() else letter}"
        for before, key in (_parts(name) for name in named)
        for letter, latin in LATIN_OF.items()
        # Without cases, a capital letter is typed as a Latin one.
        if latin == key.lower() and (key.islower() or letter.isupper() != letter.upper().isupper())
    ]
    return ",".join(dict.fromkeys((*named, *more)))


def _parts(name: str) -> tuple[str, str]:
    """Return the modifiers and the letter; no letter for a key that has a name."""
    before, plus, key = name.rpartition("+")
    return (before + plus, key) if len(key) == 1 and key.isascii() and key.isalpha() else ("", "\0")
