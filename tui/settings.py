"""Settings that outlast a run: theme, language, keys, last lesson and editor, in a small JSON file.

`$XDG_CONFIG_HOME/deck/settings.json`, by default under `~/.config`::

    {"theme": "textual-light", "language": "ru", "keys": {"node.restart": "f7"}, "lesson": "05-tf2"}
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from pathlib import Path

from platformdirs import user_config_path

from graph.heavy_types import HEAVY_TYPES
from text.i18n import LANGUAGES, N_, _, localized
from text.nested import NestedTooDeeplyError, read_json
from text.os_words import os_reason

SEEN = "seen"
PIXELS = ("auto", "on", "off")
_TEXTS = {
    "lesson": (N_("lesson: expected the name of a profile, such as {example}"), '"05-tf2"'),
    "editor": (N_("editor: expected a command, such as {example}"), '"nano"'),
}


class SettingsError(Exception):
    """The file cannot be used; the text says where the problem is and how to fix it."""


@dataclass(frozen=True)
class Settings:
    """The user's settings; unset ones are empty."""

    theme: str = ""
    language: str = ""
    keys: dict[str, str] = field(default_factory=dict)
    """Maps a binding id to its keys, comma-separated."""
    lesson: str = ""
    """Name of the profile that was opened last."""
    editor: str = ""
    """The command that opens the learner's files, where EDITOR names none."""
    left_out: str = ""
    """Types that are not recorded, comma-separated, as chosen the last time."""
    tour: str = ""
    """`SEEN` once the tour of the first start was shown."""
    pixels: str = ""
    """As `--pixels`, which comes first."""


def settings_path() -> Path:
    """Return the path of the settings file, which need not exist."""
    return user_config_path("deck") / "settings.json"


def load(path: Path, themes: Collection[str], actions: Callable[[], Collection[str]]) -> Settings:
    """Read the settings; they are empty if there is no file.

    `actions` is called only if keys are set, because it has to import every screen.

    Raises:
        SettingsError: if it is not valid JSON, or something in it is unknown.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return Settings()
    except (OSError, UnicodeDecodeError) as error:
        raise SettingsError(f"{path}: {_unreadable(error)}") from error
    import json

    try:
        raw = read_json(text)
    except json.JSONDecodeError as error:
        raise SettingsError(f"{path}:{error.lineno}:{error.colno}: {error.msg}") from error
    except NestedTooDeeplyError as error:
        raise SettingsError(f"{path}: {error}") from error
    problem = _problem(raw, themes, actions)
    if problem:
        raise SettingsError(f"{path}: {problem}")
    return Settings(**raw)


def save(path: Path, settings: Settings) -> None:
    """Write the settings atomically; a disk error is not a reason to stop."""
    import json

    raw = {name: value for name, value in vars(settings).items() if value}
    beside = path.with_suffix(".new")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        beside.write_text(json.dumps(raw, ensure_ascii=False, indent=2) + "\n", encoding="utf-8")
        beside.replace(path)
    except OSError as error:
        raise SettingsError(f"{path}: {localized(os_reason(error))}") from error


def _unreadable(error: OSError | UnicodeDecodeError) -> str:
    """Return why the file cannot be read as text, and how to fix that."""
    if isinstance(error, UnicodeDecodeError):
        words = _("is not UTF-8: byte 0x{byte:02x}").format(byte=error.object[error.start])
        return f"{words} ({_('save the file as UTF-8')})"
    if isinstance(error, IsADirectoryError):
        return _("expected a file, found a directory (remove or rename it)")
    if isinstance(error, PermissionError):
        return f"{_('no permission to read it')} ({_('chmod u+r it, or ask its owner')})"
    return _("cannot be read: {reason}").format(reason=localized(os_reason(error)))


def _problem(raw: object, themes: Collection[str], actions: Callable[[], Collection[str]]) -> str:
    if not isinstance(raw, dict):
        return _("expected an object: {example}").format(example='{"language": "ru"}')
    for name, value in raw.items():
        if name not in Settings.__dataclass_fields__:
            known = ", ".join(Settings.__dataclass_fields__)
            return _("unknown setting {name!r}; available: {known}").format(name=name, known=known)
        if name == "keys":
            found = _keys_problem(value, actions())
            if found:
                return found
        elif name in _TEXTS:
            if not isinstance(value, str):
                words, example = _TEXTS[name]
                return _(words).format(example=example)
        else:
            known_values = sorted(_values(name, themes))
            several = name == "left_out" and isinstance(value, str)
            if any(one not in known_values for one in (value.split(",") if several else [value])):
                known = ", ".join(known_values)
                return _("{name}: unknown value {value!r}; available: {known}").format(
                    name=name, value=value, known=known
                )
    return ""


def _values(name: str, themes: Collection[str]) -> Collection[str]:
    return {"theme": themes, "language": LANGUAGES, "tour": (SEEN,), "left_out": HEAVY_TYPES, "pixels": PIXELS}[name]


def _keys_problem(value: object, actions: Collection[str]) -> str:
    if not isinstance(value, dict):
        return _("keys: expected an object of actions and their keys")
    for action, keys in value.items():
        if action not in actions:
            known = ", ".join(sorted(actions))
            return _("keys: unknown action {name!r}; available: {known}").format(name=action, known=known)
        if not isinstance(keys, str) or not keys.strip():
            return _("keys: {name}: expected a key such as {example}").format(name=action, example='"f7"')
    return ""
