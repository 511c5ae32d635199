"""What the sound driver says, in both languages, by the way that the sound goes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nodes.drivers.portaudio import IN, OUT
from nodes.parts.speech import Phrase

if TYPE_CHECKING:
    from nodes.parts.speech import Speech

OPENED = {
    IN: Phrase("Microphone: {device}, {rate} Hz", "Микрофон: {device}, {rate} Гц"),
    OUT: Phrase("Speaker: {device}, {rate} Hz", "Динамик: {device}, {rate} Гц"),
}
LOST = {
    IN: Phrase("Lost the microphone {device}: {problem}", "Потерян микрофон {device}: {problem}"),
    OUT: Phrase("Lost the speaker {device}: {problem}", "Потерян динамик {device}: {problem}"),
}
CANNOT = {
    IN: Phrase("No microphone: {problem}", "Нет микрофона: {problem}"),
    OUT: Phrase("No speaker: {problem}", "Нет динамика: {problem}"),
}
SINCE = {
    IN: Phrase(
        "microphone {device}, {rate} Hz, for {seconds:.0f} s",
        "микрофон {device}, {rate} Гц, {seconds:.0f} с",
    ),
    OUT: Phrase(
        "speaker {device}, {rate} Hz, for {seconds:.0f} s",
        "динамик {device}, {rate} Гц, {seconds:.0f} с",
    ),
}
OFF = Phrase("off, by the parameter", "выключен параметром")
FAULTY = Phrase("{words}; {faults:.0f} errors a second", "{words}; ошибок в секунду: {faults:.0f}")
OPENING = Phrase("it is being opened", "открывается")

EMPTY = Phrase("An empty message for the speaker", "Пустое сообщение для динамика")
ODD = Phrase(
    "{count} bytes for the speaker, but a sample has two: the last is left out",
    "{count} байт для динамика, а в отсчёте их два: последний отброшен",
)
WORDS = Phrase(
    'Words and no sound came for the speaker: "{words}"',
    "Для динамика пришли слова, а не звук: «{words}»",
)
LATE = Phrase(
    "The speaker is late: the oldest {seconds:.1f} s of sound are dropped",
    "Динамик не успевает: отброшено {seconds:.1f} с самого старого звука",
)
UNPLAYED = Phrase(
    "There is no speaker now: {seconds:.1f} s of sound are not played",
    "Динамика сейчас нет: {seconds:.1f} с звука не сыграно",
)

_PROBLEMS = {
    "package": Phrase(
        "sounddevice is not installed; pip install sounddevice",
        "не установлен sounddevice; pip install sounddevice",
    ),
    "library": Phrase(
        "PortAudio is not installed; sudo apt install libportaudio2",
        "не установлен PortAudio; sudo apt install libportaudio2",
    ),
    "missing": Phrase(
        'no device "{device}"; set the parameter to one of these: {detail}',
        "нет устройства «{device}»; задайте параметром одно из этих: {detail}",
    ),
    "none": Phrase(
        "no such sound device; plug it in (arecord -l and aplay -l list them), "
        "or sudo usermod -aG audio $USER and log in again",
        "нет такого звукового устройства; подключите его (список: arecord -l, aplay -l) "
        "или sudo usermod -aG audio $USER и войдите заново",
    ),
    "busy": Phrase(
        "another program is using it; close that one (fuser -v /dev/snd/*)",
        "занято другой программой; закройте её (fuser -v /dev/snd/*)",
    ),
    "rate": Phrase("it cannot do {detail} Hz", "оно не поддерживает {detail} Гц"),
    "gone": Phrase("it is gone; is it unplugged?", "оно пропало; его отключили?"),
    "silent": Phrase("no sound moves any more", "звук больше не идёт"),
    "hung": Phrase("PortAudio does not answer", "PortAudio не отвечает"),
    "died": Phrase("PortAudio has died: {detail}", "PortAudio упал: {detail}"),
    "other": Phrase("{detail}", "{detail}"),
}


def explain(say: Speech, problem: str, device: str, detail: str) -> str:
    """What is wrong with a device, and the mend."""
    if problem == "missing" and not (device and detail):
        problem = "none"
    return say.text(_PROBLEMS.get(problem, _PROBLEMS["other"]), device=device, detail=detail)
