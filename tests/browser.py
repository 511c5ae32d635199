"""A real browser without a window: Chromium, told what to do by its own debugging protocol.

Source: https://chromedevtools.github.io/devtools-protocol/
"""

from __future__ import annotations

import base64
import itertools
import json
import shutil
import subprocess
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.request import urlopen

import cv2
import numpy as np
from websockets.sync.client import connect

from tests.slowness import patient
from tests.waiting import wait_until

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from typing_extensions import Self

NAMES = ("chromium", "chromium-browser", "google-chrome")
ANSWER_S = 30.0
ARGUMENTS = (
    *("--headless", "--no-sandbox", "--no-first-run", "--disable-background-networking"),
    *("--disable-component-update", "--disable-sync", "--disable-quic"),
    # WebGL on a machine without a graphics card.
    *("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
)


def chromium() -> str:
    found = next(filter(None, map(shutil.which, NAMES)), None)
    assert found, "no browser for this test: apt-get install chromium"
    return found


class Browser:
    """One tab of a browser with a profile of its own in `folder`."""

    def __init__(self, folder: Path, size: tuple[int, int] = (900, 600)) -> None:
        self.requests: list[str] = []
        """Every address that the page has asked for."""
        self.refused: list[str] = []
        """What the policy of a page has refused."""
        self._numbers = itertools.count(1)
        self._open = ExitStack()
        with (folder / "browser.log").open("wb") as log:
            self._process = subprocess.Popen(
                [
                    *(chromium(), *ARGUMENTS, f"--user-data-dir={folder}"),
                    *("--remote-debugging-port=0", f"--window-size={size[0]},{size[1]}"),
                    "about:blank",
                ],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
            )
        try:
            port = wait_until(lambda: _port(folder / "DevToolsActivePort"), "the browser's port")
            tab = wait_until(lambda: _tab(port), "a tab of the browser")
            self._line = self._open.enter_context(connect(tab, max_size=None))
            for domain in ("Network", "Page", "Log"):
                self._call(f"{domain}.enable")
        except BaseException:
            self._end()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._end()

    def open(self, url: str) -> None:
        """Go to a page; it is not waited for."""
        self._call("Page.navigate", url=url)

    def picture(self) -> NDArray[np.uint8]:
        """Return what the page looks like, shape (height, width, 3), red, green, blue."""
        shot = wait_until(lambda: self._ask("Page.captureScreenshot", format="png").get("result"), "a screenshot")
        data = np.frombuffer(base64.b64decode(shot["data"]), np.uint8)
        pixels = cv2.imdecode(data, cv2.IMREAD_COLOR)
        assert pixels is not None
        return np.ascontiguousarray(pixels[:, :, ::-1]).astype(np.uint8)

    def evaluate(self, expression: str) -> Any:
        """Return what an expression of JavaScript comes to; a promise is waited for."""
        answer = self._call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        return answer["result"].get("value")

    def _call(self, method: str, **parameters: Any) -> Any:
        answer = self._ask(method, **parameters)
        assert "result" in answer, answer
        return answer["result"]

    def _ask(self, method: str, **parameters: Any) -> Any:
        number = next(self._numbers)
        self._line.send(json.dumps({"id": number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self._line.recv(timeout=patient(ANSWER_S)))
            if message.get("id") == number:
                return message
            self._hear(message)

    def _hear(self, message: Any) -> None:
        if message["method"] == "Network.requestWillBeSent":
            self.requests.append(message["params"]["request"]["url"])
        if message["method"] == "Log.entryAdded":
            text = message["params"]["entry"]["text"]
            if "Content Security Policy" in text:
                self.refused.append(text)

    def _end(self) -> None:
        self._open.close()
        self._process.terminate()
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(10)
        self._process.kill()


def _port(file: Path) -> int:
    lines = file.read_text().splitlines() if file.exists() else []
    return int(lines[0]) if len(lines) > 1 else 0


def _tab(port: int) -> str:
    with urlopen(f"http://127.0.0.1:{port}/json") as answer:
        tabs = [one for one in json.load(answer) if one["type"] == "page"]
    return str(tabs[0]["webSocketDebuggerUrl"]) if tabs else ""
