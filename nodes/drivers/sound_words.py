"""The messages of the sound driver, by the direction of the sound."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nodes.drivers.sound_device import IN, OUT
from text.i18n import N_

if TYPE_CHECKING:
    from nodes.parts.translated_logger import TranslatedLogger
    from text.i18n import N_

OPENED = {IN: N_("Microphone: {device}, {rate} Hz"), OUT: N_("Speaker: {device}, {rate} Hz")}
LOST = {IN: N_("Lost the microphone {device}: {problem}"), OUT: N_("Lost the speaker {device}: {problem}")}
CANNOT = {IN: N_("No microphone: {problem}"), OUT: N_("No speaker: {problem}")}
SINCE = {
    IN: N_("microphone {device}, {rate} Hz, for {seconds:.0f} s"),
    OUT: N_("speaker {device}, {rate} Hz, for {seconds:.0f} s"),
}
OFF = N_("off, by the parameter")
FAULTY = N_("{words}; {faults:.0f} errors a second")
OPENING = N_("it is being opened")

EMPTY = N_("An empty message for the speaker")
ODD = N_("{count} bytes for the speaker, but a sample has two: the last is left out")
WORDS = N_('The speaker got text instead of sound: "{words}"')
LATE = N_("The speaker is late: the oldest {seconds:.1f} s of sound are dropped")
UNPLAYED = N_("There is no speaker now: {seconds:.1f} s of sound are not played")

_PROBLEMS = {
    "package": N_("miniaudio is not installed; pip install miniaudio"),
    "library": N_("neither PulseAudio nor ALSA is installed; sudo apt install libasound2"),
    "missing": N_('no device "{device}"; set the parameter to one of these: {detail}'),
    "none": N_(
        "no such sound device; plug it in (arecord -l and aplay -l list them), "
        "or sudo usermod -aG audio $USER and log in again"
    ),
    "busy": N_("it cannot be opened; close the program that uses it (fuser -v /dev/snd/*)"),
    "gone": N_("it is gone; is it unplugged?"),
    "silent": N_("no sound moves any more"),
    "hung": N_("the library of sound does not answer"),
    "died": N_("the library of sound has died: {detail}"),
    "other": N_("{detail}"),
}


def explain(say: TranslatedLogger, problem: str, device: str, detail: str) -> str:
    """Return what is wrong with a device, and the fix."""
    if problem == "missing" and not (device and detail):
        problem = "none"
    return say.text(_PROBLEMS.get(problem, _PROBLEMS["other"]), device=device, detail=detail)
