"""Cameras, sound cards and speech, which only the real robot needs."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import filterfalse
from pathlib import Path
from typing import TYPE_CHECKING

from cli.doctor.finding import ok, warn
from text.i18n import _

if TYPE_CHECKING:
    from cli.doctor.finding import Finding

SPEECH = ("pocketsphinx", "espeakng_loader")
"""What the nodes `hearing` and `speaking` import."""
CARD = re.compile(r"^\s*\d+\s+\[[^]]*\]:\s*(.+)$", re.MULTILINE)


@dataclass(frozen=True)
class MediaFacts:
    """The cameras and sound cards found."""

    cameras: tuple[tuple[str, str, bool], ...] = ()
    """Device, name, and whether this user may open it."""
    cards: tuple[str, ...] = ()
    """Sound cards by name."""
    sound_allowed: bool = True
    no_speech: tuple[str, ...] = ()
    """Packages that hearing and speaking offline lack."""


def collect() -> MediaFacts:
    cameras = tuple(
        (str(path), _camera_name(path.name), os.access(path, os.R_OK | os.W_OK))
        for path in sorted(Path("/dev").glob("video[0-9]*"))
    )
    try:
        cards = tuple(cards_in(Path("/proc/asound/cards").read_text(errors="replace")))
    except OSError:
        cards = ()
    devices = list(Path("/dev/snd").glob("pcm*")) if cards else []
    allowed = all(os.access(path, os.R_OK | os.W_OK) for path in devices)
    return MediaFacts(cameras, cards, allowed, tuple(filterfalse(find_spec, SPEECH)))


def diagnose(facts: MediaFacts) -> list[Finding]:
    """Report what is all right and what is not."""
    found = [_camera(*camera) for camera in facts.cameras]
    if not found:
        found.append(ok("camera", _("no camera; mocks need none")))
    if not facts.cards:
        found.append(ok("sound", _("no sound card; mocks need none")))
    elif facts.sound_allowed:
        found.append(ok("sound", _("sound: {cards}").format(cards=", ".join(facts.cards))))
    else:
        text = _("sound: {cards}: no permission").format(cards=", ".join(facts.cards))
        found.append(warn("sound", text, "sudo usermod -aG audio $USER"))
    if facts.no_speech:
        text = _("speech offline: without {packages}; to hear and speak: {fix}")
        fix = "pip install 'deck-robot[voice]'"
        found.append(ok("speech", text.format(packages=", ".join(facts.no_speech), fix=fix)))
    else:
        found.append(ok("speech", _("speech offline: in English; it speaks Russian too")))
    return found


def cards_in(text: str) -> list[str]:
    """Return the names of the cards listed in /proc/asound/cards."""
    return [match.group(1).strip() for match in CARD.finditer(text)]


def _camera(device: str, name: str, allowed: bool) -> Finding:
    text = _("camera {device} {name}").format(device=device, name=name).rstrip()
    if allowed:
        return ok("camera", text)
    return warn("camera", _("{what}: no permission").format(what=text), "sudo usermod -aG video $USER")


def _camera_name(device: str) -> str:
    try:
        return Path("/sys/class/video4linux", device, "name").read_text(errors="replace").strip()
    except OSError:
        return ""
