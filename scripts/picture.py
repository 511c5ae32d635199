"""Make the README's pictures: lesson 9 running, as the program draws it in a terminal.

`.venv/bin/python -m scripts.picture` writes docs/deck.en.png and docs/deck.ru.png; it needs
`rsvg-convert` (Debian: librsvg2-bin) and a monospaced font (fonts-dejavu-core).
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from tests.e2e.terminal import Terminal
from tests.waiting import comes

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


def picture(language: str) -> None:
    """Run lesson 9, make the robot turn left, and draw the screen at that moment."""
    with tempfile.TemporaryDirectory() as folder:
        env = {
            "DECK_RUN_DIR": f"{folder}/run",
            "DECK_LOG_DIR": f"{folder}/logs",
            "XDG_CONFIG_HOME": f"{folder}/config",
            "XDG_STATE_HOME": f"{folder}/state",
            "DECK_COURSE": f"{folder}/course",
        }
        arguments = ["09-brain", "--lang", language, "--domain", str(DOMAIN)]
        sonar = ["--set", "sonar_front.pattern=sweep"]
        terminal = Terminal([sys.executable, "-m", "tui", *arguments, *sonar], 120, 40, env)
        try:
            terminal.wait_for("9/9")
            terminal.wait_for("◂", within_s=60)
            while SPOKEN[language] not in terminal.text():
                # A wall may be near just then, or the brain may give another command.
                say_left(terminal, "^x STOP" if language == "en" else "^x СТОП")
                comes(lambda: SPOKEN[language] in terminal.text(), within_s=3)
            wait_for_whole_frame(terminal)
            svg = Path(folder) / "deck.svg"
            svg.write_text(terminal.svg("deck 09-brain"))
        finally:
            terminal.close()
        png = ROOT / "docs" / f"deck.{language}.png"
        png.parent.mkdir(exist_ok=True)
        subprocess.run(["rsvg-convert", "-w", str(WIDTH_PX), "-o", png, svg], check=True)
        print(f"{png.relative_to(ROOT)}: {png.stat().st_size // 1024} kB")


def main() -> int:
    """Make both pictures."""
    if shutil.which("rsvg-convert") is None:
        print("rsvg-convert is missing: apt install librsvg2-bin", file=sys.stderr)
        return 1
    for language in ("en", "ru"):
        picture(language)
    return 0


if __name__ == "__main__":
    sys.exit(main())
