"""Make the README's pictures: lesson 9 and the Space screen, as the program draws them.

`.venv/bin/python -m scripts.picture` writes docs/deck.*.png and docs/space.*.png; it needs
`rsvg-convert` (Debian: librsvg2-bin) and a monospaced font (fonts-dejavu-core).
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from tests.e2e.terminal import Terminal
from tests.waiting import comes

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).resolve().parents[1]
DOMAIN = 76
WIDTH_PX = 1320
SPOKEN = {"en": "wheel slower", "ru": "колесо медленнее"}
"""Text that the deck shows while the robot turns."""
TURN_LEFT = "налево"
PAUSE_S = 0.1


def say_left(terminal: Terminal, field_keys: str) -> None:
    """Type the command; `field_keys` is on the screen while the command line has the focus."""
    terminal.press("c")
    terminal.wait_for(field_keys)
    terminal.type(TURN_LEFT)
    terminal.press("enter", "escape")
    terminal.wait_gone(field_keys)


def wait_for_whole_frame(terminal: Terminal) -> None:
    """Wait for a pause in what the program writes, so that no frame is half drawn."""
    received = -1
    while received != terminal.received:
        received = terminal.received
        time.sleep(PAUSE_S)


@contextmanager
def deck(profile: str, language: str, *more: str) -> Iterator[Terminal]:
    """Run Deck on a profile, with settings and folders of its own."""
    with tempfile.TemporaryDirectory() as folder:
        env = {
            "DECK_RUN_DIR": f"{folder}/run",
            "DECK_LOG_DIR": f"{folder}/logs",
            "XDG_CONFIG_HOME": f"{folder}/config",
            "XDG_STATE_HOME": f"{folder}/state",
            "DECK_COURSE": f"{folder}/course",
        }
        arguments = [profile, "--lang", language, "--domain", str(DOMAIN), *more]
        terminal = Terminal([sys.executable, "-m", "tui", *arguments], 120, 40, env)
        try:
            yield terminal
        finally:
            terminal.close()


def keep(terminal: Terminal, name: str) -> None:
    """Draw what is on the screen now into docs/."""
    wait_for_whole_frame(terminal)
    png = ROOT / "docs" / name
    with tempfile.TemporaryDirectory() as folder:
        svg = Path(folder) / "deck.svg"
        svg.write_text(terminal.svg("deck"))
        subprocess.run(["rsvg-convert", "-w", str(WIDTH_PX), "-o", png, svg], check=True)
    print(f"{png.relative_to(ROOT)}: {png.stat().st_size // 1024} kB")


def lesson(language: str) -> None:
    """Run lesson 9, make the robot turn left, and draw the screen at that moment."""
    with deck("09-brain", language, "--set", "sonar_front.pattern=sweep") as terminal:
        terminal.wait_for("9/9")
        terminal.wait_for("◂", within_s=60)
        while SPOKEN[language] not in terminal.text():
            # A wall may be near just then, or the brain may give another command.
            say_left(terminal, "^x STOP" if language == "en" else "^x СТОП")
            comes(lambda: SPOKEN[language] in terminal.text(), within_s=3)
        keep(terminal, f"deck.{language}.png")


def space(language: str) -> None:
    """Run the robot in its simulated room, and look at both from above."""
    with deck("robot", language) as terminal:
        terminal.wait_for("16/16", within_s=60)
        terminal.press("9")
        terminal.wait_for("sonar_front_link", within_s=60)
        terminal.press("m")
        terminal.wait_for("○")
        wait_for_whole_frame(terminal)
        keep(terminal, f"space.{language}.png")


def main() -> int:
    """Make the pictures of README in both languages."""
    if shutil.which("rsvg-convert") is None:
        print("rsvg-convert is missing: apt install librsvg2-bin", file=sys.stderr)
        return 1
    for language in ("en", "ru"):
        lesson(language)
        space(language)
    return 0


if __name__ == "__main__":
    sys.exit(main())
