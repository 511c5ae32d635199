"""Make the pictures of the README and of the site: the program itself, in both languages.

`.venv/bin/python -m scripts.picture` writes docs/pictures; it needs `rsvg-convert` (Debian: librsvg2-bin),
a monospaced font (fonts-dejavu-core), and Pillow, which `make view` installs. It takes a few minutes.
"""

from __future__ import annotations

import io
import shutil
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from PIL import Image

from tests.e2e.terminal import Terminal
from tests.waiting import comes

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "docs" / "pictures"
DOMAIN = 76
WIDTH_PX = 960
COLOURS = 32
COLOURS_OF_A_FILM = 64
"""They have to do for all its frames."""
PAUSE_S = 0.1
TURN_LEFT = {"en": "left", "ru": "налево"}
TURNING = {"en": "wheel slower", "ru": "колесо медленнее"}
"""What the Deck shows while the robot turns."""
TRIES = 5


class Shot(NamedTuple):
    """A screen, how to get there, and what has to stand on it."""

    name: str
    keys: tuple[str, ...]
    text: str
    settles_s: float = 1.0
    """How long it takes until there is something to see."""


OF_THE_LESSON = (Shot("lesson", ("L", "C"), "✗", 2.0),)
OF_THE_BRAIN = (
    Shot("flow", ("6",), "/drive_safe", 2.0),
    Shot("topics", ("2", *["down"] * 7), "steering_angle", 3.0),
    Shot("composer", ("3", "ctrl+s"), "/drive_safe", 3.0),
    Shot("logs", ("4",), "safety_stop"),
    Shot("graph", ("5",), "/brain_state", 2.0),
    Shot("wall", ("0",), "", 6.0),
)
OF_THE_ROBOT = (
    Shot("devices", ("7",), "←", 4.0),
    Shot("frames", ("8", "down", "down"), "sonar_front_link", 3.0),
    Shot("space", ("9", "m"), "○", 2.0),
)


class Film:
    """Frames of a moving picture, each with how long it stands."""

    def __init__(self) -> None:
        self._frames: list[Image.Image] = []
        self._stands_ms: list[int] = []

    def take(self, terminal: Terminal, stands_s: float) -> Image.Image:
        picture = drawn(terminal)
        self._frames.append(picture)
        self._stands_ms.append(round(stands_s * 1000))
        return picture

    def write(self, name: str) -> None:
        """Write it with one palette, so that only what changes is in each frame."""
        first = self._frames[0]
        strip = Image.new("RGB", (first.width, first.height * len(self._frames)))
        for at, frame in enumerate(self._frames):
            strip.paste(frame, (0, at * first.height))
        palette = few_colours(strip, COLOURS_OF_A_FILM)
        frames = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in self._frames]
        path = FOLDER / name
        frames[0].save(path, save_all=True, append_images=frames[1:], duration=self._stands_ms, loop=0)
        tell(path)


def drawn(terminal: Terminal) -> Image.Image:
    """Return a picture of what is on the screen now."""
    wait_for_whole_frame(terminal)
    svg = terminal.svg("deck").encode()
    png = subprocess.run(["rsvg-convert", "-w", str(WIDTH_PX)], input=svg, stdout=subprocess.PIPE, check=True).stdout
    return Image.open(io.BytesIO(png)).convert("RGB")


def wait_for_whole_frame(terminal: Terminal) -> None:
    """Wait for a pause in what the program writes, so that no frame is half drawn."""
    received = -1
    while received != terminal.received:
        received = terminal.received
        time.sleep(PAUSE_S)


def few_colours(picture: Image.Image, colours: int = COLOURS) -> Image.Image:
    """Return it with a palette that keeps the few cells that are red or green."""
    return picture.quantize(colours, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)


def write(picture: Image.Image, name: str) -> None:
    """Write a picture with few colours."""
    path = FOLDER / name
    few_colours(picture).save(path, optimize=True)
    tell(path)


def tell(path: Path) -> None:
    """Say what has been written."""
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size // 1024} kB", flush=True)


@contextmanager
def deck(language: str, *words: str) -> Iterator[Terminal]:
    """Run Deck with settings and folders of its own."""
    with tempfile.TemporaryDirectory(prefix="deck-") as folder:
        env = {
            "DECK_RUN_DIR": f"{folder}/run",
            "DECK_LOG_DIR": f"{folder}/logs",
            "XDG_CONFIG_HOME": f"{folder}/config",
            "XDG_STATE_HOME": f"{folder}/state",
            "DECK_COURSE": f"{folder}/course",
        }
        arguments = [*words, "--lang", language, "--domain", str(DOMAIN)]
        terminal = Terminal([sys.executable, "-m", "tui", *arguments], 120, 40, env)
        try:
            yield terminal
        finally:
            terminal.close()


def picker(language: str) -> None:
    """The list of lessons; Escape leaves the tour of a first start."""
    with deck(language) as terminal:
        time.sleep(5)
        terminal.press("escape")
        time.sleep(2)
        write(drawn(terminal), f"picker.{language}.png")


def screens(terminal: Terminal, language: str, shots: tuple[Shot, ...]) -> None:
    """Go from one screen to the next; where the expected text does not come, say so and go on."""
    for shot in shots:
        terminal.press(*shot.keys)
        if not comes(partial(_shows, terminal, shot.text), within_s=30):
            print(f"{shot.name}: {shot.text!r} is not there\n{terminal.text()}", file=sys.stderr)
        time.sleep(shot.settles_s)
        write(drawn(terminal), f"{shot.name}.{language}.png")


def _shows(terminal: Terminal, text: str) -> bool:
    return text in terminal.text()


def lesson(language: str) -> None:
    """Lesson 2 and its first task."""
    with deck(language, "02-sonar-safety") as terminal:
        terminal.wait_for("2/2", within_s=60)
        screens(terminal, language, OF_THE_LESSON)


def turn_left(terminal: Terminal, language: str) -> bool:
    """Say so on the Deck; whether the wheels obey: a wall may be near, or the brain may say something else."""
    command_line = "^x STOP" if language == "en" else "^x СТОП"
    terminal.press("c")
    terminal.wait_for(command_line)
    terminal.type(TURN_LEFT[language])
    terminal.press("enter", "escape")
    terminal.wait_gone(command_line)
    return comes(lambda: TURNING[language] in terminal.text(), within_s=3)


def brain(language: str) -> None:
    """Lesson 9: a film of its first minute, and most of the screens."""
    film = Film()
    with deck(language, "09-brain", "--set", "sonar_front.pattern=sweep") as terminal:
        terminal.wait_for("/9", within_s=60)
        film.take(terminal, 1.0)
        terminal.wait_for("9/9", within_s=60)
        for _second in range(2):
            time.sleep(1)
            film.take(terminal, 1.0)
        any(turn_left(terminal, language) for _try in range(TRIES))
        write(film.take(terminal, 2.0), f"deck.{language}.png")
        terminal.press("space")
        time.sleep(1)
        film.take(terminal, 2.0)
        terminal.press("ctrl+r")
        time.sleep(2)
        film.take(terminal, 1.0)
        terminal.press("2")
        time.sleep(3)
        film.take(terminal, 2.0)
        terminal.press("1")
        film.write(f"deck.{language}.gif")
        turn_left(terminal, language)
        screens(terminal, language, OF_THE_BRAIN)


def robot(language: str) -> None:
    """The robot in its simulated room."""
    with deck(language, "robot") as terminal:
        terminal.wait_for("16/16", within_s=60)
        screens(terminal, language, OF_THE_ROBOT)


def main() -> int:
    """Make all pictures, in both languages."""
    if shutil.which("rsvg-convert") is None:
        print("rsvg-convert is missing: apt install librsvg2-bin", file=sys.stderr)
        return 1
    FOLDER.mkdir(exist_ok=True)
    for language in ("en", "ru"):
        picker(language)
        lesson(language)
        brain(language)
        robot(language)
    return 0


if __name__ == "__main__":
    sys.exit(main())
